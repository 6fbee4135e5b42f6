"""Keyword files of LS-DYNA (.k, .key, .dyn): nodes, shells with their parts, and sets of nodes, segments and shells."""

import os
import re
from collections import Counter

# ELFORM of the shells of a plane and of a body of revolution about x = 0.
DYNA_MADE_FOR = {12: "plane-stress", 13: "plane-strain", 14: "axisymmetric", 15: "axisymmetric"}
# Elements without an area, and nodes that no shell has.
DYNA_IDLE = re.compile("ELEMENT_(BEAM_|DISCRETE|MASS|INERTIA|SEATBELT|PLOTEL|BEARING|DIRECT_MATRIX|LANCING|TRIM)")
# Keywords that change nodes or make some.
DYNA_CHANGES = re.compile("NODE_(TRANSFORM|MERGE|REPLICATE)|INCLUDE_|CONTROL_REFINE_SHELL|ELEMENT_GENERALIZED|SET_NODE_.*BOX")


def dyna_blocks(source, folders=(), depth=0):
    """Keyword, width of a number and cards of each block, with those of files included from its folder or from others that are named. Comments are
    no cards, empty lines are."""
    lines = lines_of(source)
    folders = [os.path.dirname(source), *folders]
    starts = [number for number, line in enumerate(lines) if line.startswith("*")]
    wide = ten = ended = False
    for start, end in zip(starts, starts[1:] + [len(lines)]):
        words = lines[start][1:].upper().split()
        cards = lines[start + 1:end].parts(lambda line: [] if line.startswith("$") else [line.rstrip()])
        suffix = next((mark for mark in "%+-" if mark in [words[0][-1], *words[1:2]]), "") if words else ""
        keyword = words[0].rstrip("%+-") if words else ""
        if keyword == "END":
            ended = True
            break
        if keyword == "KEYWORD":
            wide, ten = "LONG=Y" in words, "I10=Y" in words
        elif keyword == "INCLUDE":
            for name in cards:
                if name.strip():
                    path = next((path for path in (os.path.join(folder, name.strip()) for folder in folders) if os.path.isfile(path)), None)
                    if depth > 9 or path is None:
                        raise Unreadable(f"it includes '{name.strip()}', which is not there: put it beside the deck")
                    yield from dyna_blocks(path, folders[1:], depth + 1)
        elif keyword in ("INCLUDE_PATH", "INCLUDE_PATH_RELATIVE"):
            folders += [os.path.join(os.path.dirname(source), name.strip()) for name in cards]
        elif any("BEGIN PGP" in card for card in cards):
            raise Unreadable(f"*{keyword} is encrypted: save the mesh without encryption")
        else:
            yield keyword, {"+": 20, "-": 8, "%": 10}.get(suffix, 20 if wide else 10 if ten else 8), cards
    if depth == 0 and not ended:
        yield "END", 0, []


def dyna_fields(card, widths):
    """The fields of a card, in columns or with commas."""
    return [word.strip() for word in card.split(",")] if "," in card else columns(card, widths)


def dyna_ints(card, widths):
    return [int(word or 0) for word in dyna_fields(card, widths)]


def dyna_head(keyword, cards):
    """Title and first card of a block, and the cards behind them."""
    titled = keyword.endswith("_TITLE")
    if len(cards) < 1 + titled:
        raise Unreadable(f"*{keyword} has no card: the file is cut off")
    return cards[0].strip() if titled else "", cards[titled], cards[1 + titled:]


