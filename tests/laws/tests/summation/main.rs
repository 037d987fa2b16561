//! Steps with compensated sums: errors of rounding are those of the increments, not of the state.
//!
//! `cargo test --release -p clebsch-laws --features heavy --test summation -- --nocapture` prints the errors of plain and of compensated sums.

#![allow(missing_docs)]

mod systems;

use clebsch::{Clebsch, Error, Scalar, State, Stepper};
use nalgebra::{Matrix2, Matrix3, Matrix4, Quaternion, SVector, Vector3};

use systems::{compensated, plain};

/// Steps, and a size of them that every precision knows.
const STEPS: usize = 20_000;
const H: f64 = 1.0 / 128.0;

/// All numbers of a state after the steps, in double precision.
trait Numbers {
    fn numbers(&self) -> Vec<f64>;
}

impl<T: Scalar, const R: usize, const C: usize> Numbers for nalgebra::SMatrix<T, R, C> {
    fn numbers(&self) -> Vec<f64> {
        self.iter().map(|x| x.to_f64()).collect()
    }
}

impl<T: Scalar> Numbers for Quaternion<T> {
    fn numbers(&self) -> Vec<f64> {
        self.coords.numbers()
    }
}

impl Numbers for () {
    fn numbers(&self) -> Vec<f64> {
        Vec::new()
    }
}

impl<A: Numbers, B: Numbers> Numbers for (A, B) {
    fn numbers(&self) -> Vec<f64> {
        [self.0.numbers(), self.1.numbers()].concat()
    }
}

/// q and N after all steps.
fn end<S>(system: S, start: impl Fn(&Stepper<S>) -> State<S>) -> [Vec<f64>; 2]
where
    S: Clebsch<Configuration: Numbers, Momentum: Numbers>,
{
    let stepper = system.into_stepper(S::Scalar::from_f64(H)).expect("parameters");
    let mut state = start(&stepper);
    for step in 0..STEPS {
        state = stepper.step(&state).unwrap_or_else(|error| panic!("step {step}: {error}"));
    }
    [state.configuration().numbers(), state.momentum().numbers()]
}

/// The largest difference of q and N, each over its largest entry.
fn error(one: &[Vec<f64>; 2], other: &[Vec<f64>; 2]) -> f64 {
    let differ = |one: &[f64], other: &[f64]| {
        let size = other.iter().fold(0.0, |size, x: &f64| x.abs().max(size));
        one.iter().zip(other).fold(0.0, |most, (a, b)| (a - b).abs().max(most)) / if size > 0.0 { size } else { 1.0 }
    };
    one.iter().zip(other).map(|(one, other)| differ(one, other)).fold(0.0, f64::max)
}

fn n<T: Scalar>(number: f64) -> T {
    T::from_f64(number)
}

fn v<T: Scalar, const N: usize>(entries: [f64; N]) -> SVector<T, N> {
    entries.map(T::from_f64).into()
}

/// For each system: the error of single precision relative to double precision, with plain and with compensated sums. Seven
/// systems are for the feature `heavy` alone.
fn errors() -> Vec<(&'static str, [f64; 2])> {
    macro_rules! of {
        ($($name:ident { $($field:ident: $value:expr),* } from ($q:expr, $mu:expr);)*) => { vec![$({
            macro_rules! ended {
                ($sums:ident, $scalar:ty) => {
                    end($sums::$name::<$scalar> { $($field: $value),* }, |stepper| stepper.state($q, $mu).expect("a state"))
                };
            }
            let exact = ended!(plain, f64);
            (stringify!($name), [error(&ended!(plain, f32), &exact), error(&ended!(compensated, f32), &exact)])
        }),*] };
    }
    let moments = [1.0, 1.5, 2.0];
    let spin = [0.25, 1.0, -0.5];
    let found = of! {
        Body { moments: v(moments) } from (Matrix3::identity(), v(spin));
        Pendulum { gravity: n(1.0) } from (Vector3::x(), v([0.0, 0.5, 0.75]));
        Quaternions { moments: v(moments), weight: n(1.0) } from (Quaternion::new(n(0.0), n(1.0), n(0.0), n(0.0)), v(spin));
        Split { moments: v([1.5, 1.5, 1.0]), weight: n(1.0) } from (Matrix3::identity(), v(spin));
        Exact { moments: v(moments) } from (Matrix3::identity(), v(spin));
        Flying { moments: v(moments) } from ((Matrix4::identity(), v([1.0, 0.0])), v([0.25, 1.0, -0.5, 0.5, 0.0, 0.25, 0.0, 1.0]));
        Shape { stiffness: n(1.0) } from (Matrix2::identity(), v([0.0, 0.5, -0.5]));
    };
    #[cfg(feature = "heavy")]
    let found = [
        found,
        of! {
            Composed { moments: v([1.5, 1.5, 1.0]), weight: n(1.0) } from (Matrix3::identity(), v(spin));
            Alone { moments: v(moments) } from ((), v(spin));
            First { gravity: n(1.0) } from (Vector3::x(), v([0.0, 0.5, 0.75]));
            Driven { rate: n(2.0) } from (v([1.0, 0.25]), v([0.0, 0.5]));
            Lopsided { stiffness: n(2.0) } from (v([1.0, 0.25]), v([0.0, 0.5]));
            Damped { moments: v(moments), damping: n(0.0078125) } from (Matrix3::identity(), v(spin));
            Attached { moments: v([1.5, 1.5, 1.0]) } from (Matrix3::identity(), v(spin));
        },
    ]
    .concat();
    found
}

