//! The kernel of a matrix of rational numbers, with a basis that depends on the order of the entries alone.

use clebsch_symbolic::{One, Rational, Zero, reduce};

/// A basis of all x of the given length with ⟨row, x⟩ = 0: an entry that those before do not determine is one in one vector of the
/// basis and zero in the others.
pub(super) fn kernel(rows: &[Vec<Rational>], length: usize) -> Vec<Vec<Rational>> {
    // a pivot is determined by the entries behind it, so entries are taken from the last to the first
    let mut reversed: Vec<Vec<Rational>> = rows.iter().map(|row| row.iter().rev().cloned().collect()).collect();
    let pivots = reduce(&mut reversed);
    let row_of = |entry: usize| pivots.iter().position(|&pivot| pivot == length - 1 - entry);
    let vector = |one: usize| {
        let entry = |entry: usize| match row_of(entry) {
            Some(row) => -reversed[row][length - 1 - one].clone(),
            None if entry == one => Rational::one(),
            None => Rational::zero(),
        };
        (0..length).map(entry).collect()
    };
    (0..length).filter(|&entry| row_of(entry).is_none()).map(vector).collect()
}
