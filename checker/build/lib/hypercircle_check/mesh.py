"""A triangulation of the proof with the conditions of the scene on its edges, every number exact."""

from dataclasses import dataclass
from fractions import Fraction as Q

import numpy as np

from . import Refused
from .ball import Ball, ball_of, fixed, root, times
from .scene import premise_of_contact

PARALLEL = 1e-10  # edges of one straight roller differ by rounding
NEAR = 1e-9  # vertices of a polygon's side, relative to the size of the polygon


@dataclass
class Pair:
    """Two edges in contact, or one with an obstacle, s from 0 at the first end to 1 at the second."""

    contact: int
    edges: tuple
    first: tuple
    second: tuple | None
    ends: list  # n times the length of the pair at s = 0 and s = 1: the direction of contact, linear between
    length: tuple  # two numbers that enclose it
    gap: list  # Bernstein coefficients of a polynomial that is no larger than the gap
    excess: Q  # by which the gap may be larger than it

    def turns(self):
        return self.ends[0] != self.ends[1]


class Mesh:
    def __init__(self, data, of, scene, manifest):
        self.of, self.scene, self.premises = of, scene, []
        get = lambda what: data[f"{of}_{what}"]
        self.points, self.triangles, self.bodies = get("points"), get("triangles").astype(int), get("bodies").astype(int)
        edges = get("edges").astype(int)
        self.edges, named = edges[:, :2], edges[:, 2]
        names = bytes(get("names")).decode().split("\n")
        self.names = [names[i] if i >= 0 else "" for i in named.tolist()]
        self.origin = [Q(x) for x in manifest["origin"]]
        order = manifest["bodies"]
        if list(scene.bodies) and sorted(order) != sorted(scene.bodies):
            raise Refused("the bodies of the proof are not those of the scene")
        self.body_names = order
        if not np.isfinite(self.points).all():
            raise Refused(f"a vertex of the {of} mesh is no number")
        self._topology()
        self.fixed = fixed(self.points)
        a, b, c = (self.fixed[self.triangles[:, i]] for i in range(3))
        self.det = times(b[:, 0] - a[:, 0], c[:, 1] - a[:, 1]) - times(b[:, 1] - a[:, 1], c[:, 0] - a[:, 0])
        if any(d <= 2 for d in self.det):
            raise Refused(f"triangle {next(t for t, d in enumerate(self.det) if d <= 2)} of the {of} mesh is turned over or flat")
        self.map = [[ball_of((p - a)[:, r], 4.0 / (1 << 300)) for p in (b, c)] for r in range(2)]  # B, by rows
        self.jacobian = ball_of(self.det, 1e-60)
        self.materials = None
        self.conditions = [scene.conditions.get(name) if self.owners[e, 1] < 0 and name else None for e, name in enumerate(self.names)]
        self._rollers()
        self._pairs(get("pairs").astype(int), get("pair_data"), manifest["contacts"])
        for name in scene.conditions:
            if name not in self.names:
                raise Refused(f"no edge of the {of} mesh is part of '{name}', on which the scene has a condition")
        if scene.polygons:
            self._against_polygons()

    def _topology(self):
        count, edges = len(self.points), self.edges
        if min(self.triangles.min(), edges.min()) < 0 or max(self.triangles.max(), edges.max()) >= count:
            raise Refused(f"the {self.of} mesh refers to a vertex that is not there")
        key = {}
        for e, (a, b) in enumerate(edges.tolist()):
            if a == b or (a, b) in key or (b, a) in key:
                raise Refused(f"edge {e} of the {self.of} mesh is there twice")
            key[a, b] = e
        self.sides = np.zeros((len(self.triangles), 3), int)
        self.signs = np.zeros((len(self.triangles), 3), int)
        self.owners = np.full((len(edges), 2), -1)
        for t, corners in enumerate(self.triangles.tolist()):
            for i in range(3):
                a, b = corners[(i + 1) % 3], corners[(i + 2) % 3]
                e, side = (key[a, b], 0) if (a, b) in key else (key.get((b, a)), 1)
                if e is None:
                    raise Refused(f"a side of triangle {t} of the {self.of} mesh is no edge of it")
                if self.owners[e, side] >= 0:
                    raise Refused(f"two triangles of the {self.of} mesh, {self.owners[e, side]} and {t}, lie on the same side of an edge")
                self.owners[e, side], self.sides[t, i], self.signs[t, i] = t, e, 1 - 2 * side
        if (self.owners[:, 0] < 0).any():
            raise Refused(f"edge {int(np.argmax(self.owners[:, 0] < 0))} of the {self.of} mesh has no triangle on its left: one is missing")

    def exact(self, vertex):
        return [Q(x) for x in self.points[vertex].tolist()]

    def written(self, vertex):
        """The vertex in the coordinates of the scene file."""
        return [x + o for x, o in zip(self.exact(vertex), self.origin)]

    def normal(self, a, b):
        (x, y), (u, v) = self.exact(a), self.exact(b)
        return [v - y, x - u]

    def kind(self, e):
        return self.conditions[e].kind if self.conditions[e] else "inside" if self.owners[e, 1] >= 0 else "free"

    def material(self, of):
        """Three Balls, one number a triangle: of(body) gives three fractions."""
        table = [[float(x) for x in of(name)] for name in self.body_names]
        mid = np.array(table)[self.bodies]
        return [Ball(mid[:, k], abs(mid[:, k]) * 2.0**-51) for k in range(3)]

    def _rollers(self):
        """Direction of every roller edge: as given, or the normal of the straight side that it is a part of."""
        self.directions, default = {}, []
        for e, condition in enumerate(self.conditions):
            if condition and condition.kind == "roller":
                if condition.direction:
                    self.directions[e] = condition.direction
                else:
                    self.directions[e] = self.normal(*self.edges[e])
                    default.append(e)
        at = {}
        for e in default:
            for v in self.edges[e].tolist():
                at.setdefault(v, []).append(e)
        parent = {e: e for e in default}

        def top(e):
            while parent[e] != e:
                parent[e] = parent[parent[e]]
                e = parent[e]
            return e

        for v, meeting in at.items():
            if len(meeting) == 2:
                m, n = (self.directions[e] for e in meeting)
                size = float(m[0] ** 2 + m[1] ** 2) ** 0.5 * float(n[0] ** 2 + n[1] ** 2) ** 0.5
                rounding = 8 * 2.0**-52 * max(abs(self.points[v])) * max(float(m[0] ** 2 + m[1] ** 2), float(n[0] ** 2 + n[1] ** 2)) ** 0.5
                if abs(float(m[0] * n[1] - m[1] * n[0])) <= PARALLEL * size + rounding:
                    parent[top(meeting[0])] = top(meeting[1])
        total = {}
        for e in default:
            sums = total.setdefault(top(e), [Q(0), Q(0)])
            sums[0], sums[1] = sums[0] + self.directions[e][0], sums[1] + self.directions[e][1]
        for e in default:
            n = total[top(e)]
            self.directions[e] = [Q(0) if n[0] == 0 else n[0], n[1]]
            if 0 not in n:
                self.premises.append("a roller along a sloped side has one direction along all of it, that of the sum of its edges")

    def _pairs(self, whole, real, contacts):
        self.pairs, paired = [], set()
        for (i, e, f, a, b, c, d), data in zip(whole.tolist(), real.tolist()):
            name = contacts[i] if 0 <= i < len(contacts) else None
            contact = self.scene.contacts.get(name)
            if contact is None:
                raise Refused(f"the proof has a contact {name} that the scene does not have")
            if e < 0 or {a, b} != set(self.edges[e].tolist()) or (f >= 0 and {c, d} != set(self.edges[f].tolist())):
                raise Refused(f"a pair of contact {name} does not fit the edges of the {self.of} mesh")
            for side, edge in ((0, e), (1, f)):
                if edge >= 0 and (self.scene.sides.get(self.names[edge]) != (name, side) or edge in paired):
                    raise Refused(f"edge {edge} of the {self.of} mesh is in a pair of contact {name} without being part of its side")
                paired.add(edge) if edge >= 0 else None
            if ("between" in contact) != (f >= 0):
                raise Refused(f"a pair of contact {name} has no second side")
            normal = self.normal(a, b) if a == self.edges[e, 0] else self.normal(b, a)
            directions = [[Q(x) for x in data[0:2]], [Q(x) for x in data[2:4]]]
            straight = "direction" not in contact and "obstacle" not in contact
            coincide = f < 0 or (self.exact(a) == self.exact(c) and self.exact(b) == self.exact(d))
            if straight and not coincide:
                raise Refused(f"the sides of contact {name} do not coincide at vertex {a} of the {self.of} mesh")
            size = float(normal[0] ** 2 + normal[1] ** 2) ** 0.5
            if straight and directions[0] == directions[1] and all(abs(float(n) - size * float(m)) < 1e-12 * size for n, m in zip(normal, directions[0])):
                ends, length = [normal, normal], root(normal[0] ** 2 + normal[1] ** 2)
            else:
                cosines = [float(n[0] * m[0] + n[1] * m[1]) / size for n, m in ((normal, d) for d in directions)]
                if min(cosines) < 0.05:
                    raise Refused(f"the direction of contact {name} at vertex {a} of the {self.of} mesh does not point out of its first side")
                ends, length = [[Q(data[4]) * x for x in d] for d in directions], (Q(data[4]), Q(data[4]))
                if straight:
                    self.premises.append(f"contact {name}: its direction is the field of unit vectors in the proof, linear along every edge")
            self.pairs.append(Pair(i, (e, f), (a, b), (c, d) if f >= 0 else None, ends, length, *self._gap(contact, name, data, straight)))
        for e, condition in enumerate(self.conditions):
            if condition and condition.kind == "contact" and e not in paired:
                name = condition.data
                if "obstacle" not in self.scene.contacts[name] and "direction" not in self.scene.contacts[name]:
                    raise Refused(f"edge {e} of the {self.of} mesh is part of contact {name}, and no pair holds it")
                self.conditions[e] = None
                self.premises.append(f"contact {name}: edges that face nothing are free")

    def _gap(self, contact, name, data, straight):
        gap, ends, count = contact.get("gap", 0), [Q(data[7]), Q(data[8])], int(data[18])
        premise = premise_of_contact(contact)
        if premise:
            self.premises.append(premise)
        if not isinstance(gap, (list, dict)):
            if straight and (ends != [Q(gap)] * 2 or count):
                raise Refused(f"the gap of contact {name} in the proof is not that of the scene")
            return ends, Q(0)
        if isinstance(gap, list):
            self.premises.append(f"contact {name}: the gap is linear between vertices, with the values in the proof")
        if not count:
            return ends, Q(0)
        self.premises.append(f"contact {name}: the gap lies between its polynomials in the proof and these plus the excess given there")
        degree, b = count + 1, [Q(x) for x in data[9 : 9 + count]]
        chord = [ends[0] + (ends[1] - ends[0]) * j / degree for j in range(degree + 1)]
        part = lambda j: Q(j * (degree - j), degree * (degree - 1)) * b[j - 1] if 0 < j < degree else Q(0)
        return [g - part(j) for j, g in enumerate(chord)], Q(data[19])

    def _against_polygons(self):
        """Areas of bodies, and that edges with a name lie on the side of this name."""
        sides, area, curved = {}, {}, set()
        for polygon in self.scene.polygons:
            points, body = [[float(Q(x) - o) for x, o in zip(p, self.origin)] for p in polygon["points"]], polygon["body"]
            ends = list(zip(points, points[1:] + points[:1]))
            area[body] = area.get(body, 0) + abs(sum(p[0] * q[1] - p[1] * q[0] for p, q in ends)) / 2
            if polygon.get("arcs"):
                curved.add(body)
            arcs = {arc["edge"] for arc in polygon.get("arcs", [])}
            for i, (name, side) in enumerate(zip(polygon["edges"], ends)):
                sides.setdefault((body, name), []).append(None if i in arcs else side)
        size = max(np.ptp(self.points, axis=0).max(), 1e-300)
        own = self.jacobian.mid / 2
        for b, body in enumerate(self.body_names):
            if body not in curved and abs(own[self.bodies == b].sum() - area.get(body, 0)) > NEAR * size * size:
                raise Refused(f"the triangles of the {self.of} mesh in body '{body}' do not have the area of its polygons: some are missing, or moved")
        if curved:
            self.premises.append("arcs of polygons are the chords between the vertices of the mesh")
        renamed = bool(self.scene.raw.get("boundaries"))
        for e in np.flatnonzero(self.owners[:, 1] < 0).tolist():
            body, name = self.body_names[self.bodies[self.owners[e, 0]]], self.names[e]
            found = sides.get((body, name), [])
            if not any(s is None or all(_distance(self.points[v], s) <= NEAR * size for v in self.edges[e]) for s in found) and not renamed:
                what = f"named '{name}'" if name else "without a name"
                raise Refused(f"edge {e} of the {self.of} mesh, on the outline of body '{body}', lies on no side of its polygon {what}")


def _distance(p, side):
    a, b = np.array(side)
    d = b - a
    s = min(max(((p - a) @ d) / (d @ d), 0.0), 1.0)
    return float(np.hypot(*(p - a - s * d)))
