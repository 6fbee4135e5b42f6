"""The weak form: stiffness and load of continuous displacements of degree k on the given triangles or quadrilaterals.

𝓛(v) = ½ ∫ c e(v):e(v) − ∫ F·v − ∫ P·v, each integral times the thickness. FEniCSx assembles stiffness and body force;
tractions, affine on each edge, are integrated in closed form against the traces of the shape functions.

On a quadrilateral the shape functions are the images of polynomials of degree k in each of two coordinates of a square, and the
integrals those of a Gauss rule: exact on parallelograms, and elsewhere part of what the model is.
"""

from __future__ import annotations

from dataclasses import dataclass
from time import perf_counter

import numpy as np
import scipy.sparse as sp
import ufl
from petsc4py import PETSc

from hypercircle_process import BadExchange, Failure

from . import compat
from .exchange import Problem
from .lattice import Lattice, square, traction_weights, weighted_traction_weights, weights
from .springs import stiffness as spring_stiffness

GAUSS_POINTS = 6
"""Points of the rule on quadrilaterals, in each direction."""

OFF_STEP = 0.1
"""How far from a node of the lattice, in steps, a node of FEniCSx may seem to be on a very thin triangle."""


@dataclass(frozen=True)
class Numbering:
    """How nodes of the exchange file are numbered by FEniCSx, known in full on every rank.

    ``nodes`` (n,) is the global FEniCSx index of each node, −1 where no triangle uses it; ``ranges`` (ranks, 2) the
    indices each rank owns.
    """

    nodes: np.ndarray
    ranges: np.ndarray

    def owned(self, rank: int) -> np.ndarray:
        """Nodes of the exchange file that ``rank`` owns, in the order of FEniCSx."""
        order = np.full(self.ranges.max(), -1, dtype=np.int64)
        used = np.flatnonzero(self.nodes >= 0)
        order[self.nodes[used]] = used
        return order[self.ranges[rank, 0] : self.ranges[rank, 1]]


@dataclass(frozen=True)
class Model:
    """Stiffness (PETSc matrix) and load (PETSc vector) in FEniCSx's numbering, two components per node.

    ``load`` counts what initial strains pull, ``working`` does not: the work that enters the energy is that of the latter.
    ``displacement`` is a function of the space, ``energy`` the compiled form of its strain energy, and ``springs`` the part of the
    stiffness that springs have, if there are any. The space owns
    the communicator of matrix and vector, and has to live as long as they and all that is duplicated from them.
    """

    stiffness: object
    load: object
    working: object
    displacement: object
    energy: object
    springs: object
    numbering: Numbering
    seconds_compile: float
    seconds_assemble: float

    def strain_energy(self, u) -> float:
        """½ ∫ c (e(u) − ε0):(e(u) − ε0), summed over the triangles, and what springs store. In uᵀK u, a rigid motion would take more
        digits: all of |u|²."""
        strain = compat.evaluate(self.energy, self.displacement, u)
        return strain if self.springs is None else strain + 0.5 * u.dot(self.springs * u)


class Mesh:
    """The triangles, distributed, with the way back to the numbering of the exchange file.

    ``triangles`` (m,) is a triangle of the exchange file in each owned cell.
    """

    corners = 3
    measure = ufl.dx

    def __init__(self, comm, problem: Problem):
        self.comm = comm
        self.problem = problem
        self.mesh = compat.create_mesh(comm, problem.triangles, problem.points)
        corners = compat.cell_input_vertices(self.mesh, self.corners)
        self.triangles = self._triangle(self._edge(corners[:, 1], corners[:, 2]), corners[:, 0])

    def _edge(self, a: np.ndarray, b: np.ndarray) -> np.ndarray:
        count = len(self.problem.points)
        given = np.sort(self.problem.edges, axis=1) @ np.array([count, 1])
        return _find(given, np.minimum(a, b) * count + np.maximum(a, b))

    def _triangle(self, edge: np.ndarray, vertex: np.ndarray) -> np.ndarray:
        count = len(self.problem.points)
        given = (self.problem.triangle_edges * count + self.problem.triangles).reshape(-1)
        return _find(given, edge * count + vertex) // 3

    def numbering(self, space, lattice: Lattice) -> Numbering:
        """Gather the numbering of ``space`` from all ranks."""
        nodes = self._nodes(lattice)
        index, points = compat.cell_nodes(space, nodes.shape[1])
        ours = np.take_along_axis(nodes, self._places(points, lattice), axis=1)
        pieces = self.comm.allgather((ours.reshape(-1), index.reshape(-1)))
        nodes = np.full(lattice.ends[2], -1, dtype=np.int64)
        for node, number in pieces:
            nodes[node] = number
        return Numbering(nodes, np.array(self.comm.allgather(compat.owned_nodes(space))))

    def _nodes(self, lattice: Lattice) -> np.ndarray:
        """The nodes of the owned cells in the order of the lattice."""
        return lattice.of_triangles(self.problem)[self.triangles]

    def _places(self, points: np.ndarray, lattice: Lattice) -> np.ndarray:
        """Which node of its triangle each point (m, n, 2) of the owned cells is, in the order of the lattice."""
        k, problem = lattice.degree, self.problem
        corners = problem.points[problem.triangles[self.triangles]]
        sides = np.stack([corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]], axis=2)
        exact = k * np.linalg.solve(sides[:, None], (points - corners[:, :1])[..., None])[..., 0]
        steps = np.rint(exact).astype(int)
        place = np.full((k + 1, k + 1), -1)
        place[tuple(weights(k)[:, 1:].T)] = np.arange(len(weights(k)))
        found = place[tuple(np.clip(steps, 0, k).T)].T
        if np.any(np.abs(exact - steps) > OFF_STEP) or np.any(np.sort(found, axis=1) != np.arange(found.shape[1])):
            raise Failure("FEniCSx has its nodes elsewhere than at equal steps")
        return found


