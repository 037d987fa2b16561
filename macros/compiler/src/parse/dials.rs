//! The choices of a declaration: its dials with their values, and the promises on its fields.

use clebsch_symbolic::IntoList;
use std::fmt;

use proc_macro2::Ident;
use syn::{Lit, LitInt};

use super::keys::Located;
use super::spelling::joined;
use super::values::Reader;
use crate::diagnostic::{Diagnostic, error};

/// The keys that are no closures, by name; each has a default.
#[derive(Clone, Default)]
pub struct Dials {
    pub(crate) order: Option<Located<Order>>,
    pub(crate) discretization: Option<Located<Discretization>>,
    pub(crate) chart: Option<Located<ChartChoice>>,
    pub(crate) solver: Option<Located<Solver>>,
    pub(crate) tolerance: Option<Located<f64>>,
    pub(crate) iterations: Option<Located<u32>>,
    pub(crate) summation: Option<Located<Summation>>,
    pub(crate) code: Option<Located<CodeForm>>,
    pub(crate) isotropy: Option<Located<Isotropy>>,
    pub(crate) signature: Option<Located<Signature>>,
    pub(crate) emit: Emit,
    pub(crate) scalar: Option<Ident>,
    pub(crate) krate: Option<syn::Path>,
}

impl Dials {
    /// The most iterations of a solve, where they are limited.
    pub fn limit(&self) -> Option<u32> {
        self.iterations.as_ref().map(|most| most.value)
    }
}

/// A value that a word chooses.
pub(super) trait Word: Copy + PartialEq + 'static {
    /// The words with their values.
    const WORDS: &'static [(&'static str, Self)];
    /// The meaning of each, as the docs say it.
    const MEANINGS: &'static [&'static str];

    fn word(self) -> &'static str {
        // by construction: every value has a word
        Self::WORDS.iter().find(|(_, value)| *value == self).map_or("", |(word, _)| word)
    }
}

/// Values that are written in a declaration, each with its meaning.
pub(super) type Meanings = Vec<(String, &'static str)>;

/// The words of a dial, each with its meaning.
pub(super) fn meanings<T: Word>() -> Meanings {
    T::WORDS.iter().zip(T::MEANINGS).map(|((word, _), meaning)| (word.to_string(), meaning.trim_start())).into_list()
}

/// Values of a dial, each with its meaning and the word by which it is read and printed.
macro_rules! words {
    ($(#[$about:meta])* $dial:ident { $(#[doc = $meaning:literal] $value:ident $word:literal,)+ }) => {
        $(#[$about])*
        #[derive(Copy, Clone, PartialEq, Eq, Debug)]
        pub enum $dial {
            $(#[doc = $meaning] $value,)+
        }

        impl Word for $dial {
            const WORDS: &'static [(&'static str, $dial)] = &[$(($word, $dial::$value)),+];
            const MEANINGS: &'static [&'static str] = &[$($meaning),+];
        }

        impl fmt::Display for $dial {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(self.word())
            }
        }
    };
}

words! {
    /// How the velocity of a step is made from its group element.
    Discretization {
        /// ξ = 2(F − I)(F + I)⁻¹/h, projected to the Lie algebra if it leaves it. A step cannot turn by π.
        Cayley "cayley",
        /// ξ = log(F)/h.
        Exponential "exponential",
        /// ξ = P(F − I)/h with the orthogonal projection P to the Lie algebra.
        Projection "projection",
        /// (F − I)/h for ξ in the form ½tr(ξ 𝕄 ξᵀ) of the kinetic energy. On SO(3) it ends near h|ω| = 1.
        MoserVeselov "moser_veselov",
        /// The discrete Lagrangian is the action of the free motion. A step without a potential has no error in h.
        Exact "exact",
    }
}

words! {
    /// The coordinates in which the group element of a step is looked for, where the user chooses them.
    ChartChoice {
        /// F = (I − Z)⁻¹(I + Z).
        Cayley "cayley",
        /// F = exp ξ.
        Exponential "exponential",
    }
}

words! {
    /// How an implicit momentum equation is solved first.
    Solver {
        /// Newton's method.
        Newton "newton",
        /// x ← x − s·h·Σ⁻¹ρ(x), then Newton's method where that does not contract.
        FixedPoint "fixed_point",
    }
}

