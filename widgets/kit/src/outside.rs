//! What a host brings to a widget, and what the widget asks of it.
//!
//! Most widgets compute all that they show. One that shows a reader's own file cannot: its host opens
//! the file, has it worked on elsewhere, and brings what came of it. So that the model stays a model,
//! both ways are plain data: deliveries in, orders out.

/// Something that the host brings: a kind, words, numbers, bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Delivery<'a> {
    /// What it is: `keyframes`.
    pub kind: &'a str,
    /// Words.
    pub text: &'a str,
    /// Numbers.
    pub numbers: &'a [f64],
    /// Bytes, such as the cells of a picture.
    pub bytes: &'a [u8],
}
