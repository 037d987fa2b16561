//! Arrays of NumPy: a header with the types of the fields, and the bytes of all rows.

use super::each_value;
use super::sink::Sink;
use crate::Form;
use crate::columns::Names;
use core::fmt::Write as _;
use std::io::{self, BufWriter, Seek, SeekFrom, Write};
use std::string::{String, ToString};
use std::vec::Vec;

/// The places of the number of rows in a header.
const DIGITS: usize = 20;

/// A file of NumPy with one array; see [`Recorder::npy`](super::Recorder::npy).
#[derive(Debug)]
pub struct Npy<W: Write + Seek> {
    /// `None` after the end.
    writer: Option<BufWriter<W>>,
    /// Where the header starts.
    start: u64,
    fields: String,
    rows: u64,
}

impl<W: Write + Seek> Npy<W> {
    pub(super) fn new(writer: W, fields: String) -> io::Result<Self> {
        let mut writer = BufWriter::new(writer);
        let start = writer.stream_position()?;
        writer.write_all(&header(&fields, 0))?;
        Ok(Self { writer: Some(writer), start, fields, rows: 0 })
    }

    fn writer(&mut self) -> io::Result<&mut BufWriter<W>> {
        // by construction: it is taken where the recorder ends
        self.writer.as_mut().ok_or_else(|| io::Error::other("the recorder has ended"))
    }
}

impl<W: Write + Seek> Sink for Npy<W> {
    type Writer = W;

    fn number(&mut self, value: f64) -> io::Result<()> {
        self.writer()?.write_all(&value.to_le_bytes())
    }

    fn end_row(&mut self) -> io::Result<()> {
        self.rows += 1;
        Ok(())
    }

    /// Writes the header again, with the number of rows.
    fn complete(&mut self) -> io::Result<()> {
        let (header, start) = (header(&self.fields, self.rows), self.start);
        let writer = self.writer()?;
        let end = writer.stream_position()?;
        writer.seek(SeekFrom::Start(start))?;
        writer.write_all(&header)?;
        writer.seek(SeekFrom::Start(end))?;
        writer.flush()
    }

    fn finish(mut self) -> io::Result<W> {
        self.complete()?;
        let writer = self.writer.take().ok_or_else(|| io::Error::other("the recorder has ended"))?;
        writer.into_inner().map_err(io::IntoInnerError::into_error)
    }
}

impl<W: Write + Seek> Drop for Npy<W> {
    fn drop(&mut self) {
        if self.writer.is_some() {
            // `finish` tells of errors
            let _ = self.complete();
        }
    }
}

/// The header of an array with these fields. Its length does not depend on the number of rows.
pub(super) fn header(fields: &str, rows: u64) -> Vec<u8> {
    let rows = rows.to_string();
    let text = std::format!("{{'descr': [{fields}], 'fortran_order': False, 'shape': ({rows},), }}");
    let text = text + &" ".repeat(DIGITS.saturating_sub(rows.len()));
    // version 1 has two bytes for the length, version 2 has four, and version 3 takes names that are not Latin
    let short = u16::try_from(text.len() + 64).is_ok() && text.is_ascii();
    let version: u8 = if short {
        1
    } else if text.is_ascii() {
        2
    } else {
        3
    };
    let prefix = if short { 10 } else { 12 };
    // the data begin at a multiple of 64, behind the end of a line
    let length = (prefix + text.len() + 1).next_multiple_of(64) - prefix;
    let mut bytes = Vec::with_capacity(prefix + length);
    bytes.extend(b"\x93NUMPY");
    bytes.extend([version, 0]);
    // a text of 4 GiB would be one of as many fields
    let counted = u32::try_from(length).unwrap_or(u32::MAX).to_le_bytes();
    bytes.extend(&counted[..if short { 2 } else { 4 }]);
    bytes.extend(text.as_bytes());
    bytes.resize(prefix + length - 1, b' ');
    bytes.push(b'\n');
    bytes
}

/// The fields of an array, each value with its name: `('t', '<f8'), ('R', '<f8', (3, 3)), `.
pub(super) fn fields(values: impl Iterator<Item = (Names, Form)>) -> String {
    let mut text = String::new();
    for (names, form) in values {
        each_value(names, form, &mut |name, form| field(&mut text, name, form));
    }
    text
}

/// A field. One without numbers is left out.
fn field(text: &mut String, name: &str, form: Form) {
    if form.width() == 0 {
        return;
    }
    text.push_str("('");
    for character in name.chars() {
        match character {
            '\'' | '\\' => text.extend(['\\', character]),
            '\n' => text.push_str("\\n"),
            '\r' => text.push_str("\\r"),
            _ => text.push(character),
        }
    }
    text.push_str("', ");
    let mut shape = String::new();
    let of = shape_of(form, &mut shape);
    match of {
        Form::Tuple(parts) => {
            text.push('[');
            parts.iter().enumerate().for_each(|(part, form)| field(text, &part.to_string(), **form));
            text.push(']');
        }
        _ => text.push_str("'<f8'"),
    }
    if !shape.is_empty() {
        // writing to a text does not fail
        let _ = write!(text, ", ({shape})");
    }
    text.push_str("), ");
}

/// The form of an entry, and the sizes of the arrays and matrices around it.
fn shape_of(form: Form, shape: &mut String) -> Form {
    let mut size = |size: usize| {
        let _ = write!(shape, "{size}, ");
    };
    match form {
        Form::Number | Form::Tuple(_) => return form,
        Form::Matrix { rows, columns: 1 } => size(rows),
        Form::Matrix { rows, columns } => {
            size(rows);
            size(columns);
        }
        Form::Quaternion => size(4),
        Form::Array { length, of } => {
            size(length);
            return shape_of(*of, shape);
        }
    }
    Form::Number
}
