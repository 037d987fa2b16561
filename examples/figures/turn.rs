//! Optimal control: the turn of least price, against the turn about a fixed axis.

use crate::Pictures;
use clebsch::{Clebsch, Controlled, Target};
use clebsch_examples::claims::Claims;
use clebsch_examples::figure::{self, BLUE, Globe, ORANGE, PURPLE, Panel, Pointer, Series, TEAL, Track, View};
use clebsch_examples::scene::Failure;
use nalgebra::{Matrix3, Rotation3, Vector3};

/// An attitude that is turned at chosen rates, each with a price.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |F: SO<3>, R: SO<3>| R * F,
    controls       = |u: Vector3| u,
    cost           = |h, u| h * u.dot(&self.price.component_mul(&u)) / 2,
    discretization = exponential,
)]
pub struct Turn {
    /// Price of the square of each rate.
    pub price: Vector3<f64>,
}

const STEPS: usize = 100;

pub fn optimal_control(pictures: &Pictures, claims: &mut Claims) -> Result<(), Failure> {
    let turn = Turn { price: Vector3::new(1.0, 2.0, 10.0) };
    let h = 1.0 / STEPS as f64;
    let angles = Vector3::new(1.0, 0.5, 2.0);
    let start = Matrix3::identity();
    let control = turn.clone().control(h)?;
    let mut plan = [control.stage(&start); STEPS];
    let target = Target::Place(Rotation3::new(angles).into_inner());
    let optimum = control.solve(&start, target, &mut plan)?;
    let rate = |u: &Vector3<f64>| u.dot(&turn.price.component_mul(u)) / 2.0;
    let fixed = rate(&angles);
    claims.holds("the plan is a local minimum", optimum.is_minimum(), "Morse's index");
    claims.within("price of the plan", optimum.price(), 0.0..=fixed, 3, "less than about the fixed axis");
    claims.within("price about the fixed axis", fixed, 0.0..=f64::INFINITY, 3, "½ θ·Pθ / T");

    let axis = Vector3::new(1.0, 1.0, 0.0).normalize();
    let place = |attitude: &Matrix3<f64>| <[f64; 3]>::from(attitude * axis);
    let least: Vec<_> = optimum.stages().iter().map(|stage| place(stage.place())).collect();
    let about = (0..=STEPS).map(|i| place(Rotation3::new(angles * (i as f64 * h)).matrix()));
    let about: Vec<_> = about.collect();
    let tracks = [
        Track { points: &about, colour: Some(ORANGE), width: 2.0 },
        Track { points: &least, colour: Some(BLUE), width: 2.0 },
    ];
    let pointers = [
        Pointer { label: "start", direction: least[0], colour: TEAL },
        Pointer { label: "target", direction: place(optimum.end()), colour: PURPLE },
    ];
    let rates = optimum.stages().iter().enumerate().map(|(i, stage)| (i as f64 * h, rate(stage.input()))).collect();
    let series = vec![
        Series { label: "about a fixed axis", colour: ORANGE, points: vec![(0.0, fixed), (1.0, fixed)] },
        Series { label: "least price", colour: BLUE, points: rates },
    ];
    pictures.draw("optimal-control", |area| {
        let (left, right) = figure::columns(area, 370.0);
        let left = figure::caption(&left, "Path of an axis of the body")?;
        Globe { view: View { azimuth: 80.0, elevation: 20.0 }, pointers: &pointers, tracks: &tracks }.draw(&left)?;
        Panel { title: "Price per second", unit: "", x_label: "time (s)", series }.draw(&right)
    })
}
