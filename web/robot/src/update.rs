//! What changed since the widget was last told: a kind, a text, numbers and bytes.
//!
//! | kind | numbers | text, bytes |
//! |---|---|---|
//! | `file` | size in bytes, whether there are scans | its name |
//! | `stage` | [`Stage`] as a number, share done, scans, loops tried, loops closed | what failed |
//! | `keyframes` | stamp (s), x, y (m), θ (rad), fit, σ (m) of each | |
//! | `map` | columns, rows, least x, least y, cell (m) | a byte a cell from the least y: 0 unknown, 1 free … 255 occupied |
//! | `loops` | ten for each, see [`links`](crate::links) | a line each: why it was turned away |
//! | `doubts` | keyframes to look into | a sentence a line |
//! | `diagnosis` | | the doctor's screen as `slam2d doctor --json` prints it |
//! | `remarks` | | what the log's owner should know, a sentence a line |
//! | `scan` | keyframe, then x and y of every point in the body's frame, m | |
//! | `grade` | see [`grade`](crate::grade) | in words |
//! | `errors` | error of each keyframe, m; NaN where there is none | |
//! | `offers` | | an option a line: its name, what is taken, what could be, with tabs between them |
//! | `where` | see [`whereabouts`](crate::whereabouts) | the other log's name, then a sentence a line |
//! | `answer` | | what became of the last order |

/// How far the engine is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// The file is read, scan by scan.
    Reading = 1,
    /// No scan follows: the last loops are closed.
    Finishing = 2,
    /// A graph from a file is solved.
    Solving = 3,
    /// The covariances are computed.
    Checking = 4,
    /// The map stands.
    Done = 5,
    /// Nothing could be done with the file.
    Failed = 6,
}

/// One change.
#[derive(Clone, Debug, PartialEq)]
pub struct Update {
    /// Which part changed.
    pub kind: &'static str,
    /// Words.
    pub text: String,
    /// Numbers.
    pub numbers: Vec<f64>,
    /// Cells.
    pub bytes: Vec<u8>,
}

impl Update {
    /// A change that is numbers alone.
    #[must_use]
    pub fn numbers(kind: &'static str, numbers: Vec<f64>) -> Self {
        Self {
            kind,
            text: String::new(),
            numbers,
            bytes: Vec::new(),
        }
    }

    /// A change that is words alone.
    #[must_use]
    pub fn text(kind: &'static str, text: impl Into<String>) -> Self {
        Self {
            text: text.into(),
            ..Self::numbers(kind, Vec::new())
        }
    }
}
