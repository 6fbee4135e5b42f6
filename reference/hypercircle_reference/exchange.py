"""The problem that the caller hands in, ``problem.json``."""

from __future__ import annotations

import json
from dataclasses import dataclass
from math import comb
from pathlib import Path

import numpy as np

from hypercircle_process import BadExchange

from .records import array, column, get, index_column, indices, numbers, records, scalar

FORMAT = "hypercircle-exchange"
VERSION = 1


@dataclass(frozen=True)
class Body:
    """Homogeneous material, body force per volume (2,) at the origin and its gradient (2, 2).

    Isotropic by Young's modulus and Poisson's ratio, or any other by ``stiffness`` (3, 3), the stresses xx, yy, xy of unit strains
    ε_xx, ε_yy, 2 ε_xy; ``young`` is then the largest entry on its diagonal, which only tells stiff bodies from soft ones.
    ``initial_strain`` (3, 3) has a row (value, ∂x, ∂y) for each of ε_xx, ε_yy, ε_xy, in a body of revolution a fourth for ε_θθ: the strain
    without stress, affine in x.
    """

    name: str
    young: float
    poisson: float
    body_force: np.ndarray
    force_gradient: np.ndarray
    stiffness: np.ndarray | None = None
    initial_strain: np.ndarray | None = None


@dataclass(frozen=True)
class Contact:
    """Matched edges of one contact, as arrays over its pairs.

    ``edges`` (m, 2) and ``second`` (m, 2) hold −1 where the opposite side is a rigid obstacle. ``first`` (m, 2) are
    the end vertices on the first side, ``normal`` (m, 2) its outward unit normal n', ``direction`` (m, 2, 2) the direction
    of contact n̂ at the two ends, linear between, ``gap`` (m, 2) the gap g at the two ends. Where ``curved`` (m,), ``gap_below``
    (m, n, n + 2) has the coefficients of degree 2, 3, …, n + 1 of polynomials that lie nowhere above it, filled up with zeros,
        the last of them the gap itself. ``friction`` (m, 2) is the bound of the tangential traction at the two ends, zero where there is
    none, ``tangent`` (m, 2, 2) the direction of sliding there, and ``length`` (m,) what integrals of friction are over. Where the
    bound goes with the pressure ``coefficient`` is Coulomb's, else zero.
    """

    name: str
    edges: np.ndarray
    first: np.ndarray
    second: np.ndarray
    normal: np.ndarray
    direction: np.ndarray
    gap: np.ndarray
    curved: np.ndarray
    gap_below: np.ndarray
    friction: np.ndarray
    tangent: np.ndarray
    length: np.ndarray
    coefficient: float = 0.0

    @property
    def rubs(self) -> np.ndarray:
        """Where there is friction (m,)."""
        return np.any(self.friction > 0.0, axis=1)

    @property
    def turns(self) -> np.ndarray:
        """Where the direction of contact changes along the pair (m,)."""
        return np.any(self.direction[:, 0] != self.direction[:, 1], axis=1)

    def part(self, pairs: np.ndarray) -> "Contact":
        """The contact on some of its pairs."""
        arrays = (self.edges, self.first, self.second, self.normal, self.direction, self.gap)
        arrays += (self.curved, self.gap_below, self.friction, self.tangent, self.length)
        return Contact(self.name, *(array[pairs] for array in arrays), self.coefficient)

    def gap_coefficients(self, degree: int) -> np.ndarray:
        """Coefficients (m, degree + 1) of polynomials of that degree, 2 or more, that lie nowhere above the gap."""
        steps = np.arange(degree + 1)
        found = ((degree - steps) * self.gap[:, :1] + steps * self.gap[:, 1:]) / degree
        if self.curved.any():
            found[self.curved] = self.gap_below[self.curved, degree - 2, : degree + 1]
        return found

    def gap_at(self, part: np.ndarray) -> np.ndarray:
        """The gap (m, n) at the ``part`` (n,) of the way along each pair."""
        found = (1.0 - part) * self.gap[:, :1] + part * self.gap[:, 1:]
        if self.curved.any():
            degree = self.gap_below.shape[1] + 1
            weights = [comb(degree, j) * part**j * (1.0 - part) ** (degree - j) for j in range(degree + 1)]
            found[self.curved] = self.gap_below[self.curved, -1] @ np.array(weights)
        return found


KINEMATICS = ("plane-strain", "plane-stress", "axisymmetric")
"""Bodies and states that a plane figure may represent."""


@dataclass(frozen=True)
class Revolution:
    """A body of revolution: the first coordinate of its axis, and the rule for integrals over triangles, with points (n, 2) in the
    triangle (0, 0), (1, 0), (0, 1) and weights (n,) that sum to one half. The rule is the same from all corners."""

    axis: float
    points: np.ndarray
    weights: np.ndarray


