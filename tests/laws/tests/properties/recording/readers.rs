//! Readers of the formats, written from their specifications: RFC 4180, NEP 1 of NumPy and the ZIP File Format Specification.

/// The lines of a text, each with its fields. A field in quotes may have commas.
pub fn lines(text: &str) -> Vec<Vec<String>> {
    text.lines().map(fields).collect()
}

fn fields(line: &str) -> Vec<String> {
    let (mut all, mut field, mut is_quoted) = (Vec::new(), String::new(), false);
    let mut characters = line.chars().peekable();
    while let Some(character) = characters.next() {
        match character {
            '"' if is_quoted && characters.next_if_eq(&'"').is_some() => field.push('"'),
            '"' => is_quoted = !is_quoted,
            ',' if !is_quoted => all.push(std::mem::take(&mut field)),
            other => field.push(other),
        }
    }
    all.push(field);
    all
}

/// An array of NumPy whose entries are records of `f64`.
pub struct Array<'a> {
    pub version: u8,
    /// The text of its header.
    pub text: &'a str,
    pub rows: usize,
    /// Each field by its name, with its shape.
    pub fields: Vec<(String, Vec<usize>)>,
    width: usize,
    data: &'a [u8],
}

impl<'a> Array<'a> {
    pub fn read(bytes: &'a [u8]) -> Array<'a> {
        assert_eq!((&bytes[..6], bytes[7]), (&b"\x93NUMPY"[..], 0));
        let version = bytes[6];
        let (length, start) = match version {
            1 => (usize::from(u16::from_le_bytes([bytes[8], bytes[9]])), 10),
            _ => (u32::from_le_bytes([bytes[8], bytes[9], bytes[10], bytes[11]]) as usize, 12),
        };
        let data = start + length;
        assert_eq!((data % 64, bytes[data - 1]), (0, b'\n'));
        let text = std::str::from_utf8(&bytes[start..data]).expect("a text");
        let descr = between(text, "'descr': [", "], 'fortran_order': False, 'shape': (");
        let rows = between(text, "'fortran_order': False, 'shape': (", ",), }").parse().expect("a number");
        let (mut fields, mut width, mut left) = (Vec::new(), 0, descr);
        while let Some((field, others)) = left.strip_prefix("('").map(|field| field.split_once("', ").expect("a name"))
        {
            let (size, shape, others) = form(others);
            width += size;
            fields.push((field.to_string(), shape));
            left = others;
        }
        assert_eq!(left, "");
        Array { version, text, rows, fields, width, data: &bytes[data..] }
    }

    /// The numbers, row by row.
    pub fn numbers(&self) -> Vec<Vec<f64>> {
        let numbers = self.data.chunks_exact(8).map(|chunk| f64::from_le_bytes(chunk.try_into().expect("8 bytes")));
        let numbers: Vec<f64> = numbers.collect();
        assert_eq!(numbers.len(), self.rows * self.width);
        numbers.chunks(self.width).map(<[f64]>::to_vec).collect()
    }
}

/// The form of a field up to its end: the count of its numbers, its shape, and the text behind it.
fn form(text: &str) -> (usize, Vec<usize>, &str) {
    let (of_one, mut text) = match text.strip_prefix("'<f8'") {
        Some(text) => (1, text),
        None => {
            let (mut size, mut text) = (0, text.strip_prefix('[').expect("a number or fields"));
            while let Some(field) = text.strip_prefix("('") {
                let (part, _, others) = form(field.split_once("', ").expect("a name").1);
                size += part;
                text = others;
            }
            (size, text.strip_prefix(']').expect("the end of fields"))
        }
    };
    let mut shape = Vec::new();
    if let Some(sizes) = text.strip_prefix(", (") {
        let (sizes, others) = sizes.split_once(')').expect("a shape");
        shape.extend(
            sizes.split(", ").filter(|size| !size.is_empty()).map(|size| size.parse::<usize>().expect("a size")),
        );
        text = others;
    }
    let others = text.strip_prefix("), ").expect("the end of a field");
    (of_one * shape.iter().product::<usize>(), shape, others)
}

fn between<'a>(text: &'a str, before: &str, after: &str) -> &'a str {
    text.split_once(before).expect(before).1.split_once(after).expect(after).0
}

/// The entries of an archive by its directory, each with its name and its bytes.
pub fn entries(bytes: &[u8]) -> Vec<(String, &[u8])> {
    let short = |place: usize| usize::from(u16::from_le_bytes(bytes[place..place + 2].try_into().expect("2 bytes")));
    let word = |place: usize| u32::from_le_bytes(bytes[place..place + 4].try_into().expect("4 bytes"));
    let long = |place: usize| u64::from_le_bytes(bytes[place..place + 8].try_into().expect("8 bytes")) as usize;
    let end = bytes.len() - 22;
    assert_eq!((word(end), word(end - 20)), (0x0605_4b50, 0x0706_4b50));
    let record = long(end - 12);
    assert_eq!((word(record), record + 56), (0x0606_4b50, end - 20));
    let (count, mut place) = (long(record + 32), long(record + 48));
    let mut all = Vec::new();
    for _ in 0..count {
        assert_eq!((word(place), short(place + 10)), (0x0201_4b50, 0));
        let (name, extra) = (short(place + 28), place + 46 + short(place + 28));
        assert_eq!((short(extra), short(extra + 2)), (1, 24));
        let (size, local) = (long(extra + 4), long(extra + 20));
        let start = local + 30 + short(local + 26) + short(local + 28);
        let data = &bytes[start..start + size];
        assert_eq!((word(local), word(local + 14)), (0x0403_4b50, word(place + 16)));
        assert_eq!(word(place + 16), checksum(data));
        all.push((String::from_utf8_lossy(&bytes[place + 46..extra]).into_owned(), data));
        place = extra + 28;
        assert_eq!(name, all[all.len() - 1].0.len());
    }
    assert_eq!(place, record);
    all
}

/// CRC-32, bit by bit.
fn checksum(bytes: &[u8]) -> u32 {
    let bits = bytes.iter().flat_map(|byte| (0..8).map(move |bit| u32::from(byte >> bit & 1)));
    !bits.fold(!0, |sum, bit| (sum >> 1) ^ if (sum ^ bit) & 1 == 1 { 0xEDB8_8320 } else { 0 })
}
