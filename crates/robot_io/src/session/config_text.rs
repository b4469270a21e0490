//! The estimator's parameters as text: a line for each, `name value`.
//!
//! One list of the fields writes and reads. It takes every struct apart by name, so a parameter that
//! is added to the estimator does not compile before it is added here.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::str::FromStr;

use ch16_slam2d::field::ClimbConfig;
use ch16_slam2d::graph::JacobianModel;
use ch16_slam2d::icp::{IcpConfig, IcpVariant};
use ch16_slam2d::loops::{Detection, DetectorKind, GateModel, LoopConfig, LoopGuard, WideSearch};
use ch16_slam2d::matching::{
    InformationFrame, MapConfig, MatcherKind, NdtMatcherConfig, SearchMatcherConfig,
    StagedMatcherConfig, TrustConfig,
};
use ch16_slam2d::ndt::NdtConfig;
use ch16_slam2d::places::{ContextConfig, HistogramConfig, PlaceDescriptor, PlaceDetectorConfig};
use ch16_slam2d::scan::ScanConfig;
use ch16_slam2d::search::{LikelihoodConfig, SearchNeighborhood};
use ch16_slam2d::slam::{
    ContradictionConfig, LoopClosure, MotionNoise, PredictionUse, RefinementConfig, SlamConfig,
    ThresholdConfig,
};
use ch16_slam2d::submaps::{FrontEndKind, GridConfig, SubmapConfig};
use pr_geom::SE2;

use crate::lines::printable;

/// Larger counts are no settings.
const MOST: usize = 1_000_000;
/// Lengths within this are settings, m.
const LENGTHS: core::ops::RangeInclusive<f64> = 1e-4..=1e6;
/// How a count is written that is no limit.
const ALL: &str = "all";

/// The parameters, a line each.
#[must_use]
pub fn config_text(config: &SlamConfig) -> String {
    let mut lines = Lines::default();
    slam(&mut config.clone(), &mut lines);
    lines.text
}

/// The parameters that these lines give.
pub fn read_config(text: &str) -> Result<SlamConfig, String> {
    let mut known = Known::default();
    for line in text.lines() {
        let Some((name, value)) = line.split_once(' ') else {
            return Err("a parameter as ‘name value’ was expected".to_owned());
        };
        known.values.insert(name, value);
    }
    let mut config = SlamConfig::default();
    slam(&mut config, &mut known);
    if let Some((name, _)) = known.values.first_key_value() {
        known.problem.get_or_insert(format!(
            "the estimator has no parameter ‘{}’",
            printable(name)
        ));
    }
    known.problem.map_or(Ok(config), Err)
}

/// What is done with each field: it is written, or read.
trait Fields {
    /// A number within a range.
    fn within(&mut self, name: &str, value: &mut f64, range: core::ops::RangeInclusive<f64>);
    /// A count up to a limit.
    fn up_to(&mut self, name: &str, value: &mut usize, most: usize);
    /// One of several names: the number of the one that is, or that is to be.
    fn one_of(&mut self, name: &str, names: &[&str], chosen: usize) -> usize;

    /// Whether there is a field of that name: a session of an older program may lack one.
    fn knows(&self, name: &str) -> bool;

    /// Any number.
    fn number(&mut self, name: &str, value: &mut f64) {
        self.within(name, value, f64::NEG_INFINITY..=f64::INFINITY);
    }
    /// A length above 0, m.
    fn length(&mut self, name: &str, value: &mut f64) {
        self.within(name, value, LENGTHS);
    }
    /// A count.
    fn count(&mut self, name: &str, value: &mut usize) {
        self.up_to(name, value, MOST);
    }
}

#[derive(Default)]
struct Lines {
    text: String,
}

impl Fields for Lines {
    fn within(&mut self, name: &str, value: &mut f64, _: core::ops::RangeInclusive<f64>) {
        let _ = writeln!(self.text, "{name} {value}");
    }

    fn up_to(&mut self, name: &str, value: &mut usize, _: usize) {
        let _ = match *value {
            usize::MAX => writeln!(self.text, "{name} {ALL}"),
            value => writeln!(self.text, "{name} {value}"),
        };
    }

