//! The methods of closures as data: name, type of the receiver, and the resulting expression.

use clebsch_symbolic::{Expr, Function, Shape};
use syn::ExprMethodCall;

use super::{Elaborator, Value};

pub(super) type Unary = for<'g> fn(Expr<'g>) -> Expr<'g>;
pub(super) type Binary = for<'g> fn(Expr<'g>, Expr<'g>) -> Expr<'g>;

/// A method with a function of its own, of a matrix.
pub(super) type Method =
    for<'e, 'c, 'g> fn(&mut Elaborator<'e, 'c, 'g>, &ExprMethodCall, Expr<'g>) -> Option<Value<'g>>;

/// The receiver of a method, and how the method makes its value.
#[derive(Copy, Clone)]
pub(super) enum Rule {
    /// Any matrix.
    Any(Unary),
    /// A square matrix.
    Square(Unary),
    /// A vector or a matrix that is no scalar.
    Vector(Unary),
    /// A vector of three components.
    Three(Unary),
    /// A scalar.
    Scalar(Function),
    /// A scalar, by a function of its own.
    OfScalar(Method),
    /// Two matrices of the same shape.
    Pair(Binary),
    /// Two vectors of three components.
    PairOfThree(Binary),
    /// A part of a matrix.
    Part(Part),
    /// A receiver of its own, by a function of its own.
    Special(&'static str, Method),
    /// An array, or a range of sites.
    Map,
    /// An array, or values for a range of sites.
    Sum,
}

impl Rule {
    /// The receiver of a method, as the docs say it.
    pub fn receiver(self) -> &'static str {
        match self {
            Rule::Any(_) | Rule::Part(_) => "a matrix or vector",
            Rule::Special(of, _) => of,
            Rule::Square(_) => "a square matrix",
            Rule::Vector(_) => "a vector or matrix that is no scalar",
            Rule::Three(_) => "a vector of three components",
            Rule::Scalar(_) | Rule::OfScalar(_) => "a scalar",
            Rule::Pair(_) => "two matrices or vectors of one shape",
            Rule::PairOfThree(_) => "two vectors of three components",
            Rule::Map => "an array or a range",
            Rule::Sum => "an array",
        }
    }
}

/// A part of a matrix.
#[derive(Copy, Clone)]
pub(super) struct Part {
    /// The number of its sizes that are written, `::<2, 2>`.
    pub sizes: usize,
    /// Its shape, from that of the matrix and the written sizes.
    pub shape: fn(Shape, &[usize]) -> Shape,
    /// Whether an argument says where it starts, along rows and along columns.
    pub starts: [bool; 2],
}

const fn part(sizes: usize, starts: [bool; 2], shape: fn(Shape, &[usize]) -> Shape) -> Rule {
    Rule::Part(Part { sizes, shape, starts })
}

