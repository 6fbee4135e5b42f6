"""Every call whose spelling depends on the DOLFINx release, and nothing else.

Two spellings are known: the one of 0.5 (UFL elements, adjacency lists) and the one of 0.9 and later (Basix elements,
plain arrays, ``functionspace`` in place of ``VectorFunctionSpace``).
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from importlib.metadata import distribution
from pathlib import Path
from types import ModuleType

import numpy as np

from hypercircle_process import NotInstalled


@contextmanager
def quick_versions() -> Iterator[None]:
    """Answer UFL and FFCx of 0.5, which ask ``pkg_resources`` for their own version and nothing else: to import it takes a fifth of a run."""
    if "pkg_resources" in sys.modules:
        yield
        return
    module = ModuleType("pkg_resources")
    module.get_distribution = distribution
    sys.modules[module.__name__] = module
    try:
        yield
    finally:
        del sys.modules[module.__name__]


try:
    with quick_versions():
        import dolfinx
        import dolfinx.fem
        import dolfinx.fem.petsc
        import dolfinx.jit
        import dolfinx.mesh
        import petsc4py
        import ufl
        from mpi4py import MPI
        from petsc4py import PETSc
except ImportError as error:
    raise NotInstalled(f"{error.name or 'FEniCSx'} cannot be imported ({error})") from error

MODERN = hasattr(dolfinx.fem, "functionspace")
if MODERN:
    import basix.ufl
else:
    import basix.ufl_wrapper

EQUAL_STEPS = basix.LagrangeVariant.equispaced

SOLVER_VERSION = dolfinx.__version__
PETSC_VERSION = petsc4py.__version__

if not np.issubdtype(PETSc.ScalarType, np.floating):
    raise NotInstalled("PETSc is built for complex numbers, and this model needs the build for real ones")


ABANDONED = 60.0
"""Seconds after which a module that is still not compiled belongs to a process that was killed."""
WAITS = 8
"""How often FFCx may wait, ten seconds each time, for a module that another process compiles."""


def remove_abandoned(cache: Path) -> None:
    """Remove what killed processes left of modules in the folder of FFCx, which would wait for each of them in vain."""
    for source in cache.glob("libffcx_*.c"):
        ready = source.with_name(f"{source.name}.cached")
        try:
            if not ready.exists() and time.time() - source.stat().st_mtime > ABANDONED:
                source.unlink()
        except FileNotFoundError:
            pass  # another process was faster


def cache_folder() -> Path:
    """Where FFCx keeps what it has compiled."""
    return Path((dolfinx.jit.get_options if MODERN else dolfinx.jit.get_parameters)()["cache_dir"])


def jit(comm: MPI.Comm, make: Callable):
    """Compiles by ``make``, on all ranks together, and returns its result."""
    for _ in range(WAITS):
        if comm.rank == 0:
            remove_abandoned(cache_folder())
        try:
            return make()
        except (RuntimeError, TimeoutError) as error:
            # The ranks after the first are told of a failure and not of its reason.
            if "just-in-time" not in str(error) and "JIT" not in str(error):
                raise
            if not comm.bcast("timed out" in str(error)):
                raise
    return make()


SHAPES = {3: "triangle", 4: "quadrilateral"}
"""Shapes of cells by their number of vertices."""


def create_mesh(comm: MPI.Comm, cells: np.ndarray, points: np.ndarray):
    """Distribute the cells, triangles (m, 3) or quadrilaterals (m, 4), with coordinates (n, 2); rank 0 hands in everything,
    the others nothing. The vertices of a quadrilateral are those of a square at (0, 0), (1, 0), (0, 1), (1, 1)."""
    shape = SHAPES[cells.shape[1]]
    if comm.rank != 0:
        cells, points = np.empty((0, cells.shape[1]), dtype=np.int64), np.empty((0, 2))
    if MODERN:
        element = basix.ufl.element("Lagrange", shape, 1, shape=(2,))
        # Keywords, because 0.10 exchanged the order of the last two.
        return jit(comm, lambda: dolfinx.mesh.create_mesh(comm, cells=cells, x=points, e=ufl.Mesh(element)))
    domain = ufl.Mesh(ufl.VectorElement("Lagrange", ufl.Cell(shape, geometric_dimension=2), 1))
    return jit(comm, lambda: dolfinx.mesh.create_mesh(comm, cells, points, domain))


def owned_cells(mesh) -> int:
    """Number of cells this rank owns; they come first in the local numbering."""
    return mesh.topology.index_map(mesh.topology.dim).size_local


def cell_input_vertices(mesh, corners: int) -> np.ndarray:
    """Vertices of each owned cell (m, corners) in the numbering of the points given to :func:`create_mesh`."""
    original = np.asarray(mesh.geometry.input_global_indices)
    # Releases after 0.10 have one table for each type of cell, and warn of the single one.
    tables = getattr(mesh.geometry, "dofmaps", None)
    table = tables[0] if isinstance(tables, (list, tuple)) else mesh.geometry.dofmap
    return original[_table(table, corners)[: owned_cells(mesh)]]


def vector_space(mesh, corners: int, degree: int):
    """Continuous Lagrange displacements of the given degree on cells with so many corners, their nodes at equal steps."""
    shape = SHAPES[corners]
    if MODERN:
        element = basix.ufl.element("Lagrange", shape, degree, EQUAL_STEPS, shape=(2,))
        return jit(mesh.comm, lambda: dolfinx.fem.functionspace(mesh, element))
    element = basix.ufl_wrapper.create_vector_element("Lagrange", shape, degree, EQUAL_STEPS)
    return jit(mesh.comm, lambda: dolfinx.fem.FunctionSpace(mesh, element))


def constant_per_cell(mesh, values: np.ndarray):
    """Coefficient with the given value (m,) on each owned cell."""
    make = dolfinx.fem.functionspace if MODERN else dolfinx.fem.FunctionSpace
    space = jit(mesh.comm, lambda: make(mesh, ("DG", 0)))
    coefficient = dolfinx.fem.Function(space)
    coefficient.x.array[_table(space.dofmap.list, 1)[: owned_cells(mesh), 0]] = values
    return coefficient


def cell_nodes(space, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Global node index of each of the ``count`` local degrees of freedom of the owned cells (m, n), and where it is
    (m, n, 2)."""
    local = _table(space.dofmap.list, count)[: owned_cells(space.mesh)]
    index = space.dofmap.index_map.local_to_global(local.reshape(-1).astype(np.int32)).reshape(local.shape)
    return index, space.tabulate_dof_coordinates()[local, :2]


