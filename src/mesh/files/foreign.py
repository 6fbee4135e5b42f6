"""Writes a mesh file as JSON: points, cells with their group names, and node sets. What has no reader beside this needs meshio, or Gmsh for what
meshio does not read."""

SHAPES = {"line": "line", "line3": "line", "triangle": "triangle", "triangle6": "triangle",
          "quad": "quadrilateral", "quad8": "quadrilateral", "quad9": "quadrilateral"}
SOLIDS = {"tetra": "tetrahedron", "tetra10": "tetrahedron with 10 nodes", "hexahedron": "hexahedron", "hexahedron20": "hexahedron with 20 nodes",
          "hexahedron27": "hexahedron with 27 nodes", "wedge": "prism", "wedge15": "prism with 15 nodes", "pyramid": "pyramid",
          "pyramid13": "pyramid with 13 nodes"}
# By Gmsh's number of the element type.
GMSH_SHAPES = {1: ("line", 2), 8: ("line", 3), 2: ("triangle", 3), 9: ("triangle", 6),
               3: ("quadrilateral", 4), 16: ("quadrilateral", 8), 10: ("quadrilateral", 9)}
# The integers that group cells, by the name each format gives them.
GROUPING = ["gmsh:physical", "cell_tags", "medit:ref", "CellEntityIds", "name_to_read", "su2:tag", "cell_ids", "GroupIds"]
# Words in what other programs call such integers, the most telling first, such words that are others' beginnings, and numbers that are
# something else.
TELLING = ["physical", "material", "region", "subdomain", "domain", "entity", "entities", "geometry", "boundar", "marker", "label", "group", "tag", "block", "zone"]
TELLING_ALONE = {"mat", "mats", "matid", "part", "parts", "partid"}
NO_GROUPS = {"gmsh:geometrical", "vtkoriginalcellids", "vtkghosttype", "ghosttype", "partition", "partitions", "partitionid", "partitionids", "partition_id", "mpi_rank", "mpirank",
             "rank", "processid", "process_id", "procid", "globalelementid", "globalcellids", "ids", "vtkidfilter_ids"}
# Suffixes that meshio does not know and Gmsh reads.
ONLY_GMSH = {".geo", ".diff", ".p3d", ".neu"}


def whole_numbers(blocks):
    """Integers of the cells, block by block, also where they are written as reals; nothing where they are no numbers of groups."""
    found = []
    for block in blocks:
        if block.ndim == 2 and block.shape[1] == 1:
            block = block[:, 0]
        if block.ndim != 1 or block.dtype.kind not in "iuf" or (block.dtype.kind == "f" and not (block == block.round()).all()) or (abs(block) >= 2**31).any():
            return None
        found.append([int(x) for x in block])
    return found


