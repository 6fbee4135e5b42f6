"""XDMF files with several grids, as DOLFINx writes them; those with one are meshio's."""

import os
import xml.etree.ElementTree

# Names of cells in XDMF files, in lower case.
XDMF_CELLS = {"polyvertex": "vertex", "polyline": "line", "edge_3": "line3", "triangle": "triangle", "triangle_6": "triangle6", "tri_6": "triangle6",
              "quadrilateral": "quad", "quadrilateral_8": "quad8", "quad_8": "quad8", "quadrilateral_9": "quad9", "quad_9": "quad9",
              "tetrahedron": "tetra", "tetrahedron_10": "tetra10", "hexahedron": "hexahedron", "wedge": "wedge", "pyramid": "pyramid"}
# Shape and number of nodes by XDMF's number of a cell in a mixed topology; zero where the number stands in the file.
XDMF_MIXED = {1: ("vertex", 0), 2: ("line", 0), 4: ("triangle", 3), 5: ("quad", 4), 6: ("tetra", 4), 7: ("pyramid", 5), 8: ("wedge", 6), 9: ("hexahedron", 8),
              34: ("line3", 3), 35: ("quad9", 9), 36: ("triangle6", 6), 37: ("quad8", 8), 38: ("tetra10", 10), 39: ("pyramid13", 13), 40: ("wedge15", 15),
              48: ("hexahedron20", 20), 50: ("hexahedron27", 27)}


def xdmf_grids(source):
    """The mesh of a file with several grids: the first has the cells, others have tags of cells and sides, or steps with fields. Nothing of a
    file with one grid."""
    domain = xml.etree.ElementTree.parse(source).getroot().find("Domain")
    if domain is None or len(list(domain.iter("Grid"))) < 2:
        return None
    import meshio
    import numpy

    points, blocks, fields, sets = None, {}, {}, {}
    for outer in domain.findall("Grid"):
        grids = outer.findall("Grid")
        steps = outer.get("CollectionType") == "Temporal"
        # The first step may have the mesh, the last has the values.
        for grid in (grids[:1] + grids[-1:] if steps else grids) or [outer]:
            if grid.find("Geometry/DataItem") is not None:
                own = xdmf_array(source, grid.find("Geometry"))
                if points is not None and not numpy.array_equal(points, own):
                    raise Unreadable(f"grid '{grid.get('Name')}' has points of its own: save one grid, or grids on the points of the first")
                points = own
            cells = xdmf_cells(source, grid) if grid.find("Topology/DataItem") is not None else []
            # A tagged cell is mostly one of the mesh, which it may go around differently.
            places = [(shape, tuple(sorted(nodes))) for shape, nodes in cells]
            for (shape, key), (_, nodes) in zip(places, cells):
                block = blocks.setdefault(shape, {})
                block.setdefault(key, (len(block), nodes))
            for attribute in grid.findall("Attribute"):
                values = xdmf_array(source, attribute)
                if attribute.get("Center", "Node") == "Node":
                    fields[attribute.get("Name")] = values
                elif not steps and cells and values.size == len(cells) and (values == values.round()).all():
                    for (shape, key), tag in zip(places, values.ravel().tolist()):
                        sets.setdefault(str(int(tag)), {}).setdefault(shape, set()).add(blocks[shape][key][0])
    if points is None:
        raise Unreadable("none of its grids has a geometry")
    fields = {name: values for name, values in fields.items() if len(values) == len(points)}
    mesh = meshio.Mesh(points, [(shape, numpy.array([nodes for _, nodes in block.values()])) for shape, block in blocks.items()], point_data=fields)
    mesh.cell_sets = {name: [sorted(of.get(shape, [])) for shape in blocks] for name, of in sets.items()}
    return mesh


def xdmf_cells(source, grid):
    """Shape and nodes of each cell of a grid."""
    topology = grid.find("Topology")
    kind = topology.get("TopologyType") or topology.get("Type") or ""
    cells = xdmf_array(source, topology)
    if kind.lower() == "mixed":
        return mixed_cells(cells.ravel().tolist())
    if kind.lower() not in XDMF_CELLS:
        raise Unreadable(f"grid '{grid.get('Name')}' has the topology '{kind}', which is not read beside other grids: save a file with one grid")
    return [(XDMF_CELLS[kind.lower()], nodes) for nodes in cells.tolist()]


def mixed_cells(numbers):
    """Shape and nodes of each cell of a mixed topology: a number of the shape, then the nodes, whose count stands first for points and lines."""
    cells, at = [], 0
    while at < len(numbers):
        kind = numbers[at]
        if kind not in XDMF_MIXED:
            raise Unreadable(f"its mixed topology has a cell of kind {kind}, which is not read: save it in first or second order")
        shape, count = XDMF_MIXED[kind]
        at += 1
        if count == 0:
            count = numbers[at] if at < len(numbers) else 0
            shape = shape if count == {"vertex": 1, "line": 2}[shape] else f"{shape} with {count} nodes"
            at += 1
        if at + count > len(numbers):
            raise Unreadable(f"its mixed topology ends within a cell of {count} nodes")
        cells.append((shape, numbers[at:at + count]))
        at += count
    return cells


def prepare_meshio_for_xdmf(source):
    """Lets meshio read mixed topologies in this way, where it stops at cells of second order, and text without the package of HDF."""
    import importlib.util
    import itertools

    import meshio.xdmf.main
    import numpy

    def blocks(data):
        runs = itertools.groupby(mixed_cells(numpy.asarray(data).ravel().tolist()), key=lambda cell: cell[0])
        return [meshio.CellBlock(shape, numpy.array([nodes for _, nodes in cells])) for shape, cells in runs]

    for module in (meshio.xdmf.main, meshio.xdmf.time_series):
        module.translate_mixed_cells = blocks
    if importlib.util.find_spec("h5py") is None and b"HDF" not in content_of(source):
        sys.modules["h5py"] = types.ModuleType("h5py")


def xdmf_array(source, part):
    """The numbers of a part of an XDMF file."""
    import numpy

    item = part.find("DataItem")
    form = item.get("Format") if item is not None else None
    if form == "XML":
        kind = int if item.get("NumberType", item.get("DataType")) in ("Int", "UInt", "Char", "UChar") else float
        return numpy.array(item.text.split(), dtype=kind).reshape([int(n) for n in item.get("Dimensions").split()])
    if form != "HDF":
        raise Unreadable(f"'{part.get('Name', part.tag)}' has data of the format '{form}', which is not read: save it as HDF or XML")
    import h5py

    name, _, path = item.text.strip().rpartition(":")
    with h5py.File(os.path.join(os.path.dirname(source), name), "r") as file:
        return file[path][()]
