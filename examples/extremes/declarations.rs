//! Three scenes, each declared with several dials, over any scalar.

use crate::probe::{Dial, Scene, Setup, dial};
use clebsch::{Clebsch, DoubleDouble, Error, Real, State, Stepper};
use clebsch_examples::counted::Counted;
use nalgebra::{Matrix3, Vector3};

fn matrix<T: Real>(entries: &Matrix3<f64>) -> Matrix3<T> {
    entries.map(T::from_f64)
}

fn vector<T: Real>(entries: &Vector3<f64>) -> Vector3<T> {
    entries.map(T::from_f64)
}

fn diagonal<T: Real>(moments: &[f64; 3]) -> Matrix3<T> {
    Matrix3::from_diagonal(&Vector3::from(*moments).map(T::from_f64))
}

/// The state of a body with the attitude and the momentum of the setup.
fn at_attitude<T: Real, S>(setup: &Setup, stepper: &Stepper<S>) -> Result<State<S>, Error>
where
    S: Clebsch<Scalar = T, Configuration = Matrix3<T>, Momentum = Vector3<T>>,
{
    stepper.state(matrix(&setup.attitude), vector(&setup.momentum))
}

/// R row by row, then π.
fn numbers_of_body<T: Real>(r: &Matrix3<T>, pi: &Vector3<T>) -> Vec<f64> {
    r.transpose().iter().chain(pi.iter()).map(|x| x.to_f64()).collect()
}

/// A body of which nothing but its own rotation is known, with each list of dials.
macro_rules! bodies {
    ($(#[$documentation:meta])* $list:ident: $($module:ident, $name:literal, {$($dials:tt)*};)*) => {
        $(pub mod $module {
            use super::*;

            /// A body that nothing acts on.
            #[derive(Clebsch, Clone, Debug)]
            #[clebsch(
                action     = |F: SO<3>, R: SO<3>| R * F,
                lagrangian = |omega| omega.dot(&(self.inertia * omega)) / 2,
                $($dials)*
            )]
            pub struct Body<T: clebsch::Scalar> {
                /// Inertia tensor about the centre of mass, kg·m².
                #[clebsch(symmetric)]
                pub inertia: Matrix3<T>,
            }

            impl<T: Real> Scene for Body<T> {
                fn of(setup: &Setup) -> Self {
                    Self { inertia: diagonal(&setup.moments) }
                }
                fn start(setup: &Setup, stepper: &Stepper<Self>) -> Result<State<Self>, Error> {
                    at_attitude(setup, stepper)
                }
                fn numbers(state: &State<Self>) -> Vec<f64> {
                    numbers_of_body(state.configuration(), &state.momentum())
                }
                fn conserved(stepper: &Stepper<Self>, state: &State<Self>) -> [f64; 3] {
                    stepper.conserved(state).values().map(|value| value.to_f64())
                }
            }
        })*

        $(#[$documentation])*
        pub fn $list() -> Vec<Dial> {
            vec![$(dial!($name, "free body", $module::Body<Counted<f64>>, $module::Body<Counted<f32>>, beside $module::Body<DoubleDouble>)),*]
        }
    };
}
bodies! {
    /// The free body.
    bodies:
    body_moser_veselov, "moser_veselov", { discretization = moser_veselov };
    body_cayley, "cayley", { discretization = cayley };
    body_exponential, "exponential", { discretization = exponential };
    body_projection, "projection", { discretization = projection };
    body_exact, "exact", { discretization = exact };
    body_collocated, "order = 16", { order = 16 };
    body_compensated, "compensated", { discretization = moser_veselov, summation = compensated };
}

bodies! {
    /// The free body by Cayley's map, with the dials of how its equation is solved.
    solves:
    solved_by_newton, "newton", { discretization = cayley, solver = newton };
    solved_by_fixed_point, "fixed_point", { discretization = cayley, solver = fixed_point };
    solved_to_tolerance, "tolerance = 1e-6", { discretization = cayley, tolerance = 1e-6 };
    solved_in_four, "iterations = 4", { discretization = cayley, iterations = 4 };
    solved_in_exponentials, "chart = exponential", { discretization = moser_veselov, chart = exponential };
}

