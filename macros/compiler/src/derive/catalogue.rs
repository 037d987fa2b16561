//! The table of formulas: each has an id, by which prints, documentation and the later stages find it.

use super::Reference::{self, ClebschOptimalControl, DiscreteMechanics, LieGroupMethods, MechanicsAndSymmetry};
use Heat::{Cold, Hot};

/// Which formula; numbers are those of the substep, and of the equation in it, or of the term.
#[derive(Copy, Clone, PartialEq, Eq, Debug)]
pub enum Id {
    /// Φ_F(q).
    Action,
    /// ξ_Q(q).
    Generator,
    /// J(q, p).
    MomentumMap,
    /// Ad*_F μ.
    Coadjoint,
    /// (TΦ_F)^{-*} p.
    CotangentLift,
    /// The representing matrices of μ.
    MomentumMatrix,
    /// The components of representing matrices.
    MomentumComponents,
    /// What vanishes where q lies on the groups that it is promised to lie on.
    Membership,
    /// τ(x) − I, and τ(−x) − I behind it.
    Retraction,
    /// The increment of a motion and of another after it.
    Composition,
    /// GᵀG ξ of G: ξ ↦ ξ_Q(q).
    OrbitMetric,
    /// Σξ.
    Inertia,
    /// T(ξ).
    KineticEnergy,
    /// ℓ(ξ), which is not quadratic.
    Lagrangian,
    /// ∂ℓ/∂ξ.
    LagrangianGradient,
    /// ∂²ℓ/∂ξ².
    LagrangianHessian,
    /// A of a kinetic energy ½ ξ·Σξ + A·ξ.
    Gyroscopic,
    /// V(q).
    PotentialEnergy,
    /// H(q, μ).
    Hamiltonian,
    /// H(q, μ) − V(q).
    KineticEnergyOfMomentum,
    /// The force in 𝔤*.
    Force,
    /// K(h, F).
    DiscreteLagrangian,
    /// U₀(h, q).
    StartPotential,
    /// U₁(h, q⁺).
    EndPotential,
    /// F⁻ℓd(q, F).
    Legendre,
    /// F⁺ℓd(q, F).
    LegendreNext,
    /// A term of the potential of a power.
    Term(usize),
    /// Its gradient at a place that it reads.
    TermGradient(usize, usize),
    /// What moves a configuration that is steered.
    Controls,
    /// The price of a step.
    Price,
    /// The bounds of inputs.
    Bounds,
    /// The price of the end.
    PriceOfEnd,
    /// A momentum that no step changes.
    Conserved(usize),
    /// All of these.
    ConservedMomenta,
    /// M − N, the kick before the solve.
    StartKick(usize),
    /// What of that kick the cost gives at F = I.
    RestKick(usize),
    /// The same kick of the covector.
    StartGradient(usize),
    /// The impulse of the force before the solve.
    StartForce(usize),
    /// What of it depends on the velocity.
    MovingForce(usize),
    /// The impulse of the force after the move.
    EndForce(usize),
    /// ρ(x) = 0.
    Equation(usize, usize),
    /// Dρ(x)·δ.
    Jacobian(usize, usize),
    /// B(x) with Dρ(x)·δ = ⟨δ^·B, E⟩.
    JacobianFactor(usize, usize),
    /// x(μ).
    Solution(usize, usize),
    /// x(μ) to first order in h, component by component: what iterations start from.
    Predictor(usize, usize),
    /// M⁺.
    MomentumUpdate(usize),
    /// The same with F = I + D.
    MomentumAfter(usize),
    /// N⁺ − M⁺, the kick after the move.
    EndKick(usize),
    /// The same kick of the covector.
    EndGradient(usize),
    /// The kick of the covector by a cost that couples.
    CoupledGradient(usize),
    /// By how much the momentum of a step of first order is ahead.
    SynchronizedMomentum,
    /// The kick of a splitting, with its weights.
    SplittingKick,
    /// The same kick of the covector.
    SplittingGradient,
    /// F − I in the chart.
    Increment,
    /// q⁺ with F = I + D.
    Advance,
    /// q⁺ by the chart coordinates alone.
    Displacement,
    /// The cotangent lift with F = I + D.
    Lift,
    /// What a step of order 16 collocates.
    HamiltonEquations,
    /// What its sweeps start from.
    Guess,
    // what follows has kernels, and is no row of the table
    /// What a stepper computes once.
    Constants,
    /// The coefficients of ξ_i ξ_j, i ≤ j, in the kinetic energy.
    EnergyCoefficients,
    /// The matrix of ξ ↦ ξ_Q(q), or the projection of μ to the momenta of motions, where motions that fix q are not free.
    Isotropy,
    /// J(q, p) as a step computes it that maps covectors.
    MomentumOfStep,
    /// A covector p at q with J(q, p) = μ.
    Covector,
    /// The gradient of a term at all places that it reads.
    TermGradients(usize),
    /// What the gradient of a site has at every site.
    SiteGradient,
    /// ℓd, F⁻ℓd, F⁺ℓd, ∂F⁻ℓd/∂η, ∂F⁻ℓd/∂η′, ∂F⁺ℓd/∂η′, and ∂F⁺ℓd/∂η where it is not −(∂F⁻ℓd/∂η′)ᵀ: matrices, or what they make of one motion.
    Edge(usize),
    /// ℓd, F⁻ℓd, F⁺ℓd.
    EdgeMomenta(usize),
    /// F⁺ℓd; Ad, ∂F⁻ℓd and ∂F⁺ℓd for motions that leave F as it is; ∂F⁻ℓd/∂η′, ∂F⁺ℓd/∂η′.
    Carried(usize),
    /// The derivatives of F⁻ℓd and of F⁺ℓd with respect to the quantities that are fixed during a step.
    EdgeSlopes(usize),
    /// J(q, q⁺ − q).
    Approach,
    /// A, B, ℓ, ∂ℓ/∂η, ∂ℓ/∂u and the second derivatives of ℓ + λ·η′.
    StepExpanded,
    /// ∂F⁻ℓd/∂u and ∂F⁺ℓd/∂u.
    ByInput,
    /// The second derivatives of β·F⁺ℓd + κ·F⁻ℓd along the motions that leave F as it is, those of q⁺ alone, and the inputs.
    Bend,
    /// ± ½ μ·[E_i, E_j].
    Bracket,
    /// Where forces take the inputs: ℓ, ∂ℓ/∂η, ∂ℓ/∂u and the second derivatives.
    PriceExpanded,
    /// What price and step gain with h and with t.
    PriceOfTime,
    /// a, ∂a/∂η, ∂a/∂u and the second derivatives of z·a.
    BoundsExpanded,
    /// φ, ∂φ/∂t, ∂φ/∂η, ∂²φ/∂η².
    PriceOfEndExpanded,
    /// |a|² of a closed form, which has to be below one.
    SineSquared(usize, usize),
    /// x(μ) by the rotation in a plane.
    ClosedForm(usize, usize),
    /// x(μ), coordinate after coordinate.
    Explicit(usize, usize),
    /// −ρ(0) and Dρ of a linear equation.
    System(usize, usize),
    /// What an iteration computes once.
    Preparation(usize, usize),
    /// ρ(x) alone, where x ← x − s·h·Σ⁻¹ρ(x) is tried before Newton's method.
    Residual(usize, usize),
    /// ρ(x) and Dρ(x).
    Linearization(usize, usize),
}

