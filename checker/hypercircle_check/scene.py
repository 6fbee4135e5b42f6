"""The scene as written: materials, loads, supports, contacts, in exact rational numbers (decimals of the file are read as doubles)."""

import copy
import tomllib
from dataclasses import dataclass

from flint import fmpq

from . import Refused, material
from .exact import rational, zero

KNOWN = {  # every key that has a meaning here, and the values of those that name a kind
    "": "title model mesh geometry bodies boundaries supports tractions contacts bonds quantities",
    "model": "kinematics thickness",
    "bodies": "young poisson orthotropic stiffness compliance angle expansion temperature initial_stress body_force rotation tag set",
    "orthotropic": "young poisson shear angle",
    "temperature": "value gradient",
    "body_force": "value gradient",
    "rotation": "density omega about",
    "supports": "on type displacement direction stiffness",
    "tractions": "on value gradient pressure",
    "contacts": "between on gap normals direction obstacle move stiffness friction",
    "friction": "bound",
    "bonds": "between direction stiffness",
    "polygons": "body points edges arcs",
}
KINDS = {"kinematics": ("plane-strain", "plane-stress"), "type": ("clamped", "roller", "spring")}


def known(place, table):
    for key, value in table.items():
        if key not in KNOWN[place].split():
            raise Refused(f"this checker does not know the key `{key}` of the scene ({place or 'top'}): there is more to it than it can verify")
        if value not in KINDS.get(key, (value,)):
            raise Refused(f"this checker does not know `{key} = {value!r}`")
    return table


def vector(values):
    if not isinstance(values, (list, tuple)):
        raise Refused(f"this checker knows constant vectors, not {values!r}")
    return [rational(x) for x in values]


def stiffnesses(given):
    """Along the normal and along the edge."""
    both = vector(given) if isinstance(given, list) else [rational(given), rational(0)]
    if len(both) != 2 or min(both) < 0 or not any(both):
        raise Refused(f"a stiffness is {given!r}")
    return both


def rows(given):
    """A function of the arc length along a contact, piecewise linear and nowhere negative: rows [s, value], or one number."""
    if isinstance(given, list) and not all(isinstance(row, list) for row in given):
        raise Refused(f"the bound of friction {given!r} is a range: this checker does not know those")
    table = [[rational(x) for x in row] for row in (given if isinstance(given, list) else [[0, given]])]
    if any(s >= t for (s, _), (t, _) in zip(table, table[1:])) or min(value for _, value in table) < 0:
        raise Refused(f"a bound of friction is {given!r}")
    return table


def at(table, s):
    """The value of such a function, constant beyond its first and last row."""
    for (a, x), (b, y) in zip(table, table[1:]):
        if s < b:
            return x + (y - x) * max(s - a, 0) / (b - a)
    return table[-1][1]


def slides(contact):
    """True if an obstacle moves along itself, and would drag what rubs on it."""
    move, line = vector(contact.get("move", [0, 0])), contact.get("obstacle", {}).get("line")
    if line is None:
        return any(move)
    (x, y), (u, v) = map(vector, line)
    along, across = move[0] * (u - x) + move[1] * (v - y), move[1] * (u - x) - move[0] * (v - y)
    return abs(along) > fmpq(1, 10**11) * abs(across)


@dataclass
class Affine:
    """value + gradient x, x in the coordinates of the scene file."""

    value: list
    gradient: list

    @staticmethod
    def of(value=None, gradient=None):
        return Affine(vector(value or [0, 0]), [vector(row) for row in gradient or [[0, 0], [0, 0]]])

    @staticmethod
    def read(place, given):
        """A constant, or a table of value and gradient."""
        return Affine.of(**known(place, given)) if isinstance(given, dict) else Affine.of(given)

    def at(self, x):
        return [v + g[0] * x[0] + g[1] * x[1] for v, g in zip(self.value, self.gradient)]

    def varies(self):
        return not zero(*(x for row in self.gradient for x in row))

    def __bool__(self):
        return self.varies() or not zero(*self.value)

    def plus(self, value):
        return Affine([x + y for x, y in zip(self.value, value)], self.gradient)


@dataclass
class Condition:
    """`clamped`: u = data(x). `roller`: u . direction = data, the outward normal where there is none. `load`: a pressure and an Affine.
    `spring`: data is the stiffness along the normal and along the edge. `contact`, `bond`: data is a name."""

    kind: str
    data: object
    direction: object = None


