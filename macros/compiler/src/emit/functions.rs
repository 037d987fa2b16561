//! The functions of each trait in generated code, with the kernels that they compute and the formulas that they show.
//!
//! Some names in signatures are words that each system replaces: `X` by the type of chart coordinates, `U` by that of
//! inputs. `Receiver` is `&self`, or the system where a method of it is stepped.
//! [`SystemEmitter::functions`](super::SystemEmitter::functions) puts in their tokens. Code behind `=` has more such
//! words. `Locals` are the shared terms of the kernel. `Value0` is its first output as a vector or a matrix, and
//! `Number0` the same as a scalar.

use super::function::Function;
use crate::derive::Id;
use clebsch_symbolic::IntoList;

macro_rules! kernel {
    ($kernel:expr $(=> $($shown:expr),*)?) => {
        $kernel
    };
}

macro_rules! shown {
    ($kernel:expr) => { &[$kernel] };
    ($kernel:expr => $($shown:expr),*) => { &[$($shown),*] };
}

// a function without a list of formulas shows the one that it computes
macro_rules! functions {
    ($(
        #[doc = $about:literal]
        $table:ident($is_inline:literal) {
            $(
                $(#[doc = $title:literal])*
                fn $name:ident $arguments:tt -> $result:ty { $($ids:tt)* } $(= { $($code:tt)* })?
            )*
        }
    )*) => {
        $(
            #[doc = $about]
            pub(super) const $table: &[Function] = &[$(Function {
                name: stringify!($name),
                title: concat!($($title, "\n"),*).trim_ascii(),
                kernel: kernel!($($ids)*),
                shown: shown!($($ids)*),
                arguments: stringify!($arguments),
                result: stringify!($result),
                is_inline: $is_inline,
                code: stringify!($($($code)*)?),
            }),*];
        )*

        const ALL: &[&[Function]] = &[$($table),*];
    };
}

/// Whether a function that is handed the constants computes this kernel.
pub(super) fn takes_constants(kernel: Id) -> bool {
    let takes = |function: &Function| function.kernel.is_like(kernel) && function.arguments.contains("c: &C");
    ALL.iter().copied().flatten().any(takes)
}

functions! {
    /// `Clebsch`, and those of `Method` among them, which are told the system.
    SYSTEM(false) {
        /// Checks the parameters and computes the constants.
        fn constants(Receiver, h: T) -> Result<Self::Constants, Error> { Id::Constants }
        /// The action.
        fn act(&self, f: &F, q: &Q) -> Q { Id::Action }
        /// The momentum map of the cotangent lift, ⟨A, E⟩ standing for the components tr(AᵀE_i).
        fn momentum_map(&self, q: &Q, p: &Q) -> Mu { Id::MomentumMap }
        /// The coadjoint action.
        fn coadjoint(&self, f: &F, mu: &Mu) -> Mu { Id::Coadjoint }
        /// The discrete Legendre transform: the momentum N before the step that moves q by F.
        fn legendre(Receiver, h: T, t: T, q: &Q, f: &F) -> Mu { Id::Legendre }
        /// The discrete Legendre transform: the momentum N⁺ after the step that moves q by F.
        fn legendre_next(Receiver, h: T, t: T, q: &Q, f: &F) -> Mu { Id::LegendreNext }
        /// Whether the kinetic energy is positive here.
        fn check_kinetic_energy(&self, t: T, q: &Q) -> Result<(), Error> { Id::Inertia }
        /// The representing matrices M = Σ G^{ij} μ_j E_i of a momentum.
        fn momentum_matrix(mu: &Mu) -> F { Id::MomentumMatrix => }
        /// The components μ_i = tr(MᵀE_i) of a momentum.
        fn momentum_components(m: &F) -> Mu { Id::MomentumComponents => }
        /// By how much the momentum N of a state is ahead of the momentum π at its configuration.
        fn stagger(Receiver, h: T, t: T, q: &Q) -> Mu { Id::SynchronizedMomentum }
        /// The potential energy.
        fn potential(&self, t: T, q: &Q) -> T { Id::PotentialEnergy }
        /// The kinetic energy.
        fn kinetic_energy(Receiver, c: &C, t: T, q: &Q, mu: &Mu) -> T { Id::KineticEnergyOfMomentum }
        fn orbit_defect(&self, q: &Q) -> T { Id::Membership }
        fn isotropy_defect(&self, q: &Q, mu: &Mu) -> T { Id::Isotropy }
        fn project_momentum(&self, q: &Q, mu: &Mu) -> Mu { Id::Isotropy }
        /// Whether a configuration obeys the constraint.
        fn check_place(&self, t: T, q: &Q) -> Result<(), Error> { Id::Places } = {
            Locals
            runtime::check_place(&Value0, &Matrix1, q)
        }
        /// By how much the velocity of a momentum violates the constraint.
        fn constraint_defect(Receiver, c: &C, t: T, q: &Q, mu: &Mu) -> Result<runtime::Violation<T>, Error> { Id::Constraint } = {
            Locals
            runtime::violation(mu, &Matrix0, &Value2, &Value1, &Matrix3)
        }
        /// The momentum whose velocity obeys the constraint, next to a momentum.
        fn constrained(Receiver, c: &C, t: T, q: &Q, mu: &Mu) -> Result<Mu, Error> { Id::Constraint => } = {
            Locals
            runtime::constrained(mu, &Matrix0, &Value2, &Value1, &Matrix3)
        }
        /// The configuration that obeys the constraint, next to a configuration.
        fn placed(Receiver, c: &C, t: T, q: &Q) -> Result<Q, Error> { Id::PlaceCorrection } = {
            runtime::placed(
                System, q,
                |q| { Locals runtime::Correction { places: Value0, rows: Matrix1, metric: Matrix2, moved: Matrix3 } },
                |x| PartsOf::element(&PartsOf::increment(System, x)),
            )
        }
    }

    /// `Constrained`.
    CONSTRAINED(false) {
        /// The momentum of a velocity.
        fn momentum_of_velocity(&self, t: T, q: &Q, x: &Mu) -> Mu { Id::MomentumOfVelocity }
    }

    /// `Reacting`.
    REACTING(false) {
        /// The multipliers κ of a push p = Aᵀκ.
        fn multipliers(&self, c: &C, t: T, q: &Q, mu: &Mu) -> Self::Reactions { Id::Multipliers } = {
            Locals
            runtime::multipliers(&Matrix0, &Value1)
        }
        /// The multipliers λ of the motion.
        fn reactions_of_motion(&self, c: &C, t: T, q: &Q, mu: &Mu, u: &U) -> Result<Self::Reactions, Error> { Id::Reactions } = {
            Locals
            runtime::reactions(&Matrix0, &Value1)
        }
    }

    /// `Conserves`.
    CONSERVES(false) {
        /// The momenta that no step changes.
        fn conserved(&self, q: &Q, mu: &Mu) -> Self::Conserved { Id::ConservedMomenta => Id::Conserved(0) }
    }

    /// `Power`: all sites together.
    SITES(false) {
        /// The potential energy, a sum over sites.
        fn potential_of_sites(&self, t: T, q: &Sites) -> T { Id::Term(0) }
    }

    /// `Joined`: the joints of neighbouring sites.
    JOINED(true) {
        /// The values of the equations whose later site is this one.
        fn places_at(&self, t: T, q: &Sites, site: Index) -> Places { Id::JointPlaces(0) }
        /// The rows of the equations whose later site is this one.
        fn rows_at(&self, t: T, q: &Sites, site: Index) -> Rows { Id::Joint(0) }
        /// The second derivatives in time of these equations with the constant velocities x of the site and mu of the one before.
        fn bend_at(&self, t: T, q: &Sites, site: Index, x: &Mu, mu: &Mu) -> Places { Id::JointBend(0) }
    }

    /// `Joined`: the joints that close loops.
    LOOPS(false) {
        /// The rows of the equations that close loops.
        fn loop_rows(&self, t: T, q: &Sites, loops: &mut LoopRows) -> () { Id::Joint(0) }
        /// The values of the equations that close loops.
        fn loop_places(&self, t: T, q: &Sites, loops: &mut LoopRows) -> () { Id::JointPlaces(0) }
        /// The second derivatives in time of these equations with constant velocities of all sites.
        fn loop_bends(&self, t: T, q: &Sites, velocities: &Velocities, loops: &mut LoopRows) -> () { Id::JointBend(0) }
    }

    /// `Mobile`: a site whose velocity follows from its momentum.
    MOBILE(true) {
        /// The velocity of a momentum, less that of the momentum 0.
        fn mobility(c: &C, mu: &Mu) -> Mu { Id::Mobility }
        /// The momentum of velocity zero.
        fn momentum_at_rest(&self, t: T, q: &Q) -> Option<Mu> { Id::Gyroscopic }
        /// The momentum of a velocity.
        fn momentum_of_velocity(&self, t: T, q: &Q, x: &Mu) -> Mu { Id::MomentumOfVelocity }
        /// The change of the velocity where no joint and no other site acts.
        fn acceleration(&self, c: &C, t: T, q: &Q, mu: &Mu, u: &U) -> Mu { Id::Acceleration }
        /// The configuration after a small motion.
        fn moved_by(&self, q: &Q, x: &Mu) -> Q { Id::SmallMotion } = {
            let x = { Locals Value0 };
            runtime::Clebsch::act(self, &PartsOf::element(&PartsOf::increment(self, &x)), q)
        }
    }

    /// `FieldSite`: the force on a site by itself, and its motion.
    FIELD_SITE(true) {
        /// The force of the potential on a site.
        fn force_on_site(&self, t: T, q: &Q) -> Mu { Id::SiteForce }
        /// The change of this force by a small motion of the site.
        fn force_on_site_along(&self, t: T, q: &Q, motion: &Mu) -> Mu { Id::SiteForceAlong }
        /// The momentum of a velocity.
        fn momentum_of_velocity(&self, t: T, q: &Q, x: &Mu) -> Mu { Id::MomentumOfVelocity }
        /// The configuration after a small motion.
        fn moved_by(&self, q: &Q, x: &Mu) -> Q { Id::SmallMotion } = {
            let x = { Locals Value0 };
            runtime::Clebsch::act(self, &PartsOf::element(&PartsOf::increment(self, &x)), q)
        }
    }

    /// `Field`: the energies of edges, and the forces on sites.
    FIELD(true) {
        /// The energy of an edge in a direction.
        fn edge_energy(&self, direction: Index, spacing: &Spacings, q: &Q, next: &Q) -> T { Id::EdgeEnergy(0) }
        /// The forces of an edge in a direction on its site and on the neighbour.
        fn edge_forces(&self, direction: Index, spacing: &Spacings, q: &Q, next: &Q) -> (Mu, Mu) { Id::EdgeForces(0) }
        /// The change of these forces by a small motion of the site and one of the neighbour.
        fn edge_forces_along(&self, direction: Index, spacing: &Spacings, q: &Q, next: &Q, motion: &Mu, next_motion: &Mu) -> (Mu, Mu) { Id::EdgeForcesAlong(0) }
        /// The force on a site that has neighbours on both sides in each direction, of its potential and of all edges.
        fn force_inside(&self, t: T, spacing: &Spacings, q: &Q, before: &Neighbours, after: &Neighbours) -> Mu { Id::ForceInside => }
    }

    /// `ConnectedField`: the elements of edges.
    CONNECTION(true) {
        /// The element that moves a site to its neighbour.
        fn edge_element(&self, q: &Q, next: &Q) -> F { Id::EdgeElement }
    }

    /// `MidpointSite`: implicit steps.
    MIDPOINT(true) {
        /// The element G of half of a step by its Cayley coordinates.
        fn half_step(x: &Mu) -> F { Id::HalfStep }
        /// The change of these coordinates by a motion of the midpoint.
        fn half_step_motion(x: &Mu, motion: &Mu) -> Mu { Id::HalfStepMotion }
        /// The left side of the equation of a step, and its derivatives by motions of the midpoint.
        fn midpoint_equation(&self, h: T, t: T, f: &F, mu: &Mu) -> (Mu, Square) { Id::MidpointEquation } = {
            Doubled Locals (Value0, Matrix1)
        }
        /// The declared force at the midpoint, and its derivatives by motions of it.
        fn midpoint_force(&self, h: T, t: T, q: &Q, x: &Mu, u: &U) -> Option<(Mu, Square)> { Id::MidpointForce } = {
            Locals runtime::Some((Value0, Matrix1))
        }
        /// The momentum carried along half of a step.
        fn half_carried(f: &F, mu: &Mu) -> Mu { Id::HalfCarried }
    }

    /// `VelocityEquation`, of a Lagrangian that is not quadratic.
    VELOCITY(false) {
        /// The Lagrangian of a velocity, its gradient and its Hessian.
        fn linearize(&self, x: &Algebra) -> (T, Algebra, Square) { Id::Lagrangian } = {
            let (t, q) = (self.t, self.q); Locals (Number0, Value1, Value2)
        }
    }

    /// `Parts`: the moves of a step.
    PARTS(true) {
        /// D = F − I of the group element with chart coordinates x (for translations F itself), without cancellation.
        fn increment(&self, Coordinates: &X) -> F { Id::Increment }
        fn element(d: &F) -> F { Id::Increment }
        fn motion(&self, x: &X, increment: impl ::core::ops::FnOnce() -> F) -> Motion { Id::Increment }
        /// D and c of F = I + c·D, the division in c apart.
        fn motion(&self, Coordinates: &X, increment: impl ::core::ops::FnOnce() -> F) -> Motion { Id::ScaledIncrement }
        /// The configuration that F = I + D moves q to.
        fn advance(&self, q: &Q, Moved: &Motion) -> Q { Id::Advance }
        /// The configuration that F = I + c·D moves q to.
        fn advance(&self, q: &Q, Moved: &Motion) -> Q { Id::ScaledAdvance }
        /// q⁺ = q + α ξ_Q(q) + β ξ_Q(ξ_Q(q)) at ξ = x where F = I + α x^ + β (x^)², without the matrix.
        fn advance(&self, q: &Q, Moved: &Motion) -> Q { Id::Displacement }
        /// The covector p carried along by F = I + D, at q⁺.
        fn lift(&self, q: &Q, p: &Q, d: &F) -> Q { Id::Lift }
        fn on_space(q: Q, rest: Rest) -> (Q, Rest) { Id::Advance => }
    }

    /// `Substep`: kicks, forces, gradients, the solve and the update. The trait provides those that a declaration lacks.
    SUBSTEP(true) {
        /// The kick at the start of a step.
        fn start_kick(&self, c: &C, t: T, q: &Q) -> Option<Mu> { Id::StartKick(0) }
        /// The kick at the end of a step.
        fn end_kick(&self, c: &C, t: T, q: &Q) -> Option<Mu> { Id::EndKick(0) }
        /// The value of the cost at F = I, with the other sign.
        fn rest(&self, c: &C, t: T, q: &Q) -> Option<Mu> { Id::RestKick(0) }
        /// The impulse of the force at the start of a step.
        fn start_force(&self, c: &C, t: T, q: &Q, u: &U) -> Option<Mu> { Id::StartForce(0) => Id::Force }
        /// The part of the impulse at the start of a step that depends on the velocity.
        fn moving_force(&self, c: &C, t: T, q: &Q, x: &X, u: &U) -> Option<Mu> { Id::MovingForce(0) => Id::Force }
        /// The force of the constraint, from the momentum that was solved for.
        fn reaction(&self, c: &C, t: T, q: &Q, mu: &Mu, x: &X, u: &U) -> Option<Mu> { Id::Reaction(0) }
        /// The change of the momentum after the move that brings it to the constraint at q⁺.
        fn projection(&self, c: &C, t: T, q: &Q, mu: &Mu) -> Option<Mu> { Id::Projection(0) }
        /// The impulse of the force at the end of a step.
        fn end_force(&self, c: &C, t: T, q: &Q, x: &X, u: &U) -> Option<Mu> { Id::EndForce(0) => Id::Force }
        /// ∂U₀(q), the kick of the covector at the start of a step.
        fn start_gradient(&self, c: &C, t: T, q: &Q) -> Option<Q> { Id::StartGradient(0) }
        /// ∂U₁(q), the kick of the covector at the end of a step.
        fn end_gradient(&self, c: &C, t: T, q: &Q) -> Option<Q> { Id::EndGradient(0) }
        /// ∂_q K(q, F), the kick of the covector by a cost that couples, F = I + D.
        fn coupled_gradient(&self, c: &C, t: T, q: &Q, d: &F) -> Option<Q> { Id::CoupledGradient(0) }
        fn solve(&self, c: &C, t: T, q: &Q, mu: &Mu, u: &U) -> Solved<X> { Id::Solution(0, 0) }
        /// The momentum after the move, F = I + D.
        fn update(&self, c: &C, t: T, q: &Q, mu: &Mu, Increment: &Motion) -> Option<Mu> { Id::MomentumAfter(0) }
    }

    /// `GreatCircles`: points on large spheres.
    GREAT_CIRCLES(true) {
        fn turn(c: &C) -> T { Id::Constants } = { c.step_size * c.inertia_inverse }
    }

    /// `FreeMotion`: several steps along one motion.
    FREE_MOTION(true) {
        /// The constants of the free motions with this momentum.
        fn kept(&self, c: &C, mu: &Mu) -> Self::Kept { Id::Constants }
        /// The coordinates of these motions.
        fn follow(&self, c: &C, kept: &Self::Kept, mu: &Mu) -> Result<(X, Mu), Error> { Id::Constants }
    }

    /// `SplitKicks`: the kicks of a splitting.
    SPLIT_KICKS(true) {
        fn step_size(c: &C) -> T { Id::Constants } = { c.step_size }
        /// A kick.
        fn kick(&self, c: &C, t: T, q: &Q, weight: T, gradient: T) -> Mu { Id::SplittingKick }
        /// The same for the covector.
        fn kick_gradient(&self, c: &C, t: T, q: &Q, weight: T, gradient: T) -> Q { Id::SplittingGradient }
    }

    /// `TimeTransformed`: the monitor that sets the times of steps.
    TIME_TRANSFORMED(true) {
        fn step_size(c: &C) -> T { Id::Constants } = { c.step_size }
        /// The monitor g: dt = g ds.
        fn monitor(&self, c: &C, q: &Q) -> T { Id::Monitor }
        /// The kick of a step, which is that of the time h g.
        fn monitored_kick(&self, c: &C, t: T, q: &Q) -> Mu { Id::MonitoredKick }
        /// The slope γ of the monitor: γ·μ = h ġ/g with the velocity of the momentum μ.
        fn monitor_slope(&self, c: &C, q: &Q) -> Mu { Id::MonitorSlope }
    }

    /// `HamiltonEquations`: the equations that a step of order 16 collocates.
    HAMILTON_EQUATIONS(true) {
        fn step_size(c: &C) -> T { Id::Constants } = { c.step_size }
        /// The numbers of the time alone that slopes take.
        fn terms_of_time(&self, c: &C, t: T) -> Times { Id::TermsOfTime } = { Locals Found }
        /// Hamilton's equations: (q′, p′) at y = (q, p), all entries of q and then those of p, rows first.
        fn slope(&self, c: &C, t: T, terms: &Times, y: &Numbers) -> Numbers { Id::HamiltonEquations } = {
            let (q, p) = <Self as Equations>::parted(y); Locals Slopes
        }
        /// A covector p at q with the momentum J(q, p) = μ.
        fn covector(&self, c: &C, q: &Q, mu: &Mu) -> Q { Id::Covector }
        /// J(q, p), entry by entry.
        fn momentum(&self, q: &Q, p: &Q) -> Mu { Id::MomentumOfStep }
        /// The chart coordinates x of the motion by the velocity ξ = Σ⁻¹(μ − A) for the time h, to first order in h.
        fn guess(&self, c: &C, t: T, q: &Q, mu: &Mu) -> Mu { Id::Guess => }
        fn part(x: &Mu, part: T) -> X { Id::Guess } = { *x * part }
        fn part(x: &Mu, part: T) -> X { Id::Guess } = { (*x * part, Weights) }
        fn joined(q: &Q, p: &Q) -> Numbers { Id::HamiltonEquations } = { Joined }
        fn parted(y: &Numbers) -> (Q, Q) { Id::HamiltonEquations } = { Parted }
    }

    /// The types of momentum equations: of a vector of momenta, and of another of unknowns.
    EQUATION(true) {
        /// The solution: the rotation by θ in one plane with sin θ = |a|, |a|² < 1.
        fn closed_form(&self, mu: &Momenta) -> Solved<Vector> { Id::ClosedForm(0, 0) => Id::Solution(0, 0), Id::Predictor(0, 0) } = {
            let x = { Locals Value0 };
            runtime::below_right_angle(x, { ByReference SineSquared })
        }
        /// The solution with the multipliers of a constraint: the rotation by θ in one plane with sin θ = |a|, |a|² < 1.
        fn constrained_form(&self, mu: &Momenta) -> Solved<Vector> { Id::ClosedForm(0, 0) => Id::Solution(0, 0) } = {
            let x = { Locals Value0 };
            runtime::below_right_angle_from(x, |x| { SineSquared }, |mu| self.closed_form_or_nan(mu))
        }
        /// The same without a branch. Where there is none, the root of 1 − |a|² is NaN.
        fn closed_form_or_nan(&self, mu: &Momenta) -> Vector { Id::ClosedForm(0, 0) => } = { Locals Value0 }
        /// The solution, coordinate after coordinate.
        fn explicit(&self, mu: &Momenta Given) -> Vector { Id::Explicit(0, 0) => Id::Solution(0, 0), Id::Predictor(0, 0) }
        /// Dρ and −ρ(0).
        fn system(&self, mu: &Momenta) -> (Square, Vector) { Id::System(0, 0) => Id::Jacobian(0, 0) }
        fn prepare(&self, mu: &Momenta) -> Self::Terms { Id::Preparation(0, 0) => }
        /// The solution to first order in h.
        fn predict(&self, mu: &Momenta) -> Vector { Id::Predictor(0, 0) }
        /// The residual alone.
        fn residual(&self, Prepared, x: &Vector) -> Vector { Id::Residual(0, 0) => Id::Equation(0, 0) }
        /// The residual and its Jacobian.
        fn linearize(&self, Prepared, x: &Vector) -> (Vector, Self::Jacobian) {
            Id::Linearization(0, 0) => Id::Equation(0, 0), Id::Jacobian(0, 0)
        }
        /// The residual and its Jacobian.
        fn linearize(&self, Prepared, x: &Vector) -> (Vector, Self::Jacobian) {
            Id::Linearization(0, 0) => Id::Equation(0, 0), Id::Jacobian(0, 0), Id::JacobianFactor(0, 0)
        }
    }

    /// The methods of an equation that solvers call, other than its residual.
    SOLVER(true) {
        /// Dρ is symmetric: LDLᵀ where it is definite.
        fn correct(a: &Square, b: &Vector) -> Option<(Vector, Orientation)> { Id::Equation(0, 0) => } = {
            runtime::solve_symmetric(a, b)
        }
        /// Dρ is block triangular: one small system for each block.
        fn correct(a: &Square, b: &Vector) -> Option<(Vector, Orientation)> { Id::Equation(0, 0) => }
        fn orientation(&self) -> Option<Orientation> { Id::Constants }
        /// The constants.
        fn body(&self) -> Body { Id::Equation(0, 0) => Id::ScalarEquation(0, 0), Id::Solution(0, 0) }
        fn has_poles() -> Bool { Id::Equation(0, 0) } = { true }
        /// 1 + |q|: the constraint is known to the rounding of places.
        fn extent(&self) -> T { Id::Equation(0, 0) => }
        /// The declared tolerance.
        fn tolerance() -> T { Id::Equation(0, 0) => }
        /// The declared number of iterations.
        fn limit() -> Option<u32> { Id::Equation(0, 0) => }
    }

    /// `Variational`: motions of configurations.
    VARIATIONAL(true) {
        /// The increments τ(η) − I and τ(−η) − I of a small motion.
        fn retractions(&self, eta: &Self::Momentum) -> [Self::Element; 2] { Id::Retraction }
        /// The increment of the motion by I + d and after it by I + second.
        fn compose(&self, d: &Self::Element, second: &Self::Element) -> Self::Element { Id::Composition }
        /// The configuration that F = I + D moves q to.
        fn advance(&self, q: &Self::Configuration, d: &Self::Element) -> Self::Configuration { Id::Advance }
        /// The infinitesimal motion ξ_Q(q).
        fn infinitesimal_motion(&self, q: &Self::Configuration, x: &Self::Momentum) -> Self::Configuration { Id::Generator }
        /// GᵀG of the infinitesimal motion G: ξ ↦ ξ_Q(q).
        fn orbit_metric(&self, q: &Self::Configuration) -> Square { Id::OrbitMetric }
        /// J(q, target − q).
        fn approach(&self, q: &Self::Configuration, target: &Self::Configuration) -> Self::Momentum { Id::Approach => }
        /// The price of the end with its derivatives.
        fn endpoint(&self, t: T, q: &Self::Configuration) -> EndpointExpansion { Id::PriceOfEndExpanded => }
    }

    /// `VariedSubstep`: an edge, with its derivatives.
    EDGE(true) {
        /// ℓd with both Legendre transforms.
        fn momenta(&self, c: &C, t: T, (q, d, next, u): Ends) -> Momenta { Id::EdgeMomenta(0) } = {
            Locals
            runtime::Momenta { lagrangian: Number0, before: Value1, after: Value2 }
        }
        /// ℓd with both Legendre transforms and their derivatives along the motions of both ends.
        fn edge(&self, c: &C, t: T, (q, d, next, u): Ends) -> Edge { Id::Edge(0) } = {
            Locals
            let before_by_end = Matrix4;
            runtime::Edge {
                lagrangian: Number0, before: Value1, after: Value2,
                before_by_start: Matrix3, before_by_end, after_by_start: Matrix6, after_by_end: Matrix5,
            }
        }
        /// F⁺ℓd with the derivatives of both momenta, along motions that leave F as it is and along those of q⁺ alone.
        fn carried(&self, c: &C, t: T, (q, d, next, u): Ends) -> Carried { Id::Carried(0) } = {
            Locals
            runtime::Carried {
                momentum: Value0,
                adjoint: Matrix1, before: Matrix2, after: Matrix3, before_by_end: Matrix4, after_by_end: Matrix5,
            }
        }
        /// ∂F⁻ℓd and ∂F⁺ℓd with respect to the quantities that are fixed during a step.
        fn slopes(&self, c: &C, t: T, (q, d, next, u): Ends) -> Slopes { Id::EdgeSlopes(0) } = { Locals (Value0, Value1) }
        fn passed(&self, c: &C, t: T, ends: Ends, mu: &Mu, edge: Carried) -> Option<PassedEdge> { Id::ConstraintAtStart(0) => } = {
            runtime::with_constraint::<Self, Sizes>(self, (c, t), ends, mu, &edge)
        }
        fn slopes_passed(&self, c: &C, t: T, ends: Ends, mu: &Mu) -> Option<Slopes> { Id::SlopesAtStart(0) => } = {
            let slopes = <Self as Varied>::slopes(self, c, t, ends);
            runtime::slopes_with_constraint::<Self, Sizes>(self, (c, t), ends, mu, slopes)
        }
    }

    /// `ConstrainedSubstep`: the constraint of an edge, with its derivatives.
    CONSTRAINED_EDGE(true) {
        fn end(c: &C, t: T) -> T { Id::Constants } = { t + c.step_size }
        /// A and A Σ⁻¹ at q, ∂(Aᵀκ) and ∂ψ along motions that leave F as it is, and ∂ψ/∂η′.
        fn at_start(&self, c: &C, t: T, (q, d, next, u): Ends, kappa: &Multipliers) -> AtStart { Id::ConstraintAtStart(0) } = {
            Locals
            runtime::ConstraintAtStart {
                rows: Matrix0, by_inertia: Matrix1, push: Matrix2, between: Matrix3, between_by_end: Matrix4,
            }
        }
        /// A and A Σ⁻¹ at q⁺, ∂(Aᵀκ)/∂η′ and ∂(A Σ⁻¹N⁺ − b)/∂η′.
        fn at_end(&self, c: &C, t: T, next: &Q, mu: &Mu, kappa: &Multipliers) -> AtEnd { Id::ConstraintAtEnd(0) } = {
            Locals
            runtime::ConstraintAtEnd { rows: Matrix0, by_inertia: Matrix1, push: Matrix2, velocity: Matrix3 }
        }
        /// The derivatives of Aᵀκ and of ψ with respect to the quantities that are fixed during a step.
        fn slopes_at_start(&self, c: &C, t: T, (q, d, next, u): Ends, kappa: &Multipliers) -> Slopes { Id::SlopesAtStart(0) } = {
            Locals (Matrix0, Matrix1)
        }
        /// The same of Aᵀκ and of A Σ⁻¹N⁺ − b at q⁺.
        fn slopes_at_end(&self, c: &C, t: T, next: &Q, mu: &Mu, kappa: &Multipliers) -> Slopes { Id::SlopesAtEnd(0) } = {
            Locals (Matrix0, Matrix1)
        }
    }

    /// `Controlled`: the step that inputs make by themselves, from points and their costates, by its size.
    STEERED(false) {
        fn prepare(&self, h: T) -> Result<Constants, Error> { Id::Constants } = { Checks runtime::Ok(Prepared) }
        fn check_place(&self, q: &Q) -> Result<(), Error> { Id::Membership } = { runtime::check_on_orbit(q, { OrbitDefect }) }
        /// The step that an input makes.
        fn follow(&self, constants: &Constants, t: T, x: &Q, u: &Input) -> Result<Q, Error> { Id::Increment => Id::Controls } = {
            Moved runtime::check_reached(next)
        }
        /// The step with its derivatives, and the second derivatives of ℓ + λ·η′.
        fn expand(&self, constants: &Constants, t: T, x: &Q, u: &Input, mu: &Costates) -> Result<Expansion, Error> { Id::StepExpanded } = {
            Moved
            let next = runtime::check_reached(next)?;
            Locals
            runtime::Ok(runtime::Expansion {
                next, by_place: Value0, by_input: Value1, price: Number2, price_by_place: Value3, price_by_input: Value4,
                place_curvature: Value5, mixed_curvature: Value6, input_curvature: Value7,
            })
        }
        /// d/dh (ℓ + λ·η′), the start of the step moving with h.
        fn price_of_time(&self, constants: &Constants, t: T, k: T, x: &Q, u: &Input, mu: &Costates) -> Result<T, Error> { Id::PriceOfTime } = {
            Moved
            let slopes: runtime::SVector<T, 2> = { Locals Value0 };
            runtime::Ok(slopes[0] + k * slopes[1])
        }
        /// Gᵀ(q* − q) and GᵀG.
        fn arrival(&self, x: &Q, target: &Q) -> Arrival { Id::OrbitMetric => } = {
            let (q, next) = (x, target);
            runtime::Arrival { residual: Approach, slope: OrbitMetric }
        }
        /// The shortest motion that moves one configuration to another, to first order.
        fn displacement(&self, x: &Q, y: &Q) -> Costates { Id::Approach } = {
            let (q, next) = (x, y);
            runtime::displacement(&OrbitMetric, &Approach)
        }
        /// The configuration that a small motion moves q to: Φ_{τ(η)}(q).
        fn moved(&self, q: &Q, eta: &Costates) -> Q { Id::Retraction } = { Retracted }
        /// The infinitesimal motion ξ_Q(q).
        fn infinitesimal_motion(&self, q: &Q, x: &Costates) -> Q { Id::Generator }
    }

    /// `Controlled`: the effect of inputs of forces on states, by the constants of steps and their size.
    FORCED(false) {
        fn prepare(&self, h: T) -> Result<Constants, Error> { Id::Constants } = { runtime::Ok(Prepared) }
        fn check_place(&self, x: &(Q, Mu)) -> Result<(), Error> { Id::Membership } = { runtime::check_state(self, &x.0, &x.1) }
        fn check_constraint(&self, constants: &Constants, t: T, x: &(Q, Mu), moves: Bool) -> Result<(), Error> { Id::Crossed => } = {
            runtime::check_constraint(self, &constants.0, (t, constants.1), x, moves)
        }
        fn constrained_place(&self, constants: &Constants, t: T, x: &(Q, Mu)) -> (Q, Mu) { Id::Crossed => } = {
            runtime::placed_state(self, &constants.0, t, x)
        }
        fn tangent_projector(&self, constants: &Constants, t: T, x: &(Q, Mu)) -> Option<Changes> { Id::Crossed => } = {
            runtime::tangent_projector::<Self, Rows>(self, &constants.0, t - constants.1, x)
        }
        fn independent(&self, constants: &Constants, t: T, x: &(Q, Mu), lengths: &Costates) -> Option<Changes> { Id::Crossed => } = {
            runtime::independent::<Self, Rows>(self, &constants.0, t - constants.1, x, lengths)
        }
        /// The forced step.
        fn follow(&self, constants: &Constants, t: T, x: &(Q, Mu), u: &Input) -> Result<(Q, Mu), Error> { Id::Increment => Id::Controls } = {
            runtime::forced_step(self, &constants.0, t, x, u)
        }
        /// (Gᵀ(q* − q), N* − N) and (GᵀG, I).
        fn arrival(&self, x: &(Q, Mu), target: &(Q, Mu)) -> Arrival { Id::OrbitMetric => } = {
            let approach = runtime::Variational::approach(self, &x.0, &target.0);
            let metric = runtime::Variational::orbit_metric(self, &x.0);
            runtime::arrival_of_state(&metric, &approach, &(target.1 - x.1))
        }
        /// The shortest motion that moves one configuration to another, to first order, and the change of the momentum.
        fn displacement(&self, x: &(Q, Mu), y: &(Q, Mu)) -> Costates { Id::Approach } = {
            let approach = runtime::Variational::approach(self, &x.0, &y.0);
            let motion = runtime::displacement(&runtime::Variational::orbit_metric(self, &x.0), &approach);
            runtime::pair(&motion, &(y.1 - x.1))
        }
        /// The state (Φ_{τ(η)}(q), N + ν).
        fn moved(&self, x: &(Q, Mu), delta: &Costates) -> (Q, Mu) { Id::Retraction } = {
            let (eta, nu): (Mu, Mu) = runtime::parted(delta);
            let d = runtime::Variational::retraction(self, &eta);
            (runtime::Variational::advance(self, &x.0, &d), x.1 + nu)
        }
        /// The infinitesimal motion (η_Q(q), ν).
        fn infinitesimal_motion(&self, x: &(Q, Mu), delta: &Costates) -> (Q, Mu) { Id::Generator } = {
            let (eta, nu): (Mu, Mu) = runtime::parted(delta);
            (runtime::Variational::infinitesimal_motion(self, &x.0, &eta), nu)
        }
    }

    /// `Controlled`: a forced step with a price of places and inputs.
    EXPANDED(false) {
        /// The forced step with its derivatives, and the second derivatives of ℓ + λ·(η′, N⁺). With the multipliers κ
        /// of the momentum equation they are those of α·η′ + β·F⁺ℓd + κ·(F⁻ℓd − N). η′ contributes ± ½ α·[Ad η, ζ].
        fn expand(&self, constants: &Constants, t: T, x: &(Q, Mu), u: &Input, costate: &Costates) -> Result<Expansion, Error> {
            Id::PriceExpanded => Id::StepExpanded
        } = {
            Crossed Linked
            let curvature: Curvature = Bend;
            Reacting
            let mu = &link.driving;
            let bracket: Square = Bracket;
            let price = {
                Locals
                runtime::Price {
                    price: Number0, by_motion: Value1, by_input: Value2, motions: Value3, mixed: Value4, inputs: Value5,
                }
            };
            let next = runtime::check_reached((*next, Landed))?;
            runtime::Ok(link.expansion(next, &curvature, &bracket, &price))
        }
        /// d/dh (ℓ + λ·(η′, N⁺)), the start of the step moving with h.
        fn price_of_time(&self, constants: &Constants, t: T, k: T, x: &(Q, Mu), u: &Input, costate: &Costates) -> Result<T, Error> {
            Id::PriceOfTime
        } = {
            Crossed Linked
            let slopes: runtime::SVector<T, 2> = { Locals Value0 };
            runtime::Ok(slopes[0] + k * slopes[1])
        }
    }

    /// `Controlled`: a forced step with a price that takes its velocity.
    EXPANDED_ON_EDGE(false) {
        /// The forced step with its derivatives, and the second derivatives of ℓ + λ·(η′, N⁺). With the multipliers κ
        /// of the momentum equation they are those of ℓ + α·η′ + β·F⁺ℓd + κ·(F⁻ℓd − N). η′ contributes ± ½ α·[Ad η, ζ].
        fn expand(&self, constants: &Constants, t: T, x: &(Q, Mu), u: &Input, costate: &Costates) -> Result<Expansion, Error> {
            Id::PriceExpanded => Id::StepExpanded
        } = {
            Crossed
            let (price, slope, bend) = { Locals (Number0, Value1, Value2) };
            let pushed = runtime::along_end(&slope);
            Pushed
            let curvature: Curvature = Bend;
            Reacting
            let mu = &link.driving;
            let bracket: Square = Bracket;
            let next = runtime::check_reached((*next, Landed))?;
            runtime::Ok(link.expansion_of_edge(next, &curvature, &bracket, (price, &slope, &bend)))
        }
        /// d/dh (ℓ + λ·(η′, N⁺)), the start of the step moving with h.
        fn price_of_time(&self, constants: &Constants, t: T, k: T, x: &(Q, Mu), u: &Input, costate: &Costates) -> Result<T, Error> {
            Id::PriceOfTime
        } = {
            Crossed
            let pushed = runtime::along_end(&PriceSlope);
            Pushed
            let slopes: runtime::SVector<T, 2> = { Locals Value0 };
            runtime::Ok(slopes[0] + k * slopes[1])
        }
    }

    /// `Controlled`: the price of a step.
    PRICED(false) {
        /// The price of a step.
        fn price(&self, constants: &Self::Constants, t: T, x: &Self::Place, u: &Input) -> Result<T, Error> { Id::Price } = {
            let (h, q) = (StepSize, Place); Locals runtime::Ok(Number0)
        }
    }

    /// `Controlled`: the price of a step that takes its velocity.
    PRICED_ON_EDGE(false) {
        /// The price of a step.
        fn price(&self, constants: &Self::Constants, t: T, x: &Self::Place, u: &Input) -> Result<T, Error> { Id::Price } = {
            Drifted Locals runtime::Ok(Number0)
        }
    }

    /// `Controlled`: bounds of places and inputs.
    BOUNDED(false) {
        /// The bounds.
        fn bounds(&self, constants: &Self::Constants, t: T, x: &Self::Place, u: &Input) -> Result<Bounds, Error> { Id::Bounds } = {
            let q = Place; Locals runtime::Ok(Value0)
        }
        /// The bounds with their derivatives, and the second derivatives of z·a.
        fn bounds_expanded(&self, constants: &Self::Constants, t: T, x: &Self::Place, u: &Input, z: &Bounds) -> Result<BoundsExpansion, Error> { Id::BoundsExpanded } = {
            let q = Place; Locals
            runtime::Ok(runtime::bounds(Value0, &Value1, Value2, &Value3, &Value4, Value5))
        }
    }

    /// `Controlled`: bounds that take the velocity of a step.
    BOUNDED_ON_EDGE(false) {
        /// The bounds.
        fn bounds(&self, constants: &Self::Constants, t: T, x: &Self::Place, u: &Input) -> Result<Bounds, Error> { Id::Bounds } = {
            Drifted Locals runtime::Ok(Value0)
        }
        /// The bounds with their derivatives, and the second derivatives of z·a, those of z·a + κ·(F⁻ℓd − N) with the
        /// multipliers κ of the momentum equation.
        fn bounds_expanded(&self, constants: &Self::Constants, t: T, x: &Self::Place, u: &Input, z: &Bounds) -> Result<BoundsExpansion, Error> { Id::BoundsExpanded } = {
            let costate: &Costates = &runtime::Space::origin();
            Crossed
            let (values, slopes, bend) = { Locals (Value0, Value1, Value2) };
            let pushed = runtime::pushed_along_end(&slopes, z);
            Pushed
            let curvature: Curvature = Bend;
            Reacting
            runtime::Ok(link.bounds(values, &slopes, &(curvature + bend)))
        }
    }

    /// `Controlled`: the prices of soft bounds.
    SOFT(false) {
        /// The prices of soft bounds.
        fn bound_prices(&self, constants: &Self::Constants, t: T) -> Bounds { Id::BoundPrices } = {
            let h = StepSize; Locals runtime::bound_prices(&Value0)
        }
    }

    /// `Controlled`: the price of the end.
    ENDED(false) {
        /// The price of the end.
        fn endpoint(&self, constants: &Self::Constants, t: T, x: &Self::Place) -> T { Id::PriceOfEnd } = { let q = Place; End }
        /// The price of the end with its derivatives.
        fn endpoint_expanded(&self, constants: &Self::Constants, t: T, x: &Self::Place) -> EndpointExpansion { Id::PriceOfEndExpanded } = { let q = Place; EndExpanded }
        /// The conditions of the end with their derivatives, and the second derivatives of z·g.
        fn target_expanded(&self, constants: &Self::Constants, t: T, x: &Self::Place, multipliers: &Costates) -> TargetExpansion { Id::TargetExpanded => Id::TargetEquations, Id::TargetInequalities } = {
            let q = Place; StateAtTarget
            let z: &Weights = &runtime::weights(multipliers);
            Locals
            runtime::conditions([&Value0, &Value1, &Value2], &Value3, &Value4)
        }
    }
}

/// The generated functions whose documentation shows a formula.
pub fn shown_by(id: Id) -> Vec<&'static str> {
    let documented = ALL.iter().copied().flatten().filter(|function| !function.title.is_empty());
    documented.filter(|function| function.shows(id)).map(|function| function.name).into_list()
}