    fn one_of(&mut self, name: &str, names: &[&str], chosen: usize) -> usize {
        let _ = writeln!(self.text, "{name} {}", names[chosen]);
        chosen
    }

    fn knows(&self, _: &str) -> bool {
        true
    }
}

#[derive(Default)]
struct Known<'a> {
    values: BTreeMap<&'a str, &'a str>,
    problem: Option<String>,
}

impl Known<'_> {
    fn parsed<T: FromStr>(&mut self, name: &str, is_good: impl Fn(&T) -> bool) -> Option<T> {
        let Some(text) = self.values.remove(name) else {
            self.refuse(format!("the parameter {name} is missing"));
            return None;
        };
        let value = text.parse().ok().filter(is_good);
        if value.is_none() {
            self.refuse(format!("the parameter {name} is not within its range"));
        }
        value
    }

    fn refuse(&mut self, problem: String) {
        self.problem.get_or_insert(problem);
    }
}

impl Fields for Known<'_> {
    fn within(&mut self, name: &str, value: &mut f64, range: core::ops::RangeInclusive<f64>) {
        if let Some(read) = self.parsed(name, |value| range.contains(value)) {
            *value = read;
        }
    }

    fn up_to(&mut self, name: &str, value: &mut usize, most: usize) {
        if self.values.get(name) == Some(&ALL) {
            self.values.remove(name);
            *value = usize::MAX;
        } else if let Some(read) = self.parsed(name, |value| *value <= most) {
            *value = read;
        }
    }

    fn one_of(&mut self, name: &str, names: &[&str], chosen: usize) -> usize {
        let read = self.parsed(name, |text: &String| names.contains(&text.as_str()));
        let read = read.and_then(|text| names.iter().position(|name| *name == text));
        read.unwrap_or(chosen)
    }

    fn knows(&self, name: &str) -> bool {
        self.values.contains_key(name)
    }
}

/// A field that is one of several values without further fields.
fn choose<T: Copy + PartialEq>(
    fields: &mut impl Fields,
    name: &str,
    value: &mut T,
    choices: &[(&str, T)],
) {
    let names: Vec<&str> = choices.iter().map(|choice| choice.0).collect();
    let chosen = choices.iter().position(|choice| choice.1 == *value);
    *value = choices[fields.one_of(name, &names, chosen.unwrap_or(0))].1;
}

fn slam(config: &mut SlamConfig, f: &mut impl Fields) {
    let SlamConfig {
        start,
        scan,
        loop_closure,
        front_end,
        matcher,
        window_sweeps,
        window_distance_m,
        window_turn_rad,
        local_map,
        max_iterations,
        min_inliers,
        extrapolation,
        prediction_use,
        contradiction,
        aperture,
        threshold,
        keyframe_distance_m,
        keyframe_turn_rad,
        information_frame,
        confidence,
        odometry_trust,
        odometry_noise,
        prediction_noise,
        loops,
        refinement,
        jacobians,
        least_correction,
        optimizer_iterations,
        optimizer_tolerance,
        huber,
    } = config;
    let mut at = start.to_array();
    f.within("start.x_m", &mut at[0], -1e9..=1e9);
    f.within("start.y_m", &mut at[1], -1e9..=1e9);
    f.within("start.heading_rad", &mut at[2], -4.0..=4.0);
    *start = SE2::new(at[0], at[1], at[2]);
    let ScanConfig {
        cell_m,
        normal_radius_m,
    } = scan;
    f.length("scan.cell_m", cell_m);
    f.length("scan.normal_radius_m", normal_radius_m);
    let on_off = [("on", LoopClosure::On), ("off", LoopClosure::Off)];
    choose(f, "loop_closure", loop_closure, &on_off);
    front_end_kind(front_end, f);
    matcher_kind("matcher", matcher, f);
    f.count("window_sweeps", window_sweeps);
    f.number("window_distance_m", window_distance_m);
    f.number("window_turn_rad", window_turn_rad);
    map("local_map", local_map, f);
    f.count("max_iterations", max_iterations);
    f.count("min_inliers", min_inliers);
    f.number("extrapolation", extrapolation);
    let uses = [
        ("start", PredictionUse::Start),
        ("measurement", PredictionUse::Measurement),
    ];
    choose(f, "prediction_use", prediction_use, &uses);
    let ContradictionConfig {
        chi2,
        min_score,
        lead,
        jump_m,
        jump_rad,
        jump_cost,
        max_cost,
    } = contradiction;
    f.within("contradiction.chi2", chi2, 0.0..=f64::INFINITY);
    f.number("contradiction.min_score", min_score);
    f.number("contradiction.lead", lead);
    f.within("contradiction.jump_m", jump_m, 0.0..=f64::INFINITY);
    f.within("contradiction.jump_rad", jump_rad, 0.0..=f64::INFINITY);
    f.number("contradiction.jump_cost", jump_cost);
    f.number("contradiction.max_cost", max_cost);
    f.number("aperture", aperture);
    let ThresholdConfig {
        initial_m,
        min_motion_m,
        max_range_m,
    } = threshold;
    f.number("threshold.initial_m", initial_m);
    f.number("threshold.min_motion_m", min_motion_m);
    f.number("threshold.max_range_m", max_range_m);
    f.number("keyframe_distance_m", keyframe_distance_m);
    f.number("keyframe_turn_rad", keyframe_turn_rad);
    let frames = [
        ("chapter", InformationFrame::Chapter),
        ("exact", InformationFrame::Exact),
    ];
    choose(f, "information_frame", information_frame, &frames);
    f.within("confidence", confidence, 1e-9..=1e9);
    trust("odometry_trust", odometry_trust, f);
    noise("odometry_noise", odometry_noise, f);
    noise("prediction_noise", prediction_noise, f);
    loop_config(loops, f);
    refinement_config(refinement, f);
    let models = [
        ("chapter", JacobianModel::Chapter),
        ("exact", JacobianModel::Exact),
    ];
    if f.knows("jacobians") {
        choose(f, "jacobians", jacobians, &models);
    }
    if f.knows("least_correction") {
        f.number("least_correction", least_correction);
    }
    f.count("optimizer_iterations", optimizer_iterations);
    f.number("optimizer_tolerance", optimizer_tolerance);
    f.number("huber", huber);
}