class Dyna:
    """What is collected from the blocks."""

    def __init__(self):
        self.found = Found("LS-DYNA")
        self.titles, self.sections, self.forms = {}, {}, {}  # Title and section by part, ELFORM by section.
        self.left_out = Counter()

    def part(self, keyword, cards, width):
        # Options have more cards behind the first two, so that only the first part of such a block is told.
        for title, card in list(zip(cards[::2], cards[1::2]))[:None if keyword == "PART" else 1]:
            number, section = (dyna_ints(card, [max(width, 10)] * 2) + [0])[:2]
            self.titles[number], self.sections[number] = title.strip(), section

    def section(self, keyword, cards, width):
        step = 3 if keyword.endswith("_TITLE") else 2
        for card in cards[step - 2::step]:
            fields = dyna_fields(card, [max(width, 10)] * 8) + [""] * 8
            self.forms[int(fields[0] or 0)] = int(float(fields[1] or 2))
            if float(fields[6] or 0):
                return

    def names(self):
        """Titles of parts, where they tell them apart."""
        titles = list(self.titles.values())
        twice = sorted({title for title in titles if title and titles.count(title) > 1})
        if twice:
            self.found.notes.append(f"Several parts are called {', '.join(twice)}: these bodies have their numbers as names.")
        return {number: title for number, title in self.titles.items() if title not in twice}

    def nodes(self, cards, width):
        widths = [width] + [max(width, 16)] * 3
        for card in cards:
            if card.strip():
                tag, *place = dyna_fields(card, widths)
                self.found.point(int(tag), [nastran_real(x) for x in (place + [""] * 3)[:3]])

    def shells(self, keyword, cards, width):
        options = keyword.split("_")[2:]
        if set(options) - {"THICKNESS", "BETA", "MCID", "OFFSET", "DOF", "SHL4", "TO", "SHL8"}:
            raise Unreadable(f"*{keyword} is not read: write the shells as *ELEMENT_SHELL")
        cards = iter(cards)
        for card in cards:
            if not card.strip():
                continue
            tag, part, *nodes = (dyna_ints(card, [width] * 10) + [0] * 10)[:10]
            if tag < 1 or part < 1:
                raise Unreadable("a shell has no number or no part: its numbers do not stand in the columns of the format")
            # Thicknesses and angles of middles have a card of their own.
            thick = ["THICKNESS"] * (1 + any(nodes[4:])) if {"THICKNESS", "BETA", "MCID"}.intersection(options) else []
            for option in thick + [option for option in ("OFFSET", "DOF") if option in options]:
                if next(cards, None) is None:
                    raise Unreadable(f"shell {tag} has no card for {option}: the file is cut off")
            if 0 in nodes[:3]:
                raise Unreadable(f"shell {tag} has no node at corner {nodes.index(0) + 1}")
            nodes[3] = nodes[3] or nodes[2]
            shape, nodes = collapsed(tag, nodes)
            name = self.found.number(2, part, self.known)
            self.found.cell(shape, whole_or_corners(shape, nodes), [name], tag)
            form = self.forms.get(self.sections.get(part))
            if form in DYNA_MADE_FOR:
                self.found.made_for.setdefault(DYNA_MADE_FOR[form], f"*ELEMENT_SHELL of ELFORM {form}")

    def beams(self, cards, width):
        for card in cards:
            if card.strip():
                _, part, *ends = (dyna_ints(card, [width] * 4) + [0] * 4)[:4]
                self.found.cell("line", ends, [self.found.number(1, part, self.known)])

    def solids(self, keyword, cards, width):
        cards = [card for card in cards if card.strip()]
        rows = [dyna_ints(card, [width] * 10) for card in cards]
        # The nodes stand behind number and part, or in a card of their own.
        rows = [row[2:10] for row in rows] if keyword == "ELEMENT_TSHELL" or rows and len(rows[0]) > 2 and any(rows[0][2:]) else rows[1::2]
        names = {4: "tetrahedron", 5: "pyramid", 6: "prism", 8: "hexahedron", 10: "tetrahedron with 10 nodes"}
        for row in rows:
            nodes = list(dict.fromkeys(node for node in row if node))
            self.found.cell(names.get(len(nodes), "solid"), nodes)

    def set(self, keyword, cards, width):
        """A set of nodes or shells, by its members or by ranges of them, or of segments."""
        title, head, rows = dyna_head(keyword, cards)
        what = keyword.split("_")[1].lower()
        name = title or f"{what}_{dyna_ints(head, [max(width, 10)])[0]}"
        members = [dyna_ints(card, [max(width, 10)] * (4 if what == "segment" else 8)) for card in rows if card.strip()]
        if what == "segment":
            for nodes in members:
                ends = list(dict.fromkeys(node for node in nodes if node))
                if len(ends) == 2:
                    self.found.cell("line", ends, [name])
                else:
                    self.left_out[f"segments of {len(ends)} nodes in {name}"] += 1
            return
        tags = [tag for row in members for tag in row if tag]
        known = self.found.index if what == "node" else self.shells_known
        if "_GENERATE" in keyword:
            order = sorted(known)
            tags = [tag for first, last in zip(tags[::2], tags[1::2]) for tag in within(order, first, last)]
        lost = [tag for tag in tags if tag not in known]
        if lost:
            more = f" and {len(lost) - 1} more" if len(lost) > 1 else ""
            self.found.notes.append(f"set '{name}' has {what} {lost[0]}{more}, which the file does not have: it is without it")
        if what == "node":
            self.found.node_sets.setdefault(name, []).extend(tags)
        else:
            for tag in tags:
                self.found.group(tag, name)


def read_dyna(source):
    deck = Dyna()
    found, blocks = deck.found, []
    for keyword, width, cards in dyna_blocks(source):
        blocks.append((keyword, width, cards))
        if re.match("PART(_(INERTIA|CONTACT|PRINT|REPOSITION|AVERAGED|TITLE))*$", keyword):
            deck.part(keyword, cards, width)
        elif keyword in ("SECTION_SHELL", "SECTION_SHELL_TITLE"):
            deck.section(keyword, cards, width)
        elif keyword == "NODE":
            deck.nodes(cards, width)
        elif keyword == "END":
            found.notes.append("The deck has no *END: if it was cut off, what is missing is not told.")
        elif DYNA_CHANGES.match(keyword):
            raise Unreadable(f"*{keyword} is not read: save the mesh as it is used, with *NODE and *ELEMENT_SHELL")
    deck.known = deck.names()
    for keyword, width, cards in blocks:
        if re.match("ELEMENT_SHELL(_|$)", keyword):
            deck.shells(keyword, cards, width)
        elif keyword == "ELEMENT_BEAM":
            deck.beams(cards, width)
        elif keyword in ("ELEMENT_SOLID", "ELEMENT_TSHELL"):
            deck.solids(keyword, cards, width)
        elif DYNA_IDLE.match(keyword):
            deck.left_out["*" + keyword] += 1
        elif keyword.startswith("ELEMENT_"):
            raise Unreadable(f"*{keyword} is not read, which may have an area or a volume: use *ELEMENT_SHELL")
    deck.shells_known = set(found.by_tag)
    for keyword, width, cards in blocks:
        if re.match("SET_(NODE|SHELL)(_LIST)?(_GENERATE)?(_TITLE)?$|SET_SEGMENT(_TITLE)?$", keyword):
            deck.set(keyword, cards, width)
        elif re.match("SET_(NODE|SHELL|SEGMENT|2D_SEGMENT)_", keyword):
            deck.left_out["*" + keyword] += 1
    if deck.left_out:
        told = ", ".join(what if what.startswith("*") else f"{count} {what}" for what, count in deck.left_out.items())
        found.notes.append(f"Left out, as without an area or an edge of the plane: {told}.")
    return found


READERS.update(dict.fromkeys((".k", ".key", ".dyn"), read_dyna))
