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
    said = io.StringIO()
    try:
        if source.lower().endswith((".xdmf", ".xmf")):
            grids = xdmf_grids(source)
            if grids is not None:
                return grids
            prepare_meshio_for_xdmf(source)
        count_rows(source)
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


def count_rows(source):
    """Refuses a file with other rows than it announces, of formats in which meshio does not look at that."""
    suffix = os.path.splitext(source)[1].lower()
    if suffix == ".xml":
        text = content_of(source).decode("latin-1")
        for what, rows in (("vertices", "vertex"), ("cells", "(?:triangle|interval|quadrilateral|tetrahedron|hexahedron)")):
            announced = re.search(rf'<{what}\s+size="(\d+)"', text)
            present = len(re.findall(rf"<{rows}\s", text))
            if announced and int(announced[1]) != present:
                raise Unreadable(f"it announces {announced[1]} {what} and has {present}")
    elif suffix in (".off", ".avs"):
        lines = lines_of(source).without("#")
        first, *others = [line.split() for line in lines[:2]]
        # OFF may stand in a line of its own.
        alone = suffix == ".off" and len(first) == 1
        counts = [int(word) for word in (others[0] if alone else [word for word in first if word.upper() != "OFF"])[:2]]
        rows = lines[2 if alone else 1:]
        # A cell of AVS has the name of its shape as the third word; rows of values stand behind the cells.
        cells = [len(row.split()) > 2 and row.split()[2].isalpha() for row in rows]
        present = [len(rows) - counts[1], counts[1]] if suffix == ".off" else [cells.index(True) if True in cells else len(cells), sum(cells)]
        if present != counts:
            raise Unreadable(f"it announces {counts[0]} points and {counts[1]} cells and has {present[0]} and {present[1]}" if suffix == ".avs"
                             else f"it announces {counts[0]} points and {counts[1]} cells, and {len(rows)} rows stand below that")


def readable(source, target):
    """The file to read: a copy of a text with a byte order mark, of VTU of version 2, which newer VTK writes and which differs in nothing that
    meshio needs, and of VTU that names a compressor and is text."""
    with open(source, "rb") as file:
        head = file.read(500)
        rest = file.read() if b"<VTKFile" in head else b""
    if re.match(rb"OFF[ \t]+\d", head):
        with open(target + ".off", "wb") as file, open(source, "rb") as text:
            file.write(b"OFF\n" + text.read()[3:].lstrip(b" \t"))
        return target + ".off"
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
    if isinstance(error, SystemExit) or str(error) and type(error).__module__.startswith("meshio"):
        lost = None
    else:
        lost = f"meshio cannot read it: {plain(error)}"
    if not source.lower().endswith(".vtk"):
        return lost
    with open(source, "rb") as file:
        head = file.read(2000).decode("latin-1")
    version, form, kind = (re.search(pattern, head, re.MULTILINE) for pattern in (r"Version\s+([0-9.]+)", "^(ASCII|BINARY)", r"^DATASET\s+(\w+)"))
    if kind is None:
        return lost
    told = ", ".join(word[1] for word in (version, form, kind) if word)
    lacking = f" because of {error}" if isinstance(error, KeyError) else ""
    return f"meshio cannot read it, a VTK file ({told}){lacking}: save it as an unstructured grid in VTU, as text (ASCII) or compressed with zlib"
