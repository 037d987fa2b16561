//! The operation counts of every fixture in one table: a change of cost is a line in the diff.

use clebsch_compiler::lower::{Cost, Program};
use insta::assert_snapshot;

use crate::fixture::{Fixture, root};

/// Whether a kernel belongs to a column.
type Wanted = fn(&str) -> bool;

/// The kernels that `step` does not call.
const FORMULAS: [&str; 11] = [
    "act",
    "momentum_map",
    "coadjoint",
    "legendre",
    "legendre_next",
    "potential",
    "momentum_matrix",
    "momentum_components",
    "generator",
    "cotangent_lift",
    "conserved",
];

/// The sum of each column.
const COLUMNS: [(&str, Wanted); 5] = [
    ("once", is_computed_once),
    ("iteration", is_iterated),
    ("rest of a step", |kernel| !is_computed_once(kernel) && !is_iterated(kernel) && !is_formula(kernel)),
    ("formulas", is_formula),
    ("all", |_| true),
];

fn is_computed_once(kernel: &str) -> bool {
    ["constants", "inertia"].contains(&kernel)
}

fn is_iterated(kernel: &str) -> bool {
    kernel.starts_with("linearize") || kernel.starts_with("residual")
}

fn is_formula(kernel: &str) -> bool {
    FORMULAS.contains(&kernel)
}

#[test]
fn operations_of_all_fixtures() {
    let titles = COLUMNS.map(|(title, _)| title.to_string());
    let mut rows: Vec<Vec<String>> = vec![["fixture".to_string()].into_iter().chain(titles).collect()];
    for fixture in Fixture::all("accept") {
        let cells = fixture.with_program(|program| COLUMNS.map(|(_, wanted)| cost(program, wanted).to_string()));
        rows.push([fixture.name].into_iter().chain(cells).collect());
    }
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path(root().join("snapshots"));
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.bind(|| assert_snapshot!("operations", table(&rows)));
}

fn cost(program: &Program<'_>, wanted: Wanted) -> Cost {
    // where a step moves by the chart coordinates alone, increments are made for others
    let steps =
        program.mechanics().is_none_or(|program| (0..program.steps.len()).all(|index| program.makes_increments(index)));
    let stands_for =
        |name: &str| if name.starts_with("increment") && !steps { "act".to_string() } else { name.to_string() };
    let kernels = program.kernels().into_iter().filter(|(name, _)| wanted(&stands_for(name)));
    kernels.map(|(_, kernel)| kernel.cost()).fold(Cost::default(), Cost::plus)
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
