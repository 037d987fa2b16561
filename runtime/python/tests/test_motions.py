"""Steps, runs and states: against programs in Rust, closed forms, and each other."""

from __future__ import annotations

import pickle
import signal
import time

import clebsch
import numpy as np
import pytest
from conftest import reference

MASS_MATRIX = [[0.5, 0.125, 0], [0.125, 0.75, 0], [0, 0, 0.25]]


@pytest.fixture(scope="module")
def stepper(heavy_top: clebsch.Declaration) -> clebsch.Stepper:
    return heavy_top(mass_matrix=MASS_MATRIX, weight=2.0, center=[0, 0.25, 1]).stepper(0.015625)


@pytest.fixture
def start(stepper: clebsch.Stepper) -> clebsch.State:
    return stepper.state(np.eye(3), [0.5, 0.25, 2.0])


def test_motions_have_the_bits_of_rust(stepper, start, probe) -> None:
    """The program of the package for C makes the same two runs in Rust."""
    state = start
    for _ in range(100):
        state = stepper.step(state)
    state = stepper.step(stepper.kick(stepper.advance(state, 900), [0.125, 0.0, -0.5]))
    top = np.concatenate([state["R"].ravel(), state.momentum, [stepper.energy(state)]])

    moving = probe(mass=2, moments=[1, 1.5, 2], stiffness=8, drift=[0.25, 0, 0]).stepper(0.0625)
    state = moving.state(t=0.5, x=[0.5, 0, 0.25], Q=[0, 0, 1, 0], N=[0, 1, 0, 0.5, 0.25, 0.125])
    for _ in range(200):
        state = moving.step(state, [0.25, 0, 0, 0, 0, 0.125])
    numbers = [[state.t], *state.configuration, state.momentum]
    of_probe = np.concatenate(numbers).astype(np.float32)
    found = [f"{bits:016x}" for bits in top.view(np.uint64)] + [f"{bits:08x}" for bits in of_probe.view(np.uint32)]
    # between the two that program steps the top by a method too
    there = reference("reference.txt").read_text(encoding="utf-8").split()
    assert found == there[:13] + there[-len(of_probe) :]


def test_a_run_has_the_states_of_its_steps(stepper, start) -> None:
    times = np.arange(51) * stepper.step_size
    motion = stepper.run(start, times)
    state, states = start, [start]
    for _ in range(50):
        state = stepper.step(state)
        states.append(state)
    assert np.array_equal(motion["R"], [state["R"] for state in states])
    assert np.array_equal(motion["N"], [state.momentum for state in states])
    assert np.array_equal(motion.energy, [stepper.energy(state) for state in states])
    assert (motion.t == times).all()
    assert motion.end == state == stepper.advance(start, 50)
    assert len(motion) == 51
    assert motion.names == ("t", "R", "N", "energy", "about e3, spatial")


def test_long_ways_between_times_change_no_bit(stepper, start) -> None:
    """A run looks for interrupts between two times that are far apart."""
    far = stepper.run(start, [0.3, 20_000 * stepper.step_size])
    assert far.end == stepper.run(start, np.arange(20_001) * stepper.step_size).end


def test_quantities_are_those_of_mechanics(stepper, start) -> None:
    """Energy from its definition, vertical momentum (R N)_3, and both along a run."""
    motion = stepper.run(start, np.linspace(0, 50, 301))
    inertia = np.trace(MASS_MATRIX) * np.eye(3) - np.array(MASS_MATRIX)
    velocity = np.linalg.solve(inertia, motion["N"].T).T
    height = motion["R"][:, 2] @ np.array([0, 0.25, 1])
    energy = np.einsum("ni,ni->n", motion["N"], velocity) / 2 + 2 * height
    assert np.abs(motion.energy - energy).max() < 1e-13
    vertical = np.einsum("ni,ni->n", motion["R"][:, 2], motion["N"])
    assert np.abs(motion["about e3, spatial"] - vertical).max() < 1e-15
    assert np.ptp(vertical) < 1e-13
    assert stepper.conserved(start) == {"about e3, spatial": 2.0}


def test_times_are_those_of_the_states(probe) -> None:
    """Free flight of the probe against a spring of no stiffness: x = x0 + v t, from the time of the start on."""
    stepper = probe(mass=2, moments=[1, 1, 1], stiffness=0, drift=[0, 0, 0]).stepper(0.25)
    start = stepper.state(t=3.0, x=[1, 0, 0], Q=[1, 0, 0, 0], N=[4, 0, 0, 0, 0, 0])
    motion = stepper.run(start, [3.0, 3.1, 5.5])
    assert np.allclose(motion["x"][:, 0], [1, 1.2, 6], rtol=1e-6, atol=0)
    assert motion.end.t == 5.5
    with pytest.raises(ValueError, match=r"times\[0\] is 2.0 after 3.0"):
        stepper.run(start, [2.0])


