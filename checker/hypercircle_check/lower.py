"""The lower bound: an admissible stress near the candidate, and its energy.

1. On every edge the scaled traction tau(s) = length times traction, as seen from the triangle on its left, is a polynomial in s: the load where
   there is one, b(s) n(s) on a joint of one direction (b <= 0 where it can only press), the sum of two such on a contact with friction, of
   which the second, along the contact, lies between its bounds, and the candidate on inner edges and others with two joints. A triangle is
   in equilibrium if the forces and moments about the origin of its edges add up to zero with those of its body force.
2. What is missing is passed on along trees of triangles that are rooted at edges held in both directions; the edge to the parent takes it. Bodies
   without such an edge are first brought into balance as a whole by the b of closed contacts, of friction and of rollers, the solution of a
   linear system. The traction of the proof is *defined* as that for which every balance holds; the balls of the arithmetic enclose it.
3. In each triangle some stress has these tractions (`reference`); its energy is enclosed.
"""

from collections import deque
from math import lcm

import numpy as np
from flint import arb, arb_mat, fmpq

from . import Refused, reference
from .exact import balls, by_component, cross, dot, length, lower, mean, raised, times, upper, zero

ROUNDING = 1e-7  # changes beyond this part of the largest traction are no rounding
NEARLY = 2.0**-36  # balances of bodies that contacts alone hold may miss this part of it where they depend on each other


def load(mesh, e):
    """Bernstein coefficients of the traction that the scene prescribes on an edge: zero on free edges."""
    held, n = mesh.conditions[e], mesh.normal(e)
    if not held or held.kind != "load":
        return [[fmpq(0)] * 2] * 2
    pressure, traction = held.data
    size = length(n) if traction else 0
    return [[size * x - pressure * y for x, y in zip(traction.at(mesh.written(v)), n)] for v in mesh.edges[e].tolist()]


HIGHEST = 24  # Degrees beyond this have no use, and matrices that fill the memory.


