"""Exodus files (.e, .exo, .ex2): blocks, side sets and node sets by name. Classic netCDF is read here, the rest through h5py."""

import struct

EXODUS = {"TRI": "triangle", "QUA": "quadrilateral", "SHE": "quadrilateral", "BAR": "line", "BEA": "line", "TRU": "line", "EDG": "line",
          "TET": "tetrahedron", "HEX": "hexahedron", "WED": "prism", "PYR": "pyramid"}
NETCDF_TYPES = {1: "b", 2: "c", 3: "h", 4: "i", 5: "f", 6: "d", 7: "B", 8: "H", 9: "I", 10: "q", 11: "Q"}


class Classic:
    """Variables of a classic netCDF file, as flat tuples with their shapes."""

    def __init__(self, data):
        self.data, self.at, self.version = data, 4, data[3]
        self.wide = self.version == 5
        if self.version not in (1, 2, 5):
            raise Unreadable(f"its version of netCDF is {self.version}")
        self.records = self.count()
        self.dimensions = [(self.name(), self.count()) for _ in range(self.list())]
        self.attributes()
        self.variables = {}
        found = []
        for _ in range(self.list()):
            name = self.name()
            axes = [self.count() for _ in range(self.count())]
            attributes = self.attributes()
            kind, _ = self.integer(), self.count()
            begin = self.integer() if self.version == 1 else self.unpack("q")
            found.append((name, axes, attributes, NETCDF_TYPES[kind], begin))
        growing = [(kind, axes) for _, axes, _, kind, _ in found if self.grows(axes)]
        sizes = [struct.calcsize(kind) * self.size(axes[1:]) for kind, axes in growing]
        self.record = sizes[0] if len(sizes) == 1 else sum(size + -size % 4 for size in sizes)
        for name, axes, attributes, kind, begin in found:
            self.variables[name] = (kind, axes, begin, attributes)

    def unpack(self, kind):
        value = struct.unpack_from(">" + kind, self.data, self.at)[0]
        self.at += struct.calcsize(kind)
        return value

    def integer(self):
        return self.unpack("i")

    def count(self):
        return self.unpack("q") if self.wide else self.unpack("i")

    def list(self):
        tag, count = self.integer(), self.count()
        return count if tag else 0

    def name(self):
        length = self.count()
        text = self.data[self.at:self.at + length].decode("utf-8", "replace")
        self.at += length + -length % 4
        return text

    def attributes(self):
        found = {}
        for _ in range(self.list()):
            name, kind, count = self.name(), NETCDF_TYPES[self.integer()], self.count()
            size = count * struct.calcsize(kind)
            found[name] = self.data[self.at:self.at + size]
            self.at += size + -size % 4
        return found

    def grows(self, axes):
        return bool(axes) and self.dimensions[axes[0]][1] == 0

    def size(self, axes):
        product = 1
        for axis in axes:
            product *= self.dimensions[axis][1]
        return product

    def __contains__(self, name):
        return name in self.variables

    def attribute(self, name, key):
        return self.variables[name][3].get(key, b"").decode("latin-1").strip("\0 ")

    def values(self, name, last=False):
        """All values of a variable, or those of its last record."""
        kind, axes, begin, _ = self.variables[name]
        if self.grows(axes):
            count = self.size(axes[1:])
            begin += self.record * (self.records - 1)
        else:
            count = self.size(axes)
        if len(self.data) < begin + count * struct.calcsize(kind):
            raise Unreadable(f"'{name}' goes beyond its end: the file is cut off")
        return list(struct.unpack_from(f">{count}{kind}", self.data, begin))

    def texts(self, name):
        if name not in self:
            return []
        width = self.dimensions[self.variables[name][1][-1]][1]
        text = b"".join(self.values(name))
        return [text[i:i + width].split(b"\0")[0].decode("utf-8", "replace").strip() for i in range(0, len(text), width)]

    def width(self, name):
        return self.dimensions[self.variables[name][1][-1]][1]


