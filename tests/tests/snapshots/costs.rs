//! The operation counts of every fixture in one table: a change of cost is a line in the diff.

use clebsch_compiler::lower::{Cost, Program};
use insta::assert_snapshot;

use crate::fixture::{Fixture, root};

/// What a column adds up: the kernels whose names begin with one of these words.
const COLUMNS: [(&str, &[&str]); 5] = [
    ("once", &["constants", "inertia"]),
    ("iteration", &["linearize"]),
    ("rest of a step", &["start_kick", "prepare", "predict", "increment", "advance", "update", "end_kick"]),
    (
        "formulas",
        &["act", "momentum_map", "coadjoint", "legendre", "potential", "momentum_", "generator", "cotangent_lift"],
    ),
    ("all", &[""]),
];

#[test]
fn operations_of_all_fixtures() {
    let mut rows =
        vec![["fixture".to_string()].into_iter().chain(COLUMNS.map(|(title, _)| title.into())).collect::<Vec<_>>()];
    for fixture in Fixture::all("accept") {
        let cells = fixture.with_program(|program| COLUMNS.map(|(_, kernels)| cost(program, kernels).to_string()));
        rows.push([fixture.name].into_iter().chain(cells).collect());
    }
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path(root().join("snapshots"));
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.bind(|| assert_snapshot!("operations", table(&rows)));
}

fn cost(program: &Program<'_>, kernels: &[&str]) -> Cost {
    let wanted = |name: &str| kernels.iter().any(|kernel| name.starts_with(kernel));
    let costs = program.kernels().into_iter().filter(|(name, _)| wanted(name)).map(|(_, kernel)| kernel.cost());
    costs.fold(Cost::default(), Cost::plus)
}

/// Rows with their columns aligned.
fn table(rows: &[Vec<String>]) -> String {
    let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..rows[0].len()).map(width).collect();
    let line = |row: &Vec<String>| {
        let cells: Vec<String> = row.iter().zip(&widths).map(|(cell, width)| format!("{cell:width$}")).collect();
        cells.join("  ").trim_end().to_string() + "\n"
    };
    rows.iter().map(line).collect()
}
