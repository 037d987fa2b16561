//! Rods at rest: rolled up by a moment, a cantilever, and the 45° bend of Bathe and Bolourchi.

use crate::continuous::Rod;
use crate::declaration::{StaticRod, centre};
use clebsch::{Clebsch, Guess};
use clebsch_examples::claims::{Claims, largest};
use clebsch_examples::round_off;
use clebsch_examples::scene::Failure;
use clebsch_examples::table::Table;
use nalgebra::{Matrix4, SVector, Vector3, Vector6};
use std::f64::consts::{FRAC_PI_4, TAU};

/// Edges of the grids.
const EDGES: [usize; 3] = [4, 8, 16];
/// Deflection of a cantilever without shear and stretch for P L²/EI = 1, by elliptic integrals.
const ELASTICA: f64 = 0.301_720_773_8;
/// How far a measured order may be from 2.
const SLOPE: f64 = 0.1;

/// Shapes of a rod in the picture.
const SHAPES: usize = 8;

/// Places along a rod.
pub type Line = Vec<Vector3<f64>>;

/// Shapes for growing loads.
#[derive(Clone, Debug)]
pub struct Shapes {
    /// A circle of one radius, a force across, a bend.
    pub all: [Vec<Line>; 3],
}

/// A rod that is clamped and pulled.
#[derive(Clone, Copy, Debug)]
struct Pulled {
    name: &'static str,
    rod: Rod,
    stiffness: SVector<f64, 6>,
    /// Loads on the way to the last one.
    loads: usize,
}

/// EI = L = 1, with little shear and stretch, and a force across it.
fn cantilever(pull: f64) -> Pulled {
    let stiffness = Vector6::new(1.0, 1.0, 1.0, 1e4, 1e4, 1e4);
    let rod = Rod {
        length: 1.0,
        compliance: stiffness.map(f64::recip),
        curvature: Vector3::zeros(),
        pull: Vector3::new(0.0, pull, 0.0),
    };
    Pulled { name: "cantilever", rod, stiffness, loads: 8 }
}

/// A bend of radius 100 and section 1 by 1, E = 1e7, G = 5e6, GJ = G/6 and shear factor 5/6, in inches and pounds.
fn bend() -> Pulled {
    let stiffness = Vector6::new(1e7 / 12.0, 1e7 / 12.0, 5e6 / 6.0, 5e6 / 1.2, 5e6 / 1.2, 1e7);
    let rod = Rod {
        length: 100.0 * FRAC_PI_4,
        compliance: stiffness.map(f64::recip),
        curvature: Vector3::new(0.0, 0.01, 0.0),
        pull: Vector3::new(0.0, 600.0, 0.0),
    };
    Pulled { name: "45° bend", rod, stiffness, loads: 160 }
}

impl Pulled {
    fn unloaded(&self, edges: usize) -> Line {
        let (ds, bend) = (self.rod.length / edges as f64, self.rod.curvature.y);
        let place = |s: f64| match bend {
            0.0 => Vector3::z() * s,
            _ => Vector3::new((1.0 - (bend * s).cos()) / bend, 0.0, (bend * s).sin() / bend),
        };
        (0..=edges).map(|i| place(ds * i as f64)).collect()
    }

    /// Places along the rod with so many edges for some loads, the last one among them, and its moment at the clamp.
    fn solve(&self, edges: usize) -> Result<(Vec<Line>, Vector3<f64>), Failure> {
        let curvature = self.rod.curvature;
        let reference = Vector6::new(curvature.x, curvature.y, curvature.z, 0.0, 0.0, 1.0);
        let start = Matrix4::identity();
        let mut path = Vec::new();
        let mut found = (vec![self.unloaded(edges)], Vector3::zeros());
        for load in 1..=self.loads {
            let pull = self.rod.pull * (load as f64 / self.loads as f64);
            let rod = StaticRod { stiffness: self.stiffness, reference, pull };
            let stepper = rod.into_stepper(self.rod.length / edges as f64)?;
            let boundary = stepper.boundary();
            let guess = if load == 1 { Guess::Velocity(reference) } else { Guess::Path };
            path.resize(edges, boundary.rest(&start));
            let extremal = boundary.solve_free(&start, guess, &mut path)?;
            if load % (self.loads / SHAPES) == 0 {
                let places = extremal.nodes().iter().map(|node| centre(node.configuration()));
                found.0.push(places.chain([centre(extremal.end())]).collect());
                found.1 = extremal.momentum().fixed_rows::<3>(0).into_owned();
            }
        }
        Ok(found)
    }
}

