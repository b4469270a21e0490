//! Deserializes the fields of a message in order.
//!
//! ROS 1 writes little-endian without padding. ROS 2 writes CDR: four bytes state the byte order, and each number is
//! aligned to its size, counted from there.
//! Source: OMG, "Extended and dynamic topic types for DDS", 1.3, section 7.4; "Common object request
//! broker architecture", 3.3, section 9.3.1.

use std::fmt;

use crate::plausible::MAX_BEAMS;

/// Serialization of a message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wire {
    /// ROS 1: without padding.
    Ros1,
    /// ROS 2: CDR with its four-byte header.
    Cdr,
}

/// A deserialization error and its position.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WireError {
    /// Byte offset in the message.
    pub at: usize,
    /// What was expected.
    pub expected: String,
}

impl fmt::Display for WireError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} expected at its byte {}", self.expected, self.at)
    }
}

/// Reads the bytes of one message.
#[derive(Clone, Debug)]
pub struct WireReader<'a> {
    bytes: &'a [u8],
    at: usize,
    wire: Wire,
    is_little: bool,
    /// Origin of alignment.
    origin: usize,
    /// Alignment of eight-byte numbers.
    widest: usize,
}

impl<'a> WireReader<'a> {
    /// Creates a reader at the first field.
    ///
    /// # Errors
    /// If the CDR header is not supported.
    pub fn new(wire: Wire, bytes: &'a [u8]) -> Result<Self, WireError> {
        let mut reader = Self {
            bytes,
            at: 0,
            wire,
            is_little: true,
            origin: 0,
            widest: 8,
        };
        if wire == Wire::Cdr {
            let [first, kind, _, _] = reader.array("CDR's four bytes")?;
            // Plain CDR and plain CDR 2; the low bit states the byte order.
            if first != 0 || !matches!(kind, 0 | 1 | 6 | 7) {
                return Err(WireError {
                    at: 0,
                    expected: format!("plain CDR, not kind {first} {kind},"),
                });
            }
            reader.is_little = kind & 1 == 1;
            reader.origin = 4;
            reader.widest = if kind >= 6 { 4 } else { 8 };
        }
        Ok(reader)
    }

    /// Serialization of this message.
    pub fn wire(&self) -> Wire {
        self.wire
    }

    fn array<const N: usize>(&mut self, what: &str) -> Result<[u8; N], WireError> {
        let taken = self.take(N, what)?;
        Ok(taken.try_into().expect("as many bytes as were asked for"))
    }

