"""Random scenes of blocks with quantities: what `hypercircle solve` says of each, beside a linear program over all equilibria.

    one_value.py HYPERCIRCLE SEED COUNT [FOLDER]

Bodies deform, so that the resultants which contacts and supports can carry are all those that balance every body. On straight edges
they are those of forces at the two ends, and at the places where a window bends: pressures that do not pull, anything at a clamp,
normal forces at a roller. The least and the largest value of a quantity over them come from HiGHS; nothing of the program is used.

 - A scene is refused (exit code 5) where and only where there is no equilibrium.
 - A quantity is `exact_by_statics` only where the ends of its interval agree to rounding and the linear program has one value, that one.
 - Every interval has a value in common with what statics allow.

A line is printed for each violation, and a last one with counts. Exit code 1 if anything is wrong.
"""

import json
import math
import random
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from scipy.optimize import linprog

# Relative to the forces in the scene: what HiGHS leaves, and what rounding leaves.
SOLVED = 1e-6
ROUNDED = 1e-9


class Scene:
    """A lattice of quadrilateral blocks with what holds and loads them."""

    def __init__(self, seed):
        self.random = random.Random(seed)
        r = self.random
        columns, rows = r.choice([(1, 1), (2, 1), (1, 2), (3, 1), (2, 2), (1, 3), (3, 2)])
        skew = r.choice([0.0, 0.0, 0.25])
        grid = {
            (i, j): (1.0 * i + r.uniform(-skew, skew), 0.8 * j + r.uniform(-skew, skew))
            for i in range(columns + 1)
            for j in range(rows + 1)
        }
        self.bodies, self.force, self.tractions = {}, {}, []
        self.supports, self.contacts, self.rigid = [], [], []
        heavy = r.random() < 0.6
        for i in range(columns):
            for j in range(rows):
                if len(self.bodies) > 1 and r.random() < 0.1:
                    continue
                name = f"b{i}{j}"
                self.bodies[name] = [grid[i, j], grid[i + 1, j], grid[i + 1, j + 1], grid[i, j + 1]]
                self.force[name] = (0.0, -r.uniform(0.5, 2.0)) if heavy else (0.0, 0.0)
        for i in range(columns):
            for j in range(rows):
                if f"b{i}{j}" not in self.bodies:
                    continue
                self.side(i, j, 1, (i + 1, j, 3), "right")
                self.side(i, j, 2, (i, j + 1, 0), "top")
                if f"b{i - 1}{j}" not in self.bodies:
                    self.outer(f"b{i}{j}", 3, "left")
                if f"b{i}{j - 1}" not in self.bodies:
                    self.outer(f"b{i}{j}", 0, "bottom" if j == 0 else "under")
        self.quantities = []
        self.ask()

    def side(self, i, j, edge, other, where):
        own, next_to = f"b{i}{j}", f"b{other[0]}{other[1]}"
        if next_to in self.bodies:
            # Between two blocks: contact, or sides that pass each other.
            if self.random.random() < 0.85:
                self.contacts.append(((own, edge), (next_to, other[2])))
        else:
            self.outer(own, edge, where)

    def outer(self, body, edge, where):
        """Adds a support or load of a side at the outline."""
        r, at = self.random, (body, edge)
        p = r.random()
        if where == "bottom":
            if p < 0.35:
                self.supports.append((at, "clamped"))
            elif p < 0.5:
                self.supports.append((at, "roller"))
            elif p < 0.9:
                self.rigid.append(at)
        elif where in ("left", "right"):
            if p < 0.15:
                self.supports.append((at, r.choice(["clamped", "roller"])))
            elif p < 0.5:
                self.rigid.append(at)
            elif p < 0.75:
                self.load(at)
        elif where == "top" and p < 0.7:
            self.load(at)

    def load(self, at):
        r = self.random
        a, b = self.ends(at)
        n = normal(a, b)
        p, q = r.uniform(0.2, 2.0), r.choice([0.0, 0.0, r.uniform(-0.5, 0.5)])
        t = (-p * n[0] - q * n[1], -p * n[1] + q * n[0])
        gradient = r.choice([((0, 0), (0, 0)), ((0, r.uniform(-1, 1)), (0, 0)), ((0, 0), (r.uniform(-1, 1), 0))])
        self.tractions.append((at, t, gradient))

    def ends(self, at):
        points = self.bodies[at[0]]
        return points[at[1]], points[(at[1] + 1) % 4]

    def forces(self):
        """The size of all forces."""
        sum = 1e-30
        for name, points in self.bodies.items():
            sum += area(points) * math.hypot(*self.force[name])
        for at, t, g in self.tractions:
            a, b = self.ends(at)
            sum += length(a, b) * max(math.hypot(*traction(t, g, x)) for x in (a, b))
        return sum

    def ask(self):
        r = self.random
        sides = [(first, second) for first, second in self.contacts] + [(at, None) for at in self.rigid]
        for k, (first, second) in enumerate(sides):
            a, b = sorted(self.ends(first))
            l = length(a, b)
            self.quantities.append(Quantity(f"contact{k}", "force", (first, second), None, None))
            if r.random() < 0.3:
                s = sorted(r.sample([0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875], 4))
                self.quantities.append(Quantity(f"window{k}", "force", (first, second), [x * l for x in s], None))
            if r.random() < 0.3:
                about = [r.uniform(-1, 2), r.uniform(-1, 2)]
                self.quantities.append(Quantity(f"turn{k}", "moment", (first, second), None, about))
        for k, (at, _) in enumerate(self.supports):
            d = r.choice([[1.0, 0.0], [0.0, 1.0], [0.6, 0.8]])
            self.quantities.append(Quantity(f"support{k}", "force", (at, "support"), None, d))
            if r.random() < 0.3:
                self.quantities.append(Quantity(f"moment{k}", "moment", (at, "support"), None, [r.uniform(-1, 2), 0.0]))
        r.shuffle(self.quantities)
        del self.quantities[4:]

    def toml(self, size):
        out = ['[model]\nkinematics = "plane-strain"\n[geometry]\nsize = %r\n' % size]
        for name, points in self.bodies.items():
            edges = [edge_name((name, e)) for e in range(4)]
            used = {edge_name(at) for at in self.named()}
            edges = [e if e in used else "" for e in edges]
            out.append(f"[[geometry.polygons]]\nbody = {name!r}\npoints = {[list(p) for p in points]}\nedges = {edges}\n")
        for k, (name, f) in enumerate(self.force.items()):
            out.append(f"[bodies.{name}]\nyoung = {[1000.0, 3000.0, 500.0][k % 3]}\npoisson = 0.3\nbody_force = {list(f)}\n")
        for at, kind in self.supports:
            out.append(f"[[supports]]\non = '{edge_name(at)}'\ntype = '{kind}'\n")
        for at, t, g in self.tractions:
            out.append(f"[[tractions]]\non = '{edge_name(at)}'\nvalue = {list(t)}\ngradient = {[list(x) for x in g]}\n")
        for first, second in self.contacts:
            out.append(f"[[contacts]]\nbetween = ['{edge_name(first)}', '{edge_name(second)}']\n")
        for at in self.rigid:
            out.append(f"[[contacts]]\non = '{edge_name(at)}'\n")
        for q in self.quantities:
            out.append(q.toml())
        return "".join(out)

    def named(self):
        for first, second in self.contacts:
            yield first
            yield second
        yield from self.rigid
        for at, *_ in self.supports + self.tractions:
            yield at


