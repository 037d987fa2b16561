//! Saved states with a number replaced: an error, or a state that steps on its space. Data that follows from time,
//! configuration and momentum cannot change the motion. Examples are the impulse at q and the constants of a free
//! motion.
//!
//! With the feature `heavy` every number is replaced by every other one, after more steps, and so are all pairs of neighbours.

use clebsch::__private::Scheme;
use clebsch::{Clebsch, Error, F64x4, Real, SavedState, Scalar, Space, State, Stepper};
use clebsch_tests::fixtures::collocated_top::CollocatedTop;
use clebsch_tests::fixtures::compensated_top::CompensatedTop;
use clebsch_tests::fixtures::damped_body::DampedBody;
use clebsch_tests::fixtures::exact_body::ExactBody;
use clebsch_tests::fixtures::exact_body4::ExactBody4;
use clebsch_tests::fixtures::generic_body::GenericBody;
use clebsch_tests::fixtures::gravity_gradient::GravityGradient;
use clebsch_tests::fixtures::quaternion_top::QuaternionTop;
use clebsch_tests::fixtures::sixth_order_top::SixthOrderTop;
use clebsch_tests::fixtures::spin_chain::SpinChain;
use clebsch_tests::fixtures::split_top::SplitTop;
use clebsch_tests::fixtures::tumbling_momentum::TumblingMomentum;
use clebsch_tests::fixtures::two_bodies::TwoBodies;
use clebsch_tests::oracle::random::Random;
use nalgebra::{Matrix3, Matrix4, Quaternion, SVector, Vector3};
use serde_json::Value;

use crate::{Kept, SPIN, inertia};

/// Numbers that take the place of others; numbers between them and `f32` are rounded to its range.
const HOSTILE: [f64; 18] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    2.0,
    1e3,
    1e16,
    -1e16,
    1e150,
    1e300,
    f64::MAX,
    1e-8,
    1e-150,
    1e-300,
    -5e-324,
    f64::NAN,
    f64::INFINITY,
    f64::NEG_INFINITY,
];
/// Factors of numbers: those next to one are no more than rounding, or just more.
const FACTORS: [f64; 6] = [-1.0, 1.0 + 1e-12, 1.0 + 1e-6, 0.999, 1e3, 1e15];

/// Every so many replacements are tried: all of them are where time is no matter.
const EVERY: usize = if cfg!(feature = "heavy") { 1 } else { 7 };
/// Steps before a state is written, and after it is read.
const STEPS: usize = 3;

/// A number as the format writes it.
trait Bytes: Real {
    fn read(bytes: &[u8]) -> f64;
    fn write(value: f64, bytes: &mut [u8]);
}

macro_rules! bytes {
    ($($number:ty),*) => { $(
        impl Bytes for $number {
            fn read(bytes: &[u8]) -> f64 {
                f64::from(<$number>::from_le_bytes(bytes.try_into().expect("a number")))
            }
            fn write(value: f64, bytes: &mut [u8]) {
                bytes.copy_from_slice(&(value as $number).to_le_bytes());
            }
        }
    )* };
}

bytes!(f32, f64);

/// How many numbers there are in a part of a state.
fn count(part: &Value) -> usize {
    match part {
        Value::Number(_) => 1,
        Value::Array(parts) => parts.iter().map(count).sum(),
        Value::Object(parts) => parts.values().map(count).sum(),
        _ => 0,
    }
}

/// States with numbers replaced; some were refused and others stepped.
struct Trial<'a, S: Clebsch> {
    stepper: &'a Stepper<S>,
    /// The state as it was written.
    bytes: Vec<u8>,
    /// Its last step.
    end: State<S>,
    /// Where the numbers of each part begin: time, configuration, momentum, impulse, step size, and where they end.
    parts: [usize; 6],
    refused: usize,
    stepped: usize,
}