def test_methods_have_dials_of_their_own(three_ways) -> None:
    """The energy of a top, whose motion conserves it: the method of order 6 comes nearest."""
    top = three_ways(moments=[1, 2, 3], weight=1, center=[0, 0, 1])
    drifts = []
    for method in (None, "Fine", "Quick"):
        stepper = top.stepper(0.05, method)
        motion = stepper.run(stepper.state(np.eye(3), [0.3, 1.5, 0.2]), np.arange(101) * 0.05)
        drifts.append(np.ptp(motion.energy))
    assert drifts[1] < 1e-3 * drifts[0] < drifts[2]
    with pytest.raises(ValueError, match="the declaration has no method `Slow`"):
        top.stepper(0.1, "Slow")


def test_sites_by_a_number(spin_chain) -> None:
    """Equal spins without a field stay at rest; without exchange each turns by itself, on a great circle."""
    stepper = spin_chain(exchange=0.0, field=[0, 0, 0]).stepper(0.01)
    q = np.tile([1.0, 0, 0], (5, 1))
    motion = stepper.run(stepper.state(q=q, N=np.tile([0, 0, 1.0], (5, 1))), [1.0])
    angle = np.arctan2(motion["q"][0, :, 1], motion["q"][0, :, 0])
    assert np.ptp(angle) == 0
    assert abs(angle[0] / 2 - 0.5) < 1e-4 or abs(angle[0] - 1) < 1e-4


def test_values_of_other_shapes_are_refused_with_both(heavy_top, stepper, start) -> None:
    for attempt, message in [
        (
            lambda: heavy_top(mass_matrix=np.eye(2), weight=1, center=[0, 0, 1]),
            r"mass_matrix has the shape \(2, 2\), and \(3, 3\)",
        ),
        (lambda: stepper.state(np.eye(3), [1, 2]), r"N has the shape \(2,\), and \(3,\) is needed"),
        (lambda: stepper.state("no", [1, 2, 3]), "R is no array of numbers"),
        (lambda: stepper.kick(start, [1.0]), r"N has the shape \(1,\), and \(3,\)"),
        (lambda: stepper.step(start, [1.0]), r"input has the shape \(1,\), and \(0,\)"),
        (lambda: stepper.run(start, 1.0), r"the times have the shape \(\), and one length is needed"),
    ]:
        with pytest.raises(ValueError, match=message):
            attempt()


def test_names_that_are_missing_or_unknown_are_told(heavy_top, stepper, start) -> None:
    with pytest.raises(TypeError, match="HeavyTop lacks 'center': it is made of 'mass_matrix', 'weight', 'center'"):
        heavy_top(mass_matrix=np.eye(3), weight=1)
    with pytest.raises(TypeError, match="a state of HeavyTop has no 'q'"):
        stepper.state(q=np.eye(3), N=[0, 0, 0])
    with pytest.raises(KeyError, match="the state has no 'q': it has t, R, N, energy"):
        start["q"]


def test_numbers_that_make_no_system_or_state_are_refused(heavy_top, stepper, start) -> None:
    for mass_matrix, step_size, kind in [(MASS_MATRIX, 0.0, "StepSize"), (-np.eye(3), 0.1, "IndefiniteKineticEnergy")]:
        with pytest.raises(clebsch.ParameterError) as parameters:
            heavy_top(mass_matrix=mass_matrix, weight=1, center=[0, 0, 1]).stepper(step_size)
        assert parameters.value.kind == kind
    with pytest.raises(clebsch.StateError, match="reflection instead of a rotation") as refused:
        stepper.state(np.diag([1, 1, -1.0]), [0, 0, 0])
    assert refused.value.kind == "OffOrbit"
    with pytest.raises(clebsch.StateError, match="the impulse"):
        stepper.kick(start, [np.nan, 0, 0])


def test_states_of_others_are_refused(heavy_top, three_ways, stepper, start) -> None:
    """A state has an impulse of its system, and the numbers of its method. Other step sizes may take it."""
    other = heavy_top(mass_matrix=MASS_MATRIX, weight=3.0, center=[0, 0.25, 1]).stepper(0.1)
    for attempt in (other.step, other.energy, lambda state: other.run(state, [0.0])):
        with pytest.raises(ValueError, match=r"weight=2.0.*weight=3.0.*make a state of its configuration"):
            attempt(start)
    with pytest.raises(TypeError, match="a state is needed, and this is list"):
        stepper.step([1.0])
    ways = three_ways(moments=[1, 2, 3], weight=1, center=[0, 0, 1])
    fine = ways.stepper(0.1, "Fine")
    with pytest.raises(TypeError, match="another declaration or to another method"):
        ways.stepper(0.1).step(fine.state(np.eye(3), [1, 2, 3]))
    halved = stepper.system.stepper(stepper.step_size / 2)
    assert halved.step(start) == halved.step(halved.state(np.eye(3), [0.5, 0.25, 2.0]))


