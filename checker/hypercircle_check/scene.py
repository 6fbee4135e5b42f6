"""The scene as written: materials, loads, supports, contacts, in exact rational numbers (decimals of the file are read as doubles)."""

import copy
import tomllib
from dataclasses import dataclass
from fractions import Fraction as Q

from . import Refused, material

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
    "contacts": "between on gap normals direction obstacle move stiffness",
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


def stiffnesses(given):
    """Along the normal and along the edge."""
    both = vector(given) if isinstance(given, list) else [Q(given), Q(0)]
    if len(both) != 2 or min(both) < 0 or not any(both):
        raise Refused(f"a stiffness is {given!r}")
    return both


def vector(values):
    if not isinstance(values, (list, tuple)):
        raise Refused(f"this checker knows constant vectors, not {values!r}")
    return [Q(x) for x in values]


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


@dataclass
class Condition:
    """`clamped`: u = data(x). `roller`: u . direction = data, the outward normal where there is none. `load`: a pressure and an Affine.
    `spring`: data is the stiffness along the normal and along the edge, or their names where they are a layer's. `contact`, `bond`: a name."""

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
        self.kinematics, self.thickness = known("model", model)["kinematics"], Q(model.get("thickness", 1))
        self.bodies, self.forces, self.strains = {}, {}, {}
        for name, body in bodies.items():
            self._body(name, known("bodies", body))
        self.conditions, self.contacts, self.bonds, self.sides = {}, {}, {}, {}
        self.polygons = [known("polygons", polygon) for polygon in (geometry or {}).get("polygons", [])]
        for support in supports:
            u, direction = known("supports", support).get("displacement"), support.get("direction")
            if support["type"] == "clamped":
                self._hold(support["on"], Condition("clamped", Affine.read("body_force", u)))
            elif support["type"] == "spring":
                self._hold(support["on"], Condition("spring", stiffnesses(support["stiffness"])))
            else:
                self._hold(support["on"], Condition("roller", Q(u or 0), direction and vector(direction)))
        for load in tractions:
            pressed = "pressure" in known("tractions", load)
            self._hold(load["on"], Condition("load", (Q(load.get("pressure", 0)), Affine.of() if pressed else Affine.of(load["value"], load.get("gradient")))))
        for place, joints, own in (("contacts", contacts, self.contacts), ("bonds", bonds, self.bonds)):
            for joint in joints:
                sides = known(place, joint).get("between") or [joint["on"]]
                name = "|".join([*sides, "rigid"][:2])
                of = stiffnesses if place == "bonds" else Q
                own[name] = {key: of(value) if key == "stiffness" else value for key, value in joint.items()}
                for side, boundary in enumerate(sides):
                    self._hold(boundary, Condition(place[:-1], name))
                    self.sides[boundary] = (name, side)

    def pulled(self, quantity, by):
        """The same scene with `by` times a constant load along the direction of a mean displacement; None where it is no such quantity."""
        on, direction = quantity.get("displacement"), quantity.get("direction")
        if on is None or direction is None or "point" in quantity or self.contacts:
            return None
        held = self.conditions.get(on, Condition("load", (Q(0), Affine.of())))
        if (on in self.bodies) == (on in self.conditions) and on in self.bodies or held.kind != "load":
            return None
        out, add = copy.copy(self), [by * x for x in vector(direction)]
        more = lambda f: Affine([x + y for x, y in zip(f.value, add)], f.gradient)
        if on in self.bodies:
            out.forces = self.forces | {on: more(self.forces[on])}
        else:
            out.conditions = self.conditions | {on: Condition("load", (held.data[0], more(held.data[1])))}
        return out

    def _body(self, name, body):
        self.bodies[name] = material.law(body, self.kinematics == "plane-strain")
        *_, warm, cold = self.bodies[name]
        known("orthotropic", body.get("orthotropic", {}))
        heat, force = body.get("temperature", 0), Affine.read("body_force", body.get("body_force"))
        heat = known("temperature", heat) if isinstance(heat, dict) else {"value": heat}
        t, slope = Q(heat.get("value", 0)), vector(heat.get("gradient", [0, 0]))
        self.strains[name] = Affine([w * t + c for w, c in zip(warm, cold)], [[w * g for g in slope] for w in warm])
        if "rotation" in body:
            turning, about = known("rotation", body["rotation"]), vector(body["rotation"]["about"])
            by = Q(turning["density"]) * Q(turning["omega"]) ** 2
            force.value = [v - by * c for v, c in zip(force.value, about)]
            force.gradient = [[g + by * (i == j) for j, g in enumerate(row)] for i, row in enumerate(force.gradient)]
        self.forces[name] = force

    def _hold(self, boundary, condition):
        if boundary in self.conditions:
            raise Refused(f"the boundary '{boundary}' has two conditions")
        self.conditions[boundary] = condition