class Scene:
    def __init__(self, text):
        try:
            self.raw = known("", tomllib.loads(text.decode()))
            self._read(**self.raw)
        except (UnicodeDecodeError, KeyError, TypeError, ValueError, IndexError, AttributeError) as error:
            raise Refused(f"the scene cannot be read: {error!r}") from None

    def _read(self, model, bodies, supports=(), tractions=(), contacts=(), bonds=(), geometry=None, **_):
        self.kinematics, self.thickness = known("model", model)["kinematics"], rational(model.get("thickness", 1))
        self.laws, self.forces, self.strains = {}, {}, {}
        for name, body in bodies.items():
            self._body(name, known("bodies", body))
        self.conditions, self.contacts, self.bonds, self.sides = {}, {}, {}, {}
        self.polygons = [known("polygons", polygon) for polygon in (geometry or {}).get("polygons", [])]
        for support in supports:
            u, direction = known("supports", support).get("displacement"), support.get("direction")
            by_kind = {
                "clamped": lambda: Condition("clamped", Affine.read("body_force", u)),
                "spring": lambda: Condition("spring", stiffnesses(support["stiffness"])),
                "roller": lambda: Condition("roller", rational(u or 0), direction and vector(direction)),
            }
            self._hold(support["on"], by_kind[support["type"]]())
        for load in tractions:
            pressure, given = known("tractions", load).get("pressure"), (load.get("value"), load.get("gradient"))
            traction = Affine.of(*given) if pressure is None else Affine.of()
            self._hold(load["on"], Condition("load", (rational(pressure or 0), traction)))
        for place, joints, own in (("contacts", contacts, self.contacts), ("bonds", bonds, self.bonds)):
            for joint in joints:
                sides = known(place, joint).get("between") or [joint["on"]]
                name = "|".join([*sides, "rigid"][:2])
                read = stiffnesses if place == "bonds" else rational
                own[name] = joint | ({"stiffness": read(joint["stiffness"])} if "stiffness" in joint else {})
                if "friction" in joint:
                    own[name] |= {"friction": rows(known("friction", joint["friction"])["bound"])}
                    if slides(joint):
                        raise Refused(f"the obstacle of contact {name} moves along itself, which this checker does not know with friction")
                for side, boundary in enumerate(sides):
                    self._hold(boundary, Condition(place[:-1], name))
                    self.sides[boundary] = (name, side)

    def _hold(self, boundary, condition):
        if boundary in self.conditions:
            raise Refused(f"the boundary '{boundary}' has two conditions")
        self.conditions[boundary] = condition

    def _body(self, name, body):
        known("orthotropic", body.get("orthotropic", {}))
        *self.laws[name], warm, cold = material.law(body, self.kinematics == "plane-strain")
        heat, force = body.get("temperature", 0), Affine.read("body_force", body.get("body_force"))
        heat = known("temperature", heat) if isinstance(heat, dict) else {"value": heat}
        t, slope = rational(heat.get("value", 0)), vector(heat.get("gradient", [0, 0]))
        self.strains[name] = Affine([w * t + c for w, c in zip(warm, cold)], [[w * g for g in slope] for w in warm])
        if "rotation" in body:
            turning, about = known("rotation", body["rotation"]), vector(body["rotation"]["about"])
            by = rational(turning["density"]) * rational(turning["omega"]) ** 2
            turned = [[g + by * (i == j) for j, g in enumerate(row)] for i, row in enumerate(force.gradient)]
            force = Affine([v - by * c for v, c in zip(force.value, about)], turned)
        self.forces[name] = force

    def pulled(self, quantity, by):
        """This scene with `by` times a constant load along the direction of a mean displacement; None where it is no such quantity."""
        on, direction = quantity.get("displacement"), quantity.get("direction")
        if on is None or direction is None or "point" in quantity or self.contacts:
            return None
        held = self.conditions.get(on, Condition("load", (rational(0), Affine.of())))
        if (on in self.forces and on in self.conditions) or held.kind != "load":
            return None
        out, add = copy.copy(self), [by * x for x in vector(direction)]
        if on in self.forces:
            out.forces = self.forces | {on: self.forces[on].plus(add)}
        else:
            out.conditions = self.conditions | {on: Condition("load", (held.data[0], held.data[1].plus(add)))}
        return out
