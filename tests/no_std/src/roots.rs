//! The exported functions of a system: the calls in a program whose stack and code are inspected.
//!
//! An operation of a concrete type is written as a call of a method. Where the system has none of that name, because it
//! has lanes, [`Absent`] has one that does nothing. An operation that a declaration has to ask for is a method of
//! [`Asked`] instead: every stepper has a method of its name.

use clebsch::{
    Clebsch, Conserves, Differentiated, Error, Method, Reacting, Space, State, Stepper, Tangent, Variational,
};
use nalgebra::SVector;

/// The steps of a plan, and the edges of a path.
pub const STEPS: usize = 16;

/// Operations that a stepper does not have itself.
pub trait Absent<S: Clebsch, M: Method<S>> {
    fn suggest_step_size(&self, _: &State<S, M>, _: S::Scalar, _: S::Scalar) {}
    fn state_at(&self, _: S::Scalar, _: S::Configuration, _: S::Momentum) {}
    fn cotangent_state_at(&self, _: S::Scalar, _: S::Configuration, _: S::Configuration) {}
    fn staggered_state_at(&self, _: S::Scalar, _: S::Configuration, _: S::Momentum) {}
    fn inverse_legendre(&self, _: &S::Configuration, _: &S::Momentum) {}
}

impl<S: Clebsch, M: Method<S>> Absent<S, M> for Stepper<S, M> {}

/// A stepper with the operations that its declaration asks for.
pub struct Asked<'a, S: Clebsch, M: Method<S>>(pub &'a Stepper<S, M>);

impl<S: Conserves, M: Method<S>> Asked<'_, S, M> {
    #[inline]
    pub fn conserved(&self, state: &State<S, M>) -> S::Conserved {
        self.0.conserved(state)
    }
}

impl<S, M, const N: usize> Asked<'_, S, M>
where
    S: Variational<N> + Clebsch<Momentum = SVector<<S as Clebsch>::Scalar, N>>,
    M: Differentiated<S, N>,
{
    #[inline]
    pub fn step_tangent(&self, state: &State<S, M>) -> Result<(State<S, M>, Tangent<S::Scalar, N>), Error> {
        self.0.step_tangent(state)
    }
}

impl<S: Reacting<M>, M: Method<S>> Asked<'_, S, M> {
    #[inline]
    pub fn reactions(&self, state: &State<S, M>, u: &S::Input) -> Result<(State<S, M>, [S::Reactions; 2]), Error> {
        let now = self.0.reactions_under(state, u)?;
        let (next, reactions) = self.0.step_with_reactions_under(state, u)?;
        Ok((next, [now, reactions]))
    }
}

/// Operations that a declaration does not ask for.
pub trait Unasked<S: Clebsch, M: Method<S>> {
    fn conserved(&self, _: &State<S, M>) {}
    fn step_tangent(&self, _: &State<S, M>) {}
    fn reactions(&self, _: &State<S, M>, _: &S::Input) {}
}

impl<S: Clebsch, M: Method<S>> Unasked<S, M> for Asked<'_, S, M> {}

/// Whether an operation succeeds, under the name `clebsch.operation.system`.
#[macro_export]
macro_rules! export {
    ($operation:literal, $system:literal, |$($argument:ident: $type:ty),* $(,)?| $body:block) => {
        const _: () = {
            #[unsafe(export_name = concat!("clebsch.", $operation, ".", $system))]
            extern "C" fn root($($argument: $type),*) -> bool {
                #[inline(always)]
                fn operation($($argument: $type),*) -> Result<(), clebsch::Error> {
                    $body
                    Ok(())
                }
                operation($($argument),*).is_ok()
            }
        };
    };
}

