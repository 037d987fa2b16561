//! The free body as it is declared, with three discretizations of the same Lagrangian.

use clap::ValueEnum;
use clebsch::{Clebsch, Variational};
use nalgebra::{Matrix3, Vector3};

/// How a velocity is made of a group element.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Discretization {
    /// Moser's and Veselov's.
    MoserVeselov,
    /// By Cayley's map.
    Cayley,
    /// By the exponential.
    Exponential,
}

impl Discretization {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::MoserVeselov, Self::Cayley, Self::Exponential];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::MoserVeselov => "Moser-Veselov",
            Self::Cayley => "Cayley",
            Self::Exponential => "exponential",
        }
    }
}

/// A declared free body.
pub trait FreeBody:
    Variational<3>
    + Clebsch<
        Scalar = f64,
        Configuration = Matrix3<f64>,
        Momentum = Vector3<f64>,
        MomentumMatrix = Matrix3<f64>,
        Time = (),
        Input = (),
    >
{
    /// With this inertia tensor, kg·m².
    fn with_inertia(inertia: Matrix3<f64>) -> Self;
}

/// Declares the body with one discretization, so that all of them are the same body.
#[rustfmt::skip]
macro_rules! free_body {
    ($name:ident, $discretization:tt) => {
        /// A body that nothing acts on: ∫ ½ Ω·JΩ dt is its action.
        #[derive(Clebsch, Clone, Debug)]
        #[clebsch(
            action         = |F: SO<3>, R: SO<3>| R * F,
            lagrangian     = |omega| omega.dot(&(self.inertia * omega)) / 2,
            discretization = $discretization,
            emit           = [boundary],
        )]
        pub struct $name {
            /// Inertia tensor about the centre of mass, body frame, kg·m².
            #[clebsch(symmetric)]
            pub inertia: Matrix3<f64>,
        }

        impl FreeBody for $name {
            fn with_inertia(inertia: Matrix3<f64>) -> Self {
                Self { inertia }
            }
        }
    };
}

free_body!(MoserVeselov, moser_veselov);
free_body!(Cayley, cayley);
free_body!(Exponential, exponential);