fn front_end_kind(kind: &mut FrontEndKind, f: &mut impl Fields) {
    let number = usize::from(*kind != FrontEndKind::Window);
    if f.one_of("front_end", &["window", "submaps"], number) == 0 {
        *kind = FrontEndKind::Window;
        return;
    }
    if *kind == FrontEndKind::Window {
        *kind = FrontEndKind::Submaps(SubmapConfig::of(&SlamConfig::default()));
    }
    let FrontEndKind::Submaps(config) = kind else {
        return;
    };
    let SubmapConfig {
        grid,
        scans,
        climb,
        occupied,
        good_score,
        search_m,
        search_rad,
        max_turn_rad,
        min_score,
        ready,
    } = config;
    let GridConfig {
        cell_m,
        wall_m,
        hit,
        miss,
        least,
    } = grid;
    let ClimbConfig {
        weight,
        max_steps,
        tolerance,
    } = climb;
    f.length("submaps.cell_m", cell_m);
    f.within("submaps.wall_m", wall_m, 0.0..=1e6);
    for (name, probability) in [("hit", hit), ("miss", miss), ("least", least)] {
        f.within(&format!("submaps.{name}"), probability, 0.0..=1.0);
    }
    f.count("submaps.scans", scans);
    f.number("submaps.climb.weight", weight);
    f.count("submaps.climb.max_steps", max_steps);
    f.number("submaps.climb.tolerance", tolerance);
    f.number("submaps.occupied", occupied);
    f.number("submaps.good_score", good_score);
    f.number("submaps.search_m", search_m);
    f.number("submaps.search_rad", search_rad);
    f.number("submaps.max_turn_rad", max_turn_rad);
    f.number("submaps.min_score", min_score);
    f.count("submaps.ready", ready);
}

fn map(of: &str, config: &mut MapConfig, f: &mut impl Fields) {
    let MapConfig {
        cell_m,
        max_per_cell,
    } = config;
    f.length(&format!("{of}.cell_m"), cell_m);
    f.count(&format!("{of}.max_per_cell"), max_per_cell);
}

fn trust(of: &str, config: &mut TrustConfig, f: &mut impl Fields) {
    let TrustConfig { sigma_m, inflate } = config;
    f.length(&format!("{of}.sigma_m"), sigma_m);
    f.within(&format!("{of}.inflate"), inflate, 1e-6..=1e9);
}