/// A field on a grid, with all that its stepper can do.
#[macro_export]
macro_rules! spreading {
    ($name:literal, $type:ty, $directions:literal $(, $momenta:literal)?) => {
        const _: () = {
            use clebsch::{Clebsch, Field, FieldState, FieldStepper, Grid, Sides};

            type S = $type;
            type T = <S as Clebsch>::Scalar;
            type Q = <S as Clebsch>::Configuration;
            type N = <S as Clebsch>::Momentum;
            type Stepper = FieldStepper<S, Grid<T, $directions>>;
            type State<'a> = FieldState<&'a mut [Q], &'a mut [N], <S as Clebsch>::Time>;

            $crate::export!("stepper", $name, |system: &S,
                                               sizes: &[usize; $directions],
                                               spacing: &[T; $directions],
                                               sides: &[Sides; $directions],
                                               h: &T,
                                               made: &mut Option<Stepper>| {
                *made = Some(system.grid(*sizes).spacing(*spacing).sides(*sides).stepper(*h)?);
            });
            $crate::export!("state", $name, |stepper: &Stepper, q: &mut [Q], mu: &mut [N], energy: &mut T| {
                *energy = stepper.energy(&stepper.state(q, mu)?)?;
            });
            $crate::export!("step", $name, |stepper: &Stepper, state: &mut State<'_>| {
                stepper.step(state)?;
            });
            $crate::export!("advance", $name, |stepper: &Stepper, state: &mut State<'_>, steps: u64| {
                stepper.advance(state, steps)?;
            });
            $crate::export!("step_with", $name, |stepper: &Stepper,
                                                 state: &mut State<'_>,
                                                 u: &[<S as Clebsch>::Input]| {
                stepper.step_with(state, u)?;
            });
            $crate::export!("stable_step", $name, |stepper: &Stepper, state: &mut State<'_>, h: &mut T| {
                *h = stepper.stable_step(state)?;
                stepper.check_stable(state)?;
            });
            $($crate::export!("residuals", $name, |stepper: &Stepper,
                                                   state: &mut State<'_>,
                                                   residuals: &mut [[T; $momenta]]| {
                stepper.step_with_residuals(state, residuals)?;
            });)?
        };
    };
}

/// A field at rest on a grid.
#[macro_export]
macro_rules! resting {
    ($name:literal, $type:ty, $directions:literal) => {
        const _: () = {
            use clebsch::{Clebsch, Field, Relaxed, Sides};

            type S = $type;
            type T = <S as Clebsch>::Scalar;
            type Q = <S as Clebsch>::Configuration;

            $crate::export!("relax", $name, |system: &S,
                                             sizes: &[usize; $directions],
                                             spacing: &[T; $directions],
                                             sides: &[Sides; $directions],
                                             q: &mut [Q],
                                             found: &mut Option<Relaxed<T>>| {
                *found = Some(system.grid(*sizes).spacing(*spacing).sides(*sides).relax().solve(q)?);
            });
        };
    };
}

