//! Errors halfway of many laps beside the graph's covariance, with the cap on information and without.

use ch16_lab::lap::{
    BuiltInWorld, HalfWay, LapConfig, LapConsistency, LapMatcher, LapRunner, NamedChoice as _,
    StepInnovations,
};
use ch16_slam2d::chapter::InformationFrame;

use super::recorded::Driven;
use crate::worlds::TRIALS;

/// Laps of each case, from seed 1 on: the standard deviation of a scatter is 5 % of it.
pub const SEEDS: u32 = 100;

/// A mean beyond so many standard errors is seldom chance.
const ALARM: f64 = 2.0;

/// Halfway by the front end and with loops, and the steps of the front end, of one lap.
type Lap = ([Option<HalfWay>; 2], Option<StepInnovations>);

/// Adds the figures of every `step`th lap of all cases: `consistency.ring.ndt.uncapped.with_loops.scatter_m`.
pub fn add_to(driven: &mut Driven, step: usize) {
    for (world, matcher) in TRIALS {
        for bound in ["capped", "uncapped"] {
            let name = format!("consistency.{}.{}.{bound}", world.name(), matcher.name());
            let laps = laps(world, matcher, bound == "capped", step);
            driven.add(&name, figures(&laps));
            driven.add_digest(&name, &laps);
        }
    }
}

fn figures(laps: &[Lap]) -> Vec<(String, Option<f64>)> {
    let steps: Vec<StepInnovations> = laps.iter().filter_map(|lap| lap.1).collect();
    let mean =
        |of: fn(&StepInnovations) -> f64| steps.iter().map(of).sum::<f64>() / steps.len() as f64;
    let alarm = mean(|lap| f64::from(u8::from(lap.t().abs() > ALARM)));
    let mut figures = vec![
        ("front_end.alarm_percent".to_owned(), Some(100.0 * alarm)),
        (
            "front_end.step_ratio".to_owned(),
            Some(mean(|lap| lap.ratio)),
        ),
    ];
    for (k, estimate) in ["front_end", "with_loops"].into_iter().enumerate() {
        let halves: Vec<HalfWay> = laps.iter().filter_map(|lap| lap.0[k]).collect();
        let of = LapConsistency::of(&halves);
        let values = [
            ("bias_m", of.map(|of| of.bias_m)),
            ("scatter_m", of.map(|of| of.scatter_m)),
            ("sigma_m", of.map(|of| of.sigma_m)),
            ("nees", of.map(|of| of.nees)),
        ];
        figures.extend(values.map(|(what, value)| (format!("{estimate}.{what}"), value)));
    }
    figures
}

fn laps(world: BuiltInWorld, matcher: LapMatcher, capped: bool, step: usize) -> Vec<Lap> {
    let mut runner = LapRunner::new();
    let lap = |seed| {
        let config = LapConfig::in_world(world, seed, 1.0)
            .with_matcher(matcher)
            .with_information(InformationFrame::Exact);
        let record = runner.run(&if capped {
            config
        } else {
            config.with_information_cap(f64::INFINITY)
        });
        (
            [record.front_end_half_way(), record.half_way()],
            record.front_end.innovations(record.ticks()),
        )
    };
    (1..=SEEDS).step_by(step).map(lap).collect()
}
