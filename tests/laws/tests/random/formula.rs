//! Formulas as data: their text in a declaration, and their value for the oracle.

use std::ops::{Add, Div, Mul, Sub};

use clebsch_tests::oracle::precise::matrix::Matrix;
use clebsch_tests::oracle::precise::real::Real;

/// An expression of a closure.
#[derive(Clone, Debug)]
pub enum Formula {
    /// A number with few binary digits, so that its decimals are exact.
    Number(f64),
    /// A field of the struct, by index.
    Field(usize),
    /// The step h.
    Step,
    /// The time t.
    Time,
    /// A leaf of the configuration, by index.
    Point(usize),
    /// The group element of a factor, by index.
    Element(usize),
    /// The velocity of a factor, by index.
    Velocity(usize),
    /// I, of this size.
    Identity(usize),
    /// `+`, `-`, `*` or `/`.
    Operator(char, Box<[Formula; 2]>),
    /// A method without arguments.
    Method(&'static str, Box<Formula>),
    /// A method with one argument.
    Pair(&'static str, Box<[Formula; 2]>),
    /// `x.powi(n)`.
    Power(Box<Formula>, u32),
    /// `x[(i, j)]`.
    Entry(Box<Formula>, usize, usize),
    /// `.x`, `.y`, `.z`, `.w`.
    Coordinate(Box<Formula>, usize),
}

impl Formula {
    pub fn method(self, name: &'static str) -> Formula {
        Formula::Method(name, Box::new(self))
    }
    pub fn dot(self, other: Formula) -> Formula {
        Formula::Pair("dot", Box::new([self, other]))
    }
    pub fn component_mul(self, other: Formula) -> Formula {
        Formula::Pair("component_mul", Box::new([self, other]))
    }
    pub fn power(self, n: u32) -> Formula {
        Formula::Power(Box::new(self), n)
    }

    /// Whether some part of the formula is such.
    pub fn mentions(&self, which: &dyn Fn(&Formula) -> bool) -> bool {
        let parts: Vec<&Formula> = match self {
            Formula::Operator(_, pair) | Formula::Pair(_, pair) => pair.iter().collect(),
            Formula::Method(_, a) | Formula::Power(a, _) | Formula::Entry(a, ..) | Formula::Coordinate(a, _) => vec![a],
            _ => Vec::new(),
        };
        which(self) || parts.iter().any(|part| part.mentions(which))
    }

    /// The same formula of other leaves, factors and fields. Points have new numbers, elements and velocities that of the first point.
    /// Fields are counted from an offset.
    pub fn moved(&self, points: &[usize], fields: usize) -> Formula {
        let of = |formula: &Formula| Box::new(formula.moved(points, fields));
        let both = |pair: &[Formula; 2]| Box::new([0, 1].map(|k| pair[k].moved(points, fields)));
        match self {
            Formula::Point(k) => Formula::Point(points[*k]),
            Formula::Element(_) => Formula::Element(points[0]),
            Formula::Velocity(_) => Formula::Velocity(points[0]),
            Formula::Field(k) => Formula::Field(k + fields),
            Formula::Operator(operator, pair) => Formula::Operator(*operator, both(pair)),
            Formula::Method(name, a) => Formula::Method(name, of(a)),
            Formula::Pair(name, pair) => Formula::Pair(name, both(pair)),
            Formula::Power(a, n) => Formula::Power(of(a), *n),
            Formula::Entry(a, i, j) => Formula::Entry(of(a), *i, *j),
            Formula::Coordinate(a, i) => Formula::Coordinate(of(a), *i),
            Formula::Number(_) | Formula::Step | Formula::Time | Formula::Identity(_) => self.clone(),
        }
    }

    /// The text, every operation in parentheses.
    pub fn text(&self, names: &Names) -> String {
        let text = |formula: &Formula| formula.text(names);
        match self {
            Formula::Number(x) if *x < 0.0 => format!("({x})"),
            Formula::Number(x) => x.to_string(),
            Formula::Field(k) => format!("self.{}", names.fields[*k]),
            Formula::Step => "h".into(),
            Formula::Time => "t".into(),
            Formula::Point(k) => names.points[*k].clone(),
            Formula::Element(k) => names.elements[*k].clone(),
            Formula::Velocity(k) => names.velocities[*k].clone(),
            Formula::Identity(_) => "I".into(),
            Formula::Operator(operator, pair) => format!("({} {operator} {})", text(&pair[0]), text(&pair[1])),
            Formula::Method(name, a) => format!("{}.{name}()", text(a)),
            Formula::Pair(name, pair) => format!("{}.{name}(&{})", text(&pair[0]), text(&pair[1])),
            Formula::Power(a, n) => format!("{}.powi({n})", text(a)),
            Formula::Entry(a, i, j) => format!("{}[({i}, {j})]", text(a)),
            Formula::Coordinate(a, i) => format!("{}.{}", text(a), ["x", "y", "z", "w"][*i]),
        }
    }

    /// The value; scalars are 1×1, quaternions the 4×4 matrices of multiplication by them from the left.
    pub fn value<R: Real>(&self, at: &Place<'_, R>) -> Matrix<R> {
        let value = |formula: &Formula| formula.value(at);
        match self {
            Formula::Number(x) => Matrix::vector(&[R::of(*x)]),
            Formula::Field(k) => at.fields[*k].lift(),
            Formula::Step => Matrix::vector(&[at.h]),
            Formula::Time => Matrix::vector(&[at.t]),
            Formula::Point(k) => at.q[*k].clone(),
            Formula::Element(k) => at.f[*k].clone(),
            Formula::Velocity(k) => at.xi[*k].clone(),
            Formula::Identity(n) => Matrix::identity(*n),
            Formula::Operator(operator, pair) => operate(*operator, &value(&pair[0]), &value(&pair[1])),
            Formula::Method(name, a) => of_method(name, &value(a)),
            Formula::Pair("dot", pair) => Matrix::vector(&[value(&pair[0]).dot(&value(&pair[1]))]),
            Formula::Pair(_, pair) => {
                let (a, b) = (value(&pair[0]), value(&pair[1]));
                let (rows, columns) = a.shape();
                Matrix::from_fn(rows, columns, |i, j| a[(i, j)] * b[(i, j)])
            }
            Formula::Power(a, n) => Matrix::vector(&[value(a)[(0, 0)].power(*n)]),
            Formula::Entry(a, i, j) => Matrix::vector(&[value(a)[(*i, *j)]]),
            Formula::Coordinate(a, i) => Matrix::vector(&[value(a)[(*i, 0)]]),
        }
    }
}

fn operate<R: Real>(operator: char, a: &Matrix<R>, b: &Matrix<R>) -> Matrix<R> {
    let scalar = |m: &Matrix<R>| m.shape() == (1, 1);
    match operator {
        '+' => a + b,
        '-' => a - b,
        '/' => a * (R::one() / b[(0, 0)]),
        _ if scalar(a) => b * a[(0, 0)],
        _ if scalar(b) => a * b[(0, 0)],
        // a quaternion turns a vector: Q v Q̄
        _ if a.shape() == (4, 4) && b.shape() == (3, 1) => imaginary(&(a * left_multiplication(b) * a.transpose())),
        _ => a * b,
    }
}

fn of_method<R: Real>(name: &str, a: &Matrix<R>) -> Matrix<R> {
    match name {
        "transpose" | "conjugate" => a.transpose(),
        "inverse" => a.inverse(),
        "trace" => Matrix::vector(&[a.trace()]),
        "norm_squared" => Matrix::vector(&[a.norm_squared()]),
        "rotation" => a.linear_part(),
        "translation" => a.translation(),
        "imag" => imaginary(a),
        "scalar" => Matrix::vector(&[a[(3, 3)]]),
        other => panic!("no method `{other}`"),
    }
}

fn imaginary<R: Real>(quaternion: &Matrix<R>) -> Matrix<R> {
    quaternion.block(0..3, 3..4)
}

/// The matrix of multiplication from the left by a quaternion without scalar part.
fn left_multiplication<R: Real>(v: &Matrix<R>) -> Matrix<R> {
    let (x, y, z, o) = (v[(0, 0)], v[(1, 0)], v[(2, 0)], R::zero());
    Matrix::of(4, 4, &[o, -z, y, x, z, o, -x, y, -y, x, o, z, -x, -y, -z, o])
}

/// The names of the leaves of a formula.
#[derive(Clone, Debug, Default)]
pub struct Names {
    pub fields: Vec<String>,
    pub points: Vec<String>,
    pub elements: Vec<String>,
    pub velocities: Vec<String>,
}

/// The values of the leaves of a formula.
pub struct Place<'a, R> {
    pub fields: &'a [Matrix<f64>],
    pub t: R,
    pub h: R,
    pub q: &'a [Matrix<R>],
    pub f: &'a [Matrix<R>],
    pub xi: &'a [Matrix<R>],
}

macro_rules! operator {
    ($($trait:ident $method:ident $sign:literal)*) => { $(
        impl $trait for Formula {
            type Output = Formula;
            fn $method(self, other: Formula) -> Formula {
                Formula::Operator($sign, Box::new([self, other]))
            }
        }
    )* };
}
operator!(Add add '+' Sub sub '-' Mul mul '*' Div div '/');

impl From<f64> for Formula {
    fn from(value: f64) -> Formula {
        Formula::Number(value)
    }
}
