//! Results of many laps in few numbers, for a picture of thousands of them.

use ch16_lab::lap::{LapConfig, LapRunner};
use ch16_lab::results::{Column, LapOutcome, Row};

/// Numbers of a lap: final errors of odometry, front end and graph in metres, closed loops, false ones.
pub const NUMBERS: usize = 5;

/// Runs laps; consecutive noise levels of one seed share their simulated drive.
#[derive(Debug, Default)]
pub struct Outcomes {
    runner: LapRunner,
}

impl Outcomes {
    /// The numbers of one lap.
    pub fn of(&mut self, seed: u32, noise_factor: f64) -> [f64; NUMBERS] {
        let config = LapConfig::with_seed_and_noise(seed, noise_factor);
        let outcome = LapOutcome::from_record(&self.runner.run(&config));
        let end_error = |column| outcome.entry(column, Row::EndError).unwrap_or(f64::NAN);
        let columns = [Column::Odometry, Column::FrontEnd, Column::WithLoops];
        let [wheels, front_end, with_loops] = columns.map(end_error);
        [
            wheels,
            front_end,
            with_loops,
            outcome.lap.loops as f64,
            outcome.false_acceptances as f64,
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ch16_lab::lap::CANONICAL_SEED;

    #[test]
    fn the_canonical_lap_has_the_figures_of_the_results_table() {
        let numbers = Outcomes::default().of(CANONICAL_SEED, 1.0);
        // `cargo run --bin slam2d -- lap`: its table, to its four digits.
        for (number, known) in numbers.into_iter().zip([2.4110, 0.7334, 0.2389, 3.0, 0.0]) {
            assert!((number - known).abs() < 5e-5, "{numbers:?}");
        }
    }
}
