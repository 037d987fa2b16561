//! The groups that problems are made of.

use clebsch_tests::oracle::precise::group::{self, Group};
use clebsch_tests::oracle::precise::matrix::Matrix;
use clebsch_tests::oracle::random::Random;

use crate::problem::{Kind, NamedGroup};

/// A number of 0..n.
pub fn pick(random: &mut Random, n: usize) -> usize {
    (random.between(0.0, n as f64) as usize).min(n - 1)
}

fn built_in(name: &str, group: Group) -> NamedGroup {
    let kind = match name {
        "SU<2>" => Kind::Quaternion,
        _ if name.starts_with("Translation") => Kind::Vector,
        _ => Kind::Matrix,
    };
    NamedGroup { name: name.into(), declaration: None, group, kind }
}

/// A group of the language, small ones more often, or a declared one.
pub fn random_group(random: &mut Random) -> NamedGroup {
    match pick(random, 24) {
        0 => built_in("SO<2>", group::so(2)),
        1 | 2 => built_in("SO<3>", group::so(3)),
        3 => built_in("SO<4>", group::so(4)),
        4 => built_in("SO<1, 2>", group::pseudo_so(1, 2)),
        5 => built_in("SO<1, 1>", group::pseudo_so(1, 1)),
        6 => built_in("SE<2>", group::se(2)),
        7 => built_in("SE<3>", group::se(3)),
        8 => built_in("Translation<1>", group::translation(1)),
        9 => built_in("Translation<2>", group::translation(2)),
        10 => built_in("Translation<3>", group::translation(3)),
        11 => built_in("GL<2>", group::gl(2)),
        12 => built_in("SL<2>", group::sl(2)),
        13 => built_in("Sp<2>", group::sp(2)),
        14 => built_in("U<1>", group::u(1)),
        15 => built_in("U<2>", group::u(2)),
        16 | 17 => built_in("SU<2>", group::unit_quaternions()),
        18 => built_in("Heisenberg<1>", group::heisenberg(1)),
        19 => built_in("Aff<1>", group::aff(1)),
        20 => built_in("Sim<2>", group::sim(2)),
        21 => by_form(random),
        22 => of_determinant_one(),
        _ => by_basis(random),
    }
}

/// FᵀηF = η for a diagonal η: E_ji − η_j/η_i E_ij, i < j, in the order of the columns.
fn by_form(random: &mut Random) -> NamedGroup {
    let n = 2 + pick(random, 2);
    let choices = [1.0, 2.0, -1.0, 0.5, -2.0];
    let eta: Vec<f64> = (0..n).map(|_| choices[pick(random, choices.len())]).collect();
    let pairs = (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j)));
    let element = |(i, j): (usize, usize)| {
        Matrix::from_fn(n, n, |row, column| match (row, column) {
            _ if (row, column) == (j, i) => 1.0,
            _ if (row, column) == (i, j) => -eta[j] / eta[i],
            _ => 0.0,
        })
    };
    let entries: Vec<String> = eta.iter().map(f64::to_string).collect();
    let declaration = format!(
        "group Form = |F: Matrix{n}| {{ let eta = Matrix{n}::from_diagonal(&vector![{}]); F.transpose() * eta * F == eta }}",
        entries.join(", ")
    );
    let group = group::group(pairs.map(element).collect());
    NamedGroup { name: "Form".into(), declaration: Some(declaration), group, kind: Kind::Matrix }
}

/// det F = 1 in two dimensions: the second diagonal entry is the one that is determined.
fn of_determinant_one() -> NamedGroup {
    let basis = [[1.0, 0.0, 0.0, -1.0], [0.0, 0.0, 1.0, 0.0], [0.0, 1.0, 0.0, 0.0]];
    NamedGroup {
        name: "Volume".into(),
        declaration: Some("group Volume = |F: Matrix2| F.determinant() == 1".into()),
        group: group::group(basis.iter().map(|entries| Matrix::of(2, 2, entries)).collect()),
        kind: Kind::Matrix,
    }
}

/// Some algebra with another basis: upper triangular matrices, so(3), or a product of scalings.
fn by_basis(random: &mut Random) -> NamedGroup {
    let triangular = vec![vec![1.0, 0.0, 0.0, 0.0], vec![0.0, 1.0, 0.0, 0.0], vec![0.0, 0.0, 0.0, 1.0]];
    let scalings = vec![vec![1.0, 0.0, 0.0, 0.0], vec![0.0, 0.0, 0.0, 1.0]];
    let rotations: Vec<Vec<f64>> = group::so(3).basis.iter().map(|e| e.entries().to_vec()).collect();
    let nilpotent = vec![
        vec![0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        vec![0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0],
        vec![0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    ];
    let mut basis = [triangular, scalings, rotations, nilpotent][pick(random, 4)].clone();
    // another basis of the same algebra: E_i + c E_0, twice
    for _ in 0..2 {
        let (i, weight) = (1 + pick(random, basis.len() - 1), [0.5, -1.0, 2.0][pick(random, 3)]);
        let first = basis[0].clone();
        basis[i].iter_mut().zip(first).for_each(|(entry, other)| *entry += weight * other);
    }
    let n = if basis[0].len() == 4 { 2 } else { 3 };
    let matrix = |entries: &Vec<f64>| {
        let numbers: Vec<String> = entries.iter().map(f64::to_string).collect();
        format!("Matrix{n}::new({})", numbers.join(", "))
    };
    let matrices: Vec<String> = basis.iter().map(matrix).collect();
    NamedGroup {
        name: "Own".into(),
        declaration: Some(format!("group Own = basis([{}])", matrices.join(", "))),
        group: group::group(basis.iter().map(|entries| Matrix::of(n, n, entries)).collect()),
        kind: Kind::Matrix,
    }
}
