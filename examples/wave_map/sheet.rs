//! The declaration, and the field of the picture.

use clebsch::{Clebsch, Field, FieldStepper, Grid};
use nalgebra::{Rotation3, Vector3};

/// Waves of unit vectors in two directions of space.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SO<3>, q: Unit<Vector3>| F * q,
    cost   = |h, F| (F - I).norm_squared() / (4 * h),
    space  = [
        |dx, q, next| (next - q).norm_squared() / (2 * dx.powi(2)),
        |dy, q, next| (next - q).norm_squared() / (2 * dy.powi(2)),
    ],
)]
pub struct WaveMap;

/// Steps of a periodic grid.
pub type Steps = FieldStepper<WaveMap, Grid<f64, 2>>;
/// Configurations and momenta.
pub type Start = (Vec<Vector3<f64>>, Vec<Vector3<f64>>);

/// Steps of a periodic grid.
///
/// # Errors
/// Those of a stepper.
pub fn steps(sizes: [usize; 2], spacing: [f64; 2], h: f64) -> Result<Steps, clebsch::Error> {
    WaveMap.grid(sizes).spacing(spacing).periodic().stepper(h)
}

/// Centres of the lumps, in parts of the square, and the axes about which they are turned.
const LUMPS: [([f64; 2], [f64; 3]); 2] = [([0.32, 0.36], [1.0, 0.0, 0.0]), ([0.66, 0.62], [-0.6, 0.8, 0.0])];
/// Their width, in parts of the square.
const WIDTH: f64 = 0.1;

/// The third axis, turned by up to `turn` in two lumps. It spins about the third axis at the rate `spin` where it is turned.
pub fn lumps(sites: usize, turn: f64, spin: f64) -> Start {
    let q: Vec<Vector3<f64>> = (0..sites * sites)
        .map(|index| {
            let place = [index / sites, index % sites].map(|i| i as f64 / sites as f64);
            let turned = |(centre, axis): ([f64; 2], [f64; 3])| {
                let far = (0..2).map(|d| ((place[d] - centre[d]) / WIDTH).powi(2)).sum::<f64>();
                Vector3::from(axis) * (turn * (-far).exp())
            };
            Rotation3::new(LUMPS.map(turned).iter().sum::<Vector3<f64>>()) * Vector3::z()
        })
        .collect();
    let mu = q.iter().map(|q| (Vector3::z() - q * q.z) * spin).collect();
    (q, mu)
}
