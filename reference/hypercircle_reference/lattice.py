"""The nodes of continuous displacements of degree k, and the polynomials along an edge that they carry.

Nodes lie at equal steps. A quadrilateral that two triangles make has the nodes of both, at equal steps of the square that is
mapped onto it. Their numbers: the vertices, then for each edge the k − 1 inside it from its first vertex to its
second, then for each triangle the (k − 1)(k − 2)/2 inside it, the weight of its first corner falling and, where that is
equal, the weight of its second.

On an edge j(s) = Σ b_i B_i(s) with the Bernstein polynomials B_0, …, B_k; the b_i of a linear function are its values at
i/k, and a bound on every b_i bounds j between the nodes too.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import comb

import numpy as np


def bernstein(degree: int) -> np.ndarray:
    """Values (k + 1, k + 1) of the Bernstein polynomials, one column each, at the nodes of an edge."""
    s = np.arange(degree + 1)[:, None] / degree
    i = np.arange(degree + 1)
    return np.array([comb(degree, j) for j in i]) * s**i * (1.0 - s) ** (degree - i)


def traction_weights(degree: int) -> np.ndarray:
    """∫ φ_i (1 − s) ds and ∫ φ_i s ds (k + 1, 2) over an edge of length one, for the shape functions φ_i of its nodes."""
    i = np.arange(degree + 1)
    moments = np.stack([degree + 1 - i, i + 1], axis=1) / ((degree + 1) * (degree + 2))
    return np.linalg.solve(bernstein(degree).T, moments)


def weighted_traction_weights(degree: int) -> np.ndarray:
    """∫ φ_i (1 − s)² ds, ∫ φ_i s (1 − s) ds and ∫ φ_i s² ds (k + 1, 3), φ_i as in :func:`traction_weights`."""
    points, by = np.polynomial.legendre.leggauss(degree // 2 + 2)
    s = 0.5 * (points + 1)
    at = np.arange(degree + 1) / degree
    shape = np.linalg.solve(np.vander(at, increasing=True).T, np.vander(s, degree + 1, increasing=True).T)
    return (0.5 * by * shape) @ np.stack([(1 - s) ** 2, s * (1 - s), s**2], axis=1)


def weights(degree: int) -> np.ndarray:
    """Weights of the corners, times k, at each node of a triangle (n, 3), the first falling, then the second."""
    return np.array([(degree - r, r - l, l) for r in range(degree + 1) for l in range(r + 1)])


def square(degree: int) -> np.ndarray:
    """Where the nodes of a quadrilateral are on the unit square ((k + 1)², 2), row by row, in the order of
    :meth:`Lattice.of_quadrilaterals`."""
    steps = np.arange(degree + 1) / degree
    return np.stack(np.meshgrid(steps, steps), axis=-1).reshape(-1, 2)


@dataclass(frozen=True)
class Lattice:
    """The nodes of degree ``degree`` on a mesh with so many vertices, edges and triangles."""

    degree: int
    vertices: int
    edges: int
    triangles: int

    @staticmethod
    def of(problem, degree: int) -> "Lattice":
        """Those of a problem."""
        return Lattice(degree, len(problem.points), len(problem.edges), len(problem.triangles))

    @property
    def in_edge(self) -> int:
        """Nodes inside one edge."""
        return self.degree - 1

    @property
    def in_triangle(self) -> int:
        """Nodes inside one triangle."""
        return (self.degree - 1) * (self.degree - 2) // 2

    @property
    def ends(self) -> tuple[int, int, int]:
        """One past the last node of the vertices, of the edges, and of all."""
        edges = self.vertices + self.in_edge * self.edges
        return self.vertices, edges, edges + self.in_triangle * self.triangles

    def inside_edges(self, edges: np.ndarray) -> np.ndarray:
        """Nodes (m, k − 1) inside the edges (m,), from their first vertices to their second."""
        return self.vertices + self.in_edge * np.asarray(edges)[:, None] + np.arange(self.in_edge)

    def inside_triangles(self, triangles: np.ndarray) -> np.ndarray:
        """Nodes (m, (k − 1)(k − 2)/2) inside the triangles (m,)."""
        return self.ends[1] + self.in_triangle * np.asarray(triangles)[:, None] + np.arange(self.in_triangle)

    def along(self, problem, edges: np.ndarray, start: np.ndarray) -> np.ndarray:
        """Nodes (m, k − 1) inside the edges (m,) in the direction that begins at the vertices ``start`` (m,); −1 where
        there is no edge."""
        nodes = self.inside_edges(edges)
        nodes = np.where((problem.edges[edges, 0] == start)[:, None], nodes, nodes[:, ::-1])
        return np.where((edges >= 0)[:, None], nodes, -1)

    def of_triangles(self, problem) -> np.ndarray:
        """Nodes of every triangle (m, (k + 1)(k + 2)/2), in the order of :func:`weights`."""
        k, at = self.degree, weights(self.degree)
        nodes = np.empty((self.triangles, len(at)), dtype=np.int64)
        nodes[:, np.all(at > 0, axis=1)] = self.inside_triangles(np.arange(self.triangles))
        for i in range(3):
            first, second = (i + 1) % 3, (i + 2) % 3
            side = np.flatnonzero(at[:, i] == 0)
            side = side[np.argsort(at[side, second])]
            nodes[:, side[0]] = problem.triangles[:, first]
            nodes[:, side[1:k]] = self.along(problem, problem.triangle_edges[:, i], problem.triangles[:, first])
        return nodes

    def of_quadrilaterals(self, problem) -> np.ndarray:
        """Nodes of every quadrilateral (m, (k + 1)²), in the order of :func:`square`."""
        k, at, nodes = self.degree, weights(self.degree), self.of_triangles(problem)
        place = np.full((k + 1, k + 1, k + 1), -1)
        place[tuple(at.T)] = np.arange(len(at))
        out = np.empty((len(problem.quadrilaterals), (k + 1) ** 2), dtype=np.int64)
        # Where the corners of the quadrilateral are among those of its two triangles.
        corner = [problem.triangles[t][:, :, None] == problem.quadrilaterals[:, None, :] for t in problem.halves.T]
        for j in range(k + 1):
            for i in range(k + 1):
                near = i + j <= k
                parts = (k - i - j, i, 0, j) if near else (0, k - j, i + j - k, k - i)
                own = corner[0] if near else corner[1]
                alpha = own @ np.array(parts)
                half = problem.halves[:, 0 if near else 1]
                out[:, j * (k + 1) + i] = nodes[half, place[tuple(alpha.T)]]
        return out
