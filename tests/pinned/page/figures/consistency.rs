//! Errors halfway of many laps beside the graph's covariance, with the cap on information and without.

use ch16_lab::lap::{
    BuiltInWorld, HalfWay, LapConfig, LapConsistency, LapMatcher, LapRunner, NamedChoice as _,
    StepInnovations,
};
use ch16_slam2d::chapter::InformationFrame;

use super::shared::Shared;

/// Laps of each case, from seed 1 on: the standard deviation of a scatter is 5 % of it.
const SEEDS: u32 = 100;

/// The front end and the lap with loops, of laps that differ in their seed only, and the steps of each front end.
type Case = ([LapConsistency; 2], Vec<StepInnovations>);

/// A mean beyond so many standard errors is seldom chance.
const ALARM: f64 = 2.0;

/// `ring.ndt.uncapped.with_loops.scatter_m`: by world, matcher, bound of the information, estimate.
pub fn value(path: &[&str]) -> Option<f64> {
    static CASES: Shared<Case> = Shared::new();
    let [world, matcher, bound, estimate, what] = *path else {
        return (path == ["seeds"]).then(|| f64::from(SEEDS));
    };
    let name = format!("{world}.{matcher}.{bound}");
    let ([front_end, with_loops], steps) = CASES.get(&name, || case(world, matcher, bound))?;
    let mean =
        |of: fn(&StepInnovations) -> f64| steps.iter().map(of).sum::<f64>() / steps.len() as f64;
    match what {
        "alarm_percent" => {
            return Some(100.0 * mean(|lap| f64::from(u8::from(lap.t().abs() > ALARM))));
        }
        "step_ratio" => return Some(mean(|lap| lap.ratio)),
        _ => {}
    }
    let of = match estimate {
        "front_end" => front_end,
        "with_loops" => with_loops,
        _ => return None,
    };
    Some(match what {
        "bias_m" => of.bias_m,
        "scatter_m" => of.scatter_m,
        "sigma_m" => of.sigma_m,
        "nees" => of.nees,
        _ => return None,
    })
}

fn case(world: &str, matcher: &str, bound: &str) -> Option<Case> {
    let (world, matcher) = (BuiltInWorld::named(world)?, LapMatcher::named(matcher)?);
    let mut runner = LapRunner::new();
    let mut halves: [Vec<HalfWay>; 2] = Default::default();
    let mut steps = Vec::new();
    for seed in 1..=SEEDS {
        let config = LapConfig::in_world(world, seed, 1.0)
            .with_matcher(matcher)
            .with_information(InformationFrame::Exact);
        let record = runner.run(&match bound {
            "capped" => config,
            "uncapped" => config.with_information_cap(f64::INFINITY),
            _ => return None,
        });
        halves[0].extend(record.front_end_half_way());
        halves[1].extend(record.half_way());
        steps.extend(record.front_end.innovations(record.ticks()));
    }
    let [front_end, with_loops] = halves.each_ref().map(|laps| LapConsistency::of(laps));
    Some(([front_end?, with_loops?], steps))
}
