//! The same rod in its plane, by places and angles alone: Newton's and Euler's laws for another integrator.

use crate::beam::{Beam, ENDS};
use nalgebra::{SVector, Vector2};

/// Edges of the rod that is compared.
pub const FEW: usize = 8;
/// Places, angle, and their rates, for each section.
pub type Numbers = SVector<f64, 54>;
const SITES: usize = FEW + 1;

/// The slopes of the energy of an edge: by the place of its end, and by the angles of both ends.
///
/// With d = (X·e₂, X·e₃) for the edge X and κ = 2 tan(Δψ/2), Cayley's strains are κ and y = (d₂ + κd₃/2, d₃ − κd₂/2).
fn slopes(beam: &Beam, edge: Vector2<f64>, angles: [f64; 2]) -> (Vector2<f64>, [f64; 2]) {
    let ds = beam.spacing(FEW);
    let (sin, cos) = angles[0].sin_cos();
    let (along, across) = (Vector2::new(cos, sin), Vector2::new(sin, -cos));
    let (d2, d3) = (edge.dot(&across), edge.dot(&along));
    let kappa = 2.0 * ((angles[1] - angles[0]) / 2.0).tan();
    let y = [d2 + kappa * d3 / 2.0, d3 - kappa * d2 / 2.0];
    let (bend, shear) = (beam.bending * kappa / ds, beam.shear * y[0] / ds);
    let stretch = beam.axial * (y[1] / ds - 1.0);
    let by_d = [shear - kappa * stretch / 2.0, stretch + kappa * shear / 2.0];
    let by_turn = (bend + shear * d3 / 2.0 - stretch * d2 / 2.0) * (1.0 + kappa * kappa / 4.0);
    (across * by_d[0] + along * by_d[1], [by_d[0] * d3 - by_d[1] * d2 - by_turn, by_turn])
}

/// The law of the rod under a force in the plane and a moment on its first section.
pub fn law(beam: &Beam, force: Vector2<f64>, moment: f64, y: &Numbers) -> Numbers {
    let mut forces = [[0.0; 3]; SITES];
    forces[0] = [force.x, force.y, moment];
    for i in 0..FEW {
        let (pull, turns) = slopes(beam, place(y, i + 1) - place(y, i), [y[3 * i + 2], y[3 * i + 5]]);
        forces[i] = [forces[i][0] + pull.x, forces[i][1] + pull.y, forces[i][2] - turns[0]];
        forces[i + 1] = [-pull.x, -pull.y, -turns[1]];
    }
    let mut rates = Numbers::zeros();
    for (i, force) in forces.iter().enumerate() {
        let ds = beam.spacing(FEW) * if i == 0 || i == FEW { 0.5 } else { 1.0 };
        for (k, (force, inertia)) in force.iter().zip([beam.mass, beam.mass, beam.inertia]).enumerate() {
            rates[3 * i + k] = y[3 * (SITES + i) + k];
            rates[3 * (SITES + i) + k] = force / (inertia * ds);
        }
    }
    rates
}

/// The straight rod at rest.
pub fn start(beam: &Beam) -> Numbers {
    let [from, to] = ENDS.map(Vector2::from);
    let along = (to - from).normalize();
    let mut y = Numbers::zeros();
    for i in 0..SITES {
        let place = from + along * (beam.spacing(FEW) * i as f64);
        y.fixed_rows_mut::<3>(3 * i).copy_from_slice(&[place.x, place.y, along.y.atan2(along.x)]);
    }
    y
}

/// Where a section is, metres.
pub fn place(y: &Numbers, i: usize) -> Vector2<f64> {
    Vector2::new(y[3 * i], y[3 * i + 1])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::beam::FLYING;

    /// The slopes are those of the energy, by differences.
    #[test]
    fn slopes_are_differences() {
        let ds = FLYING.spacing(FEW);
        let energy = |edge: Vector2<f64>, angles: [f64; 2]| {
            let (sin, cos) = angles[0].sin_cos();
            let (d2, d3) = (edge.dot(&Vector2::new(sin, -cos)), edge.dot(&Vector2::new(cos, sin)));
            let kappa = 2.0 * ((angles[1] - angles[0]) / 2.0).tan();
            let y = [d2 + kappa * d3 / 2.0, d3 - kappa * d2 / 2.0];
            let squares = FLYING.bending * (kappa / ds).powi(2) + FLYING.shear * (y[0] / ds).powi(2);
            ds / 2.0 * (squares + FLYING.axial * (y[1] / ds - 1.0).powi(2))
        };
        let (edge, angles, d) = (Vector2::new(0.9, 0.8), [0.4, 0.9], 1e-6);
        let (pull, turns) = slopes(&FLYING, edge, angles);
        let slope = |up: f64, down: f64| (up - down) / (2.0 * d);
        for (axis, expected) in [(Vector2::x(), pull.x), (Vector2::y(), pull.y)] {
            let found = slope(energy(edge + axis * d, angles), energy(edge - axis * d, angles));
            assert!((found - expected).abs() < 1e-5, "{found} {expected}");
        }
        let turned = |a: f64, b: f64| energy(edge, [angles[0] + a, angles[1] + b]);
        assert!((slope(turned(d, 0.0), turned(-d, 0.0)) - turns[0]).abs() < 1e-5);
        assert!((slope(turned(0.0, d), turned(0.0, -d)) - turns[1]).abs() < 1e-5);
    }
}
