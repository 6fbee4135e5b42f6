"""The lower bound: an admissible stress near the candidate, and its energy.

1. On every edge the scaled traction tau(s) = l T, as seen from the triangle on its left, is a polynomial in s with Legendre coefficients
   tau_0, tau_1, ...: the load where there is one, a number times the direction on rollers, b(s) n(s) with Bernstein coefficients b <= 0 on
   contacts (clipped), and the candidate on inner and clamped edges. A triangle is in equilibrium if the forces tau_0 of its edges and
   the moments mid x tau_0 + d x tau_1 / 6 (mid: the middle, d: the vector of the edge) add up to zero with those of the body force.
2. What is missing is computed in fixed point and passed on along trees of triangles that are rooted at clamped edges; the edge to the parent
   takes it. Bodies without a clamped edge are first brought into balance as a whole by changing coefficients of closed contacts and
   rollers, found by an exact linear solve. Then every balance holds exactly: by definition of the edges of the trees.
3. In each triangle some stress has these tractions (`reference`); its energy is enclosed.
"""

from dataclasses import dataclass
from fractions import Fraction as Q

import numpy as np
from flint import fmpq_mat

from . import Refused, reference
from .ball import BITS, ONE, Ball, ball_of, constants, fixed, of_fractions, root, stack, times

ROUNDING = 1e-7  # changes beyond this part of the largest traction are no rounding
ROUNDINGS = 4096  # fixed-point operations an edge or triangle takes part in, at most
NONE = [Q(0), Q(0)]
FREE, ALONG = ("inside", "clamped", "spring"), ("roller", "slide")  # edges with any traction, and those with one along a direction


@dataclass
class Term:
    """A coefficient of a roller or a contact, and the tractions (Legendre coefficients by edge) that belong to one of it."""

    value: Q
    presses: bool
    tractions: dict


def cross(x, y):
    return x[0] * y[1] - x[1] * y[0]


