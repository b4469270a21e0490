//! The widget's claims, tested on its model without a picture.

use widget_kit::model::{Activity, Assessment, Model, Motion, apply_preset};
use widget_kit::scene::{Layer, Raster, Tone};
use widgets::w16_3_cost_terraces::model::CostTerraces;

use crate::support::{fact, panel_of as panel};

fn with(settings: &[(&str, f64)]) -> CostTerraces {
    let mut model = CostTerraces::default();
    for (id, value) in settings {
        model.set(id, *value).unwrap();
    }
    model
}

fn preset(id: &str) -> CostTerraces {
    let mut model = CostTerraces::default();
    let preset = model.spec().presets.iter().find(|preset| preset.id == id);
    apply_preset(&mut model, preset.unwrap()).unwrap();
    model
}

/// Separate segments of a panel in that tone and width.
fn segments(model: &dyn Model, id: &str, tone: Tone, width_px: f32) -> usize {
    let layers = panel(model, id).layers;
    let found = layers.iter().filter_map(|layer| match layer {
        Layer::Segments {
            segments,
            tone: drawn,
            width_px: width,
            ..
        } if *drawn == tone && *width == width_px => Some(segments.len()),
        _ => None,
    });
    found.sum()
}

fn raster(model: &dyn Model) -> Raster {
    let panel = panel(model, "relief");
    let raster = panel.layers.iter().find_map(|layer| match layer {
        Layer::Raster(raster) => Some(raster.clone()),
        _ => None,
    });
    raster.unwrap()
}

/// SPEC §10, printed there with three digits.
#[test]
fn the_cross_hair_reads_the_chapters_costs() {
    for (scene, x, y, cost_m2) in [
        (0.0, 0.6, 0.0, 0.189),
        (0.0, 0.0, 0.6, 0.160),
        (2.0, 0.6, 0.0, 0.053),
        (2.0, 0.0, 0.6, 0.347),
    ] {
        let model = with(&[
            ("scene", scene),
            ("tau", 0.6),
            ("probe-x", x),
            ("probe-y", y),
        ]);
        let read = fact(&model, "icp_cost_m2");
        assert!(
            (read - cost_m2).abs() < 5e-4,
            "{read} for {cost_m2} at ({x}, {y})"
        );
    }
}

/// SPEC §10: 74 % of the peak along the corridor, nothing across it.
#[test]
fn the_corridors_ndt_score_fades_across_the_walls_alone() {
    let mut model = with(&[("scene", 2.0), ("probe-x", 0.6), ("probe-y", 0.0)]);
    let along = fact(&model, "ndt_score");
    model.set("probe-x", 0.0).unwrap();
    let peak = fact(&model, "ndt_score");
    model.set("probe-y", 0.6).unwrap();
    let across = fact(&model, "ndt_score");
    assert!((along / peak - 0.74).abs() < 5e-3, "{along} of {peak}");
    assert!(across < 1e-9, "{across}");
}

#[test]
fn a_small_tau_stops_icps_ball_on_a_terrace_and_ndts_rolls_home() {
    let model = preset("terraces");
    assert!(fact(&model, "icp_rest_m") > 0.15, "{:?}", model.outcome());
    assert!(fact(&model, "ndt_rest_m") < 0.12, "{:?}", model.outcome());
    assert_eq!(model.outcome().verdict, "ICP sticks");
    assert_eq!(model.outcome().standing, Assessment::Bad);
}

#[test]
fn the_loosest_direction_of_the_corridor_is_along_its_walls() {
    let corridor = preset("corridor");
    let angle = fact(&corridor, "loose_direction_deg");
    assert!(angle.abs() < 5.0 || angle.abs() > 175.0, "{angle}°");
    let share = |model: &dyn Model| {
        fact(model, "information_loose_per_cm2") / fact(model, "information_firm_per_cm2")
    };
    let room = CostTerraces::default();
    assert!(share(&corridor) < 0.01, "corridor {}", share(&corridor));
    assert!(share(&room) > 0.5, "room {}", share(&room));
    // The chapter: the corridor's point-to-plane matrix has rank 2.
    assert_eq!(fact(&corridor, "information_rank"), 2.0);
    assert_eq!(fact(&room, "information_rank"), 3.0);
}

