//! Remarks on corrected stamps.

use super::MendedStamps;
use crate::remark::{Part, Remark};

impl MendedStamps {
    /// One remark per correction; `messages` is their plural noun, such as “scans”.
    #[must_use]
    pub fn remarks(&self, messages: &str) -> Vec<Remark> {
        let all = self.stamps_s.len();
        let mut remarks = Vec::new();
        if self.unset > 0 {
            remarks.push(format!(
                "{} of {all} {messages} have no stamp; their time of recording is used. Set header.stamp in the driver",
                self.unset
            ));
        }
        if let Some(only_s) = self.only_s {
            remarks.push(format!(
                "all {all} {messages} have the same stamp, {only_s:.2} s; their times of recording are used. Stamp each message when it is measured"
            ));
        }
        if self.outliers > 0 {
            remarks.push(format!(
                "{} of {all} {messages} have a stamp far from their neighbours'; it was replaced using the time of recording and the neighbours",
                self.outliers
            ));
        }
        if self.equal > 0 {
            remarks.push(format!(
                "{} of {all} {messages} have the same stamp as the one before, as with stamps printed with too few digits; they were spread evenly, so speeds are unreliable. Write stamps with six decimals",
                self.equal
            ));
        }
        for step in self.steps.iter().take(3) {
            let direction = if step.by_s < 0.0 { "back" } else { "ahead" };
            remarks.push(format!(
                "the clock of the {messages} steps {direction} by {:.1} s at number {}; the step was removed and both parts are mapped",
                step.by_s.abs(),
                step.at
            ));
        }
        if self.swapped > 0 {
            remarks.push(format!(
                "{} of {all} {messages} come after a later one; they were sorted by stamp",
                self.swapped
            ));
        }
        let mended = |text| Remark::mended(Part::Clocks, text);
        remarks.into_iter().map(mended).collect()
    }
}