class Stress:
    def __init__(self, mesh, data):
        self.mesh, self.extra, self.terms, self.pressed = mesh, 0.0, [], []
        mesh.join_layers()
        counts, values = data["traction_counts"].astype(int), data["tractions"]
        pair_counts, pressures, degrees = data["pressure_counts"].astype(int), data["pressures"], data["stress_degrees"].astype(int)
        sizes = [len(x) for x in (counts, values, pair_counts, pressures, degrees)]
        if sizes != [len(mesh.edges), counts.sum(), len(mesh.pairs), pair_counts.sum(), len(mesh.triangles)] or counts.min() < 2:
            raise Refused("the proof does not have a traction for every edge and contact pair")
        if not np.isfinite(values).all() or not np.isfinite(pressures).all():
            raise Refused("a traction of the proof is no number")
        self.most = int(max([counts.max() - 1, degrees.max(), 1] + [n - 1 + p.turns() for n, p in zip(pair_counts, mesh.pairs)]))
        self.tau = Ball(np.zeros((len(counts), self.most + 1, 2))).writable()
        self.exact = np.zeros((2, len(counts), 2), object)  # tau_0 and tau_1 in fixed point
        self._candidates(counts, values)
        self._contacts(np.split(pressures, np.cumsum(pair_counts)[:-1]), max(mesh.stress, *(np.abs(x).max(initial=0.0) for x in (values, pressures))))
        self._set_terms()
        self.scale, size = max(float(np.abs(self.tau.mid).max()), mesh.resting), 1 + float(np.abs(mesh.points).max())
        self.forces = mesh.forces()
        largest = 1 + max(self.forces.max(), -self.forces.min()) / ONE
        residual = self._residuals()
        # What all roundings in fixed point can add up to, in any force or moment; where nothing acts there are none.
        self.error = ROUNDINGS * (len(mesh.edges) + len(mesh.triangles)) * size**2 * (1 + self.scale) * largest / 2.0**BITS
        self.error *= bool(residual.any() or self.scale)
        order = self._forest()
        if self.roots:
            residual = self._balance(residual)
        if self.error:
            self._mend(order, residual, 64 * self.error * size)
        # Any field with the tractions will do; it needs their degree.
        self.carries = (abs(self.tau.mid) + self.tau.rad).any(2)
        needed = np.where(self.carries.any(1), self.most - self.carries[:, ::-1].argmax(1), 0)
        turns = np.array([any(map(any, mesh.scene.forces[name].gradient)) for name in mesh.body_names])
        self.degrees = np.maximum(np.maximum(degrees, 1 + turns[mesh.bodies]), needed[mesh.sides].max(1))

    # 1. Tractions of edges.

    def _candidates(self, counts, values):
        mesh, start = self.mesh, np.concatenate([[0], np.cumsum(counts)])
        lengths, kinds = np.hypot(*(mesh.points[mesh.edges[:, 1]] - mesh.points[mesh.edges[:, 0]]).T), mesh.kinds
        for n in np.unique(counts):
            which = np.flatnonzero((counts == n) & np.isin(kinds, (*FREE, *ALONG)))
            own = values[start[which][:, None] + np.arange(n)] * lengths[which, None, None]
            matrix = np.array([[float(x) for x in row] for row in reference.to_legendre(n - 1)])
            self.tau.mid[which, :n] = np.einsum("ki,eic->ekc", matrix, own)
        free = np.flatnonzero(np.isin(kinds, FREE))
        self.exact[:, free] = fixed(np.moveaxis(self.tau.mid[free, :2], 1, 0))
        for e in np.flatnonzero(np.isin(kinds, ALONG)).tolist():
            n = mesh.directions[e]
            unit = np.array([float(x) for x in n])
            for k, b in enumerate((self.tau.mid[e, : counts[e]] @ unit / (unit @ unit)).tolist()):
                self.terms.append(Term(Q(b), False, {e: [NONE] * k + [n]}))

    def _contacts(self, pressures, largest):
        for k, (pair, own) in enumerate(zip(self.mesh.pairs, pressures)):
            if own.max(initial=0.0) > ROUNDING * largest:
                raise Refused(f"the contact traction of pair {k} pulls: {own.max():.3e} is above zero")
            self.pressed.append([])
            for j, b in enumerate(own.tolist()):
                tau, tractions = contact_traction(pair, [Q(int(i == j)) for i in range(len(own))]), {}
                for e, ends, sign in ((pair.edges[0], pair.first, 1), (pair.edges[1], pair.second, -1)):
                    if e >= 0:
                        turn = 1 if ends[0] == self.mesh.edges[e, 0] else -1
                        tractions[e] = [[sign * turn**i * x for x in c] for i, c in enumerate(tau)]
                self.pressed[-1].append(Term(min(Q(b), Q(0)), True, tractions))
            self.terms += self.pressed[-1]

    def _set_terms(self, off=0.0):
        """Tractions of loads, rollers and contacts; coefficients are known up to `off`."""
        rows = {e: load(self.mesh, e) for e in np.flatnonzero(self.mesh.kinds == "load").tolist()}
        for term in self.terms:
            for e, tau in term.tractions.items():
                own = rows.setdefault(e, [])
                own += [NONE] * (len(tau) - len(own))
                if term.value:
                    own[: len(tau)] = [[x + term.value * y for x, y in zip(a, b)] for a, b in zip(own, tau)]
        if rows:
            which, table = np.array(list(rows)), np.array([c + [NONE] * (self.most + 1 - len(c)) for c in rows.values()], object)
            reach = max((abs(x) for t in self.terms for tau in t.tractions.values() for c in tau for x in c), default=0)
            ball = of_fractions(table.ravel(), table.shape)
            self.tau.put(which, Ball(ball.mid, ball.rad + 64 * off * float(reach)))
            self.exact[:, which] = fixed(np.moveaxis(table[:, :2], 1, 0))

    # 2. Balances.

    def _vectors(self, which):
        """Middle and vector of edges, by components."""
        a, b = (self.mesh.fixed[self.mesh.edges[which, i]].T for i in range(2))
        return (a + b) >> 1, b - a

    def _residuals(self):
        """What is missing in the balances of every triangle: two forces and the moment about the origin."""
        mesh, (first, second) = self.mesh, np.swapaxes(self.exact, 1, 2)
        mid, d = self._vectors(slice(None))
        force = np.stack([*first, (cross(mid, first) >> BITS) + (cross(d, second) >> BITS) // 6], 1)
        out = sum(mesh.signs[:, i, None].astype(object) * force[mesh.sides[:, i]] for i in range(3))
        acted = np.flatnonzero((self.forces != 0).any((1, 2)))
        if len(acted):
            # By the middles of the sides: exact for quadratic functions.
            x, f = (v + np.roll(v, 1, 1) for v in (mesh.fixed[mesh.triangles[acted]], self.forces[acted]))
            moment = sum(cross(x[:, i].T, f[:, i].T) >> (BITS + 2) for i in range(3))
            whole = np.stack([*(f.sum(1).T >> 1), moment], 1)
            out[acted] += times(mesh.det[acted, None], whole) // 6
        return out

    def _forest(self):
        """The triangles, parents first; sets the edge to the parent of each, and of components without a clamped edge the roots."""
        mesh, order, self.roots = self.mesh, [], []
        self.component, self.parent = np.full((2, len(mesh.triangles)), -1)
        other = np.where(mesh.signs > 0, mesh.owners[mesh.sides, 1], mesh.owners[mesh.sides, 0]).tolist()
        # From all edges that hold at once, then from an outer edge of what they do not reach: best one that has nothing to do with others.
        starts = [np.flatnonzero(np.isin(mesh.kinds, FREE) & (mesh.owners[:, 1] < 0)).tolist()]
        starts += [[e] for some in (("free", "load"), (*ALONG, "contact")) for e in np.flatnonzero(np.isin(mesh.kinds, some)).tolist()]
        for k, edges in enumerate(starts):
            begin = len(order)
            for t, e in ((int(mesh.owners[e, 0]), e) for e in edges):
                if self.component[t] < 0:
                    self.roots += [(t, e)] if k else []
                    self.component[t], self.parent[t] = len(self.roots), -1 if k else e
                    order.append(t)
            while begin < len(order):
                t, begin = order[begin], begin + 1
                for e, o in zip(mesh.sides[t].tolist(), other[t]):
                    if o >= 0 and self.component[o] < 0:
                        self.component[o], self.parent[o] = self.component[t], e
                        order.append(o)
        return order

    def _balance(self, residual):
        """Brings components without a clamped edge into balance as a whole, by closed contacts and rollers."""
        mesh, total = self.mesh, []
        centres = [mesh.exact(mesh.triangles[t, 0]) for t, _ in self.roots]
        for c, centre in enumerate(centres):
            x, y, m = (Q(sum(column), ONE) for column in residual[self.component == c + 1].T.tolist())
            total += [x, y, m - cross(centre, (x, y))]
        terms = [t for t in self.terms if not t.presses or t.value < 0]
        matrix = [[Q(0)] * len(terms) for _ in total]
        for v, term in enumerate(terms):
            for e, tau in term.tractions.items():
                c = int(self.component[mesh.owners[e, 0]]) - 1
                if c >= 0:
                    a, b = (mesh.exact(v) for v in mesh.edges[e].tolist())
                    arm, d = [(x + y) / 2 - z for x, y, z in zip(a, b, centres[c])], [y - x for x, y in zip(a, b)]
                    f, g = (tau + [NONE])[:2]
                    for k, x in enumerate((*f, cross(arm, f) + cross(d, g) / 6)):
                        matrix[3 * c + k][v] += x
        # Balances that nothing takes part in hold exactly, or are left.
        rows = [i for i, row in enumerate(matrix) if any(row)]
        off = self._solve([total[i] for i in rows], [matrix[i] for i in rows], terms) if rows else 0.0
        if off is None or any(total[i] for i in set(range(len(total))) - set(rows)):
            # As an additional load on an edge of each: its size is told, and its work is part of the upper bound.
            for t, e in self.roots:
                self.parent[t] = e
        self.error *= 1 + (off or 0.0)
        self._set_terms(self.error)
        return self._residuals()

    def _solve(self, total, matrix, terms):
        """Changes coefficients by about the least that balances, then exactly by as many as there are balances. Returns by how much more than
        `total` coefficients and forces may be off; None where the balance is not exact."""
        room = np.array([abs(float(t.value)) if t.presses else self.scale + 1e-300 for t in terms])
        a = np.array([[float(x) for x in row] for row in matrix])
        norms = np.sqrt(((a * room) ** 2).sum(1)) + 1e-300
        scaled, changed = a * room / norms[:, None], [t.value for t in terms]
        missing = lambda: [t + sum(x * (y - s.value) for x, y, s in zip(row, changed, terms) if x) for t, row in zip(total, matrix)]
        for _ in range(3):
            active = np.array([not t.presses or x < 0 for t, x in zip(terms, changed)])
            step = np.linalg.lstsq(scaled * active, -np.array([float(x) for x in missing()]) / norms, rcond=1e-10)[0] * room * active
            changed = [min(x + Q(s), Q(0)) if t.presses else x + Q(s) for t, x, s in zip(terms, changed, step.tolist())]
        chosen, rest = [], scaled.copy()
        for _ in total:  # the columns that are most independent
            sizes = (rest**2).sum(0)
            chosen.append(int(np.argmax(sizes)))
            q = rest[:, chosen[-1]] / np.sqrt(sizes[chosen[-1]] + 1e-300)
            rest = rest - np.outer(q, q @ rest)
        square, off = reference.rational([[row[j] for j in chosen] for row in matrix]), None
        if sizes.max() > 1e-18 and square.det() != 0:
            inverse, balanced = square.inv(), list(changed)
            for j, (x,) in zip(chosen, (inverse * reference.rational([[x] for x in missing()])).table()):
                balanced[j] -= Q(int(x.p), int(x.q))
            norm = np.abs(reference.floats(inverse)).sum(1).max()
            if all(balanced[j] < -4 * norm * self.error for j in chosen if terms[j].presses):
                changed, off = balanced, 8 * norm * max(1.0, np.abs(a).max()) * len(terms)
        worst = max(abs(float(x - t.value)) for t, x in zip(terms, changed))
        if worst > ROUNDING * max(self.scale, room.max()):
            raise Refused(f"a body that only contacts and rollers hold is out of balance: a traction would have to change by {worst:.3e}")
        for term, x in zip(terms, changed):
            term.value = x
        return off

    def _mend(self, order, missing, error):
        """Passes on what is missing, leaves first, to the edges of the trees."""
        mesh, edges, changes = self.mesh, [], []
        for t in (t for t in reversed(order) if self.parent[t] >= 0):
            first = mesh.owners[self.parent[t], 0] == t
            edges.append(self.parent[t])
            changes.append(-missing[t] if first else missing[t])
            other = mesh.owners[self.parent[t], int(first)]
            if other >= 0:
                missing[other] = missing[other] + missing[t]
        if not edges:
            return
        which, change = np.array(edges), np.array(changes, object).reshape(-1, 3).T
        mid, d = self._vectors(which)
        # What is left of the moment about the middle of the edge is d x tau_1 / 6.
        first, turning = ball_of(change[:2].T, error), ball_of(6 * (change[2] - (cross(mid, change) >> BITS)), error)
        x, y = (ball_of(c, 1e-90) for c in d)
        turning = turning * (x.square() + y.square()).inverse()
        second = stack([-(turning * y), turning * x], 1)
        by_edge = np.maximum(np.abs(first.mid).max(1), np.abs(second.mid).max(1))
        at = int(np.argmax(by_edge))
        if by_edge[at] > ROUNDING * self.scale:
            raise Refused(
                f"the stress is not in equilibrium: edge {which[at]} of triangles {mesh.owners[which[at]].tolist()} would have to carry "
                f"{by_edge[at]:.3e} more, the largest force of an edge being {self.scale:.3e}"
            )
        for k, by in ((0, first), (1, second)):
            self.tau.put((which, k), self.tau[which, k] + by)
        loaded = ~np.isin(mesh.kinds[which], FREE)
        if loaded.any():
            self.extra = float(sum((abs(by.mid[loaded]) + by.rad[loaded]).sum() for by in (first, second))) * (1 + 1e-9)
            mesh.premises.append(f"bodies that contacts and rollers alone hold balance but for {self.extra:.1e}, taken for an additional load")

    # 3. Energies.

    def bound(self):
        """A number that -Pi of an admissible stress is not below, thickness included."""
        mesh, scene, total, carries = self.mesh, self.mesh.scene, Q(0), self.carries.any(1)
        acted = carries[mesh.sides].any(1) | (self.forces != 0).any((1, 2))
        for p in np.unique(self.degrees[acted]).tolist():
            own = np.flatnonzero((self.degrees == p) & acted)
            for which in np.array_split(own, max(1, len(own) * p * p // 20000)):
                total -= Q(float(self._energies(which, p).sum()[1]))
        for e in np.flatnonzero((mesh.kinds == "clamped") & carries).tolist():
            ends = [mesh.conditions[e].data.at(mesh.written(v)) for v in mesh.edges[e].tolist()]
            u = of_fractions([x for a, b in zip(*ends) for x in ((a + b) / 2, (b - a) / 6)], (2, 2))
            total += Q(float((self.tau[e, :2] * Ball(u.mid.T, u.rad.T)).sum()[0]))
        for term in self.terms:
            for e, tau in () if term.presses else term.tractions.items():
                u0, n = mesh.conditions[e].data if mesh.kinds[e] == "roller" else 0, mesh.directions[e]
                if u0 and len(tau) == 1:
                    total += min(term.value * u0 * length for length in root(n[0] ** 2 + n[1] ** 2)) - abs(u0) * Q(self.error) * 4
        for pair, b in zip(mesh.pairs, self.pressed):
            for i, term in enumerate(b):
                for j, g in enumerate(pair.gap):
                    work = term.value * (g + pair.excess) * reference.product(len(b) - 1, i, len(pair.gap) - 1, j)
                    total += min(work * length for length in pair.length)
            total -= Q(self.error) * 4 * max(abs(g) for g in pair.gap) * pair.length[1]
            if pair.stiffness:
                off = [abs(term.value) + 4 * Q(self.error) for term in b]
                total -= pair.length[1] * square(off) / (2 * pair.stiffness)
        for e, _, stiffness in mesh.springs:
            n = mesh.normal(*mesh.edges[e])
            for k, (x, y) in zip(stiffness, (n, [-n[1], n[0]])):
                if k:
                    # int (tau.n)^2 / (2 k l^3), n as long as the edge
                    along = self.tau[e, :, 0] * of_fractions([x])[0] + self.tau[e, :, 1] * of_fractions([y])[0]
                    weights = [1 / ((2 * j + 1) * 2 * k * root(x * x + y * y)[0] ** 3) for j in range(self.most + 1)]
                    total -= Q(float((along.square() * of_fractions(weights)).sum()[1])) * (1 + Q(1, 10**60))
        return total * scene.thickness

    def _energies(self, which, p):
        mesh, count, parts = self.mesh, len(which), []
        law = mesh.by_body(lambda name: mesh.scene.bodies[name][0], which)
        ((a, b), (c, d)), det = [[m[which] for m in row] for row in mesh.map], mesh.jacobian[which]
        pulled = lambda v: stack([d * v[0] - b * v[1], a * v[1] - c * v[0]])  # J B^-1 v
        for i in range(3):
            for k in range(p + 1):  # -tau(1 - s), from the right of an edge
                turn = np.where(mesh.signs[which, i] > 0, 1.0, (-1.0) ** (k + 1))[:, None]
                own = self.tau[mesh.sides[which, i], k]
                parts.append(pulled(Ball((own.mid * turn).T, own.rad.T)))
        force = [[f * det for f in own] for own in mesh.corners(mesh.scene.forces, which)]
        parts += [pulled(f) for f in zip(*force)][: 3 if p > 1 else 1]
        special, free, norms = reference.stresses(p)
        s = stack(parts).reshape(-1, count).times(special)
        if free is not None:
            s = s + Ball(self._least(s.mid, free.mid, norms, [x.mid for x in (a, b, c, d)], [x.mid for x in law])).times(free)
        s = s.reshape(3, 3, len(norms), count)
        xx, yy, xy = s[:, 0], s[:, 1], s[:, 2]
        one, two, three, four = a * xx + b * xy, a * xy + b * yy, c * xx + d * xy, c * xy + d * yy  # B s^
        xx, yy, xy = one * a + two * b, three * c + four * d, one * c + two * d  # B s^ B^T
        x = [xx + yy, xx - yy, xy]
        total = form(law, x).times(constants([norms]), 1)[:, 0]
        energy = (total[0] + total[1] + total[2]) * (det.square() * det).inverse() * constants([[Q(1, 6)]])[0, 0]
        if not mesh.warm:
            return energy
        work, weights = 0, constants([norms[:3]])
        for own, strain in zip(x, mesh.corners(mesh.scene.strains, which)):
            for sub, e in enumerate(reference.on_split(strain)):
                work = (own[sub, :3] * e).times(weights)[0] + work
        return energy + work * det.inverse() * constants([[Q(1, 3)]])[0, 0]

    @staticmethod
    def _least(s, free, norms, edges, law):
        """Coefficients of the fields without traction that make the energy small; nothing is claimed of them."""
        n, (a, b, c, d) = len(norms), edges
        xx, yy, xy = np.array([[a * a, b * b, 2 * a * b], [c * c, d * d, 2 * c * d], [a * c, b * d, a * d + b * c]])  # B s^ B^T
        roots = [u * (xx + yy) + v * (xx - yy) + w * xy for u, v, w in (law[k + 1 : k + 4] for k in (0, 4, 8))]
        form = sum(w * r[:, None] * r for w, r in zip(law[::4], roots))
        z, own = (x.reshape(3, 3, n, -1).swapaxes(0, 1).reshape(3, 3 * n, -1) for x in (free, s))
        left = z * np.tile([float(x) for x in norms], 3)[:, None]
        hessian = sum(form[i, j][:, None, None] * (left[i].T @ z[j]) for i in range(3) for j in range(3))
        gradient = sum(form[i, j][:, None] * (left[i].T @ own[j]).T for i in range(3) for j in range(3))
        try:
            return -np.linalg.solve(hessian, gradient[:, :, None])[:, :, 0].T
        except np.linalg.LinAlgError:
            return np.zeros(gradient.T.shape)


def form(law, x):
    """Sum of w (r . x)^2; the numbers of the law are those of triangles, the last axis of x."""
    total = 0
    for k in (0, 4, 8):
        inner = 0
        for r, own in zip(law[k + 1 : k + 4], x):
            if r.mid.any() or r.rad.any():
                inner = own * r + inner
        total = inner.square() * law[k] + total
    return total


def square(b):
    """int_0^1 of the square of a polynomial by its Bernstein coefficients."""
    n = len(b) - 1
    return sum(x * y * reference.product(n, i, n, j) for i, x in enumerate(b) for j, y in enumerate(b))


def load(mesh, e):
    """Legendre coefficients tau_0, tau_1 of the load on an edge; lengths that are no fraction are taken to BITS places."""
    (a, b), (pressure, affine) = mesh.edges[e].tolist(), mesh.conditions[e].data
    n = mesh.normal(a, b)
    ends, length = [affine.at(mesh.written(v)) for v in (a, b)], root(n[0] ** 2 + n[1] ** 2)[0]
    return [[length * (x + y) / 2 - pressure * z for x, y, z in zip(*ends, n)], [length * (y - x) / 2 for x, y in zip(*ends)]]


def contact_traction(pair, b):
    """Legendre coefficients of b(s) n(s), n(s) times the length of the pair, as seen from its first side."""
    (m, n), k = pair.ends, len(b)
    product = [[x * y for y in m] for x in b]
    if pair.turns():
        product = [[((k - i) * (b[i] if i < k else 0) * x + i * (b[i - 1] if i else 0) * y) / k for x, y in zip(m, n)] for i in range(k + 1)]
    return [[sum(w * x[c] for w, x in zip(row, product)) for c in range(2)] for row in reference.to_legendre(len(product) - 1)]