/// How often a formula is computed, which decides how its code is written.
#[derive(Copy, Clone, PartialEq, Eq, Debug)]
pub enum Heat {
    /// In steps, or again and again by solvers: what costs least.
    Hot,
    /// When someone asks for it: matrix code that a person can read.
    Cold,
}

/// What the table says of a formula.
#[derive(Copy, Clone, PartialEq, Eq, Debug)]
pub struct Entry {
    /// What it is, in words.
    pub title: &'static str,
    /// Where it comes from; `None` for what is declared or follows from the formulas above it.
    pub source: Option<Reference>,
    /// How often it is computed.
    pub heat: Heat,
    /// Whether prints and `DERIVATION` list it; the rest is in the documentation of methods alone.
    pub is_listed: bool,
}

impl Id {
    /// The numbers of its substep and of its equation there, as far as it has them.
    fn numbers(&mut self) -> (Option<&mut usize>, Option<&mut usize>) {
        match self {
            Id::StartKick(substep)
            | Id::RestKick(substep)
            | Id::StartForce(substep)
            | Id::MovingForce(substep)
            | Id::EndForce(substep)
            | Id::StartGradient(substep)
            | Id::MomentumUpdate(substep)
            | Id::MomentumAfter(substep)
            | Id::EndKick(substep)
            | Id::EndGradient(substep)
            | Id::CoupledGradient(substep)
            | Id::Edge(substep)
            | Id::EdgeMomenta(substep)
            | Id::Carried(substep)
            | Id::EdgeSlopes(substep) => (Some(substep), None),
            Id::Equation(substep, number)
            | Id::Jacobian(substep, number)
            | Id::JacobianFactor(substep, number)
            | Id::Solution(substep, number)
            | Id::Predictor(substep, number)
            | Id::SineSquared(substep, number)
            | Id::ClosedForm(substep, number)
            | Id::Explicit(substep, number)
            | Id::System(substep, number)
            | Id::Preparation(substep, number)
            | Id::Residual(substep, number)
            | Id::Linearization(substep, number) => (Some(substep), Some(number)),
            _ => (None, None),
        }
    }

    /// The substep whose formula it is; `None` for those of the whole system.
    pub fn substep(mut self) -> Option<usize> {
        self.numbers().0.copied()
    }

    /// The equation whose formula it is, by its number in its substep.
    pub fn equation(mut self) -> Option<usize> {
        self.numbers().1.copied()
    }

