"""Every call to PETSc whose spelling or options depend on its release, and nothing else."""

from __future__ import annotations

import numpy as np

from hypercircle_process import Failure, NotInstalled

try:
    import petsc4py

    petsc4py.init(["hypercircle_dual"])
    from mpi4py import MPI
    from petsc4py import PETSc
except ImportError as error:
    raise NotInstalled(f"{error.name or 'petsc4py'} cannot be imported ({error})") from error

PETSC_VERSION = ".".join(map(str, PETSc.Sys.getVersion()))
INDEX = PETSc.IntType

if not np.issubdtype(PETSc.ScalarType, np.floating):
    raise NotInstalled("PETSc is built for complex numbers, and this model needs the build for real ones")

OPTIONS = {
    "ksp_fcg_mmax": 10,
    "ksp_fcg_nprealloc": 2,
    "ksp_fcg_truncation_type": "standard",
    "mg_levels_ksp_type": "chebyshev",
    "mg_levels_ksp_max_it": 2,
    "mg_levels_pc_type": "pbjacobi",
    "mg_coarse_ksp_type": "cg",
    "mg_coarse_ksp_max_it": 8,
    # Fewer where nothing is left to solve, as on meshes of a few triangles.
    "mg_coarse_ksp_norm_type": "natural",
    "mg_coarse_ksp_rtol": 1e-3,
    "mg_coarse_pc_type": "gamg",
    "mg_coarse_pc_mg_cycle_type": "v",
    "mg_coarse_pc_gamg_agg_nsmooths": 1,
    "mg_coarse_pc_gamg_threshold": 0.0,
    # The name before release 3.18, and the one since.
    "mg_coarse_pc_gamg_square_graph": 0,
    "mg_coarse_pc_gamg_aggressive_coarsening": 0,
    "mg_coarse_mg_levels_ksp_type": "chebyshev",
    "mg_coarse_mg_levels_pc_type": "jacobi",
}
"""Two levels, the lower of which is solved with by eight conjugate gradients, each with a cycle of smoothed aggregation."""
# Solves of one right-hand side take MUMPS several times as long.
FACTORS = "cholmod" if PETSc.Sys.hasExternalPackage("suitesparse") else "mumps"
SUBDOMAINS = {
    # Edges of the mesh that lie between the same two subdomains are constrained together, though no entry joins them.
    "pc_bddc_use_local_mat_graph": 0,
    # Constraints become unknowns, or the matrix of a subdomain that nothing else holds could not be factorised.
    "pc_bddc_use_change_of_basis": 1,
    "pc_bddc_use_deluxe_scaling": 1,
    # Rounding of what is eliminated inside subdomains may be all that is left on small loads.
    "pc_bddc_switch_static": 1,
    "pc_bddc_dirichlet_pc_type": "cholesky",
    "pc_bddc_dirichlet_pc_factor_mat_solver_type": FACTORS,
    "pc_bddc_neumann_pc_type": "cholesky",
    "pc_bddc_neumann_pc_factor_mat_solver_type": FACTORS,
}
"""Balancing domain decomposition by constraints, with factorised subdomains."""
WORKSPACE = {"mat_mumps_icntl_14": 60}
"""Percent of memory that MUMPS takes beyond its own estimate, which falls short over several ranks."""


def index_set(comm: MPI.Comm, indices: np.ndarray) -> PETSc.IS:
    """Indices that this rank is interested in."""
    return PETSc.IS().createGeneral(np.asarray(indices, INDEX), comm)


def vector(comm: MPI.Comm, local: int | None, size: int | None = None) -> PETSc.Vec:
    """A distributed vector of zeros; PETSc shares out what has no local size."""
    return PETSc.Vec().createMPI((local, size), comm=comm)


