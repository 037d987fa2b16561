//! The rows of the table.

use super::Feature::{self, *};
use super::Row;

const LATER: &str = "it belongs to the language and comes with a later version of clebsch";
const ALL_SITES: &str = "write a number in place of the const generic: then all sites are written out";
const NO_EXACT: &str = "leave the key out, or write `discretization = moser_veselov`";
const NO_SUM: &str = "leave out `summation`";
const ORDER_8: &str = "write `order = 8`";
const ORDER_2: &str = "write `order = 2`";
const UNROLLED: &str = "leave out `code`, or write `code = unrolled`";
const WITHOUT_MATRICES: &[Feature] =
    &[Inputs, Power, Quaternions, ExactDrifts, FreeRotation, Collocation, HeldConfiguration, GeneralLagrangian];

/// What is refused, beside what, the message, why, and what to write.
pub(super) const ROWS: [Row; 48] = [
    // inputs move the configuration
    row(
        &[Dynamics],
        &[Controls],
        "there are `controls` and `dynamics`, but one thing moves a configuration",
        "",
        "keep `controls` for motions of a group, `dynamics` for any map of a vector space",
    ),
    row(
        &[
            Lagrangian, Potential, Force, ForceOn, Symmetry, Order, Tolerance, Iterations, Summation, Isotropy, Chart,
            Method,
        ],
        &[Controls, Dynamics],
        "a system with {beside} has no {refused}",
        "the inputs move the configuration directly, without mass, momentum or force",
        "leave it out, or leave out {beside}",
    ),
    row(
        &[Effort],
        &[Controls, Dynamics],
        "the price of {beside} is the `cost`",
        "",
        "write `cost = |h, u| h * u.norm_squared() / 2`",
    ),
    row(
        &[Tangent, Boundary],
        &[Controls, Dynamics],
        "{refused} is for steps in time, and a system with {beside} has none",
        "",
        "leave out the word: what solving for the inputs needs is always there",
    ),
    row(
        &[Action],
        &[Dynamics],
        "a system with `dynamics` has no action",
        "",
        "leave it out: the typed argument of `dynamics` is the configuration, and any map moves it",
    ),
    row(
        &[OtherDiscretization],
        &[Controls],
        "controls move by the exponential or by Cayley's map",
        "",
        "write `discretization = exponential` or `discretization = cayley`",
    ),
    row(
        &[CayleyDiscretization],
        &[NoCayleyMap],
        "`{name}` has no Cayley map",
        "(I - Z)⁻¹(I + Z) is not in {name} for every Z of its Lie algebra",
        "write `discretization = exponential`",
    ),
    // kinetic energies
    row(
        &[Lagrangian],
        &[Cost],
        "there is a cost and a lagrangian, but a step needs one kinetic energy",
        "",
        "keep one of the two: the `lagrangian` is discretised for you, the `cost` is discrete as it stands",
    ),
    row(
        &[Discretization],
        &[Cost],
        "a cost is discrete already, there is nothing to discretise",
        "",
        "remove `discretization`, or declare a `lagrangian` instead of the `cost`",
    ),
    // paths of least action
    row(
        &[Composition],
        &[Boundary, Effort],
        "{beside} is for steps of order 2, not of order {name}",
        "a composed step runs back in some of its parts, where the least action is the greatest",
        ORDER_2,
    ),
    row(
        &[Sixteenth],
        &[Boundary, Effort],
        "{beside} is for steps of order 2, not of order {name}",
        "a step of order 16 collocates Hamilton's equations and has no discrete Lagrangian",
        ORDER_2,
    ),
    row(
        &[Forces],
        &[Boundary],
        "a system with forces has no action that fixed endpoints could make critical",
        "forces that are gradients belong in the potential",
        "leave out `boundary` from `emit`, or the force",
    ),
    row(
        &[Effort],
        &[AdjointPair],
        "this step is composed of two, and the inputs of such steps cannot be chosen yet",
        "a cost that changes when the step is run back has order 1, and is composed with its adjoint for order 2",
        "write `order = 1`, or a cost that is its own adjoint, or a `lagrangian`",
    ),
    row(
        &[OpaquePotential],
        &[Effort],
        "{beside} needs a potential that is a formula",
        "it differentiates forces, and an opaque potential gives a value and a gradient, no second derivatives",
        "write the potential as a closure, or leave out the effort",
    ),
    row(
        &[OpaquePotential],
        &[Tangent, Boundary],
        "{beside} needs a potential that is a formula",
        "it differentiates forces, and an opaque potential gives a value and a gradient, no second derivatives",
        "write the potential as a closure, or leave out the word",
    ),
    // momenta alone
    row(
        &[Potential, ForceOn, Symmetry, Isotropy, Endpoint, Effort, Controls, Dynamics, Bounds],
        &[Momentum],
        "{beside} steps the momentum alone, without {refused}",
        "it needs the configuration, and none is stepped",
        "leave out {refused}, or the word `momentum`",
    ),
    row(
        &[Tangent],
        &[Momentum],
        "`momentum` and `tangent` do not go together",
        "`tangent` is about motions of the configuration, and none is stepped",
        "leave out one of the two",
    ),
    row(
        &[Boundary],
        &[Momentum],
        "`momentum` and `boundary` do not go together",
        "`boundary` is about motions of the configuration, and none is stepped",
        "leave out one of the two",
    ),
    row(
        &[DependsOnConfiguration],
        &[Momentum],
        "{beside} steps the momentum alone, and this depends on `{name}`",
        "",
        "leave out the word `momentum`",
    ),
    // powers
    row(
        &[OpaquePotential, Force, ForceOn, Endpoint, Symmetry, Controls, Dynamics, Effort],
        &[Power],
        "{refused} of a power is not supported yet",
        LATER,
        ALL_SITES,
    ),
    row(&[Composition, Sixteenth], &[Power], "`order = {name}` of a power is not supported yet", LATER, ALL_SITES),
    row(
        &[Summation, Tangent, Boundary, Momentum, Method],
        &[Power],
        "{refused} of a power is not supported yet",
        LATER,
        ALL_SITES,
    ),
    // groups
    row(
        &[Symmetry],
        &[LargeGroup],
        "a symmetry is offered, but `{name}` has more than 64 dimensions",
        "in larger groups single components are looked at, not what combines them",
        "leave out `symmetry`: which components of the momentum are conserved is found without it",
    ),
    row(
        &[CayleyChart],
        &[NoCayleyMap],
        "the Cayley map leaves {name}",
        "(I - Z)^-1 (I + Z) stays in groups of a quadratic equation, like SO<n>, Sp<2n> and U<n>",
        "write `chart = exponential`, or leave the key out",
    ),
    // free motions
    row(
        &[ExactDiscretization],
        &[UnknownFreeMotion],
        "`discretization = exact` knows the free motion on `SO<3>`, `SU<2>`, `SO<4>` and `Translation<n>`, not on `{name}`",
        "the free motion of other groups is no map of Moser and Veselov with constants that are known",
        "write `discretization = exponential`, which is exact where the kinetic energy is the same for all axes, or leave the key out",
    ),
    row(
        &[ExactDiscretization],
        &[RotationsOfFourSpace],
        "`discretization = exact` knows the free motion on `SO<4>` where nothing else moves or acts",
        "its constants are those of one motion: a kick ends the motion, and to find those of the next takes much longer than a step",
        "leave out the potential and the other factors, or the key",
    ),
    row(
        &[ExactDiscretization],
        &[Forces],
        "`discretization = exact` knows no forces",
        "the velocity that a force sees is made of the group element of a step, by a discretisation that is a formula of it",
        NO_EXACT,
    ),
    row(
        &[ExactDiscretization],
        &[Tangent, Boundary, Effort],
        "`discretization = exact` cannot be differentiated twice",
        "its discrete Lagrangian is the action of the free motion, which is no formula of the group element",
        "leave out `emit = [tangent]` or `emit = [boundary]`, or write another discretization; a struct that is generic over its scalar can be stepped with dual numbers",
    ),
    row(
        &[ExactDiscretization],
        &[VaryingEnergy],
        "`discretization = exact` needs a constant quadratic form of the velocity of each factor",
        "the free motion conserves the energy and the length of the momentum, and is known in terms of both",
        "write a kinetic energy, as in `{name}.dot(&(self.inertia * {name})) / 2`, or leave the key out",
    ),
    row(
        &[ExactDiscretization],
        &[NoDistributionOfMass],
        "`discretization = exact` needs the kinetic energy of a mass distribution on `SO<4>`",
        "other quadratic forms of the velocity have no integrals beside the energy and those of the group: their motions are chaotic",
        "write `(self.mass * {name}.matrix() * {name}.matrix().transpose()).trace() / 2` with a symmetric matrix `mass`, or leave the key out",
    ),
    row(
        &[MoserVeselov],
        &[CoupledVelocities],
        "the Lagrangian is not a quadratic form of the velocity of each factor",
        "the Moser–Veselov discretisation puts (F - I)/h into ½ tr(ξ 𝕄 ξᵀ), which is quadratic and one for each factor",
        "leave out `discretization = moser_veselov`, or write a kinetic energy, as in `{name}.dot(&(self.inertia * {name})) / 2`",
    ),
    row(
        &[MoserVeselov],
        &[NoMassMatrix],
        "this Lagrangian has no Moser–Veselov form on `{name}`",
        "that form is ½ tr(ξ 𝕄 ξᵀ) with a symmetric matrix 𝕄; the inertia of this Lagrangian is of that form for no 𝕄 that holds for all values of its parameters",
        "leave out `discretization`: the default exists for every Lagrangian",
    ),
    // collocation
    row(
        &[Collocation],
        &[Momentum],
        "`order = 16` moves a configuration, and there is none",
        "its stages are pairs (q, p)",
        "leave out `momentum` from `emit`, or write `order = 8`",
    ),
    row(
        &[Collocation],
        &[Forces],
        "`order = 16` knows no forces",
        "forces act at both ends of a step, of second order",
        ORDER_2,
    ),
    row(
        &[Collocation],
        &[Tangent],
        "a step of order 16 cannot be differentiated by `emit`",
        "derivatives are derived for steps of a discrete Lagrangian and for what is composed of them",
        "write `order = 8`; a struct that is generic over its scalar can be stepped with dual numbers",
    ),
    row(
        &[Collocation],
        &[GeneralLagrangian, MovingInertia],
        "`order = 16` needs a kinetic energy with a constant inertia",
        "its equations are those of ½ (J − A)·Σ⁻¹(J − A) + V, with Σ⁻¹ made once",
        ORDER_8,
    ),
    row(
        &[Collocation],
        &[UnmovedFactor],
        "`order = 16` moves what a momentum is made of, and `{name}` moves nothing",
        "its stages are pairs (q, p), and J(q, p) has no part for this factor",
        ORDER_8,
    ),
    row(
        &[Collocation],
        &[FreeIsotropy],
        "with `isotropy = free` momenta are not those of a covector, which `order = 16` moves",
        "its stages are pairs (q, p), and no p has a momentum J(q, p) about an axis that q does not show",
        "write `order = 8`, or declare the whole attitude",
    ),
    row(
        &[Collocation],
        &[BentAction],
        "`order = 16` needs an action that is linear in the configuration, or affine",
        "collocation keeps what is quadratic in (q, p), as the momentum of a linear action is",
        ORDER_8,
    ),
    row(
        &[Collocation],
        &[UnliftedMomentum],
        "`order = 16` knows no covector of a momentum for this action of `{name}`",
        "it knows p = λ μ_Q(q), for rotations and translations of what each factor moves by itself",
        ORDER_8,
    ),
    // sums
    row(
        &[Summation],
        &[FreeMotionOfFourSpace],
        "the free motion on `SO<4>` finds the next momentum from the group element, so there is no sum to compensate",
        "it takes steps of any size: with longer ones there are fewer to round",
        NO_SUM,
    ),
    row(
        &[Summation],
        &[CoupledCost],
        "this cost makes the momentum anew in each step, so there is no sum to compensate",
        "where a cost couples the configuration and the group element, N⁺ is the other trivialisation of its slope, and not N with something added",
        NO_SUM,
    ),
    row(
        &[Summation],
        &[OtherSum],
        "the action does not add to `{name}`, so there is no sum to compensate",
        "with F = I + D an action has to be a polynomial in D, as linear and affine ones are",
        NO_SUM,
    ),
    // equations
    row(
        &[ExponentialChart],
        &[Poles],
        "the momentum equation of this step has poles in the exponential chart",
        "it divides by what vanishes where F turns by π, and beside that what is computed has lost its digits",
        "leave out `chart`: then Cayley's is chosen, in which it has none",
    ),
    row(
        &[Iterations],
        &[ExplicitEquation],
        "the momentum equation of this step is solved without iteration",
        "",
        "leave out `iterations`: every step takes the same number of operations",
    ),
    row(
        &[Tolerance],
        &[FreeMotion],
        "the free motion is found once for all steps, to round-off",
        "the series of a free rotation are evaluated again after each kick",
        "leave out `tolerance`",
    ),
    row(
        &[Tolerance],
        &[ExplicitEquation],
        "the momentum equation of this step is solved without iteration",
        "a tolerance says where an iteration ends",
        "leave out `tolerance`",
    ),
    // code
    row(&[Matrices], WITHOUT_MATRICES, "{beside} has no code with whole matrices yet", "", UNROLLED),
];

const fn row(
    refused: &'static [Feature],
    beside: &'static [Feature],
    message: &'static str,
    why: &'static str,
    help: &'static str,
) -> Row {
    Row { refused, beside, message, why, help }
}
