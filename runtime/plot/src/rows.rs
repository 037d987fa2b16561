//! The rows of a table, all of them finite.

use crate::PlotError;
use crate::error::at_step;
use clebsch::{Clebsch, Method, Quantities, Real, Sample, Scalar, Table};

/// A column of a table: its names, its unit, and its numbers.
#[derive(Clone, Debug)]
pub(crate) struct Column {
    pub name: String,
    /// The name of the value that it is a number of.
    pub value: &'static str,
    pub unit: String,
    pub numbers: Vec<f64>,
    /// The differences from the first number, taken in the scalar of the system: it may have more digits than `f64`.
    pub changes: Vec<f64>,
}

/// The columns of a table, the time first. `observe` sees each state with its time.
pub(crate) fn read<S, M, L, A>(
    table: &Table<'_, S, M, L>,
    samples: impl IntoIterator<Item = Result<A, clebsch::Error>>,
    mut observe: impl FnMut(&A),
) -> Result<Vec<Column>, PlotError>
where
    S: Clebsch<Scalar: Real>,
    M: Method<S>,
    L: Quantities<S, M>,
    A: Sample<S, M>,
{
    let mut columns: Vec<Column> = table
        .columns()
        .map(|column| Column {
            name: column.to_string(),
            value: column.value(),
            unit: column.unit().unwrap_or_default().to_owned(),
            numbers: Vec::new(),
            changes: Vec::new(),
        })
        .collect();
    let mut first: Vec<S::Scalar> = Vec::new();
    let mut count = 0;
    for sample in samples {
        let sample = sample.map_err(at_step(count))?;
        let row = || table.row(sample.time(), sample.state());
        if first.is_empty() {
            first = row().collect();
        }
        for ((exact, start), column) in row().zip(&first).zip(&mut columns) {
            let number = exact.to_f64();
            if !number.is_finite() {
                return Err(PlotError::NotFinite { name: column.name.clone(), index: count });
            }
            column.numbers.push(number);
            column.changes.push((exact - *start).to_f64());
        }
        observe(&sample);
        count += 1;
    }
    if count == 0 { Err(PlotError::Nothing) } else { Ok(columns) }
}
