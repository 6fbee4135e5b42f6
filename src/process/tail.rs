//! The end of what a process prints, in a memory that does not grow.

/// The last lines of a stream.
#[derive(Debug, Default)]
pub struct Tail {
    bytes: Vec<u8>,
}

impl Tail {
    const LINES: usize = 40;
    /// Bytes of a line that are kept.
    const WIDTH: usize = 2000;
    const KEPT: usize = Self::LINES * Self::WIDTH;

    /// Appends what was read; of more than is ever shown, the beginning is let go.
    pub fn push(&mut self, read: &[u8]) {
        self.bytes.extend_from_slice(&read[read.len().saturating_sub(Self::KEPT)..]);
        // Twice as much is kept between cuts, so that not every read moves all of it.
        if self.bytes.len() > 2 * Self::KEPT {
            self.bytes.drain(..self.bytes.len() - Self::KEPT);
        }
    }

    /// The last lines that are not empty at the end, each cut to its width.
    pub fn lines(&self) -> Vec<String> {
        let end = self.bytes.iter().rposition(|b| !b.is_ascii_whitespace()).map_or(0, |i| i + 1);
        let kept = &self.bytes[..end];
        if kept.is_empty() {
            return Vec::new();
        }
        let lines: Vec<&[u8]> = kept.split(|&b| b == b'\n').collect();
        let text = |line: &&[u8]| String::from_utf8_lossy(&line[..line.len().min(Self::WIDTH)]).trim_end().to_owned();
        lines[lines.len().saturating_sub(Self::LINES)..].iter().map(text).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_lines_stay_and_memory_does_not_grow() {
        let mut tail = Tail::default();
        for i in 0..200_000 {
            tail.push(format!("line {i}\n").as_bytes());
        }
        tail.push(&vec![b'x'; 1 << 20]);
        tail.push(b"\nlast\n\n");
        assert!(tail.bytes.capacity() < 8 * Tail::KEPT, "{}", tail.bytes.capacity());
        let lines = tail.lines();
        assert_eq!(lines.last().map(String::as_str), Some("last"));
        assert!(lines.iter().all(|line| line.len() <= Tail::WIDTH));
        assert!(Tail::default().lines().is_empty());
    }

    #[test]
    fn lines_arrive_in_pieces_of_any_size() {
        let text: String = (0..100).map(|i| format!("row {i}\n")).collect();
        let mut tail = Tail::default();
        text.as_bytes().chunks(7).for_each(|piece| tail.push(piece));
        let lines = tail.lines();
        assert_eq!((lines.len(), lines[0].as_str(), lines[39].as_str()), (40, "row 60", "row 99"));
    }
}
