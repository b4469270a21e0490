//! Draggable things: both robots, the threshold, the newer view, and a pair of the matrix.

use pr_geom::{SE2, math};
use widget_kit::model::Handle;

use super::lap::Places;
use super::picture::scores;
use super::{PlaceRecognition, panel};
use crate::w16_7_place_recognition::spec::{CALLED, SECTOR_DEG, TURN};

/// Names of the draggable things.
mod thing {
    pub const OLD: &str = "old";
    pub const NEW: &str = "new";
    pub const THRESHOLD: &str = "threshold";
    pub const TURN: &str = "turn";
    pub const PAIR: &str = "pair";
}

/// Keyframes of the way out and of the way back lie beside each other: one that is as many keyframes away
/// counts as this much farther, m.
const PER_KEYFRAME_M: f64 = 0.03;

/// What a press takes.
pub fn grab(been: &PlaceRecognition, panel: &str, at: [f64; 2], reach: [f64; 2]) -> Option<Handle> {
    let places = been.places.as_ref()?;
    match panel {
        panel::FLAT => {
            let [old, new] = been.pair()?;
            let robots = [(thing::NEW, new), (thing::OLD, old)].into_iter();
            let mut near = robots.filter_map(|(id, node)| {
                let robot = places.study.places()[node].truth;
                Handle::within(panel::FLAT, id, [robot.x(), robot.y()], at, reach)
            });
            near.next()
        }
        panel::SCORES => {
            let line = been.threshold(been.detector()).max(0.0);
            Handle::within(panel::SCORES, thing::THRESHOLD, [line, at[1]], at, reach)
        }
        panel::LOOKS => {
            let turn = super::picture::looks::turn_deg(been)?;
            let anywhere = [f64::INFINITY; 2];
            Handle::within(panel::LOOKS, thing::TURN, [turn, at[1]], at, anywhere)
        }
        // Every spot of the matrix is a pair.
        panel::MATRIX => {
            let [_, new] = super::picture::pair_at(been, at)?;
            let pair = Handle::within(panel::MATRIX, thing::PAIR, at, at, reach);
            pair.filter(|_| new > 0)
        }
        _ => None,
    }
}

/// Moves the grabbed thing.
pub fn drag(been: &mut PlaceRecognition, handle: Handle, at: [f64; 2]) {
    let (Some(spot), Some(places), Some([old, new])) =
        (handle.spot(at), been.places.as_ref(), been.pair())
    else {
        return;
    };
    match handle.id {
        thing::NEW => {
            let new = nearest(places, new, spot).max(1);
            been.playback.pause();
            been.values.put(&super::NEWEST, new as f64);
        }
        thing::OLD => {
            let old = nearest(places, old, spot).min(new - 1);
            been.select([old, new]);
        }
        thing::THRESHOLD => {
            let called = places.called_percent(been.detector(), spot[0]);
            been.values
                .put(&CALLED, called.round().clamp(0.0, CALLED.spec.range().1));
        }
        thing::TURN => {
            let best = places.study.turned(old, new).turn_rad;
            let away = SE2::new(0.0, 0.0, spot[0].to_radians() - best).theta();
            let sectors = (away.to_degrees() / SECTOR_DEG).round();
            been.playback.pause();
            been.values.put(&TURN, sectors * SECTOR_DEG);
        }
        _ => {
            if let Some([old, new]) = super::picture::pair_at(been, spot)
                && new > 0
            {
                been.select([old, new]);
            }
        }
    }
}

/// A tap on a dot selects its pair.
pub fn tap(been: &mut PlaceRecognition, panel: &str, at: [f64; 2], reach: [f64; 2]) {
    if panel != panel::SCORES || !at.iter().all(|value| value.is_finite()) {
        return;
    }
    let away = |dot: &scores::Dot| {
        let [x, y] = [0, 1].map(|i| (dot.at[i] - at[i]) / reach[i]);
        math::norm2(x, y)
    };
    let dots = scores::dots(been)
        .into_iter()
        .filter(|dot| away(dot) <= 1.0);
    let nearest = dots.min_by(|a, b| away(a).total_cmp(&away(b)));
    if let Some(dot) = nearest {
        been.select(dot.nodes);
    }
}

/// The keyframe nearest to a spot of the flat, on the same pass through it if possible.
fn nearest(places: &Places, now: usize, [x, y]: [f64; 2]) -> usize {
    let away = |(node, place): (usize, &ch16_lab::places::Place)| {
        let truth = place.truth;
        let far_m = math::norm2(truth.x() - x, truth.y() - y);
        (node, far_m + PER_KEYFRAME_M * node.abs_diff(now) as f64)
    };
    let all = places.study.places().iter().enumerate().map(away);
    all.min_by(|a, b| a.1.total_cmp(&b.1))
        .map_or(now, |(node, _)| node)
}
