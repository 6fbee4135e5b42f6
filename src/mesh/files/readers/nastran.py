"""Bulk data of Nastran: points and plane elements, by their property."""

import math

# Shape and number of nodes of Nastran's elements of a plane, which begin with a number, a property and the nodes; of those in space the corners.
NASTRAN_CELLS = {name: (shape, count) for names, shape, count in [
    ("CTRIA3 CTRIAR CPLSTN3 CPLSTS3 CTRAX3", "triangle", 3), ("CTRIA6 CPLSTN6 CPLSTS6 CTRAX6 CTRIAX CTRIAX6", "triangle", 6),
    ("CQUAD4 CQUADR CPLSTN4 CPLSTS4 CQUADX4", "quadrilateral", 4), ("CQUAD8 CPLSTN8 CPLSTS8 CQUADX8", "quadrilateral", 8),
    ("CQUAD CQUAD9 CQUADX", "quadrilateral", 9), ("CBAR CBEAM CBEND CROD CTUBE", "line", 2),
    ("CTETRA", "tetrahedron", 4), ("CPYRA CPYRAM", "pyramid", 5), ("CPENTA", "prism", 6), ("CHEXA", "hexahedron", 8),
] for name in names.split()}


# Elements without an area: springs, dampers, masses, joints, boundaries of heat and panels of air.
NASTRAN_IDLE = re.compile("C(ELAS|BUSH|DAMP|MASS|VISC|GAP|WELD|FAST|SEAM|HBDY|ONV|ONM|ONROD|ONTACT|AERO|AXIF|FLUID|FREE|INSTR)")
# Cards of other things that begin with a C.
NASTRAN_OTHERS = re.compile("C(ORD|SET|LOAD|REEP|SSCHD|SUPER|SUPUP|SUPEXT|YJOIN|YSUP|YAX|UPDATE|OMPUTE|HACAB|HACBR|DB|OHESIV)")


# Cells of a body of revolution, which lie in the plane y = 0 with the axis along z, or in z = 0 with the axis along y.
NASTRAN_TURNED = set("CTRAX3 CTRAX6 CTRIAX CTRIAX6 CQUADX4 CQUADX8 CQUADX".split())


def nastran_lines(source, depth=0):
    """Place and text of the lines of bulk data, with those of included files. A deck without its first words is bulk data from its first line on."""
    lines = lines_of(source)
    begin = next((i for i, line in enumerate(lines) if re.match(r"\s*BEGIN\s+BULK", line, re.IGNORECASE)), -1) + 1
    for number, line in enumerate(lines[begin:], begin + 1):
        place = f"line {number}" + (f" of {os.path.basename(source)}" if depth else "")
        line = line.split("$")[0].expandtabs(8).rstrip()
        word = line.strip().upper()
        if word.startswith("ENDDATA"):
            return
        if word.startswith("INCLUDE"):
            name = line.strip()[7:].strip(" '\"")
            path = os.path.join(os.path.dirname(source), name)
            if depth > 9 or not os.path.isfile(path):
                raise Unreadable(f"{place} includes '{name}', which is not there: put it beside the deck")
            yield from nastran_lines(path, depth + 1)
        elif word:
            yield place, line


