//! The span of a keyword of the item.

use clebsch::Clebsch;

#[derive(Clebsch)]
#[clebsch(action = |F: SO<3>, R: SO<3>| R * F, cost = |h, F| (F - I).norm_squared() / (4 * h))]
enum Body {
    Free,
}

fn main() {}