macro_rules! tops {
    ($($module:ident, $name:literal, {$($dials:tt)*};)*) => {
        $(pub mod $module {
            use super::*;

            /// A body turning about a pivot in uniform gravity.
            #[derive(Clebsch, Clone, Debug)]
            #[clebsch(
                action     = |F: SO<3>, R: SO<3>| R * F,
                lagrangian = |omega| omega.dot(&(self.inertia * omega)) / 2,
                potential  = |R| self.weight * (R * self.center).z,
                $($dials)*
            )]
            pub struct Top<T: clebsch::Scalar> {
                /// Inertia tensor about the pivot, kg·m².
                #[clebsch(symmetric)]
                pub inertia: Matrix3<T>,
                /// m·g, N.
                pub weight: T,
                /// Centre of mass in the body frame, m.
                pub center: Vector3<T>,
            }

            impl<T: Real> Scene for Top<T> {
                fn of(setup: &Setup) -> Self {
                    Self { inertia: diagonal(&setup.moments), weight: T::from_f64(setup.weight), center: vector(&setup.arm) }
                }
                fn start(setup: &Setup, stepper: &Stepper<Self>) -> Result<State<Self>, Error> {
                    at_attitude(setup, stepper)
                }
                fn numbers(state: &State<Self>) -> Vec<f64> {
                    numbers_of_body(state.configuration(), &state.momentum())
                }
                fn conserved(stepper: &Stepper<Self>, state: &State<Self>) -> [f64; 3] {
                    [stepper.conserved(state).values()[0].to_f64(), 0.0, 0.0]
                }
            }
        })*

        /// The heavy top.
        pub fn tops() -> Vec<Dial> {
            vec![$(dial!($name, "heavy top", $module::Top<Counted<f64>>, $module::Top<Counted<f32>>, beside $module::Top<DoubleDouble>)),*]
        }
    };
}
tops! {
    top_moser_veselov, "moser_veselov", { discretization = moser_veselov };
    top_cayley, "cayley", { discretization = cayley };
    top_exact, "exact, order 4", { discretization = exact, order = 4 };
    top_eighth, "moser_veselov, order 8", { discretization = moser_veselov, order = 8 };
    top_collocated, "order = 16", { order = 16 };
    top_compensated, "compensated", { discretization = moser_veselov, summation = compensated };
}

macro_rules! pendulums {
    ($($module:ident, $name:literal, {$($dials:tt)*};)*) => {
        $(pub mod $module {
            use super::*;

            /// A bob on a rigid massless rod.
            #[derive(Clebsch, Clone, Debug)]
            #[clebsch(
                action    = |F: SO<3>, q: Unit<Vector3>| F * q,
                potential = |q| self.weight * self.arm * q.z,
                $($dials)*
            )]
            pub struct Pendulum<T: clebsch::Scalar> {
                /// m·l², kg·m².
                pub inertia: T,
                /// m·g, N.
                pub weight: T,
                /// Length of the rod, m.
                pub arm: T,
            }

            impl<T: Real> Scene for Pendulum<T> {
                fn of(setup: &Setup) -> Self {
                    let [inertia, weight, arm] = [setup.moments[0], setup.weight, setup.arm.norm()].map(T::from_f64);
                    Self { inertia, weight, arm }
                }
                fn start(setup: &Setup, stepper: &Stepper<Self>) -> Result<State<Self>, Error> {
                    let q = vector(&setup.attitude.column(2).into_owned());
                    let n = stepper.project(&q, &vector(&setup.momentum))?;
                    stepper.state(q, n)
                }
                fn numbers(state: &State<Self>) -> Vec<f64> {
                    state.configuration().iter().chain(state.momentum().iter()).map(|x| x.to_f64()).collect()
                }
                fn conserved(stepper: &Stepper<Self>, state: &State<Self>) -> [f64; 3] {
                    [stepper.conserved(state).values()[0].to_f64(), 0.0, 0.0]
                }
            }
        })*

        /// The spherical pendulum.
        pub fn pendulums() -> Vec<Dial> {
            vec![$(dial!($name, "spherical pendulum", $module::Pendulum<Counted<f64>>, $module::Pendulum<Counted<f32>>, beside $module::Pendulum<DoubleDouble>)),*]
        }
    };
}
pendulums! {
    pendulum_chord, "chord", { cost = |h, F| self.inertia * (F - I).norm_squared() / (4 * h) };
    pendulum_exponential, "exponential, order 4", { lagrangian = |omega| self.inertia * omega.dot(&omega) / 2, discretization = exponential, order = 4 };
    pendulum_collocated, "order = 16", { lagrangian = |omega| self.inertia * omega.dot(&omega) / 2, order = 16 };
    pendulum_compensated, "compensated", { cost = |h, F| self.inertia * (F - I).norm_squared() / (4 * h), summation = compensated };
}
