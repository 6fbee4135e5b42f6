"""The upper bound: an admissible displacement near the candidate, and its energy.

The candidate has a value at every vertex, inner Bernstein coefficients on every edge in a degree of its own, and coefficients inside every
triangle: it is continuous whatever the numbers are. Those on supports are replaced by what the support prescribes, and those on
contacts moved until no Bernstein coefficient of (v' - v'').n - |n| g is above zero, in rational numbers; changes of the size of rounding.
Along contacts with friction it may slide as it likes: that costs the bound times the distance.
"""

import numpy as np
from flint import arb, arb_mat, fmpq

from . import Refused, reference
from .exact import by_component, cross, dot, halves, lower, mean, raised, rational, times, upper
from .lower import load

ROUNDING = 1e-7  # changes beyond this part of the largest displacement are no rounding
SWEEPS = 200
GRAIN = 1 << 220  # changes along contacts are multiples of its inverse


def positive_square(b, depth=40):
    """At least int_0^1 max(0, x)^2 of a polynomial x by its Bernstein coefficients, and hardly more."""
    if max(b) <= 0:
        return fmpq(0)
    if min(b) >= 0 or not depth:
        positive = [max(x, fmpq(0)) for x in b]
        return mean(times(positive, positive))
    return sum(positive_square(half, depth - 1) for half in halves(b)) / 2


def absolute(b, weight, depth=40):
    """At least int_0^1 weight |x| of a polynomial x by its Bernstein coefficients, and hardly more; the weight is nowhere negative."""
    if min(b) >= 0 or max(b) <= 0 or not depth:
        return mean(times([abs(x) for x in b], weight))
    return sum(absolute(*both, depth - 1) for both in zip(halves(b), halves(weight))) / 2


