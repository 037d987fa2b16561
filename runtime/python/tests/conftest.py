"""Declarations that several tests share: each is built once."""

from __future__ import annotations

import os
from pathlib import Path

import clebsch
import pytest

REPOSITORY = Path(__file__).resolve().parents[3]

PROBE = """
/// A probe with thrusters and wheels, pulled to a place that moves.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |(a, F): (Translation<3>, SU<2>), (x, Q): (Vector3, SU<2>)| (x + a, Q * F),
    lagrangian = |(v, omega)| (self.mass * v.norm_squared() + omega.dot(&self.moments.component_mul(&omega))) / 2,
    potential  = |t, (x, Q)| self.stiffness * (x - t * self.drift).norm_squared() / 2,
    force      = |(v, omega), (thrust, torque): (Vector3, Vector3)| (thrust, torque),
)]
struct Probe<T: Scalar> {
    mass: T,
    moments: Vector3<T>,
    stiffness: T,
    drift: Vector3<T>,
}
"""


def fixture_text(name: str) -> str:
    """The text of an accepted declaration of the repository's tests."""
    return (REPOSITORY / "tests" / "fixtures" / "accept" / f"{name}.rs").read_text(encoding="utf-8")


def reference(name: str) -> Path:
    """A file that a program in Rust has written, which `check` runs."""
    folder = os.environ.get("CLEBSCH_REFERENCES")
    if folder is None:
        pytest.skip("runtime/python/check makes the references")
    return Path(folder) / name


@pytest.fixture(scope="session")
def heavy_top() -> clebsch.Declaration:
    return clebsch.compile(fixture_text("heavy_top"))


@pytest.fixture(scope="session")
def probe() -> clebsch.Declaration:
    return clebsch.compile(PROBE, scalar="f32")


@pytest.fixture(scope="session")
def three_ways() -> clebsch.Declaration:
    return clebsch.compile(fixture_text("three_ways"))


@pytest.fixture(scope="session")
def spin_chain() -> clebsch.Declaration:
    return clebsch.compile(fixture_text("spin_chain"), constants={"N": 5})
