"""Text formats of finite element programs: FreeFEM, Medit, GetFEM, GiD, NGSolve, scikit-fem and Elmer."""

import json
import re

# Shape and order of the nodes, by the name of the transformation.
GETFEM = {"PK(2,1)": ("triangle", [0, 1, 2]), "PK(2,2)": ("triangle", [0, 2, 5, 1, 4, 3]),
          "QK(2,1)": ("quadrilateral", [0, 1, 3, 2]), "QK(2,2)": ("quadrilateral", [0, 2, 8, 6, 1, 5, 7, 3, 4]),
          "LINEAR_PRODUCT(PK(1,1),PK(1,1))": ("quadrilateral", [0, 1, 3, 2]), "LINEAR_QK(2)": ("quadrilateral", [0, 1, 3, 2]),
          "PRODUCT(PK(1,1),PK(1,1))": ("quadrilateral", [0, 1, 3, 2]), "PRODUCT(PK(1,2),PK(1,2))": ("quadrilateral", [0, 2, 8, 6, 1, 5, 7, 3, 4]),
          "Q2_INCOMPLETE(2)": ("quadrilateral", [0, 2, 7, 5, 1, 4, 6, 3]), "PK(1,1)": ("line", [0, 1]), "PK(1,2)": ("line", [0, 2, 1])}
# Side of the cell by number of GetFEM's face.
GETFEM_FACES = {"triangle": [1, 2, 0], "quadrilateral": [1, 3, 2, 0]}


def read_freefem(source):
    """nv nt ne, then vertices, triangles and edges, each with a label."""
    found = Found("FreeFEM")
    words = lines_of(source).parts(str.split)
    counts = [int(word) for word in words[:3]]
    at = 3
    if min(counts) < 0 or len(words) < 3 + 3 * counts[0] + 4 * counts[1] + 3 * counts[2]:
        raise Unreadable(f"it announces {counts[0]} vertices, {counts[1]} triangles and {counts[2]} edges and has fewer")
    for tag in range(counts[0]):
        found.point(tag + 1, [real(x) for x in words[at:at + 2]])
        at += 3
    for dimension, shape, count, corners in ((2, "triangle", counts[1], 3), (1, "line", counts[2], 2)):
        for _ in range(count):
            *nodes, label = [int(word) for word in words[at:at + corners + 1]]
            found.cell(shape, nodes, [found.number(dimension, label, {})])
            at += corners + 1
    if at < len(words):
        raise Unreadable(f"it has {len(words) - at} numbers more than the {counts[0]} vertices, {counts[1]} triangles and {counts[2]} edges that it announces")
    return found


MEDIT = {"edges": (1, "line", 2), "edgesp2": (1, "line", 3), "triangles": (2, "triangle", 3), "trianglesp2": (2, "triangle", 6),
         "quadrilaterals": (2, "quadrilateral", 4), "quadrilateralsq2": (2, "quadrilateral", 9),
         "tetrahedra": (3, "tetrahedron", 4), "tetrahedrap2": (3, "tetrahedron with 10 nodes", 10), "hexahedra": (3, "hexahedron", 8),
         "prisms": (3, "prism", 6), "pyramids": (3, "pyramid", 5)}


