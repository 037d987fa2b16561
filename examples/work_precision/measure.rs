//! The measurements of each setting at each place of its dial.

use crate::exact::Exact;
use crate::motion::Scene;
use crate::setting::{Dial, Family, Name, SAMPLES, Setting};
use clebsch_examples::claims::largest;
use clebsch_examples::progress::Progress;
use nalgebra::{SVector, Vector6};
use std::time::Instant;

/// Above this a motion has little to do with the exact one.
const LARGEST_ERROR: f64 = 0.3;
/// Below this rounding may show.
const SMALLEST_ERROR: f64 = 1e-9;
/// Each reading of the clock is the least of so many, and between two of them all other settings are read.
const READINGS: usize = 7;

/// One setting at one place of its dial.
#[derive(Clone, Copy, Debug)]
pub struct Point {
    /// The setting.
    pub name: Name,
    /// Its dial.
    pub dial: Dial,
    /// Length of a step, the mean where it varies.
    pub h: f64,
    /// Number of steps.
    pub steps: u64,
    /// Largest at the samples, relative.
    pub error: f64,
    /// Nanoseconds for one unit of simulated time.
    pub time: f64,
    /// Largest error of the energy in each half of the duration.
    pub energy: [f64; 2],
    /// Largest change of the momenta that the motion keeps.
    pub momenta: f64,
    /// How far the configuration leaves its space, at most.
    pub constraint: f64,
    /// The settings that it beats.
    pub front: Front,
}

/// Whether a point is on a front: no other one is better in both error and time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Front {
    /// Another one beats it.
    Behind,
    /// It is on the front of those that keep the geometry, and a classical one beats it.
    Geometric,
    /// None beats it.
    All,
}

/// How fine the dials are and how far they go.
#[derive(Clone, Copy, Debug)]
pub struct Grid {
    /// Places of a dial between a step and its half, or between a tolerance and a tenth of it.
    pub finer: u32,
    /// Steps of a motion, at most.
    pub most: u64,
    /// Seconds after which a motion is not repeated with shorter steps.
    pub patience: f64,
}

/// All points of a scene.
pub fn measure<const N: usize>(scene: &Scene<N>, exact: &Exact<N>, grid: Grid) -> Vec<Point> {
    let mut progress = Progress::of(scene.settings.len() as u64 + READINGS as u64, scene.name);
    let mut points: Vec<(usize, Point)> = Vec::new();
    for (index, setting) in scene.settings.iter().enumerate() {
        points.extend(walk_all(scene, exact, setting.as_ref(), grid).into_iter().map(|point| (index, point)));
        progress.reached(index as u64 + 1);
    }
    for reading in 0..READINGS {
        for (index, point) in &mut points {
            point.time = point.time.min(scene.settings[*index].clock(point.dial, scene.duration));
        }
        progress.reached((scene.settings.len() + reading) as u64 + 1);
    }
    let mut points: Vec<Point> = points.into_iter().map(|(_, point)| point).collect();
    mark_front(&mut points);
    points
}

/// From the longest steps to where shorter ones do not help any more.
fn walk_all<const N: usize>(scene: &Scene<N>, exact: &Exact<N>, setting: &dyn Setting<N>, grid: Grid) -> Vec<Point> {
    let mut points: Vec<Point> = Vec::new();
    // errors of order 16 differ by 65 536 between a step and its half
    let finer = grid.finer * if setting.name().order > 8 { 4 } else { 1 };
    for dial in dials(setting.is_adaptive(), Grid { finer, ..grid }) {
        let began = Instant::now();
        let Some(point) = walk(scene, exact, setting, dial) else { continue };
        let last = points.last().map_or(f64::INFINITY, |last| last.error);
        if point.error < SMALLEST_ERROR && point.error > 0.7 * last {
            break;
        }
        if point.error < LARGEST_ERROR {
            points.push(point);
        }
        if began.elapsed().as_secs_f64() > grid.patience {
            break;
        }
    }
    points
}

