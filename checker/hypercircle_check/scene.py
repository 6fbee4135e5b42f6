"""The scene as written: materials, loads, supports, contacts, in exact rational numbers (decimals of the file are read as doubles)."""

import tomllib
from dataclasses import dataclass
from fractions import Fraction as Q

from . import Refused

TABLES = {
    "": {"title", "model", "mesh", "geometry", "bodies", "boundaries", "supports", "tractions", "contacts", "quantities"},
    "model": {"kinematics", "thickness"},
    "bodies": {"young", "poisson", "body_force", "tag", "set"},
    "supports": {"on", "type", "displacement", "direction"},
    "tractions": {"on", "value", "gradient", "pressure"},
    "contacts": {"between", "on", "gap", "normals", "direction", "obstacle", "move"},
    "polygons": {"body", "points", "edges", "arcs"},
}


def _known(table, name, where):
    unknown = set(table) - TABLES[name]
    if unknown:
        raise Refused(f"this checker does not know the key `{sorted(unknown)[0]}` {where}: the scene has more to it than it can verify")


def vector(values):
    return [Q(x) for x in values]


@dataclass
class Affine:
    """value + gradient x, x in the coordinates of the scene file."""

    value: list
    gradient: list

    @staticmethod
    def of(value, gradient):
        return Affine(vector(value or [0, 0]), [vector(row) for row in gradient or [[0, 0], [0, 0]]])

    def at(self, x):
        return [v + g[0] * x[0] + g[1] * x[1] for v, g in zip(self.value, self.gradient)]


@dataclass
class Condition:
    """`clamped`: u = data(x). `roller`: u . direction = data, the outward normal where there is none. `load`: an Affine or a pressure."""

    kind: str
    data: object
    direction: object = None


class Scene:
    def __init__(self, text):
        try:
            raw = tomllib.loads(text.decode())
        except (UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
            raise Refused(f"the scene cannot be read: {error}") from None
        self.raw = raw
        try:
            self._read(raw)
        except (KeyError, TypeError, ValueError, IndexError, AttributeError) as error:
            raise Refused(f"the scene is malformed: {error!r}") from None

    def _read(self, raw):
        _known(raw, "", "at the top of the scene")
        model = raw["model"]
        _known(model, "model", "in [model]")
        self.kinematics, self.thickness = model["kinematics"], Q(model.get("thickness", 1))
        if self.kinematics not in ("plane-strain", "plane-stress"):
            raise Refused(f"this checker does not know the kinematics '{self.kinematics}'")
        self.bodies = {}
        for name, body in raw["bodies"].items():
            _known(body, "bodies", f"in [bodies.{name}]")
            self.bodies[name] = (Q(body["young"]), Q(body["poisson"]), vector(body.get("body_force", [0, 0])))
        self.conditions = {}
        for support in raw.get("supports", []):
            _known(support, "supports", "in [[supports]]")
            u, direction = support.get("displacement"), support.get("direction")
            if support["type"] == "clamped":
                affine = Affine.of(u.get("value"), u.get("gradient")) if isinstance(u, dict) else Affine.of(u, None)
                self._hold(support["on"], Condition("clamped", affine))
            elif support["type"] == "roller":
                self._hold(support["on"], Condition("roller", Q(u or 0), direction and vector(direction)))
            else:
                raise Refused(f"this checker does not know supports of type '{support['type']}'")
        for load in raw.get("tractions", []):
            _known(load, "tractions", "in [[tractions]]")
            pressed = "pressure" in load
            self._hold(load["on"], Condition("load", Q(load["pressure"]) if pressed else Affine.of(load["value"], load.get("gradient"))))
        self.contacts, self.sides = {}, {}
        for contact in raw.get("contacts", []):
            _known(contact, "contacts", "in [[contacts]]")
            first, second = contact["between"] if "between" in contact else (contact["on"], "rigid")
            name = f"{first}|{second}"
            self.contacts[name] = contact
            for side, boundary in enumerate((first, second) if "between" in contact else (first,)):
                self._hold(boundary, Condition("contact", name))
                self.sides[boundary] = (name, side)
        self.polygons = raw.get("geometry", {}).get("polygons", []) if "geometry" in raw else None
        for polygon in self.polygons or []:
            _known(polygon, "polygons", "in [[geometry.polygons]]")

    def _hold(self, boundary, condition):
        if boundary in self.conditions:
            raise Refused(f"the boundary '{boundary}' has two conditions")
        self.conditions[boundary] = condition

    def compliance(self, body):
        """(s, d, t): a s:s = s (xx + yy)^2 + d (xx - yy)^2 + t xy^2."""
        young, nu, _ = self.bodies[body]
        if self.kinematics == "plane-strain":
            return (1 + nu) * (1 - 2 * nu) / (2 * young), (1 + nu) / (2 * young), 2 * (1 + nu) / young
        return (1 - nu) / (2 * young), (1 + nu) / (2 * young), 2 * (1 + nu) / young

    def stiffness(self, body):
        """(s, d, t): c e:e likewise, with the tensor component e_xy."""
        s, d, t = self.compliance(body)
        return 1 / (4 * s), 1 / (4 * d), 4 / t


def premise_of_contact(contact):
    """What of a contact is taken from the proof and not derived from the scene: a sentence, or None."""
    name = f"contact {'|'.join(contact['between']) if 'between' in contact else contact['on']}"
    if "obstacle" in contact:
        return f"{name}: distance and direction to its obstacle, at vertices, are those in the proof"
    if "direction" in contact:
        return f"{name}: the matching of its sides along its direction, and the distance, are those in the proof"
    return None
