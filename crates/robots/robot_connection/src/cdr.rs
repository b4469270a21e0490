//! Messages of ROS 2 in CDR, little-endian.
//!
//! Source: OMG, "Extended and dynamic topic types for DDS", 7.4. A number is aligned to its size, counted from the end of
//! the header of four bytes.

/// Fields of a message, in order.
#[derive(Clone, Debug)]
pub struct Cdr(Vec<u8>);

impl Default for Cdr {
    fn default() -> Self {
        Self(vec![0, 1, 0, 0])
    }
}

impl Cdr {
    fn number<const SIZE: usize>(&mut self, bytes: [u8; SIZE]) {
        while !(self.0.len() - 4).is_multiple_of(SIZE) {
            self.0.push(0);
        }
        self.0.extend_from_slice(&bytes);
    }

    /// Adds an unsigned integer, or the length of a list.
    pub fn u32(&mut self, value: u32) {
        self.number(value.to_le_bytes());
    }

    /// Adds a number of four bytes.
    pub fn f32(&mut self, value: f32) {
        self.number(value.to_le_bytes());
    }

    /// Adds a number of eight bytes.
    pub fn f64(&mut self, value: f64) {
        self.number(value.to_le_bytes());
    }

    /// Adds bytes as they are.
    pub fn raw(&mut self, bytes: &[u8]) {
        self.0.extend_from_slice(bytes);
    }

    /// Adds a list of bytes.
    pub fn bytes(&mut self, bytes: &[u8]) {
        self.u32(bytes.len() as u32);
        self.raw(bytes);
    }

    /// Adds a text.
    pub fn text(&mut self, text: &str) {
        self.u32(text.len() as u32 + 1);
        self.raw(text.as_bytes());
        self.raw(&[0]);
    }

    /// Adds a time, s.
    pub fn time(&mut self, stamp_s: f64) {
        let nanoseconds = nanoseconds(stamp_s);
        self.u32((nanoseconds / 1_000_000_000) as u32);
        self.u32((nanoseconds % 1_000_000_000) as u32);
    }

    /// Adds a header: time (s) and frame.
    pub fn header(&mut self, stamp_s: f64, frame: &str) {
        self.time(stamp_s);
        self.text(frame);
    }

    /// Adds numbers of eight bytes, such as position and quaternion of a pose.
    pub fn f64s(&mut self, values: &[f64]) {
        values.iter().for_each(|&value| self.f64(value));
    }

    /// The message.
    #[must_use]
    pub fn finish(self) -> Vec<u8> {
        self.0
    }
}

/// A time (s) in nanoseconds; zero if it is earlier.
#[must_use]
pub fn nanoseconds(stamp_s: f64) -> u64 {
    (stamp_s.max(0.0) * 1e9).round() as u64
}
