//! Values on sides: so many for each edge or contact pair, one after the other.

/// For each of a number of sides a list of values, as many as its degree asks for.
#[derive(Debug, Clone, PartialEq)]
pub struct SideValues<T> {
    start: Vec<usize>,
    values: Vec<T>,
}

impl<T: Copy> SideValues<T> {
    /// `counts` values on each side, all equal to `value`.
    pub fn filled(counts: impl IntoIterator<Item = usize>, value: T) -> Self {
        let start = starts(counts);
        let values = vec![value; start.last().copied().unwrap_or(0)];
        SideValues { start, values }
    }

    /// The given values, as many on each side as `counts` says.
    ///
    /// # Panics
    /// Where there are not as many values as that.
    pub fn new(counts: impl IntoIterator<Item = usize>, values: Vec<T>) -> Self {
        let start = starts(counts);
        assert_eq!(start.last(), Some(&values.len()), "one value for each that was counted");
        SideValues { start, values }
    }

    /// The values of side `i`.
    pub fn of(&self, i: usize) -> &[T] {
        &self.values[self.start[i]..self.start[i + 1]]
    }

    /// The values of side `i`, to change.
    pub fn of_mut(&mut self, i: usize) -> &mut [T] {
        &mut self.values[self.start[i]..self.start[i + 1]]
    }

    /// Number of sides.
    pub fn len(&self) -> usize {
        self.start.len() - 1
    }

    /// True if there are no sides.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The values of each side.
    pub fn iter(&self) -> impl DoubleEndedIterator<Item = &[T]> + ExactSizeIterator + Clone {
        self.start.windows(2).map(|w| &self.values[w[0]..w[1]])
    }

    /// The values of all sides, for filling in parallel.
    pub fn parts_mut(&mut self) -> Vec<&mut [T]> {
        parts(&mut self.values, &self.start)
    }

    /// All values, side by side.
    pub fn values(&self) -> &[T] {
        &self.values
    }

    /// All values, to change.
    pub fn values_mut(&mut self) -> &mut [T] {
        &mut self.values
    }
}

/// Where each of a row of lists begins that have so many values, and the end of the last one.
pub fn starts(counts: impl IntoIterator<Item = usize>) -> Vec<usize> {
    let mut start = vec![0];
    start.extend(counts.into_iter().scan(0, |end, count| {
        *end += count;
        Some(*end)
    }));
    start
}

/// The lists of `values` that begin where `start` says, as [`starts`] gives it.
pub fn parts<'a, T>(values: &'a mut [T], start: &[usize]) -> Vec<&'a mut [T]> {
    let mut rest = values;
    let mut parts = Vec::with_capacity(start.len().saturating_sub(1));
    for ends in start.windows(2) {
        let (part, behind) = rest.split_at_mut(ends[1] - ends[0]);
        parts.push(part);
        rest = behind;
    }
    parts
}

impl<T, L: AsRef<[T]>> FromIterator<L> for SideValues<T>
where
    T: Copy,
{
    fn from_iter<I: IntoIterator<Item = L>>(sides: I) -> Self {
        let mut all = SideValues { start: vec![0], values: Vec::new() };
        for side in sides {
            all.values.extend_from_slice(side.as_ref());
            all.start.push(all.values.len());
        }
        all
    }
}

#[cfg(test)]
mod tests {
    use super::SideValues;

    #[test]
    fn sides_have_as_many_values_as_they_were_given() {
        let sides: SideValues<f64> = [vec![1.0, 2.0], vec![], vec![3.0]].into_iter().collect();
        assert_eq!(sides.len(), 3);
        assert_eq!((sides.of(0), sides.of(1), sides.of(2)), (&[1.0, 2.0][..], &[][..], &[3.0][..]));
        let mut zero = SideValues::filled([2, 0, 1], 0.0);
        zero.of_mut(2)[0] = 3.0;
        zero.of_mut(0).copy_from_slice(&[1.0, 2.0]);
        assert_eq!(zero, sides);
        assert_eq!(SideValues::new([2, 0, 1], vec![1.0, 2.0, 3.0]), sides);
        assert_eq!(sides.iter().map(<[f64]>::len).collect::<Vec<_>>(), [2, 0, 1]);
    }
}