def owned_nodes(space) -> tuple[int, int]:
    """The half-open range of global node indices this rank owns."""
    return tuple(space.dofmap.index_map.local_range)


def form(comm: MPI.Comm, expression):
    """Compile a UFL form."""
    return jit(comm, lambda: dolfinx.fem.form(expression))


def assemble_matrix(compiled) -> PETSc.Mat:
    """The assembled matrix, ready for use."""
    matrix = dolfinx.fem.petsc.assemble_matrix(compiled)
    matrix.assemble()
    return matrix


def assemble_vector(compiled) -> PETSc.Vec:
    """The assembled vector, contributions of all ranks added."""
    vector = dolfinx.fem.petsc.assemble_vector(compiled)
    vector.ghostUpdate(addv=PETSc.InsertMode.ADD, mode=PETSc.ScatterMode.REVERSE)
    return vector


def function(space):
    """A function of the space; it keeps the space alive."""
    return dolfinx.fem.Function(space)


def evaluate(compiled, argument, values: PETSc.Vec) -> float:
    """The value of a form of rank zero, summed over all ranks, with ``values`` for the function ``argument``."""
    argument.x.array[: values.getLocalSize()] = values.array_r
    argument.x.scatter_forward()
    return float(argument.function_space.mesh.comm.allreduce(dolfinx.fem.assemble_scalar(compiled)))


def _table(dofmap, width: int) -> np.ndarray:
    return np.asarray(getattr(dofmap, "array", dofmap)).reshape(-1, width)
