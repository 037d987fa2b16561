//! Extremals by shooting in all directions: is there one that the guesses have missed?

use crate::Problem;
use crate::rolling::{Costate, Shot};
use crate::way::Way;
use clebsch_examples::claims::Claims;
use clebsch_examples::progress::Progress;
use clebsch_examples::scene::say;

/// Shots.
const SHOTS: u32 = 100;
/// The largest entry of a costate to shoot with, in its units.
const LARGEST: f64 = 10.0;
/// The root of x⁶ = x + 1: its negative powers fill the cube evenly (Roberts, 2018, after Kronecker's sequences).
const ROOT: f64 = 1.134_724_138_401_519_4;
/// Prices that differ by less, relative, are the same.
const SAME: f64 = 1e-6;

/// The prices of the extremals up to that of the last of `ways`, the least first, m²/s.
pub fn take(problem: &Problem, ways: &[Way]) -> Vec<f64> {
    let largest = ways.iter().filter_map(|way| way.shot).fold(0.0, |price: f64, shot| price.max(shot.price));
    let mut progress = Progress::of(u64::from(SHOTS), "shots");
    let mut prices: Vec<f64> = Vec::new();
    for number in 1..=SHOTS {
        let entry = |index: usize, _| {
            let part = (f64::from(number) * ROOT.powi(-(index as i32 + 1))).fract();
            LARGEST * (2.0 * part - 1.0)
        };
        let shot = Shot::aim(problem, &Costate::from_fn(entry));
        prices.extend(shot.map(|shot| shot.price).filter(|price| *price <= largest * (1.0 + SAME)));
        progress.reached(u64::from(number));
    }
    prices.sort_by(f64::total_cmp);
    prices.dedup_by(|a, b| (*a / *b - 1.0).abs() < SAME);
    prices
}

/// The least of the ways is the least of the shots.
pub fn claim(ways: &[Way], prices: &[f64], claims: &mut Claims) {
    let shown: Vec<_> = prices.iter().map(|price| format!("{price:.6}")).collect();
    say(format_args!(
        "extremals up to there that {SHOTS} shots of the continuous ball find, m²/s: {}\n",
        shown.join(", ")
    ));
    let name = "no extremal by shooting costs less than the least";
    match (ways[0].shot, prices.first()) {
        (Some(least), Some(found)) => {
            let reason = format!("m²/s, the least of {} prices by shooting", prices.len());
            claims.at_most(name, least.price, found * (1.0 + SAME), &reason);
        }
        (Some(_), None) => claims.skip(name, "no shot arrives"),
        (None, _) => claims.skip(name, "no continuous extremal is near: too long a step"),
    }
}