def read_medit(source):
    """Medit's text, of second order too; keywords without cells, such as normals and ridges, are passed over. Gmsh writes eight and nine nodes
    under `Quadrilaterals`, as many as there are numbers."""
    found = Found("Medit")
    words = lines_of(source).without("#").parts(str.split)
    starts = [i for i, word in enumerate(words) if word[0].isalpha()]
    dimension = 3
    for start, end in zip(starts, starts[1:] + [len(words)]):
        keyword, numbers = words[start].lower(), words[start + 1:end]
        if keyword == "dimension":
            dimension = int(numbers[0])
        elif keyword == "vertices":
            width = dimension + 1
            if len(numbers) != 1 + int(numbers[0]) * width:
                wanted = f"{numbers[0]} vertices, each with {dimension} coordinates and a reference"
                raise Unreadable(f"it announces {wanted}, and has {len(numbers) - 1} numbers instead of {int(numbers[0]) * width}")
            for tag in range(int(numbers[0])):
                found.point(tag + 1, [real(x) for x in numbers[1 + tag * width:1 + tag * width + dimension]])
        elif keyword in MEDIT:
            way, shape, corners = MEDIT[keyword]
            count = int(numbers[0])
            width, rest = divmod(len(numbers) - 1, max(count, 1))
            if rest or count and width <= corners:
                raise Unreadable(f"it announces {count} of {keyword} and has others")
            for cell in range(count):
                *nodes, label = [int(word) for word in numbers[1 + cell * width:1 + (cell + 1) * width]]
                found.cell(shape, nodes, [found.number(way, label, {})] if label else [])
        elif re.fullmatch(r"(edges|triangles|quadrilaterals)[pq]\d", keyword):
            raise Unreadable(f"it has cells of the kind '{keyword}': save it in first or second order")
    return found


def read_getfem(source):
    found = Found("GetFEM")
    region = None
    sides = []
    for line in lines_of(source):
        line = line.split("%")[0].strip()
        words = line.split()
        if words[:2] == ["BEGIN", "REGION"]:
            region = words[2]
        elif words[:1] == ["END"]:
            region = None
        elif words[:1] == ["POINT"] and words[1:2] != ["COUNT"]:
            found.point(int(words[1]), [real(x) for x in words[2:5]])
        elif words[:1] == ["CONVEX"] and words[1:2] != ["COUNT"]:
            match = re.fullmatch(r"CONVEX\s+(\d+)\s+'?([^']*?)'?\s+([\d\s]+)", line)
            if match is None:
                raise Unreadable(f"it has '{line[:60]}' where a convex is expected")
            name = re.sub(r"\s|GT_", "", match[2])
            nodes = [int(word) for word in match[3].split()]
            shape, order = GETFEM.get(name, (match[2], range(len(nodes))))
            if len(order) != len(nodes):
                raise Unreadable(f"convex {match[1]} has {len(nodes)} nodes for {match[2]}")
            found.cell(shape, [nodes[i] for i in order], (), int(match[1]))
        elif region is not None:
            for word in words:
                cell, _, face = word.partition("/")
                sides.append((int(cell), int(face) if face else None, region))
    for cell, face, region in sides:
        if cell not in found.by_tag:
            raise Unreadable(f"region {region} has convex {cell}, which is not among its convexes")
        number = int(region) if region.isdigit() else None
        if face is None or face > 60000:
            found.group(cell, region)
        else:
            faces = GETFEM_FACES.get(found.cells[found.by_tag[cell]][0], [])
            if face < len(faces):
                found.side(cell, faces[face], region)
        if number is not None:
            found.numbers[(1 if face is not None else 2), number] = region
    return found


def read_gid(source):
    found = Found("GiD")
    shapes = {"linear": "line", "triangle": "triangle", "quadrilateral": "quadrilateral", "tetrahedra": "tetrahedron",
              "hexahedra": "hexahedron", "prism": "prism", "pyramid": "pyramid", "point": None}
    shape = count = part = name = None
    for line in lines_of(source):
        line = line.split("#")[0].strip()
        low = line.lower()
        if low.startswith("mesh"):
            match = re.search(r'elemtype\s+"?(\w+)"?\s+nnode\s+(\d+)', low)
            if match is None or match[1] not in shapes:
                raise Unreadable(f"it has '{line[:60]}' where a kind of cell is expected")
            shape, count = shapes[match[1]], int(match[2])
            quoted = re.match(r'mesh\s+"([^"]*)"', line, re.IGNORECASE)
            name = quoted[1] if quoted else None
        elif low in ("coordinates", "elements"):
            part = low
        elif low.startswith("end"):
            part = None
        elif part == "coordinates" and line:
            words = line.split()
            found.point(int(words[0]), [real(x) for x in words[1:4]])
        elif part == "elements" and line and shape is not None:
            tag, *nodes = [int(word) for word in line.split()]
            if len(nodes) < count:
                raise Unreadable(f"element {tag} has {len(nodes)} nodes instead of {count}")
            groups = [found.number(1 if shape == "line" else 2, n, {}) for n in nodes[count:count + 1] if n]
            found.cell(shape, nodes[:count], groups or ([name] if name else []), tag)
    return found


