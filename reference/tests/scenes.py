"""Small problems built directly in the exchange format, with no help from the package under test."""

from __future__ import annotations

import math

CLAMP, ROLLER, LOAD, CONTACT = "clamp", "roller", "load", "contact"


class Builder:
    """Collects blocks of triangles and writes the exchange dictionary."""

    def __init__(self, kinematics="plane-strain", thickness=1.0):
        self.data = {
            "format": "hypercircle-exchange", "version": 1, "kinematics": kinematics, "thickness": thickness,
            "bodies": [], "points": [], "triangles": [], "body": [], "edges": [], "triangle_edges": [],
            "clamped": [], "roller": [], "tractions": [], "contacts": [], "pins": [], "quadrilaterals": [],
        }  # fmt: skip
        self.edge_of = {}

    def body(self, name="body", young=1.0, poisson=0.3, body_force=(0.0, 0.0)):
        self.data["bodies"].append(
            {"name": name, "young": young, "poisson": poisson, "body_force": list(body_force)}
        )
        return len(self.data["bodies"]) - 1

    def triangle(self, body, corners):
        index = []
        for i in range(3):
            ends = (corners[(i + 1) % 3], corners[(i + 2) % 3])
            key = tuple(sorted(ends))
            if key not in self.edge_of:
                self.edge_of[key] = len(self.data["edges"])
                self.data["edges"].append(list(ends))
            index.append(self.edge_of[key])
        self.data["triangles"].append(list(corners))
        self.data["triangle_edges"].append(index)
        self.data["body"].append(body)

    def block(self, body, nx, ny, place):
        """nx × ny squares, diagonals alternating like a chessboard; ``place(s, t)`` maps [0, 1]² to the plane.

        Returns vertex chains of the four sides: bottom, right, top, left, each in the direction of growing s or t.
        """
        base = len(self.data["points"])
        self.data["points"] += [list(place(i / nx, j / ny)) for j in range(ny + 1) for i in range(nx + 1)]

        def at(i, j):
            return base + j * (nx + 1) + i

        for j in range(ny):
            for i in range(nx):
                a, b, c, d = at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)
                split = [(a, b, c), (a, c, d)] if (i + j) % 2 == 0 else [(a, b, d), (b, c, d)]
                first = len(self.data["triangles"])
                for corners in split:
                    self.triangle(body, corners)
                corners = [b, c, d, a] if (i + j) % 2 == 0 else [a, b, c, d]
                self.data["quadrilaterals"].append({"corners": corners, "triangles": [first, first + 1]})
        return {
            "bottom": [at(i, 0) for i in range(nx + 1)],
            "right": [at(nx, j) for j in range(ny + 1)],
            "top": [at(i, ny) for i in range(nx + 1)],
            "left": [at(0, j) for j in range(ny + 1)],
        }

    def edges_of(self, chain):
        return [self.edge_of[tuple(sorted(pair))] for pair in zip(chain, chain[1:])]

    def clamp(self, chain, displacement=(0.0, 0.0)):
        self.data["clamped"] += [{"edge": e, "displacement": list(displacement)} for e in self.edges_of(chain)]

    def roller(self, chain, normal):
        self.data["roller"] += [{"edge": e, "normal": list(normal)} for e in self.edges_of(chain)]

    def load(self, chain, traction):
        for e in self.edges_of(chain):
            values = [list(traction(*self.data["points"][v])) for v in self.data["edges"][e]]
            self.data["tractions"].append({"edge": e, "values": values})

    def contact(self, first, second, normal, gap=lambda x, y: 0.0, name="contact"):
        pairs = []
        for k, edge in enumerate(self.edges_of(first)):
            ends = [first[k], first[k + 1]]
            opposite = None if second is None else [second[k], second[k + 1]]
            pairs.append({
                "edges": [edge, None if second is None else self.edges_of(second)[k]],
                "first": ends, "second": opposite, "normal": list(normal), "direction": [list(normal), list(normal)],
                "gap": [gap(*self.data["points"][v]) for v in ends],
            })  # fmt: skip
        self.data["contacts"].append({"name": name, "pairs": pairs})

    def friction(self, bound, contact=0):
        """Give a contact the friction ``bound(x, y)``, along the order of its first side."""
        for pair in self.data["contacts"][contact]["pairs"]:
            rub(pair, self.data["points"], bound)

    def pin(self, vertex, direction):
        self.data["pins"].append({"vertex": vertex, "direction": list(direction)})


def rub(pair, points, bound):
    """Friction on one pair; the tangent is at right angles to the normal at each end, in the order of ``first``."""
    (x0, y0), (x1, y1) = (points[v] for v in pair["first"])
    tangents = []
    for nx, ny in pair["direction"]:
        sign = 1.0 if -ny * (x1 - x0) + nx * (y1 - y0) > 0.0 else -1.0
        tangents.append([-sign * ny, sign * nx])
    values = [bound(*points[v]) for v in pair["first"]]
    pair["friction"] = {"bound": values, "tangent": tangents, "length": math.hypot(x1 - x0, y1 - y0)}


def rotated(angle, move=(0.0, 0.0)):
    """Point and vector maps of a rotation."""
    c, s = math.cos(angle), math.sin(angle)
    return (
        lambda x, y: (c * x - s * y + move[0], s * x + c * y + move[1]),
        lambda x, y: (c * x - s * y, s * x + c * y),
    )


def two_blocks(n, traction=lambda y: 4.0 - 7.0 * y, gap=0.0, angle=0.0, load=1.0, **builder):
    """Two unit blocks side by side, the left one loaded at x = 0, the right one clamped at x = 2; then rotated."""
    b = Builder(**builder)
    point, vector = rotated(angle)
    back, _ = rotated(-angle)
    left, right = b.body("left"), b.body("right")
    one = b.block(left, n, n, lambda s, t: point(s, t))
    two = b.block(right, n, n, lambda s, t: point(1.0 + s, t))
    b.clamp(two["right"])
    b.roller(one["bottom"], vector(0.0, -1.0))
    b.load(one["left"], lambda x, y: vector(load * traction(back(x, y)[1]), 0.0))
    b.contact(one["right"], two["left"], vector(1.0, 0.0), lambda x, y: gap)
    return b.data


def arched_blocks(n, rise, softer=1.0, poisson=0.3):
    """A block on another of ``softer`` modulus, facets of an arch between them; a pin, and a load from above."""
    b = Builder()

    def arch(s):
        return 4.0 * rise * s * (1.0 - s)

    upper, lower = b.body("upper", 1.0, 0.3), b.body("lower", softer, poisson)
    below = b.block(lower, n, n, lambda s, t: (s, -1.0 + t * (1.0 + arch(s))))
    above = b.block(upper, n, n, lambda s, t: (s, arch(s) + t * (1.5 - arch(s))))
    b.clamp(below["bottom"])
    b.load(above["top"], lambda x, y: (0.0, -0.05 * (0.3 + 2.0 * x)))
    b.contact(below["top"], above["bottom"], (0.0, 1.0))
    pairs = b.data["contacts"][0]["pairs"]
    for pair in pairs:
        (x0, y0), (x1, y1) = (b.data["points"][v] for v in pair["first"])
        length = math.hypot(x1 - x0, y1 - y0)
        pair["normal"] = [-(y1 - y0) / length, (x1 - x0) / length]
    b.pin(above["top"][n // 2], (1.0, 0.0))
    return b.data
