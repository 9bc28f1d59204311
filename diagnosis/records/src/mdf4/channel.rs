//! One channel: where its bits are, and what they mean.

use super::records::Layout;
use super::{Block, Bytes, DataError, text};

/// Takes a channel's value out of a record.
pub(super) struct Reader {
    /// Whether it is the time of its group.
    pub is_time: bool,
    /// The unit's symbol.
    pub unit: String,
    coding: Coding,
    bit: u64,
    bits: u64,
    start: usize,
    length: usize,
    /// Bit of the invalidation bytes, counted from the start of the record.
    invalid: Option<usize>,
    scale: f64,
    offset: f64,
}

#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Unsigned,
    Signed,
    Float,
}

#[derive(Clone, Copy)]
struct Coding {
    kind: Kind,
    big_endian: bool,
}

impl Reader {
    /// Reads a `CN` block; the inner error says why the channel is left out.
    pub fn read(bytes: Bytes, block: &Block, layout: &Layout) -> Result<Result<Self, String>, DataError> {
        let (kind, sync, data) = (block.number(0, 1)?, block.number(1, 1)?, block.number(2, 1)?);
        let (bit, byte, bits) = (block.number(3, 1)?, block.number(4, 4)?, block.number(8, 4)?);
        let (flags, invalid) = (block.number(12, 4)?, block.number(16, 4)?);
        // Fixed length, master; virtual channels and those of variable length have no value in the record.
        if !matches!(kind, 0 | 2) {
            return Ok(Err(format!("channels of type {kind} are not read")));
        }
        if kind == 2 && sync != 1 {
            return Ok(Err("the master channel is not one of time".into()));
        }
        if block.link(1) != 0 {
            return Ok(Err("arrays and structures are not read".into()));
        }
        let coding = match data {
            0..=5 => Coding {
                kind: [Kind::Unsigned, Kind::Signed, Kind::Float][data as usize / 2],
                big_endian: data % 2 == 1,
            },
            6..=9 => return Ok(Err("text".into())),
            _ => return Ok(Err(format!("data of type {data} are not read"))),
        };
        let length = (bit + bits).div_ceil(8);
        let aligned = bit == 0 && matches!(bits, 16 | 32 | 64);
        if bits == 0 || length > 8 || bit > 7 || (coding.kind == Kind::Float && !aligned) {
            return Ok(Err(format!("values of {bits} bits from bit {bit} are not read")));
        }
        let invalid = match flags & 0b11 {
            1 => return Ok(Err("all its samples are invalid".into())),
            2 => Some(layout.values * 8 + invalid as usize),
            _ => None,
        };
        let outside = byte + length > layout.values as u64
            || invalid.is_some_and(|bit| bit / 8 >= layout.values + layout.invalidation);
        if outside {
            return Err(bytes.error("is damaged: a channel lies outside of its record"));
        }
        let (scale, offset, unit_of_conversion) = match conversion(bytes, block.link(4))? {
            Ok(conversion) => conversion,
            Err(why) => return Ok(Err(why)),
        };
        let own_unit = text(bytes, block.link(6))?;
        let unit = if own_unit.is_empty() { unit_of_conversion } else { own_unit }.trim().to_owned();
        let (start, length) = (byte as usize, length as usize);
        Ok(Ok(Self { is_time: kind == 2, unit, coding, bit, bits, start, length, invalid, scale, offset }))
    }

    /// The value in a record that is as long as its layout says; NaN if it is marked as invalid.
    pub fn value(&self, record: &[u8]) -> f64 {
        if self.invalid.is_some_and(|bit| record[bit / 8] >> (bit % 8) & 1 == 1) {
            return f64::NAN;
        }
        let bytes = &record[self.start..self.start + self.length];
        let join = |number: u64, &byte: &u8| number << 8 | u64::from(byte);
        let raw = if self.coding.big_endian {
            bytes.iter().fold(0, join)
        } else {
            bytes.iter().rev().fold(0, join)
        };
        // Bits above the value's are another channel's.
        let unused = 64 - self.bits;
        let raw = raw >> self.bit << unused;
        let value = match (self.coding.kind, self.bits) {
            (Kind::Unsigned, _) => (raw >> unused) as f64,
            (Kind::Signed, _) => (raw.cast_signed() >> unused) as f64,
            (Kind::Float, 64) => f64::from_bits(raw),
            (Kind::Float, 32) => f64::from(f32::from_bits((raw >> 32) as u32)),
            (Kind::Float, _) => half((raw >> 48) as u16),
        };
        self.scale * value + self.offset
    }
}

/// The value of an IEEE 754 half-precision number.
fn half(bits: u16) -> f64 {
    let sign = if bits >> 15 == 1 { -1.0 } else { 1.0 };
    let (exponent, fraction) = (i32::from(bits >> 10 & 0x1F), f64::from(bits & 0x3FF) / 1024.0);
    sign * match exponent {
        0 => fraction * 2.0_f64.powi(-14),
        0x1F if fraction == 0.0 => f64::INFINITY,
        0x1F => f64::NAN,
        _ => (1.0 + fraction) * 2.0_f64.powi(exponent - 15),
    }
}

/// Factor, offset and unit of a `CC` block.
fn conversion(bytes: Bytes, at: u64) -> Result<Result<(f64, f64, String), String>, DataError> {
    if at == 0 {
        return Ok(Ok((1.0, 0.0, String::new())));
    }
    let block = Block::read(bytes, at, "##CC")?;
    let unit = text(bytes, block.link(1))?;
    // cc_type, precision, flags (2), cc_ref_count (2), cc_val_count (2), range (16), values.
    let value = |number: u64| block.float(24 + 8 * number);
    Ok(match block.number(0, 1)? {
        0 => Ok((1.0, 0.0, unit)),
        1 => Ok((value(1)?, value(0)?, unit)),
        // (P1 x² + P2 x + P3)/(P4 x² + P5 x + P6), which recorders also use for straight lines.
        2 if value(0)? == 0.0 && value(3)? == 0.0 && value(4)? == 0.0 && value(5)? != 0.0 => {
            Ok((value(1)? / value(5)?, value(2)? / value(5)?, unit))
        }
        other => Err(format!("conversions of type {other} are not read, only linear ones")),
    })
}

#[cfg(test)]
mod tests {
    use super::half;

    #[test]
    fn half_precision() {
        for (bits, value) in
            [(0x3C00, 1.0), (0xC000, -2.0), (0x7BFF, 65504.0), (0x0001, 2.0_f64.powi(-24)), (0, 0.0)]
        {
            assert_eq!(half(bits), value);
        }
        assert_eq!(half(0x7C00), f64::INFINITY);
        assert!(half(0x7E00).is_nan());
    }
}
