//! A reader's function in the seams of the estimator: what the worker answers, the widget shows.

use std::sync::Arc;

use ch16_lab::reader_code::{ANSWERS, Callable, Executor, KeepPairs, SEAT};
use ch16_slam2d::chapter::path_information;
use ch16_slam2d::icp::{Increment, Pair, svd_align};
use ch16_slam2d::loops::{InnovationGate, LoopConfig, chi_squared_gate};
use nalgebra::Vector3;
use pr_geom::{Point2, SE2};
use widget_kit::host_messages::Delivery;
use widget_kit::model::{Activity, Model};
use widget_kit::scene::{Layer, RasterCell};
use widgets::w16_1_basin_explorer::model::{BasinExplorer, panel};
use widgets::w16_2_full_lap::model::FullLap;

use crate::support::{fact, panel_of};

/// Our functions, as a reader would write them.
struct Ours;

impl Increment for Ours {
    fn increment(&self, pairs: &[Pair]) -> SE2 {
        let points = |of: fn(&Pair) -> Point2<f64>| pairs.iter().map(of).collect::<Vec<_>>();
        svd_align(&points(|pair| pair.source), &points(|pair| pair.target))
    }
}

impl InnovationGate for Ours {
    fn chi2(&self, innovation: &Vector3<f64>, gap: usize, config: &LoopConfig) -> f64 {
        chi_squared_gate(innovation, &path_information(gap, config), config.gate_chi2).chi2
    }
}

impl KeepPairs for Ours {
    fn dropped(&self, lengths_m: &[f64], trim: f64) -> Vec<usize> {
        let mut sorted = lengths_m.to_vec();
        sorted.sort_by(f64::total_cmp);
        let kept = ((1.0 - trim) * sorted.len() as f64).ceil().max(1.0);
        let longest_m = sorted[kept as usize - 1];
        let pairs = (0..lengths_m.len()).filter(|&index| lengths_m[index] > longest_m);
        pairs.collect()
    }
}

/// A step without its turn, a gate that rejects everything, and a rejection that drops the shortest pairs.
struct Wrong;

impl KeepPairs for Wrong {
    fn dropped(&self, lengths_m: &[f64], _: f64) -> Vec<usize> {
        let mut by_length: Vec<usize> = (0..lengths_m.len()).collect();
        by_length.sort_by(|&a, &b| lengths_m[a].total_cmp(&lengths_m[b]));
        by_length.truncate(lengths_m.len() / 2);
        by_length.sort_unstable();
        by_length
    }
}

impl Increment for Wrong {
    fn increment(&self, pairs: &[Pair]) -> SE2 {
        let step = Ours.increment(pairs);
        SE2::new(step.x(), step.y(), 0.0)
    }
}

impl InnovationGate for Wrong {
    fn chi2(&self, _: &Vector3<f64>, _: usize, _: &LoopConfig) -> f64 {
        f64::INFINITY
    }
}

fn deliver(model: &mut dyn Model, kind: &str, text: &str, numbers: &[f64]) {
    model.receive(&Delivery {
        kind,
        text,
        numbers,
        bytes: &[],
    });
}

/// Executes every order of the widget, and lets it work, until there is none. Returns the number of orders.
fn serve(model: &mut dyn Model, function: &Arc<dyn Callable>) -> usize {
    let mut executor = Executor::default();
    let mut count = 0;
    loop {
        model.finish_work();
        let mut orders = model.take_requests();
        while orders.is_empty() && model.work() == Activity::Busy {
            orders = model.take_requests();
        }
        if orders.is_empty() {
            return count;
        }
        for order in orders {
            count += 1;
            let mut job = executor.begin(&order, function).unwrap();
            let answers = loop {
                if let Some(answers) = job.step() {
                    break answers;
                }
            };
            deliver(model, ANSWERS, &order, &answers);
        }
    }
}

fn facts(model: &dyn Model) -> Vec<u64> {
    let facts = model.outcome().facts;
    facts.iter().map(|fact| fact.value.to_bits()).collect()
}

#[test]
fn the_registration_by_the_readers_function_has_the_bits_of_ours() {
    let function: Arc<dyn Callable> = Arc::new(Ours);
    let mut model = BasinExplorer::default();
    let ours = facts(&model);
    deliver(&mut model, SEAT, "svd_align", &[]);
    assert_ne!(
        facts(&model),
        ours,
        "until the answers are here, the source stands"
    );
    assert_eq!(serve(&mut model, &function), 1);
    assert_eq!(facts(&model), ours);
    let title = panel_of(&model, panel::SWEEPS).title;
    assert!(title.starts_with("Your svd_align, 0 of "), "{title}");
    let sentence = model.outcome().sentence;
    assert!(
        sentence.contains("your svd_align ends") && sentence.contains("Ours ends"),
        "{sentence}"
    );
    model.set("heading", 60.0).unwrap();
    serve(&mut model, &function);
    let turned = facts(&model);
    deliver(&mut model, SEAT, "", &[]);
    assert_eq!(facts(&model), turned);
    assert!(
        !model.outcome().sentence.contains("your"),
        "ours drives again"
    );
}

