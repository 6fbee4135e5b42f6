"""Results of CalculiX (.frd) as text: nodes, cells and the displacement of the last step."""

FRD = {7: ("triangle", 3), 8: ("triangle", 6), 9: ("quadrilateral", 4), 10: ("quadrilateral", 8), 11: ("line", 2), 12: ("line", 3),
       1: ("hexahedron", 8), 2: ("prism", 6), 3: ("tetrahedron", 4), 4: ("hexahedron with 20 nodes", 20), 5: ("prism with 15 nodes", 15),
       6: ("tetrahedron with 10 nodes", 10)}


def frd_reals(line, start, count):
    return [real(line[start + 12 * i:start + 12 * i + 12]) for i in range(count) if line[start + 12 * i:start + 12 * i + 12].strip()]


def read_frd(source):
    found = Found("CalculiX")
    part = kind = None
    tag = 0
    nodes, values = [], {}
    for line in lines_of(source):
        key = line[:6].strip()
        if key in ("2C", "3C"):
            part = key
            wide = not line.rstrip().endswith(" 0")
        elif key.startswith("100C"):
            part = None
            wide = True
        elif line.startswith(" -4"):
            part = "field" if line[5:13].strip() == "DISP" else None
            values = {} if part else values
        elif line.startswith(" -3"):
            part = None
        elif part == "3C" and line.startswith(" -1"):
            tag, kind = (int(word) for word in line[3:].split()[:2])
            nodes = []
            if kind not in FRD:
                raise Unreadable(f"element {tag} is of kind {kind}, which CalculiX does not write")
        elif part == "3C" and line.startswith(" -2"):
            nodes += [int(word) for word in line[3:].split()]
            if len(nodes) >= FRD[kind][1]:
                found.cell(FRD[kind][0], nodes, (), tag)
        elif part in ("2C", "field") and line.startswith(" -1"):
            end = 13 if wide else 8
            row = frd_reals(line, end, 3)
            if part == "2C":
                found.point(int(line[3:end]), row)
            else:
                values[int(line[3:end])] = row
    if not found.points:
        raise Unreadable("it has no block of nodes (2C) as text: have the results written with *NODE FILE, not in binary")
    # Nodes without a result, such as those of springs, are told as such.
    nothing = [float("nan")] * 3
    if values:
        found.fields["displacement"] = [values.get(tag, nothing) for tag in found.index]
    return found