/// All methods: the number of arguments, the receiver, and the value.
#[rustfmt::skip]
pub(super) const METHODS: [(&str, usize, Rule, &str); 41] = [
    ("transpose",      0, Rule::Any(|a| a.transpose()), "Aᵀ"),
    ("norm_squared",   0, Rule::Any(|a| a.norm_squared()), "tr(AᵀA), the sum of the squares of all entries"),
    ("norm",           0, Rule::Special("a vector or matrix that is no scalar", |this, call, a| this.norm(call, a)), "√tr(AᵀA); it has no derivative at 0"),
    ("normalize",      0, Rule::Vector(|a| a.normalize()), "A/|A|"),
    ("trace",          0, Rule::Square(|a| a.trace()), "tr A"),
    ("determinant",    0, Rule::Square(|a| a.determinant()), "det A"),
    ("inverse",        0, Rule::Square(|a| a.inverse()), "A⁻¹"),
    ("symmetric_part", 0, Rule::Square(|a| a.symmetric_part()), "(A + Aᵀ)/2"),
    ("cross_matrix",   0, Rule::Three(|a| a.hat()), "the matrix a^ with a^ b = a × b"),
    ("dot",            1, Rule::Pair(|a, b| a.dot(b)), "tr(AᵀB), the sum of the products of equal entries"),
    ("component_mul",  1, Rule::Pair(|a, b| a.hadamard(b)), "the products of equal entries"),
    ("cross",          1, Rule::PairOfThree(|a, b| a.cross(b)), "a × b"),
    ("column",         1, part(0, [false, true], |all, _| Shape::new(all.rows, 1)), "`A.column(j)`, counted from 0"),
    ("row",            1, part(0, [true, false], |all, _| Shape::new(1, all.columns)), "`A.row(i)`, counted from 0"),
    ("fixed_rows",     1, part(1, [true, false], |all, n| Shape::new(n[0], all.columns)), "`A.fixed_rows::<2>(i)`, two rows from row i on"),
    ("fixed_columns",  1, part(1, [false, true], |all, n| Shape::new(all.rows, n[0])), "`A.fixed_columns::<2>(j)`, two columns from column j on"),
    ("fixed_view",     2, part(2, [true, true], |_, n| Shape::new(n[0], n[1])), "`A.fixed_view::<2, 3>(i, j)`, two rows and three columns from entry (i, j) on"),
    ("xy",             0, part(0, [false, false], |_, _| Shape::vector(2)), "the first two components of a vector"),
    ("xyz",            0, part(0, [false, false], |_, _| Shape::vector(3)), "the first three components of a vector"),
    ("rotation",       0, Rule::Special("an element of `SE`, `Sim` or `Aff`", |this, call, a| this.rotation(call, a)), "the linear part A of (A a; 0 1)"),
    ("translation",    0, Rule::Special("an element of `SE`, `Sim` or `Aff`", |this, call, a| this.translation(call, a)), "the shift a of (A a; 0 1)"),
    ("matrix",         0, Rule::Special("the velocity of one factor", |this, call, a| this.velocity_matrix(call, a)), "its element of the Lie algebra"),
    ("cayley",         0, Rule::Special("the element of an edge", |this, call, a| this.cayley(call, a)), "the strain ξ of an edge with F = (I − ξ/2)⁻¹(I + ξ/2), in `space`"),
    ("log",            0, Rule::Special("the element of an edge", |this, call, a| this.log(call, a)), "the strain ξ of an edge with F = exp ξ, in `space`"),
    ("map",            1, Rule::Map, "`x.map(|i| …)`, an array"),
    ("sum",            0, Rule::Sum, "the sum of an array"),
    ("sqrt",           0, Rule::OfScalar(|this, call, a| this.sqrt(call, a)), "√x"),
    ("powi",           1, Rule::OfScalar(|this, call, a| this.powi(call, a)), "`x.powi(n)`, xⁿ for an integer n from −64 to 64"),
    ("powf",           1, Rule::OfScalar(|this, call, a| this.powf(call, a)), "`x.powf(y)`, x^y; `x.powf(3 / 2)` is exact"),
    ("recip",          0, Rule::OfScalar(|this, call, a| this.recip(call, a)), "1/x"),
    ("sin",            0, Rule::Scalar(Function::Sin), "sin x"),
    ("cos",            0, Rule::Scalar(Function::Cos), "cos x"),
    ("tan",            0, Rule::Scalar(Function::Tan), "tan x"),
    ("asin",           0, Rule::Scalar(Function::Asin), "arcsin x"),
    ("acos",           0, Rule::Scalar(Function::Acos), "arccos x"),
    ("atan",           0, Rule::Scalar(Function::Atan), "arctan x"),
    ("sinh",           0, Rule::Scalar(Function::Sinh), "sinh x"),
    ("cosh",           0, Rule::Scalar(Function::Cosh), "cosh x"),
    ("tanh",           0, Rule::Scalar(Function::Tanh), "tanh x"),
    ("exp",            0, Rule::Scalar(Function::Exp), "eˣ"),
    ("ln",             0, Rule::Scalar(Function::Ln), "ln x, the natural logarithm"),
];

