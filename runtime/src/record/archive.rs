//! Archives of NumPy: a ZIP file without compression, with an array in each entry.

use super::checksum::{checksum, joined};
use super::npy::{Npy, fields, header};
use crate::record::{RecordError, Recorder, check_names};
use crate::table::{Quantities, Table};
use crate::{Clebsch, Method};
use std::io::{self, Seek, SeekFrom, Write};
use std::string::{String, ToString};
use std::vec::Vec;

/// Version 4.5 of the format: sizes have 64 bits.
const VERSION: u16 = 45;
/// Names are UTF-8.
const FLAGS: u16 = 1 << 11;
/// 1 January 1980, the first date that the format has.
const DATE: u16 = 1 << 5 | 1;
/// Bytes of a header in front of its name.
const LOCAL: u64 = 30;

/// An archive for NumPy, `.npz`, with the tables of several runs. Each run is an entry with a name.
///
/// Entries are not compressed, and each may have more than 4 GiB.
///
/// ```
/// # use clebsch::Clebsch;
/// use clebsch::record::{Npz, Recorder};
/// # use nalgebra::Vector1;
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(action = |a: Translation<1>, x: Vector1| x + a, cost = |h, a| self.mass * a.norm_squared() / (2 * h))]
/// # struct Particle { mass: f64 }
/// let stepper = Particle { mass: 2.0 }.into_stepper(0.5)?;
/// # let file = std::io::Cursor::new(Vec::new());
/// // let file = std::fs::File::create("runs.npz")?;
/// let mut archive = Npz::new(file)?;
/// for (name, momentum) in [("slow", 1.0), ("fast", 6.0)] {
///     let start = stepper.state(Vector1::zeros(), Vector1::new(momentum))?;
///     let mut recorder = Recorder::npz(&mut archive, name, stepper.table())?;
///     recorder.record_all(stepper.trajectory(start).every(0.25).with_times().take(8))?;
///     recorder.finish()?;
/// }
/// archive.finish()?;
/// # Ok::<(), clebsch::record::RecordError>(())
/// ```
///
/// In Python, `numpy.load("runs.npz")["fast"]["x"]` has the places of the second run.
///
/// Source: PKWARE, *.ZIP File Format Specification* 6.3.10.
#[derive(Debug)]
pub struct Npz<W: Write + Seek> {
    /// `None` after the end.
    writer: Option<W>,
    /// Where the archive starts.
    start: u64,
    /// The entries that are complete.
    entries: Vec<Listed>,
    /// The first error of an entry that was dropped.
    error: Option<io::Error>,
}

/// An entry in the directory of an archive.
#[derive(Debug)]
struct Listed {
    name: String,
    offset: u64,
    size: u64,
    checksum: u32,
}

impl<W: Write + Seek> Npz<W> {
    /// An archive that begins where the writer stands.
    ///
    /// # Errors
    /// [`RecordError::Io`].
    pub fn new(mut writer: W) -> Result<Self, RecordError> {
        let start = writer.stream_position()?;
        Ok(Self { writer: Some(writer), start, entries: Vec::new(), error: None })
    }

    /// Writes the directory of the archive, and gives back the writer.
    ///
    /// # Errors
    /// [`RecordError::Io`], also for a recorder that was dropped and could not complete its entry.
    pub fn finish(mut self) -> Result<W, RecordError> {
        if let Some(error) = self.error.take() {
            return Err(error.into());
        }
        self.write_directory()?;
        // by construction: it is taken here alone
        self.writer.take().ok_or_else(|| io::Error::other("the archive has ended").into())
    }

    fn write_directory(&mut self) -> io::Result<()> {
        let Some(writer) = &mut self.writer else { return Ok(()) };
        let offset = writer.stream_position()? - self.start;
        let mut bytes = Vec::new();
        for Listed { name, offset, size, checksum } in &self.entries {
            bytes.extend(b"PK\x01\x02");
            extend(&mut bytes, &[VERSION, VERSION, FLAGS, 0, 0, DATE]);
            bytes.extend(checksum.to_le_bytes());
            bytes.extend([0xFF; 8]);
            // by construction: `Recorder::npz` has checked the length of the name
            extend(&mut bytes, &[u16::try_from(name.len()).unwrap_or(u16::MAX), 28, 0, 0, 0, 0, 0]);
            bytes.extend([0xFF; 4]);
            bytes.extend(name.as_bytes());
            extend(&mut bytes, &[1, 24]);
            [size, size, offset].iter().for_each(|number| bytes.extend(number.to_le_bytes()));
        }
        let (size, count) = (bytes.len() as u64, self.entries.len() as u64);
        bytes.extend(b"PK\x06\x06");
        bytes.extend(44_u64.to_le_bytes());
        extend(&mut bytes, &[VERSION, VERSION]);
        bytes.extend([0; 8]);
        [count, count, size, offset].iter().for_each(|number| bytes.extend(number.to_le_bytes()));
        bytes.extend(b"PK\x06\x07\0\0\0\0");
        bytes.extend((offset + size).to_le_bytes());
        bytes.extend(b"\x01\0\0\0PK\x05\x06\0\0\0\0");
        bytes.extend([0xFF; 12]);
        bytes.extend([0; 2]);
        writer.write_all(&bytes)?;
        writer.flush()
    }
}

