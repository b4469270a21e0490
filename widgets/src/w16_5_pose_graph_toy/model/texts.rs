//! The result in words and numbers.

use ch16_slam2d::graph::{EdgeKind, EdgeView};
use widget_kit::model::{Assessment, Fact, Outcome};

use super::PoseGraphToy;

use crate::w16_5_pose_graph_toy::spec::PINNED;

/// Costs that differ by a smaller share are called the same.
const ALIKE: f64 = 0.01;

/// `2 to 3`, as the poses are numbered on screen.
pub fn ends(edge: &EdgeView) -> String {
    format!("{} to {}", edge.from.index() + 1, edge.to.index() + 1)
}

/// The kind of an edge.
pub fn kind(edge: &EdgeView) -> &'static str {
    match edge.edge.kind {
        EdgeKind::Odometry => "odometry",
        EdgeKind::Loop => "loop",
    }
}

/// Good is a converged graph; without a fixed pose its location is arbitrary.
pub fn standing(toy: &PoseGraphToy) -> Assessment {
    if toy.course.failed {
        Assessment::Bad
    } else if toy.step() == toy.course.last() {
        Assessment::Good
    } else {
        Assessment::Neutral
    }
}

fn is_pinned(toy: &PoseGraphToy) -> bool {
    toy.values.get(&PINNED)
}

pub fn outcome(toy: &PoseGraphToy) -> Outcome {
    let (shown, step) = (toy.shown(), toy.step());
    let last = toy.course.last();
    let before = &toy.course.moments[step.saturating_sub(1)];
    let verdict = match (step == last, is_pinned(toy)) {
        _ if toy.course.failed => "no step possible",
        (true, true) => "at rest",
        (true, false) => "at rest, anywhere",
        (false, _) => "springs pull",
    };
    let worst = worst(toy);
    let start = toy.course.moments[0].chi2;
    let sentence = if step == 0 {
        format!("before the first step χ² is {start:.3}; {worst}")
    } else if step == last {
        format!(
            "χ² falls from {start:.3} to {:.3}. At rest, {worst}",
            shown.chi2
        )
    } else {
        let [was, is] = [before.chi2, shown.chi2].map(|chi2| format!("{chi2:.3}"));
        let change = if was == is {
            format!("leaves χ² at {is}")
        } else {
            format!("takes χ² from {was} to {is}")
        };
        format!(
            "step {step} of {last} {change}. It moves a pose by {:.2} m + rad at most; {worst}",
            shown.moved
        )
    };
    let floats = if is_pinned(toy) {
        ""
    } else {
        "; no pose is pinned, and χ² is the same wherever the graph is"
    };
    let mut facts = vec![
        Fact::new("chi2", "χ²", shown.chi2, "", 3),
        Fact::new("chi2_start", "χ² before the first step", start, "", 3),
        Fact::new(
            "chi2_rest",
            "χ² at rest",
            toy.course.moments[last].chi2,
            "",
            3,
        ),
        Fact::count("steps_to_rest", "steps to rest", last as f64),
        Fact::new("moved", "moved by the last step", shown.moved, "m + rad", 3),
    ];
    let end = shown.poses[shown.poses.len() - 1];
    facts.push(Fact::metres("last_x_m", "last pose: x", end.x()));
    facts.push(Fact::metres("last_y_m", "last pose: y", end.y()));
    Outcome {
        standing: standing(toy),
        verdict: verdict.to_owned(),
        sentence: format!("{sentence}{floats}"),
        facts,
    }
}

/// Where the cost is: most of it in one spring, a largest part, or the same part in several.
fn worst(toy: &PoseGraphToy) -> String {
    let shown = toy.shown();
    let costs = toy.course.edges.iter().zip(&shown.edge_chi2);
    let Some((edge, chi2)) = costs.max_by(|(_, a), (_, b)| a.total_cmp(b)) else {
        return String::new();
    };
    let alike = |other: &&f64| **other > (1.0 - ALIKE) * chi2;
    let share = if *chi2 > 0.5 * shown.chi2 {
        "most of it"
    } else {
        match shown.edge_chi2.iter().filter(alike).count() {
            1 => "the largest share",
            count if count == shown.edge_chi2.len() => {
                return format!("every spring has the same share, {chi2:.3}");
            }
            count => return format!("{count} springs have the largest share, {chi2:.3} each"),
        }
    };
    format!(
        "{share}, {chi2:.3}, is in the {} from {}",
        kind(edge),
        ends(edge)
    )
}

pub fn summary(toy: &PoseGraphToy) -> String {
    let poses = toy.shown().poses.iter().enumerate();
    let poses = poses.map(|(k, pose)| {
        format!(
            "pose {} at x {:.2} m, y {:.2} m, turned {:.0}°",
            k + 1,
            pose.x(),
            pose.y(),
            pose.theta().to_degrees()
        )
    });
    let poses: Vec<_> = poses.collect();
    format!(
        "A pose graph of {} poses and {} springs. {}.",
        toy.shown().poses.len(),
        toy.course.edges.len(),
        poses.join("; ")
    )
}
