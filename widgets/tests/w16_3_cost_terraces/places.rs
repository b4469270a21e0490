//! The panels beside the maps: partners at a ridge, Gaussians, slices, and the results of many sweeps.

use widget_kit::model::{Activity, Model, Motion, apply_preset};
use widget_kit::scene::{Layer, Panel, Stroke, Tone};
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
    apply_preset(&mut model, preset.expect(id)).unwrap();
    model
}

/// Cells of the ICP map that are lower than all of their neighbours along the row and the column.
fn hollows(model: &dyn Model) -> usize {
    let tables = model.tables();
    let maps = tables.iter().find(|table| table.id == "maps").unwrap();
    let heights: Vec<f64> = maps
        .rows
        .iter()
        .map(|row| row[2].parse().unwrap())
        .collect();
    let n = 49;
    assert_eq!(heights.len(), n * n);
    let lower = |here: usize, there: usize| heights[here] < heights[there];
    let inner = (1..n - 1).flat_map(|row| (1..n - 1).map(move |column| row * n + column));
    let is_hollow = |&at: &usize| {
        [at - 1, at + 1, at - n, at + n]
            .iter()
            .all(|&k| lower(at, k))
    };
    inner.filter(is_hollow).count()
}

/// The picture of the bells.
fn bells(mut model: CostTerraces) -> Panel {
    model.set("measure", 1.0).unwrap();
    panel(&model, "bells")
}

#[test]
fn the_picture_of_the_bells_shows_bells_in_every_preset() {
    for spec in CostTerraces::default().spec().presets {
        let bells = bells(preset(spec.id));
        let is_inside = |[x, y]: [f64; 2]| {
            (bells.x.min..bells.x.max).contains(&x) && (bells.y.min..bells.y.max).contains(&y)
        };
        let shown = bells.layers.iter().filter(|layer| match layer {
            Layer::Ellipse { center, .. } => is_inside(*center),
            _ => false,
        });
        // Two ellipses per Gaussian.
        assert!(shown.count() >= 4, "{}", spec.id);
    }
}

#[test]
fn it_opens_on_terraces_where_icps_ball_sticks() {
    let model = CostTerraces::default();
    assert_eq!(model.outcome().verdict, "ICP sticks");
    assert_eq!(model.values().number("colours"), 1.0, "by rank");
    let (opening, bowl) = (hollows(&model), hollows(&preset("bowl")));
    assert!(
        opening > 20 && bowl < 5,
        "{opening} hollows, the bowl {bowl}"
    );
}

/// Lines from a point to its next partner, and the highlighted points.
fn lit(model: &dyn Model) -> (usize, usize) {
    let layers = panel(model, "sweep").layers;
    let lines = layers.iter().filter_map(|layer| match layer {
        Layer::Segments {
            segments,
            tone: Tone::Series(0),
            ..
        } => Some(segments.len()),
        _ => None,
    });
    let points = layers.iter().filter_map(|layer| match layer {
        Layer::Points {
            points,
            tone: Tone::Series(0),
            ..
        } => Some(points.len()),
        _ => None,
    });
    (lines.sum(), points.sum())
}

#[test]
fn at_a_ridge_the_partner_that_changes_lights_up() {
    let mut model = with(&[("tau", 0.6), ("probe-x", 0.0), ("probe-y", 0.0)]);
    assert_eq!(lit(&model), (0, 0), "at the truth every point has itself");
    // Halfway between two points of the map, many points are about to change.
    let mut seen = 0;
    for step in 1..=13 {
        model.set("probe-x", 0.1 * f64::from(step)).unwrap();
        let (lines, points) = lit(&model);
        assert_eq!(points as f64, fact(&model, "partners_changing"));
        assert!(lines <= points, "one that loses its partner has no line");
        seen += lines;
    }
    assert!(seen > 10, "{seen} on 1.3 m");
}

