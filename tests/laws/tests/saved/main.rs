//! States that are written and read back go on with the bits that they would have had, in text and in binary.

#![allow(missing_docs)]

mod corrupted;

use clebsch::__private::Scheme;
use clebsch::{Clebsch, Error, F32x8, F64x4, SavedState, Scalar, State, Stepper};
use clebsch_tests::fixtures::compensated_top::CompensatedTop;
use clebsch_tests::fixtures::exact_body::ExactBody;
use clebsch_tests::fixtures::exact_body4::ExactBody4;
use clebsch_tests::fixtures::generic_body::GenericBody;
use clebsch_tests::fixtures::gravity_gradient::GravityGradient;
use clebsch_tests::fixtures::quaternion_top::QuaternionTop;
use clebsch_tests::fixtures::sixth_order_top::SixthOrderTop;
use clebsch_tests::fixtures::split_top::SplitTop;
use clebsch_tests::fixtures::tumbling_momentum::TumblingMomentum;
use clebsch_tests::fixtures::two_bodies::TwoBodies;
use clebsch_tests::oracle::random::Random;
use nalgebra::{Matrix3, Vector3};
use proptest::prelude::*;
use serde::Serialize;
use serde::de::DeserializeOwned;

/// Steps before the state is written, and after.
const STEPS: usize = 20;

/// Values that can be written and read back completely.
trait Kept: Serialize + DeserializeOwned {}
impl<T: Serialize + DeserializeOwned> Kept for T {}

fn steps<S: Clebsch>(stepper: &Stepper<S>, start: State<S>) -> Result<State<S>, Error> {
    (0..STEPS).try_fold(start, |state, _| stepper.step(&state))
}

/// Writes the state after some steps, reads it, and goes on with it and without.
fn goes_on<S>(stepper: &Stepper<S>, start: State<S>) -> Result<(), Error>
where
    S: Clebsch<Time: Kept, Configuration: Kept, Scheme: Scheme<S, Held: Kept, Left: Kept>, Scalar: Kept>,
{
    let state = steps(stepper, start)?;
    let exact = steps(stepper, state)?;
    let text = serde_json::to_string(&state).expect("numbers");
    let from_text: SavedState<S> = serde_json::from_str(&text).expect("the same numbers");
    let bytes = postcard::to_stdvec(&state).expect("numbers");
    let from_bytes: SavedState<S> = postcard::from_bytes(&bytes).expect("the same numbers");
    for saved in [from_text, from_bytes] {
        let resumed = stepper.resume(saved)?;
        // every bit, also of data that a state does not show
        assert_eq!(serde_json::to_string(&resumed).expect("numbers"), text, "{}", S::NAME);
        let end = steps(stepper, resumed)?;
        assert_eq!(end, exact, "{}", S::NAME);
        assert_eq!(serde_json::to_string(&end).expect("numbers"), serde_json::to_string(&exact).expect("numbers"));
    }
    Ok(())
}

const SPIN: [f64; 3] = [0.4, 1.2, -0.7];

fn inertia() -> Matrix3<f64> {
    Matrix3::new(2.0, 0.1, -0.2, 0.1, 1.5, 0.05, -0.2, 0.05, 1.0)
}

#[test]
fn every_kind_of_state_goes_on_bit_for_bit() -> Result<(), Error> {
    let mut random = Random::new(91);
    let (r, spin) = (random.attitude::<3>(), Vector3::from(SPIN));
    let (mass_matrix, weight, center) = (inertia(), 3.0, Vector3::new(0.1, -0.2, 0.7));

    // an impulse, and rests
    let stepper = CompensatedTop { mass_matrix, weight, center }.into_stepper(0.05)?;
    goes_on(&stepper, stepper.state(r, spin)?)?;
    // the constants of a free motion
    let stepper = ExactBody { moments: Vector3::new(1.0, 1.5, 2.0) }.into_stepper(0.3)?;
    goes_on(&stepper, stepper.state(r, spin)?)?;
    let stepper =
        ExactBody4 { mass: nalgebra::Matrix4::from_diagonal(&[1.0, 1.5, 2.0, 2.5].into()) }.into_stepper(0.5)?;
    goes_on(&stepper, stepper.state(random.attitude::<4>(), random.vector())?)?;
    // a time
    let stepper = GravityGradient { inertia: inertia(), orbital_rate: 0.3 }.into_stepper(0.05)?;
    goes_on(&stepper, stepper.state_at(0.1, r, spin)?)?;
    // a momentum alone
    let stepper = TumblingMomentum { inertia: inertia() }.into_stepper(0.05)?;
    goes_on(&stepper, stepper.state((), spin)?)?;
    let stepper = SixthOrderTop { inertia: inertia(), weight, center }.into_stepper(0.05)?;
    goes_on(&stepper, stepper.state(r, spin)?)?;
    let stepper = SplitTop { inertia: inertia(), weight, center }.into_stepper(0.05)?;
    goes_on(&stepper, stepper.state(r, spin)?)?;
    let stepper = QuaternionTop { inertia: inertia(), moment: center }.into_stepper(0.05)?;
    goes_on(&stepper, stepper.state(nalgebra::Quaternion::new(0.5, 0.5, -0.5, 0.5), spin)?)?;
    let stepper = TwoBodies { mass: [1.0, 3.0], gravitation: 2.0 }.into_stepper(0.01)?;
    goes_on(&stepper, stepper.state([Vector3::zeros(), Vector3::x()], [0.0, -1.0, 0.0, 0.0, 1.0, 0.5].into())?)?;
    Ok(())
}