impl<'a, S> Trial<'a, S>
where
    S: Clebsch<Time: Kept, Configuration: Kept, Scheme: Scheme<S, Held: Kept, Left: Kept>, Scalar: Kept>,
    S::Scalar: Scalar<Lane: Bytes>,
{
    fn new(stepper: &'a Stepper<S>, start: State<S>) -> Result<Self, Error> {
        let state = stepper.advance(&start, STEPS)?;
        let written = serde_json::to_value(state).expect("numbers");
        let mut parts = [0; 6];
        for (index, part) in ["time", "configuration", "momentum", "impulse", "step_size"].iter().enumerate() {
            parts[index + 1] = parts[index] + count(&written[part]);
        }
        let bytes = postcard::to_stdvec(&state).expect("numbers");
        assert_eq!(bytes.len(), parts[5] * size_of::<<S::Scalar as Scalar>::Lane>(), "{}: other numbers", S::NAME);
        Ok(Self { stepper, bytes, end: stepper.step(&state)?, parts, refused: 0, stepped: 0 })
    }

    /// One number after the other, or two neighbours at once.
    fn run(mut self) {
        let count = self.parts[5];
        let choices = HOSTILE.len() + FACTORS.len();
        for case in (0..count * choices).step_by(EVERY) {
            let (place, choice) = (case / choices, case % choices);
            self.check(&[place], choice);
            if cfg!(feature = "heavy") && place + 1 < count {
                self.check(&[place, place + 1], choice);
            }
        }
        assert!(self.refused > 0 && self.stepped > 0, "{}: {} and {}", S::NAME, self.refused, self.stepped);
    }

    fn check(&mut self, places: &[usize], choice: usize) {
        let width = size_of::<<S::Scalar as Scalar>::Lane>();
        let mut bytes = self.bytes.clone();
        let mut case = String::new();
        for &place in places {
            let number = &mut bytes[place * width..][..width];
            let old = <<S::Scalar as Scalar>::Lane as Bytes>::read(number);
            let new = HOSTILE.get(choice).copied().unwrap_or_else(|| old * FACTORS[choice - HOSTILE.len()]);
            <<S::Scalar as Scalar>::Lane as Bytes>::write(new, number);
            case += &format!("{}: number {place} of {:?} is {new:e} and was {old:e}; ", S::NAME, self.parts);
        }
        let saved: SavedState<S> = postcard::from_bytes(&bytes).expect("numbers");
        let Ok(resumed) = self.stepper.resume(saved) else {
            self.refused += 1;
            return;
        };
        let follows = |place: &usize| (self.parts[3]..self.parts[5]).contains(place);
        let mut state = resumed;
        let start = self.defect(&resumed);
        for step in 0..STEPS {
            let Ok(next) = self.stepper.step(&state) else {
                assert!(!places.iter().all(follows), "{case}the step fails");
                self.refused += 1;
                return;
            };
            assert!(next.configuration().all_finite() && next.momentum().all_finite(), "{case}not finite");
            let defect = self.defect(&next);
            let rounding = 256.0 * <S::Scalar as Scalar>::EPSILON.lane(0).to_f64();
            assert!(defect <= 4.0 * start + rounding, "{case}step {step} is off its space by {defect:e}");
            if step == 0 && places.iter().all(follows) {
                self.is_the_same(&next, &case);
            }
            state = next;
        }
        self.stepped += 1;
    }

    fn defect(&self, state: &State<S>) -> f64 {
        largest(&self.stepper.system().orbit_defect(state.configuration()))
    }

    /// The step is the one from the state that was written, up to √ε of the momentum: errors of this size are accepted
    /// as rounding.
    fn is_the_same(&self, next: &State<S>, case: &str) {
        let (q, mu) = (self.end.configuration(), self.end.momentum());
        let moved = largest(&next.configuration().zip_map(q, |a, b| a - b).max_abs());
        let pushed = largest(&next.momentum().zip_map(&mu, |a, b| a - b).max_abs());
        let accepted = 16.0 * <S::Scalar as Scalar>::EPSILON.lane(0).to_f64().sqrt();
        let size = |value: f64| accepted * (1.0 + value);
        assert!(moved <= size(largest(&q.max_abs())), "{case}the configuration is off by {moved:e}");
        assert!(pushed <= size(largest(&mu.max_abs())), "{case}the momentum is off by {pushed:e}");
    }
}

/// The largest number in the lanes.
fn largest<T: Scalar>(number: &T) -> f64 {
    (0..T::LANES).map(|lane| number.lane(lane).to_f64()).fold(0.0, f64::max)
}

fn check<S>(stepper: Result<Stepper<S>, Error>, q: S::Configuration, mu: S::Momentum) -> Result<(), Error>
where
    S: Clebsch<Time: Kept, Configuration: Kept, Scheme: Scheme<S, Held: Kept, Left: Kept>, Scalar: Kept>,
    S::Scalar: Scalar<Lane: Bytes>,
{
    let stepper = stepper?;
    let start = stepper.project(q, mu)?;
    Trial::new(&stepper, start)?.run();
    Ok(())
}

/// A point on a sphere so large that a state holds n numbers of its momentum.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<8>, q: Unit<SVector<8>>| F * q,
    cost      = |h, F| (F - I).norm_squared() / (4 * h),
    potential = |q| self.weight * q.x * q.y,
)]
struct PointOfLargeSphere {
    weight: f64,
}

/// One that nothing pushes, whose state holds the plane of its motion.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(action = |F: SO<8>, q: Unit<SVector<8>>| F * q, cost = |h, F| (F - I).norm_squared() / (4 * h), scalar = f64)]
struct FreePointOfLargeSphere;

