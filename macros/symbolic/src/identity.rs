//! Deciding identities: evaluation at a random point of a prime field.
//!
//! Two rational expressions that agree at a random point of a field with 2⁶¹ − 1 elements are equal. The probability of
//! an error is below degree/2⁶¹ (Schwartz and Zippel), 10⁻¹⁵ for a degree of a thousand: one point decides. Rotations
//! are sampled by the Cayley map and unit vectors by stereographic projection, so the relations of the group are part
//! of the test. Functions that are not rational are opaque: equal arguments give equal values, and no other law of
//! theirs is used. So an identity may be missed, but is never claimed wrongly.

use std::cell::RefCell;

use crate::evaluate::{Matrix, Number, Values, negative, one, zero};
use crate::group::sample;
use crate::node::{Analytic, Function, Term};
use crate::table::hash_of;
use crate::{Expr, Group, IntoList, Property, Rational, Shape, Table};

pub(crate) const PRIME: u64 = (1 << 61) - 1;

/// A number from 0 to 1 that depends on all bits of the seeds and on nothing else.
pub fn fraction(seeds: &[u64]) -> f64 {
    Residue::mixed(seeds).0 as f64 / PRIME as f64
}

/// An element of the field of integers modulo the prime 2⁶¹ − 1.
#[derive(Copy, Clone, PartialEq, Eq, Debug)]
pub struct Residue(u64);

impl Residue {
    /// The residue of a value below 2¹²⁴: 2⁶¹ is one, so its upper and lower halves are added.
    #[inline(always)]
    pub(crate) fn new(value: u128) -> Residue {
        let sum = (value as u64 & PRIME) + (value >> 61) as u64;
        let sum = (sum & PRIME) + (sum >> 61);
        Residue(if sum >= PRIME { sum - PRIME } else { sum })
    }

    /// A number that depends on all bits of the seeds and on nothing else.
    pub(crate) fn mixed(seeds: &[u64]) -> Residue {
        let mut state = 0x9e37_79b9_7f4a_7c15_u64;
        for seed in seeds {
            state = (state ^ seed).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            state = (state ^ (state >> 29)).wrapping_mul(0x94d0_49bb_1331_11eb);
            state ^= state >> 32;
        }
        Residue::new(state as u128)
    }

    /// A matrix of numbers that depend on the seeds and on some matrices.
    fn scattered(mut seeds: Vec<u64>, arguments: &[&Matrix<Residue>], shape: Shape) -> Matrix<Residue> {
        seeds.extend(arguments.iter().flat_map(|argument| &argument.entries).map(|entry| entry.0));
        let seed = Residue::mixed(&seeds).0;
        Matrix::from_fn(shape, |(i, j)| Residue::mixed(&[seed, i as u64, j as u64]))
    }
}

impl Number for Residue {
    fn from_rational(value: &Rational) -> Residue {
        match value.parts() {
            Some((numerator, 1)) if numerator.unsigned_abs() < PRIME => {
                Residue(if numerator < 0 { PRIME - numerator.unsigned_abs() } else { numerator as u64 })
            }
            _ => {
                let [numerator, denominator] = value.remainders(PRIME).map(Residue);
                numerator.multiply(denominator.reciprocal())
            }
        }
    }
    fn from_integer(value: i64) -> Residue {
        match value {
            0.. => Residue::new(value as u128),
            _ => Residue(PRIME - value.unsigned_abs() % PRIME),
        }
    }
    #[inline(always)]
    fn add(self, other: Residue) -> Residue {
        Residue::new(self.0 as u128 + other.0 as u128)
    }
    #[inline(always)]
    fn multiply(self, other: Residue) -> Residue {
        Residue::new(self.0 as u128 * other.0 as u128)
    }
    fn dot(row: &[Residue], column: &[Residue], apart: usize) -> Residue {
        // three products and a residue are below 2¹²⁴, whose halves still fit
        let (mut sum, mut k) = (0_u128, 0);
        while k < row.len() {
            sum += row[k].0 as u128 * column[k * apart].0 as u128;
            k += 1;
            if k % 3 == 0 {
                sum = Residue::new(sum).0 as u128;
            }
        }
        Residue::new(sum)
    }
    fn reciprocal(self) -> Residue {
        // Euclid's algorithm: each remainder is its factor times this residue, modulo the prime
        let (mut remainder, mut next) = (PRIME as i64, self.0 as i64);
        let (mut factor, mut next_factor) = (0, 1);
        while next != 0 {
            let quotient = remainder / next;
            (remainder, next) = (next, remainder - quotient * next);
            (factor, next_factor) = (next_factor, factor - quotient * next_factor);
        }
        Residue::from_integer(factor)
    }
    fn fractional_power(self, (numerator, denominator): (i64, i64)) -> Residue {
        match self.0 {
            0 | 1 => self,
            value => Residue::mixed(&[1, value, numerator as u64, denominator as u64]),
        }
    }
    fn function(self, function: Function) -> Residue {
        Residue::mixed(&[2, self.0, hash_of(&function)])
    }
    fn analytic(function: Analytic, argument: &Matrix<Residue>) -> Matrix<Residue> {
        Residue::scattered(vec![7, function as u64], &[argument], argument.shape)
    }
    fn opaque(name: &str, output: usize, arguments: &[&Matrix<Residue>], shape: Shape) -> Matrix<Residue> {
        Residue::scattered(vec![8, hash_of(&name), output as u64], arguments, shape)
    }
    fn pi() -> Residue {
        Residue::mixed(&[3])
    }
}