#[test]
fn the_pointer_over_a_map_moves_the_sweep_that_is_paired() {
    let mut model = with(&[("tau", 0.6)]);
    assert_eq!(panel(&model, "sweep").title, "Matches at the crosshair");
    assert_ne!(lit(&model), (0, 0));
    model.hover("relief", Some([0.0, 0.0]));
    assert_eq!(panel(&model, "sweep").title, "Matches under the pointer");
    assert_eq!(lit(&model), (0, 0));
    model.hover("relief", None);
    // While the ball rolls, its partners are shown.
    model.set("t", 50.0).unwrap();
    assert_eq!(panel(&model, "sweep").title, "Matches at the ball");
}

/// Longer half axes of the ellipses of one standard deviation, m.
fn bells_m(model: &dyn Model) -> Vec<f64> {
    let layers = panel(model, "bells").layers;
    let ellipses = layers.iter().filter_map(|layer| match layer {
        Layer::Ellipse { half_axes, .. } => Some(half_axes[0]),
        _ => None,
    });
    // Each Gaussian has the ellipse of two deviations below that of one.
    ellipses
        .skip(1)
        .step_by(2)
        .map(|[x, y]| x.hypot(y))
        .collect()
}

#[test]
fn the_bells_follow_the_cell_slider() {
    let mut model = with(&[("measure", 1.0)]);
    let median = |mut lengths: Vec<f64>| {
        lengths.sort_by(f64::total_cmp);
        lengths[lengths.len() / 2]
    };
    let mut shorter_m = 0.0;
    let mut counts = Vec::new();
    for cell_m in [0.55, 0.8, 1.2] {
        model.set("ndt-cell", cell_m).unwrap();
        let bells = bells_m(&model);
        counts.push(bells.len());
        assert_eq!(bells.len() as f64, fact(&model, "bells"));
        let title = panel(&model, "bells").title;
        assert!(title.contains(&format!("{cell_m:.2} m")), "{title}");
        // Points spread evenly over a cell deviate by its width over the root of 12; few points may deviate
        // more.
        let length_m = median(bells);
        let longest_m = cell_m / 2.0;
        assert!(
            (shorter_m..longest_m).contains(&length_m),
            "{length_m} m in {cell_m} m"
        );
        shorter_m = length_m;
    }
    assert!(counts[2] < counts[0], "{counts:?}");
}

#[test]
fn along_the_corridor_the_pose_is_unconstrained() {
    let cost = |x: f64, y: f64| {
        let at = [("scene", 1.0), ("tau", 0.6), ("probe-x", x), ("probe-y", y)];
        fact(&with(&at), "icp_cost_m2")
    };
    let (truth, along, across) = (cost(0.0, 0.0), cost(0.6, 0.0), cost(0.0, 0.6));
    // The noise of 1 cm and points 8 cm apart cost a few tenths of a square decimetre anywhere.
    assert!(
        (along - truth).abs() < 0.002,
        "{along} along, {truth} at the truth"
    );
    assert!(across > 50.0 * truth, "{across} across");
    let corridor = preset("corridor");
    assert!(
        fact(&corridor, "icp_lowest_m") > 0.3,
        "the lowest cell is anywhere"
    );
    // Dropped 0.6 m along the corridor, both balls stay near there.
    for rest in ["icp_rest_m", "ndt_rest_m"] {
        assert!(fact(&corridor, rest) > 0.4, "{rest}");
    }
    // On its own points the sweep has a definite minimum.
    assert_eq!(fact(&preset("own-corridor"), "icp_lowest_m"), 0.0);
}

#[test]
fn a_hundred_sweeps_rest_round_in_the_room_and_in_a_streak_in_the_corridor() {
    let spread = |id| {
        let mut model = preset(id);
        model.finish_work();
        assert_eq!(fact(&model, "rests"), 100.0);
        ["rests_std_x_cm", "rests_std_y_cm"].map(|axis| fact(&model, axis))
    };
    let [x, y] = spread("drop-room");
    // As wide as the information predicts, 0.11 cm, within a factor of two.
    for deviation in [x, y] {
        assert!((0.05..0.22).contains(&deviation), "room {x} {y}");
    }
    let [x, y] = spread("drop-corridor");
    assert!(x > 10.0 && y < 0.6, "corridor {x} {y}");
}

