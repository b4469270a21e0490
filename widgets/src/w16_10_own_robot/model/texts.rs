//! The result in words and numbers.

use log_messages::{KeyframeReport, LoopDecision, LoopReport, Stage};
use pr_geom::math;
use widget_kit::model::{Assessment, Fact, Outcome};
use widget_kit::plural::plural;

use super::OwnRobot;
use super::log_state::LogState;
use super::wheels::end_m;

/// The privacy statement about the reader's file.
const STAYS: &str = "The file stays in this browser; none of it is sent anywhere.";

/// The current result.
pub fn outcome(own: &OwnRobot) -> Outcome {
    let robot = &own.robot;
    let (standing, verdict) = match robot.progress.stage {
        Stage::Empty => (Assessment::Neutral, "no log yet"),
        Stage::Failed => (Assessment::Bad, "no map"),
        _ if robot.paused => (Assessment::Neutral, "held"),
        Stage::Opening => (Assessment::Neutral, "opening"),
        Stage::Reading => (Assessment::Neutral, "reading"),
        Stage::Finishing => (Assessment::Neutral, "closing the last loops"),
        Stage::Solving => (Assessment::Neutral, "solving"),
        Stage::Checking => (Assessment::Neutral, "checking"),
        _ if robot.is_under_way() => (Assessment::Neutral, "looking for the robot"),
        Stage::Done => return described(own, standing(robot), verdict_on_loops(robot)),
    };
    described(own, standing, verdict.to_owned())
}

fn described(own: &OwnRobot, standing: Assessment, verdict: String) -> Outcome {
    Outcome {
        standing,
        verdict,
        sentence: sentence(own),
        facts: facts(own),
    }
}

fn standing(robot: &LogState) -> Assessment {
    match to_look_into(robot) {
        0 if robot.doubts.is_empty() => Assessment::Good,
        0 => Assessment::Neutral,
        _ => Assessment::Doubtful,
    }
}

fn verdict_on_loops(robot: &LogState) -> String {
    match (to_look_into(robot), in_graph(robot)) {
        (_, 0) => "mapped".to_owned(),
        (0, all) => format!("none of {} in doubt", plural(all, "loop")),
        (some, all) => format!("{some} of {} in doubt", plural(all, "loop")),
    }
}

fn in_graph(robot: &LogState) -> usize {
    robot
        .links
        .iter()
        .filter(|link| link.decision.is_in_graph())
        .count()
}

/// Loops of the graph that the rest of it contradicts, and that the reader has not accepted.
fn to_look_into(robot: &LogState) -> usize {
    let links = robot.links.iter();
    let open =
        links.filter(|link| link.is_contradicted() && link.decision != LoopDecision::Confirmed);
    open.count()
}

fn sentence(own: &OwnRobot) -> String {
    let robot = &own.robot;
    let name = &robot.name;
    // A robot that drives has no end in sight.
    let done = if robot.progress.share.is_nan() {
        "driving".to_owned()
    } else {
        format!("{:.0}% done", (100.0 * robot.progress.share).round())
    };
    let progress = match robot.progress.stage {
        Stage::Empty => {
            "Open a log, drop one, or map the sample, a simulated ring of corridors.".to_owned()
        }
        Stage::Failed if robot.answer.is_empty() => return robot.progress.problem.clone(),
        Stage::Failed => {
            return format!(
                "{}. {}",
                robot.progress.problem.trim_end_matches('.'),
                robot.answer
            );
        }
        Stage::Opening => format!("{name} is being opened."),
        Stage::Reading => format!(
            "{name}: {done}, {}, {}, {} closed.",
            plural(robot.progress.scans, "scan"),
            plural(robot.keyframes.len(), "keyframe"),
            plural(robot.progress.closed, "loop")
        ),
        Stage::Finishing => format!("{name}: {done}, closing the last loops."),
        Stage::Solving => format!(
            "{name} is solved: {}.",
            plural(robot.keyframes.len(), "pose")
        ),
        Stage::Checking | Stage::Done => finished(robot),
    };
    let held = if robot.paused { " It is paused." } else { "" };
    let answer = match robot.answer.as_str() {
        "" => String::new(),
        answer => format!(" {answer}"),
    };
    let grade = robot.grade.as_ref();
    let grade = grade.map_or(String::new(), |grade| format!(" {}.", grade.words));
    let visitor = visitor(own);
    format!("{progress}{held}{grade}{visitor}{answer} {STAYS}")
}

