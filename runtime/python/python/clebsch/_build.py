"""From a declaration to its library, by cargo and without a network."""

from __future__ import annotations

import hashlib
import json
import logging
import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from . import _cache, _toolchain
from ._diagnostics import Mistake, error_of
from ._toolchain import Toolchain
from .errors import ToolchainError

SOURCES = Path(__file__).parent / "sources"

#: In front of the text of the user, in one line. What the user imports by name goes before it.
PRELUDE = "#[allow(unused_imports)] use clebsch_module::prelude::*;\n"

#: On macOS the names of Python are found when the library is loaded.
LINK = ["--", "-C", "link-arg=-undefined", "-C", "link-arg=dynamic_lookup"] if sys.platform == "darwin" else []

log = logging.getLogger("clebsch")


@dataclass(frozen=True)
class Source:
    """A declaration as it is built."""

    #: The text of the user.
    text: str
    #: The name of the struct with its parameters, such as `SpinChain<8>`.
    system: str
    #: The name of the struct.
    name: str
    #: The fields with their types.
    fields: tuple[tuple[str, str], ...]
    #: The methods besides that of the declared dials.
    methods: tuple[str, ...]
    #: What the parameters of the struct are, as items of Rust.
    generics: str

    def code(self) -> str:
        """The crate: the text from its second line on, and the line that makes the module of Python."""
        fields = ", ".join(f"{name}: {type}" for name, type in self.fields)
        parts = f"{self.system}, {self.name} {{ {fields} }}, [{', '.join(self.methods)}], {{ {self.generics} }}"
        return f"{PRELUDE}{self.text}\nclebsch_module::library!({parts});\n"

    def key(self, toolchain: Toolchain) -> str:
        """A name for the library: that of everything that it is made from."""
        parts = "\0".join([digest(), toolchain.key, self.code()])
        return hashlib.sha256(parts.encode()).hexdigest()[:32]


def digest() -> str:
    """The name of the sources."""
    try:
        return (SOURCES / "DIGEST").read_text(encoding="utf-8").strip()
    except OSError as error:
        raise ToolchainError("the package has no sources: build it in the folder that `runtime/python/assemble` makes") from error


def library(source: Source) -> Path:
    """The library of a declaration: that of the cache, or a new one."""
    toolchain = _toolchain.installed()
    workshop = _cache.folder() / digest() / toolchain.key
    found = workshop / "libraries" / source.key(toolchain) / "declaration.abi3.so"
    if not found.exists():
        with _cache.locked(workshop):
            # another process may have built it in the meantime
            if not found.exists():
                _put(_built(source, toolchain, workshop), found)
    return found


def _put(built: Path, place: Path) -> None:
    """A copy that is there as a whole, or not at all."""
    place.parent.mkdir(parents=True, exist_ok=True)
    part = place.with_suffix(".part")
    shutil.copyfile(built, part)
    os.replace(part, place)


def _built(source: Source, toolchain: Toolchain, workshop: Path) -> Path:
    crate = _crate(source, workshop)
    if not (workshop / "target").exists():
        log.warning("building the crates that all declarations need, once for each toolchain: this takes a minute or two")
    command = [toolchain.cargo, "rustc", "--release", "--offline", "--locked", "--message-format=json", *LINK]
    # the library is the same for every Python: none is asked, and none is linked
    of_pyo3 = {"PYO3_NO_PYTHON": "1", "PYO3_BUILD_EXTENSION_MODULE": "1"}
    environment = {**os.environ, **of_pyo3, "CARGO_TARGET_DIR": str(workshop / "target")}
    # cargo asks for settings of its own where a build of cargo has started Python
    environment.pop("CARGO_BUILD_TARGET", None)
    try:
        done = subprocess.run(command, cwd=crate, env=environment, capture_output=True, text=True, encoding="utf-8")
    except OSError as error:
        raise ToolchainError(f"`{toolchain.cargo}` failed: {error}") from error
    messages = list(_messages(done.stdout))
    mistakes = [mistake for message in messages for mistake in _mistakes(message)]
    if mistakes:
        raise error_of(mistakes, source.text)
    built = [Path(name) for message in messages for name in _files(message)]
    if done.returncode != 0 or not built:
        raise ToolchainError(f"cargo failed:\n{_said(messages)}{done.stderr.strip()}")
    return built[-1]


def _crate(source: Source, workshop: Path) -> Path:
    """The crate of a declaration, and where cargo finds what it depends on."""
    crate = workshop / "declaration"
    (crate / "src").mkdir(parents=True, exist_ok=True)
    (crate / ".cargo").mkdir(exist_ok=True)
    template = SOURCES / "runtime" / "python" / "template"
    manifest = (template / "Cargo.toml").read_text(encoding="utf-8").replace("SOURCES", SOURCES.as_posix())
    vendored = json.dumps(str(SOURCES / "vendor"))
    replaced = '[source.crates-io]\nreplace-with = "vendored"\n\n'
    _write(crate / "Cargo.toml", manifest)
    _write(crate / "Cargo.lock", (template / "Cargo.lock").read_text(encoding="utf-8"))
    _write(crate / ".cargo" / "config.toml", f"{replaced}[source.vendored]\ndirectory = {vendored}\n")
    (crate / "src" / "lib.rs").write_text(source.code(), encoding="utf-8", newline="\n")
    return crate


def _write(path: Path, text: str) -> None:
    """Writes a file that is another one: the time of one that stays says nothing new to cargo."""
    if not path.exists() or path.read_text(encoding="utf-8") != text:
        path.write_text(text, encoding="utf-8", newline="\n")


def _messages(output: str) -> Iterator[dict[str, Any]]:
    for line in output.splitlines():
        if line.startswith("{"):
            yield json.loads(line)


def _is_of_declaration(message: dict[str, Any]) -> bool:
    return bool(message.get("target", {}).get("name") == "declaration")


def _files(message: dict[str, Any]) -> list[str]:
    is_library = message["reason"] == "compiler-artifact" and _is_of_declaration(message)
    return [name for name in message["filenames"] if not name.endswith((".lib", ".pdb", ".exp"))] if is_library else []


def _mistakes(message: dict[str, Any]) -> list[Mistake]:
    """The errors of rustc in the text of the user: its first line is the second one of the file."""
    if message["reason"] != "compiler-message" or not _is_of_declaration(message):
        return []
    said = message["message"]
    if said["level"] != "error" or not said["spans"]:
        return []
    span = _of_text(next((span for span in said["spans"] if span["is_primary"]), said["spans"][0]))
    more = [f"{child['level']}: {child['message']}" for child in said["children"]]
    start = (span["line_start"] - 1, span["column_start"] - 1)
    return [Mistake("\n".join([said["message"], *more]), start, (span["line_end"] - 1, span["column_end"] - 1))]


def _of_text(span: dict[str, Any]) -> dict[str, Any]:
    """The place in the text that a macro was called from."""
    while span.get("expansion") and Path(span["file_name"]).name != "lib.rs":
        span = span["expansion"]["span"]
    return span


def _said(messages: list[dict[str, Any]]) -> str:
    said = [message["message"] for message in messages if message["reason"] == "compiler-message"]
    return "".join(one.get("rendered") or "" for one in said if one["level"] == "error")
