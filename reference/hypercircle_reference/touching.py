"""Elastic contact: ½ ∫ k (j − g)₊² of the jump j of an edge along its normal beyond the gap g, times the thickness; of a body of revolution
with the weight r.

The energy is convex and once differentiable. Newton's method has the minimum of its second-order model, under whatever else bounds the
displacement, as its next step, and shortens a step that does not lower the energy itself. Where the jump exceeds the gap is found from
the zeros of a polynomial on each edge, so that integrals are exact.
"""

from __future__ import annotations

from dataclasses import replace
from math import comb

import numpy as np

from hypercircle_process import Failure, log

from .constraints import Constraints
from .exchange import Problem, Springs
from .lattice import Lattice, bernstein
from .model import Mesh, Model, distributed
from .solve import Solution, minimise
from .springs import assembled, sides

STEPS = 100
"""Newton steps after which the method gives up."""

SETTLED = 1e-13
"""A step that changes the energy by less than this part of what is stored is the last."""

HALVINGS = 40
"""How often a step is halved until it lowers the energy."""

FARTHER = 30.0
"""By what stiff contact grows stiffer from one minimum to the next."""


class Touching:
    """Elastic contact for displacements of one degree, given as arrays (n, 2) over the nodes of the exchange file."""

    def __init__(self, problem: Problem, degree: int, springs: Springs):
        self.problem, self.degree, self.springs = problem, degree, springs
        self.first, self.second, self.length = sides(problem, self.springs, degree)
        self.weight = problem.thickness * self.length * self.springs.stiffness[:, 0]
        self.radius = np.ones((len(self.length), 2))
        if problem.revolution is not None:
            self.radius = problem.points[problem.edges[springs.edges]][:, :, 0] - problem.revolution.axis
        self.back = np.linalg.inv(bernstein(degree))

    def jumps(self, displacement: np.ndarray) -> np.ndarray:
        """Values (m, k + 1) of the jump at the nodes of each edge."""
        normal = self.springs.axes[:, 0]
        own = np.einsum("mai,mi->ma", displacement[self.first], normal)
        other = np.einsum("mai,mi->ma", displacement[self.second], normal)
        return own - np.where(self.springs.opposite[:, None] >= 0, other, 0.0)

    def points(self, displacement: np.ndarray):
        """For each edge a rule over where the jump exceeds the gap: weights (n,), shape functions (n, k + 1) and gap (n,)."""
        for jump, gap, radius in zip(self.jumps(displacement), self.springs.gaps, self.radius):
            count = max(self.degree, len(gap) - 1) + 1
            depth = _powers(self.back @ jump, count) - _powers(gap, count)
            zeros = np.roots(depth[::-1]) if np.any(depth[1:]) else np.zeros(0)
            inside = np.sort(zeros.real[(np.abs(zeros.imag) < 1e-12) & (zeros.real > 0.0) & (zeros.real < 1.0)])
            ends = np.concatenate([[0.0], inside, [1.0]])
            closed = np.polyval(depth[::-1], 0.5 * (ends[:-1] + ends[1:])) > 0.0
            yield self._rule(ends, gap, radius, closed)

    def _rule(self, ends: np.ndarray, gap: np.ndarray, radius: np.ndarray, which: np.ndarray = np.array([True])):
        at, weight = np.polynomial.legendre.leggauss(self.degree + len(gap))
        length = (ends[1:] - ends[:-1])[which, None]
        s = (ends[:-1][which, None] + 0.5 * length * (1.0 + at)).reshape(-1)
        weight = (0.5 * length * weight).reshape(-1) * (radius[0] + s * (radius[1] - radius[0]))
        return weight, _basis(self.degree, s) @ self.back, _basis(len(gap) - 1, s) @ gap

    def energy(self, displacement: np.ndarray) -> float:
        """½ ∫ k (j − g)₊²."""
        stored = 0.0
        for scale, jump, (weight, basis, gap) in zip(self.weight, self.jumps(displacement), self.points(displacement)):
            stored += 0.5 * scale * float(weight @ (basis @ jump - gap) ** 2)
        return stored

    def model(self, mesh: Mesh, model: Model, displacement: np.ndarray | None) -> Model:
        """``model`` with what contact resists where it is closed at ``displacement``; everywhere without one."""
        count, k = len(self.length), self.degree
        products, pull = np.zeros((count, k + 1, k + 1)), np.zeros((Lattice.of(self.problem, k).ends[2], 2))
        if displacement is None:
            rules = (self._rule(np.array([0.0, 1.0]), *of) for of in zip(self.springs.gaps, self.radius))
        else:
            rules = self.points(displacement)
        for i, (weight, basis, gap) in enumerate(rules):
            products[i] = (weight[:, None] * basis).T @ basis
            force = self.weight[i] * ((weight * gap) @ basis)[:, None] * self.springs.axes[i, 0]
            np.add.at(pull, self.first[i], force)
            if self.springs.opposite[i] >= 0:
                np.add.at(pull, self.second[i], -force)
        stiffness = model.stiffness.copy()
        resists = distributed(mesh, assembled(self.problem, self.springs, k, products), model.numbering)
        stiffness.axpy(1.0, resists)
        load = model.load.copy()
        load.array[:] += pull[model.numbering.owned(mesh.comm.rank)].reshape(-1)
        return replace(model, stiffness=stiffness, load=load)


