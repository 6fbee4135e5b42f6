"""Guaranteed two-sided energy bounds for contact, and what is wrong with an element or a field."""

from collections.abc import Callable, Sequence
from os import PathLike
from pathlib import Path
from typing import Any, Literal, Protocol, TypedDict, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

__version__: str

_PlaneState = Literal["plane-strain", "plane-stress"]
_Kinematics = Literal["plane-strain", "plane-stress", "axisymmetric"]
_Method = Literal["condensed", "active-set", "clarabel", "uzawa"]

class InputError(ValueError):
    remedy: str

class InfeasibleError(RuntimeError):
    remedy: str

class SolveError(RuntimeError):
    remedy: str

# The tables of a scene, for completion; `hypercircle schema scene` says what each key means.
_Range = float | Sequence[float]
_Point = Sequence[float]

class _Affine(TypedDict, total=False):
    value: _Point
    gradient: Sequence[_Point]

class _Model(TypedDict, total=False):
    kinematics: _Kinematics
    thickness: float

class _MeshPart(TypedDict, total=False):
    file: str | PathLike[str]
    prefix: str
    scale: float
    translate: _Point

class _Mesh(TypedDict, total=False):
    file: str | PathLike[str]
    parts: Sequence[_MeshPart]

class _Arc(TypedDict):
    edge: int
    through: _Point

class _Polygon(TypedDict, total=False):
    body: str
    points: ArrayLike
    edges: Sequence[str]
    arcs: Sequence[_Arc]

class _Geometry(TypedDict, total=False):
    size: float
    polygons: Sequence[_Polygon]

class _Boundary(TypedDict, total=False):
    name: str
    body: str
    line: Sequence[_Point]
    box: Sequence[_Point]
    circle: dict[str, Any]
    normal: _Point
    angle: float
    set: str
    tag: int

class _Orthotropic(TypedDict, total=False):
    young: Sequence[float]
    poisson: Sequence[float]
    shear: float
    angle: float

class _Rotation(TypedDict, total=False):
    density: float
    omega: float
    about: _Point

class _Body(TypedDict, total=False):
    young: _Range
    poisson: float
    orthotropic: _Orthotropic
    stiffness: ArrayLike
    compliance: ArrayLike
    angle: float
    expansion: float | Sequence[float]
    temperature: float | dict[str, Any]
    initial_stress: Sequence[float]
    body_force: _Point | _Affine
    rotation: _Rotation
    set: str
    tag: int

class _Support(TypedDict, total=False):
    on: str
    type: Literal["clamped", "roller", "spring"]
    displacement: float | _Point | _Affine
    direction: _Point
    stiffness: float | Sequence[float]

class _Traction(TypedDict, total=False):
    on: str
    value: _Point
    gradient: Sequence[_Point]
    pressure: float
    terms: Sequence[dict[str, Any]]

class _Contact(TypedDict, total=False):
    between: Sequence[str]
    on: str
    gap: float | Sequence[Any] | dict[str, float]
    normals: Literal["smooth", "facets"]
    direction: _Point
    obstacle: dict[str, Any]
    move: _Point
    stiffness: _Range
    friction: dict[str, Any]

class _Bond(TypedDict, total=False):
    between: Sequence[str]
    direction: _Point
    stiffness: Sequence[float]

class _Quantity(TypedDict, total=False):
    name: str
    displacement: str
    force: str
    moment: str
    stress: str
    stress_intensity: Literal["KI", "KII"]
    direction: _Point
    component: str
    window: Sequence[float]
    about: _Point
    box: Sequence[_Point]
    polygon: Sequence[_Point]
    point: _Point
    tip: _Point
    smoothness: int

class _Scene(TypedDict, total=False):
    title: str
    model: _Model
    mesh: _Mesh
    geometry: _Geometry
    boundaries: Sequence[_Boundary]
    bodies: dict[str, _Body]
    supports: Sequence[_Support]
    tractions: Sequence[_Traction]
    contacts: Sequence[_Contact]
    bonds: Sequence[_Bond]
    quantities: Sequence[_Quantity]