/// A stepper with all that it can do, by the declared dials or by a method.
#[macro_export]
macro_rules! stepping {
    ($name:literal, $type:ty) => {
        $crate::stepping!($name, $type, clebsch::Declared);
    };
    ($name:literal, $type:ty, $method:ty) => {
        const _: () = {
            use clebsch::{Clebsch, CotangentState, Integrator, SavedState, State, Stepper};
            use core::hint::black_box;
            #[allow(unused_imports, reason = "a system may have it all")]
            use $crate::roots::{self, Absent, Asked, Unasked};

            type S = $type;
            type M = $method;
            type T = <S as Clebsch>::Scalar;
            type Q = <S as Clebsch>::Configuration;
            type N = <S as Clebsch>::Momentum;

            $crate::export!("stepper", $name, |system: &S, h: &T, made: &mut Option<Stepper<S, M>>| {
                *made = Some(roots::stepper(system, *h)?);
            });
            $crate::export!("state", $name, |stepper: &Stepper<S, M>, q: &Q, mu: &N, made: &mut State<S, M>| {
                *made = stepper.state(*q, *mu)?;
            });
            $crate::export!("staggered", $name, |stepper: &Stepper<S, M>, q: &Q, mu: &N, made: &mut State<S, M>| {
                *made = stepper.staggered_state(*q, *mu)?;
            });
            $crate::export!("timed", $name, |stepper: &Stepper<S, M>, t: &T, q: &Q, mu: &N| {
                let _ = black_box(stepper.state_at(*t, *q, *mu));
                let _ = black_box(stepper.cotangent_state_at(*t, *q, *q));
                let _ = black_box(stepper.staggered_state_at(*t, *q, *mu));
            });
            $crate::export!(
                "cotangent",
                $name,
                |stepper: &Stepper<S, M>, q: &Q, p: &Q, made: &mut CotangentState<S>| {
                    *made = stepper.cotangent_state(*q, *p)?;
                }
            );
            $crate::export!("project", $name, |stepper: &Stepper<S, M>, q: &Q, mu: &N, made: &mut State<S, M>| {
                *made = stepper.project(*q, *mu)?;
            });
            $crate::export!("resume", $name, |stepper: &Stepper<S, M>,
                                              saved: &SavedState<S, M>,
                                              made: &mut State<S, M>| {
                *made = stepper.resume(*saved)?;
            });
            $crate::export!("step", $name, |stepper: &Stepper<S, M>, state: &mut State<S, M>| {
                *state = stepper.step(state)?;
            });
            $crate::export!("step_with", $name, |stepper: &Stepper<S, M>,
                                                 state: &mut State<S, M>,
                                                 u: &<S as Clebsch>::Input| {
                *state = stepper.step_with(state, u)?;
            });
            $crate::export!("integrator", $name, |integrator: &mut Integrator<S, M>, u: &<S as Clebsch>::Input| {
                integrator.step_with(u)?;
                integrator.advance(2)?;
            });
            $crate::export!("step_each", $name, |stepper: &Stepper<S, M>, state: &mut State<S, M>| {
                *state = stepper.step_each(state).0;
            });
            $crate::export!("failure", $name, |stepper: &Stepper<S, M>, state: &State<S, M>, lane: usize| {
                stepper.failure(state, lane).map_or(Ok(()), Err)?;
            });
            $crate::export!("step_symmetric", $name, |stepper: &Stepper<S, M>, state: &mut CotangentState<S>| {
                *state = stepper.step_symmetric(state)?;
            });
            $crate::export!("step_tangent", $name, |stepper: &Stepper<S, M>, state: &State<S, M>| {
                let _ = black_box(Asked(stepper).step_tangent(state));
            });
            $crate::export!("reactions", $name, |stepper: &Stepper<S, M>,
                                                 state: &State<S, M>,
                                                 u: &<S as Clebsch>::Input| {
                let _ = black_box(Asked(stepper).reactions(state, u));
            });
            $crate::export!("advance", $name, |stepper: &Stepper<S, M>, state: &mut State<S, M>, steps: usize| {
                *state = stepper.advance(state, steps)?;
            });
            $crate::export!("trajectory", $name, |stepper: &Stepper<S, M>, state: &mut State<S, M>, steps: usize| {
                for next in stepper.trajectory(*state).take(steps) {
                    *state = next?;
                }
            });
            $crate::export!("suggest_step_size", $name, |stepper: &Stepper<S, M>,
                                                         state: &State<S, M>,
                                                         error: &T,
                                                         time: &T| {
                let _ = black_box(stepper.suggest_step_size(state, *error, *time));
            });
            $crate::export!("energies", $name, |stepper: &Stepper<S, M>,
                                                state: &State<S, M>,
                                                energies: &mut [T; 3]| {
                *energies = [stepper.energy(state), stepper.kinetic_energy(state), stepper.synchronized_energy(state)];
            });
            $crate::export!("momenta", $name, |stepper: &Stepper<S, M>, state: &State<S, M>, mu: &mut N| {
                let _ = black_box(Asked(stepper).conserved(state));
                *mu = stepper.synchronized(state);
            });
            $crate::export!("formulas", $name, |stepper: &Stepper<S, M>, t: &T, q: &Q, p: &Q, mu: &mut N| {
                roots::formulas(stepper, *t, q, p, mu)?;
            });
            $crate::export!("inverse_legendre", $name, |stepper: &Stepper<S, M>, q: &Q, mu: &N| {
                let _ = black_box(stepper.inverse_legendre(q, mu));
            });
        };
    };
}

