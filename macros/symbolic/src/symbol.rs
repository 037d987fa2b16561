//! Symbols: named unknowns with a shape, a role and a promise about their values.

use crate::{Group, Shape};

/// The meaning of a symbol. The role decides how often its value changes and how generated code spells it.
#[derive(Copy, Clone, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub enum Role {
    /// The step h.
    StepSize,
    /// The time t.
    Time,
    /// A parameter of the system, by its leaf index.
    Parameter(usize),
    /// A constant of the user's crate, by its index.
    Constant(usize),
    /// A leaf of the configuration q.
    Configuration(usize),
    /// A leaf of the configuration q⁺ that q is moved to.
    Image(usize),
    /// A leaf of the covector p.
    Covector(usize),
    /// A factor of the group element F.
    Element(usize),
    /// A leaf of the input u of a step.
    Input(usize),
    /// A leaf of the reference of a step, data of a plan.
    Reference(usize),
    /// A leaf of the reference of the end of a plan.
    EndReference(usize),
    /// The coordinates of log F of a factor.
    Logarithm(usize),
    /// The Cayley coordinates of F of a factor.
    Cayley(usize),
    /// A factor of the increment F − I that a step has found.
    Increment(usize),
    /// A factor of the increment of a motion that follows another.
    Following(usize),
    /// The coordinates of an algebra element ξ of a factor.
    Algebra(usize),
    /// The coordinates of a small motion of an end of an edge, by the number of the end and of the factor.
    Motion(usize, usize),
    /// The momentum μ of a factor.
    Momentum(usize),
    /// The multipliers of the momentum equation of a step.
    Multiplier,
    /// The multipliers of a constraint in a step and those of its equations in a price, by number.
    Reaction(usize),
    /// The multipliers of bounds.
    Weight,
    /// max(a, 0) in a price, by the number of a.
    Kink(usize),
    /// The representing matrix of the momentum of a factor.
    MomentumMatrix(usize),
    /// The weight of a kick that is a part of a step.
    Kick,
    /// The weight of the force gradient in such a kick.
    KickGradient,
    /// The weight of chart coordinates that are given up to a factor, by its number.
    ChartWeight(usize),
    /// c of an increment F − I = c·D that is given up to a factor, by its number.
    IncrementScale(usize),
    /// The chart coordinates of a factor's group element.
    Chart(usize),
    /// The number of sites of a power.
    Sites,
    /// The index of a site that a sum runs through, by how many sums are around it.
    Site(usize),
    /// A leaf of the configuration at a place of a power, by the number of the place and of the leaf.
    At(usize, usize),
    /// The spacing of the edges of a field in a direction.
    Spacing(usize),
    /// The direction δ of a derivative along the chart coordinates of a block.
    Direction(usize),
    /// Σ⁻¹, the inverse of the inertia.
    InertiaInverse,
    /// An element of a factor where a law of the action composes several, by the factor and the number of the element.
    Composed(usize, usize),
    /// The element of an offered symmetry, by the index of the symmetry.
    OfferedElement(usize),
    /// An element of a declared group while its equation is read.
    DeclaredElement,
    /// A number about which nothing is known, in the special value of a parameter.
    Unknown,
    /// A letter of a formula that is printed and not computed.
    Letter,
}

/// The promise about the values of a symbol.
#[derive(Copy, Clone, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub enum Property {
    /// Nothing.
    General,
    /// Aᵀ = A.
    Symmetric,
    /// Aᵀ = −A.
    Skew,
    /// Zero off the diagonal.
    Diagonal,
    /// AᵀA = I and det A = 1.
    Orthogonal,
    /// |v| = 1.
    Unit,
    /// AᵀA = I, of more rows than columns.
    Orthonormal,
    /// Aᵀ = A and A² = A, of this rank.
    Projector(usize),
    /// An element of a group that is not SO(n).
    Element(Group),
    /// F − I for an element F of a group.
    Increment(Group),
}

impl Property {
    /// Whether Aᵀ = A.
    pub fn is_symmetric(self) -> bool {
        matches!(self, Property::Symmetric | Property::Diagonal | Property::Projector(_))
    }
}

/// A symbol as it was declared.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub struct Symbol {
    /// The name, as the user spells it.
    pub name: String,
    /// The shape of the value.
    pub shape: Shape,
    /// Its meaning.
    pub role: Role,
    /// The promise about its values.
    pub property: Property,
}