class Quantity:
    def __init__(self, name, kind, of, window, extra):
        self.name, self.kind, self.of, self.window, self.extra = name, kind, of, window, extra

    def is_support(self):
        return self.of[1] == "support"

    def toml(self):
        first, second = self.of
        target = edge_name(first)
        if not self.is_support():
            target += "|" + (edge_name(second) if second else "rigid")
        out = f"[[quantities]]\nname = '{self.name}'\n{self.kind} = '{target}'\n"
        if self.window:
            out += f"window = {self.window}\n"
        if self.kind == "moment":
            out += f"about = {self.extra}\n"
        elif self.is_support():
            out += f"direction = {self.extra}\n"
        return out

    def weight(self, s):
        if not self.window:
            return 1.0
        a, b, c, d = self.window
        rise = (s - a) / (b - a)
        fall = (d - s) / (d - c)
        return min(max(min(rise, fall), 0.0), 1.0)


def edge_name(at):
    return f"{at[0]}e{at[1]}"


def length(a, b):
    return math.hypot(b[0] - a[0], b[1] - a[1])


def normal(a, b):
    """Outwards: bodies run counter-clockwise."""
    l = length(a, b)
    return ((b[1] - a[1]) / l, -(b[0] - a[0]) / l)


def area(points):
    return 0.5 * sum(cross(points[i - 1], points[i]) for i in range(len(points)))


