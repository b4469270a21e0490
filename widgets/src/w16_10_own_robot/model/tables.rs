//! The tables: loops with their evidence and doubts beside the picture; all keyframes and all loops for the
//! export.

use log_messages::LoopReport;
use widget_kit::model::{Table, TablePlace};

use super::OwnRobot;
use super::texts::verdict;
use crate::w16_10_own_robot::spec::RECORDING_OPTIONS;

/// Rows of loops beside the picture.
const SHOWN_LOOPS: usize = 8;
/// Sentences beside the picture.
const SHOWN_SENTENCES: usize = 8;

/// All tables, the shown ones first.
pub fn all(own: &OwnRobot) -> Vec<Table> {
    let mut tables = shown(own);
    tables.push(every_loop(own));
    tables.push(keyframes(own));
    tables.extend(places(own));
    tables
}

/// Those beside the picture.
pub fn shown(own: &OwnRobot) -> Vec<Table> {
    let robot = &own.robot;
    let mut tables = vec![loops(own)];
    tables.extend(sentences("doubts", "Doubts about the map", &robot.doubts));
    tables.extend(sentences("remarks", "About the log", &robot.remarks));
    if let Some(other) = &robot.other_log {
        let title = format!("About {}", other.name);
        tables.extend(sentences("remarks-where", &title, &other.remarks));
    }
    tables.extend(offers(own));
    tables
}

/// A number with so many digits, a dash where there is none.
fn number(value: f64, decimals: usize) -> String {
    if value.is_finite() {
        format!("{value:.decimals$}")
    } else {
        "–".to_owned()
    }
}

/// The loops around the one that is shown, and the whole evidence of that one.
fn loops(own: &OwnRobot) -> Table {
    let links = &own.robot.links;
    let chosen = own.link().unwrap_or_default();
    let first = chosen.saturating_sub(SHOWN_LOOPS / 2);
    let first = first.min(links.len().saturating_sub(SHOWN_LOOPS));
    let near = links.iter().enumerate().skip(first).take(SHOWN_LOOPS);
    let rows = near.map(|(index, link)| {
        let mark = if index == chosen { "▸ " } else { "" };
        vec![
            format!("{mark}{index}"),
            format!("{} to {}", link.new, link.old),
            number(link.share, 2),
            number(link.rmse_m, 3),
            number(link.margin, 2),
            number(link.chi2, 1),
            verdict(link).to_owned(),
        ]
    });
    let why = links.get(chosen).map_or("", |link| link.reason.as_str());
    let title = match (links.len(), why) {
        (0, _) => "Loops: none yet".to_owned(),
        (count, "") => format!("Loops {first} to {} of {count}", last_of(first, count)),
        (_, why) => format!("Loop {chosen}: {why}"),
    };
    Table {
        id: "loops",
        title,
        columns: ["loop", "ends", "fits", "off (m)", "margin", "χ²", "verdict"]
            .map(str::to_owned)
            .to_vec(),
        rows: rows.collect(),
        place: TablePlace::Shown,
    }
}

fn last_of(first: usize, count: usize) -> usize {
    (first + SHOWN_LOOPS).min(count) - 1
}

fn sentences(id: &'static str, title: &str, lines: &[String]) -> Option<Table> {
    let mut rows: Vec<Vec<String>> = lines
        .iter()
        .take(SHOWN_SENTENCES)
        .map(|sentence| vec![sentence.clone()])
        .collect();
    let more = lines.len().saturating_sub(SHOWN_SENTENCES);
    if more > 0 {
        rows.push(vec![format!("and {more} more in the report")]);
    }
    (!rows.is_empty()).then(|| Table {
        id,
        title: title.to_owned(),
        columns: vec![String::new()],
        rows,
        place: TablePlace::Shown,
    })
}

/// What the recording has several of.
fn offers(own: &OwnRobot) -> Option<Table> {
    let several = own
        .robot
        .offers
        .iter()
        .filter(|offer| offer.names.len() > 1);
    let rows: Vec<Vec<String>> = several
        .map(|offer| {
            let names = offer.names.iter().filter(|name| **name != offer.taken);
            let others: Vec<&str> = names.take(SHOWN_SENTENCES).map(String::as_str).collect();
            let label = RECORDING_OPTIONS
                .iter()
                .find(|(name, ..)| *name == offer.option);
            let label = label.map_or("", |(.., label)| label);
            vec![label.to_owned(), offer.taken.clone(), others.join(", ")]
        })
        .collect();
    (!rows.is_empty()).then(|| Table {
        id: "offers",
        title: "Topics and frames to choose from".to_owned(),
        columns: ["", "taken", "others"].map(str::to_owned).to_vec(),
        rows,
        place: TablePlace::Shown,
    })
}

/// Every scan of the other log.
fn places(own: &OwnRobot) -> Option<Table> {
    let other = own.robot.other_log.as_ref()?;
    let rows = other.places.iter().map(|place| {
        let [x, y, theta] = place.pose;
        vec![
            place.scan.to_string(),
            place.stamp_s.to_string(),
            place.state.name().to_owned(),
            number(x, 4),
            number(y, 4),
            number(theta, 5),
            number(place.fit, 3),
            number(place.ellipse[0], 4),
        ]
    });
    Some(Table {
        id: "where",
        title: "Every scan of the other log".to_owned(),
        columns: [
            "scan",
            "time (s)",
            "verdict",
            "x (m)",
            "y (m)",
            "heading (rad)",
            "share that fits",
            "σ (m)",
        ]
        .map(str::to_owned)
        .to_vec(),
        rows: rows.collect(),
        place: TablePlace::ExportOnly,
    })
}

fn every_loop(own: &OwnRobot) -> Table {
    let row = |link: &LoopReport| {
        vec![
            link.new.to_string(),
            link.old.to_string(),
            number(link.share, 3),
            number(link.rmse_m, 4),
            number(link.points, 0),
            number(link.margin, 3),
            number(link.chi2, 2),
            number(link.gate_chi2, 2),
            verdict(link).to_owned(),
            link.reason.clone(),
        ]
    };
    Table {
        id: "all-loops",
        title: "Every loop with its evidence".to_owned(),
        columns: [
            "from",
            "to",
            "share that fits",
            "off (m)",
            "points",
            "margin",
            "χ²",
            "gate",
            "verdict",
            "why",
        ]
        .map(str::to_owned)
        .to_vec(),
        rows: own.robot.links.iter().map(row).collect(),
        place: TablePlace::ExportOnly,
    }
}

fn keyframes(own: &OwnRobot) -> Table {
    let keyframes = own.robot.keyframes.iter().enumerate();
    let rows = keyframes.map(|(k, keyframe)| {
        let [x, y, theta] = keyframe.pose;
        vec![
            k.to_string(),
            keyframe.stamp_s.to_string(),
            x.to_string(),
            y.to_string(),
            theta.to_string(),
            number(keyframe.fit, 3),
            number(keyframe.sigma_m, 4),
            number(own.robot.error_m(k), 4),
        ]
    });
    Table {
        id: "keyframes",
        title: "Every keyframe".to_owned(),
        columns: [
            "keyframe",
            "time (s)",
            "x (m)",
            "y (m)",
            "heading (rad)",
            "share that fits",
            "σ (m)",
            "error (m)",
        ]
        .map(str::to_owned)
        .to_vec(),
        rows: rows.collect(),
        place: TablePlace::ExportOnly,
    }
}
