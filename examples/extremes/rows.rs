//! Tables of as many columns as there are dials.

/// Columns aligned, the first to the left.
pub fn align(rows: &[Vec<String>]) -> String {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width = |column: usize| rows.iter().filter_map(|row| row.get(column)).map(|cell| cell.chars().count()).max();
    let widths: Vec<usize> = (0..columns).map(|column| width(column).unwrap_or(0)).collect();
    let line = |row: &Vec<String>| {
        let cells = row.iter().zip(&widths).enumerate();
        let text: String = cells
            .map(
                |(column, (cell, &width))| {
                    if column == 0 { format!("  {cell:<width$}") } else { format!("   {cell:>width$}") }
                },
            )
            .collect();
        text.trim_end().to_owned() + "\n"
    };
    rows.iter().map(line).collect()
}