/// The state of the other log's robot: overall, and at the current scan.
fn visitor(own: &OwnRobot) -> String {
    let Some(other) = &own.robot.other_log else {
        return String::new();
    };
    let name = &other.name;
    let Some((_, shown)) = own.place() else {
        let why = other.remarks.first().map_or("", String::as_str);
        return if other.is_over {
            format!(" {why}.")
        } else {
            format!(" {name} is being localized on the map.")
        };
    };
    let [.., doubtful, lost] = other.counts;
    let first = if let Some(first) = other.first {
        format!("is found at scan {first}")
    } else if other.is_over {
        "is not found on this map".to_owned()
    } else {
        "is not found yet".to_owned()
    };
    let done = if other.is_over {
        String::new()
    } else {
        format!(", {:.0}% done", (100.0 * other.share).floor())
    };
    let scans = other.localized() + doubtful + lost;
    let [x, y, theta] = shown.pose;
    let at = if x.is_finite() {
        let sigma_m = shown.ellipse[0];
        let known = if sigma_m.is_finite() {
            format!(", known to {sigma_m:.2} m")
        } else {
            String::new()
        };
        format!(
            " at x {x:.1} m, y {y:.1} m, turned {:.0}°{known}",
            theta.to_degrees()
        )
    } else {
        String::new()
    };
    format!(
        " The robot of {name} {first}{done}: of {scans} scans, {} are localized, {doubtful} doubtful, {lost} lost. At scan {} it is {}{at}.",
        other.localized(),
        shown.scan,
        shown.state.name()
    )
}

fn finished(robot: &LogState) -> String {
    let closed = in_graph(robot);
    let contradicted = robot.links.iter().filter(|link| link.is_contradicted());
    let contradicted = contradicted.count();
    let accepted = match contradicted - to_look_into(robot) {
        0 => String::new(),
        some => format!(", {some} accepted by you"),
    };
    let doubted = match contradicted {
        0 if robot.doubts.is_empty() => "no loop contradicts the graph".to_owned(),
        0 => "no loop contradicts the graph, but the list of doubts is not empty".to_owned(),
        1 => format!("one loop contradicts the graph{accepted}"),
        many => format!("{many} loops contradict the graph{accepted}"),
    };
    let source = if robot.has_scans {
        format!(
            "{} became {}",
            plural(robot.progress.scans, "scan"),
            plural(robot.keyframes.len(), "keyframe")
        )
    } else {
        plural(robot.keyframes.len(), "pose")
    };
    let path_m = path_length_m(robot);
    let first = match end_m(robot) {
        Some(off_m) => {
            format!("after {path_m:.0} m the wheels alone are {off_m:.1} m out. {source}")
        }
        None => format!("{source} on a path of {path_m:.0} m"),
    };
    format!(
        "{}: {first}. It holds {}; {doubted}.",
        robot.name,
        plural(closed, "loop")
    )
}

/// Path length over the keyframes, m.
fn path_length_m(robot: &LogState) -> f64 {
    let steps = robot.keyframes.windows(2);
    let steps = steps.map(|two| {
        let [a, b] = [two[0].pose, two[1].pose];
        math::norm2(b[0] - a[0], b[1] - a[1])
    });
    // The empty sum is -0.
    steps.fold(0.0, |sum, step| sum + step)
}

