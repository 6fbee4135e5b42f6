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


class Stress:
    def __init__(self, mesh, data):
        self.mesh = mesh
        counts, values = data["traction_counts"].astype(int), data["tractions"]
        self.pair_counts = data["pressure_counts"].astype(int)
        if len(counts) != len(mesh.edges) or counts.sum() != len(values) or len(self.pair_counts) != len(mesh.pairs):
            raise Refused("the proof does not have a traction for every edge and contact pair")
        if self.pair_counts.sum() != len(data["pressures"]) or counts.min(initial=2) < 2 or not np.isfinite(values).all():
            raise Refused("the tractions of the proof are incomplete")
        self.degrees = data["stress_degrees"].astype(int).copy()
        most = max([counts.max() - 1, self.degrees.max(), 1] + [n - 1 + p.turns() for n, p in zip(self.pair_counts, mesh.pairs)])
        self.most = int(most)
        self.tau = Ball(np.zeros((len(counts), self.most + 1, 2)))
        self.tau.rad = np.zeros(self.tau.mid.shape)
        self.force = np.zeros((len(counts), 3), object)  # force and moment about the origin, fixed point
        self._candidates(counts, values)
        self._given()
        self._contacts(data["pressures"])
        self._raise_degrees()
        self.size = max(1.0, float(np.abs(mesh.points).max()))
        self.scale = float(np.abs(self.tau.mid).max(initial=0.0))
        self.error = 0.0  # of the forces of trees, in absolute numbers
        residual = self._residuals()
        residual = self._float_bodies(residual)
        self._mend(residual)

    # 1. Tractions of edges.

    def _vectors(self, which):
        a, b = (self.mesh.fixed[self.mesh.edges[which, i]] for i in range(2))
        return (a + b) >> 1, b - a

    def _set_forces(self, which, first, second):
        """Force and moment from the fixed-point coefficients tau_0 and tau_1."""
        mid, d = self._vectors(which)
        cross = lambda x, y: times(x[:, 0], y[:, 1]) - times(x[:, 1], y[:, 0])
        self.force[which, :2] = first
        self.force[which, 2] = cross(mid, first) + cross(d, second) // 6

    def _candidates(self, counts, values):
        mesh, start = self.mesh, np.concatenate([[0], np.cumsum(counts)])
        lengths = np.hypot(*(mesh.points[mesh.edges[:, 1]] - mesh.points[mesh.edges[:, 0]]).T)
        kinds = np.array([mesh.kind(e) for e in range(len(counts))])
        for n in np.unique(counts):
            which = np.flatnonzero((counts == n) & np.isin(kinds, ("inside", "clamped", "roller")))
            own = values[start[which][:, None] + np.arange(n)] * lengths[which, None, None]
            matrix = np.array([[float(x) for x in row] for row in reference.to_legendre(n - 1)])
            self.tau.mid[which, :n] = np.einsum("ki,eic->ekc", matrix, own)
        free = np.flatnonzero(np.isin(kinds, ("inside", "clamped")))
        self._set_forces(free, fixed(self.tau.mid[free, 0]), fixed(self.tau.mid[free, 1]))
        self.clamped = set(np.flatnonzero(kinds == "clamped").tolist())
        self.rollers = {}
        for e in np.flatnonzero(kinds == "roller").tolist():
            n = np.array([float(x) for x in mesh.directions[e]])
            self.rollers[e] = [Q(x) for x in (self.tau.mid[e] @ n / (n @ n)).tolist()]
            self._set_roller(e)

    def _set_exact(self, e, coefficients, error=0.0):
        """A traction with Legendre coefficients that are fractions (a list of vectors)."""
        self.tau.put(e, Ball(np.zeros((self.most + 1, 2))))
        for k, c in enumerate(coefficients):
            ball = of_fractions(c)
            self.tau.put((e, k), Ball(ball.mid, ball.rad + error))
        two = (coefficients + [[Q(0), Q(0)]])[:2]
        self._set_forces(np.array([e]), *(fixed(np.array(c, object))[None] for c in two))

    def _set_roller(self, e):
        n = self.mesh.directions[e]
        self._set_exact(e, [[b * n[0], b * n[1]] for b in self.rollers[e]])

    def _given(self):
        """Loads: exactly, but for lengths that are no fraction, which are taken to BITS places."""
        mesh = self.mesh
        for e, condition in enumerate(mesh.conditions):
            if condition and condition.kind == "load":
                self._set_exact(e, load(mesh, e, condition))

    # b(s) n(s) on contacts.

    def _contacts(self, pressures):
        start = np.concatenate([[0], np.cumsum(self.pair_counts)])
        largest = max(np.abs(pressures).max(initial=0.0), 1e-300)
        self.pressures = []
        for k, pair in enumerate(self.mesh.pairs):
            own = [Q(x) for x in pressures[start[k] : start[k + 1]].tolist()]
            if max(own, default=0) > ROUNDING * largest:
                raise Refused(f"the contact traction of pair {k} pulls: {float(max(own)):.3e} is above zero")
            self.pressures.append([min(x, Q(0)) for x in own])
            self._set_pair(k)

    def _set_pair(self, k, error=0.0):
        pair, b = self.mesh.pairs[k], self.pressures[k]
        tau = contact_traction(pair, b)
        error *= float(max(abs(x) for n in pair.ends for x in n)) * 4 * 9
        for e, ends, sign in ((pair.edges[0], pair.first, 1), (pair.edges[1], pair.second, -1)):
            if e >= 0:
                along = ends[0] == self.mesh.edges[e, 0]
                self._set_exact(e, [[sign * x if along or i % 2 == 0 else -sign * x for x in c] for i, c in enumerate(tau)], error)

    def _raise_degrees(self):
        """A triangle needs the degree of its tractions: any field that has them will do."""
        there = (np.abs(self.tau.mid).max(2) + self.tau.rad.max(2)) > 0
        needed = np.where(there.any(1), self.most - there[:, ::-1].argmax(1), 0)
        self.degrees = np.maximum(np.maximum(self.degrees, 1), needed[self.mesh.sides].max(1))

    # 2. Balances.

    def _residuals(self):
        mesh = self.mesh
        out = np.zeros((len(mesh.triangles), 3), object)
        for i in range(3):
            out = out + mesh.signs[:, i, None].astype(object) * self.force[mesh.sides[:, i]]
        for b, name in enumerate(mesh.body_names):
            f = fixed(np.array(mesh.scene.bodies[name][2], object))
            own = np.flatnonzero(mesh.bodies == b)
            if f[0] or f[1]:
                for c in range(2):
                    out[own, c] += times(mesh.det[own], f[c]) >> 1
                centre = mesh.fixed[mesh.triangles[own]].sum(1)
                out[own, 2] += times(mesh.det[own], times(centre[:, 0], f[1]) - times(centre[:, 1], f[0])) // 6
        return out

    def _neighbours(self, t):
        for i in range(3):
            e = self.mesh.sides[t, i]
            other = self.mesh.owners[e, 1 if self.mesh.signs[t, i] > 0 else 0]
            if other >= 0:
                yield e, other

    def _forest(self):
        """Triangles, parents first; the edge to the parent (a clamped one for roots, -1 where there is none) and the component."""
        count = len(self.mesh.triangles)
        self.parent_edge, self.component, order = np.full(count, -1), np.full(count, -1), []
        self.bodies_held = []

        def grow(begin):
            while begin < len(order):
                t = order[begin]
                begin += 1
                for e, other in self._neighbours(t):
                    if self.component[other] < 0:
                        self.component[other], self.parent_edge[other] = self.component[t], e
                        order.append(other)

        # Components first, then trees from all clamped edges of each at once.
        for t in range(count):
            if self.component[t] < 0:
                self.component[t] = len(self.bodies_held)
                self.bodies_held.append(False)
                order.append(t)
                grow(len(order) - 1)
        component, self.component = self.component, np.full(count, -1)
        order.clear()
        for e in sorted(self.clamped):
            t = self.mesh.owners[e, 0]
            self.bodies_held[component[t]] = True
            if self.component[t] < 0:
                self.component[t], self.parent_edge[t] = component[t], e
                order.append(t)
        grow(0)
        for t in range(count):
            if self.component[t] < 0:
                self.component[t], self.parent_edge[t] = component[t], -1
                order.append(t)
                grow(len(order) - 1)
        return order

    def _float_bodies(self, residual):
        """Brings components without a clamped edge into balance as a whole, by closed contacts and rollers."""
        self.order = self._forest()
        largest = 1 + max(float(abs(x)) for body in self.mesh.scene.bodies.values() for x in body[2])
        self.error = ROUNDINGS * (len(self.mesh.edges) + len(self.mesh.triangles)) * (1 + self.size) ** 2 * (1 + self.scale) * largest / 2.0**BITS
        floating = [c for c, held in enumerate(self.bodies_held) if not held]
        if not floating:
            return residual
        rows = {c: i for i, c in enumerate(floating)}
        component = lambda e: rows.get(self.component[self.mesh.owners[e, 0]])
        total = [sum(residual[self.component == c, k].tolist()) for c in floating for k in range(3)]
        variables, columns = [], []
        for e, b in self.rollers.items():
            for k in range(2) if component(e) is not None else ():
                variables.append(("roller", e, k))
                columns.append([(component(e), self._unit_roller(e, k))])
        for p, pair in enumerate(self.mesh.pairs):
            touched = [component(e) if e >= 0 else None for e in pair.edges]
            for j, b in enumerate(self.pressures[p]):
                if b < 0 and touched != [None, None]:
                    unit = self._unit_pair(p, j)
                    variables.append(("pair", p, j))
                    columns.append([(row, f) for row, f in zip(touched, unit) if row is not None])
        matrix = np.zeros((3 * len(floating), len(variables)), object)
        for v, column in enumerate(columns):
            for row, f in column:
                matrix[3 * row : 3 * row + 3, v] += f
        # Rows of zeros are balances that nothing can change: they hold exactly, or the scene has no equilibrium.
        wanted = [i for i in range(len(total)) if any(matrix[i])]
        for i in set(range(len(total))) - set(wanted):
            if total[i]:
                what = ("horizontal forces", "vertical forces", "moments")[i % 3]
                body = self.mesh.body_names[self.mesh.bodies[np.argmax(self.component == floating[i // 3])]]
                raise Refused(f"the {what} on body '{body}' are out of balance by {total[i] / ONE:.3e}, and nothing that holds it can change that")
        if wanted:
            self._solve([total[i] for i in wanted], matrix[wanted], variables)
            residual = self._residuals()
        return residual

    def _unit_roller(self, e, k):
        n, (mid, d) = self.mesh.directions[e], self._edge(e)
        cross = (mid[0] * n[1] - mid[1] * n[0]) if k == 0 else (d[0] * n[1] - d[1] * n[0]) / 6
        return fixed(np.array([n[0] * (k == 0), n[1] * (k == 0), cross], object))

    def _edge(self, e):
        a, b = (self.mesh.exact(v) for v in self.mesh.edges[e].tolist())
        return [(x + y) / 2 for x, y in zip(a, b)], [y - x for x, y in zip(a, b)]

    def _unit_pair(self, p, j):
        pair = self.mesh.pairs[p]
        tau = contact_traction(pair, [Q(int(i == j)) for i in range(len(self.pressures[p]))])[:2] + [[Q(0)] * 2]
        out = []
        for e, ends, sign in ((pair.edges[0], pair.first, 1), (pair.edges[1], pair.second, -1)):
            if e < 0:
                out.append(None)
                continue
            a, b = (self.mesh.exact(v) for v in ends)
            mid, d = [(x + y) / 2 for x, y in zip(a, b)], [y - x for x, y in zip(a, b)]
            moment = mid[0] * tau[0][1] - mid[1] * tau[0][0] + (d[0] * tau[1][1] - d[1] * tau[1][0]) / 6
            out.append(fixed(np.array([sign * x for x in (*tau[0], moment)], object)))
        return out

    def _solve(self, total, matrix, variables):
        """Changes the coefficients: by about the least that balances, then exactly by as many as there are balances."""
        value = lambda v: self.rollers[v[1]][v[2]] if v[0] == "roller" else self.pressures[v[1]][v[2]]
        a = np.array([[x / ONE for x in row] for row in matrix])
        room = np.array([abs(float(value(v))) if v[0] == "pair" else self.scale + 1e-300 for v in variables])
        scaled = a * room
        norms = np.sqrt((scaled**2).sum(1))
        if not (norms > 0).all():
            raise Refused("nothing that presses can balance a body that only contacts and rollers hold")
        scaled = scaled / norms[:, None]
        step = np.linalg.lstsq(scaled, -np.array([x / ONE for x in total]) / norms, rcond=1e-11)[0] * room
        chosen, left = [], scaled.copy()
        for _ in range(len(total)):
            sizes = (left**2).sum(0)
            j = int(np.argmax(sizes))
            if sizes[j] < 1e-18:
                raise Refused("a body that only contacts and rollers hold can move freely, and its balance cannot be made exact")
            chosen.append(j)
            q = left[:, j] / np.sqrt(sizes[j])
            left = left - np.outer(q, q @ left)
        exact_step = fixed(step)
        for i in range(len(total)):
            total[i] += sum(times(x, s) for x, s in zip(matrix[i].tolist(), exact_step.tolist()))
        square = fmpq_mat(len(total), len(total), [fmpq(int(matrix[i, j]), ONE) for i in range(len(total)) for j in chosen])
        inverse = square.inv()
        last = inverse * fmpq_mat(len(total), 1, [fmpq(-int(x), ONE) for x in total])
        for j, x in zip(chosen, (row[0] for row in last.table())):
            exact_step[j] += int((x * ONE).floor())
        # The real solution differs from the fixed-point one by what the inverse makes of the roundings.
        norm = max(sum(abs(float(int(x.p) / int(x.q))) for x in row) for row in inverse.table())
        largest = max(abs(a).max(), 1.0)
        off = 2 * norm * (self.error * 2 + len(variables) * (largest + room.max() + 1) * 2.0**-BITS * 4) + 2.0**-BITS
        self.error += off * largest * len(total) * 4
        changed = set()
        for v, s in zip(variables, exact_step.tolist()):
            change = Q(s, ONE)
            if abs(float(change)) > ROUNDING * max(self.scale, room.max()):
                raise Refused(f"a body that only contacts and rollers hold is out of balance: a traction would have to change by {float(change):.3e}")
            if v[0] == "roller":
                self.rollers[v[1]][v[2]] += change
            else:
                self.pressures[v[1]][v[2]] += change
                if float(self.pressures[v[1]][v[2]]) > -2 * off:
                    raise Refused("a contact traction that has to balance a body would pull")
            changed.add(v[:2])
        self.off = off
        for kind, which in changed:
            if kind == "pair":
                self._set_pair(which, off)
            else:
                self._set_roller(which)
                self.tau.rad[which] += off * float(max(abs(x) for x in self.mesh.directions[which])) * 2

    def _mend(self, residual):
        """Passes on what is missing, leaves first, to the edges of the trees."""
        mesh, missing = self.mesh, residual.copy()
        edges, changes = [], []
        for t in reversed(self.order):
            e = self.parent_edge[t]
            if e < 0:
                continue
            sign = 1 if mesh.owners[e, 0] == t else -1
            own = missing[t]
            edges.append(e)
            changes.append([-sign * x for x in own])
            other = mesh.owners[e, 1] if mesh.owners[e, 0] == t else mesh.owners[e, 0]
            if other >= 0:
                missing[other] = missing[other] + own
        if not edges:
            return
        which = np.array(edges)
        change = np.array(changes, object).reshape(-1, 3)
        mid, d = self._vectors(which)
        # What is left of the moment about the middle of the edge is d x tau_1 / 6.
        turning = 6 * (change[:, 2] - times(mid[:, 0], change[:, 1]) + times(mid[:, 1], change[:, 0]))
        error = 64 * self.error * (1 + self.size)
        first, cross = ball_of(change[:, :2], error), ball_of(turning, error)
        (x, y) = (ball_of(d[:, i], 1e-90) for i in range(2))
        over = (x.square() + y.square()).inverse()
        second = stack([-(cross * y) * over, cross * x * over], 1)
        worst = max(np.abs(first.mid).max(), np.abs(second.mid).max())
        self.mended = float(worst)
        if worst > ROUNDING * self.scale:
            at = int(np.argmax(np.maximum(np.abs(first.mid).max(1), np.abs(second.mid).max(1))))
            t = mesh.owners[which[at]]
            raise Refused(f"the stress is not in equilibrium: edge {which[at]} of triangles {t.tolist()} would have to carry {worst:.3e} more, the largest force of an edge being {self.scale:.3e}")
        for k, by in ((0, first), (1, second)):
            self.tau.put((which, k), self.tau[which, k] + by)

    # 3. Energies.

    def bound(self):
        """A number that -Pi of an admissible stress is not below, thickness included."""
        mesh, total = self.mesh, Q(0)
        compliance = mesh.material(mesh.scene.compliance)
        for p in np.unique(self.degrees):
            for which in np.array_split(np.flatnonzero(self.degrees == p), max(1, (self.degrees == p).sum() * p * p // 20000)):
                total -= Q(float(self._energies(which, int(p), [m[which] for m in compliance]).sum()[1]))
        for e in sorted(self.clamped):
            ends = [mesh.conditions[e].data.at(mesh.written(v)) for v in mesh.edges[e].tolist()]
            for c in range(2):
                mean, slope = (ends[0][c] + ends[1][c]) / 2, (ends[1][c] - ends[0][c]) / 6
                if mean or slope:
                    work = self.tau[e, 0, c] * of_fractions([mean]) + self.tau[e, 1, c] * of_fractions([slope])
                    total += Q(float(work.sum()[0]))
        for e, b in self.rollers.items():
            u0, n = mesh.conditions[e].data, mesh.directions[e]
            if u0:
                total += min(b[0] * u0 * length for length in root(n[0] ** 2 + n[1] ** 2)) - abs(u0) * Q(self.error) * 4
        for pair, b in zip(mesh.pairs, self.pressures):
            p, q = len(b) - 1, len(pair.gap) - 1
            for i in range(p + 1):
                for j in range(q + 1):
                    work = b[i] * (pair.gap[j] + pair.excess) * reference.product(p, i, q, j)
                    total += min(work * length for length in pair.length)
            total -= Q(self.error) * 4 * max(abs(g) for g in pair.gap) * pair.length[1]
        return total * mesh.scene.thickness

    def _energies(self, which, p, compliance):
        mesh, count = self.mesh, len(which)
        (a, b), (c, d) = [[m[which] for m in row] for row in mesh.map]
        tau = Ball(np.zeros((3, p + 1, 2, count)))
        tau.rad = np.zeros(tau.mid.shape)
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
