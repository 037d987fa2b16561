//! The same steps in lanes and one by one.

use clebsch::{Body, Clebsch, Error, F32x8, F64x4, F64x8, Mask, Scalar, Space, State, Stepper};
use clebsch_tests::oracle::bits::Bits;
use std::cell::RefCell;

/// Steps in lanes of this type, for code that is written for any.
pub trait Lanes: Scalar<Lane: Bits> {}

impl Lanes for F64x8 {}
impl Lanes for F64x4 {}
impl Lanes for F32x8 {}

/// All scalars of a space, bit for bit.
pub fn bits<T: Bits>(space: &impl Space<T>) -> Vec<u64> {
    let found = RefCell::new(Vec::new());
    space.all(|entry| {
        found.borrow_mut().push(entry.bits());
        true
    });
    found.into_inner()
}

/// How often a step succeeded and failed.
#[derive(Clone, Copy, Debug, Default)]
pub struct Count {
    pub stepped: usize,
    pub failed: usize,
    /// Steps of lanes that succeeded while another one failed.
    pub spared: usize,
}

impl Count {
    /// Adds other counts.
    pub fn add(&mut self, other: Count) {
        self.stepped += other.stepped;
        self.failed += other.failed;
        self.spared += other.spared;
    }
}

/// Steps `starts` side by side and one by one, and asserts that bits and errors are the same. A lane that fails stays.
pub fn same<L, S>(lanes: &Stepper<L>, singles: &[Stepper<S>], starts: &[Body<S>], steps: usize) -> Count
where
    L: Clebsch<Scalar: Lanes + Scalar<Lane = S::Scalar>>,
    S: Clebsch<Scalar: Bits + Scalar<Lane = S::Scalar>, Configuration: Space<S::Scalar, Lane = S::Configuration>>,
    S: Clebsch<Momentum: Space<S::Scalar, Lane = S::Momentum>>,
    L::Configuration: Space<L::Scalar, Lane = S::Configuration>,
    L::Momentum: Space<L::Scalar, Lane = S::Momentum>,
{
    let state = lanes
        .state(L::Configuration::side_by_side(|lane| starts[lane].0), L::Momentum::side_by_side(|lane| starts[lane].1));
    let mut state: State<L> = state.expect("states in lanes");
    let mut each: Vec<State<S>> = (0..L::Scalar::LANES)
        .map(|lane| singles[lane].state(starts[lane].0, starts[lane].1).expect("a single state"))
        .collect();
    let mut count = Count::default();
    for step in 0..steps {
        let whole = lanes.step(&state);
        let (next, stepped) = lanes.step_each(&state);
        let first = (0..L::Scalar::LANES).find(|&lane| !stepped.lane(lane));
        match (whole, first) {
            (Ok(whole), None) => assert_eq!(whole, next),
            (Err(error), Some(lane)) => assert!(error == Error::InLane { lane } || !stepped.any()),
            (whole, first) => panic!("{whole:?}, but {first:?} is the first lane that fails"),
        }
        for (lane, single) in each.iter_mut().enumerate() {
            match singles[lane].step(single) {
                Ok(next) => {
                    assert!(stepped.lane(lane), "step {step}: lane {lane} fails by {:?}", lanes.failure(&state, lane));
                    assert_eq!(lanes.failure(&state, lane), None);
                    *single = next;
                    count.stepped += 1;
                    count.spared += usize::from(first.is_some());
                }
                Err(error) => {
                    assert!(!stepped.lane(lane), "step {step}: lane {lane} should fail: {error}");
                    assert_eq!(lanes.failure(&state, lane), Some(error), "step {step}, lane {lane}");
                    count.failed += 1;
                }
            }
            let (q, mu) = next.lane(lane);
            assert_eq!(bits(&q), bits(single.configuration()), "step {step}, lane {lane}: configuration");
            assert_eq!(bits(&mu), bits(&single.momentum()), "step {step}, lane {lane}: momentum");
        }
        state = next;
    }
    count
}
