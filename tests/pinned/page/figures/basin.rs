//! Registrations of w16.1 from a wrong heading: their results, and the width of the basin.

use ch16_lab::basin::{
    BasinOutcome, BasinScene, BasinStart, EdgeSearch, HOME_HEADING_DEG, Minimum, SUCCESS_RADIUS_M,
};
use ch16_slam2d::icp::{IcpVariant, IcpWorkspace, correspondences, icp_information};

/// The widget's own τ, m.
pub const TAU_M: f64 = 0.7;
/// Other τ of the exercises, m.
pub const WIDE_TAU_M: f64 = 1.4;
const SHORT_TAU_M: f64 = 0.1;

/// `p2l.180.rmse`, `p2p.wide.to_deg`: by variant, and by start or edge.
pub fn value(scene: &BasinScene, path: &[&str]) -> Option<f64> {
    match *path {
        ["points"] => Some(scene.source().len() as f64),
        ["success_m"] => Some(SUCCESS_RADIUS_M),
        ["home_deg"] => Some(HOME_HEADING_DEG),
        [name, "edge_deg"] => edge_deg(scene, name, TAU_M),
        [name, "wide", "edge_deg"] => edge_deg(scene, name, WIDE_TAU_M),
        [variant, "from_deg"] => basin_edge(scene, variant, TAU_M, -1),
        [variant, "to_deg"] => basin_edge(scene, variant, TAU_M, 1),
        [variant, "wide", "from_deg"] => basin_edge(scene, variant, WIDE_TAU_M, -1),
        [variant, "wide", "to_deg"] => basin_edge(scene, variant, WIDE_TAU_M, 1),
        [name, "quarter_from_deg"] => quarter_from_deg(scene, name),
        [name, "iterations_least"] => iterations_in_basin(scene, name)?.min(),
        [name, "iterations_most"] => iterations_in_basin(scene, name)?.max(),
        [_, "short", "starts"] => Some(whole_degrees().count() as f64),
        [variant, "short", "right"] => {
            let ends_right = |degrees: &i32| {
                register(scene, variant, SHORT_TAU_M, f64::from(*degrees))
                    .is_some_and(|found| found.ending == Minimum::Right)
            };
            Some(whole_degrees().filter(ends_right).count() as f64)
        }
        [variant, "short", "placed"] => {
            let ends_there = |degrees: &i32| {
                register(scene, variant, SHORT_TAU_M, f64::from(*degrees))
                    .is_some_and(|found| found.error_m < SUCCESS_RADIUS_M)
            };
            Some(whole_degrees().filter(ends_there).count() as f64)
        }
        [variant, heading_deg, "std_mm"] => {
            claimed_std_mm(scene, variant, heading_deg.parse().ok()?)
        }
        [variant, heading_deg, "lost"] => {
            let found = register(scene, variant, TAU_M, heading_deg.parse().ok()?)?;
            Some((scene.source().len() - found.inliers) as f64)
        }
        [variant, heading_deg, what] => {
            let found = register(scene, variant, TAU_M, heading_deg.parse().ok()?)?;
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
fn register(scene: &BasinScene, name: &str, tau: f64, heading_deg: f64) -> Option<BasinOutcome> {
    let start = BasinStart {
        heading_deg,
        dx_m: 0.0,
        dy_m: 0.0,
    };
    let config = BasinScene::config(variant(name)?, tau);
    Some(scene.register_from(&start, &config, &mut IcpWorkspace::new()))
}

/// The standard deviation of the position in its loosest direction, according to a registration.
fn claimed_std_mm(scene: &BasinScene, name: &str, heading_deg: f64) -> Option<f64> {
    /// Range noise of the scene's sensor, m.
    const SIGMA_M: f64 = 0.012;
    let config = BasinScene::config(variant(name)?, TAU_M);
    let found = register(scene, name, TAU_M, heading_deg)?;
    let pairs = correspondences(scene.source(), scene.map(), found.pose, &config);
    let information = icp_information(&pairs, SIGMA_M, 1.0);
    let position = information.fixed_view::<2, 2>(0, 0).into_owned();
    Some(1e3 / position.symmetric_eigenvalues().min().sqrt())
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

/// The smallest whole degree from which, as from each larger one up to 90°, a registration ends a quarter
/// turn off.
fn quarter_from_deg(scene: &BasinScene, name: &str) -> Option<f64> {
    let is_quarter = |degrees: &i32| {
        register(scene, name, TAU_M, f64::from(*degrees))
            .is_some_and(|found| found.ending == Minimum::QuarterTurn)
    };
    let last_other = (0..=90).rev().find(|degrees| !is_quarter(degrees))?;
    Some(f64::from(last_other + 1))
}

/// Iterations from each whole degree of the right basin, except for the truth itself.
fn iterations_in_basin(scene: &BasinScene, name: &str) -> Option<Iterations> {
    let [from, to] = [-1, 1].map(|side| basin_edge(scene, name, TAU_M, side));
    let degrees = (from? as i32..=to? as i32).filter(|degrees| *degrees != 0);
    let found = degrees.filter_map(|degrees| register(scene, name, TAU_M, f64::from(degrees)));
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
fn basin_edge(scene: &BasinScene, name: &str, tau: f64, side: i32) -> Option<f64> {
    let comes_home = |degrees: i32| {
        let found = register(scene, name, tau, f64::from(side * degrees));
        found.is_some_and(|found| found.ending == Minimum::Right)
    };
    variant(name)?;
    let first_failure = (0..=180).find(|&degrees| !comes_home(degrees))?;
    Some(f64::from(side * (first_failure - 1)))
}

/// The largest heading error, on both sides, of a guess at the right position that converges to the truth.
fn edge_deg(scene: &BasinScene, name: &str, tau: f64) -> Option<f64> {
    let mut search = EdgeSearch::new(BasinScene::config(variant(name)?, tau));
    let mut workspace = IcpWorkspace::new();
    while !search.step(scene, &mut workspace) {}
    search.reached_deg()
}