# Sections of Netgen that hold cells; each version has more columns.
NGSOLVE_SURFACES = ["surfaceelements", "surfaceelementsgi", "surfaceelementsuv"]
NGSOLVE_EDGES = ["edgesegments", "edgesegmentsgi", "edgesegmentsgi2", "edgesegmentsgi3"]


def read_ngsolve(source):
    found = Found("NGSolve")
    lines = lines_of(source).parts(lambda line: [text for text in [line.strip()] if text and not text.startswith("#")])
    tables = {}
    at = 0
    while at < len(lines):
        key = lines[at].lower()
        at += 1
        if re.match("(surfaceelements|edgesegments|volumeelements)", key) and key not in (*NGSOLVE_SURFACES, *NGSOLVE_EDGES, "volumeelements"):
            raise Unreadable(f"it has a section '{lines[at - 1]}', which this program does not know: export the mesh in another format, such as Gmsh's")
        if key in (*NGSOLVE_SURFACES, *NGSOLVE_EDGES, "volumeelements", "points", "materials", "bcnames", "pointelements", "edgedescriptors"):
            count = int(lines[at])
            tables[key] = lines[at + 1:at + 1 + count].parts(lambda line: [line.split()])
            if len(tables[key]) != count:
                raise Unreadable(f"its {key} are {len(tables[key])} instead of the {count} it announces")
            at += 1 + count
            if at < len(lines) and re.fullmatch(r"[-+.\deE\s]+", lines[at]):
                raise Unreadable(f"its {key} are more than the {count} it announces: '{lines[at]}' stands behind them")
    names = {key: {int(row[0]): row[1] for row in tables.get(key, []) if len(row) > 1} for key in ("materials", "bcnames")}
    for tag, row in enumerate(tables.get("points", []), 1):
        if len(row) < 3:
            raise Unreadable(f"point {tag} has {len(row)} coordinates instead of 3")
        found.point(tag, [real(x) for x in row[:3]])
    solids = {4: "tetrahedron", 10: "tetrahedron with 10 nodes", 8: "hexahedron", 6: "prism", 5: "pyramid"}
    for row in tables.get("volumeelements", []):
        found.cell(solids.get(int(row[1]), "solid"), [int(n) for n in row[2:2 + int(row[1])]])
    # The middle of a side is numbered by the corner that it is opposite to.
    orders = {3: [0, 1, 2], 6: [0, 1, 2, 5, 3, 4], 4: [0, 1, 2, 3], 8: [0, 1, 2, 3, 4, 7, 5, 6]}
    for key in NGSOLVE_SURFACES:
        for row in tables.get(key, []):
            count = int(row[4])
            nodes = [int(n) for n in row[5:5 + count]]
            shape = "triangle" if count in (3, 6) else "quadrilateral"
            found.cell(shape, [nodes[i] for i in orders.get(count, range(count))], [found.number(2, int(row[1]), names["materials"])])
    for key in NGSOLVE_EDGES[:3]:
        for row in tables.get(key, []):
            found.cell("line", [int(n) for n in row[2:4]], [found.number(1, int(row[0]), names["bcnames"])])
    # Here a segment begins with its points and ends with its descriptor, counted from zero, which begins with a number and ends with a name.
    descriptors = [(int(row[0]), " ".join(row[8:])) for row in tables.get("edgedescriptors", [])]
    for row in tables.get(NGSOLVE_EDGES[3], []):
        if not 0 <= int(row[6]) < len(descriptors):
            raise Unreadable(f"a segment of {NGSOLVE_EDGES[3]} has descriptor {row[6]}, and there are {len(descriptors)} in edgedescriptors")
        number, name = descriptors[int(row[6])]
        found.cell("line", [int(n) for n in row[:2]], [found.number(1, number, {number: name or names["bcnames"].get(number)})])
    return found


