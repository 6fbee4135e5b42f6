"""A triangulation of the proof with the conditions of the scene on its edges, every number exact."""

from dataclasses import dataclass

import numpy as np
from flint import arb, fmpq

from . import Refused
from .exact import cross, dot, length, lower, raised, rational, times
from .scene import at

PARALLEL = 1e-9  # edges of one straight roller differ by rounding
NEAR = 1e-9  # vertices and areas against polygons, relative to the size of the scene


@dataclass
class Joint:
    """A constraint along one direction on an edge, against the ground or between two edges; s runs from 0 to 1 along it. The jump of
    displacements j = (v' - v'').n equals |n| times the offset, or is at most that where the joint can only press; in a joint with a stiffness
    the excess costs energy, and in one with a bound of friction every jump does. The traction of the first side, times the length of the edge,
    is b(s) n(s) with b the unknown; that of a contact with friction is the sum of two such, along its direction and along it turned by 90 degrees."""

    edges: tuple  # of the first side, of the second or -1
    starts: tuple  # the vertices where s = 0
    normal: list  # Bernstein coefficients of n(s): one, or two where it turns
    length: object  # of n
    offset: list  # Bernstein coefficients
    excess: object = 0  # by which the offset of one that presses may be larger
    stiffness: object = None  # None: rigid
    presses: bool = False
    bound: list = None  # of |b| where there is friction: values at both ends, linear between
    pressure: list = None  # b, where it is not the traction that is unknown

    @property
    def limited(self):
        """True if not all tractions along n are admissible."""
        return self.presses or self.bound is not None

    def limits(self, count):
        """The least and the largest value of each of so many Bernstein coefficients of b: a polynomial lies between those that its lie between."""
        if self.bound is None:
            return [(arb("-inf"), arb(0) if self.presses else arb("inf"))] * count
        most = raised(self.bound, count - 1) if count > 1 else [min(self.bound)]
        return [(-lower(x), lower(x)) for x in most]

    def along(self, vectors):
        """Bernstein coefficients of the product of a polynomial vector with n."""
        return [x + y for x, y in zip(*(times(v, n) for v, n in zip(zip(*vectors), zip(*self.normal))))]