@final
class Scene:
    def __new__(cls, path: str | PathLike[str]) -> Scene: ...
    @classmethod
    def from_text(cls, text: str, name: str = "scene", folder: str | PathLike[str] | None = None) -> Scene: ...
    @classmethod
    def from_dict(cls, data: _Scene, name: str = "scene", folder: str | PathLike[str] | None = None) -> Scene: ...
    @property
    def name(self) -> str: ...
    @property
    def title(self) -> str: ...
    @property
    def path(self) -> Path: ...
    @property
    def kinematics(self) -> _Kinematics: ...
    @property
    def thickness(self) -> float: ...
    @property
    def bodies(self) -> list[dict[str, Any]]: ...
    @property
    def contacts(self) -> list[str]: ...
    @property
    def quantities(self) -> list[str]: ...
    def problem(self, refine: int = 0) -> dict[str, Any]: ...
    def solve(
        self,
        *,
        method: _Method = "condensed",
        degree: int | None = None,
        degrees: Sequence[int] | None = None,
        refine: int = 0,
        tolerance: float | None = None,
        tolerance_of: dict[str, float] | None = None,
        adapt: Literal["h", "hp"] | None = None,
        max_triangles: int | None = None,
        max_seconds: float | None = None,
        max_memory: str | None = None,
        threads: int = 1,
        element: _Stresses | None = None,
        out: str | PathLike[str] | None = None,
    ) -> Solution: ...
    def certify(
        self,
        points: ArrayLike | None = None,
        triangles: ArrayLike | None = None,
        displacement: ArrayLike | None = None,
        *,
        file: str | PathLike[str] | None = None,
        field: str | None = None,
        name: str = "displacement",
        solution: bool = False,
        values: dict[str, float] | None = None,
        allow: dict[str, float] | None = None,
        tolerance: float | None = None,
        method: _Method = "condensed",
        degree: int | None = None,
        max_triangles: int | None = None,
        max_seconds: float | None = None,
        max_memory: str | None = None,
        threads: int = 1,
        out: str | PathLike[str] | None = None,
    ) -> Certificate: ...
    def verify(
        self,
        *,
        primal_degree: Sequence[int] = ...,
        allow: dict[str, float] | None = None,
        method: _Method = "condensed",
        degree: int | None = None,
        refine: int = 0,
        tolerance: float | None = None,
        tolerance_of: dict[str, float] | None = None,
        max_triangles: int | None = None,
        max_seconds: float | None = None,
        max_memory: str | None = None,
        threads: int = 1,
        out: str | PathLike[str] | None = None,
    ) -> Certificate: ...
    def chart(
        self,
        *,
        out: str | PathLike[str],
        methods: Sequence[str] = ...,
        primal_degree: Sequence[int] = ...,
        refine: int = 3,
        repeats: int = 3,
        budget: float | None = None,
        resume: bool = False,
        max_memory: str | None = None,
        threads: int = 1,
    ) -> dict[str, Any]: ...
    def diagnose(
        self, points: ArrayLike, triangles: ArrayLike, displacement: ArrayLike
    ) -> dict[str, Any] | None: ...

@final
class Solution:
    @property
    def lower(self) -> float: ...
    @property
    def upper(self) -> float: ...
    @property
    def relative_error_bound(self) -> float: ...
    @property
    def status(self) -> Literal["agree", "disagree"]: ...
    @property
    def verdict(self) -> str: ...
    @property
    def report(self) -> dict[str, Any]: ...
    @property
    def quantities(self) -> dict[str, Quantity]: ...
    @property
    def contacts(self) -> dict[str, Contact]: ...
    @property
    def points(self) -> NDArray[np.float64]: ...
    @property
    def triangles(self) -> NDArray[np.intp]: ...
    @property
    def body(self) -> NDArray[np.intp]: ...
    @property
    def stress(self) -> NDArray[np.float64]: ...
    @property
    def stress_start(self) -> NDArray[np.int64]: ...
    @property
    def stress_points(self) -> NDArray[np.float64]: ...
    @property
    def mean_stress(self) -> NDArray[np.float64]: ...
    @property
    def degrees(self) -> list[int]: ...
    @property
    def displacement(self) -> NDArray[np.float64] | None: ...
    @property
    def energy(self) -> float: ...
    @property
    def complementary(self) -> float: ...
    @property
    def contact_traction(self) -> list[list[list[float]]]: ...
    @property
    def closed(self) -> NDArray[np.bool_]: ...
    @property
    def moments(self) -> list[list[list[float]]]: ...
    @property
    def equilibrium_residual(self) -> float: ...
    @property
    def unknowns(self) -> int: ...
    @property
    def iterations(self) -> int: ...
    @property
    def maps(self) -> dict[str, NDArray[np.float64]]: ...
    def table(self, name: str) -> dict[str, list[Any]]: ...
    def to_pyvista(self) -> Any: ...
    def plot(
        self,
        value: str | ArrayLike | None = None,
        *,
        ax: Any = None,
        deformed: float = 0.0,
        colorbar: bool = True,
        **options: Any,
    ) -> Any: ...
    def _repr_html_(self) -> str: ...
    def certify(
        self,
        points: ArrayLike | None = None,
        triangles: ArrayLike | None = None,
        displacement: ArrayLike | None = None,
        *,
        file: str | PathLike[str] | None = None,
        field: str | None = None,
        name: str = "displacement",
        solution: bool = False,
        values: dict[str, float] | None = None,
        allow: dict[str, float] | None = None,
        tolerance: float | None = None,
        out: str | PathLike[str] | None = None,
    ) -> Certificate: ...

