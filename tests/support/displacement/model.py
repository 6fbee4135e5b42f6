"""A small displacement method of its own, P1 or P2 on the mesh of a problem.json, with numpy and scipy alone."""

import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as sla

CORNERS = np.eye(3)
MIDDLES = np.array([[0.0, 0.5, 0.5], [0.5, 0.0, 0.5], [0.5, 0.5, 0.0]])


def lame(kinematics, young, poisson):
    mu = young / (2 * (1 + poisson))
    if kinematics == "plane-strain":
        return young * poisson / ((1 + poisson) * (1 - 2 * poisson)), mu
    return young * poisson / (1 - poisson**2), mu


def shape_gradients(corners, degree, point):
    """Gradients of the shape functions at a point in barycentric coordinates, and the area."""
    edges = np.array([corners[1] - corners[0], corners[2] - corners[0]])
    area = 0.5 * np.linalg.det(edges)
    inner = np.linalg.inv(edges)
    g = np.column_stack([-inner[:, 0] - inner[:, 1], inner[:, 0], inner[:, 1]]).T
    if degree == 1:
        return g, area
    at_corners = [(4 * point[i] - 1) * g[i] for i in range(3)]
    at_middles = [4 * (point[j] * g[k] + point[k] * g[j]) for j, k in ((1, 2), (2, 0), (0, 1))]
    return np.array(at_corners + at_middles), area


