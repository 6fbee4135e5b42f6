"""Displacement elements of the textbooks in NumPy, with mistakes that can be planted; nothing of the program's is used.

Corners run counter-clockwise, then come the middles of the sides. Triangles have the local coordinates (ξ, η) from their first corner,
quadrilaterals those of [−1, 1]².
"""

import numpy as np

G = 1 / np.sqrt(3)
TRIANGLE = [(1 / 6, 1 / 6, 1 / 6), (2 / 3, 1 / 6, 1 / 6), (1 / 6, 2 / 3, 1 / 6)]
SIGNS = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])


def gauss(n):
    """(ξ, η, weight) of n × n points, first ξ."""
    x, w = np.polynomial.legendre.leggauss(n)
    return [(a, b, v * u) for b, u in zip(x, w) for a, v in zip(x, w)]


RULES = {"T3": [(1 / 3, 1 / 3, 0.5)], "T6": TRIANGLE, "Q4": gauss(2), "Q8": gauss(3)}
REFERENCE = {
    "T3": np.array([[0, 0], [1, 0], [0, 1]], float),
    "T6": np.array([[0, 0], [1, 0], [0, 1], [0.5, 0], [0.5, 0.5], [0, 0.5]]),
    "Q4": SIGNS.astype(float),
    "Q8": np.array([[-1, -1], [1, -1], [1, 1], [-1, 1], [0, -1], [1, 0], [0, 1], [-1, 0]], float),
}


def slopes(kind, xi, eta):
    """∂N/∂(ξ, η), a row a node."""
    if kind == "T3":
        return np.array([[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]])
    if kind == "T6":
        l = [1 - xi - eta, xi, eta]
        d = np.array([[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]])
        corners = [(4 * l[i] - 1) * d[i] for i in range(3)]
        return np.array(corners + [4 * (l[i] * d[j] + l[j] * d[i]) for i, j in [(0, 1), (1, 2), (2, 0)]])
    if kind == "Q4":
        return np.array([[a * (1 + b * eta), b * (1 + a * xi)] for a, b in SIGNS]) / 4
    corners = [
        [a * (1 + b * eta) * (2 * a * xi + b * eta) / 4, b * (1 + a * xi) * (2 * b * eta + a * xi) / 4] for a, b in SIGNS
    ]
    along = lambda b: [-xi * (1 + b * eta), b * (1 - xi * xi) / 2]
    across = lambda a: [a * (1 - eta * eta) / 2, -eta * (1 + a * xi)]
    return np.array([*corners, along(-1), across(1), along(1), across(-1)])


def corners_of(kind, seed):
    """Corners without symmetry, turned against the axes, of no special area."""
    random = np.random.default_rng(seed)
    shape = [[0, 0], [1, 0], [1, 1], [0, 1]] if kind[0] == "Q" else [[0, 0], [1, 0], [0.3, 0.9]]
    moved = np.array(shape) + random.uniform(-0.15, 0.15, (len(shape), 2))
    angle, size = random.uniform(0.2, 1.3), random.uniform(0.7, 2.5)
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    return size * moved @ turn.T + random.uniform(-2, 2, 2)


def nodes_of(kind, corners):
    if kind in ("T3", "Q4"):
        return corners
    return np.vstack([corners, (corners + np.roll(corners, -1, axis=0)) / 2])


def elastic(young, poisson, state="plane-strain"):
    """Hooke's law of (xx, yy, γ)."""
    if state == "plane-stress":
        return young / (1 - poisson**2) * np.array([[1, poisson, 0], [poisson, 1, 0], [0, 0, (1 - poisson) / 2]])
    c = young / ((1 + poisson) * (1 - 2 * poisson))
    return c * np.array([[1 - poisson, poisson, 0], [poisson, 1 - poisson, 0], [0, 0, 0.5 - poisson]])


def strains(gradients):
    b = np.zeros((3, 2 * len(gradients)))
    b[0, ::2] = b[2, 1::2] = gradients[:, 0]
    b[1, 1::2] = b[2, ::2] = gradients[:, 1]
    return b


class Element:
    """`stiffness(nodes, young, poisson)`; every argument plants one mistake."""

    def __init__(
        self,
        kind,
        state="plane-strain",
        rule=None,
        weights=None,
        measure=lambda det, middle: det,
        hooke=None,
        shear_rule=None,
        local=lambda xi, eta, slopes: slopes,
        in_jacobian=False,
        gradients=lambda gradients: gradients,
        transposed=False,
        nodes=lambda nodes: nodes,
        after=lambda k, nodes: k,
        modes=None,
        b_bar=None,
    ):
        self.__dict__.update({name: value for name, value in locals().items() if name != "self"})
        self.rule = rule or RULES[kind]

    def point(self, nodes, xi, eta):
        """B, det J and J⁻¹ at a point."""
        right = slopes(self.kind, xi, eta)
        wrong = self.local(xi, eta, right.copy())
        jacobian = nodes.T @ (wrong if self.in_jacobian else right)
        inverse = np.linalg.inv(jacobian)
        gradients = self.gradients(wrong @ (inverse.T if self.transposed else inverse))
        return strains(gradients), abs(np.linalg.det(jacobian)), jacobian

    def stiffness(self, nodes, young, poisson):
        given, nodes = nodes, self.nodes(np.asarray(nodes, float))
        d = (self.hooke or (lambda e, v: elastic(e, v, self.state)))(young, poisson)
        middle = (0, 0) if self.kind[0] == "Q" else (1 / 3, 1 / 3)
        b_middle, det_middle, j_middle = self.point(nodes, *middle)
        n = 2 * len(nodes)
        uu, ua, aa = np.zeros((n, n)), np.zeros((n, 4)), np.zeros((4, 4))
        parts = [(self.rule, d)]
        if self.shear_rule:
            only = np.diag([0, 0, d[2, 2]])
            parts = [(self.rule, d - only), (self.shear_rule, only)]
        for rule, d in parts:
            for i, (xi, eta, weight) in enumerate(rule):
                b, det, jacobian = self.point(nodes, xi, eta)
                w = weight * self.measure(det, det_middle) * (1 if self.weights is None else self.weights[i])
                if self.b_bar:
                    uu += w * self.dilated(b, b_middle, d)
                    continue
                uu += w * b.T @ d @ b
                if self.modes:
                    own = self.modes(xi, eta, jacobian, j_middle)
                    ua += w * b.T @ d @ own
                    aa += w * own.T @ d @ own
        if self.modes:
            uu -= ua @ np.linalg.solve(aa, ua.T)
        return self.after(uu, np.asarray(given, float))

    def dilated(self, b, b_middle, d):
        """B-bar with parts of the missing volume change in xx, yy and zz."""
        trace = lambda b: b[0] + b[1]
        solid = np.zeros((4, 4))
        solid[:3, :3] = d
        solid[3, :2] = solid[:2, 3] = d[0, 1]
        solid[3, 3] = d[0, 0]
        bar = np.vstack([b, np.zeros(b.shape[1])])
        for row, part in zip((0, 1, 3), self.b_bar):
            bar[row] += part * (trace(b_middle) - trace(b))
        return bar.T @ solid @ bar


def incompatible(taylor):
    """The strains of the modes 1 − ξ² and 1 − η² of Wilson."""

    def modes(xi, eta, jacobian, middle):
        at = middle if taylor else jacobian
        ratio = np.linalg.det(middle) / np.linalg.det(jacobian) if taylor else 1
        return ratio * strains(np.array([[-2 * xi, 0], [0, -2 * eta]]) @ np.linalg.inv(at))

    return modes
