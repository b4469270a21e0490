//! Noise, world and estimator of `lap`, `laps` and `sweep`: `--seed`, `--noise`, `--world`, `--matcher`,
//! `--loop-matcher`, `--detector`, `--gate`, `--information`, `--no-information-cap`.

use ch16_lab::lap::{
    BuiltInWorld, LapConfig, LapDetector, LapFrontEnd, LapMatcher, LoopMatcher, NamedChoice,
};
use ch16_slam2d::chapter::InformationFrame;
use ch16_slam2d::loops::GateModel;
use clap::Args;
use command_line::choice::choice;
use pr_sim::Course;
use serde::Serialize;

use crate::world::WorldArg;
use command_line::numbers;

/// Seed and strength of the noise of a drive.
#[derive(Args, Clone, Copy, Debug, Serialize)]
pub struct NoiseArgs {
    /// Seed of all noise, decimal or 0x….
    #[arg(long, default_value = "0xC0FFEE", value_parser = numbers::seed, allow_hyphen_values = true)]
    pub seed: u32,
    /// Factor on the six parameters of odometry noise.
    #[arg(long, default_value = "1", value_parser = numbers::noise_factor, allow_hyphen_values = true)]
    pub noise: f64,
}

/// Arguments shared by a lap and a sweep of laps.
#[derive(Args, Clone, Debug)]
pub struct TrialArgs {
    /// Matcher of the front end and of loops; default: p2p.
    #[arg(long, value_parser = choice(LapMatcher::NAMED))]
    matcher: Option<LapMatcher>,
    /// Reference that the front end registers scans on; a local map also has its own loop search.
    #[arg(long, value_parser = choice(LapFrontEnd::NAMED))]
    front_end: Option<LapFrontEnd>,
    /// Matcher of loops only; default: the front end's.
    #[arg(long, value_parser = choice(LoopMatcher::NAMED))]
    loop_matcher: Option<LoopMatcher>,
    /// Detector of loop candidates; default: distance in the graph.
    #[arg(long, value_parser = choice(LapDetector::NAMED))]
    detector: Option<LapDetector>,
    /// Drift model of the loop gate.
    #[arg(long, value_parser = choice(GateModel::NAMED))]
    gate: Option<GateModel>,
    /// World: apartment, ring, twins, corridor, hall, or a .json file.
    #[arg(long, default_value = "apartment")]
    world: WorldArg,
    /// Frame of the edges' information; default: the frame of the chapter's figures in the
    /// Apartment, the exact one elsewhere.
    #[arg(long, value_parser = choice(InformationFrame::NAMED))]
    information: Option<InformationFrame>,
    /// Leave the information of edges as the pairs give it; by default it is bounded at a standard deviation of 2 cm.
    #[arg(long)]
    no_information_cap: bool,
}

/// The requested laps, which differ in seed and noise.
#[derive(Clone, Debug)]
pub struct LapOptions {
    course: Option<Course>,
    matcher: LapMatcher,
    front_end: LapFrontEnd,
    loop_matcher: Option<LoopMatcher>,
    detector: LapDetector,
    gate: Option<GateModel>,
    information: Option<InformationFrame>,
    no_information_cap: bool,
}

impl TrialArgs {
    /// The first argument that affects only a pose graph and its front end.
    pub fn of_the_graph(&self) -> Option<&'static str> {
        let given = [
            (self.matcher.is_some(), "--matcher"),
            (self.front_end.is_some(), "--front-end"),
            (self.loop_matcher.is_some(), "--loop-matcher"),
            (self.detector.is_some(), "--detector"),
            (self.gate.is_some(), "--gate"),
            (self.information.is_some(), "--information"),
            (self.no_information_cap, "--no-information-cap"),
        ];
        given.into_iter().find(|(is, _)| *is).map(|(_, name)| name)
    }

    /// The laps, with the world read.
    ///
    /// # Errors
    /// If the world file cannot be used.
    pub fn trial(&self) -> anyhow::Result<LapOptions> {
        let is_the_chapters = self.world == WorldArg::BuiltIn(BuiltInWorld::Apartment);
        let course = (!is_the_chapters).then(|| self.world.course());
        Ok(LapOptions {
            course: course.transpose()?,
            matcher: self.matcher.unwrap_or_default(),
            front_end: self.front_end.unwrap_or_default(),
            loop_matcher: self.loop_matcher,
            detector: self.detector.unwrap_or_default(),
            gate: self.gate,
            information: self.information,
            no_information_cap: self.no_information_cap,
        })
    }
}

impl LapOptions {
    /// The lap at this seed and noise factor, by the chapter's estimator in the Apartment and the default one
    /// elsewhere.
    pub fn lap(&self, seed: u32, noise_factor: f64) -> LapConfig {
        let chapter = LapConfig::with_seed_and_noise(seed, noise_factor);
        let lap = match &self.course {
            Some(course) => chapter.elsewhere(course),
            None => chapter,
        };
        let lap = lap.with_matcher(self.matcher).with_detector(self.detector);
        let lap = match self.loop_matcher {
            Some(matcher) => lap.with_loop_matcher(matcher),
            None => lap,
        };
        let lap = match self.gate {
            Some(gate) => lap.with_gate(gate),
            None => lap,
        };
        let lap = match self.information {
            Some(frame) => lap.with_information(frame),
            None => lap,
        };
        let lap = if self.no_information_cap {
            lap.with_information_cap(f64::INFINITY)
        } else {
            lap
        };
        lap.with_front_end(self.front_end)
    }
}
