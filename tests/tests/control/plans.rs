//! Plans of declared systems, against their conditions of first order and against closed forms.

use clebsch::{Controlled, Target};
use clebsch_tests::fixtures::regulator::Regulator;
use nalgebra::{Matrix2, Vector2};

/// The Riccati recursion P = Q + Aᵀ(P − PB(R + BᵀPB)⁻¹BᵀP)A, written out.
#[test]
fn a_regulator_has_the_gains_of_riccati() {
    let (h, system) = (0.1, Regulator { mass: 1.3, stiffness: 2.0, price: 0.5 });
    let a = Matrix2::new(1.0, h, -h * system.stiffness / system.mass, 1.0);
    let b = Vector2::new(0.0, h / system.mass);
    let (q, r) = (Matrix2::identity() * h, h * system.price);
    let start = Vector2::new(1.0, -0.4);
    let control = system.control(h).expect("regular");
    let mut plan = [control.stage(&start); 50];
    let optimum = control.solve(&start, Target::Free, &mut plan).expect("a plan");
    let mut p = Matrix2::zeros();
    for stage in optimum.stages().iter().rev() {
        let gain = -(b.transpose() * p * a) / (r + (b.transpose() * p * b)[0]);
        assert!((stage.gain() - gain).amax() < 1e-13, "{} is not {gain}", stage.gain());
        p = q + a.transpose() * p * (a + b * gain);
        assert!((stage.costate() - p * stage.place()).amax() < 1e-13);
    }
    assert!((optimum.price() - (start.transpose() * p * start)[0] / 2.0).abs() < 1e-13);
    assert!(optimum.is_minimum() && optimum.iterations() <= 2);
}
