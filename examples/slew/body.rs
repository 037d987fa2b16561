//! Rigid spacecraft by their published inertia tensors.
//!
//! Station: the International Space Station as in Betts, *Practical Methods for Optimal Control and Estimation Using
//! Nonlinear Programming*, second edition (2010). The data are on page 293 and following, there in slug·ft². They are
//! after Pietz, *Pseudospectral collocation methods for the direct transcription of optimal control problems*, Rice
//! University (2003). Envisat: Bastida Virgili, Lemmens and Krag, *Investigation on Envisat attitude motion*, e.Deorbit
//! Workshop, ESA (2014).

use crate::Flags;
use clap::ValueEnum;
use clebsch_examples::scene::Failure;
use nalgebra::{Matrix3, Vector3};

/// kg·m² in a slug·ft²: 0.45359237 × 9.80665 × 0.3048.
const SLUG_FOOT_SQUARED: f64 = 1.355_817_948_331_400_4;

/// A spacecraft whose inertia has been published.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Craft {
    /// The International Space Station.
    Station,
    /// Envisat.
    Envisat,
}

impl Craft {
    /// xx, yy, zz, xy, xz, yz of the inertia tensor about the centre of mass, body frame, kg·m².
    fn inertia(self) -> [f64; 6] {
        match self {
            Self::Station => {
                [2.80701911616e7, 9.5144639344e7, 7.6594401336e7, 4.822509936e5, -1.71675094448e7, 6.02604448e4]
                    .map(|entry| entry * SLUG_FOOT_SQUARED)
            }
            Self::Envisat => [17023.3, 124825.7, 129112.2, 397.1, -2171.4, 344.2],
        }
    }
}

/// A rigid body that can exist.
#[derive(Clone, Copy, Debug)]
pub struct Body {
    /// About the centre of mass, body frame, kg·m².
    pub inertia: Matrix3<f64>,
    /// Principal moments, the least first, kg·m².
    pub moments: Vector3<f64>,
}

impl Body {
    /// From the flags.
    ///
    /// # Errors
    /// [`Failure::Flags`] where no body has this inertia tensor.
    pub fn new(flags: &Flags) -> Result<Self, Failure> {
        let [xx, yy, zz, xy, xz, yz] = flags.inertia.unwrap_or_else(|| flags.body.inertia());
        let inertia = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
        let mut moments: [f64; 3] = inertia.symmetric_eigenvalues().into();
        moments.sort_by(f64::total_cmp);
        let [a, b, c] = moments;
        if a <= 0.0 || c > a + b {
            return Err(Failure::Flags(format!(
                "no body has the principal moments {a:.6e}, {b:.6e}, {c:.6e}: all are above zero, the largest is no more than the sum of the others"
            )));
        }
        Ok(Self { inertia, moments: moments.into() })
    }

    /// The angular velocity J⁻¹π, rad/s, of a momentum in the body frame.
    pub fn spin(&self, momentum: &Vector3<f64>) -> Vector3<f64> {
        self.inertia.lu().solve(momentum).unwrap_or_else(|| Vector3::repeat(f64::NAN))
    }
}
