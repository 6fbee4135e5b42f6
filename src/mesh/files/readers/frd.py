"""Results of CalculiX (.frd), as text or in binary: nodes, cells and the displacement of the last step.

Plane elements that were expanded into space (OUTPUT=3D) are one layer of cells between equal faces, which is undone.
"""

import struct

FRD = {7: ("triangle", 3), 8: ("triangle", 6), 9: ("quadrilateral", 4), 10: ("quadrilateral", 8), 11: ("line", 2), 12: ("line", 3),
       1: ("hexahedron", 8), 2: ("prism", 6), 3: ("tetrahedron", 4), 4: ("hexahedron with 20 nodes", 20), 5: ("prism with 15 nodes", 15),
       6: ("tetrahedron with 10 nodes", 10)}

# Of a cell between two equal faces the shape of a face, and the nodes of both.
FACES = {1: ("quadrilateral", [0, 1, 2, 3], [4, 5, 6, 7]), 2: ("triangle", [0, 1, 2], [3, 4, 5]),
         4: ("quadrilateral", [0, 1, 2, 3, 8, 9, 10, 11], [4, 5, 6, 7, 16, 17, 18, 19]),
         5: ("triangle", [0, 1, 2, 6, 7, 8], [3, 4, 5, 12, 13, 14])}

# Parts of the largest coordinate and of the largest displacement by which the two faces may differ: digits of the file.
SAME_PLACE = 2e-5
SAME_DISPLACEMENT = 1e-4


class Frd:
    """What a file holds: nodes, cells (tag, kind, nodes), and rows of the last displacement."""

    def __init__(self, data):
        self.data, self.at = data, 0
        self.nodes, self.cells, self.values = {}, [], {}
        # How numbers are written: 0 and 1 are text.
        self.form = 1

    def line(self):
        end = self.data.find(b"\n", self.at)
        end = len(self.data) if end < 0 else end
        text = self.data[self.at:end].decode("latin-1").rstrip("\r")
        self.at = end + 1
        return text

    def take(self, form):
        size = struct.calcsize(form)
        row = struct.unpack(form, self.data[self.at:self.at + size])
        self.at += size
        return row

    def peek(self):
        """The first characters of the next line."""
        return self.data[self.at:self.at + 6].decode("latin-1")

    def rows(self, into, count, width):
        """A block of numbers by node, as text or in binary."""
        if self.form >= 2:
            for _ in range(count):
                tag, *row = self.take("<i" + ("d" if self.form == 3 else "f") * width)
                self.once(into, tag)
                into[tag] = row
            return
        end = 13 if self.form == 1 else 8
        while self.peek().startswith(" -1"):
            line = self.line()
            self.once(into, int(line[3:end]))
            into[int(line[3:end])] = frd_reals(line, end, width)
            while self.peek().startswith(" -2"):
                into[int(line[3:end])] += frd_reals(self.line(), end, width)

    def once(self, into, tag):
        if tag in into:
            raise Unreadable(f"node {tag} is given twice in one block")

    def ends(self, what, present):
        """Refuses a block of text that is cut off, or holds other lines."""
        if self.form < 2 and not self.peek().startswith(" -3"):
            raise Unreadable(f"its {what} end with '{self.line()[:40]}' behind {present} rows, and not with -3")

    def elements(self, count):
        if self.form >= 2:
            for _ in range(count):
                tag, kind, _, _ = self.take("<4i")
                self.cells.append((tag, kind, list(self.take(f"<{self.nodes_of(tag, kind)}i"))))
            return
        while self.peek().startswith(" -1"):
            tag, kind = (int(word) for word in self.line()[3:].split()[:2])
            nodes = []
            while len(nodes) < self.nodes_of(tag, kind) and self.peek().startswith(" -2"):
                nodes += [int(word) for word in self.line()[3:].split()]
            self.cells.append((tag, kind, nodes))

    def nodes_of(self, tag, kind):
        if kind not in FRD:
            raise Unreadable(f"element {tag} is of kind {kind}, which CalculiX does not write")
        return FRD[kind][1]

    def read(self):
        count = 0
        while self.at < len(self.data):
            line = self.line()
            key = line[:6].strip()
            words = line.split()
            if key in ("2C", "3C"):
                # The last word of a block says how it is written.
                count, self.form = int(words[1]), int(words[-1]) if len(words) > 2 else 1
                if key == "2C":
                    self.rows(self.nodes, count, 3)
                    self.ends("nodes", len(self.nodes))
                else:
                    self.elements(count)
                    self.ends("elements", len(self.cells))
            elif key.startswith("100C"):
                count, self.form = int(line[24:36]), int(words[-1])
            elif line.startswith(" -4"):
                name, width = line[5:13].strip(), 0
                while self.peek().startswith(" -5"):
                    component = self.line()
                    width += 0 if component.rstrip().endswith("ALL") else 1
                into = {}
                self.rows(into, count, width)
                self.ends(f"values of {name}", len(into))
                if name == "DISP":
                    self.values = into
        return self


