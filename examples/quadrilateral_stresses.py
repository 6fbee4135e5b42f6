#!/usr/bin/env python3
"""Which linear equilibrium element for a quadrilateral: two blocks along the better diagonal, one cut by both diagonals, or four blocks?

All have linear tractions on the four sides and nothing else in common with the rest of the mesh: eliminating what is inside
leaves a system of the same size and structure, so that meshes of the same cells cost the same. What is compared is how far
their complementary energy is above the exact one, which is the part of the bracket that stresses are to blame for.

    python3 examples/quadrilateral_stresses.py

A line has √((𝒮(λ_h) − 𝒮)/𝒮) for each, and what part that is of the first. Needs numpy and scipy.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sparse
from scipy.sparse.linalg import spsolve

YOUNG, POISSON = 1.0, 0.3  # plane stress
MESH = 12


def compliance():
    return np.array([[1, -POISSON, 0], [-POISSON, 1, 0], [0, 0, 2 * (1 + POISSON)]]) / YOUNG


def quality(p, q, r):
    """Area over the squares of the sides."""
    area = (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])
    return area / sum(np.sum((a - b) ** 2) for a, b in ((p, q), (q, r), (r, p)))


def thirds(points, corners):
    """The three parts of a triangle around its centroid, which is appended to ``points``."""
    points.append(sum(points[c] for c in corners) / 3)
    last = len(points) - 1
    a, b, c = corners
    return [(a, b, last), (b, c, last), (c, a, last)]


def two_blocks(corners):
    """Two triangles along the diagonal whose worse triangle is the better one, each cut at its centroid."""
    a, b, c, d = corners
    first = min(quality(a, b, c), quality(a, c, d)) >= min(quality(a, b, d), quality(b, c, d)) - 1e-9
    points = list(corners)
    halves = [(0, 1, 2), (0, 2, 3)] if first else [(0, 1, 3), (1, 2, 3)]
    return points, [part for half in halves for part in thirds(points, half)]


def both_diagonals(corners):
    """Four triangles around the point where the diagonals meet."""
    a, b, c, d = corners
    s = np.linalg.solve(np.column_stack([c - a, b - d]), b - a)[0]
    points = [*corners, a + s * (c - a)]
    return points, [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)]


def four_blocks(corners):
    """The same four triangles, each cut at its centroid."""
    points, triangles = both_diagonals(corners)
    return points, [part for triangle in triangles for part in thirds(points, triangle)]


def traction(points, triangle, edge):
    """The tractions at both ends of an edge from the stress at the corners (4, 9): x and y at one end, then at the other."""
    i, j = edge
    t = points[j] - points[i]
    n = np.array([t[1], -t[0]]) / np.linalg.norm(t)
    normal = np.array([[n[0], 0, n[1]], [0, n[1], n[0]]])
    out = np.zeros((4, 9))
    for row, vertex in enumerate((i, j)):
        k = 3 * triangle.index(vertex)
        out[2 * row : 2 * row + 2, k : k + 3] = normal
    return out


def stiffness(points, parts):
    """K = T Tᵀ (16, 16) on the moments of the displacement with the tractions of the sides, and the number of modes."""
    count = 9 * len(parts)
    rows, seen, energy = [], {}, np.zeros((count, count))
    sides = np.zeros((16, count))
    for e, part in enumerate(parts):
        a, b, c = (points[v] for v in part)
        double = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        gradient = [np.array([q[1] - r[1], r[0] - q[0]]) / double for q, r in ((b, c), (c, a), (a, b))]
        divergence = np.zeros((2, count))
        for k, g in enumerate(gradient):
            divergence[:, 9 * e + 3 * k : 9 * e + 3 * k + 3] = np.array([[g[0], 0, g[1]], [0, g[1], g[0]]]) * np.sqrt(double)
        rows.append(divergence)
        mass = double / 24 * (np.ones((3, 3)) + np.eye(3))
        energy[9 * e : 9 * e + 9, 9 * e : 9 * e + 9] = np.kron(mass, compliance())
        for i, j in ((part[0], part[1]), (part[1], part[2]), (part[2], part[0])):
            own = np.zeros((4, count))
            own[:, 9 * e : 9 * e + 9] = traction(points, part, (i, j))
            if i < 4 and j == (i + 1) % 4:
                # ∫ traction · φ for the two linear φ of the side.
                length = np.linalg.norm(points[j] - points[i])
                weights = np.kron(length / 6 * np.array([[2, 1], [1, 2]]), np.eye(2))
                sides[4 * i : 4 * i + 4] = weights @ own
            elif (j, i) in seen:
                rows.append(own + seen[j, i][[2, 3, 0, 1]])
            else:
                seen[i, j] = own
    _, singular, right = np.linalg.svd(np.vstack(rows))
    modes = right[np.sum(singular > 1e-9 * singular[0]) :].T
    # Orthonormal in complementary energy.
    root = np.linalg.cholesky(modes.T @ energy @ modes)
    T = sides @ modes @ np.linalg.inv(root).T
    return T @ T.T, modes.shape[1]


def grid(n, place):
    at = lambda i, j: j * (n + 1) + i
    points = np.array([place(i / n, j / n) for j in range(n + 1) for i in range(n + 1)])
    cells = [(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)) for j in range(n) for i in range(n)]
    return points, cells


def strain_energy(points, cells, element, pull):
    """𝒮(λ_h) with the sides at i = 0 clamped and the traction ``pull`` on those at i = n."""
    number, n = {}, int(round(np.sqrt(len(cells))))
    rows, columns, values, modes = [], [], [], 0
    load = {}
    for index, cell in enumerate(cells):
        K, modes = stiffness(*element([points[v] for v in cell]))
        dofs, signs = [], []
        for k in range(4):
            ends = (cell[k], cell[(k + 1) % 4])
            side = number.setdefault(tuple(sorted(ends)), len(number))
            # The ends of a side in the order of their numbers.
            order = (0, 1) if ends[0] < ends[1] else (1, 0)
            dofs += [4 * side + 2 * o + c for o in order for c in range(2)]
            if k == 1 and index % n == n - 1:
                length = np.linalg.norm(points[ends[1]] - points[ends[0]])
                for o in order:
                    for c in range(2):
                        load[4 * side + 2 * o + c] = 0.5 * length * pull[c]
        rows.append(np.repeat(dofs, 16))
        columns.append(np.tile(dofs, 16))
        values.append(K.reshape(-1))
    size = 4 * len(number)
    K = sparse.csr_matrix((np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))), (size, size))
    f = np.zeros(size)
    f[list(load)] = list(load.values())
    clamped = [number[tuple(sorted((j * (n + 1), (j + 1) * (n + 1))))] for j in range(n)]
    free = np.setdiff1d(np.arange(size), [4 * s + k for s in clamped for k in range(4)])
    v = spsolve(K[free][:, free].tocsc(), f[free])
    return 0.5 * f[free] @ v, modes


def cook(s, t):
    return np.array([48 * s, 44 * s + t * (44 - 28 * s)]) / 48


def shaken(amount, seed=1):
    """The unit square with its inner vertices moved by up to ``amount`` of a cell's side."""

    def place(n):
        random, moved = np.random.default_rng(seed), {}

        def at(s, t):
            inside = 0 < s < 1 and 0 < t < 1
            if (s, t) not in moved:
                offset = random.uniform(-amount, amount, 2) / n if inside else np.zeros(2)
                moved[s, t] = np.array([s, t]) + offset
            return moved[s, t]

        return at

    return place


