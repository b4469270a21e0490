//! A floor plan as a text for links: numbers in digits of base 64, and a checksum.
//!
//! A number is zigzag coded (0, −1, 1, −2 … become 0, 1, 2, 3 …) and written from its lowest five bits on; the
//! sixth bit of a digit is set if more follow, as in source maps. In order: the version, the turn (counted
//! from 1, or 0), the heading, the start, the number of waypoints and each as the step from the point
//! before, the number of walls, and of each its first end as the step from the second end of the wall before
//! and its second end as the step from the first. A wall along an axis takes a handful of digits. Five more
//! are FNV-1a of all others, which detects lost or changed characters.

use super::{PlaceCm, Sketch, SketchError, limits};

/// The digits: those of base64url.
const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";

/// The version of the format that is written, and the newest that is read.
const VERSION: i32 = 1;

/// Number of digits of the checksum.
const CHECK_DIGITS: usize = 5;

/// Number of bits of the number in a digit.
const DATA_BITS: u32 = 5;

impl Sketch {
    /// Writes the floor plan as letters, digits, `-` and `_`, for [`Sketch::from_text`].
    #[must_use]
    pub fn to_text(&self) -> String {
        let mut writer = Writer::default();
        writer.number(VERSION);
        writer.count(self.turn.map_or(0, |turn| turn + 1));
        writer.number(self.heading_deg);
        let mut last = [0, 0];
        writer.step(&mut last, self.start_cm);
        writer.count(self.way_points_cm.len());
        for at in &self.way_points_cm {
            writer.step(&mut last, *at);
        }
        writer.count(self.walls_cm.len());
        let mut last = [0, 0];
        for end in self.walls_cm.iter().flatten() {
            writer.step(&mut last, *end);
        }
        writer.finish()
    }

    /// Reads the text of a floor plan; accepts only what [`Sketch::to_text`] writes.
    ///
    /// # Errors
    /// [`SketchError`].
    pub fn from_text(text: &str) -> Result<Self, SketchError> {
        let mut reader = Reader::new(text)?;
        if reader.number()? != VERSION {
            return Err(SketchError::Newer);
        }
        let turn = reader.count(limits::WAY_POINTS)?.checked_sub(1);
        let heading_deg = reader.number()?;
        let mut last = [0, 0];
        let start_cm = reader.step(&mut last)?;
        let count = reader.count(limits::WAY_POINTS)?;
        let way_points_cm: Vec<_> = (0..count)
            .map(|_| reader.step(&mut last))
            .collect::<Result<_, _>>()?;
        let count = reader.count(limits::WALLS)?;
        let mut last = [0, 0];
        let walls_cm = (0..count)
            .map(|_| Ok([reader.step(&mut last)?, reader.step(&mut last)?]))
            .collect::<Result<_, _>>()?;
        let sketch = Self {
            walls_cm,
            start_cm,
            heading_deg,
            way_points_cm,
            turn,
        };
        let is_whole = (0..360).contains(&heading_deg)
            && turn.is_none_or(|turn| turn < sketch.way_points_cm.len())
            && sketch.walls_cm.iter().all(|[from, to]| from != to);
        // Leading zeros are rejected, because every number has one spelling.
        if !is_whole || sketch.to_text() != text {
            return Err(SketchError::Damaged);
        }
        Ok(sketch)
    }
}

#[derive(Default)]
struct Writer {
    text: String,
}

impl Writer {
    fn number(&mut self, value: i32) {
        let mut rest = ((value << 1) ^ (value >> 31)).cast_unsigned();
        loop {
            let low = rest & ((1 << DATA_BITS) - 1);
            rest >>= DATA_BITS;
            let more = u32::from(rest > 0) << DATA_BITS;
            self.digit(low | more);
            if rest == 0 {
                return;
            }
        }
    }

    fn count(&mut self, count: usize) {
        // The lists are shorter than 2³¹ on every machine.
        self.number(i32::try_from(count).unwrap_or(i32::MAX));
    }

    fn step(&mut self, last: &mut PlaceCm, at: PlaceCm) {
        for (last, at) in last.iter_mut().zip(at) {
            self.number(at.wrapping_sub(*last));
            *last = at;
        }
    }

    fn digit(&mut self, value: u32) {
        self.text.push(char::from(DIGITS[value as usize % 64]));
    }

    fn finish(mut self) -> String {
        let check = check(self.text.as_bytes());
        for place in 0..CHECK_DIGITS as u32 {
            self.digit(check >> (6 * place));
        }
        self.text
    }
}

struct Reader<'a> {
    rest: core::slice::Iter<'a, u8>,
}

impl<'a> Reader<'a> {
    /// Checks the checksum and starts at the first number.
    fn new(text: &'a str) -> Result<Self, SketchError> {
        let bytes = text.as_bytes();
        let numbers = bytes.len().checked_sub(CHECK_DIGITS);
        let (numbers, given) = bytes.split_at(numbers.ok_or(SketchError::Damaged)?);
        let check = check(numbers);
        let fits = (0..CHECK_DIGITS)
            .all(|place| given[place] == DIGITS[(check >> (6 * place)) as usize % 64]);
        if !fits {
            return Err(SketchError::Damaged);
        }
        Ok(Self {
            rest: numbers.iter(),
        })
    }

    fn number(&mut self) -> Result<i32, SketchError> {
        let mut value = 0_u32;
        for shift in (0..u32::BITS).step_by(DATA_BITS as usize) {
            let byte = self.rest.next().ok_or(SketchError::Damaged)?;
            let digit = DIGITS.iter().position(|digit| digit == byte);
            let digit = digit.ok_or(SketchError::Damaged)? as u32;
            value |= (digit & ((1 << DATA_BITS) - 1)) << shift;
            if digit >> DATA_BITS == 0 {
                return Ok((value >> 1).cast_signed() ^ -(value & 1).cast_signed());
            }
        }
        Err(SketchError::Damaged)
    }

    fn count(&mut self, most: usize) -> Result<usize, SketchError> {
        let count = usize::try_from(self.number()?).map_err(|_| SketchError::Damaged)?;
        if count > most {
            return Err(SketchError::TooLarge);
        }
        Ok(count)
    }

    fn step(&mut self, last: &mut PlaceCm) -> Result<PlaceCm, SketchError> {
        for at in last.iter_mut() {
            *at = at.wrapping_add(self.number()?);
            if at.unsigned_abs() > limits::COORDINATE_CM {
                return Err(SketchError::TooLarge);
            }
        }
        Ok(*last)
    }
}

/// FNV-1a with 32 bits, thirty of which are written.
fn check(bytes: &[u8]) -> u32 {
    bytes.iter().fold(0x811c_9dc5, |hash, byte| {
        (hash ^ u32::from(*byte)).wrapping_mul(0x0100_0193)
    })
}

/// A text of any numbers with a valid checksum.
#[cfg(test)]
pub(super) fn written(numbers: &[i32]) -> String {
    let mut writer = Writer::default();
    for number in numbers {
        writer.number(*number);
    }
    writer.finish()
}
