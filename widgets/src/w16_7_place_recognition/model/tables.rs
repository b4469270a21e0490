//! The tables: the detectors beside the picture, all pairs for the export.

use ch16_lab::lap::NamedChoice;
use ch16_lab::places::GRADED;
use widget_kit::model::Table;

use super::PlaceRecognition;

/// The tables beside the picture.
pub fn shown(been: &PlaceRecognition) -> Vec<Table> {
    vec![detectors(been)]
}

/// All tables, the shown ones first.
pub fn all(been: &PlaceRecognition) -> Vec<Table> {
    let mut tables = shown(been);
    tables.push(pairs(been));
    tables
}

fn detectors(been: &PlaceRecognition) -> Table {
    let rows = been.places.iter().flat_map(|places| {
        let detectors = GRADED.iter().enumerate().map(|(k, detector)| {
            let threshold = been.threshold(k);
            let grade = places.graded_at(k, threshold);
            let point = grade.point(threshold);
            vec![
                detector.label().to_owned(),
                grade.called.to_string(),
                grade.right.to_string(),
                share(point.map(|point| point.precision)),
                share(point.map(|point| point.recall)),
                share(places.curves[k].precision_at_fixed_recall()),
            ]
        });
        let bound = |name: &str, called: f64, half: f64| {
            let none = || "–".to_owned();
            let called = share(Some(called));
            vec![
                name.to_owned(),
                none(),
                none(),
                called,
                none(),
                share(Some(half)),
            ]
        };
        let called = places.graded_at(been.detector(), been.threshold(been.detector()));
        let chance = places.chance();
        detectors.chain([
            bound("a guess", chance, chance),
            bound("a perfect detector", places.perfect(called.called), 1.0),
        ])
    });
    Table::shown(
        "detectors",
        "The detectors at this threshold",
        &[
            "compared by",
            "called",
            "right",
            "precision",
            "recall",
            "precision at recall 0.5",
        ],
        rows.collect(),
    )
}

fn share(share: Option<f64>) -> String {
    share.map_or("–".to_owned(), |share| format!("{share:.2}"))
}

fn pairs(been: &PlaceRecognition) -> Table {
    let rows = been.places.iter().flat_map(|places| {
        places.study.pairs().iter().map(|pair| {
            let [old, new] = pair.nodes;
            let mut row = vec![old.to_string(), new.to_string()];
            row.extend(pair.distances.map(|distance| distance.to_string()));
            row.push(u8::from(pair.is_same).to_string());
            row.push(u8::from(places.study.is_loop(pair.nodes)).to_string());
            row
        })
    });
    let head = [
        "older",
        "newer",
        "nearness (deviations)",
        "ranges (χ²)",
        "Scan Context",
        "same place",
        "graded",
    ];
    Table::exported("pairs", "Every pair of keyframes", &head, rows.collect())
}
