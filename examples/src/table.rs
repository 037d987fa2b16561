//! Short tables that a person can read.

use std::fmt::{self, Display, Formatter};

/// Rows of texts under headings, aligned to the right; the first column to the left.
pub struct Table<const N: usize> {
    headings: [String; N],
    rows: Vec<[String; N]>,
}

impl<const N: usize> Table<N> {
    /// A table without rows.
    pub fn new(headings: [&str; N]) -> Self {
        Self { headings: headings.map(str::to_owned), rows: Vec::new() }
    }

    /// Adds a row.
    pub fn row(&mut self, row: [String; N]) {
        self.rows.push(row);
    }
}

impl<const N: usize> Display for Table<N> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(&aligned(std::iter::once(&self.headings).chain(&self.rows)))
    }
}

/// Lines of texts in columns, the first to the left, the others to the right. It serves tables whose number of columns
/// is found as they are made.
pub fn aligned<R: AsRef<[String]>>(lines: impl Iterator<Item = R>) -> String {
    let lines: Vec<R> = lines.collect();
    let columns = lines.iter().map(|line| line.as_ref().len()).max().unwrap_or(0);
    let cells = |column: usize| lines.iter().filter_map(move |line| line.as_ref().get(column));
    let widths: Vec<usize> =
        (0..columns).map(|column| cells(column).map(|cell| cell.chars().count()).max().unwrap_or(0)).collect();
    let mut text = String::new();
    for line in &lines {
        let mut words = String::new();
        for (column, (cell, &width)) in line.as_ref().iter().zip(&widths).enumerate() {
            words += &if column == 0 { format!("{cell:<width$}") } else { format!("   {cell:>width$}") };
        }
        text += &format!("  {}\n", words.trim_end());
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_aligned() {
        let mut table = Table::new(["", "θ / °", "days"]);
        table.row(["long".to_owned(), "1".to_owned(), "10.5".to_owned()]);
        assert_eq!(table.to_string(), "         θ / °   days\n  long       1   10.5\n");
    }
}