@dataclass(frozen=True)
class Springs:
    """Springs on edges (m,), each against the edge ``opposite`` (m,) or, where that is −1, the ground; ``axes`` (m, 2, 2) are unit
    vectors, ``stiffness`` (m, 2) along them. Those of elastic contact have the Bernstein coefficients of their ``gaps``, and resist
    along the first axis alone what exceeds it."""

    edges: np.ndarray
    opposite: np.ndarray
    axes: np.ndarray
    stiffness: np.ndarray
    gaps: list[np.ndarray | None]

    def part(self, touching: bool) -> "Springs":
        """Those of elastic contact, or the others."""
        which = np.array([i for i, gap in enumerate(self.gaps) if (gap is not None) == touching], dtype=np.int64)
        arrays = (self.edges[which], self.opposite[which], self.axes[which], self.stiffness[which])
        return Springs(*arrays, [self.gaps[i] for i in which])


@dataclass(frozen=True)
class Problem:
    """The checked content of ``problem.json``; index arrays are int64, everything else float64.

    ``quadrilaterals`` (m, 4) are the vertices of those cells, and ``halves`` (m, 2) the triangles at the first and at the third of
    them.
    """

    kinematics: str
    thickness: float
    revolution: Revolution | None
    bodies: list[Body]
    points: np.ndarray
    triangles: np.ndarray
    body: np.ndarray
    edges: np.ndarray
    triangle_edges: np.ndarray
    quadrilaterals: np.ndarray
    halves: np.ndarray
    clamped_edges: np.ndarray
    clamped_values: np.ndarray
    roller_edges: np.ndarray
    roller_directions: np.ndarray
    roller_values: np.ndarray
    traction_edges: np.ndarray
    traction_values: np.ndarray
    contacts: list[Contact]
    springs: Springs
    touching: Springs
    pin_vertices: np.ndarray
    pin_directions: np.ndarray
    pin_degrees: np.ndarray


def read_problem(path: Path) -> Problem:
    """Read and check ``problem.json``; :class:`BadExchange` names the key that is wrong."""
    try:
        text = Path(path).read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise BadExchange(f"cannot read {path}: {error}") from error
    try:
        data = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise BadExchange(f"{path} is not JSON: {error}") from error
    if not isinstance(data, dict):
        raise BadExchange(f"{path} must hold one JSON object")
    if data.get("format") != FORMAT or data.get("version") != VERSION:
        found = (data.get("format"), data.get("version"))
        raise BadExchange(f"{path} is not {FORMAT} version {VERSION}: found {found}")
    return parse_problem(data)


def parse_problem(data: dict) -> Problem:
    """Check the contents of ``problem.json``; :class:`BadExchange` names the key that is wrong."""
    kinematics = get(data, "kinematics")
    if kinematics not in KINEMATICS:
        raise BadExchange(f"kinematics is {kinematics!r}, expected one of {', '.join(KINEMATICS)}")
    revolution = _revolution(get(data, "revolution")) if kinematics == "axisymmetric" else None
    thickness = scalar(data, "thickness", "thickness")
    if not thickness > 0.0:
        raise BadExchange(f"thickness is {thickness}, expected a positive number")
    bodies = [_body(entry, f"bodies[{i}]", 3 if revolution is None else 4) for i, entry in enumerate(records(data, "bodies"))]
    points = numbers(data, "points", (-1, 2))
    triangles = indices(data, "triangles", (-1, 3), len(points))
    edges = indices(data, "edges", (-1, 2), len(points))
    triangle_edges = indices(data, "triangle_edges", (len(triangles), 3), len(edges))
    body = indices(data, "body", (len(triangles),), len(bodies))
    _check_mesh(points, triangles, edges, triangle_edges)

    cells = records(data, "quadrilaterals") if "quadrilaterals" in data else []
    quadrilaterals = index_column(cells, "quadrilaterals", "corners", (4,), len(points))
    halves = index_column(cells, "quadrilaterals", "triangles", (2,), len(triangles))
    _check_halves(quadrilaterals, halves, triangles)

    clamped = records(data, "clamped")
    roller = records(data, "roller")
    tractions = records(data, "tractions")
    pins = records(data, "pins")
    springs = _springs(records(data, "springs") if "springs" in data else [], len(edges))
    along = column(roller, "roller", "normal", (2,))
    _check_unit(along, "roller", "normal")
    directions = column(pins, "pins", "direction", (2,))
    _check_unit(directions, "pins", "direction")
    return Problem(
        kinematics=kinematics,
        thickness=thickness,
        revolution=revolution,
        bodies=bodies,
        points=points,
        triangles=triangles,
        body=body,
        edges=edges,
        triangle_edges=triangle_edges,
        quadrilaterals=quadrilaterals,
        halves=halves,
        clamped_edges=index_column(clamped, "clamped", "edge", (), len(edges)),
        clamped_values=column([_at_both_ends(entry) for entry in clamped], "clamped", "displacement", (2, 2)),
        roller_edges=index_column(roller, "roller", "edge", (), len(edges)),
        roller_directions=along,
        roller_values=column([{"displacement": 0.0, **entry} for entry in roller], "roller", "displacement", ()),
        traction_edges=index_column(tractions, "tractions", "edge", (), len(edges)),
        traction_values=column(tractions, "tractions", "values", (2, 2)),
        contacts=[
            _contact(entry, f"contacts[{i}]", edges, len(points)) for i, entry in enumerate(records(data, "contacts"))
        ],
        springs=springs.part(touching=False),
        touching=springs.part(touching=True),
        pin_vertices=index_column(pins, "pins", "vertex", (), len(points)),
        pin_directions=directions,
        pin_degrees=column([{"degree": 0, **entry} for entry in pins], "pins", "degree", ()),
    )