/// Positions of the dropped sweeps on the map.
fn flying(model: &dyn Model) -> Vec<[f64; 2]> {
    let layers = panel(model, "relief").layers;
    let dots = layers.iter().rev().find_map(|layer| match layer {
        Layer::Points {
            points,
            tone: Tone::Posterior,
            ..
        } if points.len() > 1 => Some(points.clone()),
        _ => None,
    });
    dots.unwrap_or_default()
}

#[test]
fn drop_100_works_in_pieces_and_its_points_fly_to_rest() {
    let mut model = with(&[("scene", 1.0)]);
    model.press("drop-100").unwrap();
    assert_eq!(model.values().number("drops"), 100.0);
    for number in 1..=100 {
        assert_eq!(model.work(), Activity::Busy);
        assert_eq!(fact(&model, "rests"), f64::from(number));
    }
    assert_eq!(model.work(), Activity::Idle);
    let start = flying(&model);
    assert!(
        start.iter().any(|at| at[1].abs() > 0.15),
        "they start all round"
    );
    let mut frames = 0;
    while model.advance(1.0 / 60.0) == Activity::Busy {
        frames += 1;
        assert!(frames < 60 * 10, "ten seconds and no rest");
    }
    assert!(frames > 60, "{frames} frames");
    let rests = flying(&model);
    assert!(
        rests.iter().all(|at| at[1].abs() < 0.03),
        "they rest between the walls"
    );
    // With reduced motion they are at their results at once.
    let mut still = with(&[("scene", 1.0)]);
    still.set_motion(Motion::Reduced);
    still.press("drop-100").unwrap();
    still.finish_work();
    assert_eq!(flying(&still), rests);
    assert_eq!(still.advance(1.0), Activity::Idle);
}

#[test]
fn sweeps_of_the_newest_scene_are_dropped() {
    let mut model = CostTerraces::default();
    model.set("drops", 100.0).unwrap();
    for _ in 0..40 {
        model.work();
    }
    model.set("scene", 1.0).unwrap();
    assert_eq!(fact(&model, "rests"), 0.0, "those of the room are gone");
    model.finish_work();
    let at_once = with(&[("scene", 1.0), ("drops", 100.0)]);
    let mut at_once = at_once;
    at_once.finish_work();
    assert_eq!(model.outcome(), at_once.outcome());
    // A smaller number shows the first ones, and an unrelated slider restarts none.
    model.set("drops", 7.0).unwrap();
    model.set("tau", 0.4).unwrap();
    assert_eq!(fact(&model, "rests"), 7.0);
    assert_eq!(model.work(), Activity::Idle);
}

#[test]
fn slices_of_a_landscape_share_an_axis_and_the_ellipse_keeps_its_scale() {
    let ellipse = |model: &dyn Model| {
        let panel = panel(model, "information");
        (panel.x, panel.y)
    };
    let usual = ellipse(&CostTerraces::default());
    for spec in CostTerraces::default().spec().presets {
        let mut model = preset(spec.id);
        for measure in [0.0, 1.0] {
            model.set("measure", measure).unwrap();
            let [x, y] = ["slice-x", "slice-y"].map(|id| panel(&model, id).y);
            assert_eq!(x, y, "{}", spec.id);
        }
        assert_eq!(ellipse(&model), usual, "{}", spec.id);
    }
}

