//! The checksum of the entries of an archive: CRC-32 of ISO 3309, bits reflected.

/// The polynomial without its highest power, its lowest power first.
const POLYNOMIAL: u32 = 0xEDB8_8320;

/// x⁰, as bits are ordered here.
const ONE: u32 = 1 << 31;

/// The remainders of all bytes.
const REMAINDERS: [u32; 256] = {
    let mut all = [0; 256];
    let mut byte = 0;
    while byte < 256 {
        let mut value = byte as u32;
        let mut bit = 0;
        while bit < 8 {
            value = times_x(value);
            bit += 1;
        }
        all[byte] = value;
        byte += 1;
    }
    all
};

/// A polynomial times x, modulo the one of the checksum.
const fn times_x(value: u32) -> u32 {
    if value & 1 == 1 { (value >> 1) ^ POLYNOMIAL } else { value >> 1 }
}

/// The checksum of bytes behind others, whose checksum is `before`, 0 at first.
pub(super) fn checksum(before: u32, bytes: &[u8]) -> u32 {
    let step = |sum: u32, byte: &u8| {
        let [low, ..] = sum.to_le_bytes();
        REMAINDERS[usize::from(low ^ byte)] ^ (sum >> 8)
    };
    !bytes.iter().fold(!before, step)
}

/// The checksum of two parts, from that of each and the number of bytes of the second one.
///
/// The checksum of the first part is multiplied by x for every bit of the second one.
///
/// Source: Mark Adler, `crc32_combine` of zlib.
pub(super) fn joined(first: u32, second: u32, length: u64) -> u32 {
    // x⁸ for a byte, and its squares
    let (mut power, mut left, mut all) = (ONE >> 8, length, ONE);
    while left > 0 {
        if left & 1 == 1 {
            all = product(all, power);
        }
        power = product(power, power);
        left >>= 1;
    }
    product(all, first) ^ second
}

/// The product of two polynomials.
fn product(a: u32, mut b: u32) -> u32 {
    let mut sum = 0;
    for bit in (0..32).rev() {
        if a >> bit & 1 == 1 {
            sum ^= b;
        }
        b = times_x(b);
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::{checksum, joined};

    /// The check value that catalogues of checksums give for CRC-32/ISO-HDLC.
    #[test]
    fn checksums_have_the_check_value() {
        assert_eq!(checksum(0, b"123456789"), 0xCBF4_3926);
        assert_eq!(checksum(checksum(0, b"1234"), b"56789"), 0xCBF4_3926);
    }

    #[test]
    fn parts_are_joined() {
        for cut in 0..=9 {
            let (first, second) = b"123456789".split_at(cut);
            let sums = (checksum(0, first), checksum(0, second));
            assert_eq!(joined(sums.0, sums.1, second.len() as u64), 0xCBF4_3926);
        }
    }
}