def _springs(entries: list[dict], edges: int) -> Springs:
    alone = [{**entry, "opposite": -1} if entry.get("opposite") is None else entry for entry in entries]
    axes = column(entries, "springs", "axes", (2, 2))
    for axis in range(2):
        _check_unit(axes[:, axis], "springs", "axes")
    stiffness = column(entries, "springs", "stiffness", (2,))
    if np.any(stiffness < 0.0):
        raise BadExchange(f"springs[{np.argmin(stiffness.min(axis=1))}].stiffness is negative")
    gap = lambda i, entry: None if entry.get("gap") is None else array(entry, "gap", f"springs[{i}]", (-1,))
    gaps = [gap(i, entry) for i, entry in enumerate(entries)]
    for i, found in enumerate(gaps):
        if found is not None and len(found) == 0:
            raise BadExchange(f"springs[{i}].gap has no coefficient")
    return Springs(
        edges=index_column(entries, "springs", "edge", (), edges),
        opposite=index_column(alone, "springs", "opposite", (), edges, lowest=-1),
        axes=axes,
        stiffness=stiffness,
        gaps=gaps,
    )


def _revolution(entry) -> Revolution:
    if not isinstance(entry, dict):
        raise BadExchange("revolution must be one JSON object")
    points = array(entry, "points", "revolution", (-1, 2))
    return Revolution(
        axis=scalar(entry, "axis", "revolution.axis"),
        points=points,
        weights=array(entry, "weights", "revolution", (len(points),)),
    )


def _body(entry: dict, where: str, stresses: int) -> Body:
    name, force, slope = str(get(entry, "name", where)), get(entry, "body_force", where), np.zeros((2, 2))
    if isinstance(force, dict):
        inside = f"{where}.body_force"
        force, slope = array(force, "value", inside, (2,)), array(force, "gradient", inside, (2, 2))
    else:
        force = array(entry, "body_force", where, (2,))
    initial = array(entry, "initial_strain", where, (stresses, 3)) if "initial_strain" in entry else None
    if "stiffness" in entry:
        stiffness = array(entry, "stiffness", where, (stresses, stresses))
        if not (np.array_equal(stiffness, stiffness.T) and np.linalg.eigvalsh(stiffness)[0] > 0.0):
            raise BadExchange(f"{where}.stiffness is not symmetric and positive definite")
        return Body(name, float(stiffness.diagonal().max()), 0.0, force, slope, stiffness, initial)
    young = scalar(entry, "young", f"{where}.young")
    poisson = scalar(entry, "poisson", f"{where}.poisson")
    if not young > 0.0:
        raise BadExchange(f"{where}.young is {young}, expected a positive number")
    if not -1.0 < poisson < 0.5:
        raise BadExchange(f"{where}.poisson is {poisson}, expected a number in (-1, 1/2)")
    return Body(name, young, poisson, force, slope, None, initial)