fn noise(of: &str, config: &mut MotionNoise, f: &mut impl Fields) {
    let MotionNoise {
        floor_m,
        per_metre,
        metre_per_rad,
        floor_rad,
        per_rad,
        rad_per_metre,
    } = config;
    for (name, value) in [
        ("floor_m", floor_m),
        ("per_metre", per_metre),
        ("metre_per_rad", metre_per_rad),
        ("floor_rad", floor_rad),
        ("per_rad", per_rad),
        ("rad_per_metre", rad_per_metre),
    ] {
        f.within(&format!("{of}.{name}"), value, 0.0..=1e6);
    }
}

fn icp(of: &str, config: &mut IcpConfig, f: &mut impl Fields) {
    let IcpConfig {
        variant,
        max_iters,
        tau,
        tolerance,
        min_pairs,
        trim,
        huber_width_m,
    } = config;
    let variants = [
        ("point-to-point", IcpVariant::PointToPoint),
        ("point-to-plane", IcpVariant::PointToPlane),
    ];
    choose(f, &format!("{of}.variant"), variant, &variants);
    f.count(&format!("{of}.max_iters"), max_iters);
    f.number(&format!("{of}.tau_m"), tau);
    f.number(&format!("{of}.tolerance"), tolerance);
    f.count(&format!("{of}.min_pairs"), min_pairs);
    // The file names the share that is kept.
    let before = 1.0 - *trim;
    let mut kept = before;
    f.within(&format!("{of}.trim_fraction"), &mut kept, 0.0..=1.0);
    if kept != before {
        *trim = 1.0 - kept;
    }
    f.number(&format!("{of}.huber_width_m"), huber_width_m);
}

fn matcher_kind(of: &str, kind: &mut MatcherKind, f: &mut impl Fields) {
    const NAMES: [&str; 6] = [
        "point-to-point",
        "point-to-plane",
        "icp",
        "ndt",
        "search",
        "staged",
    ];
    let number = match kind {
        MatcherKind::PointToPoint => 0,
        MatcherKind::PointToPlane => 1,
        MatcherKind::Icp(_) => 2,
        MatcherKind::Ndt(_) => 3,
        MatcherKind::Search(_) => 4,
        MatcherKind::Staged(_) => 5,
    };
    let chosen = f.one_of(of, &NAMES, number);
    if chosen != number {
        *kind = match chosen {
            0 => MatcherKind::PointToPoint,
            1 => MatcherKind::PointToPlane,
            2 => MatcherKind::Icp(IcpConfig::default()),
            3 => MatcherKind::Ndt(NdtMatcherConfig::default()),
            4 => MatcherKind::Search(SearchMatcherConfig::default()),
            _ => MatcherKind::Staged(StagedMatcherConfig::default()),
        };
    }
    match kind {
        MatcherKind::PointToPoint | MatcherKind::PointToPlane => {}
        MatcherKind::Icp(config) => icp(of, config, f),
        MatcherKind::Ndt(config) => ndt(of, config, f),
        MatcherKind::Search(config) => search(of, config, f),
        MatcherKind::Staged(config) => staged(of, config, f),
    }
}

fn ndt(of: &str, config: &mut NdtMatcherConfig, f: &mut impl Fields) {
    let NdtMatcherConfig {
        cell_m,
        min_points,
        solver,
    } = config;
    let NdtConfig {
        max_iters,
        gradient_tolerance,
        initial_damping,
        max_tries,
    } = solver;
    f.length(&format!("{of}.cell_m"), cell_m);
    f.count(&format!("{of}.min_points"), min_points);
    f.count(&format!("{of}.max_iters"), max_iters);
    f.number(&format!("{of}.gradient_tolerance"), gradient_tolerance);
    f.number(&format!("{of}.initial_damping"), initial_damping);
    f.count(&format!("{of}.max_tries"), max_tries);
}

