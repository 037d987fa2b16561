//! Words of matrices: the order of their products, and the letters that several of them have in common.

use clebsch_symbolic::{Expr, IntoList, Rational, Shape, Table};

use crate::lower::Code;

/// A term: its coefficient, its scalar factors and its word.
pub(super) struct Weighted<'g> {
    pub(super) coefficient: Rational,
    /// The product of the scalar factors; `None` if there are none.
    pub(super) scale: Option<Code>,
    pub(super) word: Vec<Expr<'g>>,
}

impl<'g> Weighted<'g> {
    /// The first or the last letter of a word of several.
    pub(super) fn outermost(&self, first: bool) -> Option<Expr<'g>> {
        if first { self.word.first().copied() } else { self.word.last().copied() }
    }

    /// The term without that letter.
    pub(super) fn without(mut self, first: bool) -> Weighted<'g> {
        if first {
            self.word.remove(0);
        } else {
            self.word.pop();
        }
        self
    }
}

/// A letter that at least two words begin with (`true`) or end with. One of the words has other letters too. The most
/// frequent letter is taken.
///
/// Vectors keep the side of the vector, so that it is multiplied first.
pub(super) fn common_letter<'g>(shape: Shape, terms: &[Weighted<'g>]) -> Option<(Expr<'g>, bool)> {
    let mut best: Option<(usize, Expr<'g>, bool)> = None;
    for first in [false, true] {
        // a common vector would make a matrix of the other letters
        if (!first && shape.columns == 1) || (first && shape.rows == 1) {
            continue;
        }
        let mut counts: Table<Expr<'g>, (usize, bool)> = Table::default();
        for term in terms {
            let Some(letter) = term.outermost(first) else { continue };
            let inner = if first { letter.shape().columns } else { letter.shape().rows };
            if inner == 1 {
                continue;
            }
            let count = counts.entry(letter);
            *count = (count.0 + 1, count.1 || term.word.len() > 1);
        }
        for (letter, (count, is_product)) in counts.iter() {
            if *count > 1 && *is_product && best.as_ref().is_none_or(|(most, ..)| count > most) {
                best = Some((*count, *letter, first));
            }
        }
    }
    best.map(|(_, letter, first)| (letter, first))
}

/// Where a word is cut in two so that its product takes the fewest multiplications (matrix chain order).
pub(super) fn cheapest_cut(word: &[Expr<'_>]) -> usize {
    let sizes: Vec<usize> = word
        .iter()
        .map(|letter| letter.shape().rows)
        .chain(word.last().map(|letter| letter.shape().columns))
        .into_list();
    let n = word.len();
    let mut best = vec![vec![(0_usize, 0_usize); n]; n];
    for length in 2..=n {
        for start in 0..=n - length {
            let end = start + length - 1;
            let cost =
                |cut: usize| best[start][cut].0 + best[cut + 1][end].0 + sizes[start] * sizes[cut + 1] * sizes[end + 1];
            // by construction: there is a cut
            best[start][end] = (start..end).map(|cut| (cost(cut), cut)).min().unwrap_or((0, start));
        }
    }
    best[0][n - 1].1 + 1
}
