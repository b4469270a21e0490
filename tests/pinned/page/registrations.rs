//! The page's claims about convergence agree with w16.1.

use ch16_lab::basin::Minimum;
use widget_kit::model::Assessment;

use super::figures;
use super::widgets::Widgets;

/// Names of basins in the text, and the settings of the widget.
const BASINS: [(&str, &str); 4] = [
    ("basin.p2p", "variant=point-to-point"),
    ("basin.p2p.patient", "variant=point-to-point&limit=200"),
    (
        "basin.p2p.patient.wide",
        "variant=point-to-point&limit=200&tau=1.4",
    ),
    ("basin.p2l", "variant=point-to-plane"),
];

#[test]
fn the_widget_converges_at_both_printed_edges_and_not_one_degree_beyond() {
    let mut widgets = Widgets::new();
    let mut verdict = |state: &str, heading: f64| {
        let state = format!("{state}&dx=0&dy=0&heading={heading}");
        let outcome = widgets.set("w16.1", &state).outcome();
        (outcome.standing, outcome.verdict)
    };
    let home = (Assessment::Good, Minimum::Right.name().to_owned());
    for (basin, state) in BASINS {
        for (edge, outwards) in [("from_deg", -1.0), ("to_deg", 1.0)] {
            let name = format!("{basin}.{edge}");
            let heading = figures::value(&name).expect("the page prints it");
            assert_eq!(verdict(state, heading), home, "{name}: {heading}°");
            let beyond = heading + outwards;
            assert_ne!(verdict(state, beyond), home, "{name}: {beyond}°");
        }
    }
}