def telling(name):
    """How telling the name of an array is of groups, the smaller the more; nothing where it is not."""
    words = [word.lower() for word in re.findall(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+", name)]
    ranks = [rank for rank, known in enumerate(TELLING) if any(word.startswith(known) or word.rstrip("s").endswith(known) for word in words)]
    return min(ranks, default=len(TELLING) if TELLING_ALONE.intersection(words) else None)


def from_meshio(source, target):
    """Points, blocks, node sets and numbers of groups, as meshio has them."""
    mesh = read_with_meshio(source, target)
    blocks = {name: whole_numbers(blocks) for name, blocks in mesh.cell_data.items() if name.lower() not in NO_GROUPS}
    whole = [name for name, found in blocks.items() if found is not None]
    # Of several numbers, those that the format has for groups, then those that are called so, then the only ones that differ.
    told = sorted((name for name in whole if telling(name) is not None), key=telling)
    found = {name: [x for block in blocks[name] for x in block] for name in whole}
    # Numbers that are all different are those of the cells.
    others = [name for name in whole if name in told or len(found[name]) < 3 or len(set(found[name])) < len(found[name])]
    differ = [name for name in others if len(set(found[name])) > 1]
    chosen = next((names[0] for names in ([n for n in GROUPING if n in whole], told, differ if len(differ) == 1 else [], others if len(others) == 1 else []) if names), None)
    numbers_of = blocks.get(chosen)
    passed_over = [name for name in others if name != chosen and chosen is not None and chosen not in GROUPING]
    notes = [f"Groups of cells are the numbers of the array '{chosen}'. There are others ({', '.join(passed_over)}): leave those that are meant as the only ones."] if passed_over else []
    # In the formats that have numbers for groups, zero is none.
    none = {0} if chosen in GROUPING or not any(found.get(chosen, [])) else set()
    names = {(int(dim), int(tag)): name for name, (tag, dim) in mesh.field_data.items()}
    families = getattr(mesh, "cell_tags", {}) or {}

    def groups(block, shape):
        cells = mesh.cells[block].data
        result = [[] for _ in cells]
        for name, sets in mesh.cell_sets.items():
            if not name.startswith("gmsh:") and block < len(sets) and sets[block] is not None:
                for cell in sets[block]:
                    result[int(cell)].append(name)
                if name.isdigit() and len(sets[block]) > 0 and shape in SHAPES.values():
                    names.setdefault((1 if shape == "line" else 2, int(name)), name)
        if chosen is not None:
            for found, tag in zip(result, numbers_of[block]):
                tag = int(tag)
                dimension = 1 if shape == "line" else 2
                if tag not in none and (dimension, tag) not in names and tag not in families and shape in SHAPES.values():
                    names[dimension, tag] = str(tag)
                more = families.get(tag) or [names.get((dimension, tag))]
                if not found:
                    found.extend(name for name in more if name is not None)
        return result

    blocks = []
    for number, block in enumerate(mesh.cells):
        shape = SHAPES.get(block.type, block.type)
        if shape in ("vertex", "point"):
            continue
        kept = shape in SHAPES.values()
        blocks.append({
            "shape": SOLIDS.get(shape, shape),
            "nodes": block.data.tolist() if kept or shape in SOLIDS else [],
            "groups": groups(number, shape) if kept else [],
        })
    sets = {name: [int(node) for node in nodes] for name, nodes in mesh.point_sets.items()}
    for tag, families_of in (getattr(mesh, "point_tags", {}) or {}).items():
        data = mesh.point_data.get("point_tags")
        if data is not None:
            for name in families_of:
                sets.setdefault(name, []).extend(int(i) for i in (data == tag).nonzero()[0])
    points = [[float(x) for x in point] for point in mesh.points]
    return {"points": points, "blocks": blocks, "node_sets": sets, "numbers": [[*key, name] for key, name in names.items()], "notes": notes}


def from_gmsh(source):
    """The same by Gmsh."""
    import gmsh

    gmsh.initialize(interruptible=False)
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.open(source)
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    index = {int(tag): i for i, tag in enumerate(tags)}
    points = [[float(x) for x in coordinates[3 * i:3 * i + 3]] for i in range(len(tags))]
    numbers, named = [], {}
    for dim, tag in gmsh.model.getPhysicalGroups():
        name = gmsh.model.getPhysicalName(dim, tag) or str(tag)
        numbers.append([int(dim), int(tag), name])
        for entity in gmsh.model.getEntitiesForPhysicalGroup(dim, tag):
            named.setdefault((dim, int(entity)), []).append(name)
    blocks = []
    for dim, entity in gmsh.model.getEntities():
        for kind, _, nodes in zip(*gmsh.model.mesh.getElements(dim, entity)):
            kind = int(kind)
            if kind == 15:
                continue
            if kind not in GMSH_SHAPES:
                blocks.append({"shape": gmsh.model.mesh.getElementProperties(kind)[0], "nodes": [], "groups": []})
                continue
            shape, count = GMSH_SHAPES[kind]
            cells = [[index[int(n)] for n in nodes[i:i + count]] for i in range(0, len(nodes), count)]
            group = named.get((dim, entity)) or ([str(entity)] if dim == 2 else [])
            blocks.append({"shape": shape, "nodes": cells, "groups": [group] * len(cells)})
    sets = {}
    for dim, tag, name in numbers:
        if dim == 0:
            sets[name] = [index[int(n)] for n in gmsh.model.mesh.getNodesForPhysicalGroup(dim, tag)[0]]
    gmsh.finalize()
    return {"points": points, "blocks": blocks, "node_sets": sets, "numbers": numbers}


def checked(found):
    """The same, or a refusal that names the node or the cell at which it is no mesh; readers of this program look for themselves."""
    for number, point in enumerate(found["points"], 1):
        if not all(map(math.isfinite, point)):
            refuse(f"node {number} has a coordinate that is no finite number")
    count = len(found["points"])
    for block in found["blocks"]:
        for number, nodes in enumerate(block["nodes"], 1):
            wrong = next((node for node in nodes if not 0 <= node < count), None)
            if wrong is not None:
                refuse(f"{block['shape']} {number} has the node with index {wrong}, and those of the file are 0 to {count - 1}")
    return found


def main():
    packed, target = sys.argv[1:]
    source = unpacked(packed, target)
    reader = own_reader(source)
    if reader is not None:
        found = read_own(source, reader).mesh()
    elif any(source.lower().endswith(suffix) for suffix in ONLY_GMSH):
        try:
            found = checked(from_gmsh(source))
        except ModuleNotFoundError:
            print("gmsh", file=sys.stderr)
            sys.exit(45)
    else:
        try:
            load_meshio()
        except ImportError as error:
            print(error, file=sys.stderr)
            sys.exit(44)
        try:
            found = checked(from_meshio(source, target))
        except ModuleNotFoundError as error:
            print(error.name, file=sys.stderr)
            sys.exit(45)
        except Unreadable as error:
            refuse(str(error))
    with open(target, "w", encoding="utf-8") as out:
        json.dump(found, out)


main()
