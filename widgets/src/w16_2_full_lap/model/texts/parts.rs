//! Texts about a selected keyframe, edge or loop, and about the custom loop.

use ch16_lab::lap::{Claim, EdgeStrain, GateUse, LoopJudgement, OwnLoop, edge_strain};
use ch16_slam2d::metrics::position_error_m;
use pr_geom::{SE2, math};
use widget_kit::model::{Assessment, Fact};

use super::{Statement, ends, standing};
use crate::w16_2_full_lap::model::found::{Found, find};
use crate::w16_2_full_lap::model::moment::LapState;
use crate::w16_2_full_lap::model::pick::GraphPart;

/// Error and χ² of a part, as far as it has them.
struct Numbers {
    error_m: f64,
    error_deg: f64,
    chi2: f64,
}

/// A short label beside the part on the map.
pub fn part_label(moment: &LapState, part: GraphPart) -> String {
    let Numbers { error_m, chi2, .. } = numbers(moment, part);
    match part {
        GraphPart::Keyframe(node) => format!("{node}: {error_m:.2} m off, χ² {chi2:.2}"),
        GraphPart::Edge(from) => {
            let to = from + 1;
            format!("edge {from} to {to}: {error_m:.3} m off, χ² {chi2:.2}")
        }
        GraphPart::Loop(_) | GraphPart::Own => {
            let name = named(moment, part);
            format!("{name}: {error_m:.2} m off, χ² {chi2:.2}")
        }
    }
}

fn named(moment: &LapState, part: GraphPart) -> String {
    match find(moment, part) {
        Some(Found::Loop(attempt)) => format!("loop {}", ends(attempt)),
        Some(Found::Own) => moment
            .own
            .map(|own| format!("your loop {}", ends(&own.attempt)))
            .unwrap_or_default(),
        _ => String::new(),
    }
}

/// The verdict and the sentence on a part.
pub fn part_statement(moment: &LapState, part: GraphPart) -> Statement {
    let Numbers {
        error_m,
        error_deg,
        chi2,
    } = numbers(moment, part);
    let neutral = |verdict: String, sentence| Statement {
        standing: Assessment::Neutral,
        verdict,
        sentence,
    };
    let tick = moment.tick;
    match (part, find(moment, part)) {
        (_, Some(Found::Keyframe(node))) => {
            let taken = moment.runs.graph.keyframe_tick(node);
            let edges = moment.edges_with_own();
            let count = edges
                .filter(|edge| [edge.from, edge.to].contains(&node))
                .count();
            let edges = if count == 1 { "edge" } else { "edges" };
            let tied = match moment.tied {
                Some(from) if from == node => {
                    "; your own loop begins here: select another keyframe and press Tie again"
                        .to_owned()
                }
                Some(from) => format!("; press Tie for a loop from keyframe {from} to here"),
                None => String::new(),
            };
            neutral(
                format!("keyframe {node}"),
                format!(
                    "keyframe {node} of tick {taken}: {error_m:.2} m and {error_deg:.1}° from the truth; its {count} {edges} cost χ² {chi2:.2}{tied}"
                ),
            )
        }
        (_, Some(Found::Edge(edge))) => {
            let strain = edge_strain(edge, &moment.nodes);
            neutral(
                format!("edge {} to {}", edge.from, edge.to),
                format!(
                    "edge {} to {}: measured {error_m:.3} m and {error_deg:.2}° from the truth, χ² {chi2:.2}, {}",
                    edge.from,
                    edge.to,
                    left(&strain)
                ),
            )
        }
        (_, Some(Found::Loop(attempt))) => {
            let lap = moment.runs.graph.lap();
            let judgement = lap.judge(attempt);
            let sentence = lap.loop_sentence(attempt);
            let now = if attempt.accepted() {
                format!("; now it costs χ² {chi2:.2}")
            } else {
                String::new()
            };
            let off = if judgement == LoopJudgement::FalseAcceptance {
                String::new()
            } else {
                format!("; measured {error_m:.2} m and {error_deg:.1}° from the truth")
            };
            Statement {
                standing: standing(judgement),
                verdict: format!("loop {}", ends(attempt)),
                sentence: format!("{sentence}{off}{now}"),
            }
        }
        (_, Some(Found::Own)) => moment.own.map_or_else(
            || {
                neutral(
                    "no loop of your own".to_owned(),
                    "no loop of your own".to_owned(),
                )
            },
            |own| own_statement(moment, own),
        ),
        (GraphPart::Loop(node), None) => neutral(
            "no such loop".to_owned(),
            format!("no loop has been tried at keyframe {node} by tick {tick}"),
        ),
        (GraphPart::Keyframe(number) | GraphPart::Edge(number), None) => neutral(
            "not yet there".to_owned(),
            format!(
                "keyframe {} does not exist yet at tick {tick}; keyframe {} is the newest",
                if matches!(part, GraphPart::Edge(_)) {
                    number + 1
                } else {
                    number
                },
                moment.nodes.len() - 1
            ),
        ),
        (GraphPart::Own, None) => neutral(
            "no loop of your own".to_owned(),
            "there is no loop of your own".to_owned(),
        ),
    }
}

/// The residual of an edge in words.
fn left(strain: &EdgeStrain) -> String {
    let [x, y, turn] = [0, 1, 2].map(|i| strain.residual[i]);
    let off_m = math::norm2(x, y);
    format!("residual {off_m:.3} m and {:.2}°", turn.abs().to_degrees())
}