def read_skfem(source):
    found = Found("scikit-fem")
    content = json.loads(content_of(source).decode("utf-8"))
    if not isinstance(content, dict) or "p" not in content or "t" not in content:
        raise Unreadable("it has no 'p' and 't', which scikit-fem writes")
    points, cells = content["p"], content["t"]
    # Rows may be coordinates and corners, as in memory, or points and cells.
    if len(points) in (2, 3) and len(points[0]) not in (2, 3):
        points = list(zip(*points))
    if len(cells) in (3, 4) and len(cells[0]) not in (3, 4):
        cells = list(zip(*cells))
    for tag, point in enumerate(points):
        found.point(tag, point)
    groups = {}
    for name, members in (content.get("subdomains") or {}).items():
        for cell in members:
            groups.setdefault(cell, []).append(name)
    sides = set()
    for tag, nodes in enumerate(cells):
        shape = {3: "triangle", 4: "quadrilateral"}.get(len(nodes), "cell")
        found.cell(shape, nodes, groups.get(tag, []), tag)
        sides.update(tuple(sorted((nodes[a], nodes[b]))) for a, b in SIDES.get(shape, []))
    # scikit-fem numbers sides by their vertices.
    sides = sorted(sides)
    for name, members in (content.get("boundaries") or {}).items():
        for side in members:
            if not 0 <= side < len(sides):
                raise Unreadable(f"boundary '{name}' has side {side} of {len(sides)}")
            found.cell("line", sides[side], [name])
    return found


SU2 = {3: ("line", 2), 5: ("triangle", 3), 9: ("quadrilateral", 4), 10: ("tetrahedron", 4), 12: ("hexahedron", 8), 13: ("prism", 6), 14: ("pyramid", 5)}


def read_su2(source):
    """Cells, points and markers, each with the number of its rows; points and cells count from zero."""
    found = Found("SU2")
    lines = lines_of(source).without("%")
    dimension, marker, at = 2, None, 0
    while at < len(lines):
        key, equals, value = lines[at].partition("=")
        key, name, value = key.strip(), value.strip(), value.split()
        if not equals:
            raise Unreadable(f"'{lines[at][:60]}' stands where a section such as NELEM= is expected: the section before it announces fewer rows")
        at += 1
        if key == "NZONE" and int(value[0]) > 1:
            raise Unreadable(f"it has {value[0]} zones: save each into a file of its own")
        elif key == "NDIME":
            dimension = int(value[0])
        elif key == "MARKER_TAG":
            marker = name
        elif key in ("NELEM", "NPOIN", "MARKER_ELEMS"):
            count = int(value[0])
            rows = lines[at:at + count]
            at += count
            if len(rows) < count or any("=" in row for row in rows):
                raise Unreadable(f"{key}= announces {count} rows, and fewer stand below it")
            for row in rows:
                su2_row(found, key, row.split(), dimension, marker)
    markers = list(dict.fromkeys(name for _, _, groups in found.cells for name in groups))
    found.numbers.update({(1, int(name) if name.isdigit() else number): name for number, name in enumerate(markers, 1)})
    return found


def su2_row(found, key, words, dimension, marker):
    if key == "NPOIN":
        found.point(len(found.points), [real(x) for x in words[:dimension]])
        return
    kind = int(words[0])
    if kind not in SU2:
        # A marker of points is none of cells.
        if key == "NELEM":
            raise Unreadable(f"an element is of type {kind}, and of SU2 only cells of first order are read (3, 5, 9): export the mesh in another format")
        return
    shape, count = SU2[kind]
    if len(words) <= count:
        raise Unreadable(f"a {shape} has {len(words) - 1} nodes instead of {count}")
    found.cell(shape, [int(n) for n in words[1:count + 1]], [marker] if key == "MARKER_ELEMS" and marker else [])


