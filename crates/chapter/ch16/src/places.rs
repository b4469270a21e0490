//! `ch16 places`: precision–recall curves of place recognition.

use anyhow::ensure;
use ch16_lab::lap::{BuiltInWorld, LapConfig, LapMatcher, NamedChoice};
use ch16_lab::places::{PlaceCurve, PlacePair, place_curves, place_pairs};
use clap::Args;
use rayon::prelude::*;
use serde::Serialize;

use command_line::numbers::{self, Seeds};
use command_line::output::{print_json, say};

/// Most seeds: every lap has a thousand pairs.
const MAX_SEEDS: u64 = 10_000;

/// Compare place recognition detectors over many laps in both built-in worlds.
///
/// Pairs of keyframes at least 22 apart are evaluated; they are the same place if their true poses are within
/// 1 m. The laps use NDT without loop closure.
#[derive(Args, Clone, Debug)]
pub struct PlacesArgs {
    /// Seeds: A..=B, A..B or one.
    #[arg(long, default_value = "1..=20", value_parser = numbers::seeds, allow_hyphen_values = true)]
    seeds: Seeds,
    /// Print one JSON list with all curves for each world.
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct WorldJson {
    world: &'static str,
    pairs: usize,
    same: usize,
    detectors: Vec<PlaceCurve>,
}

impl WorldJson {
    fn new(world: BuiltInWorld, pairs: &[PlacePair]) -> Self {
        Self {
            world: world.name(),
            pairs: pairs.len(),
            same: pairs.iter().filter(|pair| pair.is_same).count(),
            detectors: place_curves(pairs),
        }
    }
}

/// Runs the laps and prints the result of each detector.
///
/// # Errors
/// If there are too many seeds.
pub fn run(args: &PlacesArgs) -> anyhow::Result<()> {
    let seeds = args.seeds.count();
    ensure!(
        seeds <= MAX_SEEDS,
        "{seeds} seeds are too many; use at most {MAX_SEEDS}"
    );
    let worlds: Vec<WorldJson> = BuiltInWorld::GRADED
        .iter()
        .map(|&world| {
            let lap = |seed| {
                let lap = LapConfig::in_world(world, seed, 1.0);
                place_pairs(&lap.with_matcher(LapMatcher::Ndt))
            };
            let laps: Vec<Vec<PlacePair>> = (args.seeds.first..=args.seeds.last)
                .into_par_iter()
                .map(lap)
                .collect();
            WorldJson::new(world, &laps.concat())
        })
        .collect();
    if args.json {
        print_json(&worlds);
    } else {
        worlds.iter().for_each(print_world);
    }
    Ok(())
}

fn print_world(world: &WorldJson) {
    say!(
        "{}: {} pairs, {} of them the same place",
        world.world,
        world.pairs,
        world.same
    );
    say!(
        "  {:<12} {:>18} {:>24} {:>20}",
        "detector",
        "average precision",
        "recall without errors",
        "precision at half"
    );
    for detector in &world.detectors {
        say!(
            "  {:<12} {:>18.3} {:>24.3} {:>20.3}",
            detector.detector.name(),
            detector.average_precision,
            detector.recall_without_errors,
            detector.precision_at_fixed_recall().unwrap_or(0.0)
        );
    }
}