#[test]
fn across_the_corridor_both_balls_settle_on_the_wrong_wall() {
    let model = preset("wrong-wall");
    for rest in ["icp_rest_m", "ndt_rest_m"] {
        // The corridor is 1.2 m wide: one wall lies on the other at Δy = 1.2 m.
        assert!(fact(&model, rest) > 1.0, "{rest}: {:?}", model.outcome());
    }
}

#[test]
fn a_wider_ndt_cell_brings_a_ball_to_the_truth_that_the_default_cell_loses() {
    let mut model = preset("wide-hill");
    assert_eq!(model.outcome().verdict, "ICP sticks");
    let drop_m = 0.7_f64.hypot(0.7);
    assert!(fact(&model, "icp_rest_m") > drop_m, "ICP's rolls away");
    model.set("ndt-cell", 0.55).unwrap();
    assert!(fact(&model, "ndt_rest_m") > 0.12, "{:?}", model.outcome());
}

#[test]
fn with_the_widest_tau_no_point_is_without_a_pair() {
    let model = preset("wide-tau");
    let points = panel(&model, "sweep")
        .layers
        .iter()
        .find_map(|layer| match layer {
            Layer::Points { points, tone, .. } if *tone == Tone::Prior => Some(points.len()),
            _ => None,
        });
    // Unchanging pairs, and those that are about to change.
    let pairs =
        segments(&model, "sweep", Tone::Ink, 0.75) + segments(&model, "sweep", Tone::Ink, 2.5);
    assert_eq!(pairs, points.unwrap());
}

#[test]
fn a_slices_title_names_the_row_that_it_shows() {
    // 49 samples over 2.6 m lie 5.4 cm apart: none lies at 0.3 m.
    let mut model = with(&[("probe-x", 0.3), ("probe-y", -0.3)]);
    let tables = model.tables();
    let maps = tables.iter().find(|table| table.id == "maps").unwrap();
    for (measure, id, title, fixed, value) in [
        (0.0, "slice-x", "Along x at Δy = −0.325 m", 1, 2),
        (0.0, "slice-y", "Along y at Δx = 0.325 m", 0, 2),
        (1.0, "slice-x", "Along x at Δy = −0.325 m", 1, 3),
    ] {
        model.set("measure", measure).unwrap();
        let panel = panel(&model, id);
        assert_eq!(panel.title, title);
        let shift = if fixed == 1 { "-0.3250" } else { "0.3250" };
        let line = maps.rows.iter().filter(|row| row[fixed] == shift);
        let heights: Vec<f64> = line.map(|row| row[value].parse().unwrap()).collect();
        let curve = panel.layers.iter().find_map(|layer| match layer {
            Layer::Line { points, .. } => Some(points.iter().map(|at| at[1])),
            _ => None,
        });
        assert_eq!(curve.unwrap().collect::<Vec<_>>(), heights, "{id}");
    }
}

#[test]
fn a_wide_tau_brings_a_ball_to_the_truth_that_ndt_loses() {
    let mut model = preset("wide-tau");
    assert_eq!(model.outcome().verdict, "NDT sticks");
    // With the chapter's τ the same drop gets stuck on ICP, too.
    model.set("tau", 0.6).unwrap();
    assert_eq!(model.outcome().verdict, "both stick");
}

#[test]
fn a_turned_sweep_has_no_shift_without_cost() {
    let (straight, turned) = (CostTerraces::default(), preset("turned"));
    assert_eq!(raster_low(&straight), 0.0);
    assert!(raster_low(&turned) > 0.0);
    assert_eq!(fact(&straight, "ndt_lowest_m"), 0.0);
    assert!(fact(&turned, "ndt_lowest_m") > 0.3);
}

/// Lowest ICP cost of the map, from the exported table.
fn raster_low(model: &dyn Model) -> f64 {
    let tables = model.tables();
    let maps = tables.iter().find(|table| table.id == "maps").unwrap();
    let costs = maps.rows.iter().map(|row| row[2].parse::<f64>().unwrap());
    costs.fold(f64::INFINITY, f64::min)
}