fn search(of: &str, config: &mut SearchMatcherConfig, f: &mut impl Fields) {
    let SearchMatcherConfig {
        grid,
        half_width_m,
        half_turn_rad,
        neighborhood,
        min_score,
        refine,
    } = config;
    let LikelihoodConfig { cell_m, sigma_m } = grid;
    let SearchNeighborhood { reach_m, turn_rad } = neighborhood;
    f.length(&format!("{of}.grid.cell_m"), cell_m);
    f.length(&format!("{of}.grid.sigma_m"), sigma_m);
    f.number(&format!("{of}.half_width_m"), half_width_m);
    f.number(&format!("{of}.half_turn_rad"), half_turn_rad);
    f.number(&format!("{of}.neighborhood.reach_m"), reach_m);
    f.number(&format!("{of}.neighborhood.turn_rad"), turn_rad);
    f.number(&format!("{of}.min_score"), min_score);
    icp(&format!("{of}.refine"), refine, f);
}

fn staged(of: &str, config: &mut StagedMatcherConfig, f: &mut impl Fields) {
    let StagedMatcherConfig {
        taus_m,
        huber_width_m,
        fit_m,
        good_score,
        cells_m,
        min_points,
        ndt_iterations,
        turns,
        turn_rad,
        lead,
        near_score,
        near_lead,
    } = config;
    for (stage, tau_m) in taus_m.iter_mut().enumerate() {
        f.within(&format!("{of}.tau_{stage}_m"), tau_m, 0.0..=1e6);
    }
    f.number(&format!("{of}.huber_width_m"), huber_width_m);
    f.length(&format!("{of}.fit_m"), fit_m);
    f.number(&format!("{of}.good_score"), good_score);
    for (stage, cell_m) in cells_m.iter_mut().enumerate() {
        f.length(&format!("{of}.cell_{stage}_m"), cell_m);
    }
    f.count(&format!("{of}.min_points"), min_points);
    f.count(&format!("{of}.ndt_iterations"), ndt_iterations);
    f.up_to(&format!("{of}.turns"), turns, 1000);
    f.number(&format!("{of}.turn_rad"), turn_rad);
    f.number(&format!("{of}.lead"), lead);
    f.number(&format!("{of}.near_score"), near_score);
    f.number(&format!("{of}.near_lead"), near_lead);
}

fn detector(kind: &mut DetectorKind, f: &mut impl Fields) {
    let number = match kind {
        DetectorKind::Nearby => 0,
        DetectorKind::Place(PlaceDetectorConfig {
            descriptor: PlaceDescriptor::Histogram(_),
            ..
        }) => 1,
        DetectorKind::Place(_) => 2,
    };
    let chosen = f.one_of(
        "loops.detector",
        &["nearby", "histogram", "context"],
        number,
    );
    if chosen != number {
        *kind = match chosen {
            0 => DetectorKind::Nearby,
            1 => DetectorKind::Place(PlaceDetectorConfig::histogram(0)),
            _ => DetectorKind::Place(PlaceDetectorConfig::context(0)),
        };
    }
    let DetectorKind::Place(places) = kind else {
        return;
    };
    let PlaceDetectorConfig {
        descriptor,
        max_distance,
        keys_compared,
        min_gap_nodes,
    } = places;
    match descriptor {
        PlaceDescriptor::Histogram(HistogramConfig { bins, max_range_m }) => {
            f.up_to("loops.detector.bins", bins, 4096);
            f.length("loops.detector.max_range_m", max_range_m);
        }
        PlaceDescriptor::Context(ContextConfig {
            rings,
            sectors,
            max_range_m,
        }) => {
            f.up_to("loops.detector.rings", rings, 4096);
            f.up_to("loops.detector.sectors", sectors, 4096);
            f.length("loops.detector.max_range_m", max_range_m);
        }
    }
    f.number("loops.detector.max_distance", max_distance);
    f.count("loops.detector.keys_compared", keys_compared);
    f.count("loops.detector.min_gap_nodes", min_gap_nodes);
}

