"""Libraries of declarations as modules of Python."""

from __future__ import annotations

import importlib.util
import sys
import threading
from importlib.machinery import ExtensionFileLoader
from pathlib import Path
from types import ModuleType

_lock = threading.Lock()
_loaded: dict[Path, ModuleType] = {}


def module(path: Path) -> ModuleType:
    """The module of a library, loaded once in each process."""
    with _lock:
        if path not in _loaded:
            _loaded[path] = _load(path)
        return _loaded[path]


def _load(path: Path) -> ModuleType:
    name = f"clebsch_library_{path.parent.name}.declaration"
    loader = ExtensionFileLoader(name, str(path))
    spec = importlib.util.spec_from_file_location(name, path, loader=loader)
    # by construction: a loader makes a spec
    assert spec is not None
    made = importlib.util.module_from_spec(spec)
    sys.modules[name] = made
    loader.exec_module(made)
    return made
