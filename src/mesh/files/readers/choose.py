"""Which reader a file asks for."""

READERS = {".unv": read_unv, ".med": read_med, ".rmed": read_med, ".mmed": read_med, **dict.fromkeys((".e", ".exo", ".ex2", ".exii", ".exoii", ".exodus", ".g", ".gen"), read_exodus),
           ".frd": read_frd, ".vol": read_ngsolve, ".json": read_skfem, ".su2": read_su2}


def own_reader(source):
    """The reader of this program for a file, by its name and its first line, or none."""
    low = source.lower()
    if os.path.isdir(source) or os.path.basename(low) in ("mesh.header", "mesh.nodes", "mesh.elements", "mesh.boundary"):
        return read_elmer
    for suffix, reader in READERS.items():
        if low.endswith(suffix):
            return reader
    with open(source, "rb") as file:
        head = file.read(4000)
    # Sandia's netCDF, whatever it is called.
    if head[:4] in (b"CDF\1", b"CDF\2", b"CDF\5") or head.startswith(b"\x89HDF") and low.endswith(".nc"):
        return read_exodus
    if head.startswith(MARKS[1:]) and b"<" not in head[:4]:
        refuse("its text is encoded in UTF-16: save it in UTF-8 or ASCII")
    head = (head[3:] if head.startswith(MARKS[0]) else head).decode("latin-1")
    if re.search(r"^\s*BEGIN POINTS LIST", head, re.MULTILINE):
        return read_getfem
    if re.search(r"^(BEGIN +BULK|GRID[ *,]|C(TRIA|QUAD)[0-9A-Z]*[ *,])", head, re.MULTILINE | re.IGNORECASE):
        return read_nastran
    if re.search(r"^\s*(/PREP7|/BATCH|/COM,\s*ANSYS|NBLOCK,)", head, re.MULTILINE | re.IGNORECASE):
        return read_mapdl
    if re.match(r"(\$.*\n|\s*\n)*\*KEYWORD", head, re.IGNORECASE):
        return read_dyna
    if head.startswith("# Created by COMSOL"):
        return read_comsol
    if low.endswith((".node", ".ele")):
        refuse("the files of Triangle (.node, .ele) are not read: export the mesh as Gmsh (.msh), Medit (.mesh) or VTU")
    lines = [line.strip() for line in head.splitlines() if line.strip() and not line.lstrip().startswith("#")]
    first = lines[0] if lines else ""
    if first.lower().startswith("meshversionformatted"):
        return read_medit
    if re.fullmatch(r"\d+\s+\d+\s+\d+", first):
        return read_freefem
    if re.match(r'mesh\b.*elemtype', first, re.IGNORECASE):
        return read_gid
    if first == "mesh3d":
        return read_ngsolve
    if re.match(r"MFEM mesh v1\.\d", first):
        return read_mfem
    return None


def read_own(source, reader):
    """What the reader finds; what it cannot read ends with code 46 and a message."""
    try:
        found = reader(source)
        Lines.last = None
        found.mesh()
        return found
    except Unreadable as error:
        reason = str(error)
    except (ValueError, KeyError, IndexError, TypeError, AttributeError, struct.error, EOFError, OSError, OverflowError) as error:
        reason = plain(error)
    refuse(located(reason, source))


def refuse(reason):
    """Ends with code 46 and the reason why a file is not read."""
    print(reason.replace("\n", " "), file=sys.stderr)
    sys.exit(46)
