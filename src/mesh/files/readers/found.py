"""What a reader of its own collects. Nothing here needs more than Python; a package that a format needs is named with code 45."""

import bisect
import gzip
import math
import os
import re
import sys
import tempfile
import zlib

# Cells by shape and number of nodes, in Gmsh's order: corners, middles of sides, centre.
PLANE = {("line", 2), ("line", 3), ("triangle", 3), ("triangle", 6), ("quadrilateral", 4), ("quadrilateral", 8), ("quadrilateral", 9)}
SIDES = {"triangle": [(0, 1), (1, 2), (2, 0)], "quadrilateral": [(0, 1), (1, 2), (2, 3), (3, 0)]}
CORNERS = {"line": 2, "triangle": 3, "quadrilateral": 4}

# Byte order marks of UTF-8 and of UTF-16.
MARKS = (b"\xef\xbb\xbf", b"\xff\xfe", b"\xfe\xff")


class Unreadable(Exception):
    """A file that does not follow its format."""


class Lines(list):
    """Lines of a file, or their words. What was handed out last is where an error of its reader is."""

    last = None

    def __init__(self, lines, path, numbers=None):
        super().__init__(lines)
        self.path = path
        self.numbers = range(1, len(self) + 1) if numbers is None else numbers

    def __getitem__(self, at):
        if isinstance(at, slice):
            return Lines(super().__getitem__(at), self.path, self.numbers[at])
        line = super().__getitem__(at)
        Lines.last = self.path, self.numbers[at]
        return line

    def __iter__(self):
        for number, line in zip(self.numbers, super().__iter__()):
            Lines.last = self.path, number
            yield line
        Lines.last = None

    def parts(self, of_line):
        """What a function makes of each line, with the number that it has in the file."""
        made = [(number, part) for number, line in zip(self.numbers, super().__iter__()) for part in of_line(line)]
        return Lines([part for _, part in made], self.path, [number for number, _ in made])

    def without(self, comment):
        """The lines without comments and surrounding blanks, and without empty ones."""
        return self.parts(lambda line: [text for text in [line.split(comment)[0].strip()] if text])


def located(reason, source):
    """The reason with the line at which the reader stopped, where it has none yet."""
    if Lines.last is None or re.search(r"\bline \d", reason):
        return reason
    path, number = Lines.last
    return f"line {number}" + ("" if path == source else f" of {os.path.basename(path)}") + f": {reason}"


# What Python says of a text that is no number, and what is meant.
NO_NUMBER = [(re.compile("invalid literal for int.* base 10: (.*)"), "a whole number"), (re.compile("could not convert string to float: (.*)"), "a number")]


def plain(error):
    """What went wrong in a reader, in words for somebody who looks at the file."""
    text = " ".join(str(error).split())
    for pattern, wanted in NO_NUMBER:
        match = pattern.search(text)
        if match:
            return f"{match[1][:60]} stands where {wanted} belongs"
    if isinstance(error, (IndexError, StopIteration, EOFError, AssertionError)) or "unpack" in text:
        return "something that belongs here is missing, or the file is cut off"
    if isinstance(error, KeyError):
        return f"there is {text}, which this format does not have here"
    if isinstance(error, UnicodeDecodeError):
        return "it has bytes that are no text"
    return f"it does not follow its format ({text or type(error).__name__})"


class Found:
    """Points by tag, cells with their groups, and sets of nodes."""

    def __init__(self, program):
        self.program = program
        self.points = []
        self.index = {}
        self.cells = []  # Shape, tags of nodes, list of groups.
        self.by_tag = {}
        self.node_sets = {}
        self.numbers = {}  # Name by dimension and number.
        self.fields = {}  # Rows by point, by name.
        self.single = False  # True if these are in single precision.
        self.notes = []
        self.made_for = {}  # Name of an element, by the kinematics that it is made for.

    def point(self, tag, coordinates):
        point = [float(x) for x in coordinates]
        if not all(map(math.isfinite, point)):
            raise Unreadable(f"node {tag} has a coordinate that is no finite number")
        if len(point) < 2 or self.points and len(point) != len(self.points[0]):
            raise Unreadable(f"node {tag} has {len(point)} coordinates" + (f", and the first one {len(self.points[0])}" if self.points else ""))
        if tag in self.index:
            other = self.points[self.index[tag]]
            if other != point:
                places = " and at ".join("(" + ", ".join(f"{x:g}" for x in of) + ")" for of in (other, point))
                raise Unreadable(f"node {tag} is given twice, at {places}")
            return
        self.index[tag] = len(self.points)
        self.points.append(point)

    def cell(self, shape, nodes, groups=(), tag=None):
        if tag is not None:
            other = self.cells[self.by_tag[tag]][:2] if tag in self.by_tag else None
            if other is not None and (other[0] == "line") == (shape == "line") and other[1] != list(nodes):
                raise Unreadable(f"cell {tag} is given twice, with other nodes")
            self.by_tag[tag] = len(self.cells)
        self.cells.append((shape, list(nodes), list(groups)))

    def number(self, dimension, number, names):
        """The name of a number, by itself where it has none."""
        name = names.get(number) or str(number)
        self.numbers[dimension, number] = name
        return name

    def group(self, tag, name):
        """Puts a cell into a group."""
        at = self.by_tag.get(tag)
        if at is not None and name not in self.cells[at][2]:
            self.cells[at][2].append(name)

    def side(self, tag, side, name):
        """Puts the side of a cell into a group, as a line."""
        if tag not in self.by_tag:
            raise Unreadable(f"group '{name}' has a side of cell {tag}, which is not among its cells")
        shape, nodes, _ = self.cells[self.by_tag[tag]]
        sides = SIDES.get(shape, [])
        if 0 <= side < len(sides):
            self.cell("line", [nodes[i] for i in sides[side]], [name])

    def place(self, tag):
        if tag not in self.index:
            raise Unreadable(f"a cell uses node {tag}, which is not among its nodes")
        return self.index[tag]

    def blocks(self):
        """The cells in runs of one shape."""
        blocks = []
        for shape, nodes, groups in self.cells:
            kept = (shape, len(nodes)) in PLANE
            name = shape if kept or shape not in ("line", *SIDES) else f"{shape} with {len(nodes)} nodes"
            nodes = [self.place(tag) for tag in nodes]
            if not blocks or blocks[-1]["shape"] != name:
                blocks.append({"shape": name, "nodes": [], "groups": []})
            blocks[-1]["nodes"].append(nodes)
            blocks[-1]["groups"].append(groups)
        return blocks

    def mesh(self):
        if not self.points:
            raise Unreadable("there is no node in it")
        if all(shape == "line" for shape, _, _ in self.cells):
            raise Unreadable("there is no cell in it")
        sets = {name: [self.index[tag] for tag in tags if tag in self.index] for name, tags in self.node_sets.items()}
        numbers = [[*key, name] for key, name in self.numbers.items() if abs(key[1]) < 2**31]
        return {"points": self.points, "blocks": self.blocks(), "node_sets": sets, "numbers": numbers, "notes": self.notes, "made_for": list(self.made_for.items())}


