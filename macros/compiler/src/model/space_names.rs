//! The names that spaces have elsewhere, and how they are written here.

use clebsch_symbolic::Shape;

use super::shapes::spelled;

/// How a space is written, from the sizes behind its name.
type Written = fn(&[usize]) -> String;

const NAMES: [(&[&str], Written); 4] = [
    (&["Sphere", "Direction", "UnitVector"], unit),
    (&["SPD", "Spd", "Sym", "SymmetricMatrix", "PositiveDefinite"], symmetric),
    (&["Grassmann", "Grassmannian", "Gr", "Subspace"], projector),
    (&["Stiefel", "St", "Frame"], orthonormal),
];

/// The type for a space that has this name elsewhere, `Unit<Vector3>` for `Sphere<2>`.
pub(super) fn written(name: &str, arguments: &[usize]) -> Option<String> {
    let base = name.trim_end_matches(|c: char| c.is_ascii_digit());
    let (_, written) = NAMES.iter().find(|(names, _)| names.contains(&base))?;
    let digits = name[base.len()..].parse().ok().filter(|size| (1..=9).contains(size));
    let sizes: Vec<usize> = digits.into_iter().chain(arguments.iter().copied()).collect();
    let is_vector = base.ends_with("Vector");
    // a sphere has one dimension less than its vectors
    Some(match sizes.as_slice() {
        [n] if is_vector && *n > 1 => unit(&[n - 1]),
        sizes => written(sizes),
    })
}

fn unit(sizes: &[usize]) -> String {
    let dimension = if let [n] = sizes { *n } else { 2 };
    format!("Unit<{}>", spelled(Shape::vector(dimension + 1)))
}

fn symmetric(sizes: &[usize]) -> String {
    let n = if let [n] = sizes { *n } else { 3 };
    format!("Symmetric<{}>", spelled(Shape::square(n)))
}

fn projector(sizes: &[usize]) -> String {
    let (n, rank) = both(sizes);
    format!("Projector<{}, {rank}>", spelled(Shape::square(n)))
}

fn orthonormal(sizes: &[usize]) -> String {
    let (n, columns) = both(sizes);
    match columns {
        1 => unit(&[n - 1]),
        _ => format!("Orthonormal<{}>", spelled(Shape::new(n, columns))),
    }
}

/// The dimension, which is the larger one in any order, and the other one.
fn both(sizes: &[usize]) -> (usize, usize) {
    match *sizes {
        [a, b] if a != b => (a.max(b), a.min(b)),
        _ => (4, 2),
    }
}