class Mesh:
    def __init__(self, data, of, scene, manifest):
        self.scene, self.premises, self.what = scene, [], f"the {of} mesh"
        get = lambda what: data[f"{of}_{what}"]
        self.points, self.triangles, self.bodies = get("points"), get("triangles").astype(int), get("bodies").astype(int)
        self.edges, names = get("edges").astype(int)[:, :2], bytes(get("names")).decode().split("\n")
        self.names = [names[i] if i >= 0 else "" for i in get("edges")[:, 2].tolist()]
        self.origin, self.body_names = [rational(x) for x in manifest["origin"]], manifest["bodies"]
        if sorted(self.body_names) != sorted(scene.laws) or not 0 <= self.bodies.min() <= self.bodies.max() < len(self.body_names):
            raise Refused("the bodies of the proof are not those of the scene")
        if not np.isfinite(self.points).all():
            raise Refused(f"a vertex of {self.what} is no number")
        self._topology()
        self.x = [(arb(x), arb(y)) for x, y in self.points.tolist()]
        for t in range(len(self.triangles)):
            if not self.shape(t)[1] > 0:
                raise Refused(f"triangle {t} of {self.what} is turned over or flat")
        self.conditions = [scene.conditions.get(name) if name and right < 0 else None for name, right in zip(self.names, self.owners[:, 1])]
        glued = {name for name, held in scene.conditions.items() if held.kind == "bond" and "stiffness" not in scene.bonds[held.data]}
        for name in set(scene.conditions) - set(self.names) - glued:
            raise Refused(f"no edge of {self.what} is part of '{name}', on which the scene has a condition")
        self.layers = self._layers()
        self.joints = [*self._supports(), *self._pairs(get("pairs").tolist(), get("pair_data").tolist(), manifest["contacts"])]
        if scene.polygons:
            self._against_polygons()

    def _topology(self):
        """Sides and signs: of each triangle the edge opposite a corner, and 1 where it lies on the left of it. Owners: the triangle on the left
        and on the right of each edge, or -1."""
        if min(self.triangles.min(), self.edges.min()) < 0 or max(self.triangles.max(), self.edges.max()) >= len(self.points):
            raise Refused(f"{self.what} refers to a vertex that is not there")
        place = {edge: e for e, edge in enumerate(map(tuple, self.edges.tolist()))}
        if len(place) < len(self.edges) or any((b, a) in place for a, b in place):
            raise Refused(f"an edge of {self.what} is there twice")
        self.sides, self.signs = np.zeros((2, len(self.triangles), 3), int)
        self.owners = np.full((len(self.edges), 2), -1)
        for t, corners in enumerate(self.triangles.tolist()):
            for i in range(3):
                a, b = corners[(i + 1) % 3], corners[(i + 2) % 3]
                right = int((a, b) not in place)
                e = place.get((b, a) if right else (a, b))
                if e is None or self.owners[e, right] >= 0:
                    raise Refused(f"triangle {t} of {self.what} lies on the same side of an edge as another one, or on a line that is no edge")
                self.owners[e, right], self.sides[t, i], self.signs[t, i] = t, e, 1 - 2 * right
        if (self.owners[:, 0] < 0).any():
            raise Refused(f"edge {int(np.argmin(self.owners[:, 0]))} of {self.what} has no triangle on its left: one is missing")

    def shape(self, t):
        """The edges from the first corner of a triangle, and twice its area."""
        o, p, q = (self.x[v] for v in self.triangles[t].tolist())
        first, second = (p[0] - o[0], p[1] - o[1]), (q[0] - o[0], q[1] - o[1])
        return (first, second), cross(first, second)

    def written(self, vertex):
        """The vertex in the coordinates of the scene file."""
        return [x + o for x, o in zip(self.x[vertex], self.origin)]

    def normal(self, e):
        """The normal of an edge, as long as the edge: outwards on the outline."""
        (x, y), (u, v) = (map(rational, self.points[i].tolist()) for i in self.edges[e].tolist())
        return [v - y, x - u]

    def body(self, t):
        return self.body_names[self.bodies[t]]

    def corners(self, fields, t):
        """A field of bodies that is affine, at the corners of a triangle: a list by component; None where it is zero."""
        if field := fields[self.body(t)]:
            return list(zip(*(field.at(self.written(v)) for v in self.triangles[t].tolist())))

    def _outer(self, kind):
        return [(e, c) for e, c in enumerate(self.conditions) if c and c.kind == kind]

    def _supports(self):
        """Joints between edges and the ground, and of layers."""
        directions = self._rollers()
        for e, held in self._outer("clamped"):
            u = list(zip(*(held.data.at([rational(x) + o for x, o in zip(self.points[v].tolist(), self.origin)]) for v in self.edges[e].tolist())))
            for c, n in enumerate(([1, 0], [0, 1])):
                yield Joint((e, -1), (self.edges[e, 0], -1), [[fmpq(x) for x in n]], arb(1), list(u[c]))
        for e, held in self._outer("roller"):
            yield Joint((e, -1), (self.edges[e, 0], -1), [directions[e]], length(directions[e]), [held.data])
        for e, f, stiffness in [*self.layers, *((e, -1, held.data) for e, held in self._outer("spring"))]:
            n = self.normal(e)
            for k, direction in zip(stiffness, (n, [-n[1], n[0]])):
                if k:
                    yield Joint((e, f), (self.edges[e, 0], self.edges[f, 1]), [direction], length(n), [fmpq(0)], stiffness=k)

    def _rollers(self):
        """Direction of every roller edge: as given, or the sum of the normals of all such edges that are parallel to it."""
        directions, groups = {e: held.direction for e, held in self._outer("roller")}, []
        for e in [e for e, given in directions.items() if not given]:
            n, reach = self.normal(e), np.abs(self.points[self.edges[e]]).max()
            size = float(length(n))
            unit = np.array([float(x) / size for x in n])
            near = [group for group in groups if np.abs(unit - group[0]).max() < PARALLEL + 2.0**-48 * reach / size]
            near[0][1].append(e) if near else groups.append((unit, [e]))
        for _, group in groups:
            n = [sum(self.normal(e)[k] for e in group) for k in range(2)]
            directions |= dict.fromkeys(group, n)
            if 0 not in n:
                self.premises.append("a roller along a sloped side has one direction along all of it, that of the sum of its edges")
        return directions

    def _layers(self):
        """Edges of elastic bonds: (edge, the one that coincides with it, stiffnesses)."""
        ends = {tuple(self.points[self.edges[e]].ravel().tolist()): e for e, _ in self._outer("bond")}
        alone, found = set(ends.values()), []
        for (a, b, c, d), e in ends.items():
            (name, side), f = self.scene.sides[self.names[e]], ends.get((c, d, a, b))
            bond = self.scene.bonds[name]
            if all(bond.get("stiffness", [0])) and f is not None and self.scene.sides[self.names[f]] == (name, 1 - side):
                alone -= {e, f}
                found += [(e, f, bond["stiffness"])] if side == 0 else []
        for e in alone:
            name = self.conditions[e].data
            if "direction" not in self.scene.bonds[name]:
                raise Refused(f"edge {e} of {self.what} is part of the bond {name}, and nothing is opposite")
            self._release(e, f"bond {name}")
        return found

    def _release(self, e, what):
        self.conditions[e] = None
        self.premises.append(f"{what}: edges that face nothing are free")

    def _pairs(self, whole, real, contacts):
        """Joints of contacts."""
        paired = set()
        for (i, e, f, a, b, c, d), data in zip(whole, real, strict=True):
            name, places = contacts[i], ((0, e, {a, b}), (1, f, {c, d}))
            contact = self.scene.contacts.get(name)
            if contact is None or ("between" in contact) != (f >= 0) or e < 0:
                raise Refused(f"the proof has a pair of contact {name} that the scene does not have")
            for side, edge, ends in places[: 1 + (f >= 0)]:
                if edge in paired or self.scene.sides.get(self.names[edge]) != (name, side) or ends != set(self.edges[edge].tolist()):
                    raise Refused(f"edge {edge} of {self.what} is no side of a pair of contact {name}")
                paired.add(edge)
            straight = "direction" not in contact and "obstacle" not in contact
            if straight and f >= 0 and (self.points[[a, b]] != self.points[[c, d]]).any():
                raise Refused(f"the sides of contact {name} do not coincide at vertex {a} of {self.what}")
            n, size = self._contact_direction(e, a, name, data, straight)
            gap, excess = self._gap(contact, name, data, straight)
            yield Joint((e, f), (a, c), n, size, gap, excess, contact.get("stiffness"), True)
            if table := contact.get("friction"):
                bound, forward = [at(table, rational(s)) for s in data[5:7]], 1 if a == self.edges[e, 0] else -1
                yield Joint((e, f), (a, c), [[-forward * y, forward * x] for x, y in n], size, [fmpq(0)], bound=bound)
                if "move" in contact:
                    self.premises.append(f"contact {name}: the obstacle moves across itself alone")
                if len(table) > 1:
                    self.premises.append(f"contact {name}: the bound of friction is linear between vertices")
                    self.premises.append(f"contact {name}: arc lengths are those in the proof")
        for e, held in self._outer("contact"):
            if e not in paired:
                contact = self.scene.contacts[held.data]
                if "obstacle" not in contact and "direction" not in contact:
                    raise Refused(f"edge {e} of {self.what} is part of contact {held.data}, and no pair holds it")
                self._release(e, f"contact {held.data}")

    def _contact_direction(self, e, a, name, data, straight):
        """n(s) and its length: the normal of a straight edge, or else the field in the proof."""
        normal, given, size = self.normal(e), [[rational(x) for x in data[k : k + 2]] for k in (0, 2)], rational(data[4])
        if min(float(dot(n, normal)) for n in given) < 0.05 * float(length(normal)):
            raise Refused(f"the direction of contact {name} at vertex {a} of {self.what} does not point out of its first side")
        if straight and given[0] == given[1] and all(abs(x - length(normal) * y) < 1e-12 * length(normal) for x, y in zip(normal, given[0])):
            return [normal], length(normal)
        field = "its direction is the field of unit vectors in the proof, linear along every edge"
        place = "its direction, matching and distance are those in the proof, linear along every edge"
        self.premises.append(f"contact {name}: {field if straight else place}")
        n = [[size * x for x in direction] for direction in given]
        return n[: 1 + (n[0] != n[1])], arb(size)

    def _gap(self, contact, name, data, straight):
        """Bernstein coefficients of a polynomial that is no larger than the gap, and by how much the gap may be larger."""
        gap, (start, end), count = contact.get("gap", 0), [rational(x) for x in data[7:9]], int(data[18])
        if isinstance(gap, list):
            if not all(isinstance(row, list) for row in gap):
                raise Refused(f"the gap of contact {name} is known as a range: this checker does not know those")
            self.premises.append(f"contact {name}: the gap is linear between vertices")
        elif not isinstance(gap, dict) and straight and ([start, end] != [rational(gap)] * 2 or count):
            raise Refused(f"the gap of contact {name} in the proof is not that of the scene")
        if straight and not isinstance(gap, int | float):
            for s, found in zip(data[5:7], data[7:9]):
                if not abs(found - _gap_at(gap, float(s))) <= NEAR * (abs(found) + float(data[4])):
                    raise Refused(f"the gap of contact {name} at the arc length {s!r} in the proof is not that of the scene")
            self.premises.append(f"contact {name}: arc lengths are those in the proof")
        if not count:
            return [start, end], 0
        self.premises.append(f"contact {name}: the gap lies between its polynomials in the proof and these plus the excess given there")
        b, q = [0, *map(rational, data[9 : 9 + count]), 0], count + 1
        bow = [fmpq(j * (q - j), q * (q - 1)) * x for j, x in enumerate(b)]  # s (1 - s) b(s)
        return [start + (end - start) * fmpq(j, q) - x for j, x in enumerate(bow)], abs(rational(data[19]))

    def _against_polygons(self):
        """Areas of bodies, that edges of the outline lie on a side of their name, and that what is joined is bonded."""
        size, whose, sides, area, curved = max(np.ptp(self.points, axis=0)), np.array(self.body_names)[self.bodies], [], {}, set()
        for polygon in self.scene.polygons:
            points, body = np.array([[float(rational(x) - o) for x, o in zip(p, self.origin)] for p in polygon["points"]]), polygon["body"]
            ends, arcs = np.roll(points, -1, 0), {arc["edge"] for arc in polygon.get("arcs", [])}
            area[body] = area.get(body, 0) + abs(cross(points.T, ends.T).sum()) / 2
            curved |= {body} if arcs else set()
            sides += [(body, name, None if i in arcs else (points[i], ends[i])) for i, name in enumerate(polygon["edges"])]
        if curved:
            self.premises.append("arcs of polygons are the chords between the vertices of the mesh")
        own = {body: sum(float(self.shape(t)[1]) for t in np.flatnonzero(whose == body)) / 2 for body in set(self.body_names) - curved}
        for body, found in own.items():
            if abs(found - area.get(body, 0)) > NEAR * size * size:
                raise Refused(f"the triangles of {self.what} in body '{body}' do not have the area of its polygons: some are missing, or moved")
        if self.scene.raw.get("boundaries"):
            return
        outer, names, lies = self.owners[:, 1] < 0, np.array(self.names), np.zeros(len(self.edges), bool)
        joined = whose[self.owners[:, 0]] == whose[self.owners[:, 1]]
        for body, name, part in sides:
            near = _distances(self.points, *part)[self.edges].max(1) <= NEAR * size if part else outer
            lies |= near & outer & (whose[self.owners[:, 0]] == body) & (names == name)
            held = self.scene.conditions.get(name)
            if held:
                inside = near & ~outer & (whose[self.owners] == body).any(1)
                joined = joined | inside if held.kind == "bond" else joined & ~inside
        for e in np.flatnonzero(outer & ~lies)[:1].tolist():
            what = f"named '{names[e]}'" if names[e] else "without a name"
            raise Refused(f"edge {e} of {self.what}, on the outline of body '{self.body(self.owners[e, 0])}', lies on no side of its polygon {what}")
        for e in np.flatnonzero(~outer & ~joined)[:1].tolist():
            raise Refused(f"edge {e} of {self.what} joins what the scene does not bond")


def _gap_at(gap, s):
    """The gap of a scene at an arc length: rows [s, g], or the distance of a parabola or of a circle."""
    if isinstance(gap, list):
        return np.interp(s, *np.array(gap, float).T)
    away = s - float(gap["at"])
    if "parabola" in gap:
        return away * away / (2 * float(gap["parabola"]))
    radius = float(gap["circle"])
    return away * away / (radius + np.sqrt(max(radius * radius - away * away, 0)))


def _distances(p, a, b):
    s = np.clip((p - a) @ (b - a) / ((b - a) @ (b - a)), 0, 1)
    return np.hypot(*(p - a - s[:, None] * (b - a)).T)