#[test]
fn a_wrong_function_is_shown_beside_ours() {
    let mut model = BasinExplorer::default();
    let right = fact(&model, "error_deg").abs();
    deliver(&mut model, SEAT, "svd_align", &[]);
    serve(&mut model, &(Arc::new(Wrong) as Arc<dyn Callable>));
    // It never turns, so the 25° of the start remain.
    assert!(right < 1.0 && (fact(&model, "error_deg") - 25.0).abs() < 1e-6);
    let legend = panel_of(&model, panel::SWEEPS).legend;
    assert!(legend.iter().any(|entry| entry.label == "where ours ends"));
}

#[test]
fn of_many_changes_only_the_newest_is_registered() {
    let function: Arc<dyn Callable> = Arc::new(Ours);
    let mut model = BasinExplorer::default();
    deliver(&mut model, SEAT, "svd_align", &[]);
    for heading in 0..50 {
        model.set("heading", f64::from(heading)).unwrap();
    }
    assert_eq!(serve(&mut model, &function), 2, "the first, and the newest");
    let mut ours = BasinExplorer::default();
    ours.set("heading", 49.0).unwrap();
    assert_eq!(facts(&model), facts(&ours));
}

#[test]
fn the_other_variant_is_driven_by_ours() {
    let function: Arc<dyn Callable> = Arc::new(Wrong);
    let mut model = BasinExplorer::default();
    deliver(&mut model, SEAT, "svd_align", &[]);
    // The answers to the first order come after the change.
    model.set("variant", 1.0).unwrap();
    serve(&mut model, &function);
    let mut ours = BasinExplorer::default();
    ours.set("variant", 1.0).unwrap();
    assert_eq!(facts(&model), facts(&ours));
}

fn raster(model: &BasinExplorer, panel: &str) -> Arc<[RasterCell]> {
    let layers = panel_of(model, panel).layers;
    let raster = layers.into_iter().find_map(|layer| match layer {
        Layer::Raster(raster) => Some(raster.cells),
        _ => None,
    });
    raster.expect("the map is shown")
}

/// The threads of the sweeps: from each point to its partner.
fn pair_lines(model: &BasinExplorer) -> Vec<[[f64; 2]; 2]> {
    let layers = panel_of(model, panel::SWEEPS).layers;
    let lines = layers.into_iter().find_map(|layer| match layer {
        Layer::Threads { threads, .. } => Some(threads),
        _ => None,
    });
    lines.expect("the pairs are drawn")
}

#[test]
fn the_basin_map_by_the_readers_function_has_the_cells_of_ours() {
    let mut ours = BasinExplorer::default();
    ours.set("more", 1.0).unwrap();
    while ours.work().is_busy() {}
    let mut yours = BasinExplorer::default();
    yours.set("more", 1.0).unwrap();
    deliver(&mut yours, SEAT, "svd_align", &[]);
    assert!(serve(&mut yours, &(Arc::new(Ours) as Arc<dyn Callable>)) > 10);
    assert_eq!(raster(&yours, panel::POINT), raster(&ours, panel::POINT));
    assert_eq!(
        panel_of(&yours, panel::POINT).title,
        "Where your svd_align ends"
    );
    // Other settings empty it, and it is filled again.
    yours.set("tau", 1.4).unwrap();
    assert_ne!(raster(&yours, panel::POINT), raster(&ours, panel::POINT));
    serve(&mut yours, &(Arc::new(Wrong) as Arc<dyn Callable>));
    assert_ne!(raster(&yours, panel::POINT), raster(&ours, panel::POINT));
}

