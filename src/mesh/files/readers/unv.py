"""Ideas universal files (.unv)."""

# Shape by number of the element's kind; order of nodes goes around, with the middles between corners.
UNV_PLANE = {"triangle": {41, 42, 51, 52, 61, 62, 71, 72, 74, 81, 82, 91, 92}, "quadrilateral": {44, 45, 54, 55, 64, 65, 84, 85, 94, 95, 300},
             "line": {11, 21, 22, 23, 24, 31}}
UNV_SOLID = {111: "tetrahedron", 118: "tetrahedron with 10 nodes", 112: "prism", 113: "prism with 15 nodes", 115: "hexahedron",
             116: "hexahedron with 20 nodes", 101: "prism", 104: "hexahedron"}
UNV_AROUND = {("line", 3): [0, 2, 1], ("triangle", 6): [0, 2, 4, 1, 3, 5], ("quadrilateral", 8): [0, 2, 4, 6, 1, 3, 5, 7]}
UNV_NINE = [0, 2, 4, 6, 1, 3, 5, 7, 8]


def unv_nine(found, nodes):
    """Nodes of a quadrilateral of nine, which UNV does not have: Gmsh writes its corners first, others go around."""
    if not all(tag in found.index for tag in nodes):
        return nodes
    points = [found.points[found.index[tag]] for tag in nodes]
    off = lambda order, i: sum((points[order[i]][c] + points[order[(i + 1) % 4]][c] - 2 * points[order[4 + i]][c]) ** 2 for c in range(2))
    orders = (list(range(9)), UNV_NINE)
    return [nodes[i] for i in min(orders, key=lambda order: sum(off(order, i) for i in range(4)))]


def unv_ints(line):
    """Integers of a line, which may touch in columns of ten."""
    try:
        return [int(word) for word in line.split()]
    except ValueError:
        raise Unreadable(f"it has '{line.strip()[:60]}' where integers are expected") from None


def unv_datasets(lines):
    """Number and lines of each dataset."""
    at = 0
    while at < len(lines):
        if lines[at].strip() != "-1":
            at += 1
            continue
        if at + 1 >= len(lines):
            return
        end = next((i for i in range(at + 2, len(lines)) if lines[i].strip() == "-1"), None)
        if end is None:
            raise Unreadable(f"dataset {lines[at + 1].strip()} has no end: the file is cut off")
        yield lines[at + 1].strip(), lines[at + 2:end]
        at = end + 1


def unv_nodes(found, number, rows):
    if number == "15":
        for row in rows:
            words = row.split()
            found.point(int(words[0]), [real(x) for x in words[4:7]])
        return
    for head, row in zip(rows[::2], rows[1::2]):
        words = row.split()
        if len(words) != 3:
            words = [row[:25], row[25:50], row[50:75]]
        found.point(unv_ints(head)[0], [real(x) for x in words])


def unv_cells(found, rows):
    at = 0
    while at < len(rows):
        head = unv_ints(rows[at])
        at += 1
        if not head:
            continue
        if len(head) < 6:
            raise Unreadable(f"an element begins with {len(head)} integers instead of six")
        label, kind, count = head[0], head[1], head[-1]
        found.labels.add(label)
        shape = next((shape for shape, kinds in UNV_PLANE.items() if kind in kinds), None)
        # Beams have a line for their orientation.
        if kind in (21, 22, 23, 24) or (kind == 11 and at < len(rows) and len(unv_ints(rows[at])) == 3):
            at += 1
        nodes = []
        while len(nodes) < count and at < len(rows):
            nodes += unv_ints(rows[at])
            at += 1
        if len(nodes) != count:
            raise Unreadable(f"element {label} has {len(nodes)} nodes instead of {count}")
        if kind == 74 and count == 4:
            shape = "quadrilateral"
        if shape is None and kind not in UNV_SOLID:
            if count > 2:
                found.cell(f"kind {kind} of UNV", nodes, (), label)
            continue
        if (shape, count) == ("quadrilateral", 9):
            nodes = unv_nine(found, nodes)
        else:
            nodes = [nodes[i] for i in UNV_AROUND.get((shape, count), range(count))]
        property_ = head[2] if len(head) == 6 else head[3]
        found.cell(shape or UNV_SOLID[kind], nodes, (), label)
        found.properties[label] = (shape, property_)


def unv_groups(found, number, rows):
    # A member is its kind and number; newer datasets put two more integers behind them.
    width = 4 if number in ("2435", "2452", "2467", "2477") else 2
    at = 0
    while at + 1 < len(rows):
        head, name = unv_ints(rows[at]), rows[at + 1].strip()
        at += 2
        if not head:
            continue
        name = name or str(head[0])
        entities = []
        while len(entities) < width * head[-1] and at < len(rows):
            entities += unv_ints(rows[at])
            at += 1
        if len(entities) < width * head[-1]:
            raise Unreadable(f"group '{name}' has fewer members than the {head[-1]} it announces")
        lost = []
        for member in range(0, width * head[-1], width):
            kind, tag = entities[member:member + 2]
            if tag not in {7: found.index, 8: found.labels}.get(kind, (tag,)):
                lost.append(f"{'node' if kind == 7 else 'element'} {tag}")
            if kind == 7:
                found.node_sets.setdefault(name, []).append(tag)
            elif kind == 8:
                found.group(tag, name)
                at_cell = found.by_tag.get(tag)
                if at_cell is not None:
                    dimension = 1 if found.cells[at_cell][0] == "line" else 2
                    found.numbers.setdefault((dimension, head[0]), name)
        if lost:
            more = f" and {len(lost) - 1} more" if len(lost) > 1 else ""
            found.notes.append(f"group '{name}' has {lost[0]}{more}, which the file does not have: it is without it")


def read_unv(source):
    found = Found("UNV")
    found.properties, found.labels = {}, set()
    datasets = list(unv_datasets(lines_of(source)))
    if not datasets:
        raise Unreadable("it has no dataset between lines of -1")
    for number, rows in datasets:
        if number in ("15", "781", "2411"):
            unv_nodes(found, number, rows)
        elif number in ("71", "780", "2412"):
            unv_cells(found, rows)
    for number, rows in datasets:
        if number in ("2417", "2429", "2430", "2432", "2435", "2452", "2467", "2477"):
            unv_groups(found, number, rows)
    # Where no group has a cell, its property is its number.
    used = {shape: {p for s, p in found.properties.values() if s == shape} for shape in UNV_PLANE}
    for label, (shape, value) in found.properties.items():
        groups = found.cells[found.by_tag[label]][2]
        if shape and not groups and len(used[shape]) > 1:
            groups.append(found.number(1 if shape == "line" else 2, value, {}))
    return found
