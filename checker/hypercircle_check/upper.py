"""The upper bound: an admissible displacement near the candidate, and its energy.

The candidate has a value at every vertex, inner Bernstein coefficients on every edge in a degree of its own, and coefficients inside every
triangle: it is continuous whatever the numbers are. Those on supports are replaced by what the support prescribes, and those on
contacts moved until no Bernstein coefficient of (v' - v'').n - g is above zero, in rational numbers; changes of the size of rounding.
"""

from fractions import Fraction as Q

import numpy as np

from . import Refused, reference
from .ball import EPS, Ball, constants, of_fractions, root, stack
from .lower import load

ROUNDING = 1e-7  # changes beyond this part of the largest displacement are no rounding
SWEEPS = 200
GRAIN = 1 << 220  # changes along contacts are multiples of its inverse


class Displacement:
    def __init__(self, mesh, data):
        self.mesh, self.degrees = mesh, data["displacement_degrees"].astype(int)
        self.counts, self.edges = data["u_edge_counts"].astype(int), data["u_edges"]
        self.vertices, self.inside = data["u_vertices"], data["u_inside"]
        self.start = np.concatenate([[0], np.cumsum(self.counts)])
        sizes = (3 * self.degrees**2 + 3 * self.degrees + 2) // 2 - 3 * self.degrees
        self.inside_start = np.concatenate([[0], np.cumsum(sizes)])
        fits = self.vertices.shape == mesh.points.shape and len(self.degrees) == len(mesh.triangles) and len(self.counts) == len(mesh.edges)
        if not fits or self.start[-1] != len(self.edges) or self.inside_start[-1] != len(self.inside) or self.degrees.min() < 1:
            raise Refused("the displacement of the proof is incomplete")
        if (self.counts[mesh.sides].max(1) > self.degrees - 1).any():
            raise Refused("an edge of the displacement has a higher degree than a triangle beside it")
        if not all(np.isfinite(x).all() for x in (self.edges, self.vertices, self.inside)):
            raise Refused("a coefficient of the displacement is no number")
        self.scale = float(max(np.abs(x).max(initial=0.0) for x in (self.vertices, self.edges, self.inside)))
        self.exact, self.free, self.changed = {}, {}, Q(0)
        self._supports()
        self._contacts()
        self.largest_change = float(self.changed)

    # Nodes: ("v", vertex) and ("e", index of the coefficient).

    def nodes(self, e, first):
        """The nodes along an edge from the vertex `first`."""
        a, b = self.mesh.edges[e].tolist()
        inner = [("e", i) for i in range(self.start[e], self.start[e + 1])]
        return [("v", a), *inner, ("v", b)] if a == first else [("v", b), *inner[::-1], ("v", a)]

    def value(self, node):
        if node not in self.exact:
            self.exact[node] = [Q(x) for x in (self.vertices if node[0] == "v" else self.edges)[node[1]].tolist()]
        return self.exact[node]

    def _change(self, node, to, why):
        by = max(abs(x - y) for x, y in zip(to, self.value(node)))
        if by > ROUNDING * max(self.scale, float(max(abs(x) for x in to))):
            raise Refused(f"the displacement {why}: a coefficient at {self._place(node)} would have to change by {float(by):.3e}")
        self.changed = max(self.changed, by)
        self.exact[node] = to

    def _place(self, node):
        e = None if node[0] == "v" else int(np.searchsorted(self.start, node[1], "right") - 1)
        return f"vertex {node[1]}" if e is None else f"edge {e}"

    def _supports(self):
        mesh, held = self.mesh, {}
        for e, condition in enumerate(mesh.conditions):
            if not condition or condition.kind not in ("clamped", "roller"):
                continue
            nodes = self.nodes(e, mesh.edges[e, 0])
            for j, node in enumerate(nodes):
                if condition.kind == "clamped":
                    a, b = (condition.data.at(mesh.written(v)) for v in mesh.edges[e].tolist())
                    u = [x + (y - x) * Q(j, len(nodes) - 1) for x, y in zip(a, b)]
                    lines = [([Q(1), Q(0)], u[0]), ([Q(0), Q(1)], u[1])]
                else:
                    n = mesh.directions[e]
                    low, high = root(n[0] ** 2 + n[1] ** 2)
                    if low != high and condition.data:
                        mesh.premises.append("a displacement prescribed along a sloped direction is taken to 96 decimal places")
                    lines = [(n, condition.data * low)]
                for line in lines:
                    self._hold(held.setdefault(node, []), line, node)
        for node, lines in held.items():
            u = self.value(node)
            if len(lines) == 1:
                (n, w), = lines
                off = (n[0] * u[0] + n[1] * u[1] - w) / (n[0] ** 2 + n[1] ** 2)
                self._change(node, [x - off * y for x, y in zip(u, n)], "misses a support")
                self.free[node] = [-n[1], n[0]]
            else:
                (m, v), (n, w) = lines
                det = m[0] * n[1] - m[1] * n[0]
                self._change(node, [(v * n[1] - w * m[1]) / det, (m[0] * w - n[0] * v) / det], "misses a support")
                self.free[node] = None

    def _hold(self, lines, line, node):
        n, w = line
        for m, v in lines:
            if m[0] * n[1] == m[1] * n[0]:
                k = 0 if m[0] else 1
                if abs(v * n[k] - w * m[k]) > Q(1, 1 << 200) * abs(m[k]):
                    raise Refused(f"two supports that meet at {self._place(node)} prescribe different displacements")
                return
        if len(lines) == 2:
            (m, v), (l, u) = lines
            det = m[0] * l[1] - m[1] * l[0]
            x = [(v * l[1] - u * m[1]) / det, (m[0] * u - l[0] * v) / det]
            off = n[0] * x[0] + n[1] * x[1] - w
            if off:
                raise Refused(f"the supports that meet at {self._place(node)} prescribe displacements that differ by {float(off):.3e}")
            return
        lines.append(line)

    # Contacts.

    def _contacts(self):
        """Moves coefficients until no contact is penetrated."""
        pairs = []
        for pair in self.mesh.pairs:
            sides = [self.nodes(e, ends[0]) if e >= 0 else None for e, ends in zip(pair.edges, (pair.first, pair.second))]
            degree = max(len(s) - 1 for s in sides if s)
            bound = reference_elevate(self._gap_times_length(pair), max(degree + pair.turns(), len(pair.gap) - 1))
            pairs.append((pair, sides, degree, bound))
        for _ in range(SWEEPS):
            moved = False
            for pair, sides, degree, bound in pairs:
                moved = self._separate(pair, sides, degree, bound) or moved
            if not moved:
                return
        raise Refused("a contact is penetrated, and no small change of the displacement opens it")

    @staticmethod
    def _gap_times_length(pair):
        return [min(g * length for length in pair.length) for g in pair.gap]

    def _jump(self, pair, sides, degree):
        """Bernstein coefficients of (v' - v'').n times the length of the pair."""
        total = [[Q(0)] * 2 for _ in range(degree + 1)]
        for side, sign in zip(sides, (1, -1)):
            if side:
                u = [self.value(node) for node in side]
                raised = u if len(u) == degree + 1 else [[sum(w * x[c] for w, x in zip(row, u)) for c in range(2)] for row in reference.elevation(len(u) - 1, degree)]
                total = [[t + sign * x for t, x in zip(one, two)] for one, two in zip(total, raised)]
        dot = lambda a, b: a[0] * b[0] + a[1] * b[1]
        m, n = pair.ends
        if not pair.turns():
            return [dot(x, m) for x in total]
        k = degree + 1
        return [((k - j) * (dot(total[j], m) if j < k else 0) + j * (dot(total[j - 1], n) if j else 0)) / Q(k) for j in range(k + 1)]

    def _separate(self, pair, sides, degree, bound):
        jump = reference_elevate(self._jump(pair, sides, degree), len(bound) - 1)
        moved = False
        for j, (x, most) in enumerate(zip(jump, bound)):
            if x <= most:
                continue
            at, moved = Q(j, len(bound) - 1), True
            n = [a + (b - a) * at for a, b in zip(*pair.ends)]
            done = False
            for side, sign in zip(sides, (-1, 1)):
                # Of sides of one degree one coefficient, else all that may take part.
                if not side or done:
                    continue
                same = len(side) == len(bound)
                for node in [side[j]] if same else side:
                    done = self._push(node, n, sign * (x - most)) or done
            if not done:
                raise Refused(f"the supports force a penetration of {float(x - most):.3e} at {self._place((sides[0] or sides[1])[min(j, degree)])}")
        return moved

    def _push(self, node, n, by):
        """Moves a coefficient by about `by` along n, within what its support leaves free."""
        direction = self.free.get(node, n)
        if direction is None:
            return False
        along = direction[0] * n[0] + direction[1] * n[1]
        size = direction[0] ** 2 + direction[1] ** 2
        if along**2 * 10**8 < size * (n[0] ** 2 + n[1] ** 2):
            return False
        # Rounded away from zero: a multiple of the direction, so that the support holds on.
        step = by / along
        step = Q(-((-abs(step) * GRAIN).__floor__()) + 1, GRAIN) * (1 if step > 0 else -1)
        self._change(node, [x + step * d for x, d in zip(self.value(node), direction)], "penetrates a contact")
        return True

    # Energy.

    def bound(self, extra):
        """A number that the energy of the displacement is not above, thickness included; loads may change by the force `extra`."""
        mesh = self.mesh
        vertices, edges = (Ball(values).writable() for values in (self.vertices, self.edges))
        for (kind, i), value in self.exact.items():
            (vertices if kind == "v" else edges).put(i, of_fractions(value))
        total = Q(0)
        stiffness = mesh.by_body(mesh.scene.stiffness)
        for k in np.unique(self.degrees):
            for which in np.array_split(np.flatnonzero(self.degrees == k), max(1, (self.degrees == k).sum() * k * k // 20000)):
                nodes = self._gather(which, int(k), vertices, edges)
                total += Q(float(self._energies(which, int(k), nodes, [m[which] for m in stiffness]).sum()[1]))
        for e, condition in enumerate(mesh.conditions):
            if condition and condition.kind == "load":
                total -= Q(float(self._work(e, condition, vertices, edges).sum()[0]))
        return (total + 2 * Q(extra) * Q(self.scale)) * mesh.scene.thickness

    def _gather(self, which, k, vertices, edges):
        """Coefficients of triangles of degree k, those of the boundary first: an array (nodes, 2, triangles)."""
        mesh, count = self.mesh, len(which)
        out = Ball(np.zeros(((3 * k * k + 3 * k + 2) // 2, 2, count))).writable()
        turn = lambda ball: Ball(np.moveaxis(ball.mid, 0, -1), np.moveaxis(ball.rad, 0, -1))
        corners = mesh.triangles[which]
        for i in range(3):
            out.put(i, turn(vertices[corners[:, i]]))
            e = mesh.sides[which, i]
            for n in np.unique(self.counts[e]):
                own = np.flatnonzero(self.counts[e] == n)
                if k == 1:
                    continue
                place = self.start[e[own]][:, None] + np.arange(n)
                inner = edges[np.where(mesh.signs[which[own], i, None] > 0, place, place[:, ::-1])] if n else None
                ends = [vertices[corners[own, j % 3]] for j in (i + 1, i + 2)]
                along = stack([ends[0], *(inner[:, j] for j in range(n)), ends[1]])  # (n + 2, triangles, 2)
                if n + 1 < k:
                    # About the first value: what all have in common costs no digits.
                    raised = stack([b - along[0] for b in (along[j] for j in range(n + 2))]).times(constants(reference.elevation(n + 1, k)))
                    along = stack([raised[j] + along[0] for j in range(k + 1)])
                for j in range(1, k):
                    out.put((3 + i * (k - 1) + j - 1, slice(None), own), along[j])  # advanced indices come first
        inside = self.inside[self.inside_start[which][:, None] + np.arange(out.mid.shape[0] - 3 * k)]
        out.put(slice(3 * k, None), Ball(np.moveaxis(inside, 0, -1)))
        return out

    def _energies(self, which, k, nodes, stiffness):
        mesh = self.mesh
        by_xi, by_eta, norms = reference.derivatives(k)
        weight, det = constants([norms]), mesh.jacobian[which]
        (a, b), (c, d) = [[m[which] for m in row] for row in mesh.map]
        third = constants([[Q(1, 3)]])[0, 0]
        # Vectors from the centroid to the corners, times 3; the edges are (a, c) from corner 0 to 1 and (b, d) from 0 to 2.
        arms = [(-(a + b), -(c + d)), (a + a - b, c + c - d), (b + b - a, d + d - c)]
        base = nodes[0]
        local = nodes - base
        strain, load_ = None, None
        for sub in range(3):
            own = local[reference.split_nodes(k)[sub]]
            xi, eta = own.times(by_xi), own.times(by_eta)
            (px, py), (qx, qy) = arms[(sub + 1) % 3], arms[(sub + 2) % 3]
            # Gradients times the determinant J / 3 of the subtriangle, times 3.
            ux, uy = xi[:, 0] * qy - eta[:, 0] * py, eta[:, 0] * px - xi[:, 0] * qx
            vx, vy = xi[:, 1] * qy - eta[:, 1] * py, eta[:, 1] * px - xi[:, 1] * qx
            density = (ux + vy).square() * stiffness[0] + (ux - vy).square() * stiffness[1] + (uy + vx).square() * stiffness[2] * 0.25
            own = density.times(weight)[0]
            strain = own if strain is None else strain + own
        # 1/2 (J / 3) sum / (J / 3)^2 / 9
        energy = strain * det.inverse() * constants([[Q(1, 6)]])[0, 0]
        for comp in range(2):
            f = np.array([float(mesh.scene.bodies[n][2][comp]) for n in mesh.body_names])[mesh.bodies[which]]
            if not f.any():
                continue
            count = (k + 1) * (k + 2) // 2
            for sub in range(3):
                mean = local[reference.split_nodes(k)[sub]][:, comp].times(constants([[Q(1, count)] * count]))[0]
                load_ = mean if load_ is None else load_ + mean
            energy = energy - (load_ * third + base[comp]) * det * Ball(f, abs(f) * EPS) * 0.5
            load_ = None
        return energy

    def _work(self, e, condition, vertices, edges):
        tau = load(self.mesh, e, condition)
        if not any(x for t in tau for x in t):
            return Ball([0.0])
        nodes = self.nodes(e, self.mesh.edges[e, 0])
        k, total = len(nodes) - 1, Ball([0.0])
        for j, (kind, i) in enumerate(nodes):
            u = (vertices if kind == "v" else edges)[i]
            for c in range(2):
                # int B_j = 1 / (k + 1), int (2 s - 1) B_j = (2 j - k) / ((k + 1) (k + 2))
                w = tau[0][c] / (k + 1) + (tau[1][c] * Q(2 * j - k, (k + 1) * (k + 2)) if len(tau) > 1 else 0)
                total = total + of_fractions([w]) * u[c]
        return total


def reference_elevate(values, degree):
    low = len(values) - 1
    return values if low == degree else [sum(w * x for w, x in zip(row, values)) for row in reference.elevation(low, degree)]
