//! The body, its principal axes, and how they point on the orbit.

use crate::Flags;
use clebsch_examples::scene::Failure;
use nalgebra::{Matrix3, Vector3};

/// √(J/m) over the radius of the orbit above which second moments do not describe the pull of gravity.
const LARGEST: f64 = 0.01;

/// A rigid body near a planet.
#[derive(Clone, Copy, Debug)]
pub struct Body {
    /// kg
    pub mass: f64,
    /// About the centre of mass, body frame, kg·m².
    pub inertia: Matrix3<f64>,
    /// GM of the planet, m³/s².
    pub gravitation: f64,
    /// Principal moments from the least to the largest, kg·m².
    pub moments: Vector3<f64>,
    /// Their axes in the body frame, as columns.
    axes: Matrix3<f64>,
}

impl Body {
    /// From the flags.
    ///
    /// # Errors
    /// [`Failure::Flags`] where no body has this inertia tensor, or one too large for its orbit.
    pub fn new(flags: &Flags) -> Result<Self, Failure> {
        let [xx, yy, zz, xy, xz, yz] = flags.inertia;
        let inertia = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
        let eigen = inertia.symmetric_eigen();
        let mut order = [0, 1, 2];
        order.sort_by(|&i, &j| eigen.eigenvalues[i].total_cmp(&eigen.eigenvalues[j]));
        let moments = Vector3::from(order.map(|index| eigen.eigenvalues[index]));
        if moments.x <= 0.0 || moments.z > moments.x + moments.y {
            let [a, b, c] = moments.into();
            return Err(Failure::Flags(format!(
                "no body has the principal moments {a:.6e}, {b:.6e}, {c:.6e}: all are above zero, the largest is no more than the sum of the others"
            )));
        }
        let extent = (moments.z / flags.mass).sqrt();
        if extent > LARGEST * flags.radius {
            return Err(Failure::Flags(format!(
                "a body of {extent:.3e} m, the root of inertia over mass, is too large for an orbit of {:.3e} m",
                flags.radius
            )));
        }
        let axes = Matrix3::from_columns(&order.map(|index| eigen.eigenvectors.column(index).into_owned()));
        Ok(Self { mass: flags.mass, inertia, gravitation: flags.gravitation, moments, axes })
    }

    /// The same body with another inertia tensor, `factor` times as large.
    pub fn scaled(&self, factor: f64) -> Self {
        Self { inertia: self.inertia * factor, moments: self.moments * factor, ..*self }
    }
}

/// Which principal axis points where.
#[derive(Clone, Copy, Debug)]
pub struct Orientation {
    /// The order of the moments, from 0 for the least. They are about the radius (yaw), the direction of flight (roll)
    /// and the normal of the orbit (pitch).
    pub places: [usize; 3],
    /// Moments about these, kg·m².
    pub moments: Vector3<f64>,
    /// Their axes in the body frame, as columns, right-handed.
    pub axes: Matrix3<f64>,
}

impl Orientation {
    /// All six.
    pub const ALL: [[usize; 3]; 6] = [[0, 1, 2], [1, 0, 2], [0, 2, 1], [2, 0, 1], [1, 2, 0], [2, 1, 0]];

    /// With these axes about radius, direction of flight and normal.
    pub fn new(body: &Body, places: [usize; 3]) -> Self {
        let mut axes = Matrix3::from_columns(&places.map(|place| body.axes.column(place).into_owned()));
        if axes.determinant() < 0.0 {
            axes.column_mut(2).neg_mut();
        }
        Self { places, moments: Vector3::from(places.map(|place| body.moments[place])), axes }
    }

    /// Lagrange's: the longest axis points to the planet, the largest moment is about the normal.
    pub fn stable(body: &Body) -> Self {
        Self::new(body, Self::ALL[0])
    }
}