def test_times_are_in_order(stepper, start) -> None:
    with pytest.raises(ValueError, match=r"times\[2\] is 0.5 after 1.0, and times increase with steps of 0.015625"):
        stepper.run(start, [0.0, 1.0, 0.5])
    with pytest.raises(ValueError, match=r"times\[1\] is nan"):
        stepper.run(start, [0.0, np.nan])
    back = stepper.system.stepper(-0.015625)
    motion = back.run(back.state(start["R"], start.momentum), [0.0, -1.0])
    with pytest.raises(ValueError, match="times decrease"):
        back.run(start, [0.0, 1.0])
    there = stepper.run(stepper.state(motion.end["R"], motion.end.momentum), [1.0])
    assert np.abs(there["R"][0] - start["R"]).max() < 1e-12


def test_a_step_without_solution_leaves_the_state_before(stepper, start) -> None:
    """A spin of h|ω| far beyond the largest one, after a kick."""
    fast = stepper.kick(start, [0, 0, 1000.0])
    for attempt in (
        lambda: stepper.step(fast),
        lambda: stepper.advance(fast, 10),
        lambda: stepper.run(fast, [0.0, 1.0]),
    ):
        with pytest.raises(clebsch.SolveError, match="too long for this momentum") as stopped:
            attempt()
        assert (stopped.value.kind, stopped.value.state) == ("Unsolvable", fast)
    assert stopped.value.done == 1
    assert pickle.loads(pickle.dumps(stopped.value)).state == fast


def test_states_near_numbers_are_found(spin_chain) -> None:
    """The momentum of a point on a sphere has no component along it."""
    stepper = spin_chain(exchange=1.0, field=[0, 0, 1.0]).stepper(0.01)
    q, momenta = np.tile([0, 0, 1.0], (5, 1)), np.tile([0.5, 0, 2.0], (5, 1))
    with pytest.raises(clebsch.StateError) as refused:
        stepper.state(q=q, N=momenta)
    assert refused.value.kind == "OutsideMomentumSpace"
    assert (stepper.project(q=q, N=momenta).momentum == np.tile([0.5, 0, 0], (5, 1))).all()


def test_everything_pickles_and_goes_on_bit_for_bit(stepper, start, probe) -> None:
    middle = stepper.advance(start, 100)
    again = pickle.loads(pickle.dumps(middle))
    assert again == middle
    assert again.stepper.system == stepper.system
    assert again.stepper.step_size == stepper.step_size
    assert again.stepper.advance(again, 100) == stepper.advance(middle, 100)
    moving = probe(mass=2, moments=[1, 1.5, 2], stiffness=8, drift=[0.25, 0, 0]).stepper(0.1)
    state = moving.advance(moving.state(t=0.3, x=[0, 0, 1], Q=[1, 0, 0, 0], N=[0, 1, 0, 1, 0, 0]), 33)
    other = pickle.loads(pickle.dumps(state))
    assert other.t == state.t
    assert moving.advance(other, 33) == moving.advance(state, 33)
    with pytest.raises(ValueError, match="no saved state of this system"):
        stepper._native.resume(b"nonsense")


def test_ensembles_have_the_bits_of_each_body(heavy_top, stepper) -> None:
    times = np.linspace(0, 2, 9)
    tops = [heavy_top(mass_matrix=MASS_MATRIX, weight=w, center=[0, 0.25, 1]).stepper(0.01) for w in np.linspace(0, 2, 16)]
    starts = [top.state(np.eye(3), [0.5, 0.25, 2.0 + k]) for k, top in enumerate(tops)]
    ensemble = clebsch.Ensemble(tops, starts)
    together = ensemble.run(times, threads=4)
    assert together["R"].shape == (16, 9, 3, 3)
    assert together == ensemble.run(times, threads=1)
    for body, (top, start) in enumerate(zip(tops, starts, strict=True)):
        alone = top.run(start, times)
        assert together.array[body].tobytes() == alone.array.tobytes()
        assert together.ends[body] == alone.end


def test_long_runs_end_at_an_interrupt(stepper, start) -> None:
    """The handler of the user decides, as anywhere in Python."""

    class Enough(Exception):
        pass

    def stop(*_: object) -> None:
        raise Enough

    before = signal.signal(signal.SIGALRM, stop)
    try:
        for run in (
            lambda: stepper.advance(start, 10**12),
            lambda: stepper.run(start, [1e9]),
            lambda: clebsch.Ensemble(stepper, [start] * 4).run([1e9], threads=2),
        ):
            signal.setitimer(signal.ITIMER_REAL, 0.2)
            began = time.monotonic()
            with pytest.raises(Enough):
                run()
            assert time.monotonic() - began < 10
    finally:
        signal.signal(signal.SIGALRM, before)


def test_an_ensemble_names_the_body_that_fails(stepper, start) -> None:
    fast = stepper.kick(start, [0, 0, 1000.0])
    with pytest.raises(clebsch.SolveError) as stopped:
        clebsch.Ensemble(stepper, [start, fast, start]).run([0.0, 1.0])
    assert (stopped.value.body, stopped.value.state) == (1, fast)
    with pytest.raises(ValueError, match="there are 1 steppers and 2 starts"):
        clebsch.Ensemble([stepper], [start, start])
    with pytest.raises(ValueError, match="no bodies"):
        clebsch.Ensemble(stepper, []).run([0.0])
