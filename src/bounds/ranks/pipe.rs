//! Ranks that are processes of MPI, each of which has started this program and passes on what it says
//! (`reference/hypercircle_dual/bracket.py`).

use std::cell::RefCell;
use std::io::{self, Read, Write};

use super::Ranks;

/// The streams between this process and the rank that has started it.
pub struct Pipe<R, W> {
    streams: RefCell<(R, W)>,
    ranks: usize,
    /// Called where a stream has ended: the rank is lost, and with it the bracket.
    lost: fn(&io::Error) -> !,
}

impl<R: Read, W: Write> Pipe<R, W> {
    /// Over streams that should be buffered, to a rank of so many; `lost` ends this process.
    pub fn new(input: R, output: W, ranks: usize, lost: fn(&io::Error) -> !) -> Self {
        Pipe { streams: RefCell::new((input, output)), ranks, lost }
    }

    /// Tells the rank that this is the end.
    pub fn done(&self) {
        self.ask(b"D", |_| Ok(()), &[]);
    }

    /// Writes a request, and reads as many numbers as the answer has.
    fn ask(&self, kind: &[u8], request: impl FnOnce(&mut W) -> io::Result<()>, counts: &[usize]) -> Vec<Vec<f64>> {
        let (input, output) = &mut *self.streams.borrow_mut();
        let asked = output.write_all(kind).and_then(|()| request(output)).and_then(|()| output.flush());
        let answer = asked.and_then(|()| counts.iter().map(|count| read(input, *count)).collect());
        answer.unwrap_or_else(|error| (self.lost)(&error))
    }
}

fn read(input: &mut impl Read, count: usize) -> io::Result<Vec<f64>> {
    let mut bytes = vec![0; 8 * count];
    input.read_exact(&mut bytes)?;
    Ok(bytes.as_chunks::<8>().0.iter().map(|word| f64::from_le_bytes(*word)).collect())
}

fn count(output: &mut impl Write, count: usize) -> io::Result<()> {
    output.write_all(&(count as u64).to_le_bytes())
}

fn numbers(output: &mut impl Write, numbers: &[f64]) -> io::Result<()> {
    count(output, numbers.len())?;
    numbers.iter().try_for_each(|number| output.write_all(&number.to_le_bytes()))
}

impl<R: Read, W: Write> Ranks for Pipe<R, W> {
    fn exchange(&self, to: &[(usize, Vec<f64>)], from: &[(usize, usize)]) -> Vec<Vec<f64>> {
        let request = |output: &mut W| {
            count(output, to.len())?;
            for (rank, given) in to {
                count(output, *rank)?;
                numbers(output, given)?;
            }
            count(output, from.len())?;
            for (rank, taken) in from {
                count(output, *rank)?;
                count(output, *taken)?;
            }
            Ok(())
        };
        let counts: Vec<usize> = from.iter().map(|(_, count)| *count).collect();
        self.ask(b"E", request, &counts)
    }

    fn gather(&self, own: &[f64]) -> Vec<Vec<f64>> {
        self.ask(b"G", |output| numbers(output, own), &vec![own.len(); self.ranks])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn requests_have_letters_counts_and_numbers_and_answers_numbers_alone() {
        let answer: Vec<u8> = [2.5, -1.0, 7.0, 8.0].into_iter().flat_map(f64::to_le_bytes).collect();
        let pipe = Pipe::new(&answer[..], Vec::new(), 2, |error| panic!("{error}"));
        assert_eq!(pipe.exchange(&[(1, vec![0.5])], &[(1, 2)]), [[2.5, -1.0]]);
        assert_eq!(pipe.gather(&[3.0]), [[7.0], [8.0]]);
        pipe.done();
        let words = |list: &[u64]| list.iter().flat_map(|word| word.to_le_bytes()).collect::<Vec<u8>>();
        let exchange = words(&[1, 1, 1, 0.5_f64.to_bits(), 1, 1, 2]);
        let expected = [b"E", &exchange[..], b"G", &words(&[1, 3.0_f64.to_bits()]), b"D"].concat();
        assert_eq!(pipe.streams.into_inner().1, expected);
    }
}