class QuadrilateralMesh(Mesh):
    """The quadrilaterals in place of the triangles, which they have to cover."""

    corners = 4
    # Degree 2n − 1 asks for n points in each direction.
    measure = ufl.dx(metadata={"quadrature_degree": 2 * GAUSS_POINTS - 1})

    def __init__(self, comm, problem: Problem):
        if 2 * len(problem.quadrilaterals) != len(problem.triangles):
            raise BadExchange("quadrilaterals: some triangles are in none, and a model on quadrilaterals covers all")
        self.comm = comm
        self.problem = problem
        # From around the cell to row by row, as FEniCSx has a square.
        self.mesh = compat.create_mesh(comm, problem.quadrilaterals[:, [0, 1, 3, 2]], problem.points)
        corners = compat.cell_input_vertices(self.mesh, self.corners)
        given = self._diagonal(problem.quadrilaterals[:, 0], problem.quadrilaterals[:, 2])
        self.cells = _find(given, self._diagonal(corners[:, 0], corners[:, 3]))
        self.triangles = problem.halves[self.cells, 0]

    def _diagonal(self, a: np.ndarray, b: np.ndarray) -> np.ndarray:
        """A number for the diagonal between two vertices, which no other cell has."""
        return np.minimum(a, b) * len(self.problem.points) + np.maximum(a, b)

    def _nodes(self, lattice: Lattice) -> np.ndarray:
        return lattice.of_quadrilaterals(self.problem)[self.cells]

    def _places(self, points: np.ndarray, lattice: Lattice) -> np.ndarray:
        x, y = square(lattice.degree).T
        shape = np.stack([(1 - x) * (1 - y), x * (1 - y), x * y, (1 - x) * y], axis=1)
        ours = shape @ self.problem.points[self.problem.quadrilaterals[self.cells]]
        apart = np.linalg.norm(points[:, :, None] - ours[:, None], axis=3)
        found = np.argmin(apart, axis=2)
        if np.any(np.sort(found, axis=1) != np.arange(found.shape[1])):
            raise Failure("FEniCSx has its nodes elsewhere than at equal steps")
        return found