words! {
    /// How a right-hand side x′ = f(t, x, u) becomes a step, with the same input all along.
    RungeKutta {
        /// The classical Runge–Kutta method, of order 4.
        Classical "rk4",
        /// The explicit midpoint rule, of order 2: x⁺ = x + h·f(t + h/2, x + h·f(t, x, u)/2, u).
        Midpoint "midpoint",
    }
}

words! {
    /// How a step adds to q and N.
    Summation {
        /// Floating-point addition.
        Plain "plain",
        /// Kahan's summation: the rounding error of a step is added in the next one.
        Compensated "compensated",
    }
}

words! {
    /// How a step is written as code.
    CodeForm {
        /// Entry by entry, without loops.
        Unrolled "unrolled",
        /// Operations on matrices, for large groups.
        Matrices "matrices",
    }
}

words! {
    /// How to treat motions of the group that move no configuration.
    Isotropy {
        /// They are no motions: `state()` refuses a momentum along them.
        Fixed "fixed",
        /// They are motions: `state()` takes any momentum.
        Free "free",
    }
}

words! {
    /// The signs that the kinetic energy ½ ξ·Σξ may have.
    Signature {
        /// It is positive for every velocity ξ but 0: others are `Error::IndefiniteKineticEnergy`.
        Definite "definite",
        /// It may be negative, as on Lorentz groups: extremals of the action are then no minima.
        Indefinite "indefinite",
    }
}

words! {
    /// A promise about the values of a field, which the stepper checks and simplification uses.
    Promise {
        /// A square matrix with Aᵀ = A.
        Symmetric "symmetric",
        /// A square matrix with zeros off its diagonal.
        Diagonal "diagonal",
        /// A vector of length one.
        Unit "unit",
    }
}

/// The order of accuracy: where the potential is placed in a step, and of how many steps it is composed; or collocation.
#[derive(Copy, Clone, PartialEq, Eq, Debug)]
pub enum Order {
    /// −h V(Φ_F q).
    First = 1,
    /// −h/2 (V(q) + V(Φ_F q)).
    Second = 2,
    /// Five steps of second order.
    Fourth = 4,
    /// Eleven steps of second order.
    Sixth = 6,
    /// Seventeen steps of second order.
    Eighth = 8,
    /// Collocation at eight nodes.
    Sixteenth = 16,
}

/// All orders, and how a step of each is made.
#[rustfmt::skip]
const ORDERS: [(Order, &str); 6] = [
    (Order::First, "Drift, then kick: h·V at the end of the step."),
    (Order::Second, "Half kick, drift, half kick: h·V/2 at each end. Time-symmetric, with one gradient a step."),
    (Order::Fourth, "Composed of 5 steps of order 2, or a splitting where the drift is exact."),
    (Order::Sixth, "Composed of 11 steps of order 2, or a splitting where the drift is exact."),
    (Order::Eighth, "Composed of 17 steps of order 2."),
    (Order::Sixteenth, "Collocation of Hamilton's equations at the eight nodes of Gauss and Legendre."),
];

impl Order {
    /// The orders, each with its meaning.
    pub(super) fn meanings() -> Meanings {
        ORDERS.iter().map(|(order, meaning)| (order.to_string(), *meaning)).into_list()
    }

    /// The exponent of h in the error at a fixed time.
    pub fn number(self) -> u32 {
        self as u32
    }

    /// Of how many steps of second order a step is composed, where it is.
    pub fn stages(self) -> Option<usize> {
        match self {
            Order::First | Order::Second | Order::Sixteenth => None,
            Order::Fourth => Some(5),
            Order::Sixth => Some(11),
            Order::Eighth => Some(17),
        }
    }
}

/// The items that are emitted with the integrator.
#[derive(Copy, Clone, PartialEq, Eq, Default, Debug)]
pub struct Emit {
    /// The constant `GENERATED`, the generated code as text; needs the feature `generated`.
    pub generated: bool,
    /// The constant `DERIVATION_LATEX`, the formulas in LaTeX.
    pub latex: bool,
    /// The derivatives of a step with respect to state, parameters, step size and time.
    pub tangent: bool,
    /// The second derivatives of the discrete Lagrangian, for problems with fixed endpoints.
    pub boundary: bool,
    /// The momentum alone: the configuration is `()`.
    pub momentum: bool,
    /// The elements of the edges of a field alone, without configurations.
    pub connection: bool,
    /// The implicit midpoint steps of a field along a line.
    pub midpoint: bool,
}

