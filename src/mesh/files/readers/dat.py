"""Tables of CalculiX (.dat): displacements of nodes, on the cells of the deck of the same name beside it."""

DECK_CELLS = {3: "triangle", 6: "triangle", 4: "quadrilateral", 8: "quadrilateral"}


def read_dat(source):
    values, reading, last = {}, False, None
    for line in lines_of(source):
        words = line.split()
        if line.strip().startswith("displacements (vx,vy,vz)"):
            # Every step has a table, and every set in it one of its own.
            time = words[-1]
            values = values if values and time == last else {}
            reading, last = True, time
        elif words and not words[0].lstrip("-").isdigit():
            reading = False
        elif reading and len(words) >= 3:
            values[int(words[0])] = in_space(words[1:4])
    if not values:
        raise Unreadable("it has no table of displacements (vx,vy,vz): ask for one with *NODE PRINT and U")
    deck = next((source[:-4] + end for end in (".inp", ".INP") if os.path.isfile(source[:-4] + end)), None)
    if deck is None:
        raise Unreadable(f"it has no cells, and there is no {os.path.basename(source[:-4])}.inp beside it: put the deck there, or hand in the .frd")
    found = Found("CalculiX")
    read_deck(deck, found)
    lacking = [tag for _, nodes, _ in found.cells for tag in nodes if tag not in values]
    if lacking:
        raise Unreadable(f"it has no displacement of node {lacking[0]}, which a cell of {os.path.basename(deck)} uses: print a set with all nodes")
    found.fields["displacement"] = [values.get(tag, [0.0] * 3) for tag in found.index]
    return found


def in_space(words):
    """Three numbers, where two are written zero as the third."""
    return ([real(x) for x in words] + [0.0] * 3)[:3]


def read_deck(deck, found, depth=0):
    """Nodes and plane cells of a deck."""
    part, wanted, begun = None, 0, []
    for line in lines_of(deck):
        text = line.strip()
        if text.startswith("**") or not text:
            continue
        if text.startswith("*"):
            upper = text.upper().replace(" ", "")
            part, begun = upper.split(",")[0], []
            if part == "*ELEMENT":
                kind = re.search(r"TYPE=(?:CPE|CPS|CAX|S|M3D)(\d)", upper)
                wanted = int(kind[1]) if kind else 0
            elif part == "*INCLUDE" and depth < 9:
                name = re.search(r"INPUT\s*=\s*([^,]+)", text, re.IGNORECASE)
                if name:
                    read_deck(os.path.join(os.path.dirname(deck), name[1].strip().strip('"')), found, depth + 1)
            continue
        words = [word.strip() for word in text.split(",") if word.strip()]
        if part == "*NODE" and words:
            found.point(int(words[0]), in_space(words[1:4]))
        elif part == "*ELEMENT" and wanted in DECK_CELLS:
            begun += [int(word) for word in words]
            if len(begun) > wanted:
                found.cell(DECK_CELLS[wanted], begun[1:wanted + 1], (), begun[0])
                begun = []