class Model:
    """Stiffness, loads, supports and contact of a problem; nodes are its points, then the midpoints of its edges."""

    def __init__(self, problem, degree):
        self.problem, self.degree, self.of_lambda = problem, degree, 1.0
        self.points = np.array(problem["points"], float)
        self.vertices = len(self.points)
        ends = np.array(problem["edges"])
        if degree == 2:
            self.points = np.vstack([self.points, 0.5 * (self.points[ends[:, 0]] + self.points[ends[:, 1]])])
        self.count = len(self.points)
        self.cells = [self.nodes(t) for t in range(len(problem["triangles"]))]

    def nodes(self, triangle):
        corners = list(self.problem["triangles"][triangle])
        edges = [self.vertices + e for e in self.problem["triangle_edges"][triangle]]
        return corners + (edges if self.degree == 2 else [])

    def along(self, edge):
        """The nodes of an edge with the parts of ∫φ that are theirs."""
        ends = list(self.problem["edges"][edge])
        return ends + ([self.vertices + edge] if self.degree == 2 else [])

    def element(self, triangle):
        problem = self.problem
        body = problem["bodies"][problem["body"][triangle]]
        lam, mu = lame(problem["kinematics"], body["young"], body["poisson"])
        lam *= self.of_lambda
        c = np.array([[lam + 2 * mu, lam, 0], [lam, lam + 2 * mu, 0], [0, 0, mu]])
        corners = np.array([problem["points"][v] for v in problem["triangles"][triangle]])
        k = 0
        for point in MIDDLES:
            g, area = shape_gradients(corners, self.degree, point)
            b = np.zeros((3, 2 * len(g)))
            b[0, 0::2], b[1, 1::2] = g[:, 0], g[:, 1]
            b[2, 0::2], b[2, 1::2] = g[:, 1], g[:, 0]
            k = k + problem["thickness"] * area / 3 * b.T @ c @ b
        return k

    def stiffness(self, spoil=None):
        rows, columns, values = [], [], []
        for t, nodes in enumerate(self.cells):
            k = self.element(t)
            if spoil:
                k = spoil(t, k)
            dofs = np.array([[2 * n, 2 * n + 1] for n in nodes]).ravel()
            rows.append(np.repeat(dofs, len(dofs)))
            columns.append(np.tile(dofs, len(dofs)))
            values.append(k.ravel())
        return sp.csr_matrix((np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))))

    def loads(self):
        problem = self.problem
        f = np.zeros((self.count, 2))
        for t, nodes in enumerate(self.cells):
            a, b, c = (np.array(problem["points"][v]) for v in problem["triangles"][t])
            area = 0.5 * ((b - a)[0] * (c - a)[1] - (b - a)[1] * (c - a)[0])
            force = np.array(problem["bodies"][problem["body"][t]]["body_force"]) * problem["thickness"] * area / 3
            for n in nodes[-3:]:
                f[n] += force
        for entry in problem["tractions"]:
            nodes = self.along(entry["edge"])
            pa, pb = (np.array(p) for p in entry["values"])
            part = problem["thickness"] * np.linalg.norm(self.points[nodes[1]] - self.points[nodes[0]])
            # Gauss points of order three.
            for s in (0.5 - 0.5 / 3**0.5, 0.5 + 0.5 / 3**0.5):
                shape = [1 - s, s] if self.degree == 1 else [(1 - s) * (1 - 2 * s), s * (2 * s - 1), 4 * s * (1 - s)]
                for n, phi in zip(nodes, shape):
                    f[n] += 0.5 * part * phi * ((1 - s) * pa + s * pb)
        return f.ravel()

    def held(self):
        """Rows and values of the supports."""
        rows = []
        for entry in self.problem["clamped"]:
            for n in self.along(entry["edge"]):
                for c in entry.get("components", (0, 1)):
                    rows.append(({2 * n + c: 1.0}, entry["displacement"][c]))
        for entry in self.problem["roller"]:
            for n in self.along(entry["edge"]):
                rows.append(({2 * n: entry["normal"][0], 2 * n + 1: entry["normal"][1]}, 0.0))
        for n, c in self.problem.get("points_held", []):
            rows.append(({2 * n + c: 1.0}, 0.0))
        return rows

    def contacts(self):
        """Rows (v' − v'')·n ≤ g at the nodes, with ∫φ ds."""
        rows = {}
        for contact in self.problem["contacts"]:
            for pair in contact["pairs"]:
                (a, b), n = pair["first"], np.array(pair["normal"])
                c, d = pair["second"] or (None, None)
                length = np.linalg.norm(np.array(self.problem["points"][b]) - self.problem["points"][a])
                sites = [(a, c, pair["gap"][0]), (b, d, pair["gap"][1])]
                parts = [0.5, 0.5]
                if self.degree == 2:
                    own, other = (None if e is None else self.vertices + e for e in pair["edges"])
                    sites.append((own, other, 0.5 * sum(pair["gap"])))
                    parts = [1 / 6, 1 / 6, 4 / 6]
                for (first, second, gap), part in zip(sites, parts):
                    row = rows.setdefault((first, second), [{}, gap, 0.0])
                    row[2] += part * length * self.problem["thickness"]
                    for node, sign in ((first, 1.0), (second, -1.0)):
                        if node is not None:
                            row[0].update({2 * node: sign * n[0], 2 * node + 1: sign * n[1]})
        return list(rows.values())

    def matrix(self, rows):
        m = sp.lil_matrix((len(rows), 2 * self.count))
        for i, row in enumerate(rows):
            for dof, value in row.items():
                m[i, dof] = value
        return m.tocsr()

    def solve(self, penalty=None, tied=False, forget=(), spoil=None):
        """Values at the nodes. Contact by an active set, as a penalty for each unit of area, or tied."""
        k, f = self.stiffness(spoil), self.loads()
        held = self.held()
        rows = self.contacts()
        rows = [row for i, row in enumerate(rows) if i not in forget]
        b, gap, weight = self.matrix([r[0] for r in rows]), np.array([r[1] for r in rows]), np.array([r[2] for r in rows])
        if tied:
            across = [{dof + (1 if dof % 2 == 0 else -1): v for dof, v in r[0].items() if v != 0.0} for r in rows]
            held = held + list(zip([r[0] for r in rows], gap)) + [(r, 0.0) for r in across]
        h, prescribed = self.matrix([r[0] for r in held]), np.array([r[1] for r in held])
        free = null_space(h)
        start = particular(h, prescribed)
        closed = np.full(len(rows), not tied)
        for _ in range(200):
            stiff, load = k, f
            if penalty is not None:
                active = sp.diags(penalty * weight * closed)
                stiff, load = k + b.T @ active @ b, f + b.T @ (active @ gap)
            a, r = (free.T @ stiff @ free).tocsc(), free.T @ (load - stiff @ start)
            if penalty is not None or tied:
                u = start + free @ sla.spsolve(a, r)
                now = (b @ u - gap > 0) if penalty is not None else closed
            else:
                bc = (b[closed] @ free).tocsc()
                size = bc.shape[0]
                system = sp.bmat([[a, bc.T], [bc, None]], format="csc")
                found = sla.spsolve(system, np.concatenate([r, (gap[closed] - b[closed] @ start)]))
                u = start + free @ found[: a.shape[0]]
                pressure = np.zeros(len(rows))
                pressure[closed] = found[a.shape[0] : a.shape[0] + size]
                now = (pressure + (b @ u - gap) > 0) if size else (b @ u - gap > 0)
            if (now == closed).all():
                return u.reshape(-1, 2)
            closed = now
        raise RuntimeError("the contact set does not settle")

    def vtk(self, values):
        text = ["# vtk DataFile Version 3.0", "field", "ASCII", "DATASET UNSTRUCTURED_GRID"]
        text.append(f"POINTS {self.count} double")
        text += [f"{x!r} {y!r} 0.0" for x, y in self.points.tolist()]
        size = len(self.cells[0])
        text.append(f"CELLS {len(self.cells)} {len(self.cells) * (size + 1)}")
        for nodes in self.cells:
            # VTK has the middles of (0, 1), (1, 2), (2, 0); here middle i lies opposite corner i.
            order = nodes if size == 3 else [*nodes[:3], nodes[5], nodes[3], nodes[4]]
            text.append(" ".join(map(str, [size, *order])))
        text.append(f"CELL_TYPES {len(self.cells)}")
        text += ["22" if size == 6 else "5"] * len(self.cells)
        text += [f"POINT_DATA {self.count}", "VECTORS displacement double"]
        text += [f"{x!r} {y!r} 0.0" for x, y in np.asarray(values, float).tolist()]
        return "\n".join(text) + "\n"


