//! Results of many laps in few numbers, for pictures of thousands of them.

use ch16_lab::lap::{LapRunner, LapTrace, PathErrors};
use ch16_lab::results::LapOutcome;
use widgets::w16_2_full_lap::model::lap_of_link;

/// Numbers of a lap: of the front end and of the graph the position error of the last keyframe, the root mean square over
/// the keyframes, the error halfway along the path and the graph's standard deviation there, m; then closed loops and
/// false ones.
pub const NUMBERS: usize = 10;

/// Runs laps; consecutive ones of one seed share their simulated drive if it is the same.
#[derive(Debug, Default)]
pub struct Outcomes {
    runner: LapRunner,
}

impl Outcomes {
    /// The numbers of one lap, with the settings of a link to w16.2: `noise=4&matcher=p2l`.
    ///
    /// # Errors
    /// If the link is invalid.
    pub fn of(&mut self, seed: u32, link: &str) -> Result<[f64; NUMBERS], String> {
        let config = lap_of_link(link).map_err(|problem| problem.to_string())?;
        let mut config = config.ok_or("the reader's own flat has no thousand laps")?;
        config.drive.seed = seed;
        let record = self.runner.run(&config);
        let outcome = LapOutcome::from_record(&record);
        let of = |trace: &LapTrace, path: &PathErrors| {
            [
                trace.summary.keyframe_end_error_m,
                trace.summary.keyframe_rms_m,
                path.half_path_length_m(),
                path.half_way_sigma_m.unwrap_or(f64::NAN),
            ]
        };
        let [a, b, c, d] = of(&record.front_end, &record.front_end_path_errors());
        let [e, f, g, h] = of(&record.lap, &record.path_errors());
        let loops = [outcome.loops, outcome.attempts.of_false[0]].map(|count| count as f64);
        Ok([a, b, c, d, e, f, g, h, loops[0], loops[1]])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ch16_lab::lap::CANONICAL_SEED;

    fn of(link: &str) -> [f64; NUMBERS] {
        Outcomes::default().of(CANONICAL_SEED, link).unwrap()
    }

    #[test]
    fn the_canonical_lap_has_the_figures_of_the_results_table() {
        let numbers = of("noise=1");
        // `cargo run --bin ch16 -- lap`: its table, to its four digits.
        for (place, known) in [
            (0, 0.7334),
            (1, 0.6444),
            (4, 0.2389),
            (5, 0.5857),
            (8, 3.0),
            (9, 0.0),
        ] {
            assert!((numbers[place] - known).abs() < 5e-5, "{numbers:?}");
        }
    }

    #[test]
    fn without_the_cap_only_the_deviation_of_the_front_end_changes() {
        let (capped, free) = (
            of("matcher=ndt&normals=4.2"),
            of("matcher=ndt&normals=4.2&cap=off"),
        );
        assert_eq!(capped[..3], free[..3]);
        assert!(free[3] < 0.5 * capped[3], "{capped:?} {free:?}");
    }

    #[test]
    fn an_invalid_link_is_an_error_with_the_valid_names() {
        let problem = Outcomes::default().of(1, "colour=red").unwrap_err();
        assert!(problem.contains("matcher"), "{problem}");
        assert!(Outcomes::default().of(1, "noise=9").is_err());
    }
}
