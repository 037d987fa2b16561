//! Fixed endpoints: the extremal of the action from one configuration to another in a given number of steps.
//!
//! The unknowns are the motions of the vertices of a path along their orbits, on which the dynamics q_{k+1} = Φ_{F_k}(q_k) always stays. So the
//! problem on all of the space has the answer of the problem on the orbit, and no extremal is abnormal. Of momenta it determines the
//! component that motions can have. As every vertex is an unknown, no single shot has to hit the target.

mod end;
mod extremal;
mod guess;
mod newton;
mod pivot;
mod several;
mod sweep;
#[cfg(test)]
mod tests;
mod vertex;

pub use extremal::{Extremal, Node, States};
pub use guess::Guess;
pub use several::Way;

use crate::newton::{Bracket, Trial};
use crate::parameters::check_finite;
use crate::scheme::Scheme;
use crate::{Clebsch, Clock, Declared, Differentiated, Error, Method, Real, Scalar, Space, Stepper, Variational};
use core::iter::once;
use core::ops::RangeInclusive;
use num_traits::Zero;
use sweep::{Endpoints, Search};

/// Problems with fixed endpoints for a [`Stepper`], made by [`Stepper::boundary`].
///
/// ```
/// # use clebsch::{Clebsch, Guess};
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(
/// #     action     = |a: Translation<1>, x: Vector1| x + a,
/// #     lagrangian = |v| self.mass * v.norm_squared() / 2,
/// #     potential  = |x| self.stiffness * x.norm_squared() / 2,
/// #     emit       = [boundary],
/// # )]
/// # struct Spring { mass: f64, stiffness: f64 }
/// # use nalgebra::Vector1;
/// let stepper = Spring { mass: 1.0, stiffness: 1.0 }.into_stepper(0.01)?;
/// let boundary = stepper.boundary();
/// let mut path = [boundary.rest(&Vector1::zeros()); 100];
/// let extremal = boundary.solve(&Vector1::zeros(), &Vector1::new(1.0), Guess::Geodesic, &mut path)?;
/// // x = sin t / sin 1
/// assert!((extremal.momentum().x - 1.0 / 1.0_f64.sin()).abs() < 1e-4);
/// # Ok::<(), clebsch::Error>(())
/// ```
#[derive(Debug)]
pub struct Boundary<'a, S: Variational<M, Scalar: Real>, const M: usize, B: Differentiated<S, M> = Declared> {
    stepper: &'a Stepper<S, B>,
    time: S::Scalar,
}

impl<S: Clebsch, B: Method<S>> Stepper<S, B> {
    /// Problems with fixed endpoints: given q_0 and q_N instead of q_0 and N_0.
    ///
    /// ```text
    /// let boundary = stepper.boundary();
    /// let mut path = [boundary.rest(&q0); 50];
    /// let extremal = boundary.solve(&q0, &target, Guess::Geodesic, &mut path)?;
    /// ```
    /// Its paths are of steps of order 1 or 2; a composed step runs back in some of its steps, and does not compile here.
    /// Neither does a system with a constraint, whose multipliers are no unknowns of these problems:
    ///
    /// ```compile_fail,E0080
    /// # use clebsch::Clebsch;
    /// # #[derive(Clebsch, Clone, Debug)]
    /// # #[clebsch(
    /// #     action     = |a: Translation<2>, x: Vector2| x + a,
    /// #     lagrangian = |v| self.mass * v.norm_squared() / 2,
    /// #     constraint = |x| [x.norm() == 1],
    /// #     emit       = [tangent],
    /// # )]
    /// # struct Bob { mass: f64 }
    /// let stepper = Bob { mass: 2.0 }.into_stepper(0.1)?;
    /// let boundary = stepper.boundary();
    /// # Ok::<(), clebsch::Error>(())
    /// ```
    #[inline]
    pub fn boundary<const M: usize>(&self) -> Boundary<'_, S, M, B>
    where
        S: Variational<M, Scalar: Real>,
        B: Differentiated<S, M>,
    {
        const { assert!(!S::IS_CONSTRAINED, "a system with a constraint has no problems with fixed endpoints yet") };
        const { assert!(B::ORDER <= 2, "paths of least action are of steps of order 2: write `order = 2`") };
        Boundary { stepper: self, time: S::Scalar::zero() }
    }
}