#[test]
fn single_precision_and_lanes_go_on_too() -> Result<(), Error> {
    fn body<T: Scalar + Kept>(start: [Vector3<f64>; 8]) -> Result<(), Error>
    where
        Matrix3<T>: Kept,
        Vector3<T>: Kept,
    {
        let number = T::from_f64;
        let body =
            GenericBody { mass_matrix: inertia().map(number), weight: number(3.0), center: Vector3::z().map(number) };
        let stepper = body.into_stepper(number(0.05))?;
        let spin = Vector3::from_fn(|i, _| T::from_lanes(|lane| T::Lane::from_f64(start[lane][i])));
        goes_on(&stepper, stepper.state(Matrix3::identity(), spin)?)
    }
    let mut random = Random::new(92);
    let start = std::array::from_fn(|_| random.vector());
    body::<f32>(start)?;
    body::<clebsch::DoubleDouble>(start)?;
    body::<F64x4>(start)?;
    body::<F32x8>(start)
}

/// Numbers that no state has are refused, with the mistake; those that were written with another step size go on with
/// this one.
#[test]
fn what_is_read_is_checked() -> Result<(), Error> {
    type Top = CompensatedTop;
    let top = Top { mass_matrix: inertia(), weight: 3.0, center: Vector3::z() };
    let (stepper, other) = (top.stepper(0.05)?, top.stepper(0.02)?);
    let state = steps(&stepper, stepper.state(Matrix3::identity(), SPIN.into())?)?;
    let written = serde_json::to_value(state).expect("numbers");
    let read = |change: &dyn Fn(&mut serde_json::Value)| {
        let mut changed = written.clone();
        change(&mut changed);
        serde_json::from_value::<SavedState<Top>>(changed)
    };
    let same = read(&|_| ()).expect("a state");
    assert_eq!(other.step(&other.resume(same)?)?, other.step(&state)?);

    let stretched = read(&|state| state["configuration"][0] = 2.0.into()).expect("numbers");
    assert!(matches!(stepper.resume(stretched), Err(Error::OffOrbit { .. })));
    // text has no infinities: `null` is NaN nowhere
    assert!(read(&|state| state["momentum"][0] = serde_json::Value::Null).is_err());
    assert!(read(&|state| state["momentum"] = vec![1.0].into()).is_err());
    let mut bytes = postcard::to_stdvec(&state).expect("numbers");
    let last = bytes.len() - 8;
    bytes[last..].copy_from_slice(&f64::NAN.to_le_bytes());
    let broken: SavedState<Top> = postcard::from_bytes(&bytes).expect("numbers");
    assert_eq!(stepper.resume(broken).err(), Some(Error::NotFinite { name: "the data of the last step" }));
    assert!(format!("{broken:?}").starts_with("SavedState(State {"));
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 32, failure_persistence: None, ..ProptestConfig::default() })]

    /// Any state of any top, whatever its step size was. The state that is read back is that which was written, to the
    /// bit, and goes on like it.
    #[test]
    fn saved_states_resume_bit_for_bit(
        seed in any::<u64>(), weight in 0.1_f64..3.0, h in 0.01_f64..0.1, steps in 0_usize..9, other in 0.01_f64..0.1,
    ) {
        let mut random = Random::new(seed);
        let top = CompensatedTop { mass_matrix: random.inertia(), weight, center: random.vector() };
        let stepper = top.stepper(h)?;
        let state = stepper.advance(&stepper.state(random.attitude::<3>(), random.vector())?, steps)?;
        let bytes = postcard::to_stdvec(&state).expect("numbers");
        let resumed = stepper.resume(postcard::from_bytes(&bytes).expect("the same numbers"))?;
        prop_assert_eq!(&postcard::to_stdvec(&resumed).expect("numbers"), &bytes);
        let (next, exact) = (stepper.step(&resumed)?, stepper.step(&state)?);
        prop_assert_eq!(postcard::to_stdvec(&next).expect("numbers"), postcard::to_stdvec(&exact).expect("numbers"));
        // with another step size too
        let stepper = top.stepper(other)?;
        let resumed = stepper.resume(postcard::from_bytes(&bytes).expect("the same numbers"))?;
        prop_assert_eq!(stepper.step(&resumed)?, stepper.step(&state)?);
    }
}