/// A random point: each symbol has a value that its property allows.
pub struct Point<'g> {
    seed: u64,
    /// The symbols whose values have been set.
    fixed: Table<Expr<'g>, Matrix<Residue>>,
    /// The values of expressions that have been evaluated with them.
    known: Values<Residue>,
}

/// The values of expressions at points, by the numbers of the points: identities are asked for again and again.
pub(crate) type Evaluated = RefCell<Table<u64, Values<Residue>>>;

impl<'g> Point<'g> {
    /// The point number `seed`.
    pub fn new(seed: u64) -> Point<'g> {
        Point { seed, fixed: Table::default(), known: Table::default() }
    }

    /// Sets the value of one symbol.
    pub fn set(&mut self, symbol: Expr<'g>, value: Matrix<Residue>) {
        self.fixed.insert(symbol, value);
        self.known = Table::default();
    }

    /// The value of an expression here.
    pub fn evaluate(&mut self, expr: Expr<'g>) -> Matrix<Residue> {
        if self.fixed.is_empty() {
            let evaluated = &expr.graph.evaluated;
            let mut known = std::mem::take(evaluated.borrow_mut().entry(self.seed));
            let value = expr.evaluate_with(&mut known, &mut |symbol| self.sample(symbol));
            evaluated.borrow_mut().insert(self.seed, known);
            return value;
        }
        let mut known = std::mem::take(&mut self.known);
        let mut values = |symbol| self.fixed.get(&symbol).cloned().unwrap_or_else(|| self.sampled(symbol));
        let value = expr.evaluate_with(&mut known, &mut values);
        self.known = known;
        value
    }

    /// The value of a symbol that is not set, which all points of this number share.
    fn sampled(&self, symbol: Expr<'g>) -> Matrix<Residue> {
        let mut evaluated = symbol.graph.evaluated.borrow_mut();
        let known = evaluated.entry(self.seed);
        if let Some(value) = known.get(&symbol.id) {
            return value.clone();
        }
        let value = self.sample(symbol);
        known.insert(symbol.id, value.clone());
        value
    }

    fn sample(&self, symbol: Expr<'g>) -> Matrix<Residue> {
        let shape = symbol.shape();
        let random = |i: usize, j: usize| Residue::mixed(&[4, self.seed, symbol.id.0 as u64, i as u64, j as u64]);
        match symbol.property() {
            Property::General | Property::Increment(_) => Matrix::from_fn(shape, |(i, j)| random(i, j)),
            Property::Symmetric => Matrix::from_fn(shape, |(i, j)| random(i.min(j), i.max(j))),
            Property::Diagonal => Matrix::from_fn(shape, |(i, j)| if i == j { random(i, i) } else { zero() }),
            Property::Skew => Matrix::from_fn(shape, |(i, j)| random(i, j).add(negative(random(j, i)))),
            Property::Orthogonal => self.sample_element(symbol, Group::SpecialOrthogonal(shape.rows)),
            Property::Unit => stereographic(shape, random),
            Property::Orthonormal => self.orthonormal(symbol, shape.columns),
            Property::Projector(rank) => {
                let columns = self.orthonormal(symbol, rank);
                columns.multiply(&columns.transpose())
            }
            Property::Element(group) => self.sample_element(symbol, group),
        }
    }

    /// The first columns of a random rotation.
    fn orthonormal(&self, symbol: Expr<'g>, count: usize) -> Matrix<Residue> {
        let rotation = self.sample_element(symbol, Group::SpecialOrthogonal(symbol.shape().rows));
        Matrix::from_fn(Shape::new(rotation.shape.rows, count), |(i, j)| {
            rotation.entries[i * rotation.shape.columns + j]
        })
    }

    /// A random element of a group. If no way to make elements is known, it is any matrix: laws of all matrices hold
    /// for elements too.
    fn sample_element(&self, symbol: Expr<'g>, group: Group) -> Matrix<Residue> {
        let mut count = 0;
        let mut random = || {
            count += 1;
            Residue::mixed(&[5, self.seed, symbol.id.0 as u64, count])
        };
        let element = sample::element(symbol.graph, group, &mut random);
        element.unwrap_or_else(|| Matrix::from_fn(symbol.shape(), |_| random()))
    }
}

