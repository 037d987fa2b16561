//! The basis of the Lie algebra of a group that is declared by an equation, by elimination.

use clebsch_tests::oracle::precise::group::{Group, group};
use clebsch_tests::oracle::precise::matrix::Matrix;

/// The matrices ξ with L(ξ) = 0. The entries of ξ are taken column by column. One that those before do not determine is
/// a coordinate, one in one matrix of the basis and zero in the others.
pub fn solutions(n: usize, equation: impl Fn(&Matrix<f64>) -> Matrix<f64>) -> Group {
    // the last entries first, so that elimination writes each as a function of those before it
    let place = |k: usize| (k % n, k / n);
    let unit = |k: usize| Matrix::from_fn(n, n, |i, j| f64::from(u8::from((i, j) == place(k))));
    let columns: Vec<Matrix<f64>> = (0..n * n).rev().map(|k| equation(&unit(k))).collect();
    let rows = columns[0].entries().len();
    let mut system: Vec<Vec<f64>> =
        (0..rows).map(|row| columns.iter().map(|column| column.entries()[row]).collect()).collect();
    let pivots = eliminate(&mut system);
    let free: Vec<usize> = (0..n * n).filter(|column| !pivots.contains(column)).rev().collect();
    let element = |&coordinate: &usize| {
        let mut entries = vec![0.0; n * n];
        entries[coordinate] = 1.0;
        for (row, &pivot) in pivots.iter().enumerate() {
            entries[pivot] = -system[row][coordinate];
        }
        Matrix::from_fn(n, n, |i, j| entries[n * n - 1 - (j * n + i)])
    };
    group(free.iter().map(element).collect())
}

/// The reduced row echelon form; gives the columns of the pivots.
fn eliminate(rows: &mut [Vec<f64>]) -> Vec<usize> {
    let mut pivots = Vec::new();
    for column in 0..rows[0].len() {
        let rank = pivots.len();
        let Some(found) = (rank..rows.len()).find(|&row| rows[row][column].abs() > 1e-9) else { continue };
        rows.swap(rank, found);
        let head = rows[rank][column];
        rows[rank].iter_mut().for_each(|entry| *entry /= head);
        let pivot = rows[rank].clone();
        for (_, row) in rows.iter_mut().enumerate().filter(|(index, _)| *index != rank) {
            let factor = row[column];
            row.iter_mut().zip(&pivot).for_each(|(entry, other)| *entry -= factor * other);
        }
        pivots.push(column);
    }
    pivots
}
