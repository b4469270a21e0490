//! What was done to the stamps of a stream, in sentences.

use super::MendedStamps;
use crate::remark::{Part, Remark};

impl MendedStamps {
    /// What was done, a sentence each; `messages` names them, as “scans”.
    #[must_use]
    pub fn remarks(&self, messages: &str) -> Vec<Remark> {
        let all = self.stamps_s.len();
        let mut said = Vec::new();
        if self.unset > 0 {
            said.push(format!(
                "{} of {all} {messages} have no stamp; the times at which they were recorded are taken. Set header.stamp in the driver",
                self.unset
            ));
        }
        if self.outliers > 0 {
            said.push(format!(
                "{} of {all} {messages} have a stamp far from those around them; theirs are taken from the recording's time and the neighbours",
                self.outliers
            ));
        }
        if self.equal > 0 {
            said.push(format!(
                "{} of {all} {messages} have the same stamp as the one before, as of stamps printed with too few digits; they are spread evenly, so speeds mean nothing. Write stamps with six decimals",
                self.equal
            ));
        }
        for step in self.steps.iter().take(3) {
            let direction = if step.by_s < 0.0 { "back" } else { "ahead" };
            said.push(format!(
                "the clock of the {messages} steps {direction} by {:.1} s at number {}; the step is taken out and both parts are mapped",
                step.by_s.abs(),
                step.at
            ));
        }
        if self.swapped > 0 {
            said.push(format!(
                "{} of {all} {messages} stand after a later one; they are sorted by stamp",
                self.swapped
            ));
        }
        let mended = |text| Remark::mended(Part::Clocks, text);
        said.into_iter().map(mended).collect()
    }
}
