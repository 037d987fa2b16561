//! The claims of the study about every declaration.

use crate::exact::Exact;
use crate::measure::{Point, by_setting};
use crate::motion::{ClosedForm, Scene};
use crate::report::{WINDOW, slope};
use crate::setting::{Dial, SAMPLES, Setting};
use clebsch_examples::claims::{Claims, largest};
use clebsch_examples::round_off::worst_case;

/// How far a measured order may be from the declared one, relative.
const SLOPE: f64 = 0.03;
/// The same for order 16, nearer to 16 than to 14 and 18: steps are so long there that the next powers of h show.
const SLOPE_16: f64 = 1.0 / 16.0;
/// Steps of order 2 in one of order 8.
const STAGES: u64 = 17;
/// How much larger the energy error may be in the second half: both are maxima of an oscillation with several periods.
const GROWTH: f64 = 1.25;
/// Rounding of elliptic functions over some twenty periods.
const CLOSED_FORM: f64 = 1e-12;
/// The energy is followed in the longest steps with a smaller error than this.
const TYPICAL: f64 = 1e-2;
/// The error of the reference over the smallest error that a slope is taken from.
const REFERENCE: f64 = 1e-3;

/// Claims for one scene.
pub fn claim<const N: usize>(scene: &Scene<N>, exact: &Exact<N>, points: &[Point], claims: &mut Claims) {
    let name = |what: &str| format!("{}: {what}", scene.title);
    let reason = "two resolutions of it, or rounding of functions; errors that slopes are taken from";
    claims.at_most(&name("the reference is exact enough"), exact.error, REFERENCE * WINDOW[0], reason);

    if let Some(closed_form) = scene.closed_form {
        let off = (0..=SAMPLES).map(|sample| off_closed_form(scene, exact, closed_form, sample));
        let reason = "momenta at ten times beside Jacobi's elliptic functions, relative";
        claims.at_most(&name("the reference is the exact motion"), largest(off), CLOSED_FORM, reason);
    }

    let declared = || by_setting(points).filter(|points| points[0].is_geometric());
    let off: Vec<f64> = declared()
        .filter(|points| !is_collocated(points))
        .filter_map(|points| off_order(points, scene.least_error))
        .collect();
    let low = WINDOW[0].max(scene.least_error);
    let reason = &format!(
        "relative, largest; the last halving with errors of {low:.0e} to 1e-2, of the energy at order 1; not to a tolerance"
    );
    let all = declared().filter(|points| points[0].name.tolerance.is_none() && !is_collocated(points)).count();
    let measured = format!("orders of {} of {all} settings are those declared", off.len());
    claims.at_most(&name(&measured), largest(off), SLOPE, reason);
    let off: Vec<f64> = declared()
        .filter(|points| is_collocated(points))
        .filter_map(|points| off_order(points, scene.least_error))
        .collect();
    if scene.shows_sixteen && !off.is_empty() {
        let reason = "relative, largest; the same errors, in steps of the size of the motion itself";
        claims.at_most(&name("the order of collocation is nearest to 16"), largest(off), SLOPE_16, reason);
    }

    let geometric = || points.iter().filter(|point| point.is_geometric());
    let rounding = |point: &Point, scale: f64| worst_case(STAGES * point.steps, scale);
    let settled = || geometric().filter(|point| point.name.is_settled());
    // a motion that keeps none has zeros in their place
    if (scene.momenta)(&scene.start).amax() > 0.0 {
        let moved = settled().map(|point| point.momenta / rounding(point, scene.momentum_size));
        let reason = "over rounding in the worst case; largest of all points";
        claims.at_most(&name("momenta are kept"), largest(moved), 1.0, reason);
    }
    let off = settled().map(|point| point.constraint / rounding(point, 1.0));
    claims.at_most(&name("motions stay in their space"), largest(off), 1.0, "over rounding in the worst case");

    let settings = scene.settings.iter();
    let grown = settings.filter_map(|setting| growth(scene, setting.as_ref(), points));
    let reason =
        "second half over first in ten to forty times the duration, rounding taken off; largest of all settings";
    claims.at_most(&name("energy errors do not grow"), largest(grown), GROWTH, reason);
}

/// How far the reference's momentum is from the closed form, relative; NaN where there is none.
fn off_closed_form<const N: usize>(scene: &Scene<N>, exact: &Exact<N>, closed_form: ClosedForm, sample: u64) -> f64 {
    let Some(momentum) = closed_form(scene.duration * sample as f64 / SAMPLES as f64) else { return f64::NAN };
    let found = &exact.samples[sample as usize];
    largest((0..3).map(|i| (found[scene.split + i] - momentum[i]).abs())) / scene.momentum_size
}

fn is_collocated(points: &[Point]) -> bool {
    points[0].name.order == 16
}

/// How far the measured order of a setting is from the declared one, relative; `None` where too few errors lie in the window.
fn off_order(points: &[Point], least: f64) -> Option<f64> {
    let order = f64::from(points[0].name.order);
    if points[0].name.tolerance.is_some() {
        return None;
    }
    slope(points, least).map(|slope| (slope / order - 1.0).abs())
}

/// The energy error in the second half over that in the first, for the longest steps with a small error.
fn growth<const N: usize>(scene: &Scene<N>, setting: &dyn Setting<N>, points: &[Point]) -> Option<f64> {
    if setting.name().tolerance.is_some() {
        return None;
    }
    let own = |point: &&Point| point.is_geometric() && point.name == setting.name();
    let point = points.iter().filter(own).find(|point| point.error < TYPICAL)?;
    let Dial::Steps(part) = point.dial else { return None };
    let (start, duration) = ((scene.energy)(&scene.start), scene.longer as f64 * scene.duration);
    let mut halves = [0.0; 2];
    let seen = setting.walk(Dial::Steps(scene.longer * part), duration, &mut |time, y| {
        let half = &mut halves[usize::from(2.0 * time > duration)];
        *half = largest([*half, ((scene.energy)(y) - start).abs()]);
    });
    let rounding = worst_case(STAGES * scene.longer * point.steps, start.abs());
    Some(if seen.is_ok() { ((halves[1] - rounding) / halves[0]).max(0.0) } else { f64::NAN })
}
