//! Lists of numbers of eight bytes in a file, each list behind its length.

use std::io::{self, Read, Write};

/// A count or index that is none.
const NONE: u64 = u64::MAX;

/// Writes lists one after the other.
pub struct Writer<W>(pub W);

impl<W: Write> Writer<W> {
    /// Writes indices.
    pub fn indices(&mut self, list: impl IntoIterator<Item = usize>) -> io::Result<()> {
        let list: Vec<usize> = list.into_iter().collect();
        self.0.write_all(&(list.len() as u64).to_le_bytes())?;
        list.iter().try_for_each(|index| self.0.write_all(&(*index as u64).to_le_bytes()))
    }

    /// Writes indices, of which some are none.
    pub fn some_indices(&mut self, list: impl IntoIterator<Item = Option<usize>>) -> io::Result<()> {
        self.indices(list.into_iter().map(|index| index.unwrap_or(NONE as usize)))
    }

    /// Writes numbers.
    pub fn numbers(&mut self, list: impl IntoIterator<Item = f64>) -> io::Result<()> {
        self.indices(list.into_iter().map(|number| number.to_bits() as usize))
    }

    /// Writes pairs of numbers.
    pub fn vectors<'a>(&mut self, list: impl IntoIterator<Item = &'a [f64; 2]>) -> io::Result<()> {
        self.numbers(list.into_iter().flatten().copied())
    }

    /// Writes lists of indices: how many each has, and all of them.
    pub fn lists<'a>(&mut self, lists: impl IntoIterator<Item = &'a [usize]> + Clone) -> io::Result<()> {
        self.indices(lists.clone().into_iter().map(<[usize]>::len))?;
        self.indices(lists.into_iter().flatten().copied())
    }
}

/// Reads them in the same order.
pub struct Reader<R>(pub R);

impl<R: Read> Reader<R> {
    /// Reads indices.
    pub fn indices(&mut self) -> io::Result<Vec<usize>> {
        let mut word = [0; 8];
        self.0.read_exact(&mut word)?;
        let count = u64::from_le_bytes(word);
        let mut bytes = Vec::new();
        // Only what is there takes memory, whatever the count says.
        let read = Read::by_ref(&mut self.0).take(count.saturating_mul(8)).read_to_end(&mut bytes)?;
        if read as u64 / 8 != count {
            return Err(io::ErrorKind::UnexpectedEof.into());
        }
        Ok(bytes.as_chunks::<8>().0.iter().map(|word| u64::from_le_bytes(*word) as usize).collect())
    }

    /// Reads indices, of which some are none.
    pub fn some_indices(&mut self) -> io::Result<Vec<Option<usize>>> {
        Ok(self.indices()?.into_iter().map(|index| (index != NONE as usize).then_some(index)).collect())
    }

    /// Reads numbers.
    pub fn numbers(&mut self) -> io::Result<Vec<f64>> {
        Ok(self.indices()?.into_iter().map(|bits| f64::from_bits(bits as u64)).collect())
    }

    /// Reads groups of N numbers.
    pub fn vectors<const N: usize>(&mut self) -> io::Result<Vec<[f64; N]>> {
        grouped(&self.numbers()?)
    }

    /// Reads groups of N indices.
    pub fn tuples<const N: usize>(&mut self) -> io::Result<Vec<[usize; N]>> {
        grouped(&self.indices()?)
    }

    /// Reads lists of indices.
    pub fn lists(&mut self) -> io::Result<Vec<Vec<usize>>> {
        let (counts, all) = (self.indices()?, self.indices()?);
        let mut rest = &all[..];
        let lists = counts.into_iter().map(|count| {
            let (list, behind) = rest.split_at_checked(count).ok_or(io::ErrorKind::InvalidData)?;
            rest = behind;
            Ok(list.to_vec())
        });
        lists.collect()
    }
}

/// Values in groups of N; what is left over belongs to no file of this kind.
pub fn grouped<T: Copy, const N: usize>(values: &[T]) -> io::Result<Vec<[T; N]>> {
    let (groups, rest) = values.as_chunks::<N>();
    if rest.is_empty() { Ok(groups.to_vec()) } else { Err(io::ErrorKind::InvalidData.into()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_come_back_and_short_files_are_refused() {
        let mut bytes = Vec::new();
        let mut out = Writer(&mut bytes);
        out.numbers([1.5, -0.0, f64::MAX]).expect("memory");
        out.some_indices([Some(3), None]).expect("memory");
        out.lists([&[1, 2][..], &[], &[7]]).expect("memory");
        let mut back = Reader(&bytes[..]);
        assert_eq!(back.numbers().expect("there"), [1.5, -0.0, f64::MAX]);
        assert_eq!(back.some_indices().expect("there"), [Some(3), None]);
        assert_eq!(back.lists().expect("there"), [vec![1, 2], vec![], vec![7]]);
        assert!(back.indices().is_err());
        assert!(Reader(&bytes[..30]).numbers().is_err());
        assert!(grouped::<_, 2>(&[1, 2, 3]).is_err());
    }
}