/// A stepper of step size `h`.
#[inline]
pub fn stepper<S: Clebsch + Clone, M: Method<S>>(system: &S, h: S::Scalar) -> Result<Stepper<S, M>, Error> {
    system.stepper_by::<M>(h)
}

/// The derived formulas, apart from steps.
#[inline]
pub fn formulas<S: Clebsch, M: Method<S>>(
    stepper: &Stepper<S, M>,
    t: S::Scalar,
    q: &S::Configuration,
    p: &S::Configuration,
    mu: &mut S::Momentum,
) -> Result<(), Error> {
    let f = stepper.inverse_legendre_at(t, q, mu)?;
    *mu = stepper.legendre_at(t, q, &f).zip_map(&stepper.legendre_next_at(t, q, &f), |a, b| a + b);
    *mu = stepper.coadjoint(&f, mu).zip_map(&stepper.momentum_map(&stepper.act(&f, q), p), |a, b| a + b);
    *mu = stepper.momentum_components(&stepper.momentum_matrix(mu));
    core::hint::black_box(stepper.potential_at(t, q));
    Ok(())
}

/// Derivatives of steps by everything that is fixed during them.
#[macro_export]
macro_rules! sensitive {
    ($name:literal, $type:ty) => {
        $crate::export!(
            "step_sensitivity",
            $name,
            |stepper: &clebsch::Stepper<$type>, state: &clebsch::State<$type>| {
                let _ = core::hint::black_box(stepper.step_sensitivity(state));
            }
        );
    };
}

/// A path between places.
pub trait Path {
    /// Its vertices.
    type Nodes;
}

impl<S, T: clebsch::Real, const M: usize> Path for S
where
    S: Clebsch<Scalar = T, Momentum = nalgebra::SVector<T, M>> + clebsch::Variational<M>,
{
    type Nodes = [clebsch::Node<S, M>; STEPS];
}

/// Extremals between fixed and free ends.
#[macro_export]
macro_rules! connecting {
    ($name:literal, $type:ty) => {
        const _: () = {
            use clebsch::{Clebsch, Guess, Stepper};

            type S = $type;
            type T = <S as Clebsch>::Scalar;
            type Q = <S as Clebsch>::Configuration;
            type Nodes = <S as $crate::roots::Path>::Nodes;

            $crate::export!("connect", $name, |stepper: &Stepper<S>,
                                               ends: &[Q; 2],
                                               path: &mut Nodes,
                                               action: &mut T| {
                let boundary = stepper.boundary();
                path.fill(boundary.rest(&ends[0]));
                *action = boundary.solve(&ends[0], &ends[1], Guess::Geodesic, path)?.action();
            });
            $crate::export!("connect_free", $name, |stepper: &Stepper<S>,
                                                    start: &Q,
                                                    path: &mut Nodes,
                                                    action: &mut T| {
                *action = stepper.boundary().solve_free(start, Guess::Path, path)?.action();
            });
            $crate::export!(
                "connect_free_time",
                $name,
                |stepper: &Stepper<S>, ends: &[Q; 2], path: &mut Nodes, h: &mut [T; 2]| {
                    let steps = h[0]..=h[1];
                    h[0] = stepper.boundary().free_time(&ends[0], Some(&ends[1]), steps, Guess::Path, path)?;
                }
            );
            $crate::export!("connect_several", $name, |stepper: &Stepper<S>,
                                                       ends: &[Q; 2],
                                                       path: &mut Nodes,
                                                       action: &mut T| {
                let ways: [Option<clebsch::Way<_, _>>; 2] = stepper.boundary().several(&ends[0], &ends[1], path)?;
                *action = ways.into_iter().flatten().fold(*action, |sum, way| sum + way.action);
            });
        };
    };
}

