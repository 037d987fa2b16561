//! A field steps its edges by themselves only where it asks for a connection.

use clebsch::{Clebsch, Field};
use nalgebra::Matrix3;

#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SO<3>, R: SO<3>| R * F,
    cost   = |h, F| (F - I).norm_squared() / (4 * h),
    space  = |dx, W| (W - I).norm_squared() / (4 * dx.powi(2)),
)]
struct Chiral;

fn main() {
    let chain = Chiral.grid([8]);
    let stepper = chain.connection(0.1);
    let elements = chain.edge_elements(&[Matrix3::identity(); 8]);
}
