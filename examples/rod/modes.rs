//! Frequencies of a thin straight rod with free ends, from the derived forces, against Euler and Bernoulli.

use crate::beam::Beam;
use clebsch::Field;
use clebsch_examples::claims::Claims;
use clebsch_examples::scene::Failure;
use clebsch_examples::table::Table;
use nalgebra::{Matrix2, Matrix4, Rotation3, SMatrix, Vector2, Vector3, Vector6};

/// A steel-like rod of 1 m, 2 mm thick, in units with E = ρ = 1 and GA = EA·5/13.
const THICKNESS: f64 = 2e-3;
/// Edges.
const EDGES: [usize; 4] = [10, 20, 40, 80];
/// Of the differences: their error is the fourth power.
const SIZE: f64 = 1e-3;

pub fn thin() -> Beam {
    let area = THICKNESS * THICKNESS;
    let moment = area * area / 12.0;
    let shear = area / 2.6;
    Beam { length: 1.0, bending: moment, torsion: moment / 1.3, shear, axial: area, mass: area, inertia: moment }
}

/// The roots of cos β cosh β = 1, by Newton's method.
pub fn euler_bernoulli(mode: usize) -> f64 {
    let mut beta = (mode as f64 + 0.5) * std::f64::consts::PI;
    for _ in 0..20 {
        // cos β − 1/cosh β has no large numbers
        let (value, slope) = (beta.cos() - beta.cosh().recip(), -beta.sin() + beta.tanh() / beta.cosh());
        beta -= value / slope;
    }
    beta
}

/// Minus the slopes of the forces on both ends of a straight edge, by the turn about e₁ and the shift along e₂ of each.
fn stiffness(beam: &Beam, edges: usize) -> SMatrix<f64, 4, 4> {
    let (rod, spacing) = (beam.rod(edges, 1.0), [beam.spacing(edges)]);
    let moved = |k: usize, size: f64| {
        let turn = Rotation3::new(Vector3::x() * if k == 0 { size } else { 0.0 });
        Matrix4::new_translation(&(Vector3::y() * if k == 1 { size } else { 0.0 })) * turn.to_homogeneous()
    };
    let ahead = Matrix4::new_translation(&(Vector3::z() * spacing[0]));
    let forces = |k: usize, size: f64| {
        let mut ends = [Matrix4::identity(), ahead];
        ends[k / 2] *= moved(k % 2, size);
        let (on, next): (Vector6<f64>, Vector6<f64>) = rod.edge_forces(0, &spacing, &ends[0], &ends[1]);
        SMatrix::<f64, 4, 1>::new(on[0], on[4], next[0], next[4])
    };
    let slope = |k: usize, size: f64| (forces(k, -size) - forces(k, size)) / (2.0 * size);
    let scale = [1.0, spacing[0], 1.0, spacing[0]];
    let column = |k: usize| (slope(k, SIZE * scale[k]) * 4.0 - slope(k, 2.0 * SIZE * scale[k])) / 3.0;
    SMatrix::from_columns(&[0, 1, 2, 3].map(column))
}

/// The number of modes whose square is below `square`: negative pivots of K − ω²M, in blocks of a section (Sylvester).
fn below(beam: &Beam, edges: usize, block: &SMatrix<f64, 4, 4>, square: f64) -> usize {
    let block = (block + block.transpose()) / 2.0;
    let part = |i: usize, j: usize| block.fixed_view::<2, 2>(2 * i, 2 * j).into_owned();
    let masses = Matrix2::from_diagonal(&Vector2::new(beam.inertia, beam.mass)) * beam.spacing(edges);
    let (mut count, mut pivot) = (0, Matrix2::zeros());
    for i in 0..=edges {
        let is_end = i == 0 || i == edges;
        let mut next = masses * (-square * if is_end { 0.5 } else { 1.0 });
        if i < edges {
            next += part(0, 0);
        }
        if i > 0 {
            let before = Matrix2::try_inverse(pivot).unwrap_or_default();
            next += part(1, 1) - part(1, 0) * before * part(0, 1);
        }
        let determinant: f64 = next.determinant();
        count += if determinant < 0.0 { 1 } else { 2 * usize::from(next.trace() < 0.0) };
        pivot = next;
    }
    count
}

/// Frequencies of the first three modes that bend the rod, by bisection; the shift and the turn of the rod are before them.
pub fn frequencies(beam: &Beam, edges: usize, near: [f64; 3]) -> [f64; 3] {
    let block = stiffness(beam, edges);
    std::array::from_fn(|mode| {
        let (mut low, mut high) = (0.0, 4.0 * near[mode].powi(2));
        for _ in 0..60 {
            let middle = (low + high) / 2.0;
            if below(beam, edges, &block, middle) > mode + 2 { high = middle } else { low = middle }
        }
        high.sqrt()
    })
}

/// A table of relative errors, and the claim of their order.
///
/// # Errors
/// None of a rod with a mass.
pub fn compare(claims: &mut Claims) -> Result<Table<5>, Failure> {
    let beam = thin();
    let exact = [1, 2, 3].map(|mode| euler_bernoulli(mode).powi(2) * (beam.bending / beam.mass).sqrt());
    let mut table = Table::new(["edges", "mode 1", "mode 2", "mode 3", "longest stable step / s"]);
    let mut errors = Vec::new();
    for edges in EDGES {
        let found = frequencies(&beam, edges, exact);
        let error = [0, 1, 2].map(|i| found[i] / exact[i] - 1.0);
        errors.push(error[0].abs());
        let [a, b, c] = error.map(|error| format!("{error:.3e}"));
        table.row([edges.to_string(), a, b, c, format!("{:.2e}", beam.stable_step(edges)?)]);
    }
    for (i, pair) in errors.windows(2).enumerate() {
        let name = format!("first mode of a thin rod, {} to {} edges: order", EDGES[i], EDGES[i + 1]);
        claims.within(&name, (pair[0] / pair[1]).log2(), 1.9..=2.05, 3, "of its error to Euler and Bernoulli");
    }
    Ok(table)
}
