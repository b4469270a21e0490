//! Orders of the reader to the worker.

use serde::{Deserialize, Serialize};

/// An order to the worker. Keyframes and loops are given by their index.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum MapperOrder {
    /// Send the scan of this keyframe.
    Look(usize),
    /// Remove this loop from the graph, or add it.
    Turn(usize),
    /// Keep this loop, which the rest of the graph contradicts.
    Accept(usize),
    /// Remove this loop; unlike [`MapperOrder::Turn`] it never adds one.
    Reject(usize),
    /// Register these two keyframes, and add the loop if it is accepted.
    Add(usize, usize),
    /// Fix this keyframe at `[x, y, θ]`, m and rad.
    Pin(usize, [f64; 3]),
    /// Fix no keyframe any more.
    Unpin,
}

impl MapperOrder {
    /// The request to the page that passes the order on.
    #[must_use]
    pub fn request(&self) -> String {
        let json = serde_json::to_string(self).expect("plain numbers");
        format!("worker {json}")
    }

    /// Reads the order of a request; `None` if it is none.
    #[must_use]
    pub fn from_request(request: &str) -> Option<Self> {
        serde_json::from_str(request.strip_prefix("worker ")?).ok()
    }

    /// Whether only the last one of its kind counts.
    #[must_use]
    pub fn replaces(&self, earlier: &Self) -> bool {
        matches!(
            (self, earlier),
            (Self::Look(_), Self::Look(_)) | (Self::Pin(..), Self::Pin(..))
        )
    }
}