impl<'a, 'z, S: Clebsch, W: Write + Seek, L: Quantities<S, M>, M: Method<S>> Recorder<'a, S, Npy<Entry<'z, W>>, L, M> {
    /// Writes an array of NumPy, as [`npy`](Self::npy) does, to a new entry of an archive. The entry ends with the recorder.
    ///
    /// # Errors
    /// [`RecordError::SameName`] and [`RecordError::LongName`] for the name of the entry, and those of [`npy`](Self::npy).
    pub fn npz(archive: &'z mut Npz<W>, name: &str, table: Table<'a, S, M, L>) -> Result<Self, RecordError> {
        check_names(&table)?;
        let file = std::format!("{name}.npy");
        if archive.entries.iter().any(|entry| entry.name == file) {
            return Err(RecordError::SameName { name: name.to_string() });
        }
        if u16::try_from(file.len()).is_err() {
            return Err(RecordError::LongName { bytes: name.len() });
        }
        let fields = fields(table.quantities());
        let entry = Entry::new(archive, file, header(&fields, 0).len())?;
        Ok(Recorder { table, sink: Npy::new(entry, fields)?, rows: 0 })
    }
}

impl<W: Write + Seek> Drop for Npz<W> {
    fn drop(&mut self) {
        if self.writer.is_some() {
            // `finish` tells of errors
            let _ = self.write_directory();
        }
    }
}

fn extend(bytes: &mut Vec<u8>, numbers: &[u16]) {
    numbers.iter().for_each(|number| bytes.extend(number.to_le_bytes()));
}

/// The entry of an archive that is written now. It counts bytes from its own start.
///
/// When it is dropped, its sizes and its checksum are written in front of it.
#[derive(Debug)]
pub struct Entry<'z, W: Write + Seek> {
    archive: &'z mut Npz<W>,
    name: String,
    /// Where its header is in the archive.
    offset: u64,
    /// Its first bytes, which are written again at its end.
    head: Vec<u8>,
    /// The checksum of the bytes behind these.
    checksum: u32,
    position: u64,
    size: u64,
}

impl<'z, W: Write + Seek> Entry<'z, W> {
    fn new(archive: &'z mut Npz<W>, name: String, head: usize) -> io::Result<Self> {
        let start = archive.start;
        let writer = archive.writer()?;
        let offset = writer.stream_position()? - start;
        writer.write_all(&local_header(&name, 0, 0))?;
        Ok(Self { archive, name, offset, head: std::vec![0; head], checksum: 0, position: 0, size: 0 })
    }

    /// Where its first byte is in the file.
    fn begin(&self) -> u64 {
        self.archive.start + self.offset + LOCAL + self.name.len() as u64 + 20
    }

    fn complete(&mut self) -> io::Result<()> {
        let head = self.head.len() as u64;
        let behind = self.size.saturating_sub(head);
        let sum = joined(checksum(0, &self.head), self.checksum, behind);
        let (header, start) = (local_header(&self.name, sum, self.size), self.archive.start + self.offset);
        let end = self.begin() + self.size;
        let writer = self.archive.writer()?;
        writer.seek(SeekFrom::Start(start))?;
        writer.write_all(&header)?;
        writer.seek(SeekFrom::Start(end))?;
        let name = core::mem::take(&mut self.name);
        self.archive.entries.push(Listed { name, offset: self.offset, size: self.size, checksum: sum });
        Ok(())
    }
}

impl<W: Write + Seek> Npz<W> {
    fn writer(&mut self) -> io::Result<&mut W> {
        // by construction: an entry is written before the archive ends
        self.writer.as_mut().ok_or_else(|| io::Error::other("the archive has ended"))
    }
}

/// The header in front of an entry.
fn local_header(name: &str, checksum: u32, size: u64) -> Vec<u8> {
    let mut bytes = b"PK\x03\x04".to_vec();
    extend(&mut bytes, &[VERSION, FLAGS, 0, 0, DATE]);
    bytes.extend(checksum.to_le_bytes());
    bytes.extend([0xFF; 8]);
    // by construction: `Recorder::npz` has checked the length of the name
    extend(&mut bytes, &[u16::try_from(name.len()).unwrap_or(u16::MAX), 20]);
    bytes.extend(name.as_bytes());
    extend(&mut bytes, &[1, 16]);
    [size, size].iter().for_each(|number| bytes.extend(number.to_le_bytes()));
    bytes
}

impl<W: Write + Seek> Write for Entry<'_, W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.archive.writer()?.write(bytes)?;
        let bytes = bytes.get(..written).unwrap_or(bytes);
        let place = usize::try_from(self.position).unwrap_or(usize::MAX).min(self.head.len());
        let in_head = bytes.len().min(self.head.len() - place);
        let (first, others) = bytes.split_at(in_head);
        if let Some(head) = self.head.get_mut(place..place + in_head) {
            head.copy_from_slice(first);
        }
        // bytes behind the head come once, one after the other
        self.checksum = checksum(self.checksum, others);
        self.position += bytes.len() as u64;
        self.size = self.size.max(self.position);
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.archive.writer()?.flush()
    }
}

impl<W: Write + Seek> Seek for Entry<'_, W> {
    fn seek(&mut self, place: SeekFrom) -> io::Result<u64> {
        let target = match place {
            SeekFrom::Start(target) => Some(target),
            SeekFrom::Current(by) => self.position.checked_add_signed(by),
            SeekFrom::End(by) => self.size.checked_add_signed(by),
        };
        let target = target.ok_or_else(|| io::Error::from(io::ErrorKind::InvalidInput))?;
        let begin = self.begin();
        self.archive.writer()?.seek(SeekFrom::Start(begin + target))?;
        self.position = target;
        Ok(target)
    }
}

impl<W: Write + Seek> Drop for Entry<'_, W> {
    fn drop(&mut self) {
        if let Err(error) = self.complete() {
            self.archive.error.get_or_insert(error);
        }
    }
}
