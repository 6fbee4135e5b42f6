"""XDMF files with several grids, as DOLFINx writes them; those with one are meshio's."""

import os
import xml.etree.ElementTree

# Names of cells in XDMF files, in lower case.
XDMF_CELLS = {"polyvertex": "vertex", "polyline": "line", "edge_3": "line3", "triangle": "triangle", "triangle_6": "triangle6", "tri_6": "triangle6",
              "quadrilateral": "quad", "quadrilateral_8": "quad8", "quad_8": "quad8", "quadrilateral_9": "quad9", "quad_9": "quad9",
              "tetrahedron": "tetra", "tetrahedron_10": "tetra10", "hexahedron": "hexahedron", "wedge": "wedge", "pyramid": "pyramid"}


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
        from meshio.xdmf.common import translate_mixed_cells

        return [(block.type, nodes) for block in translate_mixed_cells(cells.ravel()) for nodes in block.data.tolist()]
    if kind.lower() not in XDMF_CELLS:
        raise Unreadable(f"grid '{grid.get('Name')}' has the topology '{kind}', which is not read beside other grids: save a file with one grid")
    return [(XDMF_CELLS[kind.lower()], nodes) for nodes in cells.tolist()]


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
