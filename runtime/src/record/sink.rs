//! Where the numbers of rows go.

use std::io;

/// A format of files.
pub trait Sink {
    /// Whatever the bytes go to.
    type Writer;

    /// The next number of a row.
    ///
    /// # Errors
    /// Those of the writer.
    fn number(&mut self, value: f64) -> io::Result<()>;

    /// The end of a row.
    ///
    /// # Errors
    /// Those of the writer.
    fn end_row(&mut self) -> io::Result<()>;

    /// All that has been written so far is a complete file.
    ///
    /// # Errors
    /// Those of the writer.
    fn complete(&mut self) -> io::Result<()>;

    /// The writer, when all bytes have gone to it.
    ///
    /// # Errors
    /// Those of the writer.
    fn finish(self) -> io::Result<Self::Writer>;
}