/// A rod that is rolled up by a part of the moment 2πEI/L.
fn rolled_up(edges: usize, part: f64) -> Result<Line, Failure> {
    let Pulled { stiffness, rod, .. } = cantilever(0.0);
    let straight = Vector6::new(0.0, 0.0, 0.0, 0.0, 0.0, 1.0);
    let rolled = StaticRod { stiffness, reference: straight, pull: Vector3::zeros() };
    let stepper = rolled.into_stepper(rod.length / edges as f64)?;
    let mut state = stepper.state(Matrix4::identity(), Vector6::new(TAU * part, 0.0, 0.0, 0.0, 0.0, 0.0))?;
    let mut places = vec![Vector3::zeros()];
    for step in 1..=edges as u64 {
        state = stepper.step(&state).map_err(|error| Failure::Step { step, error })?;
        places.push(centre(state.configuration()));
    }
    Ok(places)
}

/// A table of ends, claims about them, and shapes for the picture.
///
/// # Errors
/// Those of a solution.
pub fn compare(claims: &mut Claims) -> Result<(Table<5>, Shapes), Failure> {
    let last = |line: &Line| line.last().copied().unwrap_or_default();
    let gaps = EDGES.map(|edges| rolled_up(edges, 1.0).map(|line| last(&line).norm()));
    let gap = largest(gaps.into_iter().collect::<Result<Vec<f64>, Failure>>()?);
    let name = "rolled up by a moment: the end is at the start, m";
    claims.at_most(name, gap, round_off::worst_case(EDGES[2] as u64, 1.0), "rounding, on all grids");
    let mut table = Table::new(["rod", "edges", "x", "y", "z"]);
    let mut row = |name: &str, edges: &str, end: Vector3<f64>| {
        let [x, y, z] = [end.x, end.y, end.z].map(|number| format!("{:.6}", (number * 1e6).round() / 1e6 + 0.0));
        table.row([name.to_owned(), edges.to_owned(), x, y, z]);
    };
    let mut shapes = Vec::new();
    for pulled in [cantilever(1.0), cantilever(10.0), bend()] {
        let mut ends = Vec::new();
        let mut near = Vector3::zeros();
        let name = format!("{}, P = {}", pulled.name, pulled.rod.pull.y);
        for edges in EDGES {
            let (lines, moment) = pulled.solve(edges)?;
            near = moment;
            ends.push(lines.last().map(last).unwrap_or_default());
            row(&name, &edges.to_string(), ends[ends.len() - 1]);
            if edges == EDGES[2] {
                shapes.push(lines);
            }
        }
        let (exact, left) = pulled.rod.tip(near);
        row(&name, "continuous", exact);
        let [middle, fine] = [1, 2].map(|i| (ends[i] - exact).norm());
        let reason = format!("error with 16 edges {fine:.1e}; moment left by the other integration {left:.0e}");
        claims.within(&format!("{name}: order"), (middle / fine).log2(), 2.0 - SLOPE..=2.0 + SLOPE, 3, &reason);
    }
    // without shear and stretch
    let Rod { compliance, .. } = cantilever(1.0).rod;
    let rigid = Rod { compliance: compliance.map(f64::floor), ..cantilever(1.0).rod };
    let off = (rigid.tip(Vector3::x()).0.y - ELASTICA).abs();
    claims.at_most("the other integration, without shear: elliptic integrals", off, 1e-9, "of 0.3017207738 for P = 1");
    let rolled = (0..=SHAPES).map(|i| rolled_up(4 * EDGES[2], i as f64 / SHAPES as f64)).collect::<Result<_, _>>()?;
    let bent = shapes.pop().unwrap_or_default();
    Ok((table, Shapes { all: [rolled, shapes.pop().unwrap_or_default(), bent] }))
}
