"""Reads files through meshio, which is loaded without what it has for its command line and for messages in colour: that takes longer to load
than all else. Some files that meshio refuses are changed before it sees them, others are refused with their reason."""

import contextlib
import io
import os
import re
import sys
import types

# Nodes of a pixel of VTK, which goes row by row, as those of a quadrilateral.
PIXEL = [0, 1, 3, 2]
# Cells of Lagrange's of VTK whose nodes are those of others.
LAGRANGE = {("VTK_LAGRANGE_CURVE", 2): "line", ("VTK_LAGRANGE_CURVE", 3): "line3", ("VTK_LAGRANGE_TRIANGLE", 3): "triangle",
            ("VTK_LAGRANGE_TRIANGLE", 6): "triangle6", ("VTK_LAGRANGE_QUADRILATERAL", 4): "quad", ("VTK_LAGRANGE_QUADRILATERAL", 9): "quad9"}


class Console:
    """Messages to standard error, as those of `rich` are, and plain."""

    def __init__(self, **_):
        pass

    def print(self, text, **_):
        print(re.sub(r"\[/?(?:bold|red|yellow)\]", "", text), file=sys.stderr)


def load_meshio():
    """The module; ImportError where there is none."""
    left_out = {
        "rich": {},
        "rich.console": {"Console": Console},
        "meshio._cli": {},
        # The version is written to files, and nothing is written here.
        "meshio.__about__": {"__version__": ""},
    }
    for name, content in left_out.items():
        sys.modules[name] = types.ModuleType(name)
        vars(sys.modules[name]).update(content)
    import meshio

    return meshio


def read_with_meshio(source, target):
    """The mesh of a file. `target` names a place for a changed copy; of a time series the last step is read."""
    import meshio

    # Of pixels meshio knows the name, and lacks dimension and number of nodes.
    for module, table, value in (("_mesh", "topological_dimension", 2), ("_common", "num_nodes_per_cell", 4)):
        getattr(getattr(meshio, module, None), table, {}).setdefault("pixel", value)
    grids = xdmf_grids(source) if source.lower().endswith((".xdmf", ".xmf")) else None
    if grids is not None:
        return grids
    if source.lower().endswith(".su2"):
        count_rows_of_su2(source)
    said = io.StringIO()
    try:
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
            mesh = meshio.read(readable(source, target))
    except (ModuleNotFoundError, Unreadable):
        raise
    except (Exception, SystemExit) as error:
        reason = reason_of(source, error)
        if reason is not None:
            raise Unreadable(reason) from None
        print(said.getvalue(), file=sys.stderr)
        raise
    for block, cells in enumerate(mesh.cells):
        nodes = cells.data.shape[1] if getattr(cells.data, "ndim", 0) == 2 else 0
        if cells.type == "pixel":
            mesh.cells[block] = meshio.CellBlock("quad", cells.data[:, PIXEL])
        elif (cells.type, nodes) in LAGRANGE:
            mesh.cells[block] = meshio.CellBlock(LAGRANGE[cells.type, nodes], cells.data)
    return mesh


def count_rows_of_su2(source):
    """Refuses a file of SU2 in which more or fewer rows stand than a section announces: meshio reads what is announced."""
    section, announced, rows = None, 0, 0
    for number, line in enumerate([*lines_of(source), "END="], 1):
        text = line.split("%")[0].strip()
        key, equals, value = text.partition("=")
        if not equals:
            rows += bool(text)
            continue
        if section and rows != announced:
            raise Unreadable(f"line {number}: {section}= announces {announced} rows, and {rows} stand below it: correct the number, or write the file again")
        key, value = key.strip(), value.split()
        if key in ("NELEM", "NPOIN", "MARKER_ELEMS") and value and value[0].isdigit():
            section, announced, rows = key, int(value[0]), 0
        else:
            section = None


def readable(source, target):
    """The file to read: a copy of a text with a byte order mark, of VTU of version 2, which newer VTK writes and which differs in nothing that
    meshio needs, and of VTU that names a compressor and is text."""
    with open(source, "rb") as file:
        head = file.read(500)
        rest = file.read() if b"<VTKFile" in head else b""
    older = re.sub(rb'(<VTKFile[^>]*\bversion=)"2\.\d+"', rb'\1"1.0"', head)
    if b"vtkLZ4DataCompressor" in head and not re.search(rb'format="(binary|appended)"', head + rest):
        older = re.sub(rb'\scompressor="vtkLZ4DataCompressor"', b"", older)
    if b"vtkLZ4DataCompressor" in older:
        raise Unreadable("its arrays are compressed with LZ4 (vtkLZ4DataCompressor): save it as text (ASCII) or compressed with zlib")
    # XML has marks that its own reader knows.
    marked = head.startswith(MARKS) and b"<" not in head[:8]
    if older == head and not marked:
        return source
    copy = target + os.path.splitext(source)[1]
    with open(copy, "wb") as file:
        file.write(content_of(source) if marked else older + rest)
    return copy


def reason_of(source, error):
    """What a file holds that meshio does not read, and what to do; nothing where meshio's own message is to be shown."""
    low = source.lower()
    if low.endswith(".su2") and isinstance(error, KeyError):
        return f"it has elements of type {error}, and of SU2 only cells of first order are read (3, 5, 9): export the mesh in another format"
    if not low.endswith(".vtk"):
        return None
    with open(source, "rb") as file:
        head = file.read(2000).decode("latin-1")
    version, form, kind = (re.search(pattern, head, re.MULTILINE) for pattern in (r"Version\s+([0-9.]+)", "^(ASCII|BINARY)", r"^DATASET\s+(\w+)"))
    if kind is None:
        return None
    told = ", ".join(word[1] for word in (version, form, kind) if word)
    lacking = f" because of {error}" if isinstance(error, KeyError) else ""
    return f"meshio cannot read it, a VTK file ({told}){lacking}: save it as an unstructured grid in VTU, as text (ASCII) or compressed with zlib"
