//! A field has implicit steps only where it asks for them.

use clebsch::{Clebsch, Field};

#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |a: Translation<1>, x: Vector1| x + a,
    cost   = |h, a| a.norm_squared() / (2 * h),
    space  = |dx, x, next| (next - x).norm_squared() / (2 * dx.powi(2)),
)]
struct Strand;

fn main() {
    let stepper = Strand.grid([8]).midpoint(0.1);
}