fn numbers(moment: &LapState, part: GraphPart) -> Numbers {
    let truth = |node: usize| moment.runs.truth(moment.runs.graph.keyframe_tick(node));
    let off = |error: SE2, chi2| Numbers {
        error_m: position_error_m(&error, &SE2::identity()),
        error_deg: error.theta().abs().to_degrees(),
        chi2,
    };
    let lap = moment.runs.graph.lap();
    match find(moment, part) {
        Some(Found::Keyframe(node)) => {
            let edges = moment.edges_with_own();
            let touching = edges.filter(|edge| [edge.from, edge.to].contains(&node));
            let chi2 = touching.map(|edge| edge_strain(edge, &moment.nodes).chi2);
            off(truth(node).between(&moment.nodes[node]), chi2.sum())
        }
        Some(Found::Edge(edge)) => {
            let error = truth(edge.from)
                .between(&truth(edge.to))
                .between(&edge.measurement);
            off(error, edge_strain(edge, &moment.nodes).chi2)
        }
        Some(Found::Loop(attempt)) => {
            let error = lap.loop_error(attempt);
            let loop_ = &attempt.verification;
            let closed = moment
                .edges()
                .find(|edge| (edge.from, edge.to) == (loop_.candidate.node, loop_.from_node));
            Numbers {
                error_m: error.position_m,
                error_deg: error.heading_deg,
                // A rejected one has the χ² of its gate.
                chi2: closed.map_or(loop_.gate.chi2, |edge| {
                    edge_strain(edge, &moment.nodes).chi2
                }),
            }
        }
        Some(Found::Own) => {
            let own = moment.own.map(|own| (own, lap.loop_error(&own.attempt)));
            own.map_or(NONE, |(own, error)| Numbers {
                error_m: error.position_m,
                error_deg: error.heading_deg,
                chi2: if own.is_closed() {
                    edge_strain(&own.edge, &moment.nodes).chi2
                } else {
                    own.attempt.verification.gate.chi2
                },
            })
        }
        None => NONE,
    }
}

/// No values.
const NONE: Numbers = Numbers {
    error_m: f64::NAN,
    error_deg: f64::NAN,
    chi2: f64::NAN,
};

/// The verdict and the sentence on the custom loop.
pub fn own_statement(moment: &LapState, own: &OwnLoop) -> Statement {
    let lap = moment.runs.graph.lap();
    let judgement = lap.judge(&own.attempt);
    let verdict = match judgement {
        LoopJudgement::Right => "your loop accepted",
        LoopJudgement::FalseAcceptance => "your false loop accepted",
        LoopJudgement::Rejected => "your loop rejected",
    };
    let claim = match own.request.claim {
        Claim::Registered => "as registered",
        Claim::Truth => "as it truly is",
        Claim::SamePlace => "as “the same place”",
    };
    let gate = own.attempt.verification.gate;
    let side = if gate.passes() { "below" } else { "above" };
    let sentence = match &own.attempt.effect {
        None => format!("your {}; {claim}", lap.loop_sentence(&own.attempt)),
        Some(effect) => {
            let error = lap.loop_error(&own.attempt);
            let keeps = edge_strain(&own.edge, &own.poses).chi2;
            let how = match own.request.gate {
                GateUse::Bypassed if !gate.passes() => "let past the gate",
                _ => "accepted",
            };
            format!(
                "your loop {} {claim}, {how}, chi-squared {:.2} {side} {:.3}: history moved {:.2} m. \
                 The loop is {:.2} m and {:.1}° from the truth. \
                 The graph’s χ² goes from {:.1} to {:.1}: {keeps:.1} stay in your loop, {:.1} are in the other edges. \
                 The rms error over the keyframes goes from {:.2} m to {:.2} m",
                ends(&own.attempt),
                gate.chi2,
                gate.gate_chi2,
                effect.max_shift_m,
                error.position_m,
                error.heading_deg,
                effect.chi2.before,
                effect.chi2.after,
                effect.chi2.after - keeps,
                effect.keyframe_rms_m.before,
                effect.keyframe_rms_m.after,
            )
        }
    };
    Statement {
        standing: standing(judgement),
        verdict: verdict.to_owned(),
        sentence,
    }
}

/// Facts of the selected part and of the custom loop; not finite if there is none.
pub fn facts(moment: &LapState) -> Vec<Fact> {
    let looked_at = moment.picked.map_or(NONE, |part| numbers(moment, part));
    let own = moment.own;
    let effect = own.and_then(|own| own.attempt.effect);
    let of = |read: &dyn Fn(&OwnLoop) -> f64| own.map_or(f64::NAN, read);
    let of_effect = |read: &dyn Fn(&ch16_lab::lap::RecordedLoopEffect) -> f64| {
        effect.as_ref().map_or(f64::NAN, read)
    };
    let own_gate = of(&|own| own.attempt.verification.gate.chi2);
    let before = of_effect(&|effect| effect.chi2.before);
    let after = of_effect(&|effect| effect.chi2.after);
    vec![
        Fact::metres(
            "looked_at_error_m",
            "selected: position error",
            looked_at.error_m,
        ),
        Fact::new("looked_at_chi2", "selected: χ²", looked_at.chi2, "", 3),
        Fact::new("own_gate_chi2", "your loop: gate χ²", own_gate, "", 2),
        Fact::new("own_chi2_before", "your loop: χ² before", before, "", 2),
        Fact::new("own_chi2_after", "your loop: χ² after", after, "", 2),
        Fact::metres(
            "own_shift_m",
            "your loop: history moved",
            of_effect(&|effect| effect.max_shift_m),
        ),
        Fact::metres(
            "own_rms_before_m",
            "your loop: keyframe rms before",
            of_effect(&|effect| effect.keyframe_rms_m.before),
        ),
        Fact::metres(
            "own_rms_after_m",
            "your loop: keyframe rms after",
            of_effect(&|effect| effect.keyframe_rms_m.after),
        ),
    ]
}