def _basis(degree: int, s: np.ndarray) -> np.ndarray:
    """Bernstein polynomials (n, k + 1) at points ``s``."""
    return np.array([comb(degree, i) * s**i * (1.0 - s) ** (degree - i) for i in range(degree + 1)]).T


def _powers(coefficients: np.ndarray, count: int) -> np.ndarray:
    """Bernstein coefficients as those of powers, from the constant on, filled up to ``count``."""
    degree = len(coefficients) - 1
    out = np.zeros(count)
    for i, value in enumerate(coefficients):
        for j in range(i, degree + 1):
            out[j] += value * comb(degree, j) * comb(j, i) * (-1.0) ** (j - i)
    return out


def minimise_touching(comm, mesh: Mesh, model: Model, constraints: Constraints, degree: int, extent: float) -> Solution:
    """The minimum where some contact is elastic; :class:`Failure` says why no solution can be trusted.

    Stiff contact follows softer one, where it is closed is known then but for a little."""
    problem = mesh.problem
    springs, solution, steps = problem.touching, None, 0
    for limit in _limits(problem, springs):
        softer = replace(springs, stiffness=np.minimum(springs.stiffness, limit))
        begin = None if solution is None else solution.displacement.reshape(-1, 2)
        solution = _minimum(comm, mesh, model, constraints, Touching(problem, degree, softer), begin, extent)
        steps += solution.iterations
    return replace(solution, iterations=steps)


def _limits(problem: Problem, springs: Springs) -> list[float]:
    """Stiffnesses that contact has at most, one after the other, from that of the bodies on."""
    ends = problem.points[problem.edges[springs.edges]]
    shortest = float(np.min(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)))
    limit, stiffest, out = min(body.young for body in problem.bodies) / shortest, float(np.max(springs.stiffness)), []
    while limit < stiffest:
        out.append(limit)
        limit *= FARTHER
    return [*out, stiffest]


def _minimum(comm, mesh, model, constraints, touching: Touching, begin: np.ndarray | None, extent: float) -> Solution:
    """The minimum, from the displacement ``begin`` or, without one, from contact that is closed everywhere."""

    def evaluated(solution: Solution) -> tuple[np.ndarray, float]:
        return solution.displacement.reshape(-1, 2), touching.energy(solution.displacement.reshape(-1, 2))

    def step(displacement: np.ndarray | None) -> Solution:
        return minimise(comm, touching.model(mesh, model, displacement), constraints, extent)

    def slope_at(displacement: np.ndarray, change: np.ndarray) -> float:
        """The derivative of all but elastic contact along ``change``."""
        mine = model.numbering.owned(comm.rank)
        u, along = model.load.duplicate(), model.load.duplicate()
        u.array[:], along.array[:] = displacement[mine].reshape(-1), change[mine].reshape(-1)
        gradient = model.stiffness * u
        gradient.axpy(-1.0, model.load)
        return gradient.dot(along)

    solution = step(begin)
    steps = solution.iterations
    at, stored = evaluated(solution)
    rest = solution.energy
    # Rounding of the energies that are subtracted, where contact that opens leaves none.
    rounding = np.finfo(float).eps * max(solution.strain_energy, stored)
    for count in range(STEPS):
        found = step(at)
        steps += found.iterations
        ahead, stored_ahead = evaluated(found)
        change = ahead - at
        slope = slope_at(at, change)
        curved = found.energy - rest - slope
        allowed = max(SETTLED * max(found.strain_energy, stored_ahead), rounding)
        part, energy = 1.0, rest + stored
        for _ in range(HALVINGS):
            there = touching.energy(at + part * change) if part < 1.0 else stored_ahead
            lower = rest + part * slope + part * part * curved + there
            if lower <= energy + allowed:
                break
            part *= 0.5
        log(comm, f"elastic contact, step {count}: energy {lower!r}")
        if abs(energy - lower) <= allowed and part == 1.0:
            # The last step, along which next to nothing changes.
            stored = found.strain_energy + stored_ahead
            return replace(found, energy=found.energy + stored_ahead, strain_energy=stored, iterations=steps)
        at, stored, rest = at + part * change, there, rest + part * slope + part * part * curved
    raise Failure(f"elastic contact has not settled after {STEPS} steps")
