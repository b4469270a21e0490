//! The number κ of pairs that count as one: what a registration claims, against what it errs by.

use std::sync::OnceLock;

use ch16_lab::samples;
use ch16_slam2d::cloud::DenseMap;
use ch16_slam2d::icp::{IcpConfig, IcpVariant, icp};
use ch16_slam2d::matching::{TrustConfig, match_information};
use pr_geom::{Rng, SE2, math};
use widget_kit::scene::{
    Aspect, Axis, Layer, LegendEntry, Mark, Panel, Scene, Stroke, Tone, Weight,
};

use super::{Shown, SketchSpec, Slider, histogram};

/// Both matchers, with their lines.
const MATCHERS: [(IcpVariant, &str, Stroke); 2] = [
    (IcpVariant::PointToPoint, "point-to-point", Stroke::Solid),
    (IcpVariant::PointToPlane, "point-to-plane", Stroke::Dashed),
];
/// Registrations of each.
const PLACES: usize = 240;
/// Beams of a sweep, as in the lap.
const BEAMS: usize = 120;
/// Radius of the normals, m.
const NORMAL_RADIUS_M: f64 = 0.3;
/// The drive between two sweeps, m and rad, from any heading within a part of room A, m.
const DRIVE: [f64; 2] = [0.2, 0.05];
const CORNER_M: [f64; 2] = [0.8, 0.8];
const SIZE_M: [f64; 2] = [2.4, 2.0];
/// Largest κ.
const MOST: f64 = 20.0;
/// Width of a bin in standard deviations, and bins to either side.
const BIN: f64 = 0.5;
const BINS: i32 = 10;
/// Largest drawn count of a bin, and ratio.
const HIGHEST: f64 = 120.0;
const MOST_RATIO: f64 = 4.0;

pub(super) const SKETCH: SketchSpec = SketchSpec {
    name: "kappa",
    title: "Errors, in claimed standard deviations",
    slider: Slider {
        label: "κ, points that count as one",
        unit: "",
        min: 1.0,
        max: MOST,
        step: 1.0,
        default: 1.0,
        decimals: 0,
    },
    at,
    handle,
};

/// Error along the drive ÷ its standard deviation, if every pair counts.
fn ratios(variant: IcpVariant) -> Vec<f64> {
    let mut rng = Rng::new(16);
    let config = IcpConfig {
        variant,
        ..IcpConfig::default()
    };
    let trust = TrustConfig {
        sigma_m: samples::RANGE_SIGMA_M,
        covariance_scale: 1.0,
        information_cap: f64::INFINITY,
    };
    let motion = SE2::new(DRIVE[0], 0.0, DRIVE[1]);
    let register = |_| {
        let [x, y] = [0, 1].map(|axis| CORNER_M[axis] + SIZE_M[axis] * rng.uniform(0.0, 1.0));
        let heading = rng.uniform(-core::f64::consts::PI, core::f64::consts::PI);
        let before = SE2::new(x, y, heading);
        let mut old = samples::sweep(&before, BEAMS, &mut rng);
        old.estimate_normals(NORMAL_RADIUS_M);
        let new = samples::sweep(&(before * motion), BEAMS, &mut rng);
        let map = DenseMap::from_cloud(&old, config.tau_m, usize::MAX);
        let found = icp(&new, &map, motion, &config);
        let information = match_information(&found.pairs, &found.pose, &trust);
        let covariance = information.try_inverse()?;
        Some(motion.between(&found.pose).log().x / math::sqrt(covariance[(0, 0)]))
    };
    (0..PLACES).filter_map(register).collect()
}

/// The ratios of both matchers.
fn found() -> &'static [Vec<f64>; 2] {
    static FOUND: OnceLock<[Vec<f64>; 2]> = OnceLock::new();
    FOUND.get_or_init(|| MATCHERS.map(|(variant, ..)| ratios(variant)))
}

/// Root mean square of the ratios with that κ, which widens a standard deviation by its root.
fn rms(which: usize, kappa: f64) -> f64 {
    let ratios = &found()[which];
    let squares: f64 = ratios.iter().map(|ratio| ratio * ratio).sum();
    math::sqrt(squares / ratios.len() as f64 / kappa)
}