/// Methods without a derivative everywhere: the reason, and the replacement, with `…` for the receiver.
#[rustfmt::skip]
pub(super) const REFUSED: [(&str, &str, &str); 19] = [
    ("abs",        "has no derivative at 0",               "smooth it, `(… * … + self.width * self.width).sqrt()`, with a small field `width`"),
    ("signum",     "has no derivative at 0",               "smooth it, `(… / self.width).tanh()`, with a small field `width`"),
    ("min",        "has no derivative where both are equal", "write a formula that is smooth there"),
    ("max",        "has no derivative where both are equal", "write a formula that is smooth there"),
    ("clamp",      "has no derivative at its ends",        "write a formula that is smooth there"),
    ("floor",      "has no derivative at whole numbers",   "write a formula that is smooth there"),
    ("ceil",       "has no derivative at whole numbers",   "write a formula that is smooth there"),
    ("round",      "has no derivative between whole numbers", "write a formula that is smooth there"),
    ("trunc",      "has no derivative at whole numbers",   "write a formula that is smooth there"),
    ("fract",      "has no derivative at whole numbers",   "write a formula that is smooth there"),
    ("rem_euclid", "has no derivative at its jumps",       "a periodic potential is made of `sin` and `cos`"),
    ("atan2",      "has a jump",                           "write the potential in the components themselves, without the angle"),
    ("angle",      "has no derivative at 0",               "write the potential in `a.dot(&b)`, without the angle"),
    ("argument",   "has a jump",                           "write the potential in the components themselves, without the angle"),
    ("amax",       "has no derivative where two are equal", "use `norm_squared()`"),
    ("amin",       "has no derivative where two are equal", "write a formula that is smooth there"),
    ("lp_norm",    "has no derivative at 0",               "use `norm_squared()`"),
    ("hypot",      "has no derivative at 0",               "write `(a * a + b * b).sqrt()`"),
    ("cbrt",       "has no derivative at 0",               "write `….powf(1 / 3)` where it is positive"),
];

/// Methods by other names.
#[rustfmt::skip]
pub(super) const SYNONYMS: [(&str, &str); 24] = [
    ("magnitude", "norm()"), ("length", "norm()"), ("len", "norm()"),
    ("magnitude_squared", "norm_squared()"), ("length_squared", "norm_squared()"), ("norm2", "norm_squared()"),
    ("normalized", "normalize()"), ("try_inverse", "inverse()"), ("pseudo_inverse", "inverse()"),
    ("det", "determinant()"), ("tr", "trace()"), ("t", "transpose()"), ("adjoint", "transpose()"),
    ("pow", "powi(2)"), ("sq", "powi(2)"), ("square", "powi(2)"), ("squared", "powi(2)"), ("log", "ln()"),
    ("hat", "cross_matrix()"), ("skew", "cross_matrix()"), ("to_skew", "cross_matrix()"),
    ("hadamard", "component_mul(&b)"), ("symmetrize", "symmetric_part()"), ("into_iter", "map(|i| …)"),
];

/// Methods that mathematics has no need of.
#[rustfmt::skip]
pub(super) const NEEDLESS: [&str; 12] = [
    "clone", "to_owned", "into", "into_inner", "as_ref", "iter", "collect", "unwrap", "clone_owned", "evaluate", "eval", "copied",
];

/// Adapters of iterators: a closure goes over indices.
#[rustfmt::skip]
pub(super) const ITERATORS: [&str; 16] = [
    "zip", "enumerate", "fold", "filter", "windows", "chunks", "rev", "skip", "take", "step_by", "for_each", "flat_map", "product",
    "chain", "try_fold", "reduce",
];
