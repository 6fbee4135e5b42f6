"""The dual problem as a quadratic program in stresses, in numpy.

Unknown are the 21 parameters of every triangle. All of the paper's conditions are equations or inequalities for
tractions at ends of segments: continuity inside the blocks and between them, loads, rollers, contact. There are no edge
displacements, no condensation and no multipliers to eliminate: the equations are satisfied in their null space, the
contact state is found on the few inequalities and then held against the optimality conditions.
"""

import numpy as np
from scipy.linalg import qr, solve_triangular

from block import Block, compliance, outward, traction_of


class Program:
    """min 1/2 s F s - c s + constant subject to B s = b and A s <= d, where A s - d is the normal traction."""

    def __init__(self, problem):
        self.problem = problem
        points = np.asarray(problem["points"], float)
        bodies = problem["bodies"]
        self.blocks, self.force = [], []
        for corners, number in zip(problem["triangles"], problem["body"]):
            body = bodies[number]
            material = compliance(body["young"], body["poisson"], problem["kinematics"])
            self.blocks.append(Block(points[list(corners)], material))
            self.force.append(np.asarray(body["body_force"], float))
        self.count = 21 * len(self.blocks)
        self.flexibility = np.zeros((self.count, self.count))
        self.linear = np.zeros(self.count)
        self.constant = 0.0
        self.rows, self.right, self.pressing, self.bound = [], [], [], []
        self.assemble(points)

    def columns(self, t):
        return slice(21 * t, 21 * t + 21)

    def traction(self, t, i, vertex, direction):
        """Row and offset of direction . traction on side i of triangle t at one of its ends."""
        block = self.blocks[t]
        corners = list(self.problem["triangles"][t])
        point = block.corners[corners.index(vertex)]
        a, b = block.corners[(i + 1) % 3], block.corners[(i + 2) % 3]
        to = np.asarray(direction) @ traction_of(outward(a, b))
        row = np.zeros(self.count)
        row[self.columns(t)] = to @ block.stress(i, point)
        return row, to @ block.particular(self.force[t], point)

    def equal(self, pairs, value):
        """Sum of the (row, offset) pairs = value."""
        self.rows.append(sum(row for row, _ in pairs))
        self.right.append(value - sum(offset for _, offset in pairs))

    def assemble(self, points):
        for t, (block, force) in enumerate(zip(self.blocks, self.force)):
            c = self.columns(t)
            self.flexibility[c, c] = block.energy()
            self.linear[c] -= block.integrate(
                lambda i, p: block.stress(i, p).T @ block.material @ block.particular(force, p)
            )
            self.constant += 0.5 * block.integrate(
                lambda i, p: block.particular(force, p) @ block.material @ block.particular(force, p)
            )
            for row in block.continuity():
                whole = np.zeros(self.count)
                whole[c] = row
                self.equal([(whole, 0.0)], 0.0)
        sides = {}
        for t, corners in enumerate(self.problem["triangles"]):
            for i in range(3):
                sides.setdefault(frozenset((corners[(i + 1) % 3], corners[(i + 2) % 3])), []).append((t, i))
        x, y = np.eye(2)
        for vertices, condition in zip(self.problem["edges"], self.problem["conditions"]):
            at = sides[frozenset(vertices)]
            (t, i), ends = at[0], list(vertices)
            length = np.hypot(*(points[ends[1]] - points[ends[0]]))
            if condition["kind"] == "interior":
                for v in ends:
                    for d in (x, y):
                        self.equal([self.traction(*side, v, d) for side in at], 0.0)
            elif condition["kind"] == "traction":
                for v, value in zip(ends, condition["values"]):
                    for d in (0, 1):
                        self.equal([self.traction(t, i, v, np.eye(2)[d])], value[d])
            elif condition["kind"] == "clamped":
                for v in ends:
                    row, offset = self.traction(t, i, v, condition["displacement"])
                    self.linear += 0.5 * length * row
                    self.constant -= 0.5 * length * offset
            elif condition["kind"] == "roller":
                corners = self.blocks[t].corners
                tangent = corners[(i + 2) % 3] - corners[(i + 1) % 3]
                for v in ends:
                    self.equal([self.traction(t, i, v, tangent / length)], 0.0)
        for interface in self.problem["interfaces"]:
            for pair in interface["pairs"]:
                self.contact(pair, sides, points)

    def contact(self, pair, sides, points):
        first = list(pair["first"])
        second = list(pair["second"]) if pair["second"] is not None else None
        (t, i) = sides[frozenset(first)][0]
        a, b = points[first[0]], points[first[1]]
        length = np.hypot(*(b - a))
        tangent = (b - a) / length
        corners = self.blocks[t].corners
        normal = outward(corners[(i + 1) % 3], corners[(i + 2) % 3])
        gap = pair["gap"]
        for end in (0, 1):
            row, offset = self.traction(t, i, first[end], normal)
            self.equal([self.traction(t, i, first[end], tangent)], 0.0)
            if second is not None:
                (u, j) = sides[frozenset(second)][0]
                self.equal([self.traction(u, j, second[end], tangent)], 0.0)
                # Action and reaction: n.(T' + T'') = 0.
                self.equal([(row, offset), self.traction(u, j, second[end], normal)], 0.0)
            self.pressing.append(row)
            self.bound.append(-offset)
            # Integral of T_n g for two linear functions.
            weight = length / 6 * (2 * gap[end] + gap[1 - end])
            self.linear += weight * row
            self.constant -= weight * offset

    def solve(self):
        """Parameters, -Pi, and T_n at the two ends of every pair; times the thickness where it is energy."""
        matrix, right = np.array(self.rows), np.array(self.right)
        scale = np.linalg.norm(matrix, axis=1)
        matrix, right = matrix / scale[:, None], right / scale
        # matrix = (kernel triangle)^T with its rows in another order; what depends on others comes last.
        kernel, triangle, order = qr(matrix.T, pivoting=True)
        sizes = np.abs(np.diag(triangle))
        rank = int((sizes > 1e-10 * sizes[0]).sum())
        start = kernel[:, :rank] @ solve_triangular(triangle[:rank, :rank], right[order[:rank]], trans="T")
        assert np.abs(matrix @ start - right).max() < 1e-9 * max(1, np.abs(right).max()), "no equilibrated stress"
        free = kernel[:, rank:]
        hessian = free.T @ self.flexibility @ free
        slope = free.T @ (self.linear - self.flexibility @ start)
        pressing = np.array(self.pressing).reshape(-1, self.count)
        rows, bound = pressing @ free, np.array(self.bound) - pressing @ start
        y = active_set(hessian, slope, rows, bound)
        s = start + free @ y
        energy = -(0.5 * s @ self.flexibility @ s - self.linear @ s + self.constant)
        return s, self.problem["thickness"] * energy, pressing @ s - np.array(self.bound)

    def nodal_stress(self, s):
        """Stress at the nine nodes of every triangle."""
        out = []
        for t, (block, force) in enumerate(zip(self.blocks, self.force)):
            nodes = (block.nodes() @ s[self.columns(t)]).reshape(9, 3)
            offset = [block.particular(force, p) for i in range(3) for p in block.sub(i)]
            out.append(nodes + np.array(offset))
        return np.array(out)


