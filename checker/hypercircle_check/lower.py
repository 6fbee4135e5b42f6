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

from fractions import Fraction as Q

import numpy as np
from flint import fmpq, fmpq_mat

from . import Refused, reference
from .ball import BITS, EPS, ONE, Ball, ball_of, constants, fixed, of_fractions, root, stack, times

ROUNDING = 1e-7  # changes beyond this part of the largest traction are no rounding
ROUNDINGS = 4096  # fixed-point operations an edge or triangle takes part in, at most


class Term:
    """A coefficient of a roller or a contact, and the tractions (Legendre coefficients by edge) that belong to one of it."""

    def __init__(self, value, presses, tractions):
        self.value, self.presses, self.tractions = value, presses, tractions


class Stress:
    def __init__(self, mesh, data):
        self.mesh, self.extra, self.mended = mesh, 0.0, 0.0
        counts, values = data["traction_counts"].astype(int), data["tractions"]
        pair_counts, pressures = data["pressure_counts"].astype(int), data["pressures"]
        fits = len(counts) == len(mesh.edges) and counts.sum() == len(values) and counts.min(initial=2) >= 2
        if not fits or len(pair_counts) != len(mesh.pairs) or pair_counts.sum() != len(pressures) or len(data["stress_degrees"]) != len(mesh.triangles):
            raise Refused("the proof does not have a traction for every edge and contact pair")
        if not np.isfinite(values).all() or not np.isfinite(pressures).all():
            raise Refused("a traction of the proof is no number")
        self.most = int(max([counts.max() - 1, 1] + [n - 1 + p.turns() for n, p in zip(pair_counts, mesh.pairs)]))
        self.tau = Ball(np.zeros((len(counts), self.most + 1, 2))).writable()
        self.force = np.zeros((len(counts), 3), object)  # force and moment about the origin, fixed point
        self._candidates(counts, values)
        self._contacts(np.split(pressures, np.cumsum(pair_counts)[:-1]), np.abs(pressures).max(initial=0.0))
        self._set_terms()
        self.scale = float(np.abs(self.tau.mid).max(initial=0.0))
        size = 1 + float(np.abs(mesh.points).max())
        largest = 1 + max(float(abs(x)) for body in mesh.scene.bodies.values() for x in body[2])
        # What all roundings in fixed point can add up to, in any force or moment.
        self.error = ROUNDINGS * (len(mesh.edges) + len(mesh.triangles)) * size**2 * (1 + self.scale) * largest / 2.0**BITS
        residual = self._residuals()
        if not residual.any() and not self.scale:
            self.error = 0.0  # nothing acts, exactly
        order, floating = self._forest()
        if floating:
            residual = self._balance(residual, floating)
        if self.error:
            self._mend(order, residual, 64 * self.error * size)
        there = (np.abs(self.tau.mid).max(2) + self.tau.rad.max(2)) > 0
        needed = np.where(there.any(1), self.most - there[:, ::-1].argmax(1), 0)
        # Any field with the tractions will do; it needs their degree.
        self.degrees = np.maximum(np.maximum(data["stress_degrees"].astype(int), 1), needed[mesh.sides].max(1))

    # 1. Tractions of edges.

    def _vectors(self, which):
        a, b = (self.mesh.fixed[self.mesh.edges[which, i]] for i in range(2))
        return (a + b) >> 1, b - a

    def _set_forces(self, which, first, second):
        mid, d = self._vectors(which)
        cross = lambda x, y: times(x[:, 0], y[:, 1]) - times(x[:, 1], y[:, 0])
        self.force[which, :2] = first
        self.force[which, 2] = cross(mid, first) + cross(d, second) // 6

    def _candidates(self, counts, values):
        mesh, start, self.terms = self.mesh, np.concatenate([[0], np.cumsum(counts)]), []
        lengths = np.hypot(*(mesh.points[mesh.edges[:, 1]] - mesh.points[mesh.edges[:, 0]]).T)
        kinds = np.array([mesh.kind(e) for e in range(len(counts))])
        for n in np.unique(counts):
            which = np.flatnonzero((counts == n) & np.isin(kinds, ("inside", "clamped", "roller")))
            own = values[start[which][:, None] + np.arange(n)] * lengths[which, None, None]
            matrix = np.array([[float(x) for x in row] for row in reference.to_legendre(n - 1)])
            self.tau.mid[which, :n] = np.einsum("ki,eic->ekc", matrix, own)
        free = np.flatnonzero(np.isin(kinds, ("inside", "clamped")))
        self._set_forces(free, fixed(self.tau.mid[free, 0]), fixed(self.tau.mid[free, 1]))
        self.clamped = np.flatnonzero(kinds == "clamped").tolist()
        self.open = np.flatnonzero(np.isin(kinds, ("free", "load"))).tolist()
        for e in np.flatnonzero(kinds == "roller").tolist():
            n = mesh.directions[e]
            unit = np.array([float(x) for x in n])
            for k, b in enumerate((self.tau.mid[e, : counts[e]] @ unit / (unit @ unit)).tolist()):
                self.terms.append(Term(Q(b), False, {e: [[Q(0)] * 2] * k + [n]}))

    def _contacts(self, pressures, largest):
        self.pressed = []
        for k, (pair, own) in enumerate(zip(self.mesh.pairs, pressures)):
            if own.max(initial=0.0) > ROUNDING * largest:
                raise Refused(f"the contact traction of pair {k} pulls: {own.max():.3e} is above zero")
            terms = []
            for j, b in enumerate(own.tolist()):
                tau, tractions = contact_traction(pair, [Q(int(i == j)) for i in range(len(own))]), {}
                for e, ends, sign in ((pair.edges[0], pair.first, 1), (pair.edges[1], pair.second, -1)):
                    if e >= 0:
                        along = ends[0] == self.mesh.edges[e, 0]
                        tractions[e] = [[sign * x if along or i % 2 == 0 else -sign * x for x in c] for i, c in enumerate(tau)]
                terms.append(Term(min(Q(b), Q(0)), True, tractions))
            self.pressed.append(terms)
            self.terms += terms

    def _set_terms(self, off=0.0):
        """Tractions of loads, rollers and contacts; coefficients are known up to `off`."""
        mesh, exact = self.mesh, {}
        for e, condition in enumerate(mesh.conditions):
            if condition and condition.kind == "load":
                exact[e] = load(mesh, e, condition)
        for term in self.terms:
            for e, tau in term.tractions.items():
                own = exact.setdefault(e, [])
                own += [[Q(0)] * 2] * (len(tau) - len(own))
                if term.value:
                    own[: len(tau)] = [[x + term.value * y for x, y in zip(a, b)] for a, b in zip(own, tau)]
        if not exact:
            return
        which = np.array(list(exact))
        rows = np.array([c + [[Q(0)] * 2] * (self.most + 1 - len(c)) for c in exact.values()], object)
        ball = of_fractions(rows.ravel(), rows.shape)
        reach = 64 * float(max([abs(x) for t in self.terms for tau in t.tractions.values() for c in tau for x in c], default=0))
        self.tau.put(which, Ball(ball.mid, ball.rad + off * reach))
        self._set_forces(which, fixed(rows[:, 0]), fixed(rows[:, 1]))

    # 2. Balances.

    def _residuals(self):
        mesh = self.mesh
        out = sum(mesh.signs[:, i, None].astype(object) * self.force[mesh.sides[:, i]] for i in range(3))
        for b, name in enumerate(mesh.body_names):
            f, own = fixed(np.array(mesh.scene.bodies[name][2], object)), np.flatnonzero(mesh.bodies == b)
            if f.any():
                centre = mesh.fixed[mesh.triangles[own]].sum(1)
                out[own, :2] += np.stack([times(mesh.det[own], x) >> 1 for x in f], 1)
                out[own, 2] += times(mesh.det[own], times(centre[:, 0], f[1]) - times(centre[:, 1], f[0])) // 6
        return out

    def _forest(self):
        """The triangles, parents first, and the components without a clamped edge; sets the edge from each triangle to its parent."""
        mesh, count = self.mesh, len(self.mesh.triangles)
        self.component, self.parent, order, self.roots = np.full(count, -1), np.full(count, -1), [], []
        other = np.where(mesh.signs > 0, mesh.owners[mesh.sides, 1], mesh.owners[mesh.sides, 0]).tolist()
        # From all clamped edges at once, then from an open edge of what they do not reach, then from anywhere.
        starts = [self.clamped] + [[e] for e in self.open] + [[-1 - t] for t in range(count)]
        for k, edges in enumerate(starts):
            begin = len(order)
            for e in edges:
                t = int(mesh.owners[e, 0]) if e >= 0 else -1 - e
                if self.component[t] < 0:
                    self.component[t] = 0 if k == 0 else len(self.roots) + 1
                    self.parent[t] = e if k == 0 else -1
                    order.append(t)
                    if k:
                        self.roots.append((t, e))
            while begin < len(order):
                t = order[begin]
                begin += 1
                for e, o in zip(mesh.sides[t].tolist(), other[t]):
                    if o >= 0 and self.component[o] < 0:
                        self.component[o], self.parent[o] = self.component[t], e
                        order.append(o)
        return order, list(range(1, len(self.roots) + 1))

    def _balance(self, residual, floating):
        """Brings components without a clamped edge into balance as a whole, by closed contacts and rollers."""
        mesh = self.mesh
        centres = {c: mesh.exact(mesh.triangles[self.roots[c - 1][0], 0]) for c in floating}
        total = []
        for c in floating:
            x, y, m = (Q(sum(residual[self.component == c, k].tolist()), ONE) for k in range(3))
            total += [x, y, m - centres[c][0] * y + centres[c][1] * x]
        terms = [t for t in self.terms if not t.presses or t.value < 0]
        matrix = [[Q(0)] * len(terms) for _ in total]
        for v, term in enumerate(terms):
            for e, tau in term.tractions.items():
                c = int(self.component[mesh.owners[e, 0]])
                if c:
                    a, b = (mesh.exact(v) for v in mesh.edges[e].tolist())
                    arm, d = [(x + y) / 2 - z for x, y, z in zip(a, b, centres[c])], [y - x for x, y in zip(a, b)]
                    f, g = (tau + [[Q(0)] * 2])[:2]
                    for k, x in enumerate((f[0], f[1], arm[0] * f[1] - arm[1] * f[0] + (d[0] * g[1] - d[1] * g[0]) / 6)):
                        matrix[3 * (c - 1) + k][v] += x
        # Balances that nothing takes part in hold exactly, or are left.
        rows = [i for i, row in enumerate(matrix) if any(row)]
        left = any(total[i] for i in set(range(len(total))) - set(rows))
        off = self._solve([total[i] for i in rows], [matrix[i] for i in rows], terms) if rows else 0.0
        if off is None or left:
            # As an additional load on an edge of each: its size is told, and its work is part of the upper bound.
            for t, e in self.roots:
                if e < 0:
                    raise Refused("a body that only contacts and rollers hold cannot be brought into balance exactly")
                self.parent[t] = e
        self.error *= 1 + (off or 0.0)
        self._set_terms(self.error)
        return self._residuals()

    def _solve(self, total, matrix, terms):
        """Changes coefficients by about the least that balances, then exactly by as many as there are balances. Returns by how much more than
        `total` coefficients and forces may be off; None where the balance is not exact."""
        room = np.array([abs(float(t.value)) if t.presses else self.scale + 1e-300 for t in terms])
        a = np.array([[float(x) for x in row] for row in matrix])
        scaled = a * room
        norms = np.sqrt((scaled**2).sum(1)) + 1e-300
        scaled /= norms[:, None]
        step = np.linalg.lstsq(scaled, -np.array([float(x) for x in total]) / norms, rcond=1e-10)[0] * room
        changed = [t.value + Q(x) for t, x in zip(terms, step.tolist())]
        chosen, rest = [], scaled.copy()
        for _ in total:
            sizes = (rest**2).sum(0)
            chosen.append(int(np.argmax(sizes)))
            q = rest[:, chosen[-1]] / np.sqrt(sizes[chosen[-1]] + 1e-300)
            rest = rest - np.outer(q, q @ rest)
        if any(t.presses and x >= 0 for t, x in zip(terms, changed)):
            return None
        rational = lambda x: fmpq(x.numerator, x.denominator)
        square = fmpq_mat(len(total), len(total), [rational(row[j]) for row in matrix for j in chosen])
        exact = sizes.max() > 1e-18 and square.det() != 0
        if exact:
            inverse = square.inv()
            missing = [t + sum(x * (y - s.value) for x, y, s in zip(row, changed, terms) if x) for t, row in zip(total, matrix)]
            for j, (x,) in zip(chosen, (inverse * fmpq_mat(len(total), 1, [rational(-x) for x in missing])).table()):
                changed[j] += Q(int(x.p), int(x.q))
            norm = max(sum(abs(int(x.p) / int(x.q)) for x in row) for row in inverse.table())
            exact = all(x < -4 * norm * self.error for t, x in zip(terms, changed) if t.presses)
        worst = max(abs(float(x - t.value)) for t, x in zip(terms, changed))
        if worst > ROUNDING * max(self.scale, room.max()):
            raise Refused(f"a body that only contacts and rollers hold is out of balance: a traction would have to change by {worst:.3e}")
        if any(t.presses and x > 0 for t, x in zip(terms, changed)):
            return None
        for term, x in zip(terms, changed):
            term.value = x
        return 8 * norm * max(1.0, np.abs(a).max()) * len(terms) if exact else None

    def _mend(self, order, residual, error):
        """Passes on what is missing, leaves first, to the edges of the trees."""
        mesh, missing, edges, changes = self.mesh, residual, [], []
        for t in reversed(order):
            e = self.parent[t]
            if e >= 0:
                first = mesh.owners[e, 0] == t
                edges.append(e)
                changes.append(-missing[t] if first else missing[t])
                other = mesh.owners[e, int(first)]
                if other >= 0:
                    missing[other] = missing[other] + missing[t]
        if not edges:
            return
        which, change = np.array(edges), np.array(changes, object).reshape(-1, 3)
        mid, d = self._vectors(which)
        # What is left of the moment about the middle of the edge is d x tau_1 / 6.
        turning = 6 * (change[:, 2] - times(mid[:, 0], change[:, 1]) + times(mid[:, 1], change[:, 0]))
        first, cross = ball_of(change[:, :2], error), ball_of(turning, error)
        (x, y) = (ball_of(d[:, i], 1e-90) for i in range(2))
        over = (x.square() + y.square()).inverse()
        second = stack([-(cross * y) * over, cross * x * over], 1)
        by_edge = np.maximum(np.abs(first.mid).max(1), np.abs(second.mid).max(1))
        at, self.mended = int(np.argmax(by_edge)), float(by_edge.max())
        if self.mended > ROUNDING * self.scale:
            raise Refused(
                f"the stress is not in equilibrium: edge {which[at]} of triangles {mesh.owners[which[at]].tolist()} would have to carry "
                f"{self.mended:.3e} more, the largest force of an edge being {self.scale:.3e}"
            )
        for k, by in ((0, first), (1, second)):
            self.tau.put((which, k), self.tau[which, k] + by)
        loaded = np.isin(which, self.open)
        if loaded.any():
            self.extra = float(sum((abs(by.mid[loaded]) + by.rad[loaded]).sum() for by in (first, second))) * (1 + 1e-9)
            mesh.premises.append(f"a body that contacts and rollers alone hold is in balance but for {self.extra:.1e}, which is taken for an additional load")

    # 3. Energies.

    def bound(self):
        """A number that -Pi of an admissible stress is not below, thickness included."""
        mesh, total = self.mesh, Q(0)
        compliance = mesh.by_body(mesh.scene.compliance)
        heavy = np.array([any(mesh.scene.bodies[name][2]) for name in mesh.body_names])
        carries = (abs(self.tau.mid) + self.tau.rad).any((1, 2))
        acted = carries[mesh.sides].any(1) | heavy[mesh.bodies]
        for p in np.unique(self.degrees):
            own = np.flatnonzero((self.degrees == p) & acted)
            for which in np.array_split(own, max(1, len(own) * p * p // 20000)):
                total -= Q(float(self._energies(which, int(p), [m[which] for m in compliance]).sum()[1]))
        for e in (e for e in self.clamped if carries[e]):
            ends = [mesh.conditions[e].data.at(mesh.written(v)) for v in mesh.edges[e].tolist()]
            for c in range(2):
                mean, slope = (ends[0][c] + ends[1][c]) / 2, (ends[1][c] - ends[0][c]) / 6
                if mean or slope:
                    work = self.tau[e, 0, c] * of_fractions([mean]) + self.tau[e, 1, c] * of_fractions([slope])
                    total += Q(float(work.sum()[0]))
        for term in self.terms:
            for e, tau in () if term.presses else term.tractions.items():
                u0, n = mesh.conditions[e].data, mesh.directions[e]
                if u0 and len(tau) == 1:
                    total += min(term.value * u0 * length for length in root(n[0] ** 2 + n[1] ** 2)) - abs(u0) * Q(self.error) * 4
        for pair, b in zip(mesh.pairs, self.pressed):
            for i, term in enumerate(b):
                for j, g in enumerate(pair.gap):
                    work = term.value * (g + pair.excess) * reference.product(len(b) - 1, i, len(pair.gap) - 1, j)
                    total += min(work * length for length in pair.length)
            total -= Q(self.error) * 4 * max(abs(g) for g in pair.gap) * pair.length[1]
        return total * mesh.scene.thickness

    def _energies(self, which, p, compliance):
        mesh, count = self.mesh, len(which)
        (a, b), (c, d) = [[m[which] for m in row] for row in mesh.map]
        tau = Ball(np.zeros((3, p + 1, 2, count))).writable()
        flip = np.where(np.arange(p + 1) % 2 == 0, -1.0, 1.0)  # -tau(1 - s), from the right of an edge
        for i in range(3):
            own = self.tau[mesh.sides[which, i], : p + 1]
            turned = np.where(mesh.signs[which, i, None] > 0, 1.0, flip[None])[:, :, None]
            tau.put(i, Ball(np.moveaxis(own.mid * turned, 0, 2), np.moveaxis(own.rad, 0, 2)))
        f = [np.array([float(mesh.scene.bodies[n][2][k]) for n in mesh.body_names])[mesh.bodies[which]] for k in range(2)]
        adjugate = lambda x, y: (d * x - b * y, a * y - c * x)
        pulled = stack(adjugate(tau[:, :, 0], tau[:, :, 1]), 2).reshape(6 * (p + 1), count)
        force = adjugate(*(Ball(x, abs(x) * EPS) * mesh.jacobian[which] for x in f))
        data = Ball(*(np.concatenate([getattr(pulled, k), getattr(force[0], k)[None], getattr(force[1], k)[None]]) for k in ("mid", "rad")))
        special, free, norms = reference.stresses(p)
        n = len(norms)
        s = data.times(special)
        if free is not None:
            s = s + Ball(self._least(s.mid, free.mid, norms, [x.mid for x in (a, b, c, d)], [x.mid for x in compliance])).times(free)
        s = s.reshape(3, 3, n, count)
        xx, yy, xy = s[:, 0], s[:, 1], s[:, 2]
        # B s^ B^T
        one, two = a * xx + b * xy, a * xy + b * yy
        three, four = c * xx + d * xy, c * xy + d * yy
        xx, yy, xy = one * a + two * b, three * c + four * d, one * c + two * d
        density = (xx + yy).square() * compliance[0] + (xx - yy).square() * compliance[1] + xy.square() * compliance[2]
        weight = constants([norms])
        total = density.times(weight, 1)[:, 0]
        cube = mesh.jacobian[which]
        return (total[0] + total[1] + total[2]) * (cube.square() * cube).inverse() * constants([[Q(1, 6)]])[0, 0]

    @staticmethod
    def _least(s, free, norms, map_, compliance):
        """Coefficients of the fields without traction that make the energy small; nothing is claimed of them."""
        n, (a, b, c, d), (u, v, w) = len(norms), map_, compliance
        rows = np.array([[a * a, b * b, 2 * a * b], [c * c, d * d, 2 * c * d], [a * c, b * d, a * d + b * c]])  # B s^ B^T
        q = u * (rows[0] + rows[1])[:, None] * (rows[0] + rows[1]) + v * (rows[0] - rows[1])[:, None] * (rows[0] - rows[1]) + w * rows[2][:, None] * rows[2]
        weight = np.array([float(x) for x in norms])[None, :, None]
        z = free.reshape(3, 3, n, -1)
        own, count = s.reshape(3, 3, n, -1), s.shape[1]
        hessian = np.zeros((count, z.shape[3], z.shape[3]))
        gradient = np.zeros((count, z.shape[3]))
        for i in range(3):
            left = (z[:, i] * weight).reshape(3 * n, -1)
            for j in range(3):
                hessian += q[i, j][:, None, None] * (left.T @ z[:, j].reshape(3 * n, -1))
                gradient += q[i, j][:, None] * (left.T @ own[:, j].reshape(3 * n, -1)).T
        try:
            return -np.linalg.solve(hessian, gradient[:, :, None])[:, :, 0].T
        except np.linalg.LinAlgError:
            return np.zeros((z.shape[3], count))


def load(mesh, e, condition):
    """Legendre coefficients tau_0, tau_1 of the load on an edge."""
    a, b = mesh.edges[e].tolist()
    n = mesh.normal(a, b)
    if not hasattr(condition.data, "at"):
        return [[-condition.data * x for x in n]]
    ends, length = [condition.data.at(mesh.written(v)) for v in (a, b)], root(n[0] ** 2 + n[1] ** 2)[0]
    return [[length * (x + y) / 2 for x, y in zip(*ends)], [length * (y - x) / 2 for x, y in zip(*ends)]]


def contact_traction(pair, b):
    """Legendre coefficients of b(s) n(s), n(s) times the length of the pair, as seen from its first side."""
    m, n = pair.ends
    if pair.turns():
        k = len(b)
        product = [[((k - i) * (b[i] if i < k else 0) * m[c] + i * (b[i - 1] if i else 0) * n[c]) / Q(k) for c in range(2)] for i in range(k + 1)]
    else:
        product = [[x * m[c] for c in range(2)] for x in b]
    rows = reference.to_legendre(len(product) - 1)
    return [[sum(w * x[c] for w, x in zip(row, product)) for c in range(2)] for row in rows]
