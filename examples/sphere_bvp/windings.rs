//! Several extremals between the same points: the long way, another turn, and between opposite points both ways.

use crate::great_circle::GreatCircle;
use crate::polygon::{Defects, ROUNDING};
use clebsch::{Clebsch, Error, Guess, Stepper, Variational};
use clebsch_examples::claims::Claims;
use clebsch_examples::scene::{Failure, say};
use clebsch_examples::table::Table;
use nalgebra::{SMatrix, SVector};

/// Steps of each arc: the longest, of 3π, has to turn by less than π/2 a step.
const STEPS: usize = 100;

/// Solves with guesses that lead round in all these ways, prints and claims the closed forms.
pub fn follow<S, const D: usize, const M: usize>(
    sphere: S,
    (start, target): (SVector<f64, D>, SVector<f64, D>),
    duration: f64,
    claims: &mut Claims,
) -> Result<(), Failure>
where
    S: Variational<M> + Clebsch<Scalar = f64, Configuration = SVector<f64, D>>,
    S::MomentumMatrix: Into<SMatrix<f64, D, D>>,
{
    let stepper = sphere.into_stepper(duration / STEPS as f64)?;
    let boundary = stepper.boundary();
    let mut path = vec![boundary.rest(&start); STEPS];
    let unguided = boundary.solve(&start, &-start, Guess::Geodesic, &mut path);
    let refused = matches!(unguided, Err(Error::UndeterminedDirection { distance }) if (distance - 2.0).abs() < 1e-12);
    let sphere = D - 1;
    let reason = "refused: the direction is undetermined, the distance is 2";
    claims.holds(&format!("S{sphere}: opposite points without a guess"), refused, reason);

    let (mut table, mut isolated, mut halves, mut indices) = (Table::new(HEADINGS), 0.0_f64, 0.0_f64, true);
    for (name, arc) in ways(&start, &target) {
        let (defects, index) = round(&stepper, start, (name, &arc), &mut table)?;
        match arc.index() {
            Some(theory) => {
                isolated = isolated.max(defects.over_rounding(STEPS));
                indices &= index == theory;
            }
            None => halves = halves.max(defects.over_rounding(STEPS)),
        }
    }
    say(format_args!("ways round S{sphere} in {STEPS} steps\n"));
    say(table);
    claims.at_most(&format!("S{sphere}: each way round is its great circle"), isolated, 1.0, ROUNDING);
    let reason = "directions across the arc times half turns";
    claims.holds(&format!("S{sphere}: the indices are Morse's"), indices, reason);
    // Which of all half circles is left to rounding, but not that it is one.
    claims.at_most(&format!("S{sphere}: to the opposite point both ways"), halves, 1.0, ROUNDING);
    Ok(())
}

const HEADINGS: [&str; 7] =
    ["way round", "angle / rad", "action / J s", "from the circle", "iterations", "index", "theory"];

/// Arcs to the target, and to the point opposite to the start.
fn ways<const D: usize>(start: &SVector<f64, D>, target: &SVector<f64, D>) -> [(&'static str, GreatCircle<D>); 6] {
    let short = GreatCircle::between(*start, *target);
    let long = short.other_way();
    [
        ("the short way", short),
        ("the long way", long),
        ("the short way and a turn", short.one_more_turn()),
        ("the long way and a turn", long.one_more_turn()),
        ("to the opposite point", GreatCircle::half(*start, short.direction)),
        ("to it the other way", GreatCircle::half(*start, -short.direction)),
    ]
}

/// Solves for one arc: how far the extremal is from it, and its index.
fn round<S, const D: usize, const M: usize>(
    stepper: &Stepper<S>,
    start: SVector<f64, D>,
    (name, arc): (&str, &GreatCircle<D>),
    table: &mut Table<7>,
) -> Result<(Defects, usize), Failure>
where
    S: Variational<M> + Clebsch<Scalar = f64, Configuration = SVector<f64, D>>,
    S::MomentumMatrix: Into<SMatrix<f64, D, D>>,
{
    let h = stepper.step_size();
    // For a point of unit mass the momentum of a velocity has the components of the angular velocity in the plane of both.
    let velocity = arc.direction * (arc.angle / (h * STEPS as f64));
    let guess = Guess::Velocity(stepper.momentum_map(&start, &velocity));
    let boundary = stepper.boundary();
    let mut path = vec![boundary.rest(&start); STEPS];
    let extremal = boundary.solve(&start, &arc.end(), guess, &mut path)?;
    // Between opposite points all half circles are extremals: the one that was found, best told by the point a quarter
    // turn away.
    let arc = &if arc.index().is_some() { *arc } else { arc.towards(extremal.nodes()[STEPS / 2].configuration()) };
    let (defects, index) = (Defects::of(&extremal, arc, h), extremal.negative());
    table.row([
        name.to_owned(),
        format!("{:.6}", arc.angle),
        format!("{:.9}", extremal.action()),
        format!("{:.1e}", defects.points),
        extremal.iterations().to_string(),
        arc.index().map_or("-".to_owned(), |_| index.to_string()),
        arc.index().map_or("degenerate".to_owned(), |theory| theory.to_string()),
    ]);
    Ok((defects, index))
}
