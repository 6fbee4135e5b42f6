"""The upper bound: an admissible displacement near the candidate, and its energy.

The candidate has a value at every vertex, inner Bernstein coefficients on every edge in a degree of its own, and coefficients inside every
triangle: it is continuous whatever the numbers are. Those on supports are replaced by what the support prescribes, and those on
contacts moved until no Bernstein coefficient of (v' - v'').n - g is above zero, in rational numbers; changes of the size of rounding.
"""

from fractions import Fraction as Q

import numpy as np

from . import Refused, reference
from .ball import EPS, Ball, constants, of_fractions, root, stack
from .lower import form, load, square

ROUNDING = 1e-7  # changes beyond this part of the largest displacement are no rounding
SWEEPS = 200
GRAIN = 1 << 220  # changes along contacts are multiples of its inverse


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1]


def elevated(values, degree):
    low = len(values) - 1
    return values if low == degree else [sum(w * x for w, x in zip(row, values)) for row in reference.elevation(low, degree)]


def positive_square(b, depth=40):
    """At least int_0^1 max(0, x)^2 of a polynomial x by its Bernstein coefficients, and hardly more."""
    if max(b) <= 0:
        return Q(0)
    if min(b) >= 0 or not depth:
        return square([max(x, Q(0)) for x in b])
    left, right, row = [], [], b
    while row:
        left, right, row = [*left, row[0]], [row[-1], *right], [(x + y) / 2 for x, y in zip(row, row[1:])]
    return (positive_square(left, depth - 1) + positive_square(right, depth - 1)) / 2


