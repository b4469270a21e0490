//! The basin's edge: the reader marks it for both errors, then it is computed and compared.

use ch16_lab::basin::{BasinScene, EdgeSearch};
use ch16_slam2d::icp::{IcpVariant, IcpWorkspace};
use widget_kit::disclosure::Opening;
use widget_kit::model::{Activity, Assessment, Fact, Outcome};
use widget_kit::scene::{Layer, Mark, Stroke, Tone};
use widget_kit::values::Values;

use super::BasinExplorer;
use super::settings::{config, variant_name};
use crate::w16_1_basin_explorer::spec::{EDGE, EDGES, OFFSET_SPAN_M, Phase};

/// Distance of a word from its line, pixels.
const CLEAR_PX: f32 = 8.0;
/// Largest error of a right mark, °.
const RIGHT_DEG: f64 = 5.0;

const VARIANTS: [IcpVariant; 2] = [IcpVariant::PointToPoint, IcpVariant::PointToPlane];

/// The opening layer while the question is open.
pub const OPENING: Opening = Opening {
    panels: &["basin-point-to-point", "basin-point-to-plane"],
    params: &["edge-p2p", "edge-p2l"],
    buttons: &["sweep", "defaults"],
};

/// The searches for both edges, in the order of the maps.
pub struct Edges {
    searches: [EdgeSearch; 2],
}

impl Edges {
    /// Searches before their first step.
    pub fn new(values: &Values) -> Self {
        Self {
            searches: VARIANTS.map(|variant| EdgeSearch::new(config(values, variant))),
        }
    }

    /// Starts over if the settings changed.
    pub fn follow(&mut self, values: &Values) {
        let fresh = Self::new(values);
        let differs = |(old, new): (&EdgeSearch, &EdgeSearch)| old.config() != new.config();
        if self.searches.iter().zip(&fresh.searches).any(differs) {
            *self = fresh;
        }
    }

    /// Advances the search that is behind by one degree.
    pub fn work(&mut self, scene: &BasinScene, workspace: &mut IcpWorkspace) -> Activity {
        let open = self.searches.iter_mut().filter(|search| !search.is_done());
        let Some(behind) = open.min_by(|a, b| reached(a).total_cmp(&reached(b))) else {
            return Activity::Idle;
        };
        behind.step(scene, workspace);
        Activity::Busy
    }

    fn are_found(&self) -> bool {
        self.searches.iter().all(EdgeSearch::is_done)
    }
}

fn reached(search: &EdgeSearch) -> f64 {
    search.reached_deg().unwrap_or(0.0)
}

/// The edges that the reader has marked, °; 0 without a mark.
fn marks(values: &Values) -> [f64; 2] {
    EDGES.each_ref().map(|edge| values.get(edge))
}

/// A line at a heading error, on both sides.
fn lines(heading_deg: f64, stroke: Stroke, tone: Tone) -> Layer {
    let side = |x: f64| [[x, -OFFSET_SPAN_M], [x, OFFSET_SPAN_M]];
    Layer::segments(
        vec![side(-heading_deg), side(heading_deg)],
        stroke,
        tone,
        2.5,
    )
}

/// The question's layers over the map of a variant.
pub fn layers(explorer: &BasinExplorer, of: IcpVariant) -> Vec<Layer> {
    let phase = explorer.values.get(&EDGE);
    if phase == Phase::Off {
        return Vec::new();
    }
    let k = usize::from(of == IcpVariant::PointToPlane);
    let mark = marks(&explorer.values)[k];
    let mut layers = Vec::new();
    if phase == Phase::Swept {
        let edge = reached(&explorer.edges.searches[k]);
        layers.push(lines(edge, Stroke::Dashed, Tone::Truth));
        // Along the pure rotations that were computed.
        layers.push(Layer::line(
            vec![[-edge, 0.0], [edge, 0.0]],
            Stroke::Dashed,
            Tone::Truth,
            2.5,
        ));
        layers.push(Layer::label([edge, 0.0], "swept".to_owned(), CLEAR_PX));
    }
    if mark > 0.0 {
        layers.push(lines(mark, Stroke::Solid, Tone::Ink));
        let high = 0.6 * OFFSET_SPAN_M;
        layers.push(Layer::label([mark, high], "your edge".to_owned(), CLEAR_PX));
    }
    if phase == Phase::Marking {
        layers.extend([-mark, mark].map(|x| Layer::Handle {
            at: [x, 0.0],
            tone: Tone::Ink,
            label: "your edge of the basin: drag it outwards",
        }));
        layers.push(Layer::points(
            vec![[0.0, 0.0]],
            Mark::Plus,
            Tone::Truth,
            7.0,
        ));
        layers.push(Layer::label([0.0; 2], "truth".to_owned(), CLEAR_PX));
    }
    layers
}