/// The types of plans of a system: its scalar T, places X and stages.
#[macro_export]
macro_rules! types_of_plans {
    ($type:ty, $d:literal, $u:literal, $c:literal) => {
        type S = $type;
        type T = <S as clebsch::Controlled<$d, $u, $c>>::Scalar;
        type X = <S as clebsch::Controlled<$d, $u, $c>>::Place;
        type Stages = [clebsch::Stage<S, $d, $u, $c>; $crate::roots::STEPS];
    };
}

/// Plans with a start that is unknown.
#[macro_export]
macro_rules! estimating {
    ($name:literal, $type:ty, $d:literal, $u:literal, $c:literal) => {
        const _: () = {
            use clebsch::{Control, Limits, Prior, Target};
            use nalgebra::SMatrix;

            $crate::types_of_plans!($type, $d, $u, $c);
            type Estimator = clebsch::Estimator<S, $d, $u, $c>;

            $crate::export!("prior", $name, |control: &Control<S, $d, $u, $c>,
                                             prior: &Prior<X, T, $d>,
                                             made: &mut Option<Estimator>| {
                *made = Some(control.clone().with_prior(*prior)?);
            });
            $crate::export!("estimate", $name, |control: &Estimator, guess: &X, plan: &mut Stages, end: &mut X| {
                *end = *control.solve(guess, Target::Free, plan)?.end();
            });
            $crate::export!(
                "slide",
                $name,
                |control: &mut Estimator, plan: &mut Stages, end: &mut X, information: &mut SMatrix<T, $d, $d>| {
                    control.slide(plan, 1)?;
                    *end = *control.solve_within(end, Target::Free, Limits { sweeps: 1 }, plan)?.end();
                    *information = control.end_information(plan)?;
                }
            );
        };
    };
}

/// Plans of least price.
#[macro_export]
macro_rules! planning {
    ($name:literal, $type:ty, $d:literal, $u:literal, $c:literal) => {
        const _: () = {
            use clebsch::{Control, Controlled, Limits, Target};

            $crate::types_of_plans!($type, $d, $u, $c);

            $crate::export!("control", $name, |system: &S, h: &T, made: &mut Option<Control<S, $d, $u, $c>>| {
                *made = Some(system.clone().control(*h)?);
            });
            $crate::export!("plan", $name, |control: &Control<S, $d, $u, $c>,
                                            ends: &[X; 2],
                                            plan: &mut Stages,
                                            price: &mut T| {
                plan.fill(control.stage(&ends[0]));
                *price = control.solve(&ends[0], Target::Place(ends[1]), plan)?.price();
            });
            $crate::export!("plan_along", $name, |control: &Control<S, $d, $u, $c>,
                                                  places: &[X; $crate::roots::STEPS],
                                                  plan: &mut Stages,
                                                  price: &mut T| {
                let [start, .., goal] = places;
                let path = |k: usize, _| places.get(k).copied().unwrap_or(*goal);
                *price = control.solve_along(start, Target::Place(*goal), path, plan)?.price();
            });
            $crate::export!("plan_within", $name, |control: &Control<S, $d, $u, $c>,
                                                   ends: &[X; 2],
                                                   plan: &mut Stages,
                                                   gap: &mut T| {
                control.shift(plan, 1);
                let limits = Limits { sweeps: 4 };
                *gap = control.solve_within(&ends[0], Target::Place(ends[1]), limits, plan)?.gap();
            });
            $crate::export!("plan_free_time", $name, |control: &Control<S, $d, $u, $c>,
                                                      ends: &[X; 2],
                                                      plan: &mut Stages,
                                                      h: &mut [T; 2]| {
                let target = Target::Configuration(ends[1]);
                h[0] = control.solve_free_time(&ends[0], target, h[0]..=h[1], plan)?.step_size();
            });
            $crate::export!("follow", $name, |control: &Control<S, $d, $u, $c>,
                                              plan: &Stages,
                                              start: &X,
                                              place: &mut X| {
                *place = control.follow_with(start, &control.feedback(&plan[0], place), plan[0].reference())?;
            });
        };
    };
}