def whole_or_corners(shape, nodes):
    """The nodes of a cell, in which 0 is none; without all middles of its sides it has only corners."""
    return nodes[:CORNERS[shape]] if 0 in nodes else nodes


def collapsed(tag, nodes):
    """Shape and nodes of a quadrilateral of four or eight nodes, which is a triangle where two neighbouring corners are one node."""
    corners, middles = nodes[:4], nodes[4:]
    points = [i for i in range(4) if corners[i] == corners[(i + 1) % 4]]
    if len(points) > 1 or len(set(corners)) < 4 - len(points):
        raise Unreadable(f"element {tag} has the corners {', '.join(map(str, corners))}, which are no quadrilateral and no triangle")
    if not points:
        return "quadrilateral", nodes
    gone = (points[0] + 1) % 4
    kept = [i for i in range(4) if i != gone]
    return "triangle", [corners[i] for i in kept] + [middles[gone if i == points[0] else i] for i in kept if middles]


def within(tags, first, last):
    """Those of sorted numbers that are not outside of a range."""
    return tags[bisect.bisect_left(tags, first):bisect.bisect_right(tags, last)]


def columns(line, widths):
    """The texts in the columns of a line, as far as it goes."""
    fields, at = [], 0
    for width in widths:
        if not line[at:].strip():
            break
        fields.append(line[at:at + width])
        at += width
    found = [field.strip() for field in fields]
    # Where columns touch, a number that begins in its first column also ends in its last.
    if [text for text in found if text] != line[:at].split() and any(field[0] not in " -" and field[-1] == " " for field in fields if field.strip()):
        raise Unreadable("its numbers do not stand in the columns of the format")
    return found


# More are no mesh that anything here could solve, and may fill the disk.
MOST_UNPACKED = 1 << 30


def unpacked(source, target):
    """The file, or an unpacked copy in the folder of `target` where it is packed with gzip."""
    if not source.lower().endswith(".gz"):
        return source
    copy = os.path.join(os.path.dirname(target), os.path.basename(source)[:-3])
    try:
        with gzip.open(source, "rb") as file, open(copy, "wb") as out:
            while block := file.read(1 << 20):
                out.write(block)
                if out.tell() > MOST_UNPACKED:
                    refuse("it is longer than 1 GiB when it is unpacked: give a smaller mesh")
    except (OSError, EOFError, zlib.error) as error:
        refuse(f"it cannot be unpacked with gzip ({error}): pack it again, or give the file that was packed")
    return copy


def content_of(source):
    """The bytes of a file without the byte order mark of UTF-8."""
    with open(source, "rb") as file:
        data = file.read()
    if data.startswith(MARKS[1:]):
        raise Unreadable("its text is encoded in UTF-16: save it in UTF-8 or ASCII")
    return data[3:] if data.startswith(MARKS[0]) else data


def lines_of(source):
    """The lines of a text file in UTF-8, or else in Latin-1."""
    data = content_of(source)
    try:
        text = data.decode("utf-8")
    except UnicodeDecodeError:
        text = data.decode("latin-1")
    # Python's own `splitlines` also splits at letters of Latin-1.
    return Lines(re.sub("\r\n?", "\n", text).removesuffix("\n").split("\n") if text else [], source)


def package(name):
    """Imports a package, or ends with its name."""
    try:
        return __import__(name)
    except ImportError:
        print(name, file=sys.stderr)
        sys.exit(45)


def real(text):
    """A number, with Fortran's exponent too."""
    return float(re.sub(r"(?<=[0-9.])[dD](?=[-+]?[0-9])", "E", text) if "d" in text or "D" in text else text)
