//! What a declaration chooses from: its dials with their values, and the promises on its fields.

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

    fn word(self) -> &'static str {
        // by construction: every value has a word
        Self::WORDS.iter().find(|(_, value)| *value == self).map_or("", |(word, _)| word)
    }
}

/// Values of a dial, each with the word by which it is read and printed.
macro_rules! words {
    ($(#[$about:meta])* $dial:ident { $($(#[$meaning:meta])* $value:ident $word:literal,)+ }) => {
        $(#[$about])*
        #[derive(Copy, Clone, PartialEq, Eq, Debug)]
        pub enum $dial {
            $($(#[$meaning])* $value,)+
        }

        impl Word for $dial {
            const WORDS: &'static [(&'static str, $dial)] = &[$(($word, $dial::$value)),+];
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
        /// ξ = 2(F − I)(F + I)⁻¹/h, projected to the algebra where it leaves it.
        Cayley "cayley",
        /// ξ = log(F)/h.
        Exponential "exponential",
        /// ξ = P(F − I)/h with the orthogonal projection P to the algebra.
        Projection "projection",
        /// (F − I)/h in ½tr(ξ 𝕄 ξᵀ).
        MoserVeselov "moser_veselov",
        /// The discrete Lagrangian is the action of the free motion, which a step without a potential makes exactly.
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
        /// By Newton's method.
        Newton "newton",
        /// By x ← x − s·h·Σ⁻¹ρ(x), and by Newton's method where that does not contract.
        FixedPoint "fixed_point",
    }
}

words! {
    /// How a step adds to q and N.
    Summation {
        /// As numbers are added.
        Plain "plain",
        /// What rounding takes off is kept, and added in the next step.
        Compensated "compensated",
    }
}

words! {
    /// How a step is written as code.
    CodeForm {
        /// Entry by entry, in straight lines.
        Unrolled "unrolled",
        /// With whole matrices, in loops.
        Matrices "matrices",
    }
}

words! {
    /// What becomes of motions of the group that move no configuration.
    Isotropy {
        /// They are no motions: a momentum has to annihilate them.
        Fixed "fixed",
        /// They are motions too: any momentum is one.
        Free "free",
    }
}

words! {
    /// A promise about the values of a field, which the stepper checks and simplification uses.
    Promise {
        /// Aᵀ = A.
        Symmetric "symmetric",
        /// Zero off the diagonal.
        Diagonal "diagonal",
        /// |v| = 1.
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
    /// Nine steps of second order.
    Sixth = 6,
    /// Seventeen steps of second order.
    Eighth = 8,
    /// Collocation at eight nodes.
    Sixteenth = 16,
}

const ORDERS: [Order; 6] = [Order::First, Order::Second, Order::Fourth, Order::Sixth, Order::Eighth, Order::Sixteenth];

impl Order {
    /// The exponent of h in the error at a fixed time.
    pub fn number(self) -> u32 {
        self as u32
    }

    /// Of how many steps of second order a step is composed, where it is.
    pub fn stages(self) -> Option<usize> {
        match self {
            Order::First | Order::Second | Order::Sixteenth => None,
            Order::Fourth => Some(5),
            Order::Sixth => Some(9),
            Order::Eighth => Some(17),
        }
    }
}

/// What is emitted beside the integrator.
#[derive(Copy, Clone, PartialEq, Eq, Default, Debug)]
pub struct Emit {
    /// The constant `GENERATED`, the generated code as text.
    pub generated: bool,
    /// The constant `DERIVATION_LATEX`, the formulas in LaTeX.
    pub latex: bool,
    /// The derivatives of a step with respect to state, parameters, step size and time.
    pub tangent: bool,
    /// What problems with fixed endpoints need: second derivatives of the discrete Lagrangian.
    pub boundary: bool,
    /// The momentum alone: the configuration is `()`.
    pub momentum: bool,
}

/// Whether something is emitted.
type EmittedPart = fn(&mut Emit) -> &mut bool;

/// What may be emitted beside the integrator, and where it is asked for.
pub(super) const EMITTED: [(&str, EmittedPart); 5] = [
    ("generated", |emit| &mut emit.generated),
    ("latex", |emit| &mut emit.latex),
    ("tangent", |emit| &mut emit.tangent),
    ("boundary", |emit| &mut emit.boundary),
    ("momentum", |emit| &mut emit.momentum),
];

impl Emit {
    /// The list of words that asks for it; `None` for nothing.
    pub(super) fn text(mut self) -> Option<String> {
        let words = joined(EMITTED.iter().filter(|(_, part)| *part(&mut self)).map(|(word, _)| word));
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
            ORDERS.iter().find(|order| order.number() == number).copied()
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
