//! The exported functions, called on memory as C has it. Under Miri this shows that they have no undefined behaviour.
#![allow(unsafe_code, reason = "C reads its memory as steppers and states without a proof")]

use clebsch::{Clebsch, State, Stepper};
use clebsch_c::{Message, Status};
use clebsch_c_example::{Fine, HeavyTop, Probe, fine_top, heavy_top, probe};
use nalgebra::{Matrix3, Vector3};
use std::mem::MaybeUninit;

const TOP: [f64; 13] = [0.5, 0.125, 0.0, 0.125, 0.75, 0.0, 0.0, 0.0, 0.25, 2.0, 0.0, 0.25, 1.0];
const START: [f64; 12] = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.5, 0.25, 2.0];

/// The size of a value in the header.
fn size<V>() -> usize {
    size_of::<V>().next_multiple_of(8)
}

/// The numbers of a state, read in C and in Rust.
fn rows(state: &State<HeavyTop, impl clebsch::Method<HeavyTop>>) -> Vec<f64> {
    state.configuration().transpose().iter().chain(&state.momentum()).copied().collect()
}

fn top() -> HeavyTop {
    let mass_matrix = Matrix3::new(0.5, 0.125, 0.0, 0.125, 0.75, 0.0, 0.0, 0.0, 0.25);
    HeavyTop { mass_matrix, weight: 2.0, center: Vector3::new(0.0, 0.25, 1.0) }
}

#[test]
fn calls_have_the_bits_of_methods() {
    let mut stepper = MaybeUninit::<Stepper<HeavyTop>>::uninit();
    let mut state = MaybeUninit::<State<HeavyTop>>::uninit();
    let size_of_stepper = size::<Stepper<HeavyTop>>();
    assert_eq!(heavy_top::make(Some(&mut stepper), size_of_stepper, Some(&TOP), 0.015625), Status::Ok);
    // SAFETY: `make` has written it
    let stepper = unsafe { stepper.assume_init_ref() };
    assert_eq!(heavy_top::start(Some(stepper), Some(&mut state), size::<State<HeavyTop>>(), Some(&START)), Status::Ok);
    // SAFETY: `start` has written it
    let state = unsafe { state.assume_init_mut() };
    assert_eq!(heavy_top::step(Some(stepper), Some(&mut *state)), Status::Ok);
    assert_eq!(heavy_top::advance(Some(stepper), Some(&mut *state), 3), Status::Ok);
    assert_eq!(heavy_top::kick(Some(stepper), Some(&mut *state), Some(&[0.125, 0.0, -0.5])), Status::Ok);
    let (mut numbers, mut energy) = ([0.0; 12], 0.0);
    assert_eq!(heavy_top::read(Some(state), Some(&mut numbers)), Status::Ok);
    assert_eq!(heavy_top::energy(Some(stepper), Some(state), Some(&mut energy)), Status::Ok);

    let by_hand = top().stepper(0.015625).expect("a top");
    let start = by_hand.state(Matrix3::identity(), Vector3::new(0.5, 0.25, 2.0)).expect("a state");
    let end =
        by_hand.kick(&by_hand.advance(&start, 4).expect("steps"), Vector3::new(0.125, 0.0, -0.5)).expect("a kick");
    assert_eq!((numbers.to_vec(), energy), (rows(&end), by_hand.energy(&end)));

    // null pointers and wrong sizes are statuses, and after an error the state is unchanged
    assert_eq!(heavy_top::step(None, Some(&mut *state)), Status::Null);
    assert_eq!(heavy_top::make(None, size_of_stepper, Some(&TOP), 0.1), Status::Null);
    assert_eq!(heavy_top::kick(Some(stepper), Some(&mut *state), Some(&[f64::NAN, 0.0, 0.0])), Status::NotFinite);
    assert_eq!(rows(state), rows(&end));
}

#[test]
fn a_named_method_has_its_own_functions() {
    let mut stepper = MaybeUninit::<Stepper<HeavyTop, Fine>>::uninit();
    let mut state = MaybeUninit::<State<HeavyTop, Fine>>::uninit();
    let wrong = size::<Stepper<HeavyTop, Fine>>() - 8;
    assert_eq!(fine_top::make(Some(&mut stepper), wrong, Some(&TOP), 0.0625), Status::Size);
    assert_eq!(fine_top::make(Some(&mut stepper), wrong + 8, Some(&TOP), 0.0625), Status::Ok);
    // SAFETY: `make` has written it
    let stepper = unsafe { stepper.assume_init_ref() };
    let size_of_state = size::<State<HeavyTop, Fine>>();
    assert_eq!(fine_top::start(Some(stepper), Some(&mut state), size_of_state, Some(&START)), Status::Ok);
    // SAFETY: `start` has written it
    let state = unsafe { state.assume_init_mut() };
    assert_eq!(fine_top::step(Some(stepper), Some(&mut *state)), Status::Ok);

    let by_hand = top().into_stepper_by::<Fine>(0.0625).expect("a top");
    let start = by_hand.state(Matrix3::identity(), Vector3::new(0.5, 0.25, 2.0)).expect("a state");
    assert_eq!(rows(state), rows(&by_hand.step(&start).expect("a step")));
}

#[test]
fn a_probe_takes_an_input_and_explains_errors() {
    let parameters: [f32; 8] = [2.0, 1.0, 1.5, 2.0, 8.0, 0.25, 0.0, 0.0];
    let start: [f32; 14] = [0.5, 0.5, 0.0, 0.25, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.5, 0.25, 0.125];
    let mut stepper = MaybeUninit::<Stepper<Probe>>::uninit();
    let mut state = MaybeUninit::<State<Probe>>::uninit();
    assert_eq!(probe::make(Some(&mut stepper), size::<Stepper<Probe>>(), Some(&parameters), 0.0625), Status::Ok);
    // SAFETY: `make` has written it
    let stepper = unsafe { stepper.assume_init_ref() };
    assert_eq!(probe::start(Some(stepper), Some(&mut state), size::<State<Probe>>(), Some(&start)), Status::Ok);
    // SAFETY: `start` has written it
    let state = unsafe { state.assume_init_mut() };
    let mut numbers = [0.0; 14];
    assert_eq!(probe::read(Some(state), Some(&mut numbers)), Status::Ok);
    assert_eq!(numbers, start);
    let before = *state;
    assert_eq!(
        probe::step_with(Some(stepper), Some(&mut *state), Some(&[0.25, 0.0, 0.0, 0.0, 0.0, 0.125])),
        Status::Ok
    );
    assert_eq!(state.time(), 0.5625);
    let input = (Vector3::new(0.25, 0.0, 0.0), Vector3::new(0.0, 0.0, 0.125));
    assert_eq!(Ok(*state), stepper.step_with(&before, &input));

    let mut message = Message::default();
    let mut broken = parameters;
    broken[0] = f32::INFINITY;
    assert_eq!(probe::explain(Some(&broken), 0.1, Some(&start), None, Some(&mut message)), Status::NotFinite);
    assert!(message.text().contains("mass"), "{message:?}");
}