class Window:
    """Some entries of distributed vectors, for this rank to read and to combine with those of others."""

    def __init__(self, whole: PETSc.Vec, indices: np.ndarray) -> None:
        self.part = PETSc.Vec().createSeq(len(indices), comm=MPI.COMM_SELF)
        self._scatter = PETSc.Scatter().create(whole, index_set(MPI.COMM_SELF, indices), self.part, None)

    def read(self, whole: PETSc.Vec) -> np.ndarray:
        """The entries."""
        self._scatter.scatter(whole, self.part, PETSc.InsertMode.INSERT, PETSc.ScatterMode.FORWARD)
        return self.part.array_r.copy()

    def add(self, values: np.ndarray, whole: PETSc.Vec) -> None:
        """Add to the entries."""
        self._reverse(values, whole, PETSc.InsertMode.ADD)

    def maximum(self, values: np.ndarray, whole: PETSc.Vec) -> None:
        """Raise the entries."""
        self._reverse(values, whole, PETSc.InsertMode.MAX)

    def _reverse(self, values: np.ndarray, whole: PETSc.Vec, mode: PETSc.InsertMode) -> None:
        self.part.array = values
        self._scatter.scatter(self.part, whole, mode, PETSc.ScatterMode.REVERSE)


def partition(comm: MPI.Comm, starts: np.ndarray, neighbours: np.ndarray, size: int) -> np.ndarray:
    """The rank for each node of this rank's part of a graph of ``size`` nodes, found by PT-Scotch."""
    local = len(starts) - 1
    # An MPIAIJ matrix wants its columns in order.
    order = np.lexsort((neighbours, np.repeat(np.arange(local), np.diff(starts))))
    columns, ones = neighbours[order].astype(INDEX), np.ones(len(neighbours))
    graph = PETSc.Mat().createAIJ(((local, size), (local, size)), csr=(starts.astype(INDEX), columns, ones), comm=comm)
    graph = graph.convert("mpiadj", PETSc.Mat())
    partitioning = PETSc.MatPartitioning().create(comm)
    partitioning.setType("ptscotch")
    partitioning.setAdjacency(graph)
    owner = PETSc.IS().create(comm)
    partitioning.apply(owner)
    return owner.getIndices().copy()


def matrix(comm: MPI.Comm, local: int, stride: int, own: np.ndarray, other: np.ndarray) -> PETSc.Mat:
    """An empty square matrix, with room for ``own`` and ``other`` entries in the columns of this rank and of others."""
    empty = PETSc.Mat().create(comm)
    empty.setSizes(((local, None), (local, None)))
    empty.setBlockSize(stride)
    empty.setType("aij")
    empty.setPreallocationNNZ((own.astype(INDEX), other.astype(INDEX)))
    empty.setOption(PETSc.Mat.Option.NEW_NONZERO_ALLOCATION_ERR, True)
    return empty


def add_blocks(target: PETSc.Mat, numbers: np.ndarray, values: np.ndarray) -> None:
    """Add square matrices ``values`` (k, n, n) at the rows and columns ``numbers`` (k, n)."""
    if numbers.size == 0:
        return
    numbers = np.ascontiguousarray(numbers, INDEX)
    target.setValuesRCV(numbers, numbers, np.ascontiguousarray(values), PETSc.InsertMode.ADD)


def finish(target: PETSc.Mat) -> None:
    """End assembly of a symmetric, semidefinite matrix."""
    target.assemble()
    target.setOption(PETSc.Mat.Option.SYMMETRIC, True)
    target.setOption(PETSc.Mat.Option.SPD, True)


def factorisation(target: PETSc.Mat) -> PETSc.KSP:
    """A solver that factorises with MUMPS."""
    solver = with_options(target, WORKSPACE)
    solver.setType("preonly")
    solver.pc.setType("cholesky")
    solver.pc.setFactorSolverType("mumps")
    return set_up(solver)


