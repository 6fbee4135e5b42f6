"""Node data of Gmsh's format, whose rows have the numbers of their nodes. meshio takes them in the order of the nodes of the file."""


def msh_nodes(version, rows):
    """The numbers of the nodes, in the order of the file."""
    rows = iter(rows)
    if version < 4:
        return [int(next(rows).split()[0]) for _ in range(int(next(rows)))]
    count, numbers = int(next(rows).split()[0]), []
    for _ in range(count):
        size = int(next(rows).split()[3])
        block = [next(rows).split()[0] for _ in range(size)]
        numbers += [int(word) for word in block]
        if version >= 4.1:
            # The coordinates follow the numbers.
            for _ in range(size):
                next(rows)
    return numbers


def msh_data(rows, numbers):
    """The lines of a section of node data with a row for each of `numbers`, in their order; without a value where there is none."""
    at, counts = 0, []
    for _ in range(3):
        counts.append(int(rows[at]))
        at += 1 + counts[-1]
    head, body = rows[:at], [row for row in rows[at:] if row.strip()]
    width = int(head[-counts[-1] + 1])
    known, found = set(numbers), {}
    for row in body:
        number = int(row.split()[0])
        if number not in known:
            raise Unreadable(f"$NodeData has a row for node {number}, which is not among its nodes")
        if number in found:
            raise Unreadable(f"$NodeData has two rows for node {number}")
        found[number] = row
    head[-counts[-1] + 2] = str(len(numbers))
    return head + [found.get(number, f"{number}" + " nan" * width) for number in numbers]


def by_node(source, target):
    """The file to read: of a text of Gmsh's a copy with its node data in the order of the nodes."""
    if not source.lower().endswith(".msh"):
        return source
    with open(source, "rb") as file:
        head = file.read(200)
    kind = re.search(rb"\$MeshFormat\s+(\d\.?\d*)\s+0\s", head)
    if kind is None:
        return source
    lines = lines_of(source)
    begins = {name: [i for i, line in enumerate(lines) if line.strip() == name] for name in ("$Nodes", "$EndNodes", "$NodeData", "$EndNodeData")}
    if len(begins["$Nodes"]) != 1 or len(begins["$EndNodes"]) != 1 or len(begins["$NodeData"]) != len(begins["$EndNodeData"]):
        return source
    try:
        numbers = msh_nodes(float(kind[1]), lines[begins["$Nodes"][0] + 1:begins["$EndNodes"][0]])
        for start, end in reversed(list(zip(begins["$NodeData"], begins["$EndNodeData"]))):
            lines[start + 1:end] = msh_data(lines[start + 1:end], numbers)
    except (ValueError, IndexError, StopIteration) as error:
        raise Unreadable(f"its $Nodes or $NodeData do not follow the format of Gmsh ({error})") from None
    copy = target + ".msh"
    with open(copy, "w", encoding="utf-8") as file:
        file.write("\n".join(lines) + "\n")
    return copy
