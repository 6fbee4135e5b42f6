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
    source = named(source, target)
    try:
        if source.lower().endswith((".xdmf", ".xmf")):
            grids = xdmf_grids(source)
            if grids is not None:
                return grids
            prepare_meshio_for_xdmf(source)
            # Files that it names lie beside it.
            os.chdir(os.path.dirname(source))
        count_rows(source)
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
            mesh = read_legacy_vtk(source) if source.lower().endswith(".vtk") else None
            mesh = meshio.read(readable(source, target)) if mesh is None else mesh
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


def named(source, target):
    """The file, or a copy with the ending of its format where it has that of another: AVS's UCD is called .inp by those who write it."""
    if not source.lower().endswith(".inp"):
        return source
    with open(source, "rb") as file, open(target + ".avs", "wb") as copy:
        copy.write(file.read())
    return target + ".avs"


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
    elif suffix in (".tec", ".dat"):
        zones = sum(bool(re.match(r"ZONE\b", line.strip(), re.IGNORECASE)) for line in lines_of(source))
        if zones > 1:
            raise Unreadable(f"it has {zones} zones, of which one would be read: save each into a file of its own, and name the files in [[mesh.parts]]")
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
    whole = one_piece(head + rest) if rest else head
    changed, head, rest = whole != head + rest, whole[:500], whole[500:]
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
    if older == head and not marked and not changed:
        return source
    copy = target + os.path.splitext(source)[1]
    with open(copy, "wb") as file:
        file.write(content_of(source) if marked else older + rest)
    return copy


def one_piece(data):
    """VTK's XML with no piece but the one that has cells: meshio reads the last, whatever the others hold."""
    end = data.find(b"<AppendedData")
    head, tail = (data, b"") if end < 0 else (data[:end], data[end:])
    pieces = re.findall(rb"<Piece\b[^>]*>", head)
    empty = [piece for piece in pieces if re.search(rb'NumberOfCells\s*=\s*["\']\s*0*\s*["\']', piece)]
    if len(pieces) - len(empty) > 1:
        raise Unreadable(f"it has {len(pieces) - len(empty)} pieces, and does not say which of their points are the same: save it as one piece (in ParaView with Merge Blocks, "
                         "then Save Data)")
    for piece in empty if len(pieces) > 1 else []:
        start = head.index(piece)
        after = head.find(b"</Piece>", start) + len(b"</Piece>")
        head = head[:start] + head[after if not piece.endswith(b"/>") else start + len(piece):]
    return head + tail


# Formats of VTK that name other files, or hold grids without a list of cells.
VTK_NAMES_OTHERS, VTK_WITHOUT_CELLS = (".pvd", ".pvtu", ".vtm", ".vtmb"), (".vtp", ".vts", ".vtr", ".vti", ".pvts", ".pvtr", ".pvti", ".pvtp")

# Binary files of programs that also write a format that is read.
OF_PROGRAMS = {**dict.fromkeys((".mph", ".mphbin"), "export the mesh as text (.mphtxt)"), **dict.fromkeys((".cae", ".odb"), "write the input file (.inp)"),
               **dict.fromkeys((".db", ".dbb", ".rst", ".rth", ".mechdat", ".wbpj"), "write the archive (CDWRITE,DB: .cdb)"), ".d3plot": "hand in the keyword file (.k)"}


def unknown(suffix):
    """What to say of a file whose ending is that of no format that is read."""
    if suffix in OF_PROGRAMS:
        return f"files {suffix} are a program's own: {OF_PROGRAMS[suffix]}"
    if suffix in VTK_NAMES_OTHERS:
        return f"files {suffix} only name others: give one of these"
    if suffix in VTK_WITHOUT_CELLS:
        return f"files {suffix} have no list of cells: save it as an unstructured grid in VTU"
    return (f"files {suffix} are in no format that is read" if suffix else "its name has no ending that tells its format") + (
        ": export the mesh as Abaqus or CalculiX (.inp), Ansys (.cdb), LS-DYNA (.k), COMSOL (.mphtxt), Gmsh (.msh), MED, UNV, Exodus, Nastran or VTU")


def reason_of(source, error):
    """What a file holds that meshio does not read, and what to do; nothing where meshio's own message is to be shown."""
    if "Could not deduce file format" in str(error):
        return f"meshio cannot read it: {unknown(os.path.splitext(source)[1].lower())}"
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