def _contact(entry: dict, where: str, edges: np.ndarray, vertices: int) -> Contact:
    pairs = records(entry, "pairs", where)
    inside = f"{where}.pairs"
    rigid = np.array([pair.get("second") is None for pair in pairs], dtype=bool)
    filled = [_without_second(pair, inside) if alone else pair for pair, alone in zip(pairs, rigid)]
    none = {"bound": [0.0, 0.0], "tangent": [[0.0, 0.0], [0.0, 0.0]], "length": 0.0}
    friction, rough = [pair.get("friction") or none for pair in pairs], f"{inside}[..].friction"
    contact = Contact(
        name=str(get(entry, "name", where)),
        edges=index_column(filled, inside, "edges", (2,), len(edges), lowest=-1),
        first=index_column(filled, inside, "first", (2,), vertices),
        second=index_column(filled, inside, "second", (2,), vertices, lowest=-1),
        normal=column(filled, inside, "normal", (2,)),
        direction=column(filled, inside, "direction", (2, 2)),
        gap=column(filled, inside, "gap", (2,)),
        curved=np.array(["gap_below" in pair for pair in pairs], dtype=bool),
        gap_below=_gap_below(pairs, inside),
        friction=column(friction, rough, "bound", (2,)),
        tangent=column(friction, rough, "tangent", (2, 2)),
        length=column(friction, rough, "length", ()),
        coefficient=scalar(entry, "coefficient", f"{where}.coefficient") if "coefficient" in entry else 0.0,
    )
    if contact.coefficient < 0.0:
        raise BadExchange(f"{where}.coefficient is negative")
    if contact.coefficient > 0.0 and np.any(contact.length <= 0.0):
        raise BadExchange(f"{inside}[{np.argmin(contact.length)}] has no friction, and its contact has a coefficient")
    if np.any(contact.friction < 0.0):
        raise BadExchange(f"{inside}[{np.argmin(contact.friction.min(axis=1))}].friction.bound is negative")
    _check_unit(contact.normal, inside, "normal")
    if np.any(np.abs(np.linalg.norm(contact.direction, axis=2) - 1.0) > 0.1):
        raise BadExchange(f"{inside}: direction is not close to a unit vector")
    for side, ends in ((0, contact.first), (1, contact.second)):
        rows = np.flatnonzero(~rigid) if side else np.arange(len(pairs))
        present = contact.edges[rows, side]
        wrong = (present < 0) | np.any(np.sort(edges[present], axis=1) != np.sort(ends[rows], axis=1), axis=1)
        if wrong.any():
            pair = rows[np.argmax(wrong)]
            raise BadExchange(f"{inside}[{pair}]: edges[{side}] does not join the vertices given for that side")
    return contact


def _gap_below(pairs: list[dict], where: str) -> np.ndarray:
    curved = [pair["gap_below"] for pair in pairs if "gap_below" in pair]
    count = max((len(degrees) for degrees in curved if isinstance(degrees, list)), default=0)
    found = np.zeros((len(pairs), count, count + 2))
    for i, pair in enumerate(pairs):
        if "gap_below" not in pair:
            continue
        degrees = pair["gap_below"]
        if not isinstance(degrees, list) or len(degrees) != count:
            raise BadExchange(f"{where}[{i}].gap_below is not a list of {count} degrees")
        for k, coefficients in enumerate(degrees):
            found[i, k, : k + 3] = array({"gap_below": coefficients}, "gap_below", f"{where}[{i}]", (k + 3,))
    return found


def _without_second(pair: dict, where: str) -> dict:
    edges = get(pair, "edges", where)
    if not isinstance(edges, list) or len(edges) != 2 or edges[1] is not None:
        raise BadExchange(f"{where}[..].edges must be [edge, null] where second is null")
    return {**pair, "second": [-1, -1], "edges": [edges[0], -1]}


def _check_mesh(points, triangles, edges, triangle_edges) -> None:
    if len(triangles) == 0:
        raise BadExchange("triangles is empty")
    a, b, c = (points[triangles[:, i]] for i in range(3))
    doubled_area = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]
    if not np.all(doubled_area > 0.0):
        raise BadExchange(f"triangles[{np.argmin(doubled_area)}] is clockwise or has no area")
    for i in range(3):
        expected = np.sort(triangles[:, [(i + 1) % 3, (i + 2) % 3]], axis=1)
        wrong = np.any(np.sort(edges[triangle_edges[:, i]], axis=1) != expected, axis=1)
        if wrong.any():
            raise BadExchange(f"triangle_edges[{np.argmax(wrong)}][{i}] is not the edge opposite vertex {i}")


def _check_halves(quadrilaterals, halves, triangles) -> None:
    for half, corners in enumerate(((0, 1, 3), (2, 3, 1))):
        expected = np.sort(quadrilaterals[:, corners], axis=1)
        wrong = np.any(np.sort(triangles[halves[:, half]], axis=1) != expected, axis=1)
        if wrong.any():
            raise BadExchange(f"quadrilaterals[{np.argmax(wrong)}].triangles[{half}] is not the half at corner {2 * half}")


def _check_unit(vectors: np.ndarray, where: str, key: str) -> None:
    off = np.abs(np.linalg.norm(vectors, axis=1) - 1.0) > 1e-9
    if off.any():
        raise BadExchange(f"{where}[{np.argmax(off)}].{key} is not a unit vector")


def _at_both_ends(clamped: dict) -> dict:
    """A clamped edge with its displacement at both ends, where the file has one vector for the whole edge."""
    value = clamped.get("displacement")
    constant = isinstance(value, list) and not any(isinstance(entry, list) for entry in value)
    return {**clamped, "displacement": [value, value]} if constant else clamped
