//! Combinations of dials that no fixture has, each with small systems: sums, forms of code, orders, charts, solvers, lanes and single precision.

#[path = "../../laws/tests/compositions/systems.rs"]
mod compositions;
#[path = "../../laws/tests/exact/systems.rs"]
mod exact;
#[path = "combinations/forms.rs"]
mod forms;
#[path = "../../laws/tests/lanes/systems.rs"]
mod lanes;
#[path = "../../laws/tests/summation/systems.rs"]
mod summation;

use crate::lift::Lift;
use crate::run::Task;
use clebsch::{F32x8, F64x4, Method, Scalar};
use clebsch_tests::scenes::{centre, four, inertia, placed, principal, quaternion, turned, unit};
use nalgebra::*;

/// Systems over a scalar, by module and name.
macro_rules! over {
    ($task:ident, $suffix:literal, $scalar:ty: $($module:ident::$($path:ident)::+ { $($field:ident: $value:expr),* }, $q:expr, $h:expr;)*) => {$({
        let number = |x: f64| <$scalar as Scalar>::from_f64(x);
        let name = concat!(stringify!($module), $("_", stringify!($path),)+ $suffix);
        let system = $module::$($path)::+::<$scalar> { $($field: Lift::lift($value, number)),* };
        $task.combination(name, system, Lift::lift($q, number), number($h));
    })*};
}

/// The systems of the tests of sums.
macro_rules! sums {
    ($task:ident, $suffix:literal, $scalar:ty, $sums:ident) => {
        over! { $task, $suffix, $scalar:
            summation::$sums::Body { moments: principal() }, turned(), 0.05;
            summation::$sums::Pendulum { gravity: 9.81 }, unit(), 0.05;
            summation::$sums::First { gravity: 9.81 }, unit(), 0.05;
            summation::$sums::Quaternions { moments: principal(), weight: 1.3 }, quaternion(), 0.05;
            summation::$sums::Composed { moments: principal(), weight: 1.3 }, turned(), 0.05;
            summation::$sums::Split { moments: principal(), weight: 1.3 }, turned(), 0.05;
            summation::$sums::Exact { moments: principal() }, turned(), 0.05;
            summation::$sums::Driven { rate: 2.0 }, Vector2::new(1.0, 0.25), 0.05;
            summation::$sums::Lopsided { stiffness: 2.0 }, Vector2::new(1.0, 0.25), 0.05;
            summation::$sums::Damped { moments: principal(), damping: 0.1 }, turned(), 0.05;
            summation::$sums::Flying { moments: principal() }, (placed(), Vector2::new(1.0, 0.5)), 0.05;
            summation::$sums::Shape { stiffness: 1.2 }, Matrix2::identity(), 0.02;
        }
        $task.combination(
            concat!("summation_", stringify!($sums), "_Alone", $suffix),
            summation::$sums::Alone { moments: principal().map(<$scalar as Scalar>::from_f64) },
            (),
            <$scalar as Scalar>::from_f64(0.05),
        );
    };
}

/// The small systems by one method.
fn by_method<M>(task: &impl Task, name: &str)
where
    M: Method<forms::Top<f64>> + Method<forms::Pendulum<f64>> + Method<forms::Body4<f64>>,
{
    let name = |system: &str| format!("forms_{name}_{system}");
    let top = forms::Top { inertia: inertia(), weight: 1.3, center: centre() };
    task.combination_by::<_, M>(&name("Top"), top, turned(), 0.05);
    task.combination_by::<_, M>(&name("Pendulum"), forms::Pendulum { gravity: 9.81 }, unit(), 0.05);
    task.combination_by::<_, M>(&name("Body4"), forms::Body4 { j_d: four() }, Matrix4::identity(), 0.05);
}

/// Some of them in lanes.
fn methods_in_lanes(task: &impl Task) {
    let number = |x: f64| <F64x4 as Scalar>::from_f64(x);
    let inertia = Lift::lift(inertia(), number);
    let top = forms::Top { inertia, weight: number(1.3), center: Lift::lift(centre(), number) };
    let start = Lift::lift(turned(), number);
    task.combination_by::<_, forms::Matrices>("forms_matrices_Top_lanes", top, start, number(0.05));
    let body = forms::Body4 { j_d: Lift::lift(four(), number) };
    let (start, name) = (Lift::lift(Matrix4::identity(), number), "forms_matrices_compensated_Body4_lanes");
    task.combination_by::<_, forms::MatricesCompensated>(name, body, start, number(0.05));
}

