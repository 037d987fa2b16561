//! Tables as text, a line for each row.

use super::sink::Sink;
use std::io::{self, BufWriter, Write};
use std::string::String;

/// Lines of numbers with commas between them; see [`Recorder::csv`](super::Recorder::csv).
#[derive(Debug)]
pub struct Csv<W: Write> {
    writer: BufWriter<W>,
    is_inside: bool,
}

impl<W: Write> Csv<W> {
    pub(super) fn new(writer: W) -> Self {
        Self { writer: BufWriter::new(writer), is_inside: false }
    }

    fn separate(&mut self) -> io::Result<()> {
        if self.is_inside {
            self.writer.write_all(b",")?;
        }
        self.is_inside = true;
        Ok(())
    }

    /// A name in the first line, in quotes where RFC 4180 asks for them.
    pub(super) fn name(&mut self, name: &str) -> io::Result<()> {
        self.separate()?;
        if name.contains([',', '"', '\n', '\r']) {
            let doubled: String = name.replace('"', "\"\"");
            write!(self.writer, "\"{doubled}\"")
        } else {
            self.writer.write_all(name.as_bytes())
        }
    }
}

impl<W: Write> Sink for Csv<W> {
    type Writer = W;

    fn number(&mut self, value: f64) -> io::Result<()> {
        self.separate()?;
        // the fewest digits that give the same number, with an exponent where it is short
        write!(self.writer, "{value:?}")
    }

    fn end_row(&mut self) -> io::Result<()> {
        self.is_inside = false;
        self.writer.write_all(b"\n")
    }

    fn complete(&mut self) -> io::Result<()> {
        self.writer.flush()
    }

    fn finish(self) -> io::Result<W> {
        self.writer.into_inner().map_err(io::IntoInnerError::into_error)
    }
}
