"""The toolchain of Rust that is installed."""

from __future__ import annotations

import functools
import hashlib
import os
import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path

from .errors import ToolchainError

#: The oldest Rust that builds clebsch.
OLDEST = (1, 89)

INSTALL = "install Rust from https://rustup.rs, or name cargo by the variable CARGO"


@dataclass(frozen=True)
class Toolchain:
    """Cargo, and what its libraries depend on."""

    cargo: str
    #: The version of rustc and its host, in its own words.
    version: str
    #: Flags of the user for the compiler.
    flags: str

    @property
    def key(self) -> str:
        """A short name for libraries that are the same."""
        return hashlib.sha256(f"{self.version}\n{self.flags}".encode()).hexdigest()[:16]


def installed() -> Toolchain:
    """The toolchain that is installed."""
    flags = os.environ.get("CARGO_ENCODED_RUSTFLAGS") or os.environ.get("RUSTFLAGS", "")
    return _installed(_cargo(), flags)


@functools.lru_cache(maxsize=8)
def _installed(cargo: str, flags: str) -> Toolchain:
    version = _answer([_rustc(cargo), "-vV"])
    release = next((line.split()[1] for line in version.splitlines() if line.startswith("release:")), "0.0.0")
    major, minor = (int(part) for part in release.split(".")[:2])
    if (major, minor) < OLDEST:
        raise ToolchainError(f"Rust {release} is installed, and {OLDEST[0]}.{OLDEST[1]} is needed: run `rustup update`")
    return Toolchain(cargo, version, flags)


def _cargo() -> str:
    named = os.environ.get("CARGO")
    found = shutil.which(named) if named else shutil.which("cargo") or shutil.which(Path.home() / ".cargo" / "bin" / "cargo")
    if found is None:
        where = f"there is no `{named}`, which CARGO names" if named else "cargo was not found"
        raise ToolchainError(f"{where}: {INSTALL}")
    return str(found)


def _rustc(cargo: str) -> str:
    named = os.environ.get("RUSTC")
    beside = shutil.which("rustc", path=str(Path(cargo).parent))
    return named or beside or "rustc"


def _answer(command: list[str]) -> str:
    try:
        return subprocess.run(command, check=True, capture_output=True, text=True).stdout
    except (OSError, subprocess.CalledProcessError) as error:
        said = getattr(error, "stderr", None) or str(error)
        raise ToolchainError(f"`{' '.join(command)}` failed: {said.strip()}\n{INSTALL}") from error
