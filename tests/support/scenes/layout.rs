//! Which cells of a lattice belong to which body, and the sides along which bodies meet each other or nothing.

use crate::support::random::Random;

/// Where a side of a cell looks, in the order of a cell's sides.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Facing {
    South,
    East,
    North,
    West,
}

use Facing::{East, North, South, West};

impl Facing {
    /// The n-th of `divisions` + 1 points along that side of a cell, counter-clockwise.
    pub fn along(self, n: usize, divisions: usize) -> [usize; 2] {
        match self {
            South => [n, 0],
            East => [divisions, n],
            North => [divisions - n, divisions],
            West => [0, divisions - n],
        }
    }
}

const FACINGS: [Facing; 4] = [South, East, North, West];

/// Columns times rows of quadrilaterals, each of a body or empty.
pub struct Layout {
    columns: usize,
    rows: usize,
    /// Body of each cell, row by row from below.
    owner: Vec<Option<usize>>,
    /// Points of the lattice, row by row from below.
    pub points: Vec<[f64; 2]>,
    pub bodies: usize,
}

/// A chain of cell sides between a body and another one, or nothing.
pub struct Side {
    pub body: usize,
    /// The body across, which then has a side of the same chain.
    pub across: Option<usize>,
    /// Where the first piece looks.
    pub facing: Facing,
    /// Pieces as (cell, its side).
    pub pieces: Vec<(usize, Facing)>,
}

impl Layout {
    /// One to six bodies, each a rectangle of cells, which `grown` makes into other shapes.
    pub fn random(random: &mut Random, grown: bool) -> Layout {
        let (columns, rows) = (1 + random.below(3), 1 + random.below(3));
        let mut layout = Layout { columns, rows, owner: vec![None; columns * rows], points: Vec::new(), bodies: 0 };
        let wanted = 1 + random.below(6);
        for _ in 0..3 * wanted {
            if layout.bodies < wanted {
                layout.place(random, 2);
            }
        }
        if grown {
            for _ in 0..random.below(5) {
                layout.grow(random);
            }
        }
        layout
    }

    /// Four to six bodies that fill most of three columns.
    pub fn crowded(random: &mut Random) -> Layout {
        let rows = 2 + random.below(2);
        let mut layout = Layout { columns: 3, rows, owner: vec![None; 3 * rows], points: Vec::new(), bodies: 0 };
        let wanted = 4 + random.below(3);
        while layout.bodies < wanted && layout.owner.contains(&None) {
            let more = 1 + usize::from(random.chance(0.2));
            layout.place(random, more);
        }
        for _ in 0..random.below(4) {
            layout.grow(random);
        }
        layout
    }

    /// Adds a rectangular body of up to `most` cells along each side where there is room.
    fn place(&mut self, random: &mut Random, most: usize) {
        let (column, row) = (random.below(self.columns), random.below(self.rows));
        let wide = (column + 1 + random.below(most)).min(self.columns);
        let high = (row + 1 + random.below(most)).min(self.rows);
        let cells: Vec<usize> =
            (row..high).flat_map(|j| (column..wide).map(move |i| (i, j))).map(|(i, j)| j * self.columns + i).collect();
        let alone = |c: usize| FACINGS.iter().all(|&f| self.across(c, f).is_none_or(|d| self.owner[d].is_none()));
        // A body away from all others now and then.
        let reached = self.bodies == 0 || random.chance(0.1) || !cells.iter().all(|&c| alone(c));
        if reached && cells.iter().all(|&c| self.owner[c].is_none()) {
            cells.iter().for_each(|&c| self.owner[c] = Some(self.bodies));
            self.bodies += 1;
        }
    }

    /// Gives an empty cell to a body beside it.
    fn grow(&mut self, random: &mut Random) {
        let cell = random.below(self.owner.len());
        let beside = self.across(cell, random.pick(&FACINGS)).and_then(|c| self.owner[c]);
        if self.owner[cell].is_none() {
            self.owner[cell] = beside;
        }
    }

    /// Puts points on the lines of the lattice.
    pub fn lines(&mut self, x: &[f64], y: &[f64]) {
        self.points = (0..=self.rows).flat_map(|j| (0..=self.columns).map(move |i| [x[i], y[j]])).collect();
    }

    pub fn columns(&self) -> usize {
        self.columns
    }

    pub fn rows(&self) -> usize {
        self.rows
    }

    /// The cells that belong to a body, each with its body.
    pub fn cells(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        self.owner.iter().enumerate().filter_map(|(cell, owner)| Some((cell, (*owner)?)))
    }

    /// Column and row of a cell.
    pub fn place_of(&self, cell: usize) -> [usize; 2] {
        [cell % self.columns, cell / self.columns]
    }

    /// A point of a cell by its two coordinates in [0, 1].
    pub fn within(&self, cell: usize, [s, t]: [f64; 2]) -> [f64; 2] {
        let ([a, b], [c, d]) = (self.ends((cell, South)), self.ends((cell, North)));
        let [a, b, c, d] = [a, b, c, d].map(|p| self.points[p]);
        [0, 1].map(|k| (1.0 - t) * ((1.0 - s) * a[k] + s * b[k]) + t * (s * c[k] + (1.0 - s) * d[k]))
    }

