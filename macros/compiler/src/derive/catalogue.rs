//! The catalogue of formulas and kernels: each has an id, by which prints, documentation and the later stages find it.

use std::fmt;

use Heat::{Cold, Hot};
use Reference::{ClebschOptimalControl, DiscreteMechanics, LieGroupMethods, MechanicsAndSymmetry};

/// A published source.
#[derive(Copy, Clone, PartialEq, Eq, Debug)]
pub enum Reference {
    /// The two theorems that every step is an instance of.
    ClebschOptimalControl,
    /// Discrete Legendre transforms and discrete Noether theorem.
    DiscreteMechanics,
    /// Hessians, momentum maps, coadjoint actions and their conventions.
    MechanicsAndSymmetry,
    /// The Cayley map as a chart, with the derivative used here.
    LieGroupMethods,
}

impl fmt::Display for Reference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Reference::ClebschOptimalControl => "N. Nordkvist, P. E. Crouch, A. M. Bloch, Discrete Clebsch Optimal Control, theorems 1 and 2",
            Reference::DiscreteMechanics => {
                "J. E. Marsden, M. West, Discrete mechanics and variational integrators, Acta Numerica 10 (2001) 357-514"
            }
            Reference::MechanicsAndSymmetry => "J. E. Marsden, T. S. Ratiu, Introduction to Mechanics and Symmetry, 2nd edition, Springer 1999",
            Reference::LieGroupMethods => {
                "A. Iserles, H. Z. Munthe-Kaas, S. P. Norsett, A. Zanna, Lie-group methods, Acta Numerica 9 (2000) 215-365"
            }
        })
    }
}

/// How often a formula is computed, which decides how its code is written.
#[derive(Copy, Clone, PartialEq, Eq, Debug)]
pub enum Heat {
    /// In steps, or again and again by solvers: the cheapest code.
    Hot,
    /// When someone asks for it: matrix code that a person can read.
    Cold,
}

/// The facts of a formula in the catalogue.
#[derive(Copy, Clone, PartialEq, Eq, Debug)]
pub struct Entry {
    /// Its name, in words.
    pub title: &'static str,
    /// Its source; `None` for a declaration, or if it follows from the formulas above it.
    pub source: Option<Reference>,
    /// How often it is computed.
    pub heat: Heat,
    /// Whether prints and `DERIVATION` list it; other formulas are in the documentation of methods alone.
    pub is_listed: bool,
}

const fn listed(title: &'static str, heat: Heat) -> Entry {
    Entry { title, source: None, heat, is_listed: true }
}

const fn unlisted(title: &'static str, heat: Heat) -> Entry {
    Entry { is_listed: false, ..listed(title, heat) }
}

impl Entry {
    const fn by(self, source: Reference) -> Entry {
        Entry { source: Some(source), ..self }
    }
}

/// The numbers of an id, by their meaning.
#[derive(Default)]
#[expect(dead_code, reason = "substeps and equations alone are asked for")]
struct Numbers<'i> {
    substep: Option<&'i mut usize>,
    equation: Option<&'i mut usize>,
    term: Option<&'i mut usize>,
    joint: Option<&'i mut usize>,
    direction: Option<&'i mut usize>,
    place: Option<&'i mut usize>,
    momentum: Option<&'i mut usize>,
}

