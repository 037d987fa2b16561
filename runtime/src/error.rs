//! Everything that can go wrong, with the numbers that a person needs.

use crate::Scalar;
use core::fmt::{self, Display, Formatter};

/// Declares the errors, each with its message, in which fields are called by their names.
macro_rules! errors {
    ($(#[$attribute:meta])* pub enum Error { $(
        $(#[doc = $doc:literal])*
        $variant:ident $({ $($(#[doc = $about:literal])* $field:ident: $type:ty,)* })? => $message:literal $(, $argument:expr)*;
    )* }) => {
        $(#[$attribute])*
        pub enum Error { $(
            $(#[doc = $doc])*
            $variant $({ $($(#[doc = $about])* $field: $type,)* })?,
        )* }

        impl Display for Error {
            fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
                match *self { $(
                    #[allow(unused_variables, reason = "a message need not give all numbers")]
                    Self::$variant $({ $($field,)* })? => write!(f, $message $(, $argument)*),
                )* }
            }
        }
    };
}

/// The text that a function writes, as part of a message.
struct Said<F>(F);

impl<F: Fn(&mut Formatter<'_>) -> fmt::Result> Display for Said<F> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        (self.0)(f)
    }
}

errors! {
    /// Why a stepper could not be made, a state not be taken, a step not be done or an extremal not be found. The state that was passed in is unchanged.
    ///
    /// Numbers are given as `f64` whatever the scalar of the system is.
    ///
    /// ```
    /// # use clebsch::{Clebsch, Error};
    /// # #[derive(Clebsch, Clone, Debug)]
    /// # #[clebsch(action = |a: Translation<1>, x: Vector1| x + a, cost = |h, a| self.mass * a.norm_squared() / (2 * h))]
    /// # struct Particle { mass: f64 }
    /// let refused = Particle { mass: 0.0 }.into_stepper(0.5);
    /// assert!(matches!(refused, Err(Error::SingularKineticEnergy { .. })));
    ///
    /// let error = Particle { mass: f64::NAN }.into_stepper(0.5).unwrap_err();
    /// assert_eq!(error, Error::NotFinite { name: "mass" });
    /// assert!(error.to_string().starts_with("mass is not finite"));
    /// ```
    #[derive(Clone, Copy, Debug, PartialEq)]
    #[non_exhaustive]
    pub enum Error {
        /// The step size is zero, NaN or infinite. Negative ones are allowed and run back in time.
        StepSize {
            /// The step size that was given.
            value: f64,
        } => "the step size is {value}: it must be a finite number other than zero (negative runs back in time)";
        /// An input or a result is NaN or infinite.
        NotFinite {
            /// The quantity that is not finite: a field of the declared struct, or a part of the state.
            name: &'static str,
        } => "{name} is not finite: look for NaN, infinity, division by zero or overflow in the numbers that it comes from";
        /// The error that a step size was asked for is not above that of rounding alone.
        BelowRounding {
            /// The error that was wished.
            error: f64,
            /// The approximate error of rounding over the duration.
            rounding: f64,
        } =>
            "an error of {error:.1e} was asked for, but rounding alone makes about {rounding:.1e} over this duration: \
             ask for more than that, or for a shorter duration";
        /// A part of the storage of a [`Sites`](crate::Sites) has another length than there are sites.
        NumberOfSites {
            /// The entries of that part.
            found: usize,
            /// The sites, N.
            sites: usize,
        } => "the storage has {found} entries where there are {sites} sites: give one entry for each site";
        /// There is no site with this number.
        NoSite {
            /// The number, counted from 0.
            site: usize,
            /// The sites, N.
            sites: usize,
        } => "there is no site {site} among {sites}: they are counted from 0, so give a number below {sites}";
        /// A time is before the last one that was asked for, in the direction of the steps.
        TimeOrder {
            /// The time.
            time: f64,
            /// The last one, or that of the start.
            before: f64,
        } => "the time {time} comes after {before}, against the direction of the steps: give times in the order in which steps reach them";
        /// The function of an event is not finite.
        EventNotFinite {
            /// The number of the event.
            event: usize,
        } => "the function of event {event} is not finite: look for NaN, division by zero or overflow in it";
        /// The function of an event touches zero, and rounding decides whether it crosses.
        EventGrazes {
            /// The number of the event.
            event: usize,
            /// The nearest value to zero, on the positive side where the function does not cross.
            least: f64,
        } =>
            "the function of event {event} touches zero, to {least:.1e}, and rounding decides whether it crosses: move \
             its zero by more than that, or take the zeros of its rate for the touches";
        /// The state that was set at an event does not leave the zero of its function.
        EventStays {
            /// The number of the event.
            event: usize,
        } =>
            "the state that was set at event {event} does not leave the zero of its function: stop there, let it rest by \
             a constraint, or set another momentum";
        /// A grid has no site in some direction, or more than can be numbered.
        EmptyGrid {
            /// The direction, from 0 on.
            direction: usize,
            /// The sites in this direction.
            sites: usize,
        } => "the grid has {sites} sites in direction {direction}: give each direction at least one, and all of them fewer than memory has";
        /// A slab of a grid has no row, or rows that are not there.
        Rows {
            /// Its first row, from 0 on.
            first: usize,
            /// The row behind its last one.
            end: usize,
            /// The rows of the grid.
            rows: usize,
        } => "the slab has the rows {first}..{end} of a grid with {rows} rows: give it at least one, and none beyond the last";
        /// A spacing of a grid is zero, negative, NaN or infinite.
        Spacing {
            /// The direction, from 0 on.
            direction: usize,
            /// The spacing that was given.
            value: f64,
        } => "the spacing in direction {direction} is {value}: it must be a finite number above zero";
        /// A face of a mesh has a corner that is no vertex.
        FaceCorner {
            /// The face, from 0 on.
            face: usize,
            /// The vertex that it names.
            vertex: usize,
            /// The number of vertices.
            vertices: usize,
        } => "face {face} has the corner {vertex}, and there are {vertices} vertices: count them from 0 on";
        /// A face of a mesh has too few corners, or a corner twice. Or it is no triangle, and has to be one.
        FaceSize {
            /// The face, from 0 on.
            face: usize,
            /// Its different corners.
            corners: usize,
        } => "face {face} has {corners} different corners: give at least three, each once, and exactly three for cotangent weights";
        /// Two faces of a mesh run through an edge in the same direction, or three faces have the same edge.
        FlippedFace {
            /// The second of these faces.
            face: usize,
            /// The vertex that the edge starts from.
            from: usize,
            /// The vertex that it ends at.
            to: usize,
        } => "face {face} runs from vertex {from} to {to}, as another face does or as a third one: list the corners of one of them the other way round, or leave out a double one";
        /// An edge of a mesh has no length, or one that is not finite.
        EdgeLength {
            /// A vertex.
            from: usize,
            /// Another one.
            to: usize,
            /// Their distance.
            value: f64,
        } => "the vertices {from} and {to} are {value} apart: give vertices of an edge different finite places";
        /// The weight of an edge is not finite.
        EdgeWeight {
            /// A vertex.
            from: usize,
            /// Another one.
            to: usize,
            /// The weight.
            value: f64,
        } => "the edge of the vertices {from} and {to} has the weight {value}: give a finite one (a triangle without area has no cotangents)";
        /// There is no edge between two vertices of a mesh.
        NoEdge {
            /// A vertex.
            from: usize,
            /// Another one.
            to: usize,
        } => "no face has an edge between the vertices {from} and {to}";
        /// There is not one group element for each number of an edge.
        NumberOfEdges {
            /// The elements.
            found: usize,
            /// The numbers of edges.
            edges: usize,
        } => "there are {found} elements for {edges} edges: give one for each number, the identity where a side has no edge";
        /// The elements of edges are not those of a configuration.
        NotFlat {
            /// The start of the first edge that does not fit.
            from: usize,
            /// Its end.
            to: usize,
            /// By how much its element differs from that of the configuration.
            distance: f64,
            /// The difference that was allowed.
            tolerance: f64,
        } => "the element of the edge from {from} to {to} is {distance:.3e} off the way along other edges, above {tolerance:.3e}: a face has a curvature, or the way goes around a hole";
        /// No path of edges leads to a site.
        Unreached {
            /// The site.
            site: usize,
            /// The site from which paths start.
            from: usize,
        } => "no path of edges leads from the site {from} to the site {site}: start at a site of the lattice, and leave sites without edges to the others out of it";
        /// The factor of over-relaxation is not between 0 and 2.
        OverRelaxation {
            /// The factor.
            factor: f64,
        } => "the factor of over-relaxation is {factor}: give one above 0 and below 2, or none";
        /// A field has not come to rest after the most sweeps.
        NotRelaxed {
            /// The sweeps.
            sweeps: u64,
            /// The largest correction of the last sweep, in the coordinates of the group.
            correction: f64,
            /// The correction that was allowed.
            tolerance: f64,
        } => "after {sweeps} sweeps corrections are still {correction:.3e}, above {tolerance:.3e}: go on from this configuration, allow more sweeps, or a larger tolerance";
        /// Small waves of a field grow at steps of this size.
        UnstableStep {
            /// The step size.
            step_size: f64,
            /// The step size up to which they do not grow.
            stable: f64,
        } => "the step size {step_size} is above {stable}, up to which small waves of the field surely do not grow: take shorter steps";
        /// A field is not symmetric that is declared `#[clebsch(symmetric)]`, or that a cost needs to be symmetric.
        NotSymmetric {
            /// The field.
            field: &'static str,
            /// The largest |A_ij − A_ji|, in the units of the field.
            defect: f64,
            /// The largest defect that is taken for round-off.
            tolerance: f64,
        } =>
            "`{field}` is declared symmetric, or its cost needs it to be, but entries that mirror each other differ by \
             up to {defect:.3e}, more than the round-off of {tolerance:.1e}: pass ({field} + {field}ᵀ)/2, or remove \
             `#[clebsch(symmetric)]`";
        /// A field that is declared `#[clebsch(diagonal)]` has an entry off its diagonal.
        NotDiagonal {
            /// Name of the field.
            field: &'static str,
            /// Largest entry off the diagonal, in the unit of the field.
            defect: f64,
        } =>
            "`{field}` is declared diagonal, but has an entry of {defect:.3e} off its diagonal: set it to zero, or \
             remove `#[clebsch(diagonal)]`";
        /// A field that is declared `#[clebsch(unit)]` has another length.
        NotUnit {
            /// Name of the field.
            field: &'static str,
            /// Its length.
            length: f64,
        } =>
            "`{field}` is declared a unit vector, but its length is {length}: pass {field}.normalize(), or remove \
             `#[clebsch(unit)]`";
        /// The kinetic energy is degenerate for these parameters: momenta do not determine velocities.
        SingularKineticEnergy {
            /// Condition number of the inertia, infinite where it is exactly singular.
            condition: f64,
        } =>
            "the kinetic energy is singular for these parameters (condition number {condition:.2e}), so that momenta \
             do not determine velocities: check masses and moments of inertia for zeros and for units that differ by \
             many orders";
        /// The kinetic energy ½ ξ·Σξ is negative for some velocity ξ, or for every one, and the declaration does not say `signature = indefinite`.
        ///
        /// Σ is the inertia, the Hessian of the kinetic energy in the basis of the Lie algebra. Its eigenvalues are in units of mass, or of mass times length squared.
        IndefiniteKineticEnergy {
            /// The least eigenvalue of Σ.
            least_eigenvalue: f64,
            /// The largest eigenvalue of Σ; the kinetic energy is negative for every velocity where this is below zero.
            largest_eigenvalue: f64,
        } =>
            "the kinetic energy is {} (eigenvalues of the inertia from {least_eigenvalue:.3e} to \
             {largest_eigenvalue:.3e}): {}; declare `signature = indefinite` where this is meant",
            Said(|f: &mut Formatter<'_>| f.write_str(if largest_eigenvalue < 0.0 {
                "negative for every velocity"
            } else {
                "negative for some velocities"
            })),
            Said(|f: &mut Formatter<'_>| f.write_str(if largest_eigenvalue < 0.0 {
                "check for a missing `.transpose()` in a square, and change the sign of the cost or of the Lagrangian"
            } else {
                "check the signs of masses and moments of inertia, and for a missing `.transpose()` in a square"
            }));
        /// The configuration is not on the space that the declaration promises, for example no rotation matrix.
        OffOrbit {
            /// By how much its equations are violated, as in the largest entry of |RᵀR − I|; infinite on the wrong component.
            defect: f64,
            /// The largest defect that is accepted.
            tolerance: f64,
        } =>
            "the configuration is {}",
            Said(|f: &mut Formatter<'_>| if defect == f64::INFINITY {
                f.write_str("on another component of its space, such as a reflection instead of a rotation: check the \
                 sign of its determinant, for example the order or the signs of its columns")
            } else {
                write!(f, "off its space by {defect:.3e} where {tolerance:.1e} is accepted: normalise it, for example \
                 give unit length to a vector, orthonormal columns to a rotation or a frame, equal entries across the \
                 diagonal to a symmetric matrix, or make a projector XXᵀ of orthonormal columns X")
            });
        /// The momentum has a component along the motions that leave the configuration unchanged.
        OutsideMomentumSpace {
            /// The size of that component, in the units of the momentum.
            violation: f64,
            /// The largest violation that is accepted.
            tolerance: f64,
        } =>
            "the momentum has a component of {violation:.3e} along motions that leave the configuration unchanged, \
             where {tolerance:.1e} is accepted: start by `Stepper::project` or compute it by `momentum_map`; \
             where such motions are motions of the body, declare `isotropy = free`";
        /// The configuration does not obey the constraint of the declaration on places.
        OffConstraint {
            /// The size of one of its equations, left side less right side.
            violation: f64,
            /// The largest one that is accepted.
            tolerance: f64,
        } =>
            "the configuration violates the constraint by {violation:.3e}, where {tolerance:.1e} is accepted: start \
             by `Stepper::project`, or from one that obeys every equation of the constraint";
        /// No configuration that obeys the constraint of the declaration on places was found near this one.
        FarFromConstraint {
            /// The size of one of its equations that was left, left side less right side.
            violation: f64,
            /// Number of corrections of the configuration that were made.
            corrections: u32,
        } =>
            "no configuration that obeys the constraint was found near this one: it is violated by {violation:.3e} \
             after {corrections} corrections; start nearer to one that obeys it";
        /// The velocity of the momentum does not obey the constraint of the declaration.
        ConstraintViolated {
            /// The largest |A ξ − b| of its equations, in the units of the velocity that they fix.
            violation: f64,
            /// The largest violation that is accepted.
            tolerance: f64,
        } =>
            "the velocity violates the constraint by {violation:.3e}, where {tolerance:.1e} is accepted: start by \
             `Stepper::project`, or give a velocity that obeys every equation of the constraint";
        /// The rows of the constraint depend on each other at this configuration: its forces are not determined.
        DependentConstraints {
            /// The number of independent rows.
            rank: usize,
            /// The number of rows.
            rows: usize,
        } =>
            "the {rows} rows of the constraint have rank {rank} at this configuration, so that its forces are not \
             determined: leave out the equations that follow from others, or start from another configuration";
        /// The equation of the step has no solution that is connected to the identity: the step is too long. For exact
        /// drifts the motion is longer than formulas can reach. On SO(3) duplication reaches h|M|/J up to some 10⁷ in
        /// `f64` and a thousand in `f32`. On SO(4) parts reach some thousand radians.
        Unsolvable {
            /// The largest s ≤ 1 for which the equation with s times the momentum has such a solution.
            solvable_fraction: f64,
            /// The step size, where the error comes from a [`Stepper`](crate::Stepper).
            step_size: Option<f64>,
            /// The longest step from the same state that has a solution, if the error comes from a
            /// [`Stepper`](crate::Stepper) and one was found. A step that is 2 % longer has no solution. Potentials and
            /// forces add a momentum that depends on the step size too, so the longest step is found by trying. Some
            /// ten steps are tried, at most 32. None is tried if a stepper has more than two kilobytes of constants, as
            /// for exact drifts.
            solvable_step: Option<f64>,
        } =>
            "the step {}is too long for this momentum: its equation has a solution up to {solvable_fraction:.3} times it; {}",
            Said(|f: &mut Formatter<'_>| step_size.map_or(Ok(()), |h| write!(f, "of {h:.3e} "))),
            Said(|f: &mut Formatter<'_>| match solvable_step {
                // rounded down
                Some(h) => write!(f, "reduce the step size to {:.3e} or less", h * 0.9995),
                None => f.write_str("reduce the step size, by that factor or more"),
            });
        /// The equation of the step has no solution on the branch of short steps, and no part of the momentum changes that. This
        /// is so for a constraint whose motion does not stop where the momentum does, as that of a ball on a turning table.
        StepTooLong {
            /// The step size.
            step_size: f64,
            /// The longest step from the same state that has a solution, if one was found by trying. A step that is 2 % longer has no
            /// solution.
            solvable_step: Option<f64>,
        } =>
            "the step of {step_size:.3e} is too long: its equation has no solution near those of short steps; {}",
            Said(|f: &mut Formatter<'_>| match solvable_step {
                // rounded down
                Some(h) => write!(f, "reduce the step size to {:.3e} or less", h * 0.9995),
                None => f.write_str("reduce the step size"),
            });
        /// The monitor g of `step` is not positive and finite. Within a step it is 1/W, the value that the step carries along. It is 0 where
        /// steps to a time do not change the time any more.
        Monitor {
            /// g(q), or 1/W.
            value: f64,
        } =>
            "the function of `step` is {value:.3e}, and a step needs one that is positive and finite: write one that is so wherever the \
             system moves, or take smaller steps where it changes much within one";
        /// The gradient method of an opaque potential disagrees with differences of its value method.
        WrongGradient {
            /// The entry of the configuration, counted through all its leaves, matrices column by column.
            entry: usize,
            /// Its value by the gradient method.
            gradient: f64,
            /// Its value by differences of the value method.
            difference: f64,
        } =>
            "entry {entry} of the gradient is {gradient:.9e}, but differences of the value give {difference:.9e}: \
             check the sign, the factor and the order of entries of the gradient method";
        /// The nodes that were given for a path do not make up full steps.
        PathLength {
            /// Their number.
            nodes: usize,
            /// The number of nodes of one step.
            per_step: usize,
        } => "a path of {nodes} nodes was given: give {per_step} for each step, and at least one step";
        /// No small motion of the start comes nearer to the target: they are like opposite points of a sphere, or on different orbits.
        UndeterminedDirection {
            /// The distance from start to target, as the root of the sum of squares of all entries.
            distance: f64,
        } =>
            "no small motion brings the start nearer to the target, {distance:.3e} away: where they are opposite, give \
             a velocity as the guess; else check that some motion moves one to the other";
        /// No motion moves the start to the target.
        Unreachable {
            /// The least distance that was left, as the root of the sum of squares of all entries.
            distance: f64,
        } =>
            "no motion was found from the start to the target: {distance:.3e} were left; check that the target is on \
             the orbit of the start, such as a vector of the same length, or give a velocity as the guess";
        /// The work allowed for one path with fixed endpoints was used up without a decision.
        NoExtremal {
            /// Size of the next correction, relative to the path: the root of the ratio of its decrease of the action.
            correction: f64,
            /// Number of linearisations that were made.
            iterations: u32,
        } =>
            "no extremal was found in {iterations} linearisations (relative correction {correction:.1e}): give a \
             better guess, or go there by targets between; of a plan, check that its price cannot fall for ever";
        /// The path or plan that was found is not critical: at a step, terms that should cancel do not.
        NotStationary {
            /// The largest jump of the momentum at a vertex. For a plan, the largest slope of the price along an input.
            residual: f64,
            /// The momentum, as the root of the mean of squares. For a plan, the largest term of a slope.
            momentum: f64,
        } =>
            "what was found is no extremal: momenta jump by {residual:.3e}, beside {momentum:.3e} of their own, \
             which is more than round-off; it may pass a singularity, so lead around it by another guess";
        /// To first order no input moves the end of the plan towards the target.
        Uncontrollable {
            /// The distance that is left, as the root of the sum of squares of all entries.
            distance: f64,
        } =>
            "no small change of the inputs brings the end nearer to the target, {distance:.3e} away: check that the \
             inputs control all that the target fixes, and that there are enough steps; else guess inputs that lead \
             near it";
        /// A plan is to end where the declared conditions hold, and none are declared.
        NoTarget =>
            "the declaration has no `target`: write `target = |q| [a == b]`, or pass `Target::Place`, \
             `Target::Configuration` or `Target::Free`";
        /// A price has a term |a| or max(a, b) with a negative factor, which no minimum has at its kink.
        NegativePrice {
            /// The term, as it was written.
            term: &'static str,
            /// Its factor.
            price: f64,
        } =>
            "the factor of `{term}` in the price is {price:.3e}: it has to be positive, or 0, for the price to have a minimum";
        /// An estimate is to go on by more steps than its plan has.
        PlanTooShort {
            /// The number of steps of the plan.
            steps: usize,
            /// The number that was asked for.
            wanted: usize,
        } => "the plan has {steps} steps, fewer than the {wanted} by which the estimate is to go on";
        /// The information of a prior has a negative eigenvalue.
        NegativeInformation {
            /// The least eigenvalue.
            eigenvalue: f64,
        } =>
            "the information of the prior has the eigenvalue {eigenvalue:.3e}: it is the inverse of a covariance, and has no negative one";
        /// A motion, a price or bounds read a reference that was not given.
        NoReference {
            /// The step whose reference is missing, counted from 0. It is `steps` for the reference of the end.
            step: usize,
            /// The number of steps.
            steps: usize,
        } =>
            "reference {step} is missing or not finite: `Control::refer` gives those of the {steps} steps, counted from 0, \
             and `Control::with_end_reference` that of the end, number {steps}; `Control::follow_with` takes that of a single step";
        /// No inputs were found that keep the bounds.
        Infeasible {
            /// The bound that is violated most, as it was written.
            bound: &'static str,
            /// The step in which it is, counted from 0.
            stage: usize,
            /// By how much it is violated, at most.
            violation: f64,
        } =>
            "no inputs were found that keep the bounds: `{bound}` is violated by {violation:.3e} in step {stage}; \
             relax it, or guess inputs that keep it; equations among the bounds have to agree with each other";
        /// No inputs were found that lead to the target.
        TargetMissed {
            /// The distance that is left, as the root of the sum of squares of all entries.
            distance: f64,
            /// Number of linearisations that were made.
            iterations: u32,
        } =>
            "no inputs were found that lead to the target: {distance:.3e} were left after {iterations} linearisations; \
             give more steps or wider bounds, or guess inputs that lead near it";
        /// The work allowed for one implicit equation was used up without a decision.
        NotConverged {
            /// Size of the residual that was left, relative to the terms of the equation.
            residual: f64,
            /// Number of linearisations or sweeps that were made.
            iterations: u32,
        } =>
            "the implicit equation was not solved in {iterations} iterations (relative residual {residual:.1e}): \
             reduce the step size, or allow more by `iterations` where the declaration limits them";
        /// The step of a lane failed: [`failure`](crate::Stepper::failure) says why, and [`step_each`](crate::Stepper::step_each) steps the others.
        InLane {
            /// The first such lane, counted from 0.
            lane: usize,
        } =>
            "the step of lane {lane} failed, and may have in others: `Stepper::failure` says why, and \
             `Stepper::step_each` steps those that can be";
        /// There is no body with this number in an [ensemble](crate#many-bodies).
        NoBody {
            /// The number, counted from 0.
            body: usize,
            /// How many bodies there are.
            bodies: usize,
        } =>
            "there is no body {body} in an ensemble of {bodies}: they are counted from 0, so give a number below \
             {bodies}";
        /// A step on T*Q was asked of a system with forces, a constraint or `step`, or of momenta alone. Forces act on momenta in 𝔤* and determine no covector.
        NoCovector =>
            "a system with forces, a constraint or `step`, or of momenta alone, has no step in (q, p), as there are no covectors of the \
             configuration to step: step in (q, N), by `Stepper::step`";
        /// The step has no derivative: it is at the very edge of solvability.
        SingularTangent {
            /// The step size.
            step_size: f64,
        } =>
            "the step of {step_size:.3e} has no derivative, as it is at the edge of solvability: reduce the \
             step size";
    }
}

impl Error {
    /// The step's equation has a solution up to this fraction of the momentum.
    #[cold]
    pub(crate) fn unsolvable<T: Scalar>(fraction: T) -> Self {
        Self::Unsolvable { solvable_fraction: fraction.to_f64(), step_size: None, solvable_step: None }
    }
}

impl core::error::Error for Error {}
