//! A closure over several lines is underlined from its first to its last token.

use clebsch::Clebsch;
use nalgebra::Matrix3;

#[derive(Clebsch)]
#[clebsch(
    action = |F: SO<3>, R: SO<3>| R * F,
    cost   = |h, F| {
        let turning = (self.mass_matrix * (F - I) * (F - I).transpose()).trace();
        h * turning
            / 2
    },
)]
struct Top {
    mass_matrix: Matrix3<f64>,
}

fn main() {}
