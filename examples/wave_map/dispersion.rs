//! Frequencies of the grid: of small standing waves, and of spirals of any amplitude, against the closed form.
//!
//! ```text
//! sin²(ωh/2)/h² = sin²(k₁dx/2)/dx² + sin²(k₂dy/2)/dy²
//! ```
//! A spiral is q = (sin α cos φ, sin α sin φ, cos α) with φ = k·x + ωt.
//! The equations of the grid: (q₊ + q₋)/h² less the sums of neighbours over dx² and dy² is along q.
//! Spirals of every α obey them if and only if ω obeys the formula.

use crate::sheet::{Start, steps};
use clebsch_examples::claims::{Claims, largest};
use clebsch_examples::round_off;
use clebsch_examples::scene::Failure;
use clebsch_examples::table::Table;
use nalgebra::{Rotation2, Vector2, Vector3};
use std::f64::consts::TAU;

/// Sites of the grid that the waves run on.
const SIZES: [usize; 2] = [16, 12];
/// Waves around the grid in each direction.
const WAVES: [[usize; 2]; 6] = [[1, 0], [0, 1], [1, 1], [3, 2], [5, 4], [8, 6]];
/// So many of them are spirals too: shorter spirals are unstable.
const SPIRALS: usize = 4;
/// Metres.
const SPACING: [f64; 2] = [0.5, 0.6];
/// Seconds.
const STEP: f64 = 0.2;
/// Steps of each run.
const STEPS: u64 = 60;
/// Of the standing wave, rad. Its frequency is off by the square.
const AMPLITUDE: f64 = 1e-5;
/// Of the spiral.
const TILT: f64 = 0.9;

/// One wave on a grid.
struct Wave {
    waves: [usize; 2],
}

impl Wave {
    /// k dx in both directions.
    fn angles(&self) -> [f64; 2] {
        [0, 1].map(|d| TAU * self.waves[d] as f64 / SIZES[d] as f64)
    }

    /// That of the grid, 1/s.
    fn of_grid(&self) -> f64 {
        let angles = self.angles();
        let square: f64 = (0..2).map(|d| ((angles[d] / 2.0).sin() / SPACING[d]).powi(2)).sum();
        2.0 / STEP * (STEP * square.sqrt()).asin()
    }

    /// That of the continuous field, |k|.
    fn of_space(&self) -> f64 {
        let angles = self.angles();
        (angles[0] / SPACING[0]).hypot(angles[1] / SPACING[1])
    }

    /// k·x of all sites.
    fn phases(&self) -> impl Iterator<Item = f64> {
        let angles = self.angles();
        (0..SIZES[0] * SIZES[1])
            .map(move |index| angles[0] * (index / SIZES[1]) as f64 + angles[1] * (index % SIZES[1]) as f64)
    }

    /// Steps from a start; `read` sums one number of each state over all sites, from q and k·x.
    fn run(&self, start: Start, read: fn(&Vector3<f64>, f64) -> Vector2<f64>) -> Result<Vec<Vector2<f64>>, Failure> {
        let stepper = steps(SIZES, SPACING, STEP)?;
        let mut state = stepper.state(start.0, start.1)?;
        let mut sums = Vec::new();
        for step in 0..=STEPS {
            if step > 0 {
                stepper.step(&mut state).map_err(Failure::step(step))?;
            }
            sums.push(state.configuration().iter().zip(self.phases()).map(|(q, phase)| read(q, phase)).sum());
        }
        Ok(sums)
    }

    /// Of a small standing wave: c(t + h) + c(t − h) = 2 cos(ωh) c(t), by least squares.
    fn standing(&self) -> Result<f64, Failure> {
        let turned = |phase: f64| {
            let (sin, cos) = (AMPLITUDE * phase.cos()).sin_cos();
            Vector3::new(sin, 0.0, cos)
        };
        let start = (self.phases().map(turned).collect(), vec![Vector3::zeros(); SIZES[0] * SIZES[1]]);
        let sums = self.run(start, |q, phase| Vector2::new(q.x * phase.cos(), 0.0))?;
        let (mut products, mut squares) = (0.0, 0.0);
        for three in sums.windows(3) {
            products += three[1].x * (three[0].x + three[2].x) / 2.0;
            squares += three[1].x * three[1].x;
        }
        Ok((products / squares).acos() / STEP)
    }

    /// Of a spiral: how far it turns in all steps.
    fn spiral(&self) -> Result<f64, Failure> {
        let (sin, cos) = TILT.sin_cos();
        let q: Vec<Vector3<f64>> =
            self.phases().map(|phase| Vector3::new(sin * phase.cos(), sin * phase.sin(), cos)).collect();
        // N = q × (q₊ − q₋)/2h
        let rate = (self.of_grid() * STEP).sin() / STEP;
        let mu = q.iter().map(|q| (Vector3::z() - q * q.z) * rate).collect();
        let sums = self.run((q, mu), |q, phase| Rotation2::new(-phase) * q.xy())?;
        let turned: f64 = sums.windows(2).map(|two| two[0].perp(&two[1]).atan2(two[0].dot(&two[1]))).sum();
        Ok(turned / (STEP * STEPS as f64))
    }
}

/// A table of frequencies, and the claims about them.
///
/// # Errors
/// Those of steps.
pub fn compare(claims: &mut Claims) -> Result<Table<5>, Failure> {
    let mut table = Table::new(["waves around", "|k| / 1/s", "of the grid", "standing wave", "spiral"]);
    let (mut standing_off, mut spiral_off) = (Vec::new(), Vec::new());
    for (index, waves) in WAVES.into_iter().enumerate() {
        let wave = Wave { waves };
        let (exact, standing) = (wave.of_grid(), wave.standing()?);
        standing_off.push((standing / exact - 1.0).abs());
        let mut shown = "unstable".to_owned();
        if index < SPIRALS {
            let spiral = wave.spiral()?;
            spiral_off.push((spiral - exact).abs() * STEP * STEPS as f64);
            shown = format!("{spiral:.9}");
        }
        let [space, exact, standing] = [wave.of_space(), exact, standing].map(|number| format!("{number:.9}"));
        table.row([format!("{}, {}", waves[0], waves[1]), space, exact, standing, shown]);
    }
    let name = "standing waves have the frequency of the grid";
    claims.at_most(name, largest(standing_off), AMPLITUDE * AMPLITUDE, "relative; the square of the amplitude");
    let name = "spirals with a tilt of 0.9 rad turn with it";
    claims.at_most(name, largest(spiral_off), round_off::worst_case(STEPS, 1.0), "rad at the end; rounding");
    Ok(table)
}
