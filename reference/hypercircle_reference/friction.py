"""Friction with a given bound τ̄: the term ∫ τ̄ |j_t| ds of the energy, from the Bernstein coefficients of the tangential jump j_t.

With j_t = Σ d_i B_i it is replaced by Σ c_i |d_i|, c_i = ∫ τ̄ B_i ds: nowhere less, equal wherever j_t keeps its sign along the
edge. The forces conjugate to the d_i are then the ∫ T_t B_i ds, each at most its c_i. Where t̂ does not turn each d_i is an unknown; where
it turns the coefficients are those of degree k + 1, of degree 1 the ends alone, and see :mod:`coupled`.
"""

from __future__ import annotations

from math import comb

import numpy as np

from hypercircle_process import BadExchange

from .exchange import Contact, Problem


def weights(problem: Problem, contact: Contact, degree: int) -> np.ndarray:
    """The c_i (m, degree + 1) of every pair, times the thickness; zero without friction."""
    coefficients = contact.friction
    if problem.revolution is not None:
        # r τ̄ is a quadratic.
        radius = problem.points[contact.first][:, :, 0] - problem.revolution.axis
        (a, b), (r, s) = contact.friction.T, radius.T
        coefficients = np.stack([r * a, 0.5 * (r * b + s * a), s * b], axis=1)
    return problem.thickness * contact.length[:, None] * (coefficients @ _products(coefficients.shape[1] - 1, degree))


def _products(p: int, k: int) -> np.ndarray:
    """∫ B_a B_i ds (p + 1, k + 1) over an edge of length one, of the Bernstein polynomials of degree p and k."""
    total = [[comb(p, a) * comb(k, i) / comb(p + k, a + i) for i in range(k + 1)] for a in range(p + 1)]
    return np.array(total) / (p + k + 1)


def check(problem: Problem, degree: int, nodal_contact: bool) -> None:
    """Refuse friction where contact is asked for at nodes alone."""
    rubbing = [contact for contact in problem.contacts if contact.rubs.any()]
    if rubbing and nodal_contact and degree > 1:
        raise BadExchange(f"contact {rubbing[0].name} has friction, which is not modelled with contact at the nodes only")


def vertex_slips(problem: Problem, degree: int) -> list[tuple[tuple[int, int], np.ndarray, float, int]]:
    """((first, second), tangent, weight, contact) of the tangential jumps at vertices; weights of equal ones added."""
    found: dict[tuple, list] = {}
    for index, contact in enumerate(problem.contacts):
        if not contact.rubs.any():
            continue
        shares = {k: weights(problem, contact, k) for k in (degree, degree + 1)}
        for pair in np.flatnonzero(contact.rubs):
            k = degree + 1 if degree > 1 and contact.turns[pair] else degree
            for end in range(2):
                ends = (int(contact.first[pair, end]), int(contact.second[pair, end]))
                tangent = contact.tangent[pair, end]
                entry = found.setdefault((index, *ends, *tangent), [ends, tangent, 0.0, index])
                entry[2] += float(shares[k][pair, end * k])
    return [tuple(entry) for entry in found.values() if entry[2] > 0.0]