    /// The cell across a side of a cell.
    fn across(&self, cell: usize, facing: Facing) -> Option<usize> {
        let (i, j) = (cell % self.columns, cell / self.columns);
        match facing {
            South => (j > 0).then(|| cell - self.columns),
            East => (i + 1 < self.columns).then(|| cell + 1),
            North => (j + 1 < self.rows).then(|| cell + self.columns),
            West => (i > 0).then(|| cell - 1),
        }
    }

    /// The two points of a cell's side, counter-clockwise.
    pub fn ends(&self, (cell, facing): (usize, Facing)) -> [usize; 2] {
        let (i, j) = (cell % self.columns, cell / self.columns);
        let at = |i: usize, j: usize| j * (self.columns + 1) + i;
        match facing {
            South => [at(i, j), at(i + 1, j)],
            East => [at(i + 1, j), at(i + 1, j + 1)],
            North => [at(i + 1, j + 1), at(i, j + 1)],
            West => [at(i, j + 1), at(i, j)],
        }
    }

    pub fn length(&self, piece: (usize, Facing)) -> f64 {
        let [a, b] = self.ends(piece).map(|p| self.points[p]);
        (b[0] - a[0]).hypot(b[1] - a[1])
    }

    /// The sides of a cell that bound its body, and what is across.
    fn outer(&self, cell: usize) -> impl Iterator<Item = (Facing, Option<usize>)> + '_ {
        let across = move |f: Facing| self.across(cell, f).and_then(|c| self.owner[c]);
        FACINGS.into_iter().map(move |f| (f, across(f))).filter(move |(_, other)| *other != self.owner[cell])
    }

    /// The outlines of a body: one polygon as far as it has neither hole nor pinch, else one for each cell. Pieces in
    /// order; `None` for sides inside the body.
    pub fn outlines(&self, body: usize, whole: bool) -> Vec<Vec<(usize, Facing)>> {
        let cells: Vec<usize> = (0..self.owner.len()).filter(|&c| self.owner[c] == Some(body)).collect();
        let outer: Vec<_> = cells.iter().flat_map(|&c| self.outer(c).map(move |(f, _)| (c, f))).collect();
        let mut ring = vec![outer[0]];
        while ring.len() < outer.len() {
            let end = self.ends(ring[ring.len() - 1])[1];
            let mut next = outer.iter().filter(|piece| self.ends(**piece)[0] == end);
            match (next.next(), next.next()) {
                (Some(piece), None) if *piece != ring[0] => ring.push(*piece),
                _ => break,
            }
        }
        if whole && ring.len() == outer.len() {
            return vec![ring];
        }
        cells.iter().map(|&c| FACINGS.map(|f| (c, f)).to_vec()).collect()
    }

    /// All sides. Sides of a body that look in different directions are different sides, unless `bent` allows for corners.
    pub fn sides(&self, bent: bool) -> Vec<Side> {
        let mut sides: Vec<Side> = Vec::new();
        for cell in 0..self.owner.len() {
            let Some(body) = self.owner[cell] else { continue };
            for (facing, across) in self.outer(cell) {
                if across.is_some_and(|other| other < body) {
                    continue;
                }
                let piece = (cell, facing);
                let joins = |side: &Side| {
                    side.body == body
                        && side.across == across
                        && (side.facing == facing || (bent && across.is_some()))
                        && self.lengthens(side, piece)
                };
                match sides.iter().position(joins) {
                    Some(found) => sides[found].pieces.push(piece),
                    None => sides.push(Side { body, across, facing, pieces: vec![piece] }),
                }
            }
        }
        let other = |side: &Side| {
            let turned = |(cell, facing): (usize, Facing)| {
                let opposite = FACINGS[(facing as usize + 2) % 4];
                (self.across(cell, facing).expect("a body across lies on a cell"), opposite)
            };
            let pieces: Vec<_> = side.pieces.iter().map(|p| turned(*p)).collect();
            Side { body: side.across.expect("an interface"), across: Some(side.body), facing: pieces[0].1, pieces }
        };
        let facing: Vec<Side> = sides.iter().filter(|s| s.across.is_some()).map(other).collect();
        sides.extend(facing);
        sides
    }

    /// True if a chain stays a chain with one more piece.
    fn lengthens(&self, side: &Side, piece: (usize, Facing)) -> bool {
        let [a, b] = self.ends(piece);
        let meets = |p: usize| side.pieces.iter().flat_map(|q| self.ends(*q)).filter(|q| *q == p).count();
        matches!((meets(a), meets(b)), (1, 0) | (0, 1))
    }

    /// The points of a side.
    pub fn corners(&self, side: &Side) -> Vec<usize> {
        side.pieces.iter().flat_map(|p| self.ends(*p)).collect()
    }
}