#[test]
fn the_corridors_rows_have_rank_two_and_leave_an_arrow_along_it() {
    let mut model = with(&[("scene", 1.0), ("rows", 0.0)]);
    let ranks: Vec<f64> = (0..=120)
        .map(|rows| {
            model.set("rows", f64::from(rows)).unwrap();
            fact(&model, "rows_rank")
        })
        .collect();
    assert_eq!(ranks[..3], [0.0, 1.0, 2.0]);
    assert!(ranks[2..].iter().all(|&rank| rank == 2.0));
    // 1e-12: an eigenvector whose other entries are zero.
    assert!((fact(&model, "null_x") - 1.0).abs() < 1e-12);
    let arrow = |model: &dyn Model| drawn(model, Tone::Series(1));
    let [[from, to], ..] = arrow(&model)[..] else {
        panic!("no arrow");
    };
    assert!(to[0] > from[0] + 1.0 && (to[1] - from[1]).abs() < 1e-9);
    // A room constrains every direction.
    model.set("scene", 0.0).unwrap();
    assert_eq!(fact(&model, "rows_rank"), 3.0);
    // The end of the slider selects all.
    assert!(fact(&model, "rows") > 120.0);
    assert!(arrow(&model).is_empty());
}

#[test]
fn a_row_of_odometry_restores_the_rank_with_its_deviation() {
    for sigma_m in [0.01, 0.05, 0.5] {
        let model = with(&[("scene", 1.0), ("odometry", sigma_m)]);
        assert_eq!(fact(&model, "rows_rank"), 3.0);
        // 1e-9: the inverse of a matrix whose entries reach 1e6.
        assert!((fact(&model, "rows_along_m") - sigma_m).abs() < 1e-9);
        let expected = format!("x known to {:.1} cm", 100.0 * sigma_m);
        assert!(model.outcome().sentence.contains(&expected));
        assert!(panel(&model, "rows").title.contains(&expected));
        let [[from, to]] = drawn(&model, Tone::Posterior)[..] else {
            panic!("no bar");
        };
        assert!((to[0] - from[0] - 2.0 * sigma_m).abs() < 1e-9);
    }
}

#[test]
fn each_row_can_be_read_one_by_one() {
    let model = preset("one-row");
    let tables = model.tables();
    let rows = &tables.iter().find(|table| table.id == "rows").unwrap().rows;
    assert!(
        rows.iter()
            .all(|row| row[1] == "0" && row[2].ends_with('1'))
    );
    let first = &rows[0];
    let title = panel(&model, "rows").title;
    let count = rows.len();
    let expected = format!("Row 1 of {count}: ({}, {}, ", first[1], first[2]);
    assert!(title.starts_with(&expected), "{title}");
    assert!(title.ends_with("rank 1"), "{title}");
}

/// The segments of a tone in the panel of the rows.
fn drawn(model: &dyn Model, wanted: Tone) -> Vec<[[f64; 2]; 2]> {
    let layers = panel(model, "rows").layers.into_iter();
    let segments = layers.filter_map(|layer| match layer {
        Layer::Segments { segments, tone, .. } if tone == wanted => Some(segments),
        _ => None,
    });
    segments.flatten().collect()
}

/// The ball on its profile, and the ground: distance from the drop (m), height (% of the highest).
fn ball_and_ground(model: &dyn Model) -> ([f64; 2], Vec<[f64; 2]>) {
    let layers = panel(model, "path").layers;
    let ball = layers.iter().find_map(|layer| match layer {
        Layer::Points {
            points,
            tone: Tone::Posterior,
            ..
        } => Some(points[0]),
        _ => None,
    });
    let ground = layers.iter().find_map(|layer| match layer {
        Layer::Line { points, .. } => Some(points.clone()),
        _ => None,
    });
    (ball.unwrap(), ground.unwrap())
}

#[test]
fn icps_ball_stops_on_a_step_with_the_pit_ahead_and_ndts_in_the_pit() {
    let mut model = with(&[("t", 100.0)]);
    let (ball, ground) = ball_and_ground(&model);
    let [end_m, end] = ground[ground.len() - 1];
    assert!(ball[1] > 50.0 && end < 1.0, "{ball:?} of {end}");
    assert!((end_m - ball[0] - fact(&model, "icp_rest_m")).abs() < 1e-9);
    // Level for more than 10 cm ahead: a step, not a slope.
    let ahead = ground
        .iter()
        .filter(|at| (0.0..0.1).contains(&(at[0] - ball[0])));
    assert!(ahead.count() >= 10);
    let step = ground.iter().find(|at| at[0] > ball[0] + 0.1).unwrap();
    assert!((step[1] - ball[1]).abs() < 2.0, "{step:?} after {ball:?}");
    model.set("measure", 1.0).unwrap();
    let (ball, ground) = ball_and_ground(&model);
    assert!(ball[1] < 5.0, "{ball:?} on {ground:?}");
}

