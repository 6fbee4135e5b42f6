"""Archives and input files of Ansys MAPDL (.cdb, and .dat of Workbench): NBLOCK, EBLOCK, CMBLOCK, and single N, E and EN."""

import re

# Shape and number of nodes by number of the element, of those in a plane, of shells and of the lines beside them.
MAPDL_CELLS = {number: (shape, count) for numbers, shape, count in [
    ("2 35 146", "triangle", 6), ("13 41 42 55 63 67 131 143 157 181 182 212 222 292", "quadrilateral", 4),
    ("53 77 82 93 121 132 183 213 223 230 233 238 281 293", "quadrilateral", 8),
    ("1 3 4 8 10 23 32 33 54 151 153 171 172 180 188 189 208 209", "line", 2),
] for number in numbers.split()}
# Cells in space, by the number of their corners.
MAPDL_SOLIDS = {number: corners for numbers, corners in [
    ("5 45 46 62 64 65 69 70 73 90 95 96 97 122 147 164 185 186 190 226 231 236 239 278 279", 8),
    ("87 92 98 123 127 148 168 187 227 232 237 240 285 291", 4),
] for number in numbers.split()}
MAPDL_SOLID_NAMES = {8: "hexahedron", 6: "prism", 5: "pyramid", 4: "tetrahedron"}
# MESH200, by its KEYOPT(1).
MAPDL_MESH = {0: ("line", 2), 1: ("line", 2), 2: ("line", 2), 3: ("line", 2), 4: ("triangle", 3), 5: ("triangle", 6), 6: ("quadrilateral", 4),
              7: ("quadrilateral", 8), 8: ("tetrahedron", 4), 9: ("tetrahedron", 4), 10: ("hexahedron", 8), 11: ("hexahedron", 8)}
# Lines of contact and of loads on a side, whose material says nothing of it.
MAPDL_SIDES = {"151", "153", "171", "172"}
# Elements without an area: springs, masses, surfaces of targets, contact of nodes, faces in space, cables of fluid, joints.
MAPDL_IDLE = set("7 11 12 14 21 27 31 34 36 37 38 39 40 52 71 116 152 154 155 156 159 169 170 173 174 175 176 177 178 179 184 201 202 203 204 205 214 "
                 "250 251 252".split())
# KEYOPT(3) of the plane elements of solids.
MAPDL_MADE_FOR = {0: "plane-stress", 1: "axisymmetric", 2: "plane-strain", 3: "plane-stress", 6: "axisymmetric"}
MAPDL_SOLID_PLANE = {"2", "42", "82", "182", "183"}
# Commands that make nodes or cells out of others or of a geometry.
MAPDL_GENERATES = set("NGEN FILL EGEN ENGEN AMESH VMESH LMESH NSYM ESYM ENSYM NSCALE TRANSFER NREAD EREAD *DO *DOWHILE *REPEAT /INPUT CDREAD".split())


def fortran_widths(form):
    """Widths of the columns of a format such as (3i9,6e21.13e3)."""
    parts = re.findall(r"(\d*)\s*[ieEfFgGdDaAI](\d+)(?:\.\d+)?(?:[eE]\d+)?", form)
    if not re.fullmatch(r"\s*\(.*\)\s*", form) or not parts or any(len(count) > 3 for count, _ in parts):
        raise Unreadable(f"'{form.strip()[:40]}' stands where a format such as (3i9,6e21.13e3) belongs")
    return [int(width) for count, width in parts for _ in range(int(count or 1))]