/// Where the cost or the potential depends on the time.
impl<S, B: Differentiated<S, M>, const M: usize> Boundary<'_, S, M, B>
where
    S: Variational<M, Time = Clock<<S as Clebsch>::Scalar>, Scalar: Real>,
{
    /// The same with paths that start at the time `t` instead of 0.
    ///
    /// # Errors
    /// [`Error::NotFinite`].
    pub fn starting_at(self, t: S::Scalar) -> Result<Self, Error> {
        check_finite("the time", &t)?;
        Ok(Self { time: t, ..self })
    }
}

impl<'a, S: Variational<M, Scalar: Real>, B: Differentiated<S, M>, const M: usize> Boundary<'a, S, M, B> {
    /// The stepper.
    #[inline]
    pub fn stepper(&self) -> &'a Stepper<S, B> {
        self.stepper
    }

    /// The edge that stays at `q`, as storage. A path of N steps has N of them, or 2N if a cost is composed with its
    /// adjoint (order 2).
    pub fn rest(&self, q: &S::Configuration) -> Node<S, M> {
        Node::rest(&self.stepper.system, q)
    }

    /// The path from `start` to `target` on which the action Σ ℓd is critical, as near to the guess as Newton's method finds it.
    ///
    /// The number of steps is that of `path` divided by the edges in a step; its nodes are overwritten. F⁺ℓd of each
    /// edge is F⁻ℓd of the next, and q_N is the target, both up to round-off. Where motions fix the target, the last
    /// momentum vanishes on them.
    ///
    /// Work: three to six linearisations from a good guess, each linear in the number of nodes; at most 200. [`Guess::Geodesic`] begins with eight edges.
    ///
    /// # Errors
    /// * [`Error::PathLength`], [`Error::NotFinite`], [`Error::OffOrbit`] for the arguments;
    /// * [`Error::IndefiniteKineticEnergy`] where the inertia depends on the configuration or the time, and is not positive at an end;
    /// * [`Error::UndeterminedDirection`] and [`Error::Unreachable`] where the target is opposite to the start or on another orbit;
    /// * [`Error::NoExtremal`] where the work was not enough;
    /// * [`Error::NotStationary`] where momenta jump by more than round-off, as at a singularity of the potential.
    ///
    /// After an error the nodes hold some path from `start`.
    pub fn solve<'p>(
        &self,
        start: &S::Configuration,
        target: &S::Configuration,
        guess: Guess<S::Scalar, M>,
        path: &'p mut [Node<S, M>],
    ) -> Result<Extremal<'p, S, M, B>, Error>
    where
        'a: 'p,
    {
        self.stepper.check_configuration(target)?;
        self.extremal(start, Some(target), guess, path)
    }

    /// The path from `start` to wherever Σ ℓd + φ(t_N, q_N) is critical: its last momentum is −∂φ/∂q_N, 0 where no `endpoint` is declared.
    ///
    /// As [`solve`](Self::solve), but that [`Guess::Geodesic`] starts at rest. [`Extremal::action`] includes φ.
    ///
    /// # Errors
    /// As [`solve`](Self::solve).
    pub fn solve_free<'p>(
        &self,
        start: &S::Configuration,
        guess: Guess<S::Scalar, M>,
        path: &'p mut [Node<S, M>],
    ) -> Result<Extremal<'p, S, M, B>, Error>
    where
        'a: 'p,
    {
        self.extremal(start, None, guess, path)
    }

    fn extremal<'p>(
        &self,
        start: &S::Configuration,
        target: Option<&S::Configuration>,
        guess: Guess<S::Scalar, M>,
        path: &'p mut [Node<S, M>],
    ) -> Result<Extremal<'p, S, M, B>, Error>
    where
        'a: 'p,
    {
        self.check(start, &guess, path.len())?;
        let Stepper { system, h, constants } = self.stepper;
        let problem = Endpoints::<S, M, B> { system, h: *h, constants, time: self.time, start, target };
        let time = problem.time_of_end(path.len());
        target.map_or(Ok(()), |target| system.check_kinetic_energy(time, target))?;
        let mut search = Search { problem, path, last: *start };
        let (summary, iterations) = search.newton(&guess)?;
        let end = search.last;
        Ok(Extremal {
            stepper: self.stepper,
            nodes: path,
            time: self.time,
            action: summary.action,
            residual: summary.residual_squared.sqrt(),
            gap: target.map_or(S::Scalar::zero(), |target| end.distance_squared(target).sqrt()),
            negative: summary.negative,
            iterations,
            end,
            final_momentum: summary.after,
        })
    }

    /// The step size in `steps`, and so the final time, at which Σ ℓd + φ(t_N, q_N) of the extremal is critical. The
    /// extremal leads to `target`, or to anywhere. The energy is ∂φ/∂t there. The search starts at the step size of the
    /// stepper and goes where the sum falls, at most to a limit.
    ///
    /// The nodes hold the extremal then: a stepper of that step size and [`Guess::Path`] give it with all its numbers. By the envelope
    /// theorem the derivative by h is that at a fixed path. It is a central difference: h has ten digits of an `f64`, the action all.
    ///
    /// # Errors
    /// [`Error::StepSize`] for limits that are not positive numbers in order, [`Error::NoExtremal`], and those of [`solve`](Self::solve).
    pub fn free_time(
        &self,
        start: &S::Configuration,
        target: Option<&S::Configuration>,
        steps: RangeInclusive<S::Scalar>,
        guess: Guess<S::Scalar, M>,
        path: &mut [Node<S, M>],
    ) -> Result<S::Scalar, Error> {
        let bracket = Bracket::within(&steps)?;
        self.check(start, &guess, path.len())?;
        target.map_or(Ok(()), |target| self.stepper.check_configuration(target))?;
        let third = S::Scalar::EPSILON.powf(S::Scalar::from_ratio(1, 3));
        let accuracy = S::Scalar::from_f64(4.0) * third * third;
        let mut guess = guess;
        let trial = |h| {
            let system = &self.stepper.system;
            let constants = B::Scheme::constants(system, h)?;
            let problem = Endpoints::<S, M, B> { system, h, constants: &constants, time: self.time, start, target };
            let mut search = Search { problem, path, last: *start };
            let (_, sweeps) = search.newton(&guess)?;
            guess = Guess::Path;
            let step = third * h;
            let longer = search.sum_at(h + step)?;
            let shorter = search.sum_at(h - step)?;
            let size = (longer.abs() + shorter.abs()) / h;
            Ok(Trial { answer: h, sweeps, slope: (longer - shorter) / (step + step), size })
        };
        let (h, _) = bracket.critical(self.stepper.h, accuracy, false, trial)?;
        Ok(h)
    }

    /// Start and guess are finite, the start on the declared space, nodes those of full steps.
    fn check(&self, start: &S::Configuration, guess: &Guess<S::Scalar, M>, nodes: usize) -> Result<(), Error> {
        let per_step = B::EDGES.max(1);
        if nodes == 0 || !nodes.is_multiple_of(per_step) {
            return Err(Error::PathLength { nodes, per_step });
        }
        self.stepper.check_place(self.time, start)?;
        if matches!(guess, Guess::Velocity(velocity) if !velocity.all_finite()) {
            return Err(Error::NotFinite { name: "the guessed velocity" });
        }
        Ok(())
    }
}

impl<T: Real, S: Variational<M, Scalar = T>, B: Differentiated<S, M>, const M: usize> Search<'_, S, M, B> {
    /// Σ ℓd + φ of the path as it is, with another step size.
    fn sum_at(&self, h: T) -> Result<T, Error> {
        let system = self.problem.system;
        let constants = B::Scheme::constants(system, h)?;
        let problem = Endpoints { h, constants: &constants, ..self.problem };
        let ends = self.path.iter().skip(1).map(|node| &node.configuration).chain(once(&self.last));
        let price = system.endpoint(problem.time_of_end(self.path.len()), &self.last).price;
        Ok(self.path.iter().zip(ends).enumerate().fold(price, |sum, (index, (node, next))| {
            sum + problem.momenta(index, &node.configuration, &node.increment, next).lagrangian
        }))
    }
}
