"""The folders in which libraries are built and found again."""

from __future__ import annotations

import contextlib
import os
import sys
from collections.abc import Iterator
from pathlib import Path


def folder() -> Path:
    """The folder of everything: `CLEBSCH_CACHE`, or `clebsch` in the user's folder of caches."""
    named = os.environ.get("CLEBSCH_CACHE")
    if named:
        return Path(named)
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA", Path.home())) / "clebsch"
    if sys.platform == "darwin":
        return Path.home() / "Library" / "Caches" / "clebsch"
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "clebsch"


@contextlib.contextmanager
def locked(place: Path) -> Iterator[None]:
    """Waits until no other process is in this folder."""
    place.mkdir(parents=True, exist_ok=True)
    with open(place / "lock", "a+b") as file:
        _lock(file.fileno())
        try:
            yield
        finally:
            _unlock(file.fileno())


if sys.platform == "win32":
    import msvcrt
    import time

    def _lock(descriptor: int) -> None:
        while True:
            os.lseek(descriptor, 0, os.SEEK_SET)
            with contextlib.suppress(OSError):
                return msvcrt.locking(descriptor, msvcrt.LK_NBLCK, 1)
            time.sleep(0.1)

    def _unlock(descriptor: int) -> None:
        os.lseek(descriptor, 0, os.SEEK_SET)
        msvcrt.locking(descriptor, msvcrt.LK_UNLCK, 1)

else:
    import fcntl

    def _lock(descriptor: int) -> None:
        fcntl.flock(descriptor, fcntl.LOCK_EX)

    def _unlock(descriptor: int) -> None:
        fcntl.flock(descriptor, fcntl.LOCK_UN)
