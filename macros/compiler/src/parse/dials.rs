//! What a declaration chooses from: its dials with their values, and the promises on its fields.

use std::fmt;

use proc_macro2::Ident;

use super::keys::Located;

/// The keys that are no closures; each has a default.
#[derive(Clone, Default)]
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

/// A value that a word chooses.
pub(super) trait Word: Copy + PartialEq + 'static {
    /// The words with their values.
    const WORDS: &'static [(&'static str, Self)];

    /// The word of a value.
    fn word(self) -> &'static str {
        // by construction: every value has a word
        Self::WORDS.iter().find(|(_, value)| *value == self).map_or("", |(word, _)| word)
    }
}

/// The words of a dial's values, by which these are read and printed.
macro_rules! words {
    ($dial:ident: $($word:literal $value:ident),+) => {
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

words!(Discretization: "cayley" Cayley, "exponential" Exponential, "projection" Projection, "moser_veselov" MoserVeselov, "exact" Exact);
words!(ChartChoice: "cayley" Cayley, "exponential" Exponential);
words!(Solver: "newton" Newton, "fixed_point" FixedPoint);
words!(Summation: "plain" Plain, "compensated" Compensated);
words!(CodeForm: "unrolled" Unrolled, "matrices" Matrices);
words!(Isotropy: "fixed" Fixed, "free" Free);

/// What may be emitted beside the integrator; `None` for what comes later.
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

/// A promise about the values of a field, which the stepper checks and simplification uses.
#[derive(Copy, Clone, PartialEq, Eq, Debug)]
pub enum Promise {
    /// Aᵀ = A.
    Symmetric,
    /// Zero off the diagonal.
    Diagonal,
    /// |v| = 1.
    Unit,
}

/// How the velocity of a step is made from its group element.
#[derive(Copy, Clone, PartialEq, Eq, Debug)]
pub enum Discretization {
    /// ξ = 2(F − I)(F + I)⁻¹/h, projected to the algebra where it leaves it.
    Cayley,
    /// ξ = log(F)/h.
    Exponential,
    /// ξ = P(F − I)/h with the orthogonal projection P to the algebra.
    Projection,
    /// (F − I)/h in ½tr(ξ 𝕄 ξᵀ).
    MoserVeselov,
    /// The discrete Lagrangian is the action of the free motion, which a step without a potential makes exactly.
    Exact,
}

/// The coordinates in which the group element of a step is looked for, where the user chooses them.
#[derive(Copy, Clone, PartialEq, Eq, Debug)]
pub enum ChartChoice {
    /// F = (I − Z)⁻¹(I + Z).
    Cayley,
    /// F = exp ξ.
    Exponential,
}

/// How an implicit momentum equation is solved first.
#[derive(Copy, Clone, PartialEq, Eq, Debug)]
pub enum Solver {
    /// By Newton's method.
    Newton,
    /// By x ← x − s·h·Σ⁻¹ρ(x), and by Newton's method where that does not contract.
    FixedPoint,
}

/// How a step adds to q and N.
#[derive(Copy, Clone, PartialEq, Eq, Debug)]
pub enum Summation {
    /// As numbers are added.
    Plain,
    /// What rounding takes off is kept, and added in the next step.
    Compensated,
}

/// How a step is written as code.
#[derive(Copy, Clone, PartialEq, Eq, Debug)]
pub enum CodeForm {
    /// Entry by entry, in straight lines.
    Unrolled,
    /// With whole matrices, in loops.
    Matrices,
}

/// What becomes of motions of the group that move no configuration.
#[derive(Copy, Clone, PartialEq, Eq, Default, Debug)]
pub enum Isotropy {
    /// They are no motions: a momentum has to annihilate them.
    #[default]
    Fixed,
    /// They are motions too: any momentum is one.
    Free,
}

/// The order of accuracy: where the potential is placed in a step, and of how many steps it is composed; or collocation.
#[derive(Copy, Clone, PartialEq, Eq, Debug)]
pub enum Order {
    /// −h V(Φ_F q).
    First,
    /// −h/2 (V(q) + V(Φ_F q)).
    Second,
    /// Five steps of second order.
    Fourth,
    /// Nine steps of second order.
    Sixth,
    /// Seventeen steps of second order.
    Eighth,
    /// Collocation at eight nodes.
    Sixteenth,
}

impl Order {
    /// The exponent of h in the error at a fixed time.
    pub fn number(self) -> u32 {
        match self {
            Order::First => 1,
            Order::Second => 2,
            Order::Fourth => 4,
            Order::Sixth => 6,
            Order::Eighth => 8,
            Order::Sixteenth => 16,
        }
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

impl Emit {
    /// Nothing beside the integrator.
    pub(super) const NOTHING: Emit =
        Emit { generated: false, latex: false, tangent: false, boundary: false, momentum: false };

    /// The list of words that asks for it; `None` for nothing.
    pub(super) fn text(self) -> Option<String> {
        let asked = EMITTED.iter().filter(|(_, emit)| emit.is_some_and(|emit| self.and(emit) == self));
        let words: Vec<&str> = asked.map(|(word, _)| *word).collect();
        (!words.is_empty()).then(|| format!("[{}]", words.join(", ")))
    }

    /// What either of two asks for.
    pub(super) fn and(self, other: Emit) -> Emit {
        Emit {
            generated: self.generated || other.generated,
            latex: self.latex || other.latex,
            tangent: self.tangent || other.tangent,
            boundary: self.boundary || other.boundary,
            momentum: self.momentum || other.momentum,
        }
    }

    /// What is emitted of a method beside the integrator: what says which system is stepped.
    pub(super) fn of_method(self) -> Emit {
        Emit { momentum: self.momentum, ..Emit::NOTHING }
    }

    /// Whether discrete Lagrangians are differentiated twice.
    pub fn variations(self) -> bool {
        self.tangent || self.boundary
    }
}