fn dials(adaptive: bool, grid: Grid) -> Vec<Dial> {
    let places = 0..60 * grid.finer;
    let fraction = |place: u32| f64::from(place) / f64::from(grid.finer);
    if adaptive {
        let tolerances = places.map(|place| 10_f64.powf(-1.0 - fraction(place)));
        return tolerances.filter(|tolerance| *tolerance > 3e-15).map(Dial::Tolerance).collect();
    }
    let mut steps: Vec<u64> = places.map(|place| (4.0 * fraction(place).exp2()).round() as u64).collect();
    steps.retain(|steps| *steps <= grid.most / SAMPLES);
    steps.into_iter().map(Dial::Steps).collect()
}

/// Error and drifts; `None` where a step is refused, as it is too long.
fn walk<const N: usize>(scene: &Scene<N>, exact: &Exact<N>, setting: &dyn Setting<N>, dial: Dial) -> Option<Point> {
    let mut seen = Seen::new(scene);
    let steps = setting.walk(dial, scene.duration, &mut |time, y| seen.observe(scene, exact, time, y)).ok()?;
    let Seen { error, energy, momenta, constraint, .. } = seen;
    let (name, h) = (setting.name(), scene.duration / steps as f64);
    Some(Point { name, dial, h, steps, error, time: f64::INFINITY, energy, momenta, constraint, front: Front::Behind })
}

/// The observations of a motion.
struct Seen {
    start_energy: f64,
    start_momenta: Vector6<f64>,
    error: f64,
    energy: [f64; 2],
    momenta: f64,
    constraint: f64,
}

impl Seen {
    fn new<const N: usize>(scene: &Scene<N>) -> Self {
        let (start_energy, start_momenta) = ((scene.energy)(&scene.start), (scene.momenta)(&scene.start));
        Self { start_energy, start_momenta, error: 0.0, energy: [0.0; 2], momenta: 0.0, constraint: 0.0 }
    }

    fn observe<const N: usize>(&mut self, scene: &Scene<N>, exact: &Exact<N>, time: f64, y: &SVector<f64, N>) {
        let sample = SAMPLES as f64 * time / scene.duration;
        if (sample - sample.round()).abs() < 1e-9 {
            self.error = largest([self.error, scene.distance(y, &exact.samples[sample.round() as usize])]);
        }
        let half = &mut self.energy[usize::from(2.0 * time > scene.duration)];
        *half = largest([*half, ((scene.energy)(y) - self.start_energy).abs()]);
        self.momenta = largest([self.momenta, ((scene.momenta)(y) - self.start_momenta).amax()]);
        self.constraint = largest([self.constraint, (scene.constraint)(y)]);
    }
}

/// Marks the points that no other beats in both error and time.
fn mark_front(points: &mut [Point]) {
    let all = points.to_vec();
    for point in points {
        let beats = |other: &Point| other.error < point.error && other.time < point.time;
        point.front = if !all.iter().any(beats) {
            Front::All
        } else if point.is_geometric() && !all.iter().any(|other| other.is_geometric() && beats(other)) {
            Front::Geometric
        } else {
            Front::Behind
        };
    }
}

impl Point {
    /// Whether its setting is a declaration of this project.
    pub fn is_geometric(&self) -> bool {
        self.name.family == Family::Geometric
    }
}

/// The points of each setting, in their order.
pub fn by_setting(points: &[Point]) -> impl Iterator<Item = &[Point]> {
    points.chunk_by(|a, b| a.name == b.name)
}

/// Time and length of steps at which a setting has an error, between two of its points by powers. If its longest steps
/// are better than that, they are taken.
pub fn at_error(points: &[Point], error: f64) -> Option<(f64, f64)> {
    let first = points.first()?;
    if first.error <= error {
        return Some((first.time, first.h));
    }
    let pair = points.windows(2).find(|pair| pair[0].error > error && pair[1].error <= error)?;
    let share = (error / pair[0].error).ln() / (pair[1].error / pair[0].error).ln();
    let between = |of: fn(&Point) -> f64| of(&pair[0]) * (of(&pair[1]) / of(&pair[0])).powf(share);
    Some((between(|point| point.time), between(|point| point.h)))
}
