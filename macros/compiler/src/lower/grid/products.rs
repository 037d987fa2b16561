//! Products of matrices, entry by entry: which letters are multiplied first, and which constants are summed before.
//!
//! Vectors come first, and a column times a row last. So the gradient u uᵀR J of the potential (Rᵀu)·J Rᵀu/2 is made of
//! y = Rᵀu and J y alone. So is its moment y × J y.
//!
//! Factors that do not change during a step are gathered first. `2/h·(𝕄 + 𝕄ᵀ)/2·x^` is one constant matrix times `x^`,
//! however the derivation has distributed it.

use std::collections::BTreeMap;
use std::rc::Rc;

use clebsch_symbolic::{Analytic, Elements, Expr, IntoElements, Operation, Rational, Shape, View, WordTerm, integer};

use super::super::entries::{Grid, Scalar};
use super::super::scalar::{Callee, Rate, Scalars};

/// The most rows of a matrix φ(A) that is made for the product with a vector.
const LARGEST_MADE: usize = 3;
/// The most columns with rows of one sum that a matrix is multiplied with alone.
const MOST_DISTRIBUTED: usize = 3;

impl<'g> Scalars {
    /// The product of letters, associated so that vectors are multiplied first. A column times a row is made last.
    pub(super) fn word(&mut self, word: &[Expr<'g>]) -> Grid {
        if let Some(word) = opened(word) {
            return self.word(&word);
        }
        if let Some(terms) = distributed(word) {
            // by construction: words are not empty
            let (first, last) = (word[0], word[word.len() - 1]);
            return self.gathered(Shape::new(first.shape().rows, last.shape().columns), terms);
        }
        if let Some(cut) = between_column_and_row(word).filter(|_| word.len() > 2) {
            let (column, row) = (self.word(&word[..cut]), self.word(&word[cut..]));
            return self.multiply(&column, &row);
        }
        if let Some(cut) = middle(word) {
            let (row, column) = (self.word(&word[..cut]), self.word(&word[cut..]));
            return self.multiply(&row, &column);
        }
        let from_right = word.last().is_some_and(|letter| letter.shape().columns == 1) && word[0].shape().rows != 1;
        // by construction: words are not empty
        let ends = if from_right { word.split_last() } else { word.split_first() };
        let (first, others) = ends.expect("a word has letters");
        let first = (*self.grid(*first)).clone();
        if !from_right {
            return others.iter().fold(first, |product, letter| {
                let letter = self.grid(*letter);
                self.multiply(&product, &letter)
            });
        }
        others.iter().rev().fold(first, |vector, letter| self.times_vector(*letter, vector))
    }

    /// A letter times a column. Of φ(A), and of a block of it, the product alone is computed.
    fn times_vector(&mut self, letter: Expr<'g>, vector: Grid) -> Grid {
        let (function, (row, column)) = match letter.view() {
            View::Of(Operation::Block(row, column), function) => (function, (row, column)),
            _ => (letter, (0, 0)),
        };
        match function.view() {
            View::Of(Operation::Analytic(Analytic::Phi), a) if a.shape().rows > LARGEST_MADE => {
                let (a, zero) = (self.grid(a), self.zero());
                let whole = Shape::new(a.shape.rows, 1);
                let entry = |i: usize| i.checked_sub(column).and_then(|i| vector.entries.get(i)).copied();
                let vector = Grid::from_fn(whole, |(i, _)| entry(i).unwrap_or(zero));
                let product = self.call(Callee::PhiTimes, vec![a, Rc::new(vector)], 0, whole);
                Grid::from_fn(Shape::new(letter.shape().rows, 1), |(i, _)| product.at(row + i, 0))
            }
            _ => {
                let letter = self.grid(letter);
                self.multiply(&letter, &vector)
            }
        }
    }

    /// A sum of products. Those that differ in constant letters alone have one constant matrix.
    pub(super) fn gathered(&mut self, shape: Shape, terms: Vec<WordTerm<'g>>) -> Grid {
        type Key<'g> = (Vec<(Expr<'g>, (i64, i64))>, Vec<Expr<'g>>, Vec<Expr<'g>>);
        type Run<'g> = (Scalar, Vec<Expr<'g>>);
        let mut groups: BTreeMap<Key<'g>, Vec<Run<'g>>> = BTreeMap::new();
        let mut grids = Vec::new();
        for term in terms {
            let scalars: Vec<_> = term.scalars.each(|(base, exponent)| (*base, exponent.parts()));
            if !term.word.is_empty() && !term.word.iter().any(|letter| self.is_constant(*letter)) {
                let product = self.word(&term.word);
                let scale = self.monomial(&term.coefficient, &scalars);
                grids.push(self.scaled(&product, scale));
                continue;
            }
            let (constant, varying): (Vec<_>, Vec<_>) =
                scalars.into_iter().partition(|(base, _)| self.is_constant(*base));
            let scale = self.monomial(&term.coefficient, &constant);
            let start = self.gathering(&term.word);
            let length = term.word[start..].iter().take_while(|letter| self.is_constant(**letter)).count();
            let (prefix, suffix) = (term.word[..start].to_vec(), term.word[start + length..].to_vec());
            let run = term.word[start..start + length].to_vec();
            groups.entry((varying, prefix, suffix)).or_default().push((scale, run));
        }
        for ((varying, prefix, suffix), runs) in groups {
            let product = self.of_rank_one(&prefix, &runs, &suffix).unwrap_or_else(|| {
                let rows = suffix.first().map_or(shape.columns, |letter| letter.shape().rows);
                let middle = self.summed(rows, &runs);
                self.between(&prefix, middle, &suffix)
            });
            let scale = self.monomial(&integer(1), &varying);
            grids.push(self.scaled(&product, scale));
        }
        self.total_of(shape, &grids)
    }

    /// The sum of the products of constant letters, each with its scale.
    fn summed(&mut self, rows: usize, runs: &[(Scalar, Vec<Expr<'g>>)]) -> Grid {
        let runs: Vec<Grid> = runs.each(|(scale, run)| self.constant_run(rows, *scale, run));
        self.total_of(runs[0].shape, &runs)
    }

    /// Where the constant letters begin that are summed with those of other terms: the first ones. Where a column meets a
    /// row, a matrix in the row comes before these, as other products may have the vector before it too.
    fn gathering(&mut self, word: &[Expr<'g>]) -> usize {
        let cut = between_column_and_row(word).filter(|_| !is_iterated(word));
        let bearer = cut.and_then(|cut| Some(cut + self.bearer(&word[cut..])?)).filter(|place| is_matrix(word[*place]));
        let first = || word.iter().position(|letter| self.is_constant(*letter));
        bearer.or_else(first).unwrap_or(0)
    }

    /// prefix · Σ scale · run · suffix where that is a column times a row, each made alone. `None` for others.
    fn of_rank_one(
        &mut self,
        prefix: &[Expr<'g>],
        runs: &[(Scalar, Vec<Expr<'g>>)],
        suffix: &[Expr<'g>],
    ) -> Option<Grid> {
        if let Some(cut) = between_column_and_row(prefix) {
            let middle = self.summed(1, runs);
            let (column, row) = (self.word(&prefix[..cut]), self.between(&prefix[cut..], middle, suffix));
            return Some(self.multiply(&column, &row));
        }
        let [(scale, run)] = runs else { return None };
        let word = [prefix, run, suffix].concat();
        let cut = between_column_and_row(&word).filter(|_| word.len() > 2)?;
        // the letters that do not change in a solve stay together there
        if is_iterated(&word) && between_column_and_row(run).is_none() {
            return None;
        }
        let (column, row) = (self.chain(*scale, &word[..cut]), self.word(&word[cut..]));
        Some(self.multiply(&column, &row))
    }

    /// A multiple of a product that is a vector.
    fn chain(&mut self, scale: Scalar, word: &[Expr<'g>]) -> Grid {
        let bearer = if self.as_number(scale).is_some_and(Rational::is_one) { None } else { self.bearer(word) };
        let Some(place) = bearer else {
            let product = self.word(word);
            return self.scaled(&product, scale);
        };
        let letter = self.grid(word[place]);
        let letter = self.scaled(&letter, scale);
        self.between(&word[..place], letter, &word[place + 1..])
    }

    /// The letter of a product that takes a constant, so that no multiplication is left of it. A matrix comes before a
    /// vector, as other products may have the vector too. `None` where each letter changes, or is made of numbers.
    fn bearer(&mut self, word: &[Expr<'g>]) -> Option<usize> {
        let mut constant = (0..word.len()).filter(|&i| self.is_constant(word[i]) && !word[i].symbols().is_empty());
        let first = constant.next()?;
        Some([first].into_iter().chain(constant).find(|&i| is_matrix(word[i])).unwrap_or(first))
    }

    /// The product of the constant letters of a term, or a multiple of the identity where there are none.
    fn constant_run(&mut self, rows: usize, scale: Scalar, run: &[Expr<'g>]) -> Grid {
        if run.is_empty() {
            return self.scaled_identity(rows, scale);
        }
        let product = self.word(run);
        self.scaled(&product, scale)
    }

    /// prefix · middle · suffix, vectors first.
    fn between(&mut self, prefix: &[Expr<'g>], middle: Grid, suffix: &[Expr<'g>]) -> Grid {
        let is_row = prefix.first().is_some_and(|first| first.shape().rows == 1);
        let is_column = suffix.last().is_some_and(|last| last.shape().columns == 1);
        let (mut product, mut before) = (middle, prefix);
        if is_column {
            let vector = self.word(suffix);
            product = self.multiply(&product, &vector);
        }
        if is_row {
            let vector = self.word(prefix);
            (product, before) = (self.multiply(&vector, &product), &[]);
        }
        if !is_column {
            product = suffix.iter().fold(product, |product, letter| {
                let letter = self.grid(*letter);
                self.multiply(&product, &letter)
            });
        }
        before.iter().rev().fold(product, |product, letter| {
            let letter = self.grid(*letter);
            self.multiply(&letter, &product)
        })
    }
}

/// The place in a product of matrices where a column meets a row, so that the product has rank one.
fn between_column_and_row(word: &[Expr<'_>]) -> Option<usize> {
    let is_tall = word.first().is_some_and(|letter| letter.shape().rows != 1);
    (1..word.len()).find(|&cut| is_tall && word[cut].shape().rows == 1)
}

/// The middle of a row, matrices and a column that read the same backwards and transposed, xᵀ A S Aᵀ x. One vector, Aᵀ x,
/// makes both halves.
fn middle(word: &[Expr<'_>]) -> Option<usize> {
    let (first, last) = (word.first()?, word.last()?);
    if word.len() < 4 || first.shape().rows != 1 || last.shape().columns != 1 {
        return None;
    }
    let ends = word.iter().zip(word.iter().rev()).take(word.len() / 2);
    let cut = ends.take_while(|(left, right)| **left == right.transpose()).count();
    (cut > 1).then_some(cut)
}

/// A product with a factor u aᵀ + u bᵀ, as u (a + b)ᵀ: the column, or the row, is a letter of its own. `None` where there is
/// no such factor.
fn opened<'g>(word: &[Expr<'g>]) -> Option<Vec<Expr<'g>>> {
    if word.len() < 2 {
        return None;
    }
    word.iter().enumerate().find_map(|(place, letter)| {
        let View::Sum(terms) = letter.view() else { return None };
        if !is_matrix(*letter) || terms.len() < 2 || terms.iter().any(|term| term.word.len() < 2) {
            return None;
        }
        let graph = letter.graph();
        let (first, last) = (*terms[0].word.first()?, *terms[0].word.last()?);
        let parts = if first.shape().columns == 1 && terms.iter().all(|term| term.word[0] == first) {
            let others = terms.into_iter().map(|mut term| {
                term.word.remove(0);
                term.product(graph)
            });
            [first, graph.total(Shape::new(1, letter.shape().columns), others)]
        } else if last.shape().rows == 1 && terms.iter().all(|term| term.word.last() == Some(&last)) {
            let others = terms.into_iter().map(|mut term| {
                term.word.pop();
                term.product(graph)
            });
            [graph.total(Shape::new(letter.shape().rows, 1), others), last]
        } else {
            return None;
        };
        Some([&word[..place], &parts, &word[place + 1..]].concat())
    })
}

/// A product with a factor u aᵀ + v bᵀ of a few columns and rows, term by term: vectors alone are multiplied. `None` where
/// there is no such factor.
fn distributed<'g>(word: &[Expr<'g>]) -> Option<Vec<WordTerm<'g>>> {
    if word.len() < 2 || is_iterated(word) {
        return None;
    }
    let has_rank_one = |term: &WordTerm<'g>| between_column_and_row(&term.word).is_some();
    let sum = |letter: Expr<'g>| match letter.view() {
        View::Sum(terms) if is_matrix(letter) && terms.iter().all(has_rank_one) => Some(terms),
        _ => None,
    };
    let mut sums = word.iter().enumerate().filter_map(|(place, letter)| Some((place, sum(*letter)?)));
    // of several sums there would be as many products as terms of all of them multiplied
    let (Some((place, terms)), None) = (sums.next(), sums.next()) else { return None };
    let around = |mut term: WordTerm<'g>| {
        term.word = [&word[..place], &term.word, &word[place + 1..]].concat();
        term
    };
    (terms.len() <= MOST_DISTRIBUTED).then(|| terms.into_each(around))
}

fn is_matrix(letter: Expr<'_>) -> bool {
    letter.shape().rows > 1 && letter.shape().columns > 1
}

/// Whether a product changes in the iterations of a solve.
fn is_iterated(word: &[Expr<'_>]) -> bool {
    let is_coordinate = |symbol: &Expr<'_>| symbol.role().is_some_and(|role| Rate::of(role) == Rate::Iteration);
    word.iter().any(|letter| letter.symbols().iter().any(is_coordinate))
}

#[cfg(test)]
mod tests;
