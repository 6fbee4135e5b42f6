"""Text meshes of COMSOL (.mphtxt): one object Mesh, with the selections of domains and boundaries that were exported beside it."""

import re

# Dimension, shape and order of the nodes, which go row by row: corners, the middles of sides from corner to corner, centre.
COMSOL_CELLS = {"edg": (1, "line", [0, 1]), "edg2": (1, "line", [0, 1, 2]), "tri": (2, "triangle", [0, 1, 2]), "tri2": (2, "triangle", [0, 1, 2, 3, 5, 4]),
                "quad": (2, "quadrilateral", [0, 1, 3, 2]), "quad2": (2, "quadrilateral", [0, 1, 3, 2, 4, 7, 8, 5, 6])}
COMSOL_SOLIDS = {"tet": "tetrahedron", "pyr": "pyramid", "prism": "prism", "hex": "hexahedron", "tet2": "tetrahedron with 10 nodes", "pyr2": "pyramid with 14 nodes",
                 "prism2": "prism with 18 nodes", "hex2": "hexahedron with 27 nodes"}


class Comsol:
    """The numbers and texts of a file in their order. A comment goes from # to the end of its line."""

    def __init__(self, source):
        self.lines = lines_of(source).parts(lambda line: [line] if line.split("#")[0].strip() else [])
        self.at = 0
        self.rest = []

    def line(self):
        if self.at == len(self.lines):
            raise Unreadable("the file ends in the middle of its data: it is cut off")
        self.at += 1
        return self.lines[self.at - 1]

    def words(self, count):
        while len(self.rest) < count:
            self.rest += self.line().split("#")[0].split()
        taken, self.rest = self.rest[:count], self.rest[count:]
        return taken

    def whole(self):
        return int(self.words(1)[0])

    def text(self):
        """A text behind the number of its characters."""
        match = re.match(r"\s*(\d+) (.*)", self.line())
        if self.rest or match is None:
            raise Unreadable("a text with the number of its characters before it belongs here")
        count, rest = int(match[1]), match[2]
        comment = re.search(r"\s# \w[^#]*$", rest)
        return rest[:min(count, comment.start()) if comment else count].strip(" \0")

    def skip(self, count):
        """Passes over lines: the values in them are not as many as is said of them."""
        for _ in range(count):
            self.line()

    def rows(self, count, width, read):
        words = self.words(count * width)
        return [[read(word) for word in words[i:i + width]] for i in range(0, count * width, width)]

    def ended(self):
        return self.at == len(self.lines) and not self.rest

    def says(self, word):
        """Whether the comment of the next line has a word; nothing where the line has no comment."""
        text = list.__getitem__(self.lines, self.at) if self.at < len(self.lines) else ""
        return word in text.split("#", 1)[1] if "#" in text else None


def comsol_mesh(file, found):
    """Points and cells of an object Mesh, with shape, number of the entity and dimension; its space dimension."""
    version, dimension, count, lowest = (file.whole() for _ in range(4))
    if dimension not in (2, 3):
        raise Unreadable(f"its mesh has {dimension} dimensions instead of two")
    for tag, place in enumerate(file.rows(count, dimension, real), lowest):
        found.point(tag, place)
    cells = []
    for _ in range(file.whole()):
        kind, width, count = file.text(), file.whole(), file.whole()
        nodes = file.rows(count, width, int)
        says = file.says("parameter")
        old = says or says is None and version < 4
        if old:
            # Places of the nodes on the entity, a line for each element.
            file.whole()
            file.skip(file.whole())
        entities = file.words(file.whole())
        if old:
            file.words(2 * file.whole())
        if entities and len(entities) != count:
            raise Unreadable(f"it has {count} elements '{kind}' and geometric entities of {len(entities)}")
        cells.append((kind, width, nodes, [int(word) for word in entities] or [None] * count))
    return dimension, cells


def read_comsol(source):
    file, found = Comsol(source), Found("COMSOL")
    file.words(2)
    for _ in range(2):
        # Tags and types of the objects.
        for _ in range(file.whole()):
            file.text()
    meshes, selections, others = [], [], []
    while not file.ended():
        file.words(3)
        kind = file.text()
        if kind == "Mesh" and not meshes:
            meshes.append(comsol_mesh(file, found))
        elif kind == "Mesh":
            raise Unreadable("it has several meshes: export each into a file of its own, and name the files in [[mesh.parts]]")
        elif kind == "Selection":
            file.whole()
            label, _ = file.text(), file.text()
            of, count = file.whole(), file.whole()
            selections.append((label, of, [int(word) for word in file.words(count)]))
        else:
            others.append(kind)
            break
    if not meshes:
        raise Unreadable(f"it holds a {others[0]} and no mesh: export the mesh (Mesh, Export)" if others else "it holds no mesh")
    if others:
        raise Unreadable(f"it holds a {others[0]} too: export the mesh alone")
    dimension, cells = meshes[0]
    named = {}
    for label, of, entities in selections:
        for entity in entities:
            named.setdefault((of, entity), []).append(label)
    for kind, width, nodes, entities in cells:
        if kind in COMSOL_SOLIDS:
            for row in nodes:
                found.cell(COMSOL_SOLIDS[kind], row)
        elif kind in COMSOL_CELLS and len(COMSOL_CELLS[kind][2]) == width:
            comsol_cells(found, kind, nodes, entities, dimension, named)
        elif kind != "vtx":
            raise Unreadable(f"it has elements '{kind}' of {width} nodes: export the mesh in first or second order")
    return found


def comsol_cells(found, kind, rows, entities, dimension, named):
    way, shape, order = COMSOL_CELLS[kind]
    for row, entity in zip(rows, entities):
        groups = []
        if entity is not None:
            # The file counts domains from one and all else from zero; in COMSOL all begin with one.
            number = entity if way == dimension else entity + 1
            groups = [found.number(way, number, {})] + named.get((way, entity), [])
        found.cell(shape, [row[i] for i in order], groups)


READERS[".mphtxt"] = read_comsol
