//! CPU time per scan: of a whole log, and at its start and its end.

use serde::Serialize;

/// CPU times of a run's ticks.
#[derive(Clone, Debug, Default)]
pub struct TickCosts {
    ms: Vec<f64>,
}

/// Ticks of a run, and of its first and last tenth.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct TickSummary {
    /// Median of all, ms.
    pub median_ms: f64,
    /// 99 % of the ticks take at most this, ms.
    pub p99_ms: f64,
    /// The worst of all, ms.
    pub worst_ms: f64,
    /// The first tenth.
    pub first: Tenth,
    /// The last tenth.
    pub last: Tenth,
}

/// CPU times of a tenth of a run, ms.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Tenth {
    /// Median.
    pub median_ms: f64,
    /// Mean, including ticks that close loops.
    pub mean_ms: f64,
    /// Maximum.
    pub worst_ms: f64,
}

impl TickCosts {
    /// Adds the CPU time of a tick, ms.
    pub fn push(&mut self, ms: f64) {
        self.ms.push(ms);
    }

    /// Summarizes both tenths; `None` with fewer than ten ticks.
    pub fn summary(&self) -> Option<TickSummary> {
        let tenth = self.ms.len() / 10;
        let mut sorted = self.ms.clone();
        sorted.sort_by(f64::total_cmp);
        let at =
            |share: f64| sorted[((share * sorted.len() as f64) as usize).min(sorted.len() - 1)];
        (tenth > 0).then(|| TickSummary {
            median_ms: at(0.5),
            p99_ms: at(0.99),
            worst_ms: at(1.0),
            first: Tenth::from_ticks(&self.ms[..tenth]),
            last: Tenth::from_ticks(&self.ms[self.ms.len() - tenth..]),
        })
    }
}

impl Tenth {
    fn from_ticks(ticks_ms: &[f64]) -> Self {
        let mut sorted = ticks_ms.to_vec();
        sorted.sort_by(f64::total_cmp);
        Self {
            median_ms: sorted[sorted.len() / 2],
            mean_ms: sorted.iter().sum::<f64>() / sorted.len() as f64,
            worst_ms: sorted[sorted.len() - 1],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_and_the_last_tenth_and_the_worst_tick_are_distinguished() {
        let mut costs = TickCosts::default();
        (0..9).for_each(|k| costs.push(f64::from(k)));
        assert!(costs.summary().is_none());
        (9..35).for_each(|k| costs.push(f64::from(k)));
        let TickSummary {
            first,
            last,
            median_ms,
            p99_ms,
            worst_ms,
        } = costs.summary().unwrap();
        assert_eq!([median_ms, p99_ms, worst_ms], [17.0, 34.0, 34.0]);
        let figures = |tenth: Tenth| [tenth.median_ms, tenth.mean_ms, tenth.worst_ms];
        assert_eq!(figures(first), [1.0, 1.0, 2.0]);
        assert_eq!(figures(last), [33.0, 33.0, 34.0]);
    }
}