def with_options(target: PETSc.Mat, values: dict) -> PETSc.KSP:
    """A solver with the matrix ``target``; what ``PETSC_OPTIONS`` says with the prefix ``dual_`` goes before ``values``."""
    options = PETSc.Options()
    for name, value in values.items():
        if not options.hasName(f"dual_{name}"):
            options[f"dual_{name}"] = value
    solver = PETSc.KSP().create(target.comm)
    solver.setOptionsPrefix("dual_")
    solver.setOperators(target)
    return solver


def entries(comm: MPI.Comm, local: tuple[int, int], stride: int, rows, columns, values) -> PETSc.Mat:
    """A matrix with ``local`` rows and columns on this rank from its entries; equal places are added."""
    out = PETSc.Mat().create(comm)
    out.setSizes(((local[0], None), (local[1], None)))
    out.setBlockSizes(stride, 2)
    out.setType("aij")
    room = np.bincount(rows - (comm.exscan(local[0]) or 0), minlength=local[0]).astype(INDEX)
    out.setPreallocationNNZ((np.minimum(room, local[1]), room))
    out.setOption(PETSc.Mat.Option.NEW_NONZERO_ALLOCATION_ERR, False)
    if len(rows):
        shape = (-1, 1)
        out.setValuesRCV(
            np.ascontiguousarray(rows, INDEX).reshape(shape),
            np.ascontiguousarray(columns, INDEX).reshape(shape),
            np.ascontiguousarray(values).reshape(*shape, 1),
            PETSc.InsertMode.ADD,
        )
    out.assemble()
    return out


def kernel(motions: list[PETSc.Vec]) -> PETSc.NullSpace:
    """The space of some vectors."""
    basis: list[PETSc.Vec] = []
    for motion in motions:
        vector = motion.copy()
        for _ in range(2):
            for other in basis:
                vector.axpy(-vector.dot(other), other)
        vector.normalize()
        basis.append(vector)
    return PETSc.NullSpace().create(vectors=basis, comm=motions[0].comm)


def multigrid(target: PETSc.Mat, nodal: PETSc.Mat, motions: list[PETSc.Vec], tolerance: float, most: int) -> PETSc.KSP:
    """Conjugate gradients with two levels: ``nodal`` maps the coarse unknowns to those of ``target``, and ``motions`` are
    coarse vectors that the coarse matrix all but annihilates."""
    coarse = target.ptap(nodal)
    diagonal = coarse.getDiagonal()
    # A vertex that moves no unknown has a row without entries.
    coarse.setOption(PETSc.Mat.Option.NEW_NONZERO_ALLOCATION_ERR, False)
    diagonal.array = np.where(diagonal.array_r == 0.0, 1.0, diagonal.array_r)
    coarse.setDiagonal(diagonal)
    coarse.setBlockSize(2)
    finish(coarse)
    coarse.setNearNullSpace(kernel(motions))
    solver = with_options(target, OPTIONS)
    # The conjugate gradients below make the preconditioner another one in each iteration.
    solver.setType("fcg")
    solver.pc.setType("mg")
    solver.pc.setMGLevels(2)
    solver.pc.setMGInterpolation(1, nodal)
    solver.pc.getMGCoarseSolve().setOperators(coarse)
    solver.setTolerances(rtol=tolerance, atol=0.0, divtol=1e30, max_it=most)
    solver.setFromOptions()
    return set_up(solver)


def substructured(
    comm: MPI.Comm, own: PETSc.Mat, numbers: np.ndarray, local: int, fixed: np.ndarray, fields: list[np.ndarray],
    motions: list[PETSc.Vec], tolerance: float, most: int,
) -> PETSc.KSP:  # fmt: skip
    """Conjugate gradients with a subdomain for each rank, for the sum of the matrices ``own`` of all ranks.

    ``numbers`` are those of its rows among all, of which ``local`` belong to this rank, ``fixed`` the rows that stand alone.
    Each of the ``fields``, into which the rows are divided, is constrained by itself wherever two subdomains share some of it.
    """
    target = PETSc.Mat().create(comm)
    target.setSizes(((local, None), (local, None)))
    target.setType("is")
    numbering = PETSc.LGMap().create(numbers.astype(INDEX), comm=comm)
    target.setLGMap(numbering, numbering)
    target.setISLocalMat(own)
    finish(target)
    target.setNearNullSpace(kernel(motions))
    solver = with_options(target, SUBDOMAINS)
    solver.setType("cg")
    solver.pc.setType("bddc")
    solver.pc.setBDDCDofsSplittingLocal([index_set(MPI.COMM_SELF, field) for field in fields])
    solver.pc.setBDDCDirichletBoundariesLocal(index_set(MPI.COMM_SELF, fixed))
    solver.setTolerances(rtol=tolerance, atol=0.0, divtol=1e30, max_it=most)
    solver.setFromOptions()
    return set_up(solver)


