//! What `lap` and `sweep` drive, and with which estimator: `--world`, `--matcher`,
//! `--loop-matcher`, `--detector`, `--gate`, `--information`.

use ch16_lab::lap::{
    BuiltInWorld, Choice, LapConfig, LapDetector, LapFrontEnd, LapMatcher, LoopMatcher,
};
use ch16_slam2d::chapter::InformationFrame;
use ch16_slam2d::loops::GateModel;
use clap::Args;
use clap::builder::PossibleValue;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use pr_sim::Course;

use crate::world::{WorldArg, WorldError};

/// The arguments that a lap and a sweep of laps have in common.
#[derive(Args, Clone, Debug)]
pub struct TrialArgs {
    /// What registers scans, for the front end and for loops; p2p without it.
    #[arg(long, value_parser = choice::<LapMatcher>())]
    matcher: Option<LapMatcher>,
    /// What the front end registers scans on; that on a local map finds loops its own way as well.
    #[arg(long, value_parser = choice::<LapFrontEnd>())]
    front_end: Option<LapFrontEnd>,
    /// What registers scans for loops alone; that of the front end without it.
    #[arg(long, value_parser = choice::<LoopMatcher>())]
    loop_matcher: Option<LoopMatcher>,
    /// What proposes loops; what is near in the graph without it.
    #[arg(long, value_parser = choice::<LapDetector>())]
    detector: Option<LapDetector>,
    /// What the gate of loops takes for the drift since the place was seen.
    #[arg(long, value_parser = choice::<GateModel>())]
    gate: Option<GateModel>,
    /// What is driven: apartment, ring, twins, corridor, hall, or a file that ends in .json.
    #[arg(long, default_value = "apartment")]
    world: WorldArg,
    /// In which frame the information of edges is expressed: that of the chapter's figures in the
    /// Apartment, the exact one elsewhere, unless it is said.
    #[arg(long, value_parser = choice::<InformationFrame>())]
    information: Option<InformationFrame>,
}

/// The laps that are asked for; they differ in seed and noise.
#[derive(Clone, Debug)]
pub struct Trial {
    course: Option<Course>,
    matcher: LapMatcher,
    front_end: LapFrontEnd,
    loop_matcher: Option<LoopMatcher>,
    detector: LapDetector,
    gate: Option<GateModel>,
    information: Option<InformationFrame>,
}

impl TrialArgs {
    /// The first argument that says something only to a pose graph and its front end.
    pub fn of_the_graph(&self) -> Option<&'static str> {
        let said = [
            (self.matcher.is_some(), "--matcher"),
            (self.front_end.is_some(), "--front-end"),
            (self.loop_matcher.is_some(), "--loop-matcher"),
            (self.detector.is_some(), "--detector"),
            (self.gate.is_some(), "--gate"),
            (self.information.is_some(), "--information"),
        ];
        said.into_iter().find(|(is, _)| *is).map(|(_, name)| name)
    }

    /// What is driven, read.
    ///
    /// # Errors
    /// Where the file of the world cannot be used.
    pub fn course(&self) -> Result<Course, WorldError> {
        self.world.course()
    }

    /// The laps, with the world read.
    ///
    /// # Errors
    /// Where the file of the world cannot be used.
    pub fn trial(&self) -> Result<Trial, WorldError> {
        let is_the_chapters = self.world == WorldArg::BuiltIn(BuiltInWorld::Apartment);
        let course = (!is_the_chapters).then(|| self.world.course());
        Ok(Trial {
            course: course.transpose()?,
            matcher: self.matcher.unwrap_or_default(),
            front_end: self.front_end.unwrap_or_default(),
            loop_matcher: self.loop_matcher,
            detector: self.detector.unwrap_or_default(),
            gate: self.gate,
            information: self.information,
        })
    }
}

impl Trial {
    /// The lap at this seed and noise factor: in the Apartment the chapter's estimator, elsewhere the
    /// default.
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
        lap.with_front_end(self.front_end)
    }
}

/// Takes the short names of a list, and shows its labels in the help.
pub fn choice<C: Choice + Send + Sync>() -> impl TypedValueParser<Value = C> {
    let values = C::ALL
        .iter()
        .map(|choice| PossibleValue::new(choice.name()).help(choice.label()));
    PossibleValuesParser::new(values)
        .map(|name| C::named(&name).expect("the parser lets only names of the list pass"))
}