/// A loop with its evidence.
pub fn evidence(link: &LoopReport) -> String {
    let why = match link.reason.as_str() {
        "" => String::new(),
        reason => format!(", because {reason}"),
    };
    let fits = if link.share.is_finite() {
        format!(
            "; {:.2} of the scan fits, {:.3} m off",
            link.share, link.rmse_m
        )
    } else {
        String::new()
    };
    let chi2 = if link.chi2.is_finite() {
        format!("; χ² {:.1} of {:.1}", link.chi2, link.gate_chi2)
    } else {
        String::new()
    };
    format!(
        "The listed loop goes from keyframe {} to {}: {}{why}{fits}{chi2}.",
        link.new,
        link.old,
        verdict(link)
    )
}

/// The decision on a loop.
pub fn verdict(link: &LoopReport) -> &'static str {
    match link.decision {
        LoopDecision::Closed => "closed",
        LoopDecision::Rejected => "rejected",
        LoopDecision::Removed => "rejected by you",
        LoopDecision::Added => "closed by you",
        LoopDecision::Confirmed => "accepted by you",
    }
}

fn facts(own: &OwnRobot) -> Vec<Fact> {
    let robot = &own.robot;
    let count = |of: &dyn Fn(&LoopReport) -> bool| {
        let links = robot.links.iter().filter(|link| of(link)).count();
        links as f64
    };
    let sigmas = robot.keyframes.iter().map(|keyframe| keyframe.sigma_m);
    let worst_m = sigmas.filter(|s| s.is_finite()).fold(f64::NAN, f64::max);
    let shown = robot.keyframes.get(own.keyframe());
    let of_shown = |of: fn(&KeyframeReport) -> f64| shown.map_or(f64::NAN, of);
    let grade_m = robot.grade.as_ref().map_or(f64::NAN, |grade| grade.error_m);
    let done = 100.0 * robot.progress.share;
    let mut facts = vec![
        Fact::count("done_percent", "done, %", done.floor()),
        Fact::count("scans", "scans", robot.progress.scans as f64),
        Fact::count("keyframes", "keyframes", robot.keyframes.len() as f64),
        Fact::new("path_length_m", "path", path_length_m(robot), "m", 1),
        Fact::count("loops", "loops in the graph", in_graph(robot) as f64),
        Fact::count(
            "loops_rejected",
            "loops not in the graph",
            count(&|link| !link.decision.is_in_graph()),
        ),
        Fact::count(
            "loops_doubted",
            "loops in doubt",
            to_look_into(robot) as f64,
        ),
        Fact::metres("worst_sigma_m", "largest σ", worst_m),
        Fact::metres("error_m", "error against the reference", grade_m),
        Fact::new("fit", "scan shown: fits", of_shown(|k| k.fit), "", 2),
        Fact::metres("sigma_m", "keyframe shown: σ", of_shown(|k| k.sigma_m)),
    ];
    if let Some(other) = &robot.other_log {
        let [.., doubtful, lost] = other.counts;
        facts.extend(
            [
                ("where_localized", "other log: localized", other.localized()),
                ("where_doubtful", "other log: doubtful", doubtful),
                ("where_lost", "other log: lost", lost),
            ]
            .map(|(id, label, count)| Fact::count(id, label, count as f64)),
        );
    }
    facts
}

/// The picture in words.
pub fn summary(own: &OwnRobot) -> String {
    let robot = &own.robot;
    if robot.keyframes.is_empty() {
        return "An empty map, waiting for a robot's log.".to_owned();
    }
    let shown = own.keyframe();
    let [x, y, theta] = robot.keyframes[shown].pose;
    let link = own.link().map(|link| evidence(&robot.links[link]));
    // After a step to this loop the result describes it.
    let link = link.filter(|link| *link != robot.answer);
    format!(
        "A map with the robot’s path. Keyframe {shown} is shown, at x {x:.1} m, y {y:.1} m, turned {:.0}°.{}",
        theta.to_degrees(),
        link.map_or_else(String::new, |link| format!(" {link}"))
    )
}