/// A word of `emit`.
#[derive(Copy, Clone)]
pub(super) struct Emitted {
    /// Whether it is asked for.
    pub part: fn(&mut Emit) -> &mut bool,
    about: &'static str,
}

/// The words of `emit`: where each is noted, and the items that it adds.
#[rustfmt::skip]
pub(super) const EMITTED: [(&str, Emitted); 7] = [
    ("generated", Emitted { part: |emit| &mut emit.generated, about: "The constant `GENERATED`, the generated code as text; needs the feature `generated`." }),
    ("latex",     Emitted { part: |emit| &mut emit.latex,     about: "The constant `DERIVATION_LATEX`, the formulas in LaTeX." }),
    ("tangent",   Emitted { part: |emit| &mut emit.tangent,   about: "The methods `step_tangent` and `step_sensitivity`, the derivatives of a step." }),
    ("boundary",  Emitted { part: |emit| &mut emit.boundary,  about: "The method `boundary()`, the path of least action between two configurations." }),
    ("momentum",  Emitted { part: |emit| &mut emit.momentum,  about: "Steps of the momentum alone: the configuration is `()`." }),
    ("connection", Emitted { part: |emit| &mut emit.connection, about: "The trait `ConnectedField`: the group elements of the edges of a field, stepped without configurations." }),
    ("midpoint",  Emitted { part: |emit| &mut emit.midpoint,  about: "The trait `MidpointSite`: implicit steps of a field along a line, stable at any step size." }),
];

/// The words of `emit`, each with its meaning.
pub(super) fn emitted_meanings() -> Meanings {
    EMITTED.iter().map(|(word, emitted)| (word.to_string(), emitted.about)).into_list()
}

impl Emit {
    /// The list of words that asks for it; `None` for nothing.
    pub(super) fn text(mut self) -> Option<String> {
        let words = joined(EMITTED.iter().filter(|(_, emitted)| *(emitted.part)(&mut self)).map(|(word, _)| word));
        (!words.is_empty()).then(|| format!("[{words}]"))
    }

    /// Whether discrete Lagrangians are differentiated twice.
    pub fn variations(self) -> bool {
        self.tangent || self.boundary
    }
}

/// The numbers of dials.
impl Reader<'_, '_> {
    pub fn order(self, dial: &mut Option<Located<Order>>) -> Result<(), Diagnostic> {
        let value = |literal: &LitInt| {
            let number: u32 = literal.base10_parse().ok()?;
            ORDERS.iter().find(|(order, _)| order.number() == number).map(|(order, _)| *order)
        };
        self.number(dial, value, |place, written| {
            error!(place, "there is no step of order {written}";
                help "write `order = 2`; 4, 6, 8 or 16 for more digits, or 1 for the papers' step, drift then kick")
        })
    }

    /// A number between 0 and 1.
    pub fn part(self, dial: &mut Option<Located<f64>>) -> Result<(), Diagnostic> {
        let value = |literal: &Lit| match literal {
            Lit::Float(number) if number.suffix().is_empty() => {
                number.base10_parse().ok().filter(|part: &f64| 0.0 < *part && *part < 1.0)
            }
            _ => None,
        };
        self.number(dial, value, |place, written| {
            error!(place, "`{written}` is no tolerance";
                help "write a number between 0 and 1, as in `tolerance = 1e-8`, or leave the key out for round-off";
                note "it is the part of a step by which its momentum equation may be missed")
        })
    }

    /// A whole number above zero.
    pub fn count(self, dial: &mut Option<Located<u32>>) -> Result<(), Diagnostic> {
        let value = |literal: &Lit| match literal {
            Lit::Int(number) if number.suffix().is_empty() => {
                number.base10_parse().ok().filter(|count: &u32| *count > 0)
            }
            _ => None,
        };
        self.number(dial, value, |place, written| {
            error!(place, "`{written}` is no number of iterations";
                help "write a whole number above zero, as in `iterations = 4`, or leave the key out";
                note "it is the most iterations that a step makes for each of its momentum equations; a step that needs more is an error")
        })
    }
}
