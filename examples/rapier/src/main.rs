//! Bodies in rapier, turned by rapier and turned by clebsch.
//!
//! `cargo run --release --manifest-path examples/rapier/Cargo.toml` prints the tables of the book.

use attitudes_in_rapier::theory::{MOMENTS, RATE, STEP, turns_per_second};
use attitudes_in_rapier::{double, single};
use clebsch::Error;

fn main() -> Result<(), Error> {
    println!("theory of the body that turns over: {:.1} turns", turns_per_second(MOMENTS, RATE) * 1e5 * STEP);
    double::tables::print("f64")?;
    single::tables::print("f32")
}
