//! Fields at rest on large grids. The other tests of fields are in `tests/laws/tests/fields`.

#![allow(missing_docs)]

#[path = "../../laws/tests/fields/cycles.rs"]
mod cycles;
mod relaxation;
#[path = "../../laws/tests/fields/squares.rs"]
mod squares;

/// Sites along a side of the squares, films and crystals of `cycles`.
const SQUARES: [usize; 5] = [16, 17, 32, 50, 65];
const FILMS: [usize; 3] = [20, 33, 64];
const CRYSTALS: [usize; 2] = [17, 33];
