"""The block element as a null space, in numpy: nothing here follows the formulas of the Rust element.

Stresses are linear on each of the three subtriangles and divergence-free: seven parameters each. Continuity of
traction at both ends of the three inner segments is a 12 x 21 matrix; its null space, by SVD, is N(K). Energies are
integrated numerically with a compliance that is the inverse of Hooke's textbook matrix.
"""

import numpy as np

# Rule of degree two: the midpoints of the sides.
MIDPOINTS = np.array([[0.0, 0.5, 0.5], [0.5, 0.0, 0.5], [0.5, 0.5, 0.0]])


def compliance(young, poisson, kinematics):
    """3 x 3 matrix a with a s:s = s @ a @ s for s = (xx, yy, xy): the inverse of Hooke's law for (xx, yy, 2 xy)."""
    if kinematics == "plane-stress":
        hooke = young / (1 - poisson**2) * np.array([[1, poisson, 0], [poisson, 1, 0], [0, 0, (1 - poisson) / 2]])
    else:
        lame = young * poisson / ((1 + poisson) * (1 - 2 * poisson))
        mu = young / (2 * (1 + poisson))
        hooke = np.array([[lame + 2 * mu, lame, 0], [lame, lame + 2 * mu, 0], [0, 0, mu]])
    return np.linalg.inv(hooke)


def area(triangle):
    a, b, c = triangle
    return 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))


def traction_of(normal):
    """2 x 3 matrix from stress to traction."""
    return np.array([[normal[0], 0, normal[1]], [0, normal[1], normal[0]]])


def outward(a, b):
    """Unit normal to the right of the way from a to b."""
    d = b - a
    return np.array([d[1], -d[0]]) / np.hypot(*d)


class Block:
    """One triangle: subtriangle i has the corners a_{i+1}, a_{i+2} and the centroid."""

    def __init__(self, corners, material):
        self.corners = np.asarray(corners, float)
        self.material = material
        self.centre = self.corners.mean(axis=0)
        self.size = np.sqrt(area(self.corners))

    def sub(self, i):
        return np.array([self.corners[(i + 1) % 3], self.corners[(i + 2) % 3], self.centre])

    def stress(self, i, point):
        """3 x 21: stress at a point of subtriangle i from all parameters: airy x^2, y^2, xy, x^3, x^2y, xy^2, y^3."""
        x, y = (np.asarray(point) - self.centre) / self.size
        out = np.zeros((3, 21))
        # (phi_yy, phi_xx, -phi_xy)
        out[:, 7 * i : 7 * i + 7] = [
            [0, 2, 0, 0, 0, 2 * x, 6 * y],
            [2, 0, 0, 6 * x, 2 * y, 0, 0],
            [0, 0, -1, 0, -2 * x, -2 * y, 0],
        ]
        return out

    def continuity(self):
        """12 x 21: jump of traction at the two ends of the segments from the centroid to the corners."""
        rows = []
        for k in range(3):
            t = traction_of(outward(self.centre, self.corners[k]))
            for point in (self.centre, self.corners[k]):
                rows.append(t @ (self.stress((k + 1) % 3, point) - self.stress((k + 2) % 3, point)))
        return np.vstack(rows)

    def side_traction(self):
        """12 x 21: traction at both ends of side 0, 1, 2."""
        rows = []
        for i in range(3):
            a, b = self.corners[(i + 1) % 3], self.corners[(i + 2) % 3]
            rows += [traction_of(outward(a, b)) @ self.stress(i, p) for p in (a, b)]
        return np.vstack(rows)

    def nodes(self):
        """27 x 21: stress at the corners of the subtriangles."""
        return np.vstack([self.stress(i, p) for i in range(3) for p in self.sub(i)])

    def integrate(self, function):
        """Integral of a function of (subtriangle, point) that is quadratic on each subtriangle."""
        total = 0
        for i in range(3):
            sub = self.sub(i)
            total = total + area(sub) / 3 * sum(function(i, w @ sub) for w in MIDPOINTS)
        return total

    def energy(self):
        """21 x 21: integral of a s:s."""
        return self.integrate(lambda i, p: self.stress(i, p).T @ self.material @ self.stress(i, p))

    def balanced(self):
        """21 x 9 basis of N(K), and the singular values of the continuity matrix."""
        _, values, right = np.linalg.svd(self.continuity())
        return right[12:].T, values

    def particular(self, force, point):
        """A stress with divergence -force."""
        x, y = np.asarray(point) - self.centre
        return np.array([-force[0] * x, -force[1] * y, 0])