fn loop_config(config: &mut LoopConfig, f: &mut impl Fields) {
    let LoopConfig {
        detector: kind,
        detection,
        radius_m,
        min_gap_nodes,
        attempt_every_nodes,
        candidates_tried,
        submap_half_width,
        submap,
        matcher,
        max_iterations,
        min_tau_m,
        max_rmse_m,
        min_inliers,
        min_score,
        trust: of_loops,
        aperture,
        drift_share,
        max_radius_m,
        search: wide,
        guard: who_waits,
        gate_model,
        drift_sigma_m,
        drift_sigma_rad,
        gate_chi2,
    } = config;
    detector(kind, f);
    let detections = [
        ("nearest", Detection::Nearest),
        ("visits", Detection::Visits),
    ];
    choose(f, "loops.detection", detection, &detections);
    f.number("loops.radius_m", radius_m);
    f.count("loops.min_gap_nodes", min_gap_nodes);
    f.count("loops.attempt_every_nodes", attempt_every_nodes);
    f.count("loops.candidates_tried", candidates_tried);
    f.count("loops.submap_half_width", submap_half_width);
    map("loops.submap", submap, f);
    matcher_kind("loops.matcher", matcher, f);
    f.count("loops.max_iterations", max_iterations);
    f.number("loops.min_tau_m", min_tau_m);
    f.number("loops.max_rmse_m", max_rmse_m);
    f.count("loops.min_inliers", min_inliers);
    f.number("loops.min_score", min_score);
    trust("loops.trust", of_loops, f);
    f.number("loops.aperture", aperture);
    f.number("loops.drift_share", drift_share);
    f.number("loops.max_radius_m", max_radius_m);
    let is_wide = f.one_of("loops.search", &["off", "on"], usize::from(wide.is_some())) == 1;
    if is_wide {
        let WideSearch {
            matcher,
            min_way_m,
            every_m,
            candidates,
            min_margin,
            min_score,
        } = wide.get_or_insert(WideSearch {
            matcher: SearchMatcherConfig::default(),
            min_way_m: 0.0,
            every_m: 0.0,
            candidates: 0,
            min_margin: 0.0,
            min_score: 0.0,
        });
        search("loops.search.matcher", matcher, f);
        f.number("loops.search.min_way_m", min_way_m);
        if f.knows("loops.search.every_m") {
            f.number("loops.search.every_m", every_m);
        }
        f.count("loops.search.candidates", candidates);
        f.number("loops.search.min_margin", min_margin);
        f.number("loops.search.min_score", min_score);
    } else {
        *wide = None;
    }
    guard(who_waits, f);
    let gates = [
        ("path", GateModel::PathApproximation),
        ("marginal", GateModel::ExactMarginal),
    ];
    choose(f, "loops.gate_model", gate_model, &gates);
    f.number("loops.drift_sigma_m", drift_sigma_m);
    f.number("loops.drift_sigma_rad", drift_sigma_rad);
    f.number("loops.gate_chi2", gate_chi2);
}

fn guard(config: &mut Option<LoopGuard>, f: &mut impl Fields) {
    let is_on = f.one_of("loops.guard", &["off", "on"], usize::from(config.is_some())) == 1;
    if !is_on {
        *config = None;
        return;
    }
    let LoopGuard {
        floor_m,
        floor_rad,
        gate_chi2,
        sure_m,
        min_margin,
        agreeing,
        agreeing_outside,
        apart_m,
        patience_m,
        referee: _,
    } = config.get_or_insert_default();
    for (name, value) in [
        ("floor_m", floor_m),
        ("floor_rad", floor_rad),
        ("gate_chi2", gate_chi2),
        ("sure_m", sure_m),
        ("apart_m", apart_m),
        ("patience_m", patience_m),
    ] {
        f.within(&format!("loops.guard.{name}"), value, 0.0..=1e9);
    }
    f.number("loops.guard.min_margin", min_margin);
    f.count("loops.guard.agreeing", agreeing);
    f.count("loops.guard.agreeing_outside", agreeing_outside);
}

fn refinement_config(config: &mut RefinementConfig, f: &mut impl Fields) {
    let RefinementConfig {
        passes,
        matcher,
        radius_m,
        min_gap_nodes,
        visits,
        shift_sigma_m,
        turn_sigma_rad,
        huber,
    } = config;
    f.up_to("refinement.passes", passes, 100);
    matcher_kind("refinement.matcher", matcher, f);
    f.number("refinement.radius_m", radius_m);
    f.count("refinement.min_gap_nodes", min_gap_nodes);
    f.count("refinement.visits", visits);
    f.number("refinement.shift_sigma_m", shift_sigma_m);
    f.number("refinement.turn_sigma_rad", turn_sigma_rad);
    f.number("refinement.huber", huber);
}
