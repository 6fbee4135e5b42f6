"""VTK's older files (.vtk), as text and binary: unstructured grids and polygons with all that may stand beside them. Structured grids are meshio's."""

import urllib.parse

# Types of numbers by the names of VTK.
VTK_NUMBERS = {"bit": "u1", "unsigned_char": "u1", "char": "i1", "signed_char": "i1", "unsigned_short": "u2", "short": "i2", "unsigned_int": "u4", "int": "i4",
               "unsigned_long": "u8", "long": "i8", "vtkidtype": "i8", "float": "f4", "double": "f8", "vtktypeint64": "i8", "vtktypeuint64": "u8", "vtktypeint32": "i4",
               "vtktypeuint32": "u4", "vtktypeint16": "i2", "vtktypeuint16": "u2", "vtktypeint8": "i1", "vtktypeuint8": "u1", "vtktypefloat64": "f8", "vtktypefloat32": "f4"}
# Names of meshio by VTK's number of a cell and its number of nodes.
VTK_CELLS = {(3, 2): "line", (4, 2): "line", (5, 3): "triangle", (7, 3): "triangle", (7, 4): "quad", (8, 4): "pixel", (9, 4): "quad", (10, 4): "tetra",
             (12, 8): "hexahedron", (13, 6): "wedge", (14, 5): "pyramid", (21, 3): "line3", (22, 6): "triangle6", (23, 8): "quad8", (28, 9): "quad9", (68, 2): "line",
             (68, 3): "line3", (69, 3): "triangle", (69, 6): "triangle6", (70, 4): "quad", (70, 9): "quad9"}
# Cells of polygons, by section, in the order in which VTK counts them.
VTK_POLYGONS = {"VERTICES": 2, "LINES": 4, "POLYGONS": 7, "TRIANGLE_STRIPS": 6}
# Numbers of a row of arrays with a name and a type.
VTK_ROWS = {"VECTORS": 3, "NORMALS": 3, "TENSORS": 9, "TENSORS6": 6, "GLOBAL_IDS": 1, "PEDIGREE_IDS": 1, "EDGE_FLAGS": 1}


class VtkText:
    """The rest of a file."""

    def __init__(self, data):
        self.data, self.at, self.binary = data, 0, False

    def line(self):
        """The next line that is not empty, nothing at the end."""
        while self.at < len(self.data):
            end = self.data.find(b"\n", self.at)
            end = len(self.data) if end < 0 else end
            line, self.at = self.data[self.at:end].decode("latin-1").strip(), end + 1
            if line:
                return line
        return None

    def words(self):
        """The words of the next line, without going on."""
        at = self.at
        line = self.line()
        self.at = at
        return (line or "").split()

    def numbers(self, kind, count):
        import numpy

        kind = kind.lower()
        if kind == "string":
            return self.strings(count)
        if kind not in VTK_NUMBERS:
            raise Unreadable(f"it has numbers of the type '{kind}', which is not known")
        if count < 0 or count > len(self.data):
            raise Unreadable(f"it announces {count} numbers, and has fewer")
        if self.binary:
            kind = numpy.dtype(">" + VTK_NUMBERS[kind])
            rest = self.data[self.at:self.at + count * kind.itemsize]
            if len(rest) < count * kind.itemsize:
                raise Unreadable("it is cut off")
            self.at += len(rest)
            return numpy.frombuffer(rest, kind).astype(kind.newbyteorder("="))
        found = []
        for match in re.compile(rb"\S+").finditer(self.data, self.at):
            if len(found) == count:
                break
            found.append(match[0])
            self.at = match.end()
        if len(found) < count:
            raise Unreadable("it is cut off")
        return numpy.array([float(word) if VTK_NUMBERS[kind][0] == "f" else int(word) for word in found], dtype=VTK_NUMBERS[kind])

    def strings(self, count):
        """Passes over texts, whose length stands before each in a binary file."""
        for _ in range(count):
            if not self.binary:
                end = self.data.find(b"\n", self.at)
                self.at = len(self.data) if end < 0 else end + 1
                continue
            size = {3: 1, 2: 2, 1: 4, 0: 8}[self.data[self.at] >> 6]
            length = int.from_bytes(self.data[self.at:self.at + size], "big") & ((1 << (8 * size - 2)) - 1)
            self.at += size + length
        return None

    def cells(self, words):
        """Nodes of the cells of a section: behind offsets, or each behind its number of nodes."""
        if self.words()[:1] == ["OFFSETS"]:
            offsets = self.numbers(self.line().split()[1], int(words[1]))
            nodes = self.numbers(self.line().split()[1], int(words[2]))
            return [nodes[a:b].tolist() for a, b in zip(offsets, offsets[1:])]
        rows, found, at = self.numbers("int", int(words[2])).tolist(), [], 0
        for _ in range(int(words[1])):
            found.append(rows[at + 1:at + 1 + rows[at]])
            at += 1 + rows[at]
        return found