def null_space(rows):
    """A sparse basis of what rows of one or two entries, each node's own, leave free."""
    n = rows.shape[1]
    columns = []
    by_node = {}
    for i in range(rows.shape[0]):
        row = rows.getrow(i)
        if len({dof // 2 for dof in row.indices}) > 1:
            return general_null_space(rows)
        full = np.zeros(2)
        full[row.indices % 2] = row.data
        by_node.setdefault(row.indices[0] // 2, []).append(full)
    for node in range(n // 2):
        held = np.array(by_node.get(node, np.zeros((1, 2))))
        _, s, v = np.linalg.svd(held)
        rank = int((s > 1e-9).sum())
        columns += [(node, direction) for direction in v[rank:]]
    i, j, x = [], [], []
    for c, (node, direction) in enumerate(columns):
        i += [2 * node, 2 * node + 1]
        j += [c, c]
        x += list(direction)
    return sp.csr_matrix((x, (i, j)), shape=(n, len(columns)))


def general_null_space(rows):
    """As `null_space`, where rows tie nodes: axis-parallel rows alone, one unknown given by the others."""
    n = rows.shape[1]
    value = {}
    for i in range(rows.shape[0]):
        row = rows.getrow(i)
        terms = [(d, x) for d, x in zip(row.indices, row.data) if x != 0.0]
        if len(terms) == 1:
            value[terms[0][0]] = None
    tied = {}
    for i in range(rows.shape[0]):
        row = rows.getrow(i)
        terms = [d for d, x in zip(row.indices, row.data) if x != 0.0]
        if len(terms) == 2:
            a, b = terms
            if a in value:
                value[b] = None
            elif b in value:
                value[a] = None
            else:
                tied[a] = b
    index, i, j, x = {}, [], [], []
    for dof in range(n):
        if dof in value:
            continue
        master = tied.get(dof, dof)
        if master in value:
            continue
        column = index.setdefault(master, len(index))
        i.append(dof), j.append(column), x.append(1.0)
    return sp.csr_matrix((x, (i, j)), shape=(n, len(index)))


def particular(rows, values):
    """A displacement that meets the supports."""
    if not np.any(values):
        return np.zeros(rows.shape[1])
    return sla.lsqr(rows, values, atol=1e-15, btol=1e-15)[0]