#[test]
fn a_parameter_recomputes_only_what_depends_on_it() {
    for (id, value, changes) in [
        ("probe-x", -0.3, [false, false]),
        ("probe-y", 0.9, [false, false]),
        ("t", 1.0, [false, false]),
        ("speed", 4.0, [false, false]),
        ("drops", 2.0, [false, false]),
        ("colours", 0.0, [true, true]),
        ("tau", 0.3, [true, false]),
        ("ndt-cell", 0.8, [false, true]),
        ("heading", 7.0, [true, true]),
        ("cells", 57.0, [true, true]),
        ("scene", 1.0, [true, true]),
        ("seed", 7.0, [true, true]),
    ] {
        let repaints = [0.0, 1.0].map(|measure| {
            let mut model = CostTerraces::default();
            model.set_motion(Motion::Reduced);
            model.set("measure", measure).unwrap();
            let before = raster(&model).revision;
            model.set(id, value).unwrap();
            raster(&model).revision != before
        });
        assert_eq!(repaints, changes, "{id}");
    }
}

#[test]
fn the_order_of_the_settings_does_not_matter() {
    let settings = [
        ("tau", 0.25),
        ("scene", 1.0),
        ("ndt-cell", 0.7),
        ("cells", 65.0),
        ("heading", -12.0),
        ("probe-x", 0.4),
        ("probe-y", -0.2),
    ];
    let forwards = with(&settings);
    let mut reversed = settings;
    reversed.reverse();
    let backwards = with(&reversed);
    assert_eq!(forwards.outcome(), backwards.outcome());
    assert_eq!(forwards.tables(), backwards.tables());
}

#[test]
fn defaults_bring_back_the_first_picture() {
    let fresh = CostTerraces::default();
    for preset in fresh.spec().presets {
        let mut model = self::preset(preset.id);
        model.press("defaults").unwrap();
        assert_eq!(model.values(), fresh.values());
        assert_eq!(model.outcome(), fresh.outcome());
        assert_eq!(model.timeline(), fresh.timeline());
    }
}

/// Seconds until nothing moves.
fn seconds(model: &mut CostTerraces) -> f64 {
    let mut frames = 0;
    while model.advance(1.0 / 60.0) == Activity::Busy {
        frames += 1;
        assert!(frames < 60 * 10, "ten seconds and no rest");
    }
    f64::from(frames) / 60.0
}

#[test]
fn the_ball_waits_while_it_is_held_and_rolls_to_its_rest_when_it_is_let_go() {
    let mut model = CostTerraces::default();
    let handle = model.grab("relief", [0.4, 0.1], [0.1, 0.1]).unwrap();
    model.drag(handle, [-0.5, 0.25]);
    assert_eq!(model.advance(1.0), Activity::Idle);
    assert_eq!(model.values().number("t"), 0.0);
    model.release();
    assert!(model.plays_when_let_go(&handle));
    model.press("play").unwrap();
    let rolled_s = seconds(&mut model);
    assert!((2.0..4.0).contains(&rolled_s), "{rolled_s} s");
    let timeline = model.timeline().unwrap();
    assert!(!timeline.playing);
    // The address says where the timeline ends.
    assert_eq!(model.values().number("t"), timeline.last);
}

#[test]
fn with_reduced_motion_the_ball_is_at_rest_at_once() {
    let mut model = CostTerraces::default();
    model.set_motion(Motion::Reduced);
    model.press("play").unwrap();
    assert_eq!(model.advance(1.0), Activity::Idle);
    assert_eq!(model.values().number("t"), model.timeline().unwrap().last);
}

