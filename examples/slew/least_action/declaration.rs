//! The free body as it is declared, with three discretizations of the same Lagrangian.

use clap::ValueEnum;
use clebsch::Clebsch;
use nalgebra::Matrix3;

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

/// A body that nothing acts on: ∫ ½ Ω·JΩ dt is its action.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |F: SO<3>, R: SO<3>| R * F,
    lagrangian     = |omega| omega.dot(&(self.inertia * omega)) / 2,
    discretization = moser_veselov,
    emit           = [boundary],
    method Cayley      = (discretization = cayley),
    method Exponential = (discretization = exponential),
)]
pub struct FreeBody {
    /// Inertia tensor about the centre of mass, body frame, kg·m².
    #[clebsch(symmetric)]
    pub inertia: Matrix3<f64>,
}

/// Velocities by Cayley's map.
pub struct Cayley;

/// Velocities by the exponential.
pub struct Exponential;