def build(mesh: Mesh, degree: int, flip_sign: bool = False) -> Model:
    """Assemble stiffness and load of degree ``degree``.

    ``flip_sign`` plants a bug on purpose, 1 + 2ν for 1 − 2ν in Lamé's λ (1 + ν² for 1 − ν² in plane stress), so that
    a comparison can show that it would notice.
    """
    problem, comm = mesh.problem, mesh.comm
    start = perf_counter()
    space = compat.vector_space(mesh.mesh, mesh.corners, degree)
    section = Slice(mesh) if problem.revolution is None else Revolved(mesh)
    materials = np.array([_lame(body, problem.kinematics, flip_sign) for body in problem.bodies]) * problem.thickness
    forces = np.array([body.body_force for body in problem.bodies]) * problem.thickness
    owner = problem.body[mesh.triangles]
    lame, shear = (compat.constant_per_cell(mesh.mesh, materials[owner, i]) for i in range(2))
    law = _stiffness(mesh, owner)
    force = ufl.as_vector([compat.constant_per_cell(mesh.mesh, forces[owner, i]) for i in range(2)])
    gradients = np.array([body.force_gradient for body in problem.bodies]) * problem.thickness
    if np.any(gradients):
        slope = [[compat.constant_per_cell(mesh.mesh, gradients[owner, i, j]) for j in range(2)] for i in range(2)]
        force = force + ufl.dot(ufl.as_matrix(slope), ufl.SpatialCoordinate(mesh.mesh))
    displacement = compat.function(space)

    def product(e, d):
        isotropic = lame * section.trace(e) * section.trace(d) + 2 * shear * section.contraction(e, d)
        if law is None:
            return section.integral(isotropic)
        of_others = ufl.inner(ufl.dot(law, section.engineering(e)), section.engineering(d))
        return section.integral(isotropic + of_others)

    def work(u, v):
        if law is None and problem.revolution is None:
            both = lame * ufl.div(u) * ufl.div(v) + 2 * shear * ufl.inner(_strain(u), _strain(v))
            return section.integral(both)
        return product(section.strain(u), section.strain(v))

    u, v = ufl.TrialFunction(space), ufl.TestFunction(space)
    bilinear = compat.form(comm, work(u, v))
    initial = _initial_strain(mesh, owner)
    if initial is None:
        energy, pull = compat.form(comm, 0.5 * work(displacement, displacement)), None
    else:
        elastic = section.strain(displacement) - initial
        energy = compat.form(comm, 0.5 * product(elastic, elastic))
        pull = compat.form(comm, product(initial, section.strain(v)))
    linear = compat.form(comm, section.integral(ufl.inner(force, v)))
    compiled = perf_counter()

    lattice = Lattice.of(problem, degree)
    numbering = mesh.numbering(space, lattice)
    stiffness = compat.assemble_matrix(bilinear)
    springs = _springs(mesh, degree, numbering)
    if springs is not None:
        stiffness.axpy(1.0, springs, PETSc.Mat.Structure.DIFFERENT_NONZERO_PATTERN)
    load = compat.assemble_vector(linear)
    tractions = _traction_load(problem, lattice)
    load.array[:] += tractions[numbering.owned(mesh.comm.rank)].reshape(-1)
    working = load
    if pull is not None:
        working = load.copy()
        load.axpy(1.0, compat.assemble_vector(pull))
    return Model(stiffness, load, working, displacement, energy, springs, numbering, compiled - start, perf_counter() - compiled)


def _springs(mesh: Mesh, degree: int, numbering: Numbering):
    """The stiffness of springs in FEniCSx's numbering; None where there are none."""
    problem = mesh.problem
    if len(problem.springs.edges) == 0:
        return None
    return distributed(mesh, spring_stiffness(problem, degree), numbering)


def distributed(mesh: Mesh, of_nodes: sp.csr_matrix, numbering: Numbering):
    """A matrix for the nodes of the exchange file as a PETSc matrix in FEniCSx's numbering."""
    of_nodes, rank = of_nodes.tocoo(), mesh.comm.rank
    number = (2 * numbering.nodes[:, None] + np.arange(2)).reshape(-1)
    rows, columns = number[of_nodes.row], number[of_nodes.col]
    begin, end = 2 * numbering.ranges[rank]
    size = 2 * int(numbering.ranges.max())
    mine = (rows >= begin) & (rows < end)
    local = sp.csr_matrix((of_nodes.data[mine], (rows[mine] - begin, columns[mine])), shape=(end - begin, size))
    local.sort_indices()
    csr = (local.indptr.astype(PETSc.IntType), local.indices.astype(PETSc.IntType), local.data)
    matrix = PETSc.Mat().createAIJ(((int(end - begin), size), (int(end - begin), size)), csr=csr, comm=mesh.comm)
    matrix.assemble()
    return matrix


def _strain(v):
    return ufl.sym(ufl.grad(v))


class Slice:
    """A slice of a body: strains are those of the plane."""

    def __init__(self, mesh: Mesh):
        self.measure = mesh.measure

    def integral(self, density):
        """Over the figure, times what a point of it stands for."""
        return density * self.measure

    def strain(self, v):
        """e(v)."""
        return _strain(v)

    def trace(self, e):
        """The change of volume."""
        return ufl.tr(e)

    def contraction(self, e, d):
        """e:d."""
        return ufl.inner(e, d)

    def engineering(self, e):
        """ε_xx, ε_yy and 2 ε_xy."""
        return ufl.as_vector([e[0, 0], e[1, 1], 2 * e[0, 1]])