/// (2u, |u|² − 1)/(|u|² + 1).
fn stereographic(shape: Shape, random: impl Fn(usize, usize) -> Residue) -> Matrix<Residue> {
    let last = shape.len() - 1;
    let square = (0..last).fold(zero(), |sum: Residue, i| sum.add(random(i, 0).multiply(random(i, 0))));
    let scale = square.add(one()).reciprocal();
    let double = |k: usize| random(k, 0).add(random(k, 0));
    let numerators = (0..last).map(double).chain([square.add(negative(one()))]);
    Matrix::new(shape, numerators.map(|numerator| numerator.multiply(scale)).into_list())
}

/// Whether the expressions are equal, pair by pair, for all values of their symbols that the properties allow.
pub fn equal<'g>(left: &[Expr<'g>], right: &[Expr<'g>]) -> bool {
    let mut point = Point::new(0);
    let mut agree = |a, b| a == b || point.evaluate(a) == point.evaluate(b);
    left.len() == right.len() && left.iter().zip(right).all(|(&a, &b)| agree(a, b))
}

/// Whether the expression is zero for all values of its symbols that the properties allow, some of them fixed by `prepare`.
pub fn vanishes_where<'g>(expr: Expr<'g>, prepare: &dyn Fn(&mut Point<'g>)) -> bool {
    let mut point = Point::new(0);
    prepare(&mut point);
    point.evaluate(expr).entries.iter().all(|entry| *entry == zero())
}

/// Whether the expression is zero for all values of its symbols that the properties allow.
pub fn vanishes(expr: Expr<'_>) -> bool {
    equal(&[expr], &[expr.graph.zero(expr.shape())])
}

/// Whether the value of an expression changes with that of a symbol.
pub fn varies_with<'g>(expr: Expr<'g>, symbol: Expr<'g>) -> bool {
    let mut elsewhere = Point::new(0);
    elsewhere.set(symbol, Point::new(1).sampled(symbol));
    Point::new(0).evaluate(expr) != elsewhere.evaluate(expr)
}

/// The same sum without those of its terms that are zero for all values of their symbols.
pub fn without_vanishing_terms(expr: Expr<'_>) -> Expr<'_> {
    let (graph, shape) = (expr.graph, expr.shape());
    let stays = |term: &Term| !vanishes(graph.collect(shape, [term.clone()]));
    graph.collect(shape, expr.terms().into_iter().filter(stays))
}

/// The rank of a matrix for general values of its symbols.
pub fn rank(expr: Expr<'_>) -> usize {
    rank_where(expr, &|_| {})
}

/// The rank of a matrix for general values of its symbols, some of them fixed by `prepare`.
pub fn rank_where<'g>(expr: Expr<'g>, prepare: &dyn Fn(&mut Point<'g>)) -> usize {
    let mut point = Point::new(0);
    prepare(&mut point);
    point.evaluate(expr).reduce(expr.shape().columns).0.len()
}

/// A basis of the constant vectors w with A·w = 0, in reduced echelon form. A·w vanishes for all values of the symbols
/// in A that the properties allow.
///
/// Entries that are no small rationals are not recognised; vectors with such entries are left out, so that nothing is claimed
/// wrongly.
pub fn null_space(matrix: Expr<'_>) -> Vec<Vec<Rational>> {
    let columns = matrix.shape().columns;
    let (mut rows, mut pivots): (Vec<Residue>, Vec<usize>) = (Vec::new(), Vec::new());
    // the first point that adds nothing to the rank decides
    for seed in 0..=columns as u64 {
        rows.extend(Point::new(seed).evaluate(matrix).entries);
        let rank = pivots.len();
        let mut reduced = Matrix::new(Shape::new(rows.len() / columns, columns), rows);
        pivots = reduced.reduce(columns).0;
        rows = reduced.entries;
        rows.truncate(pivots.len() * columns);
        if pivots.len() == rank || pivots.len() == columns {
            break;
        }
    }
    let free = (0..columns).filter(|column| !pivots.contains(column));
    let vector = |column: usize| -> Option<Vec<Rational>> {
        let entry = |k: usize| match pivots.iter().position(|pivot| *pivot == k) {
            Some(row) => negative(rows[row * columns + column]).rational(),
            None => Some(crate::integer((k == column) as i64)),
        };
        (0..columns).map(entry).collect()
    };
    free.filter_map(vector).into_list()
}

impl Residue {
    /// The rational a/b with |a|, b < 2¹⁶ that this stands for, if there is one.
    fn rational(self) -> Option<Rational> {
        let bound = 1_i128 << 16;
        let (mut r, mut s) = ((PRIME as i128, self.0 as i128), (0_i128, 1_i128));
        while r.1 >= bound {
            let quotient = r.0 / r.1;
            r = (r.1, r.0 - quotient * r.1);
            s = (s.1, s.0 - quotient * s.1);
        }
        let (numerator, denominator) = if s.1 < 0 { (-r.1, -s.1) } else { (r.1, s.1) };
        (denominator > 0 && denominator < bound).then(|| crate::rational(numerator as i64, denominator as i64))
    }
}