class Displacement:
    def __init__(self, mesh, data):
        self.mesh, self.degrees, counts = mesh, data["displacement_degrees"].astype(int), data["u_edge_counts"].astype(int)
        given = [data[name] for name in ("u_vertices", "u_edges", "u_inside")]
        inside = (3 * self.degrees**2 - 3 * self.degrees + 2) // 2
        fits = [len(mesh.points), counts.sum(), inside.sum()]
        if [len(counts), len(self.degrees), *map(len, given)] != [len(mesh.edges), len(mesh.triangles), *fits] or self.degrees.min() < 1:
            raise Refused("the displacement of the proof is incomplete")
        if (counts[mesh.sides].max(1) > self.degrees - 1).any():
            raise Refused("an edge of the displacement has a higher degree than a triangle beside it")
        if not all(np.isfinite(x).all() for x in given):
            raise Refused("a coefficient of the displacement is no number")
        self.scale = max(np.abs(x).max(initial=0.0) for x in given)
        # Nodes count vertices first, then the coefficients of edges, then those inside triangles.
        self.values, starts = np.concatenate(given).tolist(), np.cumsum([len(mesh.points), *counts, *inside]).tolist()
        self.on_edge = [range(*ends) for ends in zip(starts, starts[1:])]
        self.on_edge, self.inside = self.on_edge[: len(counts)], self.on_edge[len(counts) :]
        # The energy of displacements of the size of rounding.
        stiffest = max(law[1][i, i] for law in mesh.scene.laws.values() for i in range(3))
        self.grain = upper(stiffest * rational(self.scale) ** 2 * mesh.scene.thickness / 2**90)
        self.exact, self.free = {}, {}
        self._supports()
        self._contacts()

    def nodes(self, e, first):
        """The nodes along an edge from the vertex `first`."""
        a, b = self.mesh.edges[e].tolist()
        nodes = [a, *self.on_edge[e], b]
        return nodes if a == first else nodes[::-1]

    def value(self, node):
        """The coefficient of a node, as rational numbers."""
        if node not in self.exact:
            self.exact[node] = [rational(x) for x in self.values[node]]
        return self.exact[node]

    def _change(self, node, to, why):
        by = max(abs(x - y) for x, y in zip(to, self.value(node)))
        if by > rational(ROUNDING) * max(rational(self.scale), *map(abs, to)):
            raise Refused(f"the displacement {why}: a coefficient at {self._place(node)} would have to change by {float(by):.3e}")
        self.exact[node] = to

    def _place(self, node):
        return f"vertex {node}" if node < len(self.mesh.points) else f"edge {next(e for e, own in enumerate(self.on_edge) if node in own)}"

    def _supports(self):
        held = {}
        for joint in self.mesh.joints:
            if joint.stiffness is None and not joint.limited:
                nodes, size = self.nodes(joint.edges[0], joint.starts[0]), joint.length.mid().fmpq()
                if not joint.length.is_exact() and any(joint.offset):
                    self.mesh.premises.append("a displacement prescribed along a sloped direction is taken to 96 decimal places")
                for node, w in zip(nodes, raised(joint.offset, len(nodes) - 1)):
                    held.setdefault(node, []).append((joint.normal[0], w * size))
        for node, lines in held.items():
            # Lines n.u = w; a second one that is not parallel to the first fixes the node.
            (n, w), u = lines[0], self.value(node)
            other = next(((m, v) for m, v in lines if cross(n, m) != 0), None)
            if other is None:
                off, self.free[node] = (dot(n, u) - w) / dot(n, n), [-n[1], n[0]]
                to = [x - off * y for x, y in zip(u, n)]
            else:
                (m, v), self.free[node] = other, None
                to = [(w * m[1] - v * n[1]) / cross(n, m), (n[0] * v - m[0] * w) / cross(n, m)]
            # Of parallel lines, lengths of which are taken to so many places, and of others exactly.
            off = max(abs(dot(m, to) - v) for m, v in lines)
            if off > max(abs(v) for _, v in lines) / GRAIN:
                raise Refused(f"the supports that meet at {self._place(node)} prescribe displacements that differ by {float(off):.3e}")
            self._change(node, to, "misses a support")

    def _sides(self, joint):
        return [self.nodes(e, start) if e >= 0 else [] for e, start in zip(joint.edges, joint.starts)]

    def _jump(self, joint):
        """Bernstein coefficients of the displacement of the first side less that of the second, along n."""
        sides = [[self.value(node) for node in side] or [[fmpq(0)] * 2] for side in self._sides(joint)]
        degree = max(map(len, sides)) - 1
        first, second = (by_component(lambda c: raised(c, degree), side) for side in sides)
        return joint.along([[x - y for x, y in zip(*both)] for both in zip(first, second)])

    def _beyond(self, joint):
        """Bernstein coefficients of what the jump exceeds the gap by, or more, times the length of n."""
        jump, gap = self._jump(joint), [lower(g * joint.length).fmpq() for g in joint.offset]
        degree = max(len(jump), len(gap)) - 1
        return [x - y for x, y in zip(raised(jump, degree), raised(gap, degree))]

    def _contacts(self):
        """Moves coefficients until no rigid contact is penetrated."""
        rigid = [joint for joint in self.mesh.joints if joint.presses and joint.stiffness is None]
        for _ in range(SWEEPS):
            if not any([self._separate(joint) for joint in rigid]):
                return
        raise Refused("a contact is penetrated, and no small change of the displacement opens it")

    def _separate(self, joint):
        """Pushes what penetrates apart; whether anything did."""
        beyond, sides = self._beyond(joint), self._sides(joint)
        for j, by in ((j, by) for j, by in enumerate(beyond) if by > 0):
            towards = by_component(lambda c: raised(c, len(beyond) - 1), joint.normal)[j]
            # Of a side of this degree one coefficient, else all that may take part; the second side where the first cannot move.
            for side, sign in zip(sides, (-1, 1)):
                own = [side[j]] if len(side) == len(beyond) else side
                if any([self._push(node, towards, sign * by) for node in own]):
                    break
            else:
                raise Refused(f"the supports force a penetration of {float(by):.3e} at {self._place((sides[0] + sides[1])[min(j, len(sides[0]) - 1)])}")
        return max(beyond) > 0

    def _push(self, node, n, by):
        """Moves a coefficient by about `by` along n, within what its support leaves free."""
        d = self.free.get(node, n)
        if d is None or dot(d, n) ** 2 * 10**8 < dot(d, d) * dot(n, n):
            return False
        # Rounded away from zero: a multiple of the direction, so that the support holds on.
        step = by / dot(d, n)
        step = fmpq((abs(step) * GRAIN).ceil() + 1, GRAIN) * (1 if step > 0 else -1)
        self._change(node, [x + step * y for x, y in zip(self.value(node), d)], "penetrates a contact")
        return True

    # Energy.

    def bound(self, extra):
        """A number that the energy of the displacement is not above, thickness included; loads may change by the force `extra`."""
        mesh, total = self.mesh, upper(2 * extra * self.scale)
        total += sum(upper(self._energy(t, k)) for t, k in enumerate(self.degrees.tolist()))
        for e, held in enumerate(mesh.conditions):
            if held and held.kind == "load":
                v = [self.value(node) for node in self.nodes(e, mesh.edges[e, 0])]
                total -= lower(sum(mean(times([x[c] for x in load(mesh, e)], [x[c] for x in v])) for c in range(2)))
        for joint in mesh.joints:
            if joint.stiffness:
                square = positive_square(self._beyond(joint)) if joint.presses else mean(times(jump := self._jump(joint), jump))
                total += upper(joint.stiffness * square / (2 * joint.length))
            if joint.bound:
                total += upper(absolute(self._jump(joint), joint.bound))
        return upper(total * mesh.scene.thickness)

    def _energy(self, t, k):
        """1/2 int c (e(v) - e0):(e(v) - e0) - int F.v over a triangle."""
        mesh, scene, name = self.mesh, self.mesh.scene, self.mesh.body(t)
        corners, ((a, c), (b, d)), det = mesh.triangles[t].tolist(), *mesh.shape(t)
        at = lambda node: self.exact.get(node) or [arb(x) for x in self.values[node]]
        nodes = [at(v) for v in corners]
        for i, e in enumerate(mesh.sides[t].tolist()):
            along = [at(node) for node in self.nodes(e, corners[(i + 1) % 3])]
            nodes += by_component(lambda c: raised(c, k), along)[1:-1]
        v = arb_mat([*nodes, *(at(node) for node in self.inside[t])])
        slopes = reference.gradients(k) * v
        # J times (xx, yy, 2 xy) from the derivatives of both components by xi, then by eta.
        to_strain = arb_mat([[d, 0, -c, 0], [0, -b, 0, a], [-b, d, a, -c]])
        n, rows = slopes.nrows() // 6, slopes.table()
        derivatives = [[list(zip(*rows[i * n : (i + 1) * n])) for i in (2 * sub, 2 * sub + 1)] for sub in range(3)]
        strains = [to_strain * arb_mat([*xi, *eta]) for xi, eta in derivatives]
        square = sum(reference.integral(e, e) for e in strains)
        if initial := mesh.corners(scene.strains, t):
            for e, own in zip(strains, reference.on_split(initial)):
                square += reference.integral(own, own) * (det * det) - reference.integral(e, own) * (2 * det)
        energy = (scene.laws[name][1] * square).trace() / (6 * det)
        force = mesh.corners(scene.forces, t)
        if force:
            table = v.table()
            for sub, f in enumerate(reference.on_split(force)):
                own = arb_mat([table[i] for i in reference.split_nodes(k)[sub]]).transpose()
                energy -= reference.integral(own, f).trace() * det / 3
        return energy