#[test]
fn a_wrong_number_is_an_error_or_a_state() -> Result<(), Error> {
    let mut random = Random::new(93);
    let (r, spin) = (random.attitude::<3>(), Vector3::from(SPIN));
    let (weight, center) = (3.0, Vector3::new(0.1, -0.2, 0.7));
    let mass = Matrix4::from_diagonal(&[1.0, 1.5, 2.0, 2.5].into());

    check(CompensatedTop { mass_matrix: inertia(), weight, center }.into_stepper(0.05), r, spin)?;
    check(ExactBody { moments: Vector3::new(1.0, 1.5, 2.0) }.into_stepper(0.3), r, spin)?;
    check(ExactBody4 { mass }.into_stepper(0.5), random.attitude::<4>(), random.vector())?;
    check(GravityGradient { inertia: inertia(), orbital_rate: 0.3 }.into_stepper(0.05), r, spin)?;
    check(TumblingMomentum { inertia: inertia() }.into_stepper(0.05), (), spin)?;
    check(SixthOrderTop { inertia: inertia(), weight, center }.into_stepper(0.05), r, spin)?;
    check(SplitTop { inertia: inertia(), weight, center }.into_stepper(0.05), r, spin)?;
    check(
        CollocatedTop { moments: Vector3::new(1.0, 1.5, 2.0), weight }.into_stepper(0.05),
        Quaternion::new(0.5, 0.5, -0.5, 0.5),
        spin,
    )?;
    check(DampedBody { inertia: inertia(), damping: 0.3 }.into_stepper(0.05), r, spin)?;
    check(
        QuaternionTop { inertia: inertia(), moment: center }.into_stepper(0.05),
        Quaternion::new(0.5, 0.5, -0.5, 0.5),
        spin,
    )?;
    check(
        TwoBodies { mass: [1.0, 3.0], gravitation: 2.0 }.into_stepper(0.01),
        [Vector3::zeros(), Vector3::x()],
        [0.0, -1.0, 0.0, 0.0, 1.0, 0.5].into(),
    )?;
    check(
        SpinChain::<3> { exchange: 0.7, field: center }.into_stepper(0.05),
        [r * Vector3::x(), r * Vector3::y(), r * Vector3::z()],
        [spin; 3],
    )?;
    let point = SVector::from([0.6, 0.0, 0.8, 0.0, 0.0, 0.0, 0.0, 0.0]);
    check(PointOfLargeSphere { weight }.into_stepper(0.05), point, random.vector())?;
    check(FreePointOfLargeSphere.into_stepper(0.05), point, random.vector())
}

#[test]
fn a_wrong_number_of_single_precision_or_of_a_lane() -> Result<(), Error> {
    fn body<T: Scalar<Lane: Bytes> + Kept>(spin: [Vector3<f64>; 4]) -> Result<(), Error>
    where
        Matrix3<T>: Kept,
        Vector3<T>: Kept,
    {
        let number = T::from_f64;
        let body =
            GenericBody { mass_matrix: inertia().map(number), weight: number(3.0), center: Vector3::z().map(number) };
        let spin = Vector3::from_fn(|i, _| T::from_lanes(|lane| T::Lane::from_f64(spin[lane][i])));
        check(body.into_stepper(number(0.05)), Matrix3::identity(), spin)
    }
    let mut random = Random::new(94);
    let spin = std::array::from_fn(|_| random.vector());
    body::<f32>(spin)?;
    body::<F64x4>(spin)
}

/// A covector along q, and a plane without a unit vector, are nothing that motions of q have, though their momenta are finite.
#[test]
fn what_is_held_of_a_momentum_is_checked() -> Result<(), Error> {
    fn changed<S>(stepper: &Stepper<S>, state: &State<S>, change: impl Fn(&mut Value)) -> Option<Error>
    where
        S: Clebsch<Time: Kept, Configuration: Kept, Scheme: Scheme<S, Held: Kept, Left: Kept>, Scalar: Kept>,
    {
        let mut written = serde_json::to_value(state).expect("numbers");
        change(&mut written);
        stepper.resume(serde_json::from_value(written).expect("numbers")).err()
    }
    let point = SVector::from([0.6, 0.0, 0.8, 0.0, 0.0, 0.0, 0.0, 0.0]);
    let spin = Random::new(95).vector();
    let pushed = PointOfLargeSphere { weight: 3.0 }.into_stepper(0.05)?;
    let state = pushed.project(point, spin)?;
    let refused = changed(&pushed, &state, |state| {
        let along = |i: usize, q: f64| state["momentum"][i].as_f64().expect("a number") + 1e-3 * q;
        let w: Vec<f64> = point.iter().enumerate().map(|(i, q)| along(i, *q)).collect();
        state["momentum"] = w.into();
    });
    assert!(matches!(refused, Some(Error::OutsideMomentumSpace { .. })), "{refused:?}");

    let free = FreePointOfLargeSphere.into_stepper(0.05)?;
    let state = free.project(point, spin)?;
    let refused = changed(&free, &state, |state| {
        let longer: Vec<f64> = point.iter().map(|entry| 1.001 * entry).collect();
        state["momentum"][0] = longer.into();
    });
    assert!(matches!(refused, Some(Error::OutsideMomentumSpace { .. })), "{refused:?}");
    Ok(())
}
