//! The keys of `#[clebsch(…)]`: which there are, which come later, and what was given.

use proc_macro2::{Ident, Span};

use super::dials::{ChartChoice, CodeForm, Discretization, Emit, Isotropy, Order, Solver, Summation};
use super::{Closure, DeclaredGroup, Potential};

/// A value and where it was written.
#[derive(Clone, Debug)]
pub struct Located<T> {
    /// The value.
    pub value: T,
    /// Where it was written.
    pub span: Span,
}

/// What a key's value is.
#[derive(Copy, Clone, PartialEq, Eq, Debug)]
pub(super) enum Kind {
    /// A closure, and how it usually begins.
    Closure(&'static str),
    /// A closure, or two methods of the struct.
    Potential,
    /// A closure, or a list of them.
    Symmetry,
    Order,
    Discretization,
    Chart,
    Solver,
    Tolerance,
    Iterations,
    Summation,
    Code,
    Isotropy,
    Emit,
    Scalar,
    Crate,
    /// Part of the language, but not of this version.
    Later,
}

/// All keys.
pub(super) const KEYS: [(&str, Kind); 27] = [
    ("action", Kind::Closure("|F: SO<3>, R: SO<3>| …")),
    ("cost", Kind::Closure("|h, F| …")),
    ("lagrangian", Kind::Closure("|omega| …")),
    ("potential", Kind::Potential),
    ("symmetry", Kind::Symmetry),
    ("force", Kind::Closure("|omega, torque: Vector3| torque - self.damping * omega")),
    ("force_on", Kind::Closure("|x, thrust: Vector3| thrust")),
    ("controls", Kind::Closure("|u: Vector2| vector![u.x, u.y, 0]")),
    ("dynamics", Kind::Closure("|h, x: Vector2, u: Vector1| x + h * vector![x.y, u.x]")),
    ("effort", Kind::Closure("|h, torque| h * torque.norm_squared() / 2")),
    ("bounds", Kind::Closure("|u| [u.x <= 1, -1 <= u.x]")),
    ("endpoint", Kind::Closure("|q| …")),
    ("isotropy", Kind::Isotropy),
    ("order", Kind::Order),
    ("discretization", Kind::Discretization),
    ("chart", Kind::Chart),
    ("solver", Kind::Solver),
    ("tolerance", Kind::Tolerance),
    ("iterations", Kind::Iterations),
    ("summation", Kind::Summation),
    ("code", Kind::Code),
    ("emit", Kind::Emit),
    ("scalar", Kind::Scalar),
    ("crate", Kind::Crate),
    ("constraint", Kind::Later),
    ("discrete_constraint", Kind::Later),
    ("space", Kind::Later),
];

/// The dials that a name sets: the word, and its value or `None` if it comes later.
pub(super) const DISCRETIZATIONS: [(&str, Option<Discretization>); 5] = [
    ("cayley", Some(Discretization::Cayley)),
    ("exponential", Some(Discretization::Exponential)),
    ("projection", Some(Discretization::Projection)),
    ("moser_veselov", Some(Discretization::MoserVeselov)),
    ("exact", Some(Discretization::Exact)),
];

/// Charts by name.
pub(super) const CHARTS: [(&str, Option<ChartChoice>); 2] =
    [("cayley", Some(ChartChoice::Cayley)), ("exponential", Some(ChartChoice::Exponential))];

/// Solvers by name.
pub(super) const SOLVERS: [(&str, Option<Solver>); 2] =
    [("newton", Some(Solver::Newton)), ("fixed_point", Some(Solver::FixedPoint))];

/// Kinds of summation by name.
pub(super) const SUMMATIONS: [(&str, Option<Summation>); 2] =
    [("plain", Some(Summation::Plain)), ("compensated", Some(Summation::Compensated))];

/// Forms of code by name.
pub(super) const CODES: [(&str, Option<CodeForm>); 2] =
    [("unrolled", Some(CodeForm::Unrolled)), ("matrices", Some(CodeForm::Matrices))];

/// What becomes of motions that move nothing, by name.
pub(super) const ISOTROPIES: [(&str, Option<Isotropy>); 2] =
    [("fixed", Some(Isotropy::Fixed)), ("free", Some(Isotropy::Free))];

/// What may be emitted beside the integrator.
pub(super) const EMITTED: [(&str, Option<Emit>); 6] = [
    ("generated", Some(Emit { generated: true, ..Emit::NOTHING })),
    ("latex", Some(Emit { latex: true, ..Emit::NOTHING })),
    ("tangent", Some(Emit { tangent: true, ..Emit::NOTHING })),
    ("boundary", Some(Emit { boundary: true, ..Emit::NOTHING })),
    ("momentum", Some(Emit { momentum: true, ..Emit::NOTHING })),
    ("connection", None),
];

/// Orders by number.
pub(super) const ORDERS: [Order; 6] =
    [Order::First, Order::Second, Order::Fourth, Order::Sixth, Order::Eighth, Order::Sixteenth];

/// The keys that are no closures; each has a default.
#[derive(Clone, Default, Debug)]
pub struct Dials {
    /// `order = 2`.
    pub order: Option<Located<Order>>,
    /// `discretization = cayley`.
    pub discretization: Option<Located<Discretization>>,
    /// `chart = exponential`.
    pub chart: Option<Located<ChartChoice>>,
    /// `solver = newton`.
    pub solver: Option<Located<Solver>>,
    /// `tolerance = 1e-8`.
    pub tolerance: Option<Located<f64>>,
    /// `iterations = 4`.
    pub iterations: Option<Located<u32>>,
    /// `summation = compensated`.
    pub summation: Option<Located<Summation>>,
    /// `code = matrices`.
    pub code: Option<Located<CodeForm>>,
    /// `isotropy = fixed`.
    pub isotropy: Option<Located<Isotropy>>,
    /// `emit = [generated]`.
    pub emit: Emit,
    /// `scalar = f32`, for systems without fields.
    pub scalar: Option<Ident>,
    /// `crate = path`.
    pub krate: Option<syn::Path>,
}

/// All keys that were given.
#[derive(Default)]
pub(super) struct Keys {
    pub action: Option<Closure>,
    pub cost: Option<Closure>,
    pub lagrangian: Option<Closure>,
    pub potential: Option<Potential>,
    pub force: Option<Closure>,
    pub force_on: Option<Closure>,
    pub controls: Option<Closure>,
    pub dynamics: Option<Closure>,
    pub effort: Option<Closure>,
    pub bounds: Option<Closure>,
    pub endpoint: Option<Closure>,
    pub symmetries: Vec<Closure>,
    pub groups: Vec<DeclaredGroup>,
    pub dials: Dials,
    given: Vec<(String, Span)>,
}

impl Keys {
    /// Notes that a key was given; `false` if it was given before.
    pub fn give(&mut self, key: &Ident) -> bool {
        let name = key.to_string();
        let first = !self.was_given(&name);
        self.given.push((name, key.span()));
        first
    }

    /// Whether a key was given, readable or not.
    pub fn was_given(&self, name: &str) -> bool {
        self.place_of(name).is_some()
    }

    /// Where a key was given.
    pub fn place_of(&self, name: &str) -> Option<Span> {
        self.given.iter().find(|(given, _)| given == name).map(|(_, span)| *span)
    }

    /// Whether no key was given.
    pub fn is_empty(&self) -> bool {
        self.given.is_empty()
    }
}
