"""A triangulation of the proof with the conditions of the scene on its edges, every number exact."""

from dataclasses import dataclass
from fractions import Fraction as Q

import numpy as np

from . import Refused
from .ball import Ball, ball_of, fixed, of_fractions, root, times

PARALLEL = 1e-9  # edges of one straight roller differ by rounding
NEAR = 1e-9  # vertices and areas against polygons, relative to the size of the scene


@dataclass
class Pair:
    """Two edges in contact, or one with an obstacle, s from 0 at the first end to 1 at the second."""

    edges: tuple
    first: tuple
    second: tuple | None
    ends: list  # n times the length of the pair at s = 0 and s = 1: the direction of contact, linear between
    length: tuple  # two numbers that enclose it
    gap: list = None  # Bernstein coefficients of a polynomial that is no larger than the gap
    excess: Q = Q(0)  # by which the gap may be larger than it
    stiffness: Q | None = None  # of a contact that is elastic

    def turns(self):
        return self.ends[0] != self.ends[1]


class Mesh:
    def __init__(self, data, of, scene, manifest):
        self.scene, self.premises, self.what = scene, [], f"the {of} mesh"
        get = lambda what: data[f"{of}_{what}"]
        self.points, self.triangles, self.bodies = get("points"), get("triangles").astype(int), get("bodies").astype(int)
        self.edges, names = get("edges").astype(int)[:, :2], bytes(get("names")).decode().split("\n")
        self.names = [names[i] if i >= 0 else "" for i in get("edges")[:, 2].tolist()]
        self.origin, self.body_names = [Q(x) for x in manifest["origin"]], manifest["bodies"]
        if sorted(self.body_names) != sorted(scene.bodies) or not 0 <= self.bodies.min() <= self.bodies.max() < len(self.body_names):
            raise Refused("the bodies of the proof are not those of the scene")
        if not np.isfinite(self.points).all():
            raise Refused(f"a vertex of {self.what} is no number")
        self._topology()
        self.fixed = fixed(self.points)
        a, b, c = (self.fixed[self.triangles[:, i]] for i in range(3))
        self.det = times(b[:, 0] - a[:, 0], c[:, 1] - a[:, 1]) - times(b[:, 1] - a[:, 1], c[:, 0] - a[:, 0])
        if min(self.det) <= 2:
            raise Refused(f"triangle {int(np.argmin(self.det))} of {self.what} is turned over or flat")
        self.map = [[ball_of((p - a)[:, r], 1e-90) for p in (b, c)] for r in range(2)]  # B, by rows
        self.jacobian = ball_of(self.det, 1e-60)
        self.conditions = [scene.conditions.get(name) if name and right < 0 else None for name, right in zip(self.names, self.owners[:, 1])]
        glued = {name for name, held in scene.conditions.items() if held.kind == "bond" and "stiffness" not in scene.bonds[held.data]}
        for name in set(scene.conditions) - set(self.names) - glued:
            raise Refused(f"no edge of {self.what} is part of '{name}', on which the scene has a condition")
        self._rollers()
        self._springs()
        self._pairs(get("pairs").tolist(), get("pair_data").tolist(), manifest["contacts"])
        kind = lambda condition, right: condition.kind if condition else "inside" if right >= 0 else "free"
        self.kinds = np.array([kind(*of) for of in zip(self.conditions, self.owners[:, 1])], dtype="<U8")
        for e, f, stiffness in self.springs:
            self.kinds[[e, f] if f >= 0 else [e]] = "spring" if all(stiffness) else "slide"
        # The stress and the force on an edge that initial strain makes where all is held.
        self.warm = any(any(e.value) or any(map(any, e.gradient)) for e in scene.strains.values())
        self.stress = self.resting = 0.0
        if self.warm:
            law, all_ = self.by_body(lambda name: scene.bodies[name][1], slice(None)), self.corners(scene.strains, slice(None))
            held = [[w.mid * sum(r.mid * e[i].mid for r, e in zip(row, all_)) for i in range(3)] for w, *row in (law[k : k + 4] for k in (0, 4, 8))]
            lengths = np.hypot(*(self.points[self.edges[:, 1]] - self.points[self.edges[:, 0]]).T)
            self.stress = float(np.abs(held).max())
            self.resting = float((np.abs(held).max((0, 1)) * lengths[self.sides].max(1)).max())
        if scene.polygons:
            self._against_polygons()

    def _topology(self):
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

    def join_layers(self):
        """Makes one edge of the two sides of a layer: tractions on them are equal and opposite."""
        for e, f, _ in self.springs:
            if f >= 0:
                t = self.owners[f, 0]
                i = int(np.flatnonzero(self.sides[t] == f)[0])
                self.sides[t, i], self.signs[t, i], self.owners[e, 1], self.kinds[f] = e, -1, t, "joined"

    def exact(self, vertex):
        return [Q(x) for x in self.points[vertex].tolist()]

    def exact_det(self):
        """Twice the areas of triangles."""
        for corners in self.triangles.tolist():
            (a, b), (c, d), (e, f) = (self.exact(v) for v in corners)
            yield (c - a) * (f - b) - (d - b) * (e - a)

    def written(self, vertex):
        """The vertex in the coordinates of the scene file."""
        return [x + o for x, o in zip(self.exact(vertex), self.origin)]

    def normal(self, a, b):
        (x, y), (u, v) = self.exact(a), self.exact(b)
        return [v - y, x - u]

    def by_body(self, of, which):
        """The fractions of(body) as Balls, a number for each of these triangles."""
        table = [list(of(name)) for name in self.body_names]
        ball = of_fractions([x for row in table for x in row], (len(table), -1))
        return [ball[self.bodies[which], k] for k in range(len(table[0]))]

    def corners(self, fields, which):
        """Affine fields of bodies at the three corners of these triangles: Balls by component and corner."""
        about = lambda f: [x for v, g in zip(f.at(self.origin), f.gradient) for x in (v, *g)]
        numbers = self.by_body(lambda name: about(fields[name]), which)
        points = [Ball(self.points[self.triangles[which, i]].T) for i in range(3)]
        return [[v + gx * p[0] + gy * p[1] for p in points] for v, gx, gy in zip(*(numbers[k::3] for k in range(3)))]

    def forces(self):
        """The body force at the three corners of triangles, in fixed point."""
        out = np.zeros((len(self.triangles), 3, 2), object)
        for b, name in enumerate(self.body_names):
            f, own = self.scene.forces[name], self.triangles[self.bodies == b]
            for c, (v, g) in enumerate(zip(f.at(self.origin), f.gradient)):
                if v or any(g):
                    x, y = np.moveaxis(self.fixed[own], 2, 0)
                    out[self.bodies == b, :, c] = int(fixed([v])[0]) + (times(int(fixed([g[0]])[0]), x) + times(int(fixed([g[1]])[0]), y) if any(g) else 0)
        return out

    def _rollers(self):
        """Direction of every roller edge: as given, or the sum of the normals of all such edges that are parallel to it."""
        self.directions, groups = {}, []
        for e, condition in enumerate(self.conditions):
            if condition and condition.kind == "roller":
                n = self.directions[e] = condition.direction or self.normal(*self.edges[e])
                unit = np.array([float(x) for x in n]) / np.hypot(*map(float, n))
                rounding = 2.0**-48 * np.abs(self.points[self.edges[e]]).max() / np.hypot(*map(float, n))
                near = (group for group in groups if np.abs(unit - group[0]).max() < PARALLEL + rounding)
                group = None if condition.direction else next(near, None)
                groups.append((unit, [e])) if group is None else group[1].append(e)
        for _, group in groups:
            if not self.conditions[group[0]].direction:
                n = [sum(self.directions[e][k] for e in group) for k in range(2)]
                self.directions.update(dict.fromkeys(group, n))
                if 0 not in n:
                    self.premises.append("a roller along a sloped side has one direction along all of it, that of the sum of its edges")

    def _springs(self):
        """Edges on springs: (edge, the one opposite or -1, stiffness along normal and edge); the two sides of a layer coincide."""
        self.springs, outer = [], np.flatnonzero(self.owners[:, 1] < 0).tolist()
        ends = {tuple(x for v in self.edges[e] for x in self.points[v].tolist()): e for e in outer if self.conditions[e] and self.conditions[e].kind == "bond"}
        alone = set(ends.values())
        for (a, b, c, d), e in ends.items():
            name, side = self.scene.sides[self.names[e]]
            f, bond = ends.get((c, d, a, b)), self.scene.bonds[name]
            if "stiffness" in bond and all(bond["stiffness"]) and f is not None and self.scene.sides[self.names[f]] == (name, 1 - side):
                alone -= {e, f}
                if side == 0:
                    self.springs.append((e, f, bond["stiffness"]))
        for e in alone:
            name = self.conditions[e].data
            if "direction" not in self.scene.bonds[name]:
                raise Refused(f"edge {e} of {self.what} is part of the bond {name}, and nothing is opposite")
            self.conditions[e] = None
            self.premises.append(f"bond {name}: edges that face nothing are free")
        self.springs += [(e, -1, c.data) for e, c in enumerate(self.conditions) if c and c.kind == "spring"]
        for e, _, stiffness in self.springs:
            if not all(stiffness):  # along one direction only
                n = self.normal(*self.edges[e])
                self.directions[e] = n if stiffness[0] else [-n[1], n[0]]

    def _pairs(self, whole, real, contacts):
        self.pairs, paired = [], set()
        for (i, e, f, a, b, c, d), data in zip(whole, real, strict=True):
            name, places = contacts[i], ((0, e, {a, b}), (1, f, {c, d}))
            contact = self.scene.contacts.get(name)
            if contact is None or ("between" in contact) != (f >= 0) or e < 0:
                raise Refused(f"the proof has a pair of contact {name} that the scene does not have")
            for side, edge, ends in places[: 1 + (f >= 0)]:
                if edge in paired or self.scene.sides.get(self.names[edge]) != (name, side) or ends != set(self.edges[edge].tolist()):
                    raise Refused(f"edge {edge} of {self.what} is no side of a pair of contact {name}")
                paired.add(edge)
            normal = self.normal(*self.edges[e])
            size, directions = np.hypot(*map(float, normal)), [[Q(x) for x in data[k : k + 2]] for k in (0, 2)]
            straight = "direction" not in contact and "obstacle" not in contact
            if straight and f >= 0 and [self.exact(v) for v in (a, b)] != [self.exact(v) for v in (c, d)]:
                raise Refused(f"the sides of contact {name} do not coincide at vertex {a} of {self.what}")
            if min(float(n[0] * normal[0] + n[1] * normal[1]) for n in directions) < 0.05 * size:
                raise Refused(f"the direction of contact {name} at vertex {a} of {self.what} does not point out of its first side")
            facet = all(abs(float(n) - size * float(m)) < 1e-12 * size for d in directions for n, m in zip(normal, d))
            if straight and facet and directions[0] == directions[1]:
                pair = Pair((e, f), (a, b), (c, d), [normal, normal], root(normal[0] ** 2 + normal[1] ** 2))
            else:
                pair = Pair((e, f), (a, b), (c, d), [[Q(data[4]) * x for x in n] for n in directions], (Q(data[4]), Q(data[4])))
                field = "its direction is the field of unit vectors in the proof, linear along every edge"
                place = "its direction, matching and distance are those in the proof, linear along every edge"
                self.premises.append(f"contact {name}: {field if straight else place}")
            pair.stiffness = contact.get("stiffness")
            self._gap(pair, contact, name, data, straight)
            self.pairs.append(pair)
        for e, condition in enumerate(self.conditions):
            if condition and condition.kind == "contact" and e not in paired:
                name, contact = condition.data, self.scene.contacts[condition.data]
                if "obstacle" not in contact and "direction" not in contact:
                    raise Refused(f"edge {e} of {self.what} is part of contact {name}, and no pair holds it")
                self.conditions[e] = None
                self.premises.append(f"contact {name}: edges that face nothing are free")

    def _gap(self, pair, contact, name, data, straight):
        gap, pair.gap, count = contact.get("gap", 0), [Q(x) for x in data[7:9]], int(data[18])
        if isinstance(gap, list):
            if not all(isinstance(row, list) for row in gap):
                raise Refused(f"the gap of contact {name} is known as a range: this checker does not know those")
            self.premises.append(f"contact {name}: the gap is linear between vertices, with the values in the proof")
        elif not isinstance(gap, dict) and straight and (pair.gap != [Q(gap)] * 2 or count):
            raise Refused(f"the gap of contact {name} in the proof is not that of the scene")
        if count:
            self.premises.append(f"contact {name}: the gap lies between its polynomials in the proof and these plus the excess given there")
            (start, end), b, q = pair.gap, [Q(x) for x in data[9 : 9 + count]], count + 1
            bow = [Q(j * (q - j), q * (q - 1)) * b[j - 1] if 0 < j < q else 0 for j in range(q + 1)]
            pair.gap, pair.excess = [start + (end - start) * j / q - bow[j] for j in range(q + 1)], abs(Q(data[19]))

    def _against_polygons(self):
        """Areas of bodies, and that edges of the outline lie on a side of their name."""
        sides, area, curved, size = {}, {}, set(), max(np.ptp(self.points, axis=0))
        for polygon in self.scene.polygons:
            points, body = np.array([[float(Q(x) - o) for x, o in zip(p, self.origin)] for p in polygon["points"]]), polygon["body"]
            (x, y), (u, v) = points.T, np.roll(points, -1, 0).T
            area[body] = area.get(body, 0) + abs((x * v - y * u).sum()) / 2
            arcs = {arc["edge"] for arc in polygon.get("arcs", [])}
            curved |= {body} if arcs else set()
            for i, name in enumerate(polygon["edges"]):
                sides.setdefault((body, name), []).append(None if i in arcs else (points[i], np.roll(points, -1, 0)[i]))
        if curved:
            self.premises.append("arcs of polygons are the chords between the vertices of the mesh")
        for b, body in enumerate(self.body_names):
            if body not in curved and abs(self.jacobian.mid[self.bodies == b].sum() / 2 - area.get(body, 0)) > NEAR * size * size:
                raise Refused(f"the triangles of {self.what} in body '{body}' do not have the area of its polygons: some are missing, or moved")
        if self.scene.raw.get("boundaries"):
            return
        outer, names, whose = self.owners[:, 1] < 0, np.array(self.names), np.array(self.body_names)[self.bodies]
        lies = np.zeros(len(self.edges), bool)
        glued = whose[self.owners[:, 0]] == whose[self.owners[:, 1]]
        for (body, name), parts in sides.items():
            near = np.zeros(len(self.edges), bool)
            for part in parts:
                near |= _distances(self.points, *part)[self.edges].max(1) <= NEAR * size if part else outer
            own = whose[self.owners] == body
            lies |= near & outer & own[:, 0] & (names == name)
            held = self.scene.conditions.get(name)
            inside = near & ~outer & own.any(1)
            if held and held.kind == "bond":
                glued |= inside
            elif held:
                glued &= ~inside
        for e in np.flatnonzero(outer & ~lies)[:1].tolist():
            what = f"named '{names[e]}'" if names[e] else "without a name"
            raise Refused(f"edge {e} of {self.what}, on the outline of body '{whose[self.owners[e, 0]]}', lies on no side of its polygon {what}")
        for e in np.flatnonzero(~outer & ~glued)[:1].tolist():
            raise Refused(f"edge {e} of {self.what} joins what the scene does not bond")


def _distances(p, a, b):
    s = np.clip((p - a) @ (b - a) / ((b - a) @ (b - a)), 0, 1)
    return np.hypot(*(p - a - s[:, None] * (b - a)).T)