/// Of each variant: a rejection drives the one that is selected, and its map.
#[test]
fn the_registration_by_the_readers_rejection_has_the_bits_of_ours() {
    let function: Arc<dyn Callable> = Arc::new(Ours);
    for variant in [0.0, 1.0] {
        let mut ours = BasinExplorer::default();
        let mut yours = BasinExplorer::default();
        deliver(&mut yours, SEAT, "keep_pairs", &[]);
        yours.set("variant", variant).unwrap();
        serve(&mut yours, &function);
        for (name, value) in [("variant", variant), ("trim", 0.25), ("more", 1.0)] {
            ours.set(name, value).unwrap();
        }
        assert_eq!(facts(&yours), facts(&ours));
        let sentence = yours.outcome().sentence;
        assert!(sentence.contains("your keep_pairs ends"), "{sentence}");
        yours.set("more", 1.0).unwrap();
        serve(&mut yours, &function);
        while ours.work().is_busy() {}
        let map = [panel::POINT, panel::PLANE][variant as usize];
        assert_eq!(raster(&yours, map), raster(&ours, map));
        for iteration in 0..4 {
            for model in [&mut ours, &mut yours] {
                model.set("iteration", f64::from(iteration)).unwrap();
            }
            assert_eq!(pair_lines(&yours), pair_lines(&ours), "the pairs drawn");
        }
    }
}

#[test]
fn a_wrong_rejection_is_shown_with_the_pairs_that_it_keeps() {
    let mut model = BasinExplorer::default();
    model.set("trim", 0.5).unwrap();
    let right = (facts(&model), pair_lines(&model));
    deliver(&mut model, SEAT, "keep_pairs", &[]);
    assert_eq!(model.values().number("trim"), 0.5);
    serve(&mut model, &(Arc::new(Wrong) as Arc<dyn Callable>));
    let wrong = (facts(&model), pair_lines(&model));
    assert!(right.0 != wrong.0 && right.1 != wrong.1);
}

#[test]
fn the_lap_by_the_readers_functions_has_the_bits_of_ours() {
    let mut model = FullLap::default();
    model.set("t", 129.0).unwrap();
    let ours = facts(&model);
    for name in ["svd_align", "keep_pairs", "gate"] {
        deliver(&mut model, SEAT, name, &[]);
        assert_eq!(serve(&mut model, &(Arc::new(Ours) as Arc<dyn Callable>)), 1);
        assert_eq!(facts(&model), ours, "{name}");
        let title = panel_of(&model, "map").title;
        assert!(
            title.starts_with(&format!("Your {name} after tick 129")),
            "{title}"
        );
        let sentence = model.outcome().sentence;
        assert!(
            sentence.starts_with(&format!("with your {name}, ")),
            "{sentence}"
        );
    }
    deliver(&mut model, SEAT, "", &[]);
    model.finish_work();
    assert_eq!(facts(&model), ours);
    assert!(!model.outcome().sentence.contains("your"));
}

#[test]
fn a_wrong_gate_or_increment_changes_the_lap() {
    let mut model = FullLap::default();
    model.set("t", 129.0).unwrap();
    let (loops, rms) = (fact(&model, "loops_closed"), fact(&model, "keyframe_rms_m"));
    deliver(&mut model, SEAT, "gate", &[]);
    serve(&mut model, &(Arc::new(Wrong) as Arc<dyn Callable>));
    assert!(loops > 0.0 && fact(&model, "loops_closed") == 0.0);
    deliver(&mut model, SEAT, "svd_align", &[]);
    serve(&mut model, &(Arc::new(Wrong) as Arc<dyn Callable>));
    assert!(fact(&model, "keyframe_rms_m") > 2.0 * rms);
    deliver(&mut model, SEAT, "keep_pairs", &[]);
    serve(&mut model, &(Arc::new(Wrong) as Arc<dyn Callable>));
    assert!(fact(&model, "keyframe_rms_m") != rms);
}

#[test]
fn what_is_no_order_is_rejected() {
    let function: Arc<dyn Callable> = Arc::new(Ours);
    let mut model = BasinExplorer::default();
    deliver(&mut model, SEAT, "svd_align", &[]);
    let order = model.take_requests().remove(0);
    assert!(Executor::default().begin(&order, &function).is_ok());
    let as_cells = order.replace("registration", "cells");
    assert!(
        Executor::default()
            .begin(&format!("{as_cells} 0 8"), &function)
            .is_ok()
    );
    for order in [
        String::new(),
        "open".to_owned(),
        SEAT.to_owned(),
        order.replace("svd_align", "main"),
        order.replace("svd_align", "gate"),
        order.replace("p2p", "p2l"),
        order.replace("p2p", "p2x"),
        order.replace("room", "moon"),
        order.replace(" 0.7 ", " wide "),
        format!("{as_cells} 0 99"),
        format!("{as_cells} 0"),
        format!("{SEAT} gate lap own 1 1 on 7.8 path p2p chapter nonsense"),
        format!("{SEAT} gate lap moon 1 1 on 7.8 path p2p chapter "),
    ] {
        assert!(
            Executor::default().begin(&order, &function).is_err(),
            "{order}"
        );
    }
}
