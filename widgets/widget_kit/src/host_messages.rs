//! Messages between a host and a widget.
//!
//! Most widgets compute everything that they show. One that shows a reader's own file cannot: its host opens
//! the file, processes it elsewhere, and delivers the results. The messages are plain data, which keeps the
//! model free of I/O: deliveries in, orders out.

/// A message of the host: a kind, words, numbers, bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Delivery<'a> {
    /// Its kind: `keyframes`.
    pub kind: &'a str,
    /// Words.
    pub text: &'a str,
    /// Numbers.
    pub numbers: &'a [f64],
    /// Bytes, such as the cells of a raster.
    pub bytes: &'a [u8],
}