class Revolved(Slice):
    """A body of revolution: integrals have the weight r and the rule of the exchange file, and v_r/r is the strain of the hoop."""

    def __init__(self, mesh: Mesh):
        if mesh.corners != 3:
            raise BadExchange("kinematics: a body of revolution is modelled on triangles")
        revolution = mesh.problem.revolution
        rule = {"quadrature_points": revolution.points, "quadrature_weights": revolution.weights}
        self.measure = ufl.dx(metadata={"quadrature_rule": "custom", **rule})
        self.radius = ufl.SpatialCoordinate(mesh.mesh)[0] - revolution.axis

    def integral(self, density):
        return self.radius * density * self.measure

    def strain(self, v):
        """e(v) in the directions r, z and θ."""
        e, hoop = _strain(v), v[0] / self.radius
        return ufl.as_matrix([[e[0, 0], e[0, 1], 0], [e[0, 1], e[1, 1], 0], [0, 0, hoop]])

    def engineering(self, e):
        """ε_rr, ε_zz, ε_θθ and 2 ε_rz."""
        return ufl.as_vector([e[0, 0], e[1, 1], e[2, 2], 2 * e[0, 1]])


def _initial_strain(mesh: Mesh, owner: np.ndarray):
    """ε0, affine in x, or None where no body has one."""
    bodies = mesh.problem.bodies
    if all(body.initial_strain is None for body in bodies):
        return None
    rows = 3 if mesh.problem.revolution is None else 4
    values = np.array([np.zeros((rows, 3)) if body.initial_strain is None else body.initial_strain for body in bodies])[owner]
    x = ufl.SpatialCoordinate(mesh.mesh)
    part = [[compat.constant_per_cell(mesh.mesh, values[:, i, j]) for j in range(3)] for i in range(rows)]
    xx, yy, xy, *hoop = (value + along_x * x[0] + along_y * x[1] for value, along_x, along_y in part)
    if hoop:
        return ufl.as_matrix([[xx, xy, 0], [xy, yy, 0], [0, 0, hoop[0]]])
    return ufl.as_matrix([[xx, xy], [xy, yy]])


def _stiffness(mesh: Mesh, owner: np.ndarray):
    """Stiffness of the bodies that are not isotropic, cell by cell, or None where all are."""
    problem = mesh.problem
    if all(body.stiffness is None for body in problem.bodies):
        return None
    size = 3 if problem.revolution is None else 4
    none = np.zeros((size, size))
    values = np.array([none if body.stiffness is None else body.stiffness for body in problem.bodies])
    values = values[owner] * problem.thickness
    entry = {(i, j): compat.constant_per_cell(mesh.mesh, values[:, i, j]) for i in range(size) for j in range(i, size)}
    return ufl.as_matrix([[entry[min(i, j), max(i, j)] for j in range(size)] for i in range(size)])


def _lame(body, kinematics: str, flip_sign: bool) -> tuple[float, float]:
    """(λ, μ) of the plane problem; plane stress has λ* = 2λμ/(λ + 2μ) = Eν/(1 − ν²)."""
    if body.stiffness is not None:
        return 0.0, 0.0
    young, poisson, sign = body.young, body.poisson, -1.0 if flip_sign else 1.0
    shear = young / (2.0 * (1.0 + poisson))
    if kinematics != "plane-stress":
        return young * poisson / ((1.0 + poisson) * (1.0 - sign * 2.0 * poisson)), shear
    return young * poisson / (1.0 - sign * poisson * poisson), shear


def _traction_load(problem: Problem, lattice: Lattice) -> np.ndarray:
    """∫ P·v over the loaded edges for every node and component (n, 2), times the thickness; exact for affine P."""
    load = np.zeros((lattice.ends[2], 2))
    edges = problem.traction_edges
    ends = problem.edges[edges]
    nodes = np.concatenate([ends[:, :1], lattice.inside_edges(edges), ends[:, 1:]], axis=1)
    length = np.linalg.norm(problem.points[ends[:, 1]] - problem.points[ends[:, 0]], axis=1)
    if problem.revolution is None:
        shares = traction_weights(lattice.degree) @ problem.traction_values
    else:
        # r P is a quadratic.
        first, last = problem.traction_values[:, 0], problem.traction_values[:, 1]
        radius = problem.points[ends][:, :, :1] - problem.revolution.axis
        middle = radius[:, 0] * last + radius[:, 1] * first
        quadratic = np.stack([radius[:, 0] * first, middle, radius[:, 1] * last], axis=1)
        shares = weighted_traction_weights(lattice.degree) @ quadratic
    np.add.at(load, nodes, length[:, None, None] * shares)
    return problem.thickness * load


def _find(given: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    order = np.argsort(given, kind="stable")
    place = np.minimum(np.searchsorted(given[order], wanted), len(given) - 1)
    found = order[place]
    if np.any(given[found] != wanted):
        raise Failure("FEniCSx returned a cell that is not among the triangles of the exchange file")
    return found
