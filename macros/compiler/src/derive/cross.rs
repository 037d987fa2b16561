//! Products of cross products in space: a × (b × c) = b (a·c) − c (a·b), so a^ b^ = b aᵀ − (a·b) I.
//!
//! On a sphere a Lagrangian gets shorter by that: |ω × q|² is |ω|² − (ω·q)² where |q| = 1.

use clebsch_symbolic::{Elements, Expr, Operation, Shape, View, WordTerm};

/// A scalar with its cross products multiplied out, where that has fewer letters.
pub(super) fn shortened<'g>(scalar: Expr<'g>) -> Expr<'g> {
    let expanded = scalar.expand();
    let (mut shorter, mut before) = (multiplied_out(expanded), expanded);
    while shorter != before {
        before = shorter;
        shorter = multiplied_out(shorter);
    }
    if letters(shorter) < letters(expanded) { shorter } else { scalar }
}

/// One product of two cross products in each term multiplied out.
fn multiplied_out<'g>(sum: Expr<'g>) -> Expr<'g> {
    let graph = sum.graph();
    let term = |mut term: WordTerm<'g>| {
        let found = term.scalars.iter().enumerate().find_map(|(position, (base, exponent))| {
            let product = of_word(*base).filter(|_| exponent.is_one())?;
            Some((position, product))
        });
        let Some((position, product)) = found else { return term.scale(graph) };
        term.scalars.remove(position);
        term.scale(graph) * product
    };
    graph.total(Shape::scalar(), sum.word_terms().into_iter().map(term)).expand()
}

/// A 1×1 product with its first two neighbouring cross products multiplied out; `None` if it has none.
fn of_word<'g>(scalar: Expr<'g>) -> Option<Expr<'g>> {
    let View::Word(word) = scalar.view() else { return None };
    let vectors = |pair: &[Expr<'g>]| turned(pair[0]).is_some() && turned(pair[1]).is_some();
    let first = word.windows(2).position(vectors)?;
    let (a, b) = (turned(word[first])?, turned(word[first + 1])?);
    let product = |letters: &[Expr<'g>]| letters.iter().copied().reduce(|product, letter| product * letter);
    // by their shape, such products begin and end with vectors
    let (before, after) = (product(&word[..first])?, product(&word[first + 2..])?);
    Some((before * b) * (a.transpose() * after) - a.dot(b) * (before * after))
}

/// v of a letter v^ in space.
fn turned(letter: Expr<'_>) -> Option<Expr<'_>> {
    match letter.view() {
        View::Of(Operation::Wedge(algebra), vector) if algebra.is_skew && algebra.shape == Shape::square(3) => {
            (algebra.dimension == 3).then_some(vector)
        }
        _ => None,
    }
}

/// The letters of all terms.
fn letters(sum: Expr<'_>) -> usize {
    let of_scalar = |base: Expr<'_>| match base.view() {
        View::Word(word) => word.len(),
        _ => 1,
    };
    let of_term = |term: &WordTerm<'_>| -> usize {
        let counts = |exponent: bool| if exponent { 1 } else { 2 };
        term.scalars.iter().map(|(base, exponent)| of_scalar(*base) * counts(exponent.is_one())).sum()
    };
    sum.word_terms().each(of_term).into_iter().sum()
}