def cross(a, b):
    return a[0] * b[1] - a[1] * b[0]


def traction(t, g, x):
    return [t[c] + g[c][0] * x[0] + g[c][1] * x[1] for c in (0, 1)]


class Program:
    """The linear program over all equilibria of a scene."""

    def __init__(self, scene):
        self.scene = scene
        self.row = {name: 3 * k for k, name in enumerate(scene.bodies)}
        self.columns, self.free, self.tags = [], [], []
        for of in [(f, s) for f, s in scene.contacts] + [(at, None) for at in scene.rigid]:
            a, b = scene.ends(of[0])
            n = normal(a, b)
            low, high = sorted((a, b))
            l = length(a, b)
            bends = [s for q in scene.quantities if q.of == of and q.window for s in q.window]
            for s in [0.0, l] + bends:
                x = [low[c] + s / l * (high[c] - low[c]) for c in (0, 1)]
                # On the first side along −n.
                self.add({of[0][0]: (-n[0], -n[1]), **({of[1][0]: n} if of[1] else {})}, x, False, (of, s, x, n))
        for at, kind in scene.supports:
            a, b = scene.ends(at)
            n = normal(a, b)
            for x in (a, b):
                for d in [n] if kind == "roller" else [(1.0, 0.0), (0.0, 1.0)]:
                    self.add({at[0]: d}, x, True, ((at, "support"), None, x, d))
        self.matrix = np.array(self.columns).T if self.columns else np.zeros((3 * len(self.row), 0))
        self.load = self.loads()
        self.size = scene.forces()

    def add(self, on, x, free, tag):
        column = np.zeros(3 * len(self.row))
        for body, f in on.items():
            column[self.row[body] : self.row[body] + 3] = [f[0], f[1], cross(x, f)]
        self.columns.append(column)
        self.free.append(free)
        self.tags.append(tag)

    def loads(self):
        scene, load = self.scene, np.zeros(3 * len(self.row))
        for name, points in scene.bodies.items():
            f, r = scene.force[name], self.row[name]
            whole, first = area(points), [0.0, 0.0]
            for i in range(len(points)):
                p, q = points[i - 1], points[i]
                for c in (0, 1):
                    first[c] += cross(p, q) * (p[c] + q[c]) / 6
            load[r : r + 3] += [whole * f[0], whole * f[1], cross(first, f)]
        for at, t, g in scene.tractions:
            (a, b), r = scene.ends(at), self.row[at[0]]
            l = length(a, b)
            for s, w in [(0.0, 1 / 6), (0.5, 4 / 6), (1.0, 1 / 6)]:
                x = [a[c] + s * (b[c] - a[c]) for c in (0, 1)]
                p = traction(t, g, x)
                load[r : r + 3] += [l * w * p[0], l * w * p[1], l * w * cross(x, p)]
        return load

    def solve(self, cost):
        bounds = [(None, None) if free else (0.0, None) for free in self.free]
        scaled = -self.load / self.size
        if not self.columns:
            return 2, None
        # Its presolve ends the process on some of these.
        result = linprog(cost, A_eq=self.matrix, b_eq=scaled, bounds=bounds, method="highs-ds", options={"presolve": False})
        return result.status, result.fun

    def has_equilibrium(self):
        return self.solve(np.zeros(len(self.columns)))[0] == 0

    def range(self, quantity):
        cost = np.zeros(len(self.columns))
        for k, (of, s, x, d) in enumerate(self.tags):
            if of != quantity.of:
                continue
            if quantity.kind == "moment":
                arm = [x[c] - quantity.extra[c] for c in (0, 1)]
                # On the first side; that of a support on the body.
                cost[k] = cross(arm, d if quantity.is_support() else (-d[0], -d[1]))
            elif quantity.is_support():
                cost[k] = d[0] * quantity.extra[0] + d[1] * quantity.extra[1]
            else:
                cost[k] = quantity.weight(s)
        out = []
        for sign in (1, -1):
            status, value = self.solve(sign * cost)
            out.append(sign * value * self.size if status == 0 else -sign * math.inf)
        return out


