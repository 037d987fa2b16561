"""Waves of unit vectors on a periodic sheet by NumPy, all sites at once: the step of the bench `fields`.

usage: by_numpy.py N STEPS H SPACING [REPETITIONS]

Prints the least time of a step for each site in ns, and then the configuration after STEPS steps, site by site.
"""

import sys
import time

import numpy

OFF = 8 * numpy.finfo(float).eps


def start(n):
    turn = 2 * numpy.pi * numpy.arange(n) / n
    tilt = 0.5 * numpy.sin(turn)[:, None] * numpy.cos(turn)[None, :]
    return numpy.stack([numpy.sin(tilt), numpy.zeros((n, n)), numpy.cos(tilt)]), numpy.zeros((3, n, n))


def add_cross(to, a, b, scale):
    """to += scale a × b"""
    to[0] += scale * (a[1] * b[2] - a[2] * b[1])
    to[1] += scale * (a[2] * b[0] - a[0] * b[2])
    to[2] += scale * (a[0] * b[1] - a[1] * b[0])


def kick(q, momentum, weight, neighbours):
    # the sum of the four neighbours, without the copies of numpy.roll
    neighbours[:, 1:-1] = q[:, 2:]
    neighbours[:, 1:-1] += q[:, :-2]
    neighbours[:, 0] = q[:, 1] + q[:, -1]
    neighbours[:, -1] = q[:, 0] + q[:, -2]
    neighbours[:, :, :-1] += q[:, :, 1:]
    neighbours[:, :, 1:] += q[:, :, :-1]
    neighbours[:, :, -1] += q[:, :, 0]
    neighbours[:, :, 0] += q[:, :, -1]
    add_cross(momentum, q, neighbours, weight)


def drift(q, momentum, h):
    x = h * momentum
    cosine = numpy.sqrt(1 - (x[0] * x[0] + x[1] * x[1] + x[2] * x[2]))
    moved = q * cosine
    add_cross(moved, x, q, 1.0)
    squared = moved[0] * moved[0] + moved[1] * moved[1] + moved[2] * moved[2]
    moved *= numpy.where(abs(squared - 1) > OFF, (3 - squared) / 2, 1.0)
    q[:] = moved


def steps(q, momentum, count, h, spacing):
    weight = h / spacing**2
    neighbours = numpy.empty_like(q)
    kick(q, momentum, weight / 2, neighbours)
    for step in range(1, count + 1):
        drift(q, momentum, h)
        kick(q, momentum, weight / 2 if step == count else weight, neighbours)


def main():
    n, count, h, spacing = int(sys.argv[1]), int(sys.argv[2]), float(sys.argv[3]), float(sys.argv[4])
    least = float("inf")
    for _ in range(int(sys.argv[5]) if len(sys.argv) > 5 else 5):
        q, momentum = start(n)
        before = time.perf_counter()
        steps(q, momentum, count, h, spacing)
        least = min(least, time.perf_counter() - before)
    print(least / (count * n * n) * 1e9)
    numpy.savetxt(sys.stdout, q.reshape(3, -1).T, fmt="%.17g")


main()