/// The question and its answer in words; `None` if the question is off.
pub fn outcome(explorer: &BasinExplorer) -> Option<Outcome> {
    let values = &explorer.values;
    match values.get(&EDGE) {
        Phase::Off => None,
        Phase::Marking => Some(question(values)),
        Phase::Swept => Some(answer(explorer)),
    }
}

fn question(values: &Values) -> Outcome {
    let marks = marks(values);
    let parts = VARIANTS.iter().zip(marks).map(|(variant, mark)| {
        let name = variant_name(*variant);
        if mark > 0.0 {
            format!("{name}: ±{mark:.0}°")
        } else {
            format!("{name}: no mark yet")
        }
    });
    let parts: Vec<_> = parts.collect();
    let all = marks.iter().all(|mark| *mark > 0.0);
    Outcome {
        standing: Assessment::Neutral,
        verdict: if all {
            "both edges are marked"
        } else {
            "mark both edges"
        }
        .to_owned(),
        sentence: format!(
            "How far can a guess at the right place turn either way and still converge to the truth? {}. Mark both, then press Sweep the edge.",
            parts.join("; ")
        ),
        facts: Vec::new(),
    }
}

fn answer(explorer: &BasinExplorer) -> Outcome {
    let searches = &explorer.edges.searches;
    let marks = marks(&explorer.values);
    let is_right =
        |k: usize| marks[k] > 0.0 && (marks[k] - reached(&searches[k])).abs() <= RIGHT_DEG;
    let right = (0..2).filter(|&k| is_right(k)).count();
    let (standing, verdict) = match right {
        _ if !explorer.edges.are_found() => (Assessment::Neutral, "the edge is swept"),
        2 => (Assessment::Good, "both edges are right"),
        1 => (Assessment::Neutral, "one edge is right"),
        _ => (Assessment::Bad, "no edge is right"),
    };
    let parts = searches.iter().zip(VARIANTS).zip(marks);
    let parts = parts.map(|((search, variant), mark)| {
        let edge = reached(search);
        let home = format!("{} converges from up to {edge:.0}°", variant_name(variant));
        let gap = mark - edge;
        match gap {
            _ if mark == 0.0 => format!("{home}, and you marked none"),
            0.0 => format!("{home}, as you marked"),
            _ if gap > 0.0 => format!("{home}, and you marked {mark:.0}°, {gap:.0}° too far"),
            _ => format!("{home}, and you marked {mark:.0}°, {:.0}° short", -gap),
        }
    });
    let parts: Vec<_> = parts.collect();
    let known = |k: usize| {
        let edge = searches[k].reached_deg().filter(|_| searches[k].is_done());
        edge.unwrap_or(f64::NAN)
    };
    Outcome {
        standing,
        verdict: verdict.to_owned(),
        sentence: format!("{}.", parts.join("; ")),
        facts: vec![
            Fact::new("edge_p2p_deg", "edge, point-to-point", known(0), "°", 0),
            Fact::new("edge_p2l_deg", "edge, point-to-plane", known(1), "°", 0),
            Fact::new(
                "mark_p2p_deg",
                "your edge, point-to-point",
                marks[0],
                "°",
                0,
            ),
            Fact::new(
                "mark_p2l_deg",
                "your edge, point-to-plane",
                marks[1],
                "°",
                0,
            ),
        ],
    }
}
