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
        let lines = || std::iter::once(&self.headings).chain(&self.rows);
        let widths: [usize; N] =
            std::array::from_fn(|column| lines().map(|line| line[column].chars().count()).max().unwrap_or(0));
        for line in lines() {
            let mut text = String::new();
            for (column, (cell, width)) in line.iter().zip(widths).enumerate() {
                text += &if column == 0 { format!("{cell:<width$}") } else { format!("   {cell:>width$}") };
            }
            writeln!(f, "  {}", text.trim_end())?;
        }
        Ok(())
    }
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
