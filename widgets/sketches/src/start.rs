//! A bad initial guess, the chordal start, and the certificate of the optimum.

mod certificate;
mod wound;

use pr_geom::SE2;
use pr_optim::Problem;
use widget_kit::scene::{
    Aspect, Axis, Layer, LegendEntry, Mark, Panel, Scene, Stroke, Tone, Weight,
};

use super::{Shown, SketchSpec, Slider};
use certificate::Certificate;
use wound::{chordal_start, ring, solved_from, wound_up};

/// A certificate that leaves less than this share of the cost confirms an optimum.
const CONFIRMS: f64 = 0.01;
/// Largest twist, degrees.
const MAX_TWIST_DEG: f64 = 360.0;

pub(super) const SKETCH: SketchSpec = SketchSpec {
    name: "start",
    title: "A guess that is wound up",
    slider: Slider {
        label: "the guess is wound up by",
        unit: "°",
        min: 0.0,
        max: MAX_TWIST_DEG,
        step: 10.0,
        default: 300.0,
        decimals: 0,
    },
    at,
    handle,
};

/// The last pose of the guess.
fn handle(twist_deg: f64) -> (&'static str, [f64; 2]) {
    let poses = wound_up(&ring(), twist_deg.to_radians());
    let last = poses[poses.len() - 1];
    ("given", [last.x(), last.y()])
}

/// The verdict of the certificate in words.
fn verdict(certificate: &Certificate) -> String {
    if certificate.confirms(CONFIRMS) {
        "and the certificate confirms it: no poses cost less".to_owned()
    } else {
        format!(
            "with no certificate: some poses may cost as little as {:.1}",
            certificate.lower_bound.max(0.0)
        )
    }
}

fn at(twist_deg: f64) -> Shown {
    let guess = wound_up(&ring(), twist_deg.to_radians());
    let from_guess = solved_from(&guess);
    let relaxed = chordal_start(&ring());
    let from_relaxed = solved_from(&relaxed);
    let [given, chordal] =
        [&from_guess, &from_relaxed].map(|solved| (solved.chi2(), Certificate::of(solved)));
    Shown {
        sentence: format!(
            "From a guess wound up by {twist_deg:.0}°, Gauss–Newton stops at χ² {:.1}, {}. From the chordal start it stops at {:.1}, {}.",
            given.0,
            verdict(&given.1),
            chordal.0,
            verdict(&chordal.1)
        ),
        scene: Scene {
            panels: vec![
                picture("given", "From the given guess", &guess, &from_guess),
                picture("relaxed", "From the chordal start", &relaxed, &from_relaxed),
            ],
        },
    }
}

fn picture(id: &'static str, title: &str, start: &[SE2], rest: &Problem) -> Panel {
    let round = |poses: &[SE2]| -> Vec<[f64; 2]> {
        let all = poses.iter().chain(poses.first());
        all.map(|pose| [pose.x(), pose.y()]).collect()
    };
    let pose = |pose: &SE2| Layer::pose(pose.to_array(), Mark::Square, Tone::Posterior, 4.0);
    let mut layers = vec![
        Layer::line(round(start), Stroke::Dotted, Tone::Prediction, 1.5),
        Layer::points(
            start.iter().map(|pose| [pose.x(), pose.y()]).collect(),
            Mark::Triangle,
            Tone::Prediction,
            4.0,
        ),
        Layer::line(round(rest.poses()), Stroke::Solid, Tone::Posterior, 2.0),
    ];
    layers.extend(rest.poses().iter().map(pose));
    Panel {
        id,
        title: title.to_owned(),
        weight: Weight::Half,
        aspect: Aspect::Equal,
        x: Axis::hidden(-3.0, 3.6),
        y: Axis::hidden(-0.8, 4.8),
        layers,
        legend: vec![
            LegendEntry::mark("start", Tone::Prediction, Mark::Triangle),
            LegendEntry::mark("at rest", Tone::Posterior, Mark::Square),
        ],
        color_bar: None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_certificate_fails_in_the_knot_and_confirms_what_the_chordal_start_finds() {
        let says = at(MAX_TWIST_DEG).sentence;
        let (given, chordal) = says.split_once("From the chordal start").unwrap();
        assert!(given.contains("no certificate"), "{given}");
        assert!(chordal.contains("confirms it"), "{chordal}");
        assert_eq!(at(0.0).sentence.matches("confirms it").count(), 2);
    }
}
