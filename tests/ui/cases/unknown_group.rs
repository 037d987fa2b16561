//! The span of a type.

use clebsch::Clebsch;

#[derive(Clebsch, Clone, Debug)]
#[clebsch(action = |F: SO3, q: Unit<Vector3>| F * q, cost = |h, F| self.mass * (F - I).norm_squared() / (4 * h))]
struct Pendulum {
    mass: f64,
}

fn main() {}
