//! A digest of all bits of a result, to compare machines and builds.
//!
//! A difference in one last bit changes the digest. It is not a cryptographic hash.

use pr_geom::SE2;

/// FNV-1a over the bytes of 64-bit words (Fowler, Noll, Vo 1991).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Digest(u64);

impl Default for Digest {
    fn default() -> Self {
        Self::new()
    }
}

impl Digest {
    /// The digest of an empty sequence.
    #[must_use]
    pub fn new() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }

    /// Adds a word.
    pub fn add_bits(&mut self, bits: u64) {
        for byte in bits.to_le_bytes() {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }

    /// Adds a number by its bits: 0 and −0 differ.
    pub fn add(&mut self, value: f64) {
        self.add_bits(value.to_bits());
    }

    /// Adds numbers in their order.
    pub fn add_all<'a>(&mut self, values: impl IntoIterator<Item = &'a f64>) {
        values.into_iter().for_each(|value| self.add(*value));
    }

    /// Adds x, y and θ of a pose.
    pub fn add_pose(&mut self, pose: &SE2) {
        self.add_all(&pose.to_array());
    }

    /// The digest of what was added so far.
    #[must_use]
    pub fn value(self) -> u64 {
        self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(values: &[f64]) -> u64 {
        let mut digest = Digest::new();
        digest.add_all(values);
        digest.value()
    }

    #[test]
    fn order_sign_of_zero_and_last_bit_change_the_digest() {
        assert_ne!(of(&[1.0, 2.0]), of(&[2.0, 1.0]));
        assert_ne!(of(&[0.0]), of(&[-0.0]));
        assert_ne!(of(&[1.0]), of(&[1.0 + f64::EPSILON]));
    }
}