    /// The same of an equation of a substep.
    pub fn at(mut self, (index, equation): (usize, usize)) -> Id {
        let (substep, number) = self.numbers();
        substep.into_iter().for_each(|substep| *substep = index);
        number.into_iter().for_each(|number| *number = equation);
        self
    }

    /// Whether another id differs from it in numbers alone.
    pub fn is_like(self, other: Id) -> bool {
        std::mem::discriminant(&self) == std::mem::discriminant(&other)
    }

    /// What the table says.
    pub fn entry(self) -> Entry {
        let listed = |title, source, heat| Entry { title, source, heat, is_listed: true };
        let unlisted = |title, source, heat| Entry { title, source, heat, is_listed: false };
        match self {
            Id::Action => listed("action", Some(ClebschOptimalControl), Cold),
            Id::Generator => listed("generator", Some(MechanicsAndSymmetry), Hot),
            Id::MomentumMap => listed("momentum map", Some(MechanicsAndSymmetry), Cold),
            Id::Coadjoint => listed("coadjoint action", Some(MechanicsAndSymmetry), Cold),
            Id::CotangentLift => listed("cotangent lift", Some(ClebschOptimalControl), Cold),
            Id::MomentumMatrix | Id::MomentumComponents => unlisted("momentum matrix", None, Cold),
            Id::Membership => unlisted("group", None, Cold),
            Id::Retraction => unlisted("retraction", Some(LieGroupMethods), Hot),
            Id::Composition => unlisted("composition", None, Hot),
            Id::OrbitMetric => unlisted("metric of the orbit", None, Cold),
            Id::Inertia => listed("inertia", Some(MechanicsAndSymmetry), Hot),
            Id::KineticEnergy => listed("kinetic energy", None, Cold),
            Id::Lagrangian => listed("Lagrangian", None, Cold),
            Id::LagrangianGradient => unlisted("momentum", None, Cold),
            Id::LagrangianHessian => unlisted("Hessian of the Lagrangian", None, Cold),
            Id::Gyroscopic => unlisted("slope of the kinetic energy", None, Hot),
            Id::PotentialEnergy => listed("potential energy", None, Hot),
            Id::Hamiltonian => listed("Hamiltonian", Some(MechanicsAndSymmetry), Cold),
            Id::KineticEnergyOfMomentum => unlisted("kinetic energy", Some(MechanicsAndSymmetry), Cold),
            Id::Force => listed("force", None, Hot),
            Id::DiscreteLagrangian => listed("discrete Lagrangian", None, Cold),
            Id::StartPotential | Id::EndPotential => listed("", None, Cold),
            Id::Legendre => listed("Legendre transform", Some(DiscreteMechanics), Cold),
            Id::LegendreNext => listed("next Legendre transform", Some(DiscreteMechanics), Cold),
            Id::Term(_) => listed("term", None, Hot),
            Id::TermGradient(..) => listed("gradient of a term", None, Hot),
            Id::Controls => listed("controls", None, Hot),
            Id::Price => listed("price", None, Hot),
            Id::Bounds => listed("bounds", None, Hot),
            Id::PriceOfEnd => listed("price of the end", None, Hot),
            Id::ConservedMomenta => unlisted("conserved", None, Cold),
            Id::Conserved(_) => listed("conserved", None, Cold),
            Id::StartKick(_) | Id::EndKick(_) | Id::SplittingKick => listed("kick", Some(ClebschOptimalControl), Hot),
            Id::RestKick(_) => unlisted("kick", Some(ClebschOptimalControl), Hot),
            Id::StartGradient(_) | Id::EndGradient(_) | Id::CoupledGradient(_) | Id::SplittingGradient => {
                unlisted("kick of the covector", Some(ClebschOptimalControl), Hot)
            }
            Id::StartForce(_) | Id::MovingForce(_) | Id::EndForce(_) => unlisted("impulse of the force", None, Hot),
            Id::Equation(..) => listed("equation", Some(LieGroupMethods), Hot),
            Id::Jacobian(..) => listed("Jacobian", Some(LieGroupMethods), Hot),
            Id::JacobianFactor(..) => unlisted("factor of the Jacobian", None, Hot),
            Id::Solution(..) => listed("solution", None, Hot),
            Id::Predictor(..) | Id::Guess => unlisted("predictor", None, Hot),
            Id::MomentumUpdate(_) => listed("momentum update", Some(ClebschOptimalControl), Hot),
            Id::MomentumAfter(_) => unlisted("momentum update", Some(ClebschOptimalControl), Hot),
            Id::Increment => unlisted("increment", Some(LieGroupMethods), Hot),
            Id::Advance | Id::Displacement => unlisted("action", Some(ClebschOptimalControl), Hot),
            Id::Lift => unlisted("cotangent lift", Some(ClebschOptimalControl), Cold),
            Id::SynchronizedMomentum => listed("synchronized momentum", None, Hot),
            Id::HamiltonEquations => listed("Hamilton's equations", Some(MechanicsAndSymmetry), Hot),
            // no formulas
            _ => unlisted("", None, Hot),
        }
    }
}
