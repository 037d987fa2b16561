//! Extremals against a direct minimisation of the action, which knows no momentum, no tangent map and no elimination.
//! Vertex after vertex moves to the least action of its two edges, by differences, until nothing moves.

use super::systems::Top;
use clebsch::{Clebsch, Error, Guess};
use nalgebra::{Matrix3, Rotation3, Vector3};

const H: f64 = 0.15;
const MASS: [f64; 3] = [2.0, 1.0, 0.5];
const WEIGHT: f64 = 1.3;

fn turned(r: &Matrix3<f64>, xi: Vector3<f64>) -> Matrix3<f64> {
    r * Rotation3::from_scaled_axis(xi).matrix()
}

/// tr(𝕄(F − I)(F − I)ᵀ)/(2h) − h/2 (V(R) + V(R⁺)), entry by entry.
fn edge(r: &Matrix3<f64>, next: &Matrix3<f64>) -> f64 {
    let d = r.transpose() * next - Matrix3::identity();
    let kinetic = (0..3).map(|i| MASS[i] * d.row(i).norm_squared()).sum::<f64>() / (2.0 * H);
    kinetic - H / 2.0 * WEIGHT * (r[(2, 2)] + next[(2, 2)])
}

/// The vertex between two others moved by one step of Newton's method on the action of its two edges, halved until that falls.
fn moved(before: &Matrix3<f64>, r: &Matrix3<f64>, after: &Matrix3<f64>) -> Matrix3<f64> {
    let action = |xi: Vector3<f64>| {
        let r = turned(r, xi);
        edge(before, &r) + edge(&r, after)
    };
    let step = 1e-4;
    let unit = |k: usize| Vector3::ith(k, step);
    let gradient = Vector3::from_fn(|k, _| (action(unit(k)) - action(-unit(k))) / (2.0 * step));
    let hessian = Matrix3::from_fn(|k, l| {
        let corner = |a: f64, b: f64| action(unit(k) * a + unit(l) * b);
        (corner(1.0, 1.0) - corner(1.0, -1.0) - corner(-1.0, 1.0) + corner(-1.0, -1.0)) / (4.0 * step * step)
    });
    let mut xi = -hessian.try_inverse().map_or(gradient, |inverse| inverse * gradient);
    for _ in 0..30 {
        if action(xi) < action(Vector3::zeros()) {
            return turned(r, xi);
        }
        xi /= 2.0;
    }
    *r
}

#[test]
fn a_direct_minimisation_finds_the_same_path() -> Result<(), Error> {
    let target = *Rotation3::from_scaled_axis(Vector3::new(0.6, -0.9, 1.1)).matrix();
    let stepper = Top { mass: MASS.into(), weight: WEIGHT }.into_stepper(H)?;
    let boundary = stepper.boundary();
    let mut path = [boundary.rest(&Matrix3::identity()); 8];
    let extremal = boundary.solve(&Matrix3::identity(), &target, Guess::Geodesic, &mut path)?;
    // from a path that zigzags
    let zigzag = |k: usize| Vector3::new(0.2, -0.1, 0.3) * if k.is_multiple_of(2) { 1.0 } else { -1.0 };
    let mut vertices: Vec<Matrix3<f64>> = (0..=8)
        .map(|k| *Rotation3::from_scaled_axis(Vector3::new(0.6, -0.9, 1.1) * (k as f64 / 8.0)).matrix())
        .enumerate()
        .map(|(k, r)| if k == 0 || k == 8 { r } else { turned(&r, zigzag(k)) })
        .collect();
    // each sweep takes a seventh off the error, and the action is good for twice its digits
    for _ in 0..if cfg!(feature = "heavy") { 400 } else { 130 } {
        for k in 1..8 {
            vertices[k] = moved(&vertices[k - 1], &vertices[k], &vertices[k + 1]);
        }
    }
    let least: f64 = vertices.windows(2).map(|pair| edge(&pair[0], &pair[1])).sum();
    assert!((extremal.action() - least).abs() < 1e-11, "{} is not {least}", extremal.action());
    // differences are good for half of the digits
    for (node, vertex) in extremal.nodes().iter().zip(&vertices) {
        assert!((node.configuration() - vertex).amax() < 1e-5);
    }
    Ok(())
}