def active_set(hessian, slope, rows, bound):
    """min 1/2 y H y - slope y subject to rows y <= bound; the result satisfies the conditions of optimality."""
    solve = np.linalg.solve
    count = len(bound)
    if count == 0:
        return solve(hessian, slope)
    # In terms of the multipliers z >= 0: y = H^-1 (slope - rows^T z), G z - h >= 0, complementary.
    spread = solve(hessian, rows.T)
    matrix, offset = rows @ spread, rows @ solve(hessian, slope) - bound
    z = nonnegative(matrix, offset)
    y = solve(hessian, slope) - spread @ z
    slack = bound - rows @ y
    size = max(np.abs(bound).max(), np.abs(rows @ solve(hessian, slope)).max())
    assert slack.min() > -1e-9 * size and z.min() >= 0, "inequalities"
    assert np.abs(slack * z).max() < 1e-9 * size * max(z.max(), 1e-300), "complementarity"
    return y


def nonnegative(matrix, offset):
    """z >= 0 with w = matrix z - offset >= 0 and z w = 0, for a positive definite matrix (Lawson and Hanson)."""
    count = len(offset)
    passive = np.zeros(count, bool)
    z = np.zeros(count)
    tiny = 1e-12 * max(1.0, np.abs(offset).max())
    for _ in range(20 * count):
        gradient = np.where(passive, -np.inf, offset - matrix @ z)
        if gradient.max() <= tiny:
            return z
        passive[gradient.argmax()] = True
        while True:
            trial = np.zeros(count)
            trial[passive] = np.linalg.solve(matrix[np.ix_(passive, passive)], offset[passive])
            if trial[passive].min() > 0:
                z = trial
                break
            falling = passive & (trial <= 0)
            step = (z[falling] / (z[falling] - trial[falling])).min()
            z = z + step * (trial - z)
            passive &= z > tiny * 1e-3
            z[~passive] = 0.0
    raise AssertionError("the contact state was not found")
