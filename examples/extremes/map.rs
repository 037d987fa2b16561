//! All cells of the map, as a table that programs can read, and the counts that claims are made of.

use crate::probe::{Cell, Dial};
use clebsch::Error;
use clebsch_examples::scene::Failure;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

/// The scalar types, in the order of [`Dial::begin`].
pub const SCALARS: [&str; 2] = ["f64", "f32"];

/// The runs so far.
pub struct Map<'a> {
    csv: Option<(BufWriter<File>, &'a Path)>,
    /// Runs.
    pub cells: u64,
    /// Those that came to their end.
    pub ended: u64,
    /// Numbers that are not finite in results that claim to be good.
    pub hidden: u64,
}

impl<'a> Map<'a> {
    /// Writes to `path`, if there is one.
    ///
    /// # Errors
    /// [`Failure::File`]
    pub fn new(path: Option<&'a Path>) -> Result<Self, Failure> {
        let csv = match path {
            Some(path) => {
                let file = File::create(path).map_err(Failure::file(path))?;
                Some((BufWriter::new(file), path))
            }
            None => None,
        };
        let mut map = Self { csv, cells: 0, ended: 0, hidden: 0 };
        map.line("section,scene,dial,scalar,value,outcome,steps,iterations,residual,energy,momentum,constraint,against 31 digits")?;
        Ok(map)
    }

    /// Adds a cell: the section, the dial, and the value of the section's quantity.
    ///
    /// # Errors
    /// [`Failure::File`]
    pub fn add(&mut self, section: &str, dial: &Dial, scalar: usize, value: &str, cell: &Cell) -> Result<(), Failure> {
        self.add_run(section, (dial.scene, dial.name), SCALARS[scalar], value, cell)
    }

    /// The same of a run that is not a dial's.
    ///
    /// # Errors
    /// [`Failure::File`]
    pub fn add_run(
        &mut self,
        section: &str,
        (scene, name): (&str, &str),
        scalar: &str,
        value: &str,
        cell: &Cell,
    ) -> Result<(), Failure> {
        self.cells += 1;
        self.ended += u64::from(cell.outcome.is_ok());
        self.hidden += u64::from(cell.hides_nan());
        let Cell { steps, iterations, residual, energy, momentum, constraint, precise, .. } = cell;
        let (name, value, outcome) = (name.replace(',', ""), value.replace(',', ""), outcome(cell));
        self.line(&format!(
            "{section},{scene},{name},{scalar},{value},{outcome},{steps},{iterations},{residual:e},{energy:e},{momentum:e},{constraint:e},{precise:e}"
        ))
    }

    fn line(&mut self, line: &str) -> Result<(), Failure> {
        match &mut self.csv {
            Some((file, path)) => writeln!(file, "{line}").map_err(Failure::file(path)),
            None => Ok(()),
        }
    }

    /// Ends the file.
    ///
    /// # Errors
    /// [`Failure::File`]
    pub fn finish(self) -> Result<Option<PathBuf>, Failure> {
        let Some((mut file, path)) = self.csv else { return Ok(None) };
        file.flush().map_err(Failure::file(path))?;
        Ok(Some(path.to_owned()))
    }
}

/// How a run ended, in a word or two.
pub fn outcome(cell: &Cell) -> String {
    match cell.outcome {
        Ok(()) => "done".to_owned(),
        Err(error) => refusal(error),
    }
}

/// An error in a word or two.
pub fn refusal(error: Error) -> String {
    match error {
        Error::Unsolvable { solvable_fraction, .. } => format!("too long ({solvable_fraction:.2})"),
        Error::NotConverged { iterations, .. } => format!("not converged in {iterations}"),
        Error::NotFinite { .. } => "overflow".to_owned(),
        Error::SingularKineticEnergy { .. } => "singular".to_owned(),
        Error::IndefiniteKineticEnergy { .. } => "indefinite".to_owned(),
        Error::OffOrbit { .. } => "off the group".to_owned(),
        Error::OutsideMomentumSpace { .. } => "no momentum".to_owned(),
        other => format!("{other:?}").split([' ', '{']).next().unwrap_or_default().to_owned(),
    }
}

/// A number; only its size matters.
pub fn size(x: f64) -> String {
    if x == 0.0 { "0".to_owned() } else { format!("{x:.0e}") }
}
