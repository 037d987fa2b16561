"""Random plans by CasADi, with its solvers fatrop and IPOPT.

    cargo bench -p clebsch-tests --bench control -- cases $PWD/cases.jsonl
    python tests/peers/plans.py cases.jsonl fatrop fatrop.jsonl [--compiled]
    cargo bench -p clebsch-tests --bench control -- compare $PWD/cases.jsonl $PWD/fatrop.jsonl

    cargo bench -p clebsch-tests --bench control -- gusts $PWD/gusts.jsonl
    python tests/peers/plans.py gusts.jsonl fatrop flown.jsonl [--compiled]
    cargo bench -p clebsch-tests --bench control -- compare $PWD/gusts.jsonl $PWD/flown.jsonl

The discrete problems are those of clebsch, with the same minima. Attitudes are quaternions here, and the inputs are the increments of a step.
The forces follow from them, so that no step is implicit. The guess is an interpolated path. Needs `pip install casadi numpy`, and a C compiler
for `--compiled`.
"""

import argparse
import json
import time

import casadi as ca
import numpy as np


def product(a, b):
    """The product of two quaternions."""
    return ca.vertcat(
        a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
        a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
        a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
        a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
    )


def matrix(q):
    """The rotation of a unit quaternion."""
    w, x, y, z = q[0], q[1], q[2], q[3]
    return ca.vertcat(
        ca.horzcat(1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
        ca.horzcat(2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
        ca.horzcat(2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)),
    )


def exp(v):
    """The unit quaternion of a rotation vector."""
    angle = np.linalg.norm(v)
    return np.r_[np.cos(angle / 2), np.sin(angle / 2) / angle * np.asarray(v) if angle > 1e-14 else np.zeros(3)]


def between(a, b):
    """The rotation vector from one unit quaternion to another."""
    q = np.array(product(ca.DM(np.r_[a[0], -a[1:]]), ca.DM(b))).ravel()
    q = q if q[0] >= 0 else -q
    length = np.linalg.norm(q[1:])
    return 2 * np.arctan2(length, q[0]) * q[1:] / length if length > 1e-14 else np.zeros(3)


def turned(q, v):
    return np.array(product(ca.DM(q), ca.DM(exp(v)))).ravel()


def apart(a, b):
    """What vanishes where two attitudes are the same."""
    return product(ca.vertcat(a[0], -a[1:]), b)[1:]


class Problem:
    """x⁺ and the price of a step, with bounds of functions of it, and conditions of the end."""

    def __init__(self, sizes, steps, step, end, inputs=None, bounds=None):
        states, controls = sizes
        x, u, goal = ca.SX.sym("x", states), ca.SX.sym("u", controls), ca.SX.sym("goal", states)
        self.states, self.controls, self.steps = states, controls, steps
        self.step = ca.Function("step", [x, u], list(step(x, u)))
        self.end = ca.Function("end", [x, goal], [end(x, goal)])
        self.inputs = inputs or (np.full(controls, -np.inf), np.full(controls, np.inf))
        self.bounds = bounds

    def solver(self, name, tolerance, compiled):
        """x0 u0 x1 u1 … xN, with the equations of a stage behind each other, as fatrop wants them."""
        kind = ca.MX if compiled else ca.SX
        ends = kind.sym("ends", 2 * self.states)
        x = kind.sym("x0", self.states)
        free = np.full(self.states, np.inf)
        unknowns, equations, equal, low, high = [], [], [], [], []
        self.lowest, self.highest, price = [], [], 0

        def add(values, least, most):
            equations.append(values)
            equal.extend([bool(a == b) for a, b in zip(least, most)])
            low.append(least)
            high.append(most)

        nothing = np.zeros(self.states)
        for k in range(self.steps):
            u, following = kind.sym(f"u{k}", self.controls), kind.sym(f"x{k + 1}", self.states)
            reached, cost, bounded = self.step(x, u)
            price += cost
            unknowns += [x, u]
            self.lowest += [-free, self.inputs[0]]
            self.highest += [free, self.inputs[1]]
            add(following - reached, nothing, nothing)
            if k == 0:
                add(x - ends[: self.states], nothing, nothing)
            if self.bounds:
                add(bounded, *self.bounds)
            x = following
        unknowns.append(x)
        self.lowest.append(-free)
        self.highest.append(free)
        left = self.end(x, ends[self.states :])
        add(left, np.zeros(left.shape[0]), np.zeros(left.shape[0]))
        self.lowest, self.highest, self.low, self.high = map(np.concatenate, (self.lowest, self.highest, low, high))
        options = {"print_time": False, "error_on_fail": False}
        if compiled:
            flags = {"flags": ["-O1", "-march=native"], "verbose": False}
            options |= {"jit": True, "compiler": "shell", "jit_options": flags}
        if name == "fatrop":
            options |= {"structure_detection": "auto", "equality": equal, "fatrop.print_level": 0}
            options |= {"fatrop.tol": tolerance, "fatrop.max_iter": 1000}
        else:
            options |= {"ipopt.print_level": 0, "ipopt.sb": "yes", "ipopt.tol": tolerance}
            options |= {"ipopt.max_iter": 1000, "ipopt.bound_relax_factor": 0.0}
        unknowns, equations = ca.vertcat(*unknowns), ca.vertcat(*equations)
        return ca.nlpsol("plan", name, {"x": unknowns, "f": price, "g": equations, "p": ends}, options)

    def packed(self, places, inputs):
        return np.concatenate([np.r_[x, u] for x, u in zip(places, inputs)] + [places[self.steps]])


def unicycle(top=7.0, steps=50, h=0.02):
    """Exact steps on SE(2): heading, x, y."""

    def sinc(x):
        y = x * x
        return 1 - y / 6 * (1 - y / 20 * (1 - y / 42 * (1 - y / 72)))

    def step(x, u):
        half = h * u[0] / 2
        chord = h * u[1] * sinc(half)
        place = ca.vertcat(x[0] + h * u[0], x[1] + chord * ca.cos(x[0] + half), x[2] + chord * ca.sin(x[0] + half))
        return place, h * (u[0] ** 2 + u[1] ** 2) / 2, ca.SX(0, 1)

    problem = Problem((3, 2), steps, step, lambda x, goal: x - goal, inputs=(np.array([-top, 0]), np.array([top, np.inf])))

    def posed(case):
        start, goal = np.zeros(3), np.array(case)
        guess = np.tile([goal[0], np.hypot(*goal[1:])], (steps, 1))
        return start, goal, problem.packed(np.linspace(start, goal, steps + 1), guess)

    return problem, posed, 1e-10


def body(moments=(1.0, 2.0, 3.0), top=16.0, steps=50, h=0.02):
    """Steps by Cayley's map on SO(3): attitude and momentum. The input is the velocity of a step."""
    moments = np.array(moments)

    def step(x, u):
        q, momentum, c = x[:4], x[4:], h / 2 * u
        along, across, square = moments * c, ca.cross(c, moments * c), ca.dot(c, moments * c)
        torque = 2 / h * (2 / h * (along + across + square * c) - momentum)
        after = 2 / h * (along - across + square * c) + h / 2 * torque
        turn = ca.vertcat(1, c) / ca.sqrt(1 + ca.dot(c, c))
        return ca.vertcat(product(q, turn), after), h * ca.dot(torque, torque) / 2, torque

    end = lambda x, goal: ca.vertcat(apart(goal[:4], x[:4]), x[4:] - goal[4:])
    problem = Problem((7, 3), steps, step, end, bounds=(np.full(3, -top), np.full(3, top)))

    def posed(case):
        start, goal = np.r_[1, 0, 0, 0, case[3:6]], np.r_[exp(case[:3]), case[6:9]]
        rate = between(start[:4], goal[:4]) / (steps * h)
        places = [np.r_[turned(start[:4], rate * h * k), moments * rate] for k in range(steps + 1)]
        return start, goal, problem.packed(places, np.tile(rate, (steps, 1)))

    return problem, posed, 1e-10


def quadrotor(steps=100, h=0.01):
    """Steps of Moser and Veselov on SE(3): attitude, position, rates and velocity of the body. The input is the velocity of a step, and thrust."""
    inertia = 1e-6 * np.array([[16.571710, 0.830806, 0.718277], [0.830806, 16.655602, 1.800197], [0.718277, 1.800197, 29.261652]])
    mass, gravity, arm, drag, top = 0.028, 9.81, 0.046 / np.sqrt(2), 0.005964552, 0.1597
    hover = mass * gravity / 4
    mixed = np.array([[-arm, -arm, arm, arm], [-arm, arm, arm, -arm], [-drag, drag, -drag, drag], [1, 1, 1, 1]])
    thrusts_of, inverse, up = np.linalg.inv(mixed), np.linalg.inv(inertia), ca.vertcat(0, 0, 1)

    def step(x, u):
        q, place, rate, velocity, c = x[:4], x[4:7], x[7:10], x[10:13], h / 2 * u[:3]
        along, square = ca.mtimes(inertia, c), 1 + ca.dot(c, c)
        across, turn = ca.cross(c, along), ca.vertcat(1, c) / ca.sqrt(square)
        torque = 2 / h * (2 / h * (along + across) / square - ca.mtimes(inertia, rate))
        thrusts = ca.mtimes(thrusts_of, ca.vertcat(torque, u[3] * 4 * hover))
        push, after = u[3] * 4 * hover / mass * up, product(q, turn)
        moved = h * (velocity + h / 2 * (push - gravity * ca.mtimes(matrix(q).T, up)))
        rate = ca.mtimes(inverse, 2 / h * (along - across) / square + h / 2 * torque)
        velocity = ca.mtimes(matrix(turn).T, moved / h) + h / 2 * (push - gravity * ca.mtimes(matrix(after).T, up))
        spent = thrusts / hover - 1
        place = place + ca.mtimes(matrix(q), moved)
        return ca.vertcat(after, place, rate, velocity), h * ca.dot(spent, spent) / 2, thrusts / hover

    end = lambda x, goal: ca.vertcat(apart(goal[:4], x[:4]), x[4:] - goal[4:])
    problem = Problem((13, 4), steps, step, end, bounds=(np.zeros(4), np.full(4, top / hover)))

    def posed(case):
        tilt = exp(case[:3])
        velocity = np.array(matrix(ca.DM(tilt))).T @ np.array(case[6:9])
        start, goal = np.r_[tilt, case[3:6], np.zeros(3), velocity], np.r_[exp([0, 0, case[9]]), case[10:13], np.zeros(6)]
        turn = between(start[:4], goal[:4])
        place = lambda part: np.r_[turned(start[:4], turn * part), start[4:7] + part * (goal[4:7] - start[4:7]), np.zeros(6)]
        places = [place(k / steps) for k in range(steps + 1)]
        return start, goal, problem.packed(places, np.tile([0, 0, 0, 1.0], (steps, 1)))

    return problem, posed, 1e-8


PROBLEMS = {"unicycle": unicycle, "body": body, "quadrotor": quadrotor}


def fly(ticks, arguments):
    """A quadrotor in gusts. Each plan begins with places and inputs of the one before, a step later."""
    problem, posed, tolerance = quadrotor(steps=80)
    solver = problem.solver(arguments.solver, tolerance, arguments.compiled)
    rest, turn, goal = np.zeros(3), 0.5, [0.6, 0.2, 0.15]
    with open(arguments.results, "w") as results:
        for tick in ticks:
            if tick["k"] == 0:
                place, goal_of_flight, guess = posed(np.r_[rest, rest, rest, turn, goal])
            given = dict(x0=guess, p=np.r_[place, goal_of_flight], lbx=problem.lowest, ubx=problem.highest, lbg=problem.low, ubg=problem.high)
            before = time.perf_counter()
            solved = solver(**given)
            us = 1e6 * (time.perf_counter() - before)
            told, plan, values = solver.stats(), np.array(solved["x"]).ravel(), np.array(solved["g"]).ravel()
            violation = max(0.0, np.max(np.r_[problem.low - values, values - problem.high]))
            states, size = problem.states, problem.states + problem.controls
            first, last = plan[states:size], plan[-size:-states]
            reached, price, _ = problem.step(place, first)
            line = {"problem": "gusts", "flight": tick["flight"], "k": tick["k"], "cost": float(price)}
            line |= {"iters": int(told["iter_count"]), "us": round(us, 1), "ok": bool(told["success"] and violation < 1e-6)}
            print(json.dumps(line), file=results)
            place = np.array(reached).ravel() + np.r_[np.zeros(10), tick["gust"]]
            guess = np.r_[place, plan[size + states :], last, plan[-states:]]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cases")
    parser.add_argument("solver", choices=["fatrop", "ipopt"])
    parser.add_argument("results")
    parser.add_argument("--compiled", action="store_true", help="compile the functions of the problem by a C compiler")
    arguments = parser.parse_args()
    with open(arguments.cases) as file:
        cases = [json.loads(line) for line in file]
    if cases[0]["problem"] == "gusts":
        return fly(cases, arguments)
    with open(arguments.results, "w") as results:
        for name, made in PROBLEMS.items():
            problem, posed, tolerance = made()
            solver = problem.solver(arguments.solver, tolerance, arguments.compiled)
            for case in (case for case in cases if case["problem"] == name):
                start, goal, guess = posed(case["case"])
                given = dict(x0=guess, p=np.r_[start, goal], lbx=problem.lowest, ubx=problem.highest, lbg=problem.low, ubg=problem.high)
                solver(**given)  # clebsch is timed at its second solution too
                before = time.perf_counter()
                solved = solver(**given)
                us = 1e6 * (time.perf_counter() - before)
                values = np.array(solved["g"]).ravel()
                violation = max(0.0, np.max(np.r_[problem.low - values, values - problem.high]))
                told = solver.stats()
                line = {"problem": name, "k": case["k"], "cost": float(solved["f"]), "iters": int(told["iter_count"])}
                line |= {"us": round(us, 1), "ok": bool(told["success"] and violation < 1e-6)}
                print(json.dumps(line), file=results)


if __name__ == "__main__":
    main()
