use clebsch::{Clebsch, Field};
use nalgebra::Vector3;

#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SO<3>, q: Unit<Vector3>| F * q,
    cost   = |h, F| (F - I).norm_squared() / (4 * h),
    space  = |dx, q, next| (next - q).norm_squared() / dx,
)]
struct Moving;

#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SO<3>, q: Unit<Vector3>| F * q,
    space  = |dx, q, next| (next - q).norm_squared() / dx,
)]
struct Resting;

fn main() {
    let mut q = [Vector3::x(); 4];
    let _ = Moving.grid([4]).relax().solve(&mut q);
    let _ = Resting.grid([4]).stepper(0.1);
}
