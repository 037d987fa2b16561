"""Takes the files that no build reads out of a folder of vendored crates.

`prune.py FOLDER` reads the crates that are built, one `name vVERSION` a line. The lock names others too, which features that are off would
need: of these cargo reads the manifest alone.
"""

import json
import shutil
import sys
from pathlib import Path

UNUSED = ("tests", "benches", "examples", "ci", "pytests", "newsfragments", ".github", "emscripten", "assets")


def empty(crate: Path) -> None:
    """Leaves the manifest of a crate, with a library without code."""
    for entry in crate.iterdir():
        if entry.is_dir():
            shutil.rmtree(entry)
        elif entry.name not in ("Cargo.toml", ".cargo-checksum.json"):
            entry.unlink()
    (crate / "src").mkdir()
    (crate / "src" / "lib.rs").touch()


def prune(crate: Path, is_built: bool) -> None:
    """Takes the files out of one crate, and out of the list of its checksums."""
    if not is_built:
        empty(crate)
    for name in UNUSED:
        shutil.rmtree(crate / name, ignore_errors=True)
    listed = crate / ".cargo-checksum.json"
    checksums = json.loads(listed.read_text(encoding="utf-8"))
    checksums["files"] = {name: sum for name, sum in checksums["files"].items() if is_built and (crate / name).is_file()}
    listed.write_text(json.dumps(checksums), encoding="utf-8")


built = {"-".join((name, version[1:])) for name, version, *_ in map(str.split, sys.stdin)}
for folder in sorted(Path(sys.argv[1]).iterdir()):
    prune(folder, folder.name in built)
