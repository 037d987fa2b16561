//! The functions of closures in Markdown, from the tables by which they are read.

use super::constructors::CONSTRUCTORS;
use super::quaternions;
use super::tables::{METHODS, REFUSED};

/// The methods, the constructors and the refused methods, each as a table.
pub(crate) fn functions_as_markdown() -> String {
    let methods = METHODS.iter().map(|(name, _, rule, gives)| [code(name), rule.receiver().into(), escaped(gives)]);
    let of_quaternions = quaternions::METHODS.iter().map(|(name, _, gives)| [code(name), escaped(gives)]);
    let constructors = CONSTRUCTORS.iter().map(|(name, _, gives)| [code(name), escaped(gives)]);
    let refused = REFUSED.iter().map(|(name, why, instead)| [code(name), (*why).into(), escaped(instead)]);
    format!(
        "## Methods

{}
## Methods of quaternions

`dot` of two quaternions is the sum of the products of their coordinates.

{}
## Constructors

`VectorN`, `RowVectorN`, `MatrixN` and `MatrixRxC` have them, and so have `SVector::<f64, n>` and `SMatrix::<f64, r, c>`.
`new` takes all entries, row by row. `vector![a, b]` and `matrix![a, b; c, d]` do the same for any size.
`Quaternion::new(w, i, j, k)` takes the scalar part first, and `Quaternion::identity()` is 1.

{}
## Refused

These have no derivative somewhere, so no closure can use them. Only the price of inputs takes `abs` and `max`, which are soft bounds there.

{}",
        table(["method", "of", "gives"], methods),
        table(["method", "gives"], of_quaternions),
        table(["constructor", "gives"], constructors),
        table(["method", "why", "instead"], refused),
    )
}

/// A table with a head.
fn table<const N: usize>(head: [&str; N], rows: impl Iterator<Item = [String; N]>) -> String {
    let row = |cells: [String; N]| format!("| {} |\n", cells.join(" | "));
    let head = row(head.map(str::to_string)) + &row(head.map(|_| "---".to_string()));
    rows.map(row).fold(head, |table, row| table + &row)
}

fn code(name: &str) -> String {
    format!("`{name}`")
}

/// A bar would end a cell.
fn escaped(text: &str) -> String {
    text.replace('|', "\\|")
}