class Stress:
    def __init__(self, mesh, data):
        self.mesh, self.extra = mesh, arb(0)
        counts, values, self.degrees = data["traction_counts"].astype(int), data["tractions"], data["stress_degrees"].tolist()
        sizes = [len(x) for x in (counts, values, self.degrees)]
        if sizes != [len(mesh.edges), counts.sum(), len(mesh.triangles)] or counts.min() < 2:
            raise Refused("the proof does not have a traction for every edge")
        if max(self.degrees) > HIGHEST:
            raise Refused(f"the proof has a stress of degree {max(self.degrees)}; none is above {HIGHEST}")
        if not np.isfinite(values).all():
            raise Refused("a traction of the proof is no number")
        self._candidates(np.split(values, np.cumsum(counts)[:-1]), data)
        self.scale = max(max(abs(float(x)) for tau in self.tau for c in tau for x in c), self.resting)
        # Balances are counted in a unit that makes all weights whole: sums of doubles then have no error.
        self.unit = 24 * lcm(*range(1, max(map(len, self.tau)) + 2))
        self.component, self.parent, self.roots = [-1] * len(mesh.triangles), [-1] * len(mesh.triangles), []
        order = self._forest()
        if self.roots:
            self._balance()
        self._mend(order)
        for t, sides in enumerate(mesh.sides.tolist()):  # any field with the tractions will do; it needs their degree
            turns = mesh.scene.forces[mesh.body(t)].varies()
            self.degrees[t] = max(self.degrees[t], 1 + turns, *(len(self.tau[e]) - 1 for e in sides))

    # 1. Tractions of edges.

    def _of_contacts(self, data):
        """(number of its pair, joint, b of the proof) of the joints of contacts: those that press, then those with friction."""
        pairs = {joint.edges: k for k, joint in enumerate(joint for joint in self.mesh.joints if joint.presses)}
        for what, of in (("pressure", lambda joint: joint.presses), ("friction", lambda joint: joint.bound)):
            if joints := [joint for joint in self.mesh.joints if of(joint)]:
                counts, values = data[f"{what}_counts"].astype(int), data["pressures" if what == "pressure" else "frictions"]
                if [len(counts), len(values)] != [len(pairs), counts.sum()]:
                    raise Refused(f"the proof does not have a {what} for every contact pair")
                if not np.isfinite(values).all():
                    raise Refused(f"a {what} of the proof is no number")
                own = np.split(values, np.cumsum(counts)[:-1])
                yield from ((pairs[joint.edges], joint, own[pairs[joint.edges]].tolist() or [0.0]) for joint in joints)

    def _candidates(self, values, data):
        """Sets tau and b from the proof, and the number of directions in which the traction of an edge is unknown."""
        mesh = self.mesh
        lengths = np.hypot(*(mesh.points[mesh.edges[:, 1]] - mesh.points[mesh.edges[:, 0]]).T)
        # The largest stress and force that initial strain makes where all is held.
        strained = ((mesh.scene.laws[mesh.body(t)][1], e) for t in range(len(mesh.triangles)) if (e := mesh.corners(mesh.scene.strains, t)))
        stress = max((abs(float(x)) for stiffness, e in strained for x in (stiffness * arb_mat(e)).entries()), default=0.0)
        self.resting = stress * lengths.max()
        contacts = list(self._of_contacts(data))
        largest = max(stress, *(np.abs(x).max(initial=0.0) for x in values), *(abs(b) for *_, own in contacts for b in own))
        for k, joint, own in contacts:
            limits = joint.limits(len(own))
            beyond = max(max(float(low - b), float(b - high)) for b, (low, high) in zip(own, limits))
            if beyond > ROUNDING * largest:
                what = "contact traction of pair {k} pulls" if joint.presses else "friction of pair {k} is above its bound"
                raise Refused(f"the {what.format(k=k)}, by {beyond:.3e}")
            joint.pressure = [max(low, min(arb(b), high)) for b, (low, high) in zip(own, limits)]
        self.directions = [2 if left >= 0 and right >= 0 else 0 for left, right in mesh.owners.tolist()]
        for joint in mesh.joints:
            for e in (e for e in joint.edges[: 1 + joint.limited] if e >= 0):
                self.directions[e] = 1 if joint.limited else self.directions[e] + 1
        self.single = [joint for joint in mesh.joints if self.directions[joint.edges[0]] == 1]
        for joint in self.single:
            if not joint.limited:
                e, n = joint.edges[0], np.array([float(x) for x in joint.normal[0]])
                joint.pressure = [arb(b) for b in (values[e] @ n * lengths[e] / (n @ n)).tolist()]
        for e, f, _ in mesh.layers:  # the two sides of a layer become one edge: tractions on them are equal and opposite
            t = mesh.owners[f, 0]
            i = mesh.sides[t].tolist().index(f)
            mesh.sides[t, i], mesh.signs[t, i], mesh.owners[e, 1], self.directions[f] = e, -1, t, -1
        self.tau = [balls(own * size).tolist() if n == 2 else load(mesh, e) for e, (own, size, n) in enumerate(zip(values, lengths, self.directions))]
        self._set()

    def _sides(self, joint, b):
        """(edge, tau) of the sides of a joint with the traction b n."""
        product = by_component(lambda n: times(b, n), joint.normal)
        for e, start, sign in zip(joint.edges, joint.starts, (1, -1)):
            if e >= 0:
                yield e, [[sign * x for x in c] for c in (product if start == self.mesh.edges[e, 0] else product[::-1])]

    def _set(self):
        parts = {}
        for joint in self.single:
            for e, tau in self._sides(joint, joint.pressure):
                parts.setdefault(e, []).append(tau)
        for e, own in parts.items():
            degree = max(1, *(len(tau) - 1 for tau in own))
            equal = [by_component(lambda c: raised(c, degree), tau) for tau in own]
            self.tau[e] = [[sum(x) for x in zip(*vectors)] for vectors in zip(*equal)]

    # 2. Balances.

    def _acting(self, e, tau):
        """The force of a traction on an edge and its moment about the origin, in units."""
        a, b = (self.mesh.x[v] for v in self.mesh.edges[e].tolist())
        n, components = len(tau), list(zip(*tau))
        force = [sum(c) * (self.unit // n) for c in components]
        first = [sum((i + 1) * x for i, x in enumerate(c)) * (self.unit // (n * n + n)) for c in components]  # int s tau
        return [*force, cross(a, force) + cross((b[0] - a[0], b[1] - a[1]), first)]

    def _residuals(self):
        """Residuals of the balances of every triangle."""
        mesh, acting = self.mesh, [self._acting(e, tau) for e, tau in enumerate(self.tau)]
        for t, (sides, signs) in enumerate(zip(mesh.sides.tolist(), mesh.signs.tolist())):
            out = [sum(sign * x for sign, x in zip(signs, own)) for own in zip(*(acting[e] for e in sides))]
            if f := mesh.corners(mesh.scene.forces, t):
                x, share = list(zip(*(mesh.x[v] for v in mesh.triangles[t].tolist()))), mesh.shape(t)[1] * (self.unit // 24)
                # By the middles of the sides: exact for quadratic functions.
                moment = sum(cross([c[i] + c[i - 1] for c in x], [c[i] + c[i - 1] for c in f]) for i in range(3))
                out = [y + share * z for y, z in zip(out, (4 * sum(f[0]), 4 * sum(f[1]), moment))]
            yield out

    def _forest(self):
        """The triangles, parents first; sets the edge to the parent of each, and of components without an edge held both ways the roots."""
        mesh, order, queue = self.mesh, [], deque()
        outer = lambda n: [e for e, (k, (_, right)) in enumerate(zip(self.directions, mesh.owners.tolist())) if k == n and right < 0]
        # First from edges that hold; then from an outer edge of what these do not reach, best one that has nothing to do with others.
        for start in outer(2) + outer(0) + outer(1):
            t, alone = int(mesh.owners[start, 0]), self.directions[start] < 2
            if self.component[t] < 0:
                self.roots += [(t, start)] if alone else []
                self.component[t], self.parent[t] = len(self.roots), -1 if alone else start
                queue.append(t)
            while queue:
                t = queue.popleft()
                order.append(t)
                for e, o in ((e, o) for e in mesh.sides[t].tolist() for o in mesh.owners[e].tolist()):
                    if o >= 0 and self.component[o] < 0:
                        self.component[o], self.parent[o] = self.component[t], e
                        queue.append(o)
        if -1 in self.component:
            raise Refused(f"triangle {self.component.index(-1)} of {mesh.what} is not reached from any outer edge")
        return order

    def _balance(self):
        """Brings components without an edge held both ways into balance as a whole, by closed contacts and rollers."""
        mesh, total = self.mesh, np.zeros((len(self.roots) + 1, 3), object)
        for t, missing in enumerate(self._residuals()):
            total[self.component[t]] += missing
        within = lambda joint: enumerate(zip(joint.pressure, joint.limits(len(joint.pressure))))
        free = [(joint, i, *limits) for joint in self.single for i, (b, limits) in within(joint) if limits[0] < b < limits[1]]
        columns = np.zeros((len(free), *total.shape), object)
        for column, (joint, i, *_) in zip(columns, free):
            for e, tau in self._sides(joint, [fmpq(int(i == j)) for j in range(len(joint.pressure))]):
                column[self.component[mesh.owners[e, 0]]] += self._acting(e, tau)
        for c, (_, e) in enumerate(self.roots, 1):  # moments about an end of the edge that would take what is left
            for own in (total[c], *columns[:, c]):
                own[2] -= cross(mesh.x[mesh.edges[e, 0]], own)
        total = total[1:].ravel()
        matrix = columns[:, 1:].reshape(len(free), len(total)).T
        rows = np.array([any(x != 0 for x in row) for row in matrix])
        solved = not rows.any() or self._solve(matrix[rows], total[rows], free)
        # Balances that nothing takes part in hold exactly, or are left, as an additional load on an edge of each.
        if not solved or not zero(*total[~rows], *matrix[~rows].ravel()):
            self.parent = [dict(self.roots).get(t, e) for t, e in enumerate(self.parent)]
        self._set()

    def _solve(self, matrix, total, free):
        """Changes coefficients by the least that balances, relative to what their limits leave: exactly, or where that exceeds these or is more
        than rounding, nearly, by least squares in floating point where these help. Whether it is exact."""
        start = b = np.array([joint.pressure[i] for joint, i, *_ in free], object)
        low, high, rough = np.array([own[2] for own in free], object), np.array([own[3] for own in free], object), matrix.astype(float)
        solved, most, missing = False, ROUNDING * max(arb(self.scale), *abs(b)), lambda b: total + matrix @ (b - start)
        size = np.abs(rough).max(1)
        worst = lambda b: np.abs(missing(b).astype(float) / size).max()
        for exact in (True, False, False, False, True):
            room = np.minimum((b - low).astype(float), (high - b).astype(float))
            room[np.isinf(room)] = self.scale + 1e-300
            if exact:
                weighted = arb_mat((matrix * balls(room**2)).tolist())
                try:
                    y = (weighted * arb_mat(matrix.T.tolist())).solve(arb_mat([[-x] for x in missing(b)]))
                except ZeroDivisionError:
                    continue
                found = b + np.array((weighted.transpose() * y).entries(), object)
            else:
                norms = np.sqrt(((rough * room) ** 2).sum(1)) + 1e-300
                step = np.linalg.lstsq(rough * room / norms[:, None], -missing(b).astype(float) / norms, rcond=1e-10)[0] * room
                found = np.array([max(least, min(x, greatest)) for x, least, greatest in zip(b + balls(step), low, high)], object)
            better = exact or worst(found) < worst(b)
            if better and all(abs(found - start) <= most) and all(low <= found) and all(found <= high):
                b, solved = found, exact
            if solved:
                break
        for (joint, i, *_), x in zip(free, b):
            joint.pressure[i] = x
        return solved

    def _mend(self, order):
        """Passes on what is missing, leaves first, to the edges of the trees."""
        mesh, missing, worst = self.mesh, list(self._residuals()), (0.0, -1)
        for t in (t for t in reversed(order) if self.parent[t] >= 0):
            e = self.parent[t]
            first = int(mesh.owners[e, 0] == t)
            force, other = [x * fmpq(1 - 2 * first, self.unit) for x in missing[t]], mesh.owners[e, first]
            if other >= 0:
                missing[other] = [x + y for x, y in zip(missing[other], missing[t])]
            if zero(*force):
                continue
            # A traction alpha + (2 s - 1) beta with this force and moment, beta across the edge d: d x beta / 6 is that about its middle.
            (x, y), (u, v) = (mesh.x[i] for i in mesh.edges[e].tolist())
            d, alpha = (u - x, v - y), force[:2]
            turning = 6 * (force[2] - cross(((x + u) / 2, (y + v) / 2), alpha)) / dot(d, d)
            beta, n = (-turning * d[1], turning * d[0]), len(self.tau[e]) - 1
            self.tau[e] = [[x + y + fmpq(2 * i - n, n) * z for x, y, z in zip(c, alpha, beta)] for i, c in enumerate(self.tau[e])]
            worst = max(worst, (max(abs(float(x)) for x in (*alpha, *beta)), e))
            if self.directions[e] < 2:
                self.extra += sum(upper(abs(x)) for x in (*alpha, *beta))
        if worst[0] > ROUNDING * self.scale:
            raise Refused(
                f"the stress is not in equilibrium: edge {worst[1]} of triangles {mesh.owners[worst[1]].tolist()} would have to carry "
                f"{worst[0]:.3e} more, the largest force of an edge being {self.scale:.3e}"
            )
        if not zero(self.extra):
            if not self.extra <= NEARLY * self.scale:
                raise Refused(f"bodies that contacts and rollers alone hold are out of balance by {float(self.extra):.3e}")
            mesh.premises.append(f"bodies that contacts and rollers alone hold balance but for {float(self.extra):.1e}, taken for an additional load")

    # 3. Energies.

    def bound(self):
        """A number that -Pi of the admissible stress is not below, thickness included."""
        total = -sum(upper(self._energy(t)) for t in range(len(self.mesh.triangles)))
        for joint in self.mesh.joints:
            b = joint.pressure
            if b is None:
                b = [x / dot(joint.normal[0], joint.normal[0]) for x in joint.along(self.tau[joint.edges[0]])]
            total += lower(joint.length * mean(times(b, [g + joint.excess for g in joint.offset])))
            if joint.stiffness:
                total -= upper(joint.length * mean(times(b, b)) / (2 * joint.stiffness))
        return lower(total * self.mesh.scene.thickness)

    def _energy(self, t):
        """1/2 int a s:s + int s:e0 over a triangle."""
        mesh, p, data = self.mesh, self.degrees[t], []
        ((a, c), (b, d)), det = mesh.shape(t)
        pulled = lambda x, y: (d * x - b * y, a * y - c * x)  # J B^-1
        for e, sign in zip(mesh.sides[t].tolist(), mesh.signs[t].tolist()):
            for x, y in by_component(lambda c: raised(c, p), self.tau[e])[::sign]:
                data += pulled(sign * x, sign * y)
        force = mesh.corners(mesh.scene.forces, t) or [[0] * 3] * 2
        for x, y in zip(*force):
            data += pulled(det * x, det * y)
        push = arb_mat([[a * a, b * b, 2 * a * b], [c * c, d * d, 2 * c * d], [a * c, b * d, a * d + b * c]])  # s = push (J s^) / J^2
        form = push.transpose() * mesh.scene.laws[mesh.body(t)][0] * push
        special, basis, _ = reference.stresses(p)
        x = special * arb_mat([[y] for y in data])
        if basis.ncols():
            x += basis * arb_mat([[y] for y in reference.least(p, np.array(form.table(), float), np.array(data, float))])
        n = x.nrows() // 9
        parts = [arb_mat(3, n, x.entries()[i * 3 * n : (i + 1) * 3 * n]) for i in range(3)]
        energy = sum((form * reference.integral(s, s)).trace() for s in parts) / (6 * det**3)
        strain = mesh.corners(mesh.scene.strains, t)
        if strain:
            energy += sum((push * reference.integral(s, e)).trace() for s, e in zip(parts, reference.on_split(strain))) / (3 * det)
        return energy