#[test]
fn the_ball_waits_at_the_drop_and_rolls_along_its_ground() {
    let mut model = CostTerraces::default();
    let steps = |model: &CostTerraces| {
        let tables = model.tables();
        let way = tables.iter().find(|table| table.id == "icp-ball").unwrap();
        way.rows.len() - 1
    };
    let before = panel(&model, "path");
    assert!(before.question().is_some(), "before any gesture");
    for percent in [10.0, 50.0, 100.0] {
        model.set("t", percent).unwrap();
        let (ball, ground) = ball_and_ground(&model);
        let step = (0.01 * percent * steps(&model) as f64).round();
        assert_eq!(ball, ground[step as usize]);
    }
}

#[test]
fn ndts_colour_bar_runs_from_the_highest_score_which_is_dark_to_none() {
    let bar = |colours| {
        let panel = panel(&with(&[("measure", 1.0), ("colours", colours)]), "relief");
        panel.color_bar.unwrap()
    };
    assert!(bar(0.0).min > 0.5 && bar(0.0).max == 0.0, "{:?}", bar(0.0));
    assert_eq!(bar(1.0).label, "% are better");
}

#[test]
fn a_slope_that_faces_the_light_is_brighter_than_one_that_turns_away() {
    let panel = panel(&with(&[("tau", 0.6), ("colours", 0.0)]), "relief");
    let raster = panel.layers.iter().find_map(|layer| match layer {
        Layer::Raster(raster) => Some(raster.clone()),
        _ => None,
    });
    let raster = raster.unwrap();
    let light = |column: usize, row: usize| match raster.cells[row * raster.columns + column] {
        widget_kit::scene::RasterCell::Relief { light, .. } => light,
        other => panic!("{other:?}"),
    };
    // A bowl about cell 24: its lower right wall faces the upper left.
    assert!(light(32, 16) > 0.1, "{}", light(32, 16));
    assert!(light(16, 32) < -0.1, "{}", light(16, 32));
}

#[test]
fn a_lens_shows_the_dent_that_holds_a_stuck_ball_and_none_one_that_is_home() {
    let lens = |measure: f64| {
        let panel = panel(&with(&[("measure", measure), ("t", 100.0)]), "path");
        let lines = panel.layers.into_iter().filter_map(|layer| match layer {
            Layer::Line {
                points,
                stroke: Stroke::Solid,
                ..
            } => Some(points),
            _ => None,
        });
        lines.collect::<Vec<_>>()
    };
    let lines = lens(0.0);
    let [ground, dent, frame] = &lines[..] else {
        panic!("ICP's ball sticks: {lines:?}");
    };
    let middle = 0.5 * (dent[0][0] + dent[dent.len() - 1][0]);
    let (behind, ahead): (Vec<[f64; 2]>, Vec<[f64; 2]>) =
        dent.iter().partition(|at| at[0] < middle - 1e-9);
    let highest = |side: &[[f64; 2]]| side.iter().map(|at| at[1]).fold(f64::MIN, f64::max);
    // It rises on both sides, and behind the rim it falls: that is why a ball that only descends stays.
    let (low, rim) = (ahead[0][1], highest(&ahead));
    assert!(rim - low > 1.0 && highest(&behind) > low, "{ahead:?}");
    assert!(ahead[ahead.len() - 1][1] < rim, "{ahead:?}");
    // The lens hides no ground.
    let [left, right] = [frame[0][0], frame[1][0]];
    let under = ground.iter().filter(|at| (left..=right).contains(&at[0]));
    assert!(
        under.map(|at| at[1]).all(|height| height < frame[0][1]),
        "{frame:?}"
    );
    assert_eq!(lens(1.0).len(), 1, "NDT's is home");
}
