//! The page's own drawings: consistent with the Apartment, and with the marks of the legend.

use ch16_lab::lap::{LapConfig, LapRunner};

use super::document::{page_style, source};

#[test]
fn the_plan_marks_where_the_lap_starts_and_where_it_closes_its_first_loop() {
    let record = LapRunner::new().run(&LapConfig::default());
    let first = record.lap.loop_attempts().next().expect("it closes loops");
    let nodes = [0, first.verification.from_node];
    let page = source("index.html");
    let marked: Vec<Vec<f64>> = page
        .split("<circle class=\"start\"")
        .skip(1)
        .map(|rest| {
            let attributes = rest.split('"').skip(1).step_by(2).take(2);
            attributes.map(|value| value.parse().unwrap()).collect()
        })
        .collect();
    let places = nodes.map(|node| record.lap.keyframes[node].truth.translation());
    assert_eq!(marked.len(), places.len());
    for (mark, place) in marked.iter().zip(places) {
        // 1 cm: a fourteenth of the mark.
        let off_m = (mark[0] - place.x).abs().max((mark[1] - place.y).abs());
        assert!(off_m < 0.01, "{mark:?} is at {place}");
    }
}

#[test]
fn every_drawing_uses_the_mark_that_belongs_to_its_colour() {
    let style = page_style();
    let mut marks = 0;
    // `.nodes rect { fill: var(--posterior); }`: a group of a drawing and its shape.
    for rule in style.lines().filter(|line| line.starts_with('.')) {
        let Some((selector, declarations)) = rule.split_once(" { ") else {
            continue;
        };
        let shape = selector.rsplit(' ').next().unwrap_or_default();
        for (tone, mark) in [
            ("prior", "circle"),
            ("measurement", "path"),
            ("posterior", "rect"),
        ] {
            if declarations.contains(&format!("var(--{tone})")) && selector.contains(' ') {
                assert_eq!(shape, mark, "{rule}");
                marks += 1;
            }
        }
    }
    assert_eq!(
        marks, 7,
        "sweep points, map points, poses, loop edge and its cross, errors without and with loops"
    );
}
