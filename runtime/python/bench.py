"""Times of builds, and of steps in Python and in Rust.

After `runtime/python/check`: `target/python/environment/bin/python runtime/python/bench.py`.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import clebsch
import numpy as np

HERE = Path(__file__).resolve().parent
TOP = (HERE.parents[1] / "tests" / "fixtures" / "accept" / "heavy_top.rs").read_text(encoding="utf-8")
STEPS = 100_000


def seconds(work: Callable[[], object], times: int = 1) -> float:
    """The least time of so many runs."""
    least = float("inf")
    for _ in range(times):
        start = time.perf_counter()
        work()
        least = min(least, time.perf_counter() - start)
    return least


def builds() -> None:
    """Builds in an empty cache."""
    print(f"mistakes of a declaration: {1e3 * seconds(lambda: clebsch.check(TOP), 5):.1f} ms")
    with tempfile.TemporaryDirectory() as cache:
        os.environ["CLEBSCH_CACHE"] = cache
        print(f"the first library: {seconds(lambda: clebsch.compile(TOP)):.0f} s")
        other = TOP.replace("HeavyTop", "OtherTop")
        print(f"another library: {seconds(lambda: clebsch.compile(other)):.1f} s")
        again = [sys.executable, "-c", "import sys, time, clebsch; t = time.perf_counter(); clebsch.compile(sys.argv[1]); "]
        again[-1] += "print(f'a library of the cache, in a new process: {1e3 * (time.perf_counter() - t):.0f} ms')"
        subprocess.run([*again, TOP], check=True)


def steps() -> None:
    """Steps of a library that is built."""
    top = clebsch.compile(TOP)(mass_matrix=np.diag([0.25, 0.25, 1.0]), weight=1.0, center=[0, 0, 1])
    stepper = top.stepper(0.01)
    start = stepper.state(R=np.eye(3), N=[0.1, 0, 3.2])
    times = 0.01 * np.arange(STEPS)

    def one_by_one() -> None:
        state = start
        for _ in range(STEPS):
            state = stepper.step(state)

    for name, work in [
        ("Python, advance", lambda: stepper.advance(start, STEPS)),
        ("Python, run with rows", lambda: stepper.run(start, times)),
        ("Python, step by step", one_by_one),
    ]:
        print(f"{name}: {1e9 * seconds(work, 5) / STEPS:.0f} ns a step", flush=True)
    environment = {**os.environ, "PYO3_NO_PYTHON": "1", "PYO3_BUILD_EXTENSION_MODULE": "1"}
    command = ["cargo", "run", "--quiet", "--release", "--package", "clebsch-module", "--example", "steps"]
    subprocess.run(command, check=True, cwd=HERE, env=environment)


if __name__ == "__main__":
    builds()
    steps()