/// One row for each id: its name with its numbers, and its entry.
macro_rules! catalogue {
    ($($(#[$doc:meta])* $name:ident $(($($number:ident: $type:ty),*))? = $entry:expr;)*) => {
        /// Which formula or kernel.
        #[derive(Copy, Clone, PartialEq, Eq, Debug)]
        pub enum Id {
            $($(#[$doc])* $name $(($($type),*))?,)*
        }

        impl Id {
            /// Its entry in the catalogue.
            pub fn entry(self) -> Entry {
                match self {
                    $(Id::$name { .. } => $entry,)*
                }
            }

            fn numbers(&mut self) -> Numbers<'_> {
                match self {
                    $(Id::$name $(($($number),*))? => {
                        Numbers { $($($number: Some($number),)*)? ..Numbers::default() }
                    })*
                }
            }
        }
    };
}

impl Id {
    /// The substep whose formula it is; `None` for those of the system.
    pub fn substep(mut self) -> Option<usize> {
        self.numbers().substep.copied()
    }

    /// The equation whose formula it is, by its number in its substep.
    pub fn equation(mut self) -> Option<usize> {
        self.numbers().equation.copied()
    }

    /// The same of an equation of a substep.
    pub fn at(mut self, (index, number): (usize, usize)) -> Id {
        let Numbers { substep, equation, .. } = self.numbers();
        substep.into_iter().for_each(|substep| *substep = index);
        equation.into_iter().for_each(|equation| *equation = number);
        self
    }

    /// Whether another id differs from it in numbers alone.
    pub fn is_like(self, other: Id) -> bool {
        std::mem::discriminant(&self) == std::mem::discriminant(&other)
    }
}

catalogue! {
    /// Φ_F(q).
    Action = listed("action", Cold).by(ClebschOptimalControl);
    /// ξ_Q(q).
    Generator = listed("generator", Hot).by(MechanicsAndSymmetry);
    /// J(q, p).
    MomentumMap = listed("momentum map", Cold).by(MechanicsAndSymmetry);
    /// Ad*_F μ.
    Coadjoint = listed("coadjoint action", Cold).by(MechanicsAndSymmetry);
    /// (TΦ_F)^{-*} p.
    CotangentLift = listed("cotangent lift", Cold).by(ClebschOptimalControl);
    /// The representing matrices of μ.
    MomentumMatrix = unlisted("momentum matrix", Cold);
    /// The components of representing matrices.
    MomentumComponents = unlisted("momentum matrix", Cold);
    /// The terms that vanish where q lies on the groups that it is promised to lie on.
    Membership = unlisted("group", Cold);
    /// τ(x) − I, and τ(−x) − I behind it.
    Retraction = unlisted("retraction", Hot).by(LieGroupMethods);
    /// The increment of a motion and of another after it.
    Composition = unlisted("composition", Hot);
    /// GᵀG ξ of G: ξ ↦ ξ_Q(q).
    OrbitMetric = unlisted("metric of the orbit", Cold);
    /// Σξ.
    Inertia = listed("inertia", Hot).by(MechanicsAndSymmetry);
    /// T(ξ).
    KineticEnergy = listed("kinetic energy", Cold);
    /// ℓ(ξ), which is not quadratic.
    Lagrangian = listed("Lagrangian", Cold);
    /// ∂ℓ/∂ξ.
    LagrangianGradient = unlisted("momentum", Cold);
    /// ∂²ℓ/∂ξ².
    LagrangianHessian = unlisted("Hessian of the Lagrangian", Cold);
    /// A of a kinetic energy ½ ξ·Σξ + A·ξ.
    Gyroscopic = unlisted("slope of the kinetic energy", Hot);
    /// V(q).
    PotentialEnergy = listed("potential energy", Hot);
    /// H(q, μ).
    Hamiltonian = listed("Hamiltonian", Cold).by(MechanicsAndSymmetry);
    /// H(q, μ) − V(q).
    KineticEnergyOfMomentum = unlisted("kinetic energy", Cold).by(MechanicsAndSymmetry);
    /// The force in 𝔤*.
    Force = listed("force", Hot);
    /// φ of a constraint φ = 0 on places; computed with its rows.
    Places = listed("constraint", Hot);
    /// A and b of a constraint A ξ = b; computed with Σ⁻¹(μ − A) and A Σ⁻¹Aᵀ.
    Constraint = listed("constraint", Hot);
    /// κ of a push p = Aᵀκ; computed as S and A Σ⁻¹p.
    Multipliers = unlisted("multipliers", Hot);
    /// λ of the motion; computed as S and −d/dt (A ξ − b).
    Reactions = listed("multipliers", Hot);
    /// The coordinates of a motion to φ = 0; computed as φ, A, S and s Σ⁻¹Aᵀ.
    PlaceCorrection = unlisted("correction of a place", Hot);
    /// φ of a joint of a power.
    JointPlaces(joint: usize) = listed("joint", Hot);
    /// Its rows along motions of the later site and of the one before, and −∂φ/∂t.
    Joint(joint: usize) = listed("rows of a joint", Hot);
    /// Its second derivative in time with constant velocities.
    JointBend(joint: usize) = unlisted("bend of a joint", Hot);
    /// U of an edge of a field.
    EdgeEnergy(direction: usize) = listed("energy of an edge", Hot);
    /// −J(q, ∂₁U) and −J(q⁺, ∂₂U).
    EdgeForces(direction: usize) = listed("forces of an edge", Hot).by(ClebschOptimalControl);
    /// Their changes by small motions of both ends.
    EdgeForcesAlong(direction: usize) = unlisted("change of the forces of an edge", Hot);
    /// The group element of an edge.
    EdgeElement = listed("element of an edge", Hot);
    /// Its Cayley coordinates.
    EdgeCoordinates = unlisted("Cayley coordinates of an edge", Hot);
    /// Its logarithm.
    EdgeLogarithm = unlisted("logarithm of an edge", Hot);
    /// The element G of half of an implicit step.
    HalfStep = unlisted("half of a step", Hot).by(LieGroupMethods);
    /// The Cayley coordinates of G².
    HalfStepDoubled = unlisted("Cayley coordinates of an implicit step", Hot);
    /// The logarithm of G².
    HalfStepLogarithm = unlisted("logarithm of an implicit step", Hot);
    /// (1 + Ad*)(T* ∂K(G²) − N), and its change by motions of the midpoint.
    MidpointEquation = listed("midpoint equation", Hot).by(DiscreteMechanics);
    /// C N of an implicit step, a momentum carried along G.
    HalfCarried = unlisted("momentum along half of a step", Hot).by(MechanicsAndSymmetry);
    /// The force at the midpoint, with its change by motions of it.
    MidpointForce = unlisted("force at the midpoint", Hot);
    /// The change of the coordinates of G by a motion of the midpoint.
    HalfStepMotion = unlisted("motion of the midpoint", Hot).by(LieGroupMethods);
    /// −J(q, ∂V) of a site of a field.
    SiteForce = listed("force on a site", Hot).by(ClebschOptimalControl);
    /// Its change by a small motion of the site.
    SiteForceAlong = unlisted("change of the force on a site", Hot);
    /// The force on a site from its potential and from the edges to all neighbours.
    ForceInside = unlisted("force on a site", Hot).by(ClebschOptimalControl);
    /// ξ′ of a site without joints.
    Acceleration = unlisted("acceleration of a site", Hot);
    /// Chart coordinates of a small motion of a site.
    SmallMotion = unlisted("small motion", Hot);
    /// Σ⁻¹μ.
    Mobility = unlisted("velocity of a momentum", Hot);
    /// ψ(q, F).
    DiscreteConstraint = listed("constraint of a step", Cold);
    /// Σξ + A.
    MomentumOfVelocity = unlisted("momentum of a velocity", Hot);
    /// K(h, F).
    DiscreteLagrangian = listed("discrete Lagrangian", Cold);
    /// W(h, q, F), or W(q, ξ).
    VerticalTerm = listed("vertical term", Cold);
    /// U₀(h, q).
    StartPotential = listed("", Cold);
    /// U₁(h, q⁺).
    EndPotential = listed("", Cold);
    /// F⁻ℓd(q, F).
    Legendre = listed("Legendre transform", Cold).by(DiscreteMechanics);
    /// F⁺ℓd(q, F).
    LegendreNext = listed("next Legendre transform", Cold).by(DiscreteMechanics);
    /// A term of the potential of a power.
    Term(term: usize) = listed("term", Hot);
    /// Its gradient at a place that it reads.
    TermGradient(term: usize, place: usize) = listed("gradient of a term", Hot);
    /// The motion of a steered configuration.
    Controls = listed("controls", Hot);
    /// The price of a step.
    Price = listed("price", Hot);
    /// The bounds of inputs.
    Bounds = listed("bounds", Hot);
    /// The prices of soft bounds.
    BoundPrices = listed("prices of soft bounds", Hot);
    /// The price of the end.
    PriceOfEnd = listed("price of the end", Hot);
    /// The equations of the end.
    TargetEquations = listed("target", Hot);
    /// The inequalities of the end.
    TargetInequalities = listed("target, inequalities", Hot);
    /// A momentum that no step changes.
    Conserved(momentum: usize) = listed("conserved", Cold);
    /// All of these.
    ConservedMomenta = unlisted("conserved", Cold);
    /// M − N, the kick before the solve.
    StartKick(substep: usize) = listed("kick", Hot).by(ClebschOptimalControl);
    /// The part of that kick that the cost gives at F = I.
    RestKick(substep: usize) = unlisted("kick", Hot).by(ClebschOptimalControl);
    /// The same kick of the covector.
    StartGradient(substep: usize) = unlisted("kick of the covector", Hot).by(ClebschOptimalControl);
    /// The impulse of the force before the solve.
    StartForce(substep: usize) = unlisted("impulse of the force", Hot);
    /// The part of it that depends on the velocity.
    MovingForce(substep: usize) = unlisted("impulse of the force", Hot);
    /// The force of the constraint, Aᵀλ.
    Reaction(substep: usize) = listed("force of the constraint", Hot);
    /// Aᵀμ after the move, which brings the momentum to the constraint.
    Projection(substep: usize) = listed("projection", Hot);
    /// The impulse of the force after the move.
    EndForce(substep: usize) = unlisted("impulse of the force", Hot);
    /// ρ(x) = 0.
    Equation(substep: usize, equation: usize) = listed("equation", Hot).by(LieGroupMethods);
    /// Dρ(x)·δ.
    Jacobian(substep: usize, equation: usize) = listed("Jacobian", Hot).by(LieGroupMethods);
    /// B(x) with Dρ(x)·δ = ⟨δ^·B, E⟩.
    JacobianFactor(substep: usize, equation: usize) = unlisted("factor of the Jacobian", Hot);
    /// f(κ) = 0, the scalar equation of a rotating body.
    ScalarEquation(substep: usize, equation: usize) = listed("scalar equation", Hot);
    /// x(μ).
    Solution(substep: usize, equation: usize) = listed("solution", Hot);
    /// x(μ) to first order in h, component by component: the start of iterations.
    Predictor(substep: usize, equation: usize) = unlisted("predictor", Hot);
    /// M⁺.
    MomentumUpdate(substep: usize) = listed("momentum update", Hot).by(ClebschOptimalControl);
    /// The same with F = I + D.
    MomentumAfter(substep: usize) = unlisted("momentum update", Hot).by(ClebschOptimalControl);
    /// N⁺ − M⁺, the kick after the move.
    EndKick(substep: usize) = listed("kick", Hot).by(ClebschOptimalControl);
    /// The same kick of the covector.
    EndGradient(substep: usize) = unlisted("kick of the covector", Hot).by(ClebschOptimalControl);
    /// The kick of the covector by a cost that couples.
    CoupledGradient(substep: usize) = unlisted("kick of the covector", Hot).by(ClebschOptimalControl);
    /// By how much the momentum of a step of first order is ahead.
    SynchronizedMomentum = listed("synchronized momentum", Hot);
    /// The kick of a splitting, with its weights.
    SplittingKick = listed("kick", Hot).by(ClebschOptimalControl);
    /// The same kick of the covector.
    SplittingGradient = unlisted("kick of the covector", Hot).by(ClebschOptimalControl);
    /// The monitor that sets the times of steps.
    Monitor = listed("monitor", Hot);
    /// The kick of a step whose time follows it.
    MonitoredKick = listed("kick", Hot).by(ClebschOptimalControl);
    /// Its slope along motions by a momentum.
    MonitorSlope = listed("slope of the monitor", Hot);
    /// F − I in the chart.
    Increment = unlisted("increment", Hot).by(LieGroupMethods);
    /// D and c of F − I = c·D in the chart.
    ScaledIncrement = unlisted("increment", Hot).by(LieGroupMethods);
    /// q⁺ with F = I + D.
    Advance = unlisted("action", Hot).by(ClebschOptimalControl);
    /// q⁺ with F = I + c·D.
    ScaledAdvance = unlisted("action", Hot).by(ClebschOptimalControl);
    /// q⁺ by the chart coordinates alone.
    Displacement = unlisted("action", Hot).by(ClebschOptimalControl);
    /// The cotangent lift with F = I + D.
    Lift = unlisted("cotangent lift", Cold).by(ClebschOptimalControl);
    /// The equations that a step of order 16 collocates.
    HamiltonEquations = listed("Hamilton's equations", Hot).by(MechanicsAndSymmetry);
    /// The start of its sweeps.
    Guess = unlisted("predictor", Hot);
    // the following ids have kernels, and no row in a table
    /// The values that a stepper computes once.
    Constants = unlisted("", Hot);
    /// The coefficients of ξ_i ξ_j, i ≤ j, in the kinetic energy.
    EnergyCoefficients = unlisted("", Hot);
    /// The matrix of ξ ↦ ξ_Q(q), or the projection of μ to the momenta of motions, where motions that fix q are not free.
    Isotropy = unlisted("", Hot);
    /// J(q, p) as a step computes it that maps covectors.
    MomentumOfStep = unlisted("", Hot);
    /// The numbers of the time alone that the slopes of a step of order 16 take.
    TermsOfTime = unlisted("", Hot);
    /// A covector p at q with J(q, p) = μ.
    Covector = unlisted("", Hot);
    /// The gradient of a term at all places that it reads.
    TermGradients(term: usize) = unlisted("", Hot);
    /// The part of the gradient that every site has.
    SiteGradient = unlisted("", Hot);
    /// ℓd, F⁻ℓd, F⁺ℓd, ∂F⁻ℓd/∂η, ∂F⁻ℓd/∂η′, ∂F⁺ℓd/∂η′, and ∂F⁺ℓd/∂η where it is not −(∂F⁻ℓd/∂η′)ᵀ. These are matrices,
    /// or their products with one motion.
    Edge(substep: usize) = unlisted("", Hot);
    /// ℓd, F⁻ℓd, F⁺ℓd.
    EdgeMomenta(substep: usize) = unlisted("", Hot);
    /// F⁺ℓd; Ad, ∂F⁻ℓd and ∂F⁺ℓd for motions that leave F as it is; ∂F⁻ℓd/∂η′, ∂F⁺ℓd/∂η′.
    Carried(substep: usize) = unlisted("", Hot);
    /// The derivatives of F⁻ℓd and of F⁺ℓd with respect to the quantities that are fixed during a step.
    EdgeSlopes(substep: usize) = unlisted("", Hot);
    /// A and A Σ⁻¹ at q; ∂(Aᵀκ) and ∂ψ for motions that leave F as it is; ∂ψ/∂η′.
    ConstraintAtStart(substep: usize) = unlisted("", Hot);
    /// A and A Σ⁻¹ at q⁺; ∂(Aᵀκ)/∂η′ and ∂(A Σ⁻¹N⁺ − b)/∂η′.
    ConstraintAtEnd(substep: usize) = unlisted("", Hot);
    /// The derivatives of Aᵀκ and of ψ with respect to the quantities that are fixed during a step.
    SlopesAtStart(substep: usize) = unlisted("", Hot);
    /// The same of Aᵀκ and of A Σ⁻¹N⁺ − b at q⁺.
    SlopesAtEnd(substep: usize) = unlisted("", Hot);
    /// J(q, q⁺ − q).
    Approach = unlisted("", Hot);
    /// A, B, ℓ, ∂ℓ/∂η, ∂ℓ/∂u and the second derivatives of ℓ + λ·η′.
    StepExpanded = unlisted("", Hot);
    /// ∂F⁻ℓd/∂u and ∂F⁺ℓd/∂u.
    ByInput = unlisted("", Hot);
    /// The second derivatives of β·F⁺ℓd + κ·F⁻ℓd along the motions that leave F as it is, those of q⁺ alone, and the inputs.
    Bend = unlisted("", Hot);
    /// The derivatives along the motions of both ends of the slopes with respect to the multipliers of a constraint and to N⁺.
    Crossed = unlisted("", Hot);
    /// ± ½ μ·[E_i, E_j].
    Bracket = unlisted("", Hot);
    /// Where forces take the inputs: ℓ, ∂ℓ/∂η, ∂ℓ/∂u and the second derivatives.
    PriceExpanded = unlisted("", Hot);
    /// The derivatives of price and step with respect to h and t.
    PriceOfTime = unlisted("", Hot);
    /// a, ∂a/∂η, ∂a/∂u and the second derivatives of z·a.
    BoundsExpanded = unlisted("", Hot);
    /// φ, ∂φ/∂t, ∂φ/∂η, ∂²φ/∂η².
    PriceOfEndExpanded = unlisted("", Hot);
    /// Both sides of the conditions of the end, ∂g/∂t, ∂g/∂η and ∂²(z·g)/∂η².
    TargetExpanded = unlisted("", Hot);
    /// |a|² of a closed form, which has to be below one.
    SineSquared(substep: usize, equation: usize) = unlisted("", Hot);
    /// x(μ) by the rotation in a plane.
    ClosedForm(substep: usize, equation: usize) = unlisted("", Hot);
    /// x(μ), coordinate after coordinate.
    Explicit(substep: usize, equation: usize) = unlisted("", Hot);
    /// −ρ(0) and Dρ of a linear equation.
    System(substep: usize, equation: usize) = unlisted("", Hot);
    /// The terms that an iteration computes once.
    Preparation(substep: usize, equation: usize) = unlisted("", Hot);
    /// ρ(x) alone, where x ← x − s·h·Σ⁻¹ρ(x) is tried before Newton's method.
    Residual(substep: usize, equation: usize) = unlisted("", Hot);
    /// ρ(x) and Dρ(x).
    Linearization(substep: usize, equation: usize) = unlisted("", Hot);
}
