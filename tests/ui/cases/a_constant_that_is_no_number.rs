//! Constants are read in the code that is generated: rustc knows their types, and its error stands at the constant.

use clebsch::Clebsch;

const G: [f64; 3] = [0.0, 0.0, -9.81];
const COUNT: usize = 3;

#[derive(Clebsch)]
#[clebsch(
    action    = |a: Translation<3>, x: Vector3| x + a,
    cost      = |h, a| COUNT * a.norm_squared() / (2 * h),
    potential = |x| self.mass * self::G * x.z,
)]
struct Particle {
    mass: f64,
}

fn main() {}
