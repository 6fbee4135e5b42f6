"""The scene as written: materials, loads, supports, contacts, in exact rational numbers (decimals of the file are read as doubles)."""

import tomllib
from dataclasses import dataclass
from fractions import Fraction as Q

from . import Refused

KNOWN = {  # every key that has a meaning here, and the values of those that name a kind
    "": "title model mesh geometry bodies boundaries supports tractions contacts quantities",
    "model": "kinematics thickness",
    "bodies": "young poisson body_force tag set",
    "supports": "on type displacement direction",
    "tractions": "on value gradient pressure",
    "contacts": "between on gap normals direction obstacle move",
    "polygons": "body points edges arcs",
}
KINDS = {"kinematics": ("plane-strain", "plane-stress"), "type": ("clamped", "roller")}


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
            self.raw = known("", tomllib.loads(text.decode()))
            self._read(**self.raw)
        except (UnicodeDecodeError, KeyError, TypeError, ValueError, IndexError, AttributeError) as error:
            raise Refused(f"the scene cannot be read: {error!r}") from None

    def _read(self, model, bodies, supports=(), tractions=(), contacts=(), geometry=None, **_):
        self.kinematics, self.thickness = known("model", model)["kinematics"], Q(model.get("thickness", 1))
        self.bodies = {name: (Q(b["young"]), Q(b["poisson"]), vector(b.get("body_force", [0, 0]))) for name, b in bodies.items() if known("bodies", b)}
        self.conditions, self.contacts, self.sides = {}, {}, {}
        self.polygons = [known("polygons", polygon) for polygon in (geometry or {}).get("polygons", [])]
        for support in supports:
            u, direction = known("supports", support).get("displacement"), support.get("direction")
            if support["type"] == "clamped":
                self._hold(support["on"], Condition("clamped", Affine.of(**{"value": None, "gradient": None, **u} if isinstance(u, dict) else {"value": u, "gradient": None})))
            else:
                self._hold(support["on"], Condition("roller", Q(u or 0), direction and vector(direction)))
        for load in tractions:
            pressed = "pressure" in known("tractions", load)
            self._hold(load["on"], Condition("load", Q(load["pressure"]) if pressed else Affine.of(load["value"], load.get("gradient"))))
        for contact in contacts:
            sides = known("contacts", contact).get("between") or [contact["on"]]
            name = "|".join([*sides, "rigid"][:2])
            self.contacts[name] = contact
            for side, boundary in enumerate(sides):
                self._hold(boundary, Condition("contact", name))
                self.sides[boundary] = (name, side)

    def _hold(self, boundary, condition):
        if boundary in self.conditions:
            raise Refused(f"the boundary '{boundary}' has two conditions")
        self.conditions[boundary] = condition

    def compliance(self, body):
        """(s, d, t): a s:s = s (xx + yy)^2 + d (xx - yy)^2 + t xy^2."""
        young, nu, _ = self.bodies[body]
        first = (1 + nu) * (1 - 2 * nu) if self.kinematics == "plane-strain" else 1 - nu
        return first / (2 * young), (1 + nu) / (2 * young), 2 * (1 + nu) / young

    def stiffness(self, body):
        """(s, d, t): c e:e likewise, with the tensor component e_xy."""
        s, d, t = self.compliance(body)
        return 1 / (4 * s), 1 / (4 * d), 4 / t
