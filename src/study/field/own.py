"""Fields of files that the readers of meshes read too."""

# Cells of meshio by shape and number of nodes.
OWN_CELLS = {("line", 2): "line", ("line", 3): "line3", ("triangle", 3): "triangle", ("triangle", 6): "triangle6",
             ("quadrilateral", 4): "quad", ("quadrilateral", 8): "quad8", ("quadrilateral", 9): "quad9"}
OWN_FIELDS = {".frd": read_frd, ".med": read_med, ".rmed": read_med, ".e": read_exodus, ".exo": read_exodus, ".ex2": read_exodus}


def own_fields(source):
    """Points, blocks of cells and fields of a file of CalculiX, MED or Exodus, or nothing of another."""
    reader = next((reader for suffix, reader in OWN_FIELDS.items() if source.lower().endswith(suffix)), None)
    # Tecplot writes files with this ending too.
    if reader is None and source.lower().endswith(".dat") and not any(re.match(r"\s*(TITLE|VARIABLES|ZONE)\b", line) for line in lines_of(source)):
        reader = read_dat
    if reader is None:
        return None
    import numpy

    found = read_own(source, reader)
    if not found.fields:
        how = {"CalculiX": "in CalculiX with *NODE FILE and U", "MED": "in Code_Aster as DEPL"}.get(found.program, "as a nodal variable of two or three components")
        sys.exit(f"it has no displacement at its nodes: have it written there ({how})")
    blocks = {}
    for shape, nodes, _ in found.cells:
        kind = OWN_CELLS.get((shape, len(nodes)), shape)
        blocks.setdefault((kind, len(nodes)), []).append([found.place(tag) for tag in nodes])
    fields = {}
    for name, rows in found.fields.items():
        displacement = "depl" in name.lower() or name.lower().startswith("disp")
        kind = numpy.float32 if found.single else float
        fields["displacement" if displacement and "displacement" not in fields else name] = numpy.array(rows, dtype=kind)
    # meshio's blocks take no kind that it does not know.
    cells = [types.SimpleNamespace(type=kind, data=numpy.array(nodes)) for (kind, _), nodes in blocks.items()]
    return numpy.array(found.points, dtype=float), cells, fields, False
