"""MED files of SALOME and Code_Aster, with their groups and nodal fields. Needs h5py."""

MED_CELLS = {"SE2": ("line", 2), "SE3": ("line", 3), "TR3": ("triangle", 3), "TR6": ("triangle", 6), "TR7": ("triangle", 7),
             "QU4": ("quadrilateral", 4), "QU8": ("quadrilateral", 8), "QU9": ("quadrilateral", 9),
             "TE4": ("tetrahedron", 4), "T10": ("tetrahedron with 10 nodes", 10), "HE8": ("hexahedron", 8), "H20": ("hexahedron with 20 nodes", 20),
             "H27": ("hexahedron with 27 nodes", 27), "PE6": ("prism", 6), "P15": ("prism with 15 nodes", 15), "PY5": ("pyramid", 5), "P13": ("pyramid with 13 nodes", 13)}


def med_step(group):
    """The last time step of a group that has steps."""
    steps = [name for name in group if hasattr(group[name], "keys")]
    return group[sorted(steps)[-1]] if steps else group


def med_families(families):
    """Groups of each family number."""
    found = {}
    for family in families.values():
        names = []
        if "GRO" in family:
            for row in family["GRO"]["NOM"][()]:
                text = row if isinstance(row, bytes) else bytes(int(c) & 255 for c in row)
                names.append(text.split(b"\0")[0].decode("latin-1").strip())
        found[int(family.attrs["NUM"])] = names
    return found


def read_med(source):
    h5py = package("h5py")
    try:
        file = h5py.File(source, "r")
    except OSError as error:
        raise Unreadable(f"it is no MED file of version 3 or later ({error})") from None
    meshes = list(file.get("ENS_MAA", {}))
    if len(meshes) != 1:
        raise Unreadable(f"it holds {len(meshes)} meshes ({', '.join(meshes)}): save one" if meshes else "it holds no mesh")
    whole = file["ENS_MAA"][meshes[0]]
    mesh = whole if "NOE" in whole else med_step(whole)
    if "NOE" not in mesh:
        raise Unreadable("its mesh has no nodes")
    if "COO" not in mesh["NOE"]:
        raise Unreadable("its mesh is a structured grid: save it with triangles or quadrilaterals")
    found = Found("MED")
    coordinates = mesh["NOE"]["COO"]
    count = int(coordinates.attrs["NBR"])
    flat = coordinates[()].tolist()
    for tag in range(count):
        found.point(tag + 1, flat[tag::count])
    families = whole["FAS"] if "FAS" in whole else file["FAS"][meshes[0]] if meshes[0] in file.get("FAS", {}) else {}
    of_cells, of_nodes = (med_families(families[key]) if key in families else {} for key in ("ELEME", "NOEUD"))
    if "FAM" in mesh["NOE"]:
        for tag, family in enumerate(mesh["NOE"]["FAM"][()].tolist(), 1):
            for name in of_nodes.get(family, []):
                found.node_sets.setdefault(name, []).append(tag)
    for kind, cells in (mesh["MAI"].items() if "MAI" in mesh else []):
        if kind.startswith("PO1"):
            continue
        if kind.startswith("PO"):
            raise Unreadable(f"it has polygons or polyhedra ('{kind}'): save it with triangles or quadrilaterals")
        shape, corners = MED_CELLS.get(kind[:3], (f"cell {kind} of MED", 0))
        count = int(cells["NOD"].attrs["NBR"])
        flat = cells["NOD"][()].tolist()
        family = cells["FAM"][()].tolist() if "FAM" in cells else [0] * count
        for i in range(count):
            nodes = flat[i::count]
            found.cell(shape, nodes if not corners else nodes[:corners], of_cells.get(family[i], []))
    for name, field in file.get("CHA", {}).items():
        step = med_step(field)
        if "NOE" in step:
            med_field(found, name, field, step["NOE"], file.get("PROFILS", {}))
    return found


def med_field(found, name, field, support, profiles):
    """The values of a field at all nodes that a cell uses."""
    names = field.attrs.get("NOM", b"")
    names = (names.decode("latin-1") if isinstance(names, bytes) else str(names)).split()
    components = int(field.attrs.get("NCO", 1))
    profile = next((support[key] for key in sorted(support) if "CO" in support[key]), None) if len(support) else None
    if profile is None:
        return
    flat = profile["CO"][()].tolist()
    count = len(flat) // max(components, 1)
    rows = [flat[i::count] for i in range(count)]
    # Code_Aster has others beside them, such as LAGS_C of contact and the rotations of shells.
    moves = [names.index(wanted) for wanted in ("DX", "DY", "DZ") if wanted in names]
    if len(moves) >= 2 and len(names) == components:
        rows = [[row[c] for c in moves] for row in rows]
    # A profile lists the nodes that have values, from one.
    key = profile.name.rsplit("/", 1)[1]
    tags = profiles[key]["PFL"][()].tolist() if key in profiles else range(1, count + 1)
    known = dict(zip(tags, rows))
    used = {tag for _, nodes, _ in found.cells for tag in nodes}
    if not used <= known.keys():
        return
    # DEPL and the like: Code_Aster's names have the result in front.
    found.fields[name.strip("_")] = [known.get(tag, [0.0] * len(rows[0])) for tag in found.index]