#[test]
fn the_switch_morphs_one_relief_into_the_other_with_its_ball() {
    let ball = |model: &CostTerraces| {
        let layers = panel(model, "relief").layers;
        let balls = layers.into_iter().filter_map(|layer| match layer {
            Layer::Points {
                points,
                tone: Tone::Posterior,
                radius_px,
                ..
            } if radius_px > 5.0 => Some(points[0]),
            _ => None,
        });
        balls.last().unwrap()
    };
    let of = |measure, motion| {
        let mut model = with(&[("t", 100.0)]);
        model.set_motion(motion);
        model.set("measure", measure).unwrap();
        model
    };
    let [icp, ndt] = [0.0, 1.0].map(|measure| of(measure, Motion::Reduced));
    let mut morphing = of(1.0, Motion::Full);
    assert_eq!(
        (raster(&morphing).cells, ball(&morphing)),
        (raster(&icp).cells, ball(&icp))
    );
    morphing.advance(0.4);
    let between = (raster(&morphing).cells, ball(&morphing));
    let morphs_s = 0.4 + seconds(&mut morphing);
    assert_eq!(
        (raster(&morphing).cells, ball(&morphing)),
        (raster(&ndt).cells, ball(&ndt))
    );
    assert!((0.5..1.5).contains(&morphs_s), "{morphs_s} s");
    for end in [icp, ndt] {
        assert_ne!(between, (raster(&end).cells, ball(&end)));
    }
}

#[test]
fn a_ball_never_climbs() {
    for preset in CostTerraces::default().spec().presets {
        let (id, model) = (preset.id, self::preset(preset.id));
        for ball in ["icp-ball", "ndt-ball"] {
            let tables = model.tables();
            let way = tables.iter().find(|table| table.id == ball).unwrap();
            let heights: Vec<f64> = way.rows.iter().map(|row| row[3].parse().unwrap()).collect();
            for pair in heights.windows(2) {
                assert!(
                    pair[1] <= pair[0],
                    "{id}, {ball}: {} after {}",
                    pair[1],
                    pair[0]
                );
            }
        }
    }
}

#[test]
fn a_press_on_the_relief_puts_the_cross_hair_there() {
    let mut model = CostTerraces::default();
    for measure in [0.0, 1.0] {
        model.set("measure", measure).unwrap();
        let handle = model.grab("relief", [-0.5, 0.25], [0.1, 0.1]).unwrap();
        model.drag(handle, [-0.5, 0.25]);
        assert_eq!(model.values().number("probe-x"), -0.5);
        assert_eq!(model.values().number("probe-y"), 0.25);
        // Dragged off the map, it stays at the border.
        model.drag(handle, [9.0, -9.0]);
        assert_eq!(model.values().number("probe-x"), 1.3);
        assert_eq!(model.values().number("probe-y"), -1.3);
    }
    assert!(model.grab("slice-x", [0.0, 0.5], [0.1, 0.1]).is_none());
}

#[test]
fn the_extremes_of_every_parameter_have_every_figure_and_a_cell_on_the_truth() {
    let fresh = CostTerraces::default();
    for (spec, _) in fresh.values().iter() {
        let (min, max) = spec.range();
        for value in [min, max] {
            let mut model = CostTerraces::default();
            model.set(spec.id, value).unwrap();
            model.finish_work();
            let outcome = model.outcome();
            for fact in &outcome.facts {
                assert!(fact.value.is_finite(), "{} at {value}: {fact:?}", spec.id);
            }
            assert_eq!(raster(&model).columns % 2, 1, "a cell on the truth");
        }
    }
}

#[test]
fn every_value_of_cells_keeps_a_cell_on_the_truth() {
    for cells in 49..=161 {
        let model = with(&[("cells", f64::from(cells))]);
        let raster = raster(&model);
        assert_eq!(raster.columns % 2, 1);
        assert!((49..=161).contains(&raster.columns));
    }
}

#[test]
fn the_pointer_over_the_relief_reads_both_measures() {
    let mut model = CostTerraces::default();
    let title = |model: &CostTerraces| panel(model, "relief").title;
    let resting = title(&model);
    assert!(!resting.contains('.'), "no number at rest: {resting}");
    model.hover("relief", Some([0.0, 0.0]));
    // The sweep is on its own points: zero cost; the score is the peak of the reference grid.
    assert_eq!(title(&model), "Here ICP costs 0.0000 m², NDT scores 0.59");
    model.hover("relief", None);
    assert_eq!(title(&model), resting);
}
