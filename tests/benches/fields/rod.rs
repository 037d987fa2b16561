//! A rod of rigid sections by hand: the same scheme in plain Rust. Rotations and places stand apart, and no row of a matrix is known.

use nalgebra::{Matrix3, Vector3};

/// Newton's method ends after a correction of this part of g: the error of the next one is its square.
const NEAR: f64 = 1e-8;
/// The most iterations.
const MOST: usize = 20;

/// A section: its rotation and its place, and its momentum in the body, about its axes and along them.
#[derive(Clone, Copy, Debug)]
pub struct Section {
    pub rotation: Matrix3<f64>,
    pub place: Vector3<f64>,
    pub turning: Vector3<f64>,
    pub moving: Vector3<f64>,
}

/// The parameters of a rod.
#[derive(Clone, Copy, Debug)]
pub struct ByHand {
    /// Moments of inertia and mass of a section.
    pub inertia: Vector3<f64>,
    pub mass: f64,
    /// EI, EI, GJ and GA, GA, EA.
    pub bending: Vector3<f64>,
    pub stretching: Vector3<f64>,
    /// The strains at rest.
    pub curvature: Vector3<f64>,
    pub tangent: Vector3<f64>,
    pub spacing: f64,
    pub h: f64,
}

impl ByHand {
    /// So many steps.
    pub fn steps(&self, steps: u64, rod: &mut [Section]) {
        self.kick(self.h / 2.0, rod);
        for step in 1..=steps {
            self.drift(rod);
            self.kick(if step == steps { self.h / 2.0 } else { self.h }, rod);
        }
    }

    /// The forces of all edges, times `weight`. The strain (x, y) is that of Cayley's map, and the forces are (dcay⁻¹)ᵀσ at both ends.
    fn kick(&self, weight: f64, rod: &mut [Section]) {
        let per_spacing = self.spacing.recip();
        for i in 1..rod.len() {
            let [a, b] = &mut rod[i - 1..=i] else { return };
            let w = a.rotation.tr_mul(&b.rotation);
            let d = a.rotation.tr_mul(&(b.place - a.place));
            let x = Vector3::new(w.m32 - w.m23, w.m13 - w.m31, w.m21 - w.m12) * (2.0 / (1.0 + w.trace()));
            let y = d - x.cross(&d) / 2.0;
            let moment = (x * per_spacing - self.curvature).component_mul(&self.bending);
            let force = (y * per_spacing - self.tangent).component_mul(&self.stretching);
            let (twist, across) = (x.cross(&moment) / 2.0, x.cross(&force) / 2.0);
            let along = moment + x * (x.dot(&moment) / 4.0) + y.cross(&across) / 2.0;
            let lever = twist + y.cross(&force) / 2.0;
            a.turning += (lever + along) * weight;
            a.moving += (across + force) * weight;
            b.turning += (lever - along) * weight;
            b.moving += (across - force) * weight;
        }
    }

    /// Each section turns by I + 2 (ĝ + ĝ²)/(1 + |g|²), where (2/h) J g = M + M × g + g (g·M).
    fn drift(&self, rod: &mut [Section]) {
        let scale = self.inertia * (2.0 / self.h);
        for Section { rotation, place, turning, moving } in rod {
            let m = *turning;
            let mut g = m.component_div(&scale);
            for _ in 0..MOST {
                let along = g.dot(&m);
                let residual = scale.component_mul(&g) - m - m.cross(&g) - g * along;
                let slope = Matrix3::from_diagonal(&scale.add_scalar(-along)) - m.cross_matrix() - g * m.transpose();
                let Some(inverse) = slope.try_inverse() else { break };
                let change = inverse * residual;
                g -= change;
                if change.norm_squared() <= NEAR * NEAR * g.norm_squared() {
                    break;
                }
            }
            let hat = g.cross_matrix();
            let turn = Matrix3::identity() + (hat + hat * hat) * (2.0 / (1.0 + g.norm_squared()));
            *place += *rotation * (*moving * (self.h / self.mass));
            *rotation *= turn;
            *turning = turn.tr_mul(turning);
            *moving = turn.tr_mul(moving);
        }
    }
}
