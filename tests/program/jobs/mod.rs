//! Many scenes given to one command: what one of them does hides nothing of another.

mod accepted;
mod certified;
mod junit;
mod many;
mod parts;
mod place;
mod reference;