class Displacement:
    def __init__(self, mesh, data):
        self.mesh, self.degrees, self.counts = mesh, data["displacement_degrees"].astype(int), data["u_edge_counts"].astype(int)
        self.candidates, self.inside = {"v": data["u_vertices"], "e": data["u_edges"]}, data["u_inside"]
        self.start = np.concatenate([[0], np.cumsum(self.counts)])
        self.inside_start = np.concatenate([[0], np.cumsum((3 * self.degrees**2 - 3 * self.degrees + 2) // 2)])
        fits = [len(x) for x in (self.degrees, self.counts, *self.candidates.values(), self.inside)]
        if fits != [len(mesh.triangles), len(mesh.edges), len(mesh.points), self.start[-1], self.inside_start[-1]] or self.degrees.min() < 1:
            raise Refused("the displacement of the proof is incomplete")
        if (self.counts[mesh.sides].max(1) > self.degrees - 1).any():
            raise Refused("an edge of the displacement has a higher degree than a triangle beside it")
        values = (*self.candidates.values(), self.inside)
        if not all(np.isfinite(x).all() for x in values):
            raise Refused("a coefficient of the displacement is no number")
        self.scale = float(max(np.abs(x).max(initial=0.0) for x in values))
        # The energy of displacements of the size of rounding.
        self.grain = max(max(law[1][::4]) for law in mesh.scene.bodies.values()) * Q(self.scale) ** 2 / 2**90 * mesh.scene.thickness
        self.exact, self.free = {}, {}
        self._supports()
        self._contacts()

    # Nodes: ("v", vertex) and ("e", index of the coefficient).

    def nodes(self, e, first):
        """The nodes along an edge from the vertex `first`."""
        a, b = self.mesh.edges[e].tolist()
        nodes = [("v", a), *(("e", i) for i in range(self.start[e], self.start[e + 1])), ("v", b)]
        return nodes if a == first else nodes[::-1]

    def value(self, node):
        if node not in self.exact:
            self.exact[node] = [Q(x) for x in self.candidates[node[0]][node[1]].tolist()]
        return self.exact[node]

    def _change(self, node, to, why):
        by = max(abs(x - y) for x, y in zip(to, self.value(node)))
        if by > ROUNDING * max(self.scale, float(max(abs(x) for x in to))):
            raise Refused(f"the displacement {why}: a coefficient at {self._place(node)} would have to change by {float(by):.3e}")
        self.exact[node] = to

    def _place(self, node):
        return f"vertex {node[1]}" if node[0] == "v" else f"edge {np.searchsorted(self.start, node[1], 'right') - 1}"

    def _supports(self):
        mesh, held = self.mesh, {}
        for e, condition in enumerate(mesh.conditions):
            if mesh.kinds[e] not in ("clamped", "roller"):
                continue
            nodes = self.nodes(e, mesh.edges[e, 0])
            for j, node in enumerate(nodes):
                if condition.kind == "clamped":
                    a, b = (condition.data.at(mesh.written(v)) for v in mesh.edges[e].tolist())
                    u = [x + (y - x) * Q(j, len(nodes) - 1) for x, y in zip(a, b)]
                    lines = [([Q(1), Q(0)], u[0]), ([Q(0), Q(1)], u[1])]
                else:
                    low, high = root(dot(mesh.directions[e], mesh.directions[e]))
                    if low != high and condition.data:
                        mesh.premises.append("a displacement prescribed along a sloped direction is taken to 96 decimal places")
                    lines = [(mesh.directions[e], condition.data * low)]
                held.setdefault(node, []).extend(lines)
        for node, lines in held.items():
            # Lines n.u = w; a second one that is not parallel to the first fixes the node.
            (n, w), u = lines[0], self.value(node)
            other = next(((m, v) for m, v in lines if n[0] * m[1] != n[1] * m[0]), None)
            if other is None:
                off, self.free[node] = (dot(n, u) - w) / dot(n, n), [-n[1], n[0]]
                to = [x - off * y for x, y in zip(u, n)]
            else:
                (m, v), self.free[node] = other, None
                det = n[0] * m[1] - n[1] * m[0]
                to = [(w * m[1] - v * n[1]) / det, (n[0] * v - m[0] * w) / det]
            # Of parallel lines, lengths of which are taken to so many places, and of others exactly.
            off = max(abs(dot(m, to) - v) for m, v in lines)
            if off > max(abs(v) for _, v in lines) / GRAIN:
                raise Refused(f"the supports that meet at {self._place(node)} prescribe displacements that differ by {float(off):.3e}")
            self._change(node, to, "misses a support")

    def _contacts(self):
        """Moves coefficients until no contact is penetrated."""
        pairs, self.elastic = [], []
        for pair in self.mesh.pairs:
            sides = [self.nodes(e, ends[0]) if e >= 0 else [] for e, ends in zip(pair.edges, (pair.first, pair.second))]
            degree = max(map(len, sides)) - 1
            gap = [min(g * length for length in pair.length) for g in pair.gap]
            own = pairs if pair.stiffness is None else self.elastic
            own.append((pair, sides, degree, elevated(gap, max(degree + pair.turns(), len(gap) - 1))))
        for _ in range(SWEEPS):
            if not any([self._separate(*pair) for pair in pairs]):
                return
        raise Refused("a contact is penetrated, and no small change of the displacement opens it")

    def _jump(self, sides):
        """Bernstein coefficients of the displacement of the first side less that of the second."""
        degree = max(map(len, sides)) - 1
        jump = [[Q(0)] * 2] * (degree + 1)
        for side, sign in zip(sides, (1, -1)):
            if side:
                raised = zip(*(elevated([self.value(node)[c] for node in side], degree) for c in range(2)))
                jump = [[j + sign * x for j, x in zip(one, two)] for one, two in zip(jump, raised)]
        return jump

    def _along_pair(self, pair, sides, degree, most):
        """The jump along the direction of a contact, times the length of the pair, in the degree of `most`."""
        jump, (m, n), k = self._jump(sides), pair.ends, degree + 1
        if pair.turns():
            along = [((k - j) * (dot(jump[j], m) if j < k else 0) + j * (dot(jump[j - 1], n) if j else 0)) / Q(k) for j in range(k + 1)]
        else:
            along = [dot(x, m) for x in jump]
        return elevated(along, len(most) - 1)

    def _separate(self, pair, sides, degree, most):
        """Pushes what penetrates apart; whether anything did."""
        m, n = pair.ends
        deep = [(j, x - y) for j, (x, y) in enumerate(zip(self._along_pair(pair, sides, degree, most), most)) if x > y]
        for j, by in deep:
            towards = [a + (b - a) * Q(j, len(most) - 1) for a, b in zip(m, n)]
            # Of a side of this degree one coefficient, else all that may take part; the second side where the first cannot move.
            for side, sign in zip(sides, (-1, 1)):
                own = [side[j]] if len(side) == len(most) else side
                if any([self._push(node, towards, sign * by) for node in own]):
                    break
            else:
                raise Refused(f"the supports force a penetration of {float(by):.3e} at {self._place((sides[0] + sides[1])[min(j, degree)])}")
        return bool(deep)

    def _push(self, node, n, by):
        """Moves a coefficient by about `by` along n, within what its support leaves free."""
        d = self.free.get(node, n)
        if d is None or dot(d, n) ** 2 * 10**8 < dot(d, d) * dot(n, n):
            return False
        # Rounded away from zero: a multiple of the direction, so that the support holds on.
        step = by / dot(d, n)
        step = Q((abs(step) * GRAIN).__ceil__() + 1, GRAIN) * (1 if step > 0 else -1)
        self._change(node, [x + step * y for x, y in zip(self.value(node), d)], "penetrates a contact")
        return True

    # Energy.

    def bound(self, extra):
        """A number that the energy of the displacement is not above, thickness included; loads may change by the force `extra`."""
        mesh, total = self.mesh, 2 * Q(extra) * Q(self.scale)
        values = {kind: Ball(x).writable() for kind, x in self.candidates.items()}
        for kind in values:
            changed = [i for of, i in self.exact if of == kind]
            if changed:
                values[kind].put(changed, of_fractions([x for i in changed for x in self.exact[kind, i]], (len(changed), 2)))
        for k in np.unique(self.degrees).tolist():
            along, all_ = self._along(k, values), np.flatnonzero(self.degrees == k)
            for which in np.array_split(all_, max(1, len(all_) * k * k // 20000)):
                total += Q(float(self._energies(which, k, self._gather(which, k, along)).sum()[1]))
        for e in np.flatnonzero(mesh.kinds == "load").tolist():
            nodes = self.nodes(e, mesh.edges[e, 0])
            k = len(nodes) - 1
            for j, (kind, i) in enumerate(nodes):
                # int B_j = 1 / (k + 1), int (2 s - 1) B_j = (2 j - k) / ((k + 1) (k + 2))
                weights = [a / (k + 1) + b * Q(2 * j - k, (k + 1) * (k + 2)) for a, b in zip(*load(mesh, e))]
                total -= Q(float((of_fractions(weights) * values[kind][i]).sum()[0])) if any(weights) else 0
        total += self._springs()
        return total * mesh.scene.thickness

    def _springs(self):
        """The energies of springs, layers and elastic contacts."""
        total = Q(0)
        for e, f, stiffness in self.mesh.springs:
            a, n = self.mesh.edges[e, 0], self.mesh.normal(*self.mesh.edges[e])
            jump = self._jump([self.nodes(e, a), self.nodes(f, self.mesh.edges[f, 1]) if f >= 0 else []])
            for k, d in zip(stiffness, (n, [-n[1], n[0]])):
                if k:
                    total += k * square([dot(j, d) for j in jump]) / (2 * root(dot(n, n))[0])
        for pair, sides, degree, most in self.elastic:
            beyond = [x - y for x, y in zip(self._along_pair(pair, sides, degree, most), most)]
            total += pair.stiffness * positive_square(beyond) / (2 * pair.length[0])
        return total

    def _along(self, k, values):
        """The coefficients of all edges of degree k or less, raised to k: an array (edges, k + 1, 2)."""
        out = Ball(np.zeros((len(self.counts), k + 1, 2))).writable()
        for n in range(k):
            which = np.flatnonzero(self.counts == n)
            ends = [values["v"][self.mesh.edges[which, i]] for i in range(2)]
            own = stack([ends[0], *(values["e"][self.start[which] + j] for j in range(n)), ends[1]], 1)
            if n + 1 < k:
                # About the first value: what all have in common costs no digits.
                base = own[:, :1]
                own = (own - base).times(constants(reference.elevation(n + 1, k)), 1) + base
            out.put(which, own)
        return out

    def _gather(self, which, k, along):
        """Coefficients of triangles of degree k, those of the boundary first: an array (nodes, 2, triangles)."""
        mesh, parts = self.mesh, []
        rows = lambda i, j: along[mesh.sides[which, i], np.where(mesh.signs[which, i] > 0, j, k - j)]
        parts += [rows((i + 1) % 3, k) for i in range(3)]  # corner i ends the side opposite corner i + 1
        parts += [rows(i, j) for i in range(3) for j in range(1, k)]
        inside = self.inside[self.inside_start[which][:, None] + np.arange((3 * k * k - 3 * k + 2) // 2)]
        parts += [Ball(x) for x in np.moveaxis(inside, 1, 0)]
        return Ball(*(np.stack([getattr(part, name).T for part in parts]) for name in ("mid", "rad")))

    def _energies(self, which, k, nodes):
        mesh = self.mesh
        law = mesh.by_body(lambda name: mesh.scene.bodies[name][1], which)
        strains = [list(reference.on_split(e)) for e in mesh.corners(mesh.scene.strains, which)] if mesh.warm else None
        force = [[f * mesh.jacobian[which] for f in own] for own in mesh.corners(mesh.scene.forces, which)]
        shares = constants(reference.shares(k))
        by_xi, by_eta, norms = reference.derivatives(k, bool(strains))
        weight, det, third = constants([norms]), mesh.jacobian[which], constants([[Q(1, 3)]])[0, 0]
        (a, b), (c, d) = [[m[which] for m in row] for row in mesh.map]
        # Vectors from the centroid to the corners, times 3; the edges are (a, c) from corner 0 to 1 and (b, d) from 0 to 2.
        arms = [(-(a + b), -(c + d)), (a + a - b, c + c - d), (b + b - a, d + d - c)]
        base, strain, work, half = nodes[0], [], 0, 0.5
        local = nodes - base
        for sub in range(3):
            own = local[reference.split_nodes(k)[sub]]
            xi, eta = own.times(by_xi), own.times(by_eta)
            (px, py), (qx, qy) = arms[(sub + 1) % 3], arms[(sub + 2) % 3]
            # Gradients times the determinant J / 3 of the subtriangle, times 3.
            ux, uy = xi[:, 0] * qy - eta[:, 0] * py, eta[:, 0] * px - xi[:, 0] * qx
            vx, vy = xi[:, 1] * qy - eta[:, 1] * py, eta[:, 1] * px - xi[:, 1] * qx
            e = [(ux + vy) * half, (ux - vy) * half, uy + vx]
            if strains:
                for x, initial in zip(e, strains):
                    x.put(slice(3), x[:3] - initial[sub] * det)
            strain.append(form(law, e).times(weight)[0])
            corners = own.times(shares)  # int over the subtriangle of v times its barycentric coordinates, J / 3 apart
            for c, (f0, f1, f2) in enumerate(force):
                f = [f0, f1, f2]
                centre = (f0 + f1 + f2) * third
                first, second = f[(sub + 1) % 3], f[(sub + 2) % 3]
                work = corners[0, c] * first + corners[1, c] * second + corners[2, c] * centre + work
        # 1/2 (J / 3) sum / J^2
        energy = (strain[0] + strain[1] + strain[2]) * det.inverse() * constants([[Q(1, 6)]])[0, 0]
        rest = [base[c] * (f[0] + f[1] + f[2]) * constants([[Q(1, 6)]])[0, 0] for c, f in enumerate(force)]
        return energy - work * third - rest[0] - rest[1]
