//! The timeline of a run, with its events.

/// A run that can be scrubbed.
#[derive(Clone, Debug, PartialEq)]
pub struct Timeline {
    /// The parameter that holds the position; beyond the last one it means the end.
    pub param: &'static str,
    /// Last position; the first is 0.
    pub last: f64,
    /// Whether it plays.
    pub playing: bool,
    /// Events on the timeline.
    pub marks: Vec<TimelineMark>,
}

/// An event on the timeline.
#[derive(Clone, Debug, PartialEq)]
pub struct TimelineMark {
    /// Position.
    pub at: f64,
    /// Label: `loop 29 to 7 accepted`.
    pub label: String,
    /// Good or bad.
    pub standing: Assessment,
}

/// The assessment of an outcome.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Assessment {
    /// A desirable result.
    Good,
    /// A result to beware of.
    Bad,
    /// A result that the reader should check.
    Doubtful,
    /// Neither.
    Neutral,
}
