//! SU(3) in the table of `clebsch-laws --test trust`, in a program of its own: without optimisation its steps would take longer than those of all
//! other groups.

#![allow(missing_docs)]

#[path = "../laws/tests/trust/checks.rs"]
mod checks;
#[path = "../laws/tests/trust/shapes.rs"]
mod shapes;
#[macro_use]
#[path = "../laws/tests/trust/table.rs"]
mod table;

use clebsch::Clebsch;
use clebsch_tests::oracle::precise::group;
use clebsch_tests::oracle::precise::matrix::Matrix;
use clebsch_tests::oracle::precise::on_itself::{Kind, Kinetic, OnItself};
use clebsch_tests::oracle::random::Random;
use nalgebra::SMatrix;

// the Cayley map leaves the group, and its projection makes long formulas
groups! {
    su3: [SU<3>], 6, 8, projection, group::su(3);
}