def nastran_cards(source):
    """Place, name and fields of each card, in fields of 8 or 16 columns or with commas."""
    card = None
    for place, line in nastran_lines(source):
        head, *fields = [word.strip() for word in line.split(",")] if "," in line else [line[:8].strip()]
        count = 4 if "*" in head else 8
        if "," not in line:
            fields = [line[8 + 64 // count * i:8 + 64 // count * (i + 1)].strip() for i in range(count)]
        fields = (fields + [""] * count)[:count]
        if head and head[0] not in "+*":
            if card is not None:
                yield card
            card = place, head.rstrip("* ").upper(), fields
        elif card is None:
            raise Unreadable(f"{place} continues a card, and there is none before it")
        else:
            card[2].extend(fields)
    if card is not None:
        yield card


def nastran_real(text):
    """A number, whose exponent may do without its letter."""
    try:
        return float(text or 0)
    except ValueError:
        return real(re.sub(r"(?<=[0-9.])([-+][0-9]+)$", r"E\1", text))


def nastran_basic(point, frame, frames, depth=0):
    """The coordinates in the basic system of a point in a rectangular or cylindrical one."""
    if frame == 0:
        return point
    if frame not in frames or depth > 20:
        raise Unreadable(f"it has points in the coordinate system {frame}, which no CORD2R or CORD2C defines: write them in the basic system")
    kind, base, corners = frames[frame]
    origin, on_axis, in_plane = (nastran_basic(corner, base, frames, depth + 1) for corner in corners)
    if kind == "C":
        angle = math.radians(point[1])
        point = [point[0] * math.cos(angle), point[0] * math.sin(angle), point[2]]

    def unit(v):
        length = math.hypot(*v)
        if length == 0.0:
            raise Unreadable(f"two of the three points that define the coordinate system {frame} lie in one direction: give three that do not")
        return [x / length for x in v]

    def cross(a, b):
        return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]

    z = unit([b - a for a, b in zip(origin, on_axis)])
    y = unit(cross(z, [c - a for a, c in zip(origin, in_plane)]))
    return [a + sum(p * e for p, e in zip(point, axes)) for a, *axes in zip(origin, cross(y, z), y, z)]


def nastran_cell(found, place, name, fields):
    shape, count = NASTRAN_CELLS[name]
    nodes = [int(word) if word else 0 for word in (fields + [""] * count)[2:2 + count]]
    if name == "CTRIAX6":
        nodes = nodes[::2] + nodes[1::2]
    corners = len(SIDES.get(shape, nodes))
    if 0 in nodes[:corners]:
        raise Unreadable(f"{place}: {name} {fields[0]} has no node at corner {nodes.index(0) + 1}")
    if 0 in nodes:
        # Without its centre it has eight nodes, without a node in the middle of a side only its corners.
        nodes = nodes[:8 if count == 9 and 0 not in nodes[:8] else corners]
    groups = [found.number(1 if shape == "line" else 2, int(fields[1] or fields[0]), {})] if shape in ("line", *SIDES) else []
    found.cell(shape, nodes, groups, int(fields[0]))


def read_nastran(source):
    """Bulk data of Nastran: points and elements, by their property."""
    found = Found("Nastran")
    points, frames, usual, others, idle, turned = [], {0: None}, "", {}, {}, []
    words = [line.split(None, 1)[0].upper() for line in lines_of(source) if line.strip()]
    if "BEGIN" in words and "ENDDATA" not in words:
        found.notes.append("The deck has BEGIN BULK and no ENDDATA: if it was cut off, what is missing is not told.")
    for place, name, fields in nastran_cards(source):
        try:
            if name == "GRID":
                points.append((int(fields[0]), fields[1], [nastran_real(word) for word in fields[2:5]]))
            elif name == "GRDSET":
                usual = fields[1]
            elif name in ("CORD2R", "CORD2C"):
                numbers = [nastran_real(word) for word in fields[2:11]]
                frames[int(fields[0])] = name[-1], int(fields[1] or 0), [numbers[i:i + 3] for i in (0, 3, 6)]
            elif name in NASTRAN_CELLS:
                nastran_cell(found, place, name, fields)
                turned.append(name in NASTRAN_TURNED)
                kinematics = "axisymmetric" if turned[-1] else "plane-strain" if "PLSTN" in name else "plane-stress" if "PLSTS" in name else None
                if kinematics is not None:
                    found.made_for.setdefault(kinematics, name)
            elif re.fullmatch(r"[=*].*", name) or any(re.fullmatch(r"=(\(\d+\))?|\*\(.*\)", word) for word in fields):
                raise Unreadable(f"{place}: cards are repeated (=), which is not read: write each by itself")
            elif NASTRAN_IDLE.match(name):
                idle.setdefault(name, []).append(place)
            elif re.match("C", name) and not NASTRAN_OTHERS.match(name) and sum(word.isdigit() for word in fields[:5]) == 5:
                others.setdefault(name, []).append(place)
        except ValueError as error:
            raise Unreadable(f"{place}: a field of {name} is not the number that belongs there ({error})") from None
        except Unreadable as error:
            raise Unreadable(str(error) if str(error).startswith(place) else f"{place}: {error}") from None
    points = [(tag, nastran_basic(point, int(frame or usual or 0), frames)) for tag, frame, point in points]
    across = turned and all(turned) and all(y == 0.0 for _, (_, y, _) in points) and any(z != 0.0 for _, (_, _, z) in points)
    for tag, (x, y, z) in points:
        found.point(tag, [x, z, y] if across else [x, y, z])
    if others:
        told = ", ".join(f"{name} (first at {places[0]})" for name, places in others.items())
        none = all(shape == "line" for shape, _, _ in found.cells)
        raise Unreadable(("it has no plane element, but " if none else "beside its plane elements it has ") + f"{told}: use CTRIA3, CTRIA6, CQUAD4, CQUAD8 or the like of plane strain, "
                         "plane stress or axial symmetry")
    if idle:
        found.notes.append("Elements without an area are left out: " + ", ".join(f"{len(places)} {name}" for name, places in idle.items()) + ".")
    return found


READERS.update(dict.fromkeys((".bdf", ".nas", ".fem"), read_nastran))