/// The rounding errors of 20 000 steps of 1/128 s, of bodies that turn by about a radian a second. Motions are regular: a chaotic one
/// enlarges every rounding error to the size of the motion.
#[test]
fn errors_are_those_of_increments() {
    let found = errors();
    println!("{STEPS} steps in single precision, off by     plain     compensated   ratio");
    for (name, [plain, compensated]) in &found {
        println!("{name:40} {plain:8.1e}  {compensated:12.1e} {:8.0}", plain / compensated);
    }
    for (name, [plain, compensated]) in found {
        // for unit vectors and quaternions plain steps remove the rounding error of their length, so that they are
        // nearer to begin with. So are free motions, whose moves add c·RD at once
        let gain = if matches!(name, "Pendulum" | "Quaternions" | "Exact") { 8.0 } else { 20.0 };
        assert!(compensated < plain / gain, "{name}: {plain:e} {compensated:e}");
        // after 156 seconds at a radian a second: a quarter of the last digit of the angle
        assert!(name != "Exact" || compensated < 32.0 * f64::from(f32::EPSILON), "{name}: {compensated:e}");
    }
}

/// The errors of the group and of the momentum in double precision: two digits better than with plain sums.
#[test]
fn momenta_and_rotations_stay() -> Result<(), Error> {
    const STEPS: usize = 200_000;
    let (moments, spin) = (v([1.0, 1.5, 2.0]), v([0.25, 1.0, -0.5]));
    /// The largest entries of RᵀR − I and of the change of the spatial momentum, over the momentum.
    fn lost<S>(system: S, spin: Vector3<f64>) -> Result<[f64; 3], Error>
    where
        S: Clebsch<Scalar = f64, Configuration = Matrix3<f64>, Momentum = Vector3<f64>>,
    {
        let stepper = system.into_stepper(H)?;
        let start = stepper.state(Matrix3::identity(), spin)?;
        let end = stepper.trajectory(start).nth(STEPS).expect("an endless trajectory")?;
        let r = end.configuration();
        let energy = stepper.energy(&end) / stepper.energy(&start) - 1.0;
        Ok([(r.transpose() * r - Matrix3::identity()).amax(), (r * end.momentum() - spin).amax(), energy.abs()])
    }
    let plain = lost(plain::Body { moments }, spin)?;
    let compensated = lost(compensated::Body { moments }, spin)?;
    println!("{STEPS} steps in double precision: |RᵀR − I|, spatial momentum, energy: {plain:?} {compensated:?}");
    assert!(compensated.iter().all(|lost| *lost < 3e-15), "{compensated:?}");
    // plain steps take the rounding off rotations as well, now and then
    let lost_by_sums = plain.iter().zip(compensated).skip(1);
    assert!(lost_by_sums.into_iter().all(|(plain, lost)| *plain > 5.0 * lost), "{plain:?} {compensated:?}");
    Ok(())
}