class Mapdl:
    """The state of the commands while they are read."""

    def __init__(self, source):
        self.found = Found("Ansys MAPDL")
        self.lines = lines_of(source)
        self.at = 0
        self.elements, self.keys = {}, {}  # Number of the element by type, and key option by type and number.
        self.type, self.material, self.system = 1, 1, 0
        self.components, self.selected, self.idle = [], [], {}
        self.tags = set()
        self.parameters = {}

    def next(self, what):
        if self.at == len(self.lines):
            raise Unreadable(f"the file ends in the middle of {what}: it is cut off")
        self.at += 1
        return self.lines[self.at - 1]

    def read(self):
        while self.at < len(self.lines):
            line = self.next("a command").split("!")[0]
            for command in () if re.match(r"\s*(/COM|C\*\*\*|/TITLE)", line, re.IGNORECASE) else line.split("$"):
                words = [word.strip() for word in command.split(",")]
                if words[0]:
                    self.command(words[0].upper(), words)
        for name, kind, members in self.components:
            self.component(name, kind, members)
        if self.lines and self.lines[0].upper().startswith("/COM,ANSYS") and not any(line.strip().upper().startswith("FINI") for line in self.lines[-9:]):
            self.found.notes.append("The archive does not end with FINISH: if it was cut off, what is missing is not told.")
        if self.selected:
            self.found.notes.append("Components that are made of a selection (CM) are left out: " + ", ".join(dict.fromkeys(self.selected)) + ".")
        if self.idle:
            self.found.notes.append("Elements without an area are left out: " + ", ".join(f"{count} of type {number}" for number, count in self.idle.items()) + ".")
        return self.found

    def command(self, name, words):
        word = lambda i: words[i] if i < len(words) else ""
        whole = lambda i: self.whole(word(i))
        given = re.fullmatch(r"(\w+)\s*=\s*(\S+)", words[0])
        if name == "*SET" or given:
            # Workbench numbers the types of contact by parameters.
            self.parameters[(given[1] if given else word(1)).lower()] = given[2] if given else word(2)
        elif name == "ET":
            self.element_type(whole(1), word(2), [int(key or 0) for key in words[3:9]])
        elif name in ("KEYOP", "KEYOPT"):
            self.keys[whole(1), whole(2)] = whole(3)
        elif name == "ETBLOCK":
            for fields in self.rows("ETBLOCK"):
                self.element_type(int(fields[0]), fields[1], [int(key or 0) for key in fields[2:]])
        elif name == "NBLOCK":
            self.nodes(word(2).upper() == "SOLID", whole(4))
        elif name == "EBLOCK":
            self.cells(word(2).upper(), whole(4))
        elif name == "CMBLOCK":
            self.members(word(1), word(2).upper(), whole(3))
        elif name == "CM":
            self.selected.append(word(1))
        elif name == "TYPE":
            self.type = whole(1)
        elif name == "MAT":
            self.material = whole(1)
        elif name in ("CSYS", "LOCAL", "CLOCAL", "CS", "CSKP"):
            self.system = whole(3 if word(2) in ("LOC", "ANG", "PRM") else 1)
        elif name in ("N", "EN") and re.match(r"R\d|UNBL", word(1)):
            if word(3) != "-1":
                raise Unreadable("its nodes and elements are not in blocks (N,R5.3): write the archive with CDWRITE,DB in blocked form")
        elif name == "N":
            if self.system:
                raise Unreadable(f"node {word(1)} is given in the coordinate system {self.system}: write the archive with CDWRITE,DB, which has the global one")
            self.found.point(whole(1), [real(word(i) or "0") for i in (2, 3, 4)])
        elif name in ("E", "EN") and word(1):
            tag, nodes = (whole(1), words[2:]) if name == "EN" else (max(self.tags, default=0) + 1, words[1:])
            self.cell(tag, self.type, self.material, [int(node or 0) for node in nodes])
        elif name in MAPDL_GENERATES:
            raise Unreadable(f"{name} makes nodes or elements, or reads them elsewhere, which is not done here: write the archive with CDWRITE,DB")

    def whole(self, text):
        """A whole number, by itself or as the value of a parameter."""
        value = self.parameters.get(text.lower())
        return int(text or 0) if value is None else int(real(value))

    def element_type(self, number, name, keys):
        match = re.search(r"(\d+)$", name)
        if match is None:
            raise Unreadable(f"type {number} is '{name}', which is no element of Ansys")
        self.elements[number] = match[1]
        self.keys.update({(number, key): value for key, value in enumerate(keys, 1)})

    def rows(self, what, end=r"\s*EN?,"):
        """The rows of a block in columns, up to its last line, which is a command or −1."""
        widths = fortran_widths(self.next(what))
        while True:
            line = self.next(what)
            if line.strip() == "-1" or re.match(end, line):
                return
            if line.strip():
                yield columns(line, widths)

    def nodes(self, solid, announced):
        count, first = 0, 3 if solid else 1
        for fields in self.rows("NBLOCK", r"\s*N,"):
            self.found.point(int(fields[0]), [real(text or "0") for text in (fields[first:first + 3] + [""] * 3)[:3]])
            count += 1
        self.agree("NBLOCK", "nodes", announced, count)

    def agree(self, block, things, announced, count):
        if announced and announced != count:
            raise Unreadable(f"{block} announces {announced} {things} and has {count}")

    def cells(self, kind, announced):
        if kind not in ("SOLID", ""):
            raise Unreadable(f"EBLOCK is of the kind {kind}, which is not read: write the archive with CDWRITE,DB")
        # Material, type, …, number of nodes, unused, number of the element, nodes; or number, type, constants, material, system, nodes.
        rows, count = self.rows("EBLOCK"), 0
        for fields in rows:
            row = [int(text or 0) for text in fields]
            if len(row) < (11 if kind == "SOLID" else 6):
                raise Unreadable(f"an element of EBLOCK has {len(row)} columns and no nodes: the file is cut off")
            if kind == "SOLID":
                nodes, wanted = row[11:], row[8]
                if wanted > 40:
                    raise Unreadable(f"element {row[10]} has {wanted} nodes, which no element of Ansys has")
                while 8 <= len(nodes) < wanted:
                    nodes += [int(text or 0) for text in next(rows, None) or self.next("an element of EBLOCK").split()]
                self.cell(row[10], row[1], row[0], (nodes + [0] * wanted)[:wanted])
            else:
                self.cell(row[0], row[1], row[3], row[5:])
            count += 1
        self.agree("EBLOCK", "elements", announced, count)

    def cell(self, tag, of, material, nodes):
        if of not in self.elements:
            raise Unreadable(f"element {tag} is of the type {of}, which no ET defines")
        number = self.elements[of]
        self.tags.add(tag)
        shape, count = MAPDL_MESH.get(self.keys.get((of, 1), 0), (None, 0)) if number == "200" else MAPDL_CELLS.get(number, (None, 0))
        corners = MAPDL_SOLIDS.get(number, count if shape in ("hexahedron", "tetrahedron") else None)
        if number in MAPDL_IDLE:
            self.idle[number] = self.idle.get(number, 0) + 1
            return
        if corners:
            nodes = list(dict.fromkeys(nodes[:corners]))
            self.found.cell(MAPDL_SOLID_NAMES.get(len(nodes), "solid"), nodes, (), tag)
            return
        if shape is None:
            raise Unreadable(f"element {tag} is of the type {of}, which is Ansys's element {number}, and that is none of a plane that is read: "
                             "use PLANE182 or PLANE183, or select the elements of the plane (ESEL) before CDWRITE")
        if number == "183" and self.keys.get((of, 1)) == 1:
            shape, count = "triangle", 6
        shape, nodes = mapdl_plane(tag, shape, count, nodes)
        if number in MAPDL_SOLID_PLANE:
            kinematics, key = MAPDL_MADE_FOR.get(self.keys.get((of, 3), 0)), self.keys.get((of, 3), 0)
            if kinematics is not None:
                self.found.made_for.setdefault(kinematics, f"PLANE{number} with KEYOPT(3) = {key}")
        groups = [] if number in MAPDL_SIDES else [self.found.number(1 if shape == "line" else 2, material, {})]
        self.found.cell(shape, nodes, groups, tag)

    def members(self, name, kind, count):
        widths, members = fortran_widths(self.next("CMBLOCK")), []
        while len(members) < count:
            members += [int(text) for text in columns(self.next(f"CMBLOCK {name}"), widths)]
        self.agree(f"CMBLOCK {name}", "members", count, len(members))
        # Ansys gives all nodes and all elements such names when it writes a geometry too.
        if kind in ("NODE", "ELEM", "ELEMENT") and not name.startswith("_ANF_"):
            self.components.append((name, kind[:4], members))

    def component(self, name, kind, members):
        # The second number of a range is negative.
        known, tags, count, before = sorted(self.found.index if kind == "NODE" else self.tags), [], 0, 0
        for number in members:
            first, last = (before + 1, -number) if number < 0 else (number, number)
            tags += within(known, first, last)
            count += last - first + 1
            before = last
        if len(tags) < count:
            self.found.notes.append(f"component '{name}' has {count - len(tags)} {'nodes' if kind == 'NODE' else 'elements'} that the file does not have: it is without them")
        if kind == "NODE":
            self.found.node_sets[name] = tags
        for tag in tags if kind == "ELEM" else ():
            self.found.group(tag, name)


def mapdl_plane(tag, shape, count, nodes):
    """Shape and nodes of a cell."""
    nodes = (nodes + [0] * count)[:count]
    if 0 in whole_or_corners(shape, nodes):
        raise Unreadable(f"element {tag} has no node at corner {nodes.index(0) + 1}")
    if shape == "quadrilateral":
        shape, nodes = collapsed(tag, nodes)
    return shape, whole_or_corners(shape, nodes)


def read_mapdl(source):
    return Mapdl(source).read()


READERS[".cdb"] = read_mapdl