pub fn all(task: &impl Task) {
    sums!(task, "", f64, plain);
    sums!(task, "", f64, compensated);
    sums!(task, "_f32", f32, compensated);
    sums!(task, "_lanes", F64x4, compensated);
    over! { task, "_lanes", F64x4:
        summation::plain::First { gravity: 9.81 }, unit(), 0.05;
        summation::plain::Quaternions { moments: principal(), weight: 1.3 }, quaternion(), 0.05;
        summation::plain::Composed { moments: principal(), weight: 1.3 }, turned(), 0.05;
        summation::plain::Driven { rate: 2.0 }, Vector2::new(1.0, 0.25), 0.05;
        summation::plain::Lopsided { stiffness: 2.0 }, Vector2::new(1.0, 0.25), 0.05;
        summation::plain::Damped { moments: principal(), damping: 0.1 }, turned(), 0.05;
        summation::plain::Shape { stiffness: 1.2 }, Matrix2::identity(), 0.02;
        lanes::Body { moments: principal() }, turned(), 0.05;
        lanes::TolerantBody { moments: principal() }, turned(), 0.05;
        lanes::FixedBody { moments: principal() }, turned(), 0.05;
        lanes::SixthTop { mass_matrix: inertia(), weight: 1.3, center: centre() }, turned(), 0.05;
        lanes::ExactBody { inertia: inertia() }, turned(), 0.05;
        lanes::ExactBody4 { mass: four() }, Matrix4::identity(), 0.05;
        lanes::SplitTop { inertia: inertia(), weight: 1.3, center: centre() }, turned(), 0.05;
        lanes::CollocatedTop { moments: principal(), weight: 1.3 }, quaternion(), 0.05;
        lanes::Pendulum { mass: 1.5, length: 0.8, gravity: 9.81 }, unit(), 0.05;
        lanes::Body4 { j_d: four() }, Matrix4::identity(), 0.05;
        lanes::Satellite { inertia: inertia(), weight: 0.7 }, turned(), 0.05;
        lanes::Flyer { mass: 2.0, inertia: inertia(), arm: centre() }, (centre(), turned()), 0.02;
    }
    over! { task, "_f32_lanes", F32x8:
        lanes::Top { mass_matrix: inertia(), weight: 1.3, center: centre() }, turned(), 0.05;
        lanes::CompensatedBody { moments: principal() }, turned(), 0.05;
    }
    over! { task, "", f64:
        lanes::TolerantBody { moments: principal() }, turned(), 0.05;
        lanes::FixedBody { moments: principal() }, turned(), 0.05;
        lanes::Satellite { inertia: inertia(), weight: 0.7 }, turned(), 0.05;
        lanes::Flyer { mass: 2.0, inertia: inertia(), arm: centre() }, (centre(), turned()), 0.02;
    }
    by_method::<forms::Unrolled>(task, "unrolled");
    by_method::<forms::Matrices>(task, "matrices");
    by_method::<forms::UnrolledCompensated>(task, "unrolled_compensated");
    by_method::<forms::MatricesCompensated>(task, "matrices_compensated");
    by_method::<forms::MatricesFirst>(task, "matrices_first");
    by_method::<forms::MatricesFourth>(task, "matrices_fourth");
    by_method::<forms::MatricesFourthCompensated>(task, "matrices_fourth_compensated");
    by_method::<forms::UnrolledSixteenth>(task, "unrolled_sixteenth");
    by_method::<forms::SixteenthCompensated>(task, "sixteenth_compensated");
    by_method::<forms::LooseSixteenth>(task, "loose_sixteenth");
    by_method::<forms::Exponential>(task, "exponential");
    by_method::<forms::Tolerant>(task, "tolerant");
    by_method::<forms::FixedPoint>(task, "fixed_point");
    by_method::<forms::Iterated>(task, "iterated");
    methods_in_lanes(task);
    orders(task);
    drifts(task);
}

fn orders(task: &impl Task) {
    macro_rules! orders {
        ($($order:ident)*) => {$({
            use compositions::$order::*;
            let name = |system: &str| format!("composed_{}_{system}", stringify!($order));
            task.combination(&name("Pendulum"), Pendulum { gravity: 9.81 }, unit(), 0.05);
            task.combination(&name("Driven"), Driven { rate: 2.0 }, Vector2::new(1.0, 0.25), 0.05);
            task.combination(&name("Lopsided"), Lopsided { stiffness: 2.0 }, Vector2::new(1.0, 0.25), 0.05);
            task.combination(&name("Damped"), Damped { inertia: inertia(), damping: 0.1 }, turned(), 0.05);
            task.combination(&name("Body4"), Body4 { j_d: four() }, Matrix4::identity(), 0.05);
        })*};
    }
    orders!(first fourth eighth);
}

fn drifts(task: &impl Task) {
    macro_rules! drifts {
        ($($order:ident)*) => {$({
            use exact::$order::*;
            let name = |system: &str| format!("exact_{}_{system}", stringify!($order));
            task.combination(&name("Top"), Top { inertia: inertia(), weight: 1.3, center: centre() }, turned(), 0.05);
            task.combination(&name("Satellite"), Satellite { moments: principal(), orbital_rate: 0.8 }, turned(), 0.05);
            task.combination(&name("Pendulum"), Pendulum { gravity: 9.81, waves: 0.4 }, unit(), 0.05);
        })*};
    }
    drifts!(second fourth sixth eighth sixteenth);
    use exact::fourth::*;
    let flying = Flying { mass: 1.2, moments: principal(), hook: centre(), stiffness: 2.0 };
    task.combination("exact_fourth_Flying", flying, (centre(), turned()), 0.05);
    let top = QuaternionTop { moments: principal(), moment: centre() };
    task.combination("exact_fourth_QuaternionTop", top, quaternion(), 0.05);
    let top = MirroredTop { moments: principal(), moment: centre() };
    task.combination("exact_fourth_MirroredTop", top, turned(), 0.05);
    let pendulum = OpaquePendulum { gravity: 9.81, waves: 0.4 };
    task.combination("exact_fourth_OpaquePendulum", pendulum, unit(), 0.05);
}