/// On the curve of point-to-point.
fn handle(kappa: f64) -> (&'static str, [f64; 2]) {
    ("honest", [kappa, rms(0, kappa)])
}

fn at(kappa: f64) -> Shown {
    let [point, plane] = [0, 1].map(|which| rms(which, kappa));
    Shown {
        scene: Scene {
            panels: vec![errors(kappa), honest(kappa)],
        },
        sentence: format!(
            "With κ = {kappa:.0}, the typical error is {point:.2} times what point-to-point claims, which is {}, and {plane:.2} \
             times what point-to-plane claims, which is {}.",
            verdict(point),
            verdict(plane)
        ),
    }
}

/// A claim beside the typical error, in units of the claim.
fn verdict(ratio: f64) -> &'static str {
    match ratio {
        1.1.. => "too sure",
        0.9.. => "honest",
        _ => "too cautious",
    }
}

/// Line and colour of a matcher.
fn line(which: usize, points: Vec<[f64; 2]>) -> Layer {
    Layer::line(points, MATCHERS[which].2, Tone::Series(which as u8), 2.0)
}

fn errors(kappa: f64) -> Panel {
    let curve = |which: usize| {
        let scaled = found()[which].iter().map(|ratio| ratio / math::sqrt(kappa));
        line(which, histogram(scaled, BIN, BINS))
    };
    let reach = BIN * (f64::from(BINS) + 0.5);
    let normal = (-40..=40).map(|k| {
        let at = reach * f64::from(k) / 40.0;
        let density = math::exp(-0.5 * at * at) / math::sqrt(2.0 * core::f64::consts::PI);
        [at, density * BIN * PLACES as f64]
    });
    Panel {
        id: "errors",
        title: "Error ÷ claimed standard deviation".to_owned(),
        weight: Weight::Main,
        aspect: Aspect::Free,
        x: Axis::new("along the drive (σ); end bins hold the rest", -reach, reach),
        y: Axis::new("registrations", 0.0, HIGHEST),
        layers: vec![
            Layer::line(normal.collect(), Stroke::Dotted, Tone::Ink, 2.0),
            curve(0),
            curve(1),
        ],
        legend: (0..MATCHERS.len())
            .map(|which| {
                LegendEntry::line(
                    MATCHERS[which].1,
                    Tone::Series(which as u8),
                    MATCHERS[which].2,
                )
            })
            .chain([LegendEntry::line("as claimed", Tone::Ink, Stroke::Dotted)])
            .collect(),
        color_bar: None,
    }
}

fn honest(kappa: f64) -> Panel {
    let curve = |which: usize| {
        // What is to come would give the answer away.
        let points = (1..=kappa as u32).map(|k| [f64::from(k), rms(which, f64::from(k))]);
        line(which, points.collect())
    };
    let here = |which: usize| {
        let at = vec![[kappa, rms(which, kappa)]];
        Layer::points(at, Mark::Square, Tone::Series(which as u8), 5.0)
    };
    Panel {
        id: "honest",
        title: "Above 1 too sure, below it too cautious".to_owned(),
        weight: Weight::Side,
        aspect: Aspect::Free,
        x: Axis::new("κ", 0.0, MOST),
        y: Axis::new("typical error ÷ σ", 0.0, MOST_RATIO),
        layers: vec![
            Layer::segments(
                vec![[[0.0, 1.0], [MOST, 1.0]]],
                Stroke::Dotted,
                Tone::Ink,
                2.0,
            ),
            curve(0),
            curve(1),
            here(0),
            here(1),
        ],
        legend: Vec::new(),
        color_bar: None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The claim of the caption: one κ cannot be right for both matchers.
    #[test]
    fn without_kappa_both_matchers_claim_too_much_and_each_needs_its_own() {
        assert!(found().iter().all(|ratios| ratios.len() == PLACES));
        // The ratio falls with the root of κ: it is 1 at the square of its value without κ.
        let [point, plane] = [0, 1].map(|which| rms(which, 1.0));
        assert!(point > 1.5 * plane && plane > 1.3, "{point} {plane}");
        assert!((rms(0, point * point) - 1.0).abs() < 1e-12);
    }
}
