//! Registrations of w16.1 from a wrong heading: their results, and the width of the basin.

use ch16_lab::basin::{
    BasinOutcome, BasinScene, BasinStart, EdgeSearch, HOME_HEADING_DEG, Minimum, SUCCESS_RADIUS_M,
};
use ch16_slam2d::icp::{IcpConfig, IcpVariant, IcpWorkspace, correspondences};
use ch16_slam2d::matching::{TrustConfig, match_information};

/// The widget's own τ, m.
pub const TAU_M: f64 = 0.7;
/// Other τ of the exercises, m.
pub const WIDE_TAU_M: f64 = 1.4;
const SHORT_TAU_M: f64 = 0.1;

/// The settings of a registration of the text.
#[derive(Clone, Copy)]
struct Settings {
    tau_m: f64,
    max_iterations: usize,
}

/// The widget's own settings.
const OWN: Settings = Settings {
    tau_m: TAU_M,
    max_iterations: BasinScene::MAX_ITERS,
};

impl Settings {
    /// Takes `patient` (no registration runs out of iterations) and `wide` from the front of a path.
    fn taken_from<'a>(mut path: &'a [&'a str]) -> (Self, &'a [&'a str]) {
        let mut settings = OWN;
        while let [word, rest @ ..] = path {
            match *word {
                "patient" => settings.max_iterations = BasinScene::PATIENT_ITERS,
                "wide" => settings.tau_m = WIDE_TAU_M,
                _ => break,
            }
            path = rest;
        }
        (settings, path)
    }
}

/// `p2l.180.rmse`, `p2p.patient.wide.to_deg`: by variant, settings, and start or edge.
pub fn value(scene: &BasinScene, path: &[&str]) -> Option<f64> {
    match *path {
        ["points"] => return Some(scene.source().len() as f64),
        ["success_m"] => return Some(SUCCESS_RADIUS_M),
        ["home_deg"] => return Some(HOME_HEADING_DEG),
        ["limit"] => return Some(BasinScene::MAX_ITERS as f64),
        ["patient"] => return Some(BasinScene::PATIENT_ITERS as f64),
        _ => {}
    }
    let (name, path) = path.split_first()?;
    variant(name)?;
    let (settings, path) = Settings::taken_from(path);
    let short = Settings {
        tau_m: SHORT_TAU_M,
        ..settings
    };
    let count = |is_counted: fn(&BasinOutcome) -> bool| {
        let found = whole_degrees().filter_map(|deg| register(scene, name, short, f64::from(deg)));
        found.filter(is_counted).count() as f64
    };
    match *path {
        ["edge_deg"] => edge_deg(scene, name, settings),
        ["from_deg"] => basin_edge(scene, name, settings, -1),
        ["to_deg"] => basin_edge(scene, name, settings, 1),
        ["quarter_from_deg"] => quarter_from_deg(scene, name, settings, 1),
        ["quarter_below_deg"] => quarter_from_deg(scene, name, settings, -1),
        ["iterations_least"] => iterations_in_basin(scene, name, settings)?.min(),
        ["iterations_most"] => iterations_in_basin(scene, name, settings)?.max(),
        ["short", "starts"] => Some(whole_degrees().count() as f64),
        ["short", "right"] => Some(count(|found| found.ending == Minimum::Right)),
        ["short", "placed"] => Some(count(|found| found.error_m < SUCCESS_RADIUS_M)),
        [heading_deg, "std_mm"] => claimed_std_mm(scene, name, heading_deg.parse().ok()?),
        [heading_deg, "lost"] => {
            let found = register(scene, name, settings, heading_deg.parse().ok()?)?;
            Some((scene.source().len() - found.inliers) as f64)
        }
        [heading_deg, what] => {
            let found = register(scene, name, settings, heading_deg.parse().ok()?)?;
            registration(&found, what)
        }
        _ => None,
    }
}

fn variant(name: &str) -> Option<IcpVariant> {
    match name {
        "p2p" => Some(IcpVariant::PointToPoint),
        "p2l" => Some(IcpVariant::PointToPlane),
        _ => None,
    }
}

/// Registers from the right position with a wrong heading.
fn register(
    scene: &BasinScene,
    name: &str,
    settings: Settings,
    heading_deg: f64,
) -> Option<BasinOutcome> {
    let start = BasinStart {
        heading_deg,
        dx_m: 0.0,
        dy_m: 0.0,
    };
    let config = config(name, settings)?;
    Some(scene.register_from(&start, &config, &mut IcpWorkspace::new()))
}

fn config(name: &str, settings: Settings) -> Option<IcpConfig> {
    Some(IcpConfig {
        max_iterations: settings.max_iterations,
        ..BasinScene::config(variant(name)?, settings.tau_m)
    })
}

/// The standard deviation of the robot's position in its loosest direction, according to a registration whose heading is
/// unknown as well.
fn claimed_std_mm(scene: &BasinScene, name: &str, heading_deg: f64) -> Option<f64> {
    /// Range noise of the scene's sensor, m.
    const SIGMA_M: f64 = 0.012;
    let config = config(name, OWN)?;
    let found = register(scene, name, OWN, heading_deg)?;
    let pairs = correspondences(scene.source(), scene.map(), found.pose, &config);
    let trust = TrustConfig {
        sigma_m: SIGMA_M,
        covariance_scale: 1.0,
        information_cap: f64::INFINITY,
    };
    let information = match_information(&pairs, &found.pose, &trust);
    let position = information
        .try_inverse()?
        .fixed_view::<2, 2>(0, 0)
        .into_owned();
    Some(1e3 * position.symmetric_eigenvalues().max().sqrt())
}

fn registration(found: &BasinOutcome, what: &str) -> Option<f64> {
    Some(match what {
        "error_m" => found.error_m,
        "error_deg" => found.error_deg.abs(),
        "rmse" => found.rmse_m,
        "iterations" => found.iterations as f64,
        _ => return None,
    })
}

fn whole_degrees() -> impl Iterator<Item = i32> {
    -180..=180
}

/// The whole degree nearest to zero on one side from which, as from each one up to 90° on that side, a registration ends
/// a quarter turn off.
fn quarter_from_deg(scene: &BasinScene, name: &str, settings: Settings, side: i32) -> Option<f64> {
    let is_quarter = |degrees: &i32| {
        register(scene, name, settings, f64::from(side * degrees))
            .is_some_and(|found| found.ending == Minimum::QuarterTurn)
    };
    let last_other = (0..=90).rev().find(|degrees| !is_quarter(degrees))?;
    Some(f64::from(side * (last_other + 1)))
}

/// Iterations from each whole degree of the correct basin, except for the truth itself.
fn iterations_in_basin(scene: &BasinScene, name: &str, settings: Settings) -> Option<Iterations> {
    let [from, to] = [-1, 1].map(|side| basin_edge(scene, name, settings, side));
    let degrees = (from? as i32..=to? as i32).filter(|degrees| *degrees != 0);
    let found = degrees.filter_map(|degrees| register(scene, name, settings, f64::from(degrees)));
    Some(Iterations(found.map(|found| found.iterations).collect()))
}

/// Counts of iterations.
struct Iterations(Vec<usize>);

impl Iterations {
    fn min(&self) -> Option<f64> {
        self.0.iter().min().map(|count| *count as f64)
    }

    fn max(&self) -> Option<f64> {
        self.0.iter().max().map(|count| *count as f64)
    }
}

/// The last whole degree, from 0 to one side, that converges to the right minimum.
fn basin_edge(scene: &BasinScene, name: &str, settings: Settings, side: i32) -> Option<f64> {
    let comes_home = |degrees: i32| {
        let found = register(scene, name, settings, f64::from(side * degrees));
        found.is_some_and(|found| found.ending == Minimum::Right)
    };
    let first_failure = (0..=180).find(|&degrees| !comes_home(degrees))?;
    Some(f64::from(side * (first_failure - 1)))
}

/// The largest heading error, on both sides, of a guess at the right position that converges to the truth.
fn edge_deg(scene: &BasinScene, name: &str, settings: Settings) -> Option<f64> {
    let mut search = EdgeSearch::new(config(name, settings)?);
    let mut workspace = IcpWorkspace::new();
    while !search.step(scene, &mut workspace) {}
    search.reached_deg()
}
