"""A sweep on a cluster of two processes has the bits of one process."""

from __future__ import annotations

import os
from pathlib import Path

import clebsch
import numpy as np
from distributed import Client, LocalCluster

#: The moments of a top that is new in each test: its library is built by the workers.
TOP = """
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |F: SO<3>, R: SO<3>| R * F,
    lagrangian     = |omega| omega.dot(&(self.inertia * omega)) / 2 + {0} - {0},
    discretization = moser_veselov,
    potential      = |R| self.weight * R.column(2).z,
)]
pub struct Top {{
    /// Inertia about the pivot, kg·m².
    #[clebsch(symmetric)]
    pub inertia: Matrix3<f64>,
    /// Weight times the distance of the centre of mass, N·m.
    pub weight: f64,
}}
"""

TIMES = np.linspace(0.0, 5.0, 11)


def motion_of(stepper: clebsch.Stepper, start: clebsch.State) -> tuple[int, clebsch.Motion]:
    """What a worker does: steppers and states come by pickle, and so does the motion go."""
    return os.getpid(), stepper.run(start, TIMES)


def end_of(state: clebsch.State) -> clebsch.State:
    return state.stepper.advance(state, 100)


def compiled(text: str) -> tuple[int, str]:
    """Compiles in a worker, by the text alone."""
    return os.getpid(), clebsch.compile(text).name


def test_a_sweep_on_two_processes_has_the_bits_of_one(tmp_path: Path) -> None:
    text = TOP.format(os.getpid())
    with (
        LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None) as cluster,
        Client(cluster) as client,
    ):
        workers = list(client.scheduler_info()["workers"])
        # both at once, before this process has the library: one builds it, the other waits
        asked = [client.submit(compiled, text, workers=[worker], pure=False) for worker in workers]
        found = client.gather(asked)
        assert [name for _, name in found] == ["Top", "Top"]
        assert len({process for process, _ in found} - {os.getpid()}) == 2

        Top = clebsch.compile(text)
        steppers = [Top(inertia=np.diag([1, 1, 0.5]), weight=weight).stepper(0.01) for weight in np.linspace(0, 2, 12)]
        starts = [stepper.state(np.eye(3), [0.1, 0.2, 3.0]) for stepper in steppers]
        there = client.gather(
            [
                client.submit(motion_of, stepper, start, workers=[workers[k % 2]])
                for k, (stepper, start) in enumerate(zip(steppers, starts, strict=True))
            ]
        )
        ends = client.gather(client.map(end_of, [motion.end for _, motion in there]))
    assert len({process for process, _ in there}) == 2
    here = clebsch.Ensemble(steppers, starts).run(TIMES)
    for body, (_, motion) in enumerate(there):
        assert motion.array.tobytes() == here.array[body].tobytes()
        assert motion.end == here.ends[body]
        assert ends[body] == steppers[body].advance(here.ends[body], 100)