def read_elmer(source):
    """The folder of mesh.nodes, mesh.elements, mesh.boundary and mesh.names."""
    folder = source if os.path.isdir(source) else os.path.dirname(source)
    found = Found("Elmer")

    def rows(name, needed=True):
        path = os.path.join(folder, name)
        if not os.path.isfile(path):
            if needed:
                raise Unreadable(f"there is no {name} in the folder")
            return []
        return [line for line in lines_of(path) if line.strip()]

    announced = " ".join(rows("mesh.header", needed=False)).split()[:3]
    for name, count in zip(("mesh.nodes", "mesh.elements", "mesh.boundary"), announced):
        present = len(rows(name, needed=name != "mesh.boundary"))
        if int(count) != present:
            raise Unreadable(f"mesh.header announces {count} rows of {name}, and it has {present}")
    names = [{}, {}]
    kind = 0
    for line in rows("mesh.names", needed=False):
        if line.lstrip().startswith("!"):
            kind = 1 if "boundar" in line.lower() else 0 if "bod" in line.lower() else kind
            continue
        match = re.match(r"\s*\$\s*(\S+)\s*=\s*(\d+)", line)
        if match:
            names[kind][int(match[2])] = match[1]
    for line in rows("mesh.nodes"):
        words = line.split()
        found.point(int(words[0]), [real(x) for x in words[2:5]])
    shapes = {2: "line", 3: "triangle", 4: "quadrilateral", 5: "tetrahedron", 6: "pyramid", 7: "prism", 8: "hexahedron"}
    for name, dimension, skipped in (("mesh.elements", 2, 2), ("mesh.boundary", 1, 4)):
        for line in rows(name, needed=dimension == 2):
            words = [int(word) for word in line.split()]
            kind, nodes = words[skipped], words[skipped + 1:]
            if kind // 100 == 1:
                continue
            if len(nodes) < kind % 100:
                raise Unreadable(f"{name} has a cell of kind {kind} with {len(nodes)} nodes")
            if dimension == 1 and kind // 100 != 2:
                continue
            shape = shapes.get(kind // 100, f"kind {kind} of Elmer")
            found.cell(shape, nodes[:kind % 100], [found.number(dimension, words[1], names[2 - dimension])])
    return found


# By MFEM's number of the geometry.
MFEM_CELLS = {1: ("line", 2), 2: ("triangle", 3), 3: ("quadrilateral", 4), 4: ("tetrahedron", 4), 5: ("hexahedron", 8), 6: ("prism", 6), 7: ("pyramid", 5)}


def read_mfem(source):
    """Elements, boundary and vertices of MFEM's mesh, version 1; attributes are the groups."""
    found = Found("MFEM")
    lines = lines_of(source).without("#")
    at = 1

    def rows():
        nonlocal at
        count = int(lines[at])
        at += 1 + count
        return [line.split() for line in lines[at - count:at]]

    cells = []
    while at < len(lines):
        key = lines[at]
        at += 1
        if key in ("elements", "boundary"):
            cells.append((1 + (key == "elements"), rows()))
        elif key == "vertices":
            count = int(lines[at])
            if at + 1 >= len(lines) or lines[at + 1] == "nodes":
                raise Unreadable("it has no coordinates of vertices, but a function of them (nodes): save it with straight sides")
            at += 2
            for number, line in enumerate(lines[at:at + count]):
                found.point(number, [real(x) for x in line.split()])
            at += count
        elif key == "dimension":
            at += 1
        elif key == "nodes":
            raise Unreadable("its cells are curved (nodes): save it with straight sides")
    for dimension, of_dimension in cells:
        for attribute, kind, *nodes in of_dimension:
            if int(kind) == 0:
                continue
            if int(kind) not in MFEM_CELLS:
                raise Unreadable(f"it has cells of the geometry {kind}, which is not known")
            shape, count = MFEM_CELLS[int(kind)]
            if len(nodes) != count:
                raise Unreadable(f"a {shape} has {len(nodes)} vertices instead of {count}")
            found.cell(shape, [int(n) for n in nodes], [found.number(dimension, int(attribute), {})])
    return found