def frd_reals(line, start, count):
    return [real(line[start + 12 * i:start + 12 * i + 12]) for i in range(count) if line[start + 12 * i:start + 12 * i + 12].strip()]


def frd_flat(frd):
    """The cells of one layer between equal faces as those of a face; nothing where they are none."""
    flat, middle = [], {}
    size = max((abs(x) for row in frd.nodes.values() for x in row), default=0.0)
    moved = max((abs(x) for row in frd.values.values() for x in row[:2]), default=0.0)
    heights = [set(), set()]
    for tag, kind, nodes in frd.cells:
        if kind not in FACES or not all(node in frd.nodes for node in nodes):
            return None
        shape, *faces = FACES[kind]
        sides = [[nodes[i] for i in face] for face in faces]
        for low, high in zip(*sides):
            p, q = frd.nodes[low], frd.nodes[high]
            if max(abs(p[0] - q[0]), abs(p[1] - q[1])) > SAME_PLACE * size:
                return None
            heights[0].add(p[2])
            heights[1].add(q[2])
            u, v = frd.values.get(low), frd.values.get(high)
            if u and v and max(abs(u[0] - v[0]), abs(u[1] - v[1])) > SAME_DISPLACEMENT * moved:
                raise Unreadable(f"nodes {low} and {high} lie on the two faces of one layer of cells and move differently, which is no plane state")
            if u and v:
                # In plane stress the faces move apart; between them nothing moves out of the plane.
                across = 0.5 * (u[2] + v[2])
                middle[low] = [u[0], u[1], across if abs(across) > SAME_DISPLACEMENT * moved else 0.0]
        flat.append((tag, shape, sides[0]))
    spread = max((max(at) - min(at) for at in heights), default=0.0)
    if not flat or spread > SAME_PLACE * size:
        return None
    frd.values.update(middle)
    return flat


def frd_is_turned(frd):
    """Whether the cells are a wedge about the axis y, which is what is made of axisymmetric elements."""
    if not frd.cells or not all(kind in FACES and all(node in frd.nodes for node in nodes) for _, kind, nodes in frd.cells):
        return False
    faces = [([frd.nodes[nodes[i]] for i in low], [frd.nodes[nodes[i]] for i in high]) for _, kind, nodes in frd.cells for _, low, high in [FACES[kind]]]
    radius, height = max((max((p[0], abs(p[2])) for p in low) for low, _ in faces))
    same = lambda a, b: abs(a - b) <= SAME_PLACE * max(radius, 1e-300)
    return height > 0 and all(same(p[0], q[0]) and same(p[2], -q[2]) and same(abs(p[2]) * radius, p[0] * height)
                              for low, high in faces for p, q in zip(low, high))


def read_frd(source):
    frd = Frd(content_of(source))
    try:
        frd.read()
    except (Unreadable, ValueError, IndexError):
        if frd.form < 2:
            Lines.last = source, frd.data.count(b"\n", 0, frd.at)
        raise
    if not frd.nodes:
        raise Unreadable("it has no block of nodes (2C), which CalculiX writes where the deck asks for `*NODE FILE` and U")
    found = Found("CalculiX")
    flat = frd_flat(frd)
    if flat is None and frd_is_turned(frd):
        raise Unreadable("its cells are the wedge in space that CalculiX makes of axisymmetric elements: write it with `*NODE FILE, OUTPUT=2D`")
    cells = flat or [(tag, FRD[kind][0], nodes) for tag, kind, nodes in frd.cells]
    kept = {node for _, _, nodes in flat for node in nodes} if flat else frd.nodes
    for tag, row in frd.nodes.items():
        if tag in kept:
            found.point(tag, [*row[:2], 0.0] if flat else row)
    for tag, shape, nodes in cells:
        found.cell(shape, nodes, (), tag)
    # Nodes without a result, such as those of springs, are told as such.
    nothing = [float("nan")] * 3
    if frd.values:
        found.fields["displacement"] = [frd.values.get(tag, nothing) for tag in found.index]
        found.single = frd.form == 2
    return found
