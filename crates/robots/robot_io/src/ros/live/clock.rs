//! Stamps that go on after a clock was set back, as when a simulation or a robot restarts.

use crate::stamps::MIN_STEP_S;

/// Time that passes if that of the recording is set back, too, as when a simulation starts again, s: long enough for its
/// robot to be looked for on the map, because it may stand elsewhere.
const PAUSE_S: f64 = 20.0;

/// What the stamps of all streams were shifted by after each step back of their clock, s.
#[derive(Debug)]
pub struct LiveClock {
    shifts_s: Vec<f64>,
}

/// The stamps of one stream.
#[derive(Debug, Default)]
pub struct StreamStamps {
    /// Number of steps back so far.
    steps: usize,
    /// Last stamp and time of recording, s.
    last: Option<(f64, f64)>,
}

impl Default for LiveClock {
    fn default() -> Self {
        Self {
            shifts_s: vec![0.0],
        }
    }
}

impl LiveClock {
    /// The stamp of the next message of a stream, s; `recorded_s` replaces one that is unset.
    ///
    /// The first stream that steps back goes on by the time of recording, and the others are shifted by as much.
    pub fn stamp_s(&mut self, of: &mut StreamStamps, stated_s: f64, recorded_s: f64) -> f64 {
        let is_set = stated_s > 0.0 && stated_s.is_finite();
        let stated_s = if is_set { stated_s } else { recorded_s };
        if let Some((last_s, last_recorded_s)) = of.last
            && stated_s < last_s - MIN_STEP_S
        {
            let before_s = self.shifts_s[of.steps];
            of.steps += 1;
            if of.steps == self.shifts_s.len() {
                let passed_s = recorded_s - last_recorded_s;
                let passed_s = if passed_s > 0.0 { passed_s } else { PAUSE_S };
                self.shifts_s.push(before_s + last_s + passed_s - stated_s);
            }
        }
        of.last = Some((stated_s, recorded_s));
        stated_s + self.shifts_s[of.steps]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_streams_go_on_together_after_their_clock_was_set_back() {
        let mut clock = LiveClock::default();
        let (mut scans, mut poses) = (StreamStamps::default(), StreamStamps::default());
        assert_eq!(clock.stamp_s(&mut scans, 100.0, 7.0), 100.0);
        assert_eq!(clock.stamp_s(&mut poses, 100.1, 7.1), 100.1);
        // Both restart at zero three seconds later; the poses come first.
        assert!((clock.stamp_s(&mut poses, 1.0, 10.1) - 103.1).abs() < 1e-9);
        assert!((clock.stamp_s(&mut scans, 1.2, 10.3) - 103.3).abs() < 1e-9);
        assert!((clock.stamp_s(&mut scans, 1.3, 10.4) - 103.4).abs() < 1e-9);
    }

    #[test]
    fn a_simulation_that_starts_again_goes_on_after_a_pause() {
        let mut clock = LiveClock::default();
        let (mut scans, mut poses) = (StreamStamps::default(), StreamStamps::default());
        assert_eq!(clock.stamp_s(&mut scans, 100.0, 100.0), 100.0);
        assert_eq!(clock.stamp_s(&mut poses, 100.1, 100.1), 100.1);
        assert_eq!(clock.stamp_s(&mut scans, 1.0, 1.0), 100.0 + PAUSE_S);
        assert!((clock.stamp_s(&mut poses, 1.1, 1.1) - (100.1 + PAUSE_S)).abs() < 1e-9);
    }

    #[test]
    fn a_swapped_message_is_no_step_and_an_unset_stamp_is_that_of_the_recording() {
        let mut clock = LiveClock::default();
        let mut scans = StreamStamps::default();
        for (stated_s, expected_s) in [(5.0, 5.0), (4.5, 4.5), (0.0, 9.0), (f64::NAN, 9.0)] {
            assert_eq!(clock.stamp_s(&mut scans, stated_s, 9.0), expected_s);
        }
    }
}
