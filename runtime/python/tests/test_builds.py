"""Libraries are built once, without a network, and found again."""

from __future__ import annotations

import os
import shutil
import stat
import subprocess
import sys
from pathlib import Path

import clebsch
import pytest
from clebsch import _build, _toolchain

#: A process that compiles a declaration of this mass, and prints the time of the library.
COMPILES = """
import sys, clebsch
Particle = clebsch.compile('''
#[derive(Clebsch, Clone, Debug)]
#[clebsch(action = |a: Translation<1>, x: Vector1| x + a, cost = |h, a| {} * a.norm_squared() / (2 * h))]
pub struct Particle;
'''.replace("{}", sys.argv[1]))
stepper = Particle().stepper(0.5)
print(float(stepper.run(stepper.state([0.0], [6.0]), [1.0])["x"][0, 0]))
"""


@pytest.fixture
def counted_cargo(tmp_path: Path) -> tuple[dict[str, str], Path]:
    """An environment whose cargo writes a line for each of its runs, without a network."""
    count, cargo = tmp_path / "runs", tmp_path / "cargo"
    cargo.write_text(f'#!/bin/sh\necho run >>"{count}"\nexec "{shutil.which("cargo")}" "$@"\n', encoding="utf-8")
    cargo.chmod(cargo.stat().st_mode | stat.S_IXUSR)
    return {**os.environ, "CARGO": str(cargo), "CARGO_NET_OFFLINE": "true"}, count


def test_processes_at_once_build_a_library_once(counted_cargo: tuple[dict[str, str], Path]) -> None:
    """The mass is new in each test, so that the library is not there yet."""
    environment, count = counted_cargo
    mass = f"{os.getpid()} / {os.getpid()}"
    command = [sys.executable, "-c", COMPILES, mass]
    processes = [subprocess.Popen(command, env=environment, stdout=subprocess.PIPE, text=True) for _ in range(3)]
    assert [process.communicate()[0].strip() for process in processes] == ["6.0"] * 3
    assert count.read_text(encoding="utf-8").split() == ["run"]


def test_a_missing_or_old_toolchain_is_told(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("CARGO", str(tmp_path / "cargo"))
    with pytest.raises(clebsch.ToolchainError, match="which CARGO names: install Rust from"):
        _toolchain.installed()
    for name, text in [("cargo", ""), ("rustc", "echo 'rustc 1.70.0'; echo 'release: 1.70.0'")]:
        (tmp_path / name).write_text(f"#!/bin/sh\n{text}\n", encoding="utf-8")
        (tmp_path / name).chmod(0o755)
    with pytest.raises(clebsch.ToolchainError, match=r"Rust 1\.70\.0 is installed, and 1\.89 is needed"):
        _toolchain.installed()
    monkeypatch.delenv("CARGO")
    monkeypatch.setenv("PATH", "")
    monkeypatch.setenv("HOME", str(tmp_path))
    with pytest.raises(clebsch.ToolchainError, match="cargo was not found: install Rust from"):
        _toolchain.installed()


def test_a_failure_of_cargo_is_no_mistake_of_the_declaration(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    cargo = tmp_path / "cargo"
    cargo.write_text("#!/bin/sh\necho 'the disk is full' >&2\nexit 101\n", encoding="utf-8")
    cargo.chmod(0o755)
    (tmp_path / "rustc").symlink_to(str(shutil.which("rustc")))
    monkeypatch.setenv("CARGO", str(cargo))
    monkeypatch.setenv("CLEBSCH_CACHE", str(tmp_path / "cache"))
    source = _build.Source("struct Nothing;", "Nothing", "Nothing", (), (), "")
    with pytest.raises(clebsch.ToolchainError, match="cargo failed:\nthe disk is full"):
        _build.library(source)