/// Steps of two sizes in turn: the rounding error of the one is added by the other.
#[test]
fn rests_outlive_a_change_of_the_step_size() -> Result<(), Error> {
    fn end<T: Scalar, Q: Numbers, S>(make: impl Fn() -> S, q: Q) -> Result<[Vec<f64>; 2], Error>
    where
        S: Clebsch<Scalar = T, Configuration = Q, Momentum = SVector<T, 3>>,
    {
        let (long, short) = (make().into_stepper(n(H))?, make().into_stepper(n(H / 2.0))?);
        let mut state = long.state(q, v([0.0, 0.5, 0.75]))?;
        for _ in 0..STEPS {
            state = short.step(&long.step(&state)?)?;
        }
        Ok([state.configuration().numbers(), state.momentum().numbers()])
    }
    let moments = [1.0, 1.5, 2.0];
    let exact = end(|| plain::Body { moments: v::<f64, 3>(moments) }, Matrix3::identity())?;
    let off = error(&end(|| plain::Body { moments: v::<f32, 3>(moments) }, Matrix3::identity())?, &exact);
    let kept = error(&end(|| compensated::Body { moments: v::<f32, 3>(moments) }, Matrix3::identity())?, &exact);
    println!("body, {STEPS} steps of two sizes: {off:.1e} {kept:.1e}");
    assert!(kept < off / 20.0, "{off:e} {kept:e}");

    // with a kick that each stepper makes anew
    let exact = end(|| plain::Pendulum { gravity: 1.0_f64 }, Vector3::x())?;
    let off = error(&end(|| plain::Pendulum { gravity: 1.0_f32 }, Vector3::x())?, &exact);
    let kept = error(&end(|| compensated::Pendulum { gravity: 1.0_f32 }, Vector3::x())?, &exact);
    println!("pendulum, {STEPS} steps of two sizes: {off:.1e} {kept:.1e}");
    assert!(kept < off / 8.0, "{off:e} {kept:e}");
    Ok(())
}

/// Several steps at once are the same steps, bit for bit where nothing is merged, and hand their rests on.
#[test]
fn several_steps_keep_their_rests() -> Result<(), Error> {
    let (moments, spin) = (v::<f32, 3>([1.0, 1.5, 2.0]), v::<f32, 3>([0.25, 1.0, -0.5]));
    let exact = compensated::Exact { moments }.into_stepper(H as f32)?;
    let start = exact.state(Matrix3::identity(), spin)?;
    let one_by_one = exact.trajectory(start).nth(1000).expect("an endless trajectory")?;
    assert_eq!(exact.advance(&start, 1000)?, one_by_one);
    assert_eq!(exact.advance(&exact.advance(&start, 400)?, 600)?, one_by_one);

    let split = compensated::Split { moments, weight: 1.0 }.into_stepper(H as f32)?;
    let start = split.state(Matrix3::identity(), spin)?;
    let one_by_one = split.trajectory(start).nth(1000).expect("an endless trajectory")?;
    let at_once = split.advance(&start, 1000)?;
    assert!((at_once.configuration() - one_by_one.configuration()).amax() < 1e-5);
    assert!((at_once.momentum() - one_by_one.momentum()).amax() < 1e-5);
    Ok(())
}

/// Steps with tangent maps and steps of (q, p) sum plainly, and are the same but for rounding.
#[test]
fn tangent_maps_and_covectors_are_those_of_the_step() -> Result<(), Error> {
    let stepper = Watched { gravity: 1.5 }.into_stepper(0.05)?;
    let start = stepper.state(Vector3::x(), Vector3::new(0.0, 0.5, 0.75))?;
    let (mut state, mut tangent) = (start, start);
    for _ in 0..100 {
        state = stepper.step(&state)?;
        tangent = stepper.step_tangent(&tangent)?.0;
    }
    assert!((state.configuration() - tangent.configuration()).amax() < 1e-13);
    assert!((state.momentum() - tangent.momentum()).amax() < 1e-13);
    let (q, p) = (Vector3::x(), Vector3::new(0.0, 0.75, -0.5));
    let mut covector = stepper.cotangent_state(q, p)?;
    for _ in 0..100 {
        covector = stepper.step_symmetric(&covector)?;
    }
    assert!((state.configuration() - covector.configuration()).amax() < 1e-13);
    Ok(())
}

/// `plain` is the code without the key, token for token; `DERIVATION` names the part that is not plain.
#[test]
fn plain_sums_are_the_default() {
    // sums are called plain too
    let renamed = |text: &str| text.replace("Plain", "Default");
    assert_eq!(renamed(Plain::GENERATED), renamed(Default::GENERATED));
    assert!(!plain::Body::<f64>::DERIVATION.contains("Sums are compensated"));
    assert!(compensated::Body::<f64>::DERIVATION.contains("Sums are compensated"));
}

#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<3>, q: Unit<Vector3>| F * q,
    cost      = |h, F| (F - I).norm_squared() / (4 * h),
    potential = |q| self.gravity * q.z,
    summation = compensated,
    emit      = [tangent],
)]
struct Watched {
    gravity: f64,
}

#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<3>, q: Unit<Vector3>| F * q,
    cost      = |h, F| (F - I).norm_squared() / (4 * h),
    summation = plain,
    emit      = [generated],
)]
struct Plain;

#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<3>, q: Unit<Vector3>| F * q,
    cost      = |h, F| (F - I).norm_squared() / (4 * h),
    emit      = [generated],
)]
struct Default;
