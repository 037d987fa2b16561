//! The trajectory as a file of comma-separated numbers.

use crate::flags::Run;
use crate::scene::{Failure, say};
use nalgebra::SMatrix;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// Writes one header line, then a line a step: number, time, configuration row by row, momentum.
///
/// Numbers have 17 significant digits, so that reading them gives the same `f64` again.
pub struct Csv {
    file: Option<(PathBuf, BufWriter<File>)>,
    every: u64,
}

impl Csv {
    /// Opens the file of `--csv`; without that flag nothing is written.
    ///
    /// # Errors
    /// [`Failure::File`]
    pub fn create(run: &Run, columns: &[&str]) -> Result<Self, Failure> {
        let open = |path: &Path| -> io::Result<BufWriter<File>> {
            let mut writer = BufWriter::new(File::create(path)?);
            writeln!(writer, "step,time,{}", columns.join(","))?;
            Ok(writer)
        };
        let file = match &run.csv {
            Some(path) => Some((path.clone(), open(path).map_err(Failure::file(path))?)),
            None => None,
        };
        Ok(Self { file, every: run.every })
    }

    /// Writes a step, unless `--every` leaves it out.
    ///
    /// # Errors
    /// [`Failure::File`]
    pub fn row(&mut self, step: u64, time: f64, values: impl IntoIterator<Item = f64>) -> Result<(), Failure> {
        let Some((path, writer)) = &mut self.file else { return Ok(()) };
        if !step.is_multiple_of(self.every) {
            return Ok(());
        }
        write_row(writer, step, time, values).map_err(Failure::file(path))
    }

    /// Writes the buffered lines and says where the file is.
    ///
    /// # Errors
    /// [`Failure::File`]
    pub fn finish(self) -> Result<(), Failure> {
        let Some((path, mut writer)) = self.file else { return Ok(()) };
        writer.flush().map_err(Failure::file(&path))?;
        say(format_args!("trajectory  {}", path.display()));
        Ok(())
    }
}

/// The entries of a matrix row by row; those of a vector in order.
pub fn by_rows<const R: usize, const C: usize>(matrix: &SMatrix<f64, R, C>) -> impl Iterator<Item = f64> + '_ {
    (0..R).flat_map(move |row| (0..C).map(move |column| matrix[(row, column)]))
}

fn write_row(to: &mut impl Write, step: u64, time: f64, values: impl IntoIterator<Item = f64>) -> io::Result<()> {
    write!(to, "{step},{time:.16e}")?;
    for value in values {
        write!(to, ",{value:.16e}")?;
    }
    writeln!(to)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_survive_the_file() {
        let numbers = [0.1, -1.0 / 3.0, 1e300, -0.0, f64::MIN_POSITIVE];
        let mut text = Vec::new();
        write_row(&mut text, 3, 0.03, numbers).unwrap();
        let text = String::from_utf8(text).unwrap();
        let fields: Vec<&str> = text.trim_end().split(',').collect();
        assert_eq!(fields[..2], ["3", "2.9999999999999999e-2"]);
        for (field, number) in fields[2..].iter().zip(numbers) {
            assert_eq!(field.parse::<f64>().unwrap().to_bits(), number.to_bits());
        }
    }
}