class Hdf:
    """The same of a netCDF file of version 4."""

    def __init__(self, source):
        self.file = package("h5py").File(source, "r")

    def __contains__(self, name):
        return name in self.file

    def attribute(self, name, key):
        value = self.file[name].attrs.get(key, b"")
        return value.decode("latin-1") if isinstance(value, bytes) else str(value)

    def values(self, name, last=False):
        data = self.file[name][()]
        return (data[-1] if last and len(data) else data).ravel().tolist()

    def texts(self, name):
        if name not in self:
            return []
        return [b"".join(row).split(b"\0")[0].decode("utf-8", "replace").strip() for row in self.file[name][()]]

    def width(self, name):
        return self.file[name].shape[-1]


def numbered(file, kind, pattern):
    """Numbers and variables of the blocks or sets of a kind; an empty one has a number and no variable."""
    total = max((len(file.values(name)) for name in (f"{kind}_status", f"{kind}_prop1") if name in file), default=0)
    number = 1
    while number <= total or pattern.format(number) in file:
        if pattern.format(number) in file:
            yield number, pattern.format(number)
        number += 1


def read_exodus(source):
    with open(source, "rb") as opened:
        data = opened.read()
    file = Classic(data) if data[:3] == b"CDF" else Hdf(source)
    found = Found("Exodus")
    axes = [name for name in ("coordx", "coordy", "coordz") if name in file]
    if axes:
        rows = list(zip(*(file.values(name) for name in axes)))
    elif "coord" in file:
        flat, count = file.values("coord"), file.width("coord")
        rows = list(zip(*(flat[i:i + count] for i in range(0, len(flat), count))))
    else:
        raise Unreadable("it has no coordinates ('coordx' or 'coord')")
    dimension = len(rows[0]) if rows else 0
    for tag, row in enumerate(rows, 1):
        found.point(tag, row)

    def named(kind, total, label):
        names, ids = file.texts(f"{kind}_names"), file.values(f"{kind}_prop1") if f"{kind}_prop1" in file else []
        identity = int(ids[total - 1]) if total <= len(ids) else total
        return (names[total - 1] if total <= len(names) else "") or f"{label}{identity}", identity

    tag = 1
    # Cells that have two faces before their sides: shells, and triangles in space.
    shells = set()
    for number, name in numbered(file, "eb", "connect{}"):
        width, flat = file.width(name), [int(n) for n in file.values(name)]
        kind = file.attribute(name, "elem_type").upper()
        shape = EXODUS.get(kind[:3], kind or "unknown")
        if kind.startswith("SHELL") and width in (3, 6):
            shape = "triangle"
        title, identity = named("eb", number, "")
        if shape in SIDES:
            found.numbers[2, identity] = title
        if "SHELL" in kind or (shape == "triangle" and dimension == 3):
            shells.update(range(tag, tag + len(flat) // width))
        for i in range(0, len(flat), width):
            found.cell(shape, flat[i:i + width], [title] if shape in SIDES or shape == "line" else [], tag)
            tag += 1
    solid = any(shape in ("hexahedron", "tetrahedron") for shape, _, _ in found.cells)
    for number, name in numbered(file, "ss", "elem_ss{}"):
        title, identity = named("ss", number, "side_")
        found.numbers[1, identity] = title
        for cell, side in zip(file.values(name), file.values(f"side_ss{number}")):
            first = 3 if int(cell) in shells else 1
            if int(side) < first:
                found.group(int(cell), title)
            elif not solid:
                found.side(int(cell), int(side) - first, title)
    for number, name in numbered(file, "ns", "node_ns{}"):
        found.node_sets[named("ns", number, "nodes_")[0]] = [int(n) for n in file.values(name)]
    read_exodus_variables(file, found)
    return found


def read_exodus_variables(file, found):
    """Nodal variables of the last step: those that differ in a last x, y or z are one vector."""
    columns = {}
    for number, name in enumerate(file.texts("name_nod_var"), 1):
        if f"vals_nod_var{number}" in file:
            columns[name] = file.values(f"vals_nod_var{number}", last=True)
    for name, values in columns.items():
        for ends in ("xyz", "XYZ"):
            stem = name[:-1]
            if name.endswith(ends[0]) and stem + ends[1] in columns:
                parts = [columns[stem + end] for end in ends if stem + end in columns]
                found.fields[stem.rstrip("_ ") or "u"] = [list(row) for row in zip(*parts)]