def set_up(solver: PETSc.KSP) -> PETSc.KSP:
    """Factorise, or make the preconditioner."""
    try:
        solver.setUp()
    except PETSc.Error as error:
        raise Failure(f"the matrix could not be factorised ({error})") from error
    return solver


def collect(comm: MPI.Comm) -> None:
    """Free what Python no longer refers to, which since release 3.18 is kept until all ranks ask for this together."""
    if hasattr(PETSc, "garbage_cleanup"):
        PETSc.garbage_cleanup(comm)


def solve(solver: PETSc.KSP, load: PETSc.Vec, out: PETSc.Vec) -> int:
    """Solve, and return the number of iterations; what their limit leaves is for the caller to see."""
    collect(solver.comm)
    solver.solve(load, out)
    reason = solver.getConvergedReason()
    if reason < 0 and reason != PETSc.KSP.ConvergedReason.DIVERGED_MAX_IT:
        raise Failure(f"the linear solver stopped after {solver.getIterationNumber()} iterations: {failure(solver, reason)}")
    return solver.getIterationNumber()


def failure(solver: PETSc.KSP, reason: int) -> str:
    """Why a solver stopped, in words."""
    names = {-5: "it breaks down", -8: "the preconditioner is not definite", -9: "a value is no number",
             -10: "the matrix is not definite"}  # fmt: skip
    if reason == -11 and solver.pc.getType() == "cholesky":
        code, detail = (solver.pc.getFactorMatrix().getMumpsInfog(i) for i in (1, 2))
        if code in (-8, -9, -13, -19):
            return f"MUMPS has too little memory (INFOG(1) = {code}, INFOG(2) = {detail})"
        return f"MUMPS gave up with INFOG(1) = {code}, INFOG(2) = {detail}"
    return names.get(reason, f"PETSc's reason is {reason}")


def newton(matrix: np.ndarray, c: np.ndarray, g: np.ndarray) -> np.ndarray:
    """Which of the variables are at their bound in min ½ jᵀSj − cᵀj over j ≤ g, as TAO's Newton method with a trust region finds it, on this rank alone."""
    size = len(c)
    hessian = PETSc.Mat().createDense((size, size), array=np.asfortranarray(matrix), comm=MPI.COMM_SELF)
    hessian.assemble()
    x, lower, upper = (PETSc.Vec().createSeq(size, comm=MPI.COMM_SELF) for _ in range(3))
    x.array = g
    lower.set(PETSc.NINFINITY)
    upper.array = g

    def energy(_tao, x, gradient) -> float:
        hessian.mult(x, gradient)
        quadratic = 0.5 * x.dot(gradient)
        gradient.array = gradient.array_r - c
        return quadratic - float(c @ x.array_r)

    tao = PETSc.TAO().create(MPI.COMM_SELF)
    tao.setType("bntr")
    tao.setObjectiveGradient(energy, x.duplicate())
    tao.setHessian(lambda *_: None, hessian)
    tao.setVariableBounds((lower, upper))
    tao.setTolerances(gatol=1e-14 * np.abs(c).max(initial=1e-300))
    tao.solve(x)
    gap, force = g - x.array_r, c - matrix @ x.array_r
    return force > gap