def main(program, first, count, folder):
    scenes = {}
    for seed in range(first, first + count):
        scene = Scene(seed)
        if not scene.quantities:
            continue
        scenes[f"s{seed}"] = scene
        (folder / f"s{seed}.toml").write_text(scene.toml(random.Random(-seed).choice([0.9, 0.5])))
    command = [program, "solve", str(folder), "--jobs", "2", "--quiet", "--threads", "1", "--out", str(folder / "out")]
    subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False)
    counts = dict(scenes=0, refused=0, quantities=0, exact=0, one_value=0, bounded=0, narrower=0)
    wrong = []
    for name, scene in scenes.items():
        path = folder / "out" / name / "report.json"
        if not path.exists():
            wrong.append(f"{name}: there is no report")
            continue
        report = json.loads(path.read_text())
        statics = Program(scene)
        possible = statics.has_equilibrium()
        counts["scenes"] += 1
        if report["status"] == "infeasible" or not possible:
            counts["refused"] += 1
            if (report["status"] == "infeasible") == possible:
                wrong.append(f"{name}: {report['status']}, though a linear program says that equilibrium is {possible}")
            continue
        for quantity, found in zip(scene.quantities, report["quantities"]):
            counts["quantities"] += 1
            low, high = statics.range(quantity)
            arm = 1.0 if quantity.kind == "force" else 1 + max(math.hypot(p[0], p[1]) for p in sum(scene.bodies.values(), []))
            size = statics.size * arm
            lower, upper = found["lower"], found["upper"]
            lower, upper = -math.inf if lower is None else lower, math.inf if upper is None else upper
            one = high - low <= SOLVED * size
            counts["one_value"] += one
            counts["bounded"] += math.isfinite(high - low)
            counts["narrower"] += (low > lower + SOLVED * size) or (high < upper - SOLVED * size)
            said = f"{name}: {found['name']} in [{lower}, {upper}], statics allow [{low}, {high}]"
            if found["exact_by_statics"]:
                counts["exact"] += 1
                if not one or abs(low - lower) > SOLVED * size:
                    wrong.append(f"{said}, exact by statics")
                if upper - lower > ROUNDED * max(abs(lower), abs(upper), 1e-3 * size):
                    wrong.append(f"{said}, exact by statics with ends that differ")
            if lower > high + SOLVED * size or upper < low - SOLVED * size:
                wrong.append(f"{said}: nothing in common")
    for line in wrong:
        print(line)
    print(", ".join(f"{value} {key}" for key, value in counts.items()))
    return 1 if wrong else 0


if __name__ == "__main__":
    program, first, count, *kept = sys.argv[1:]
    if kept:
        Path(kept[0]).mkdir(parents=True, exist_ok=True)
        sys.exit(main(program, int(first), int(count), Path(kept[0])))
    with tempfile.TemporaryDirectory() as folder:
        sys.exit(main(program, int(first), int(count), Path(folder)))