def main():
    straight = lambda n: lambda s, t: np.array([s, t])
    shapes = {
        "squares, tension": (straight, (1.0, 0.0)),
        "squares, shear": (straight, (0.0, 1.0)),
        "rectangles 4 : 1": (lambda n: lambda s, t: np.array([4 * s, t]), (0.0, 1.0)),
        "parallelograms": (lambda n: lambda s, t: np.array([s + 0.5 * t, t]), (0.0, 1.0)),
        "Cook's membrane": (lambda n: cook, (0.0, 1.0)),
        "shaken by 0.1": (shaken(0.1), (0.0, 1.0)),
        "shaken by 0.2": (shaken(0.2), (0.0, 1.0)),
    }
    elements = {"two blocks": two_blocks, "both diagonals": both_diagonals, "four blocks": four_blocks}
    print(f"{f'{MESH} × {MESH} cells':20}" + "".join(f"{name:>18}" for name in elements))
    for name, (place, pull) in shapes.items():
        # From above; what is left on the finest mesh is about that part of the last step that corners leave.
        pairs = [[strain_energy(*grid(n, place(n)), four_blocks, pull)[0] for n in (MESH, 2 * MESH)]]
        exact = min(fine - (coarse - fine) / 1.5 for coarse, fine in pairs)
        found = [strain_energy(*grid(MESH, place(MESH)), element, pull)[0] for element in elements.values()]
        errors = [np.sqrt(max(energy - exact, 0.0) / exact) for energy in found]
        print(f"{name:20}" + "".join(f"{100 * e:9.2f} %{e / errors[0]:7.2f}" for e in errors))
    counts = {key: strain_energy(*grid(2, cook), element, (0.0, 1.0))[1] for key, element in elements.items()}
    print("stress modes of a quadrilateral: " + ", ".join(f"{key} {count}" for key, count in counts.items()))


if __name__ == "__main__":
    main()
