//! Values by name, in the order of the deck. Abaqus takes upper and lower case for the same.

use std::collections::HashMap;

#[derive(Clone)]
pub(super) struct Names<T> {
    /// Names as the deck writes them first.
    list: Vec<(String, T)>,
    /// Positions in the list by name in upper case.
    index: HashMap<String, usize>,
}

impl<T> Default for Names<T> {
    fn default() -> Self {
        Names { list: Vec::new(), index: HashMap::new() }
    }
}

impl<T: Default> Names<T> {
    /// The value of `name`, which is made where there is none.
    pub fn of(&mut self, name: &str) -> &mut T {
        let next = self.list.len();
        let at = *self.index.entry(name.to_ascii_uppercase()).or_insert(next);
        if at == next {
            self.list.push((name.to_owned(), T::default()));
        }
        &mut self.list[at].1
    }
}

impl<T> Names<T> {
    /// Gives `name` a value in place of the one that it may have.
    pub fn put(&mut self, name: &str, value: T) {
        match self.index.get(&name.to_ascii_uppercase()) {
            Some(&at) => self.list[at].1 = value,
            None => {
                self.index.insert(name.to_ascii_uppercase(), self.list.len());
                self.list.push((name.to_owned(), value));
            }
        }
    }

    pub fn get(&self, name: &str) -> Option<&T> {
        self.index.get(&name.to_ascii_uppercase()).map(|&at| &self.list[at].1)
    }

    pub fn has(&self, name: &str) -> bool {
        self.get(name).is_some()
    }

    pub fn iter(&self) -> impl Iterator<Item = (&str, &T)> {
        self.list.iter().map(|(name, value)| (name.as_str(), value))
    }
}

impl<T> IntoIterator for Names<T> {
    type Item = (String, T);
    type IntoIter = std::vec::IntoIter<(String, T)>;

    fn into_iter(self) -> Self::IntoIter {
        self.list.into_iter()
    }
}