@final
class Quantity:
    @property
    def name(self) -> str: ...
    @property
    def kind(self) -> Literal["displacement", "force", "moment", "stress", "stress_intensity"]: ...
    @property
    def value(self) -> float | None: ...
    @property
    def lower(self) -> float: ...
    @property
    def upper(self) -> float: ...
    @property
    def first_order(self) -> tuple[float, float]: ...
    @property
    def exact_by_statics(self) -> bool: ...
    @property
    def reason(self) -> str | None: ...
    def __contains__(self, value: float, /) -> bool: ...

@final
class Contact:
    @property
    def name(self) -> str: ...
    @property
    def arc_length(self) -> NDArray[np.float64]: ...
    @property
    def pressure(self) -> NDArray[np.float64]: ...
    @property
    def force(self) -> tuple[float, float]: ...
    @property
    def moment(self) -> float: ...
    @property
    def pressure_max(self) -> float: ...
    @property
    def pressure_max_at(self) -> tuple[float, float]: ...
    @property
    def open_fraction(self) -> float: ...
    @property
    def contact_ends(self) -> list[float]: ...
    @property
    def length(self) -> float: ...

@final
class Certificate:
    @property
    def passed(self) -> bool: ...
    @property
    def status(self) -> Literal["agree", "disagree", "undecided"]: ...
    @property
    def verdict(self) -> str: ...
    @property
    def lower(self) -> float: ...
    @property
    def upper(self) -> float: ...
    @property
    def relative_error_bound(self) -> float | None: ...
    @property
    def checks(self) -> list[dict[str, Any]]: ...
    @property
    def causes(self) -> list[dict[str, Any]]: ...
    @property
    def diagnosis(self) -> dict[str, Any] | None: ...
    @property
    def residual(self) -> NDArray[np.float64] | None: ...
    @property
    def report(self) -> dict[str, Any]: ...
    def table(self, name: str) -> dict[str, list[Any]]: ...
    def _repr_html_(self) -> str: ...

_Formula = Callable[[NDArray[np.float64], float, float], ArrayLike]

class _Stresses(Protocol):
    degree: int
    def stresses(self, corners: NDArray[np.float64], /) -> ArrayLike: ...

class _HasFormula(Protocol):
    def stiffness(self, nodes: NDArray[np.float64], young: float, poisson: float, /) -> ArrayLike: ...

def workbench(
    element: ArrayLike | _Formula | _HasFormula | _Stresses,
    nodes: ArrayLike | None = None,
    young: float | None = None,
    poisson: float | None = None,
    kinematics: _Kinematics = "plane-strain",
    thickness: float = 1.0,
    order: Literal["interleaved", "blocked"] = "interleaved",
    precision: float | None = None,
    waive: Sequence[str] = ...,
    claim: Sequence[str] = ...,
    name: str = "element",
    out: str | PathLike[str] | None = None,
) -> dict[str, Any]: ...
def element(
    corners: ArrayLike,
    young: float,
    poisson: float,
    kinematics: _PlaneState,
    body_force: Sequence[float] = ...,
) -> dict[str, Any]: ...
def flexibility(corners: ArrayLike, constants: Sequence[float]) -> list[list[float]]: ...
def side_map(a: Sequence[float], b: Sequence[float]) -> list[list[float]]: ...
def field(
    of: Any, values: ArrayLike | None = None, name: str | None = None
) -> tuple[NDArray[np.float64], NDArray[np.intp], NDArray[np.float64]]: ...
def job(
    scenes: str | PathLike[str] | Sequence[str | PathLike[str]],
    command: Literal["verify", "solve", "certify"] = "verify",
    *,
    out: str | PathLike[str],
    jobs: int = 1,
    options: Sequence[str] = ...,
) -> dict[str, Any]: ...
def main() -> int: ...