def read_legacy_vtk(source):
    """A mesh of meshio's with arrays of points and cells; nothing of structured grids, and of what is no such file."""
    import meshio
    import numpy

    text = VtkText(content_of(source))
    head = [text.line() for _ in range(2)]
    form, kind = text.line() or "", (text.line() or "").split()
    if not re.match(r"# vtk DataFile", head[0] or "", re.IGNORECASE) or kind[:1] != ["DATASET"] or kind[1:] not in (["UNSTRUCTURED_GRID"], ["POLYDATA"]):
        return None
    text.binary = form.upper() == "BINARY"
    points, cells, types, polygons, data, rows = None, [], None, {}, {}, 0
    current = None
    while True:
        line = text.line()
        if line is None:
            break
        words = line.split()
        key = words[0].upper()
        if key == "POINTS":
            points = text.numbers(words[2], 3 * int(words[1])).reshape(-1, 3)
        elif key == "CELLS":
            cells = text.cells(words)
        elif key == "CELL_TYPES":
            types = text.numbers("int", int(words[1])).tolist()
        elif key in VTK_POLYGONS:
            polygons[key] = text.cells(words)
        elif key in ("CELL_DATA", "POINT_DATA"):
            current, rows = data.setdefault(key, {}), int(words[1])
        elif key == "METADATA":
            while text.at < len(text.data) and not re.match(rb"[ \t\r]*\n", text.data[text.at:text.at + 100]):
                end = text.data.find(b"\n", text.at)
                text.at = len(text.data) if end < 0 else end + 1
        elif key == "FIELD":
            for _ in range(int(words[2])):
                name, width, count, of = text.line().rsplit(None, 3)
                values = text.numbers(of, int(width) * int(count))
                if current is not None and values is not None and int(count) == rows:
                    current[name] = values.reshape(rows, -1)
        elif key == "SCALARS":
            width = int(words[3]) if len(words) > 3 else 1
            if text.words()[:1] == ["LOOKUP_TABLE"]:
                text.line()
            current[words[1]] = text.numbers(words[2], width * rows).reshape(rows, -1)
        elif key == "COLOR_SCALARS":
            text.numbers("unsigned_char" if text.binary else "float", int(words[2]) * rows)
        elif key == "LOOKUP_TABLE":
            text.numbers("unsigned_char" if text.binary else "float", 4 * int(words[2]))
        elif key == "TEXTURE_COORDINATES":
            text.numbers(words[3], int(words[2]) * rows)
        elif key in VTK_ROWS:
            current[words[1]] = text.numbers(words[2], VTK_ROWS[key] * rows).reshape(rows, -1)
        else:
            raise Unreadable(f"'{line[:60]}' stands where a section such as POINTS or CELL_DATA is expected")
    if polygons:
        cells = [nodes for key in VTK_POLYGONS for nodes in polygons.get(key, [])]
        types = [kind for key, kind in VTK_POLYGONS.items() for _ in polygons.get(key, [])]
    if points is None or types is None or len(types) != len(cells):
        raise Unreadable("it has no points, or cells without a type")
    return vtk_mesh(meshio, numpy, points, list(zip(types, cells)), data)


def vtk_mesh(meshio, numpy, points, cells, data):
    blocks, members = [], []
    for number, (kind, nodes) in enumerate(cells):
        if kind in (0, 1, 2):
            # Nothing, a point, and many points.
            continue
        if (kind, len(nodes)) not in VTK_CELLS:
            raise Unreadable(f"it has cells of VTK's kind {kind} with {len(nodes)} nodes, which are not read: triangles and quadrilaterals of first and second order are")
        name = VTK_CELLS[kind, len(nodes)]
        if not blocks or blocks[-1][0] != name:
            blocks.append((name, []))
            members.append([])
        blocks[-1][1].append(nodes)
        members[-1].append(number)
    plain = urllib.parse.unquote
    flat = lambda values: values[:, 0] if values.shape[1] == 1 else values
    of_cells = {plain(name): [flat(values)[own] for own in members] for name, values in data.get("CELL_DATA", {}).items() if len(values) == len(cells)}
    of_points = {plain(name): flat(values) for name, values in data.get("POINT_DATA", {}).items() if len(values) == len(points)}
    return meshio.Mesh(points, [(name, numpy.array(nodes)) for name, nodes in blocks], point_data=of_points, cell_data=of_cells)