    fn take(&mut self, count: usize, what: &str) -> Result<&'a [u8], WireError> {
        let end = self.at.checked_add(count);
        let Some(taken) = end.and_then(|end| self.bytes.get(self.at..end)) else {
            return Err(WireError {
                at: self.at,
                expected: format!(
                    "{what} ({count} bytes, {} are left)",
                    self.bytes.len().saturating_sub(self.at)
                ),
            });
        };
        self.at += count;
        Ok(taken)
    }

    fn number<const N: usize>(&mut self, what: &str) -> Result<[u8; N], WireError> {
        if self.wire == Wire::Cdr {
            let step = N.min(self.widest);
            let past = (self.at - self.origin) % step;
            if past > 0 {
                self.take(step - past, what)?;
            }
        }
        let mut bytes: [u8; N] = self.array(what)?;
        if !self.is_little {
            bytes.reverse();
        }
        Ok(bytes)
    }

    /// The next byte.
    pub fn u8(&mut self, what: &str) -> Result<u8, WireError> {
        Ok(u8::from_le_bytes(self.number(what)?))
    }

    /// The next 16-bit integer.
    pub fn u16(&mut self, what: &str) -> Result<u16, WireError> {
        Ok(u16::from_le_bytes(self.number(what)?))
    }

    /// The next 32-bit integer.
    pub fn u32(&mut self, what: &str) -> Result<u32, WireError> {
        Ok(u32::from_le_bytes(self.number(what)?))
    }

    /// The next 64-bit integer.
    pub fn u64(&mut self, what: &str) -> Result<u64, WireError> {
        Ok(u64::from_le_bytes(self.number(what)?))
    }

    /// The next 32-bit float.
    pub fn f32(&mut self, what: &str) -> Result<f64, WireError> {
        Ok(f64::from(f32::from_le_bytes(self.number(what)?)))
    }

    /// The next 64-bit float.
    pub fn f64(&mut self, what: &str) -> Result<f64, WireError> {
        Ok(f64::from_le_bytes(self.number(what)?))
    }

    /// The next text as a printable name; invalid bytes become question marks.
    pub fn name(&mut self, what: &str) -> Result<String, WireError> {
        let count = self.u32(what)? as usize;
        let bytes = self.take(count, what)?;
        let bytes = match self.wire {
            // CDR includes the terminating zero.
            Wire::Cdr => bytes.strip_suffix(&[0]).unwrap_or(bytes),
            Wire::Ros1 => bytes,
        };
        Ok(crate::lines::name(&String::from_utf8_lossy(bytes)))
    }

    /// A list of bytes.
    pub fn bytes(&mut self, what: &str) -> Result<&'a [u8], WireError> {
        let count = self.u32(what)? as usize;
        self.take(count, what)
    }

    /// All remaining bytes.
    pub fn rest(&self) -> &'a [u8] {
        &self.bytes[self.at..]
    }

    /// Reads the length of a list whose items have at least `smallest` bytes.
    pub fn count(&mut self, what: &str, smallest: usize) -> Result<usize, WireError> {
        let at = self.at;
        let count = self.u32(what)? as usize;
        let left = self.bytes.len() - self.at;
        if count.saturating_mul(smallest) > left {
            return Err(WireError {
                at,
                expected: format!("fewer {what} than {count}, for which {left} bytes are left,"),
            });
        }
        Ok(count)
    }

    /// A list of 32-bit floats, as many as a scan may have.
    pub fn f32_list(&mut self, what: &str) -> Result<Vec<f64>, WireError> {
        let at = self.at;
        let count = self.count(what, 4)?;
        if count > MAX_BEAMS {
            return Err(WireError {
                at,
                expected: format!("at most {MAX_BEAMS} {what}, not {count},"),
            });
        }
        (0..count).map(|_| self.f32(what)).collect()
    }

    /// Seconds and nanoseconds, s.
    pub fn stamp_s(&mut self) -> Result<f64, WireError> {
        let seconds = self.u32("seconds")?;
        let nanoseconds = self.u32("nanoseconds")?;
        Ok(f64::from(seconds) + f64::from(nanoseconds) * 1e-9)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_cdr_stand_at_multiples_of_their_size_in_either_order() {
        // OMG CORBA 3.3, 9.3.1: an octet, three bytes of padding, a long; four bytes of padding, a double.
        let little = [
            0, 1, 0, 0, 7, 0, 0, 0, 2, 1, 0, 0, 0, 0, 0, 0, 0, 0, 248, 63,
        ];
        let big = [
            0, 0, 0, 0, 7, 0, 0, 0, 0, 0, 1, 2, 63, 248, 0, 0, 0, 0, 0, 0,
        ];
        for bytes in [little, big] {
            let mut reader = WireReader::new(Wire::Cdr, &bytes).unwrap();
            assert_eq!(reader.u8("a"), Ok(7));
            assert_eq!(reader.u32("b"), Ok(258));
            assert_eq!(reader.f64("c"), Ok(1.5));
        }
    }

    #[test]
    fn ros_1_has_no_gaps_and_its_texts_no_zero() {
        let bytes = [7, 2, 0, 0, 0, b'a', b'b', 0, 0, 192, 63];
        let mut reader = WireReader::new(Wire::Ros1, &bytes).unwrap();
        assert_eq!(reader.u8("a"), Ok(7));
        assert_eq!(reader.name("b").unwrap(), "ab");
        assert_eq!(reader.f32("c"), Ok(1.5));
        let past = reader.u32("d").unwrap_err();
        assert_eq!(
            past.to_string(),
            "d (4 bytes, 0 are left) expected at its byte 11"
        );
    }

    #[test]
    fn a_list_longer_than_its_message_costs_no_memory() {
        let bytes = [255, 255, 255, 255, 0, 0, 0, 0];
        let mut reader = WireReader::new(Wire::Ros1, &bytes).unwrap();
        let error = reader.f32_list("ranges").unwrap_err().to_string();
        assert!(error.contains("fewer ranges than 4294967295"), "{error}");
    }

    #[test]
    fn other_encodings_than_plain_cdr_are_named() {
        let error = WireReader::new(Wire::Cdr, &[0, 3, 0, 0]).unwrap_err();
        assert!(error.to_string().contains("plain CDR, not kind 0 3"));
    }
}
