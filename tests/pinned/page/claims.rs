//! Sentences of the page that claim more than their numbers: the core confirms each of them.

use ch16_lab::basin::{BasinScene, BasinStart, Minimum};
use ch16_lab::terrain::{SceneKind, TerrainProbe, TerrainScene, TerrainSettings};
use ch16_slam2d::icp::{IcpConfig, IcpVariant, IcpWorkspace};
use pr_geom::Vector2;

use super::figures;
use super::figures::basin::TAU_M;

fn of(names: &[&str]) -> Vec<f64> {
    let value = |name: &&str| figures::value(name).unwrap_or_else(|| panic!("{name}"));
    names.iter().map(value).collect()
}

/// The medians of thousand laps each, by matcher: `front_end.rms.median` or another row.
fn of_matchers(what: &str) -> [f64; 3] {
    ["p2p", "p2l", "ndt"]
        .map(|matcher| of(&[&format!("worlds.apartment.{matcher}.chapter.{what}")])[0])
}

#[test]
fn point_to_plane_removes_the_bias_only_with_good_normals_which_point_to_point_does_not_use() {
    let [cells, wide_cells, narrow_cells] = of(&[
        "lap.p2l.normals_cells",
        "lap.p2p-wide.normals_cells",
        "lap.p2l-narrow.normals_cells",
    ])[..] else {
        unreachable!("three names")
    };
    assert_eq!(cells, wide_cells);
    assert!(narrow_cells < cells);
    let [point, plane, plane_narrow, point_narrow] = of(&[
        "lap.p2p-wide.front_end.rms",
        "lap.p2l.front_end.rms",
        "lap.p2l-narrow.front_end.rms",
        "lap.canonical.front_end.rms",
    ])[..] else {
        unreachable!("four names")
    };
    // Normals do not enter the steps of point to point.
    assert_eq!(point, point_narrow);
    assert!(plane < 0.5 * point, "{plane} {point}");
    assert!(plane_narrow > point_narrow, "{plane_narrow}");
    assert_eq!(of(&["lap.p2l-narrow.loops"]), [0.0]);
    // One residual reduces the error more than all loops together.
    let with_loops = of(&["lap.canonical.rms"])[0];
    assert!(point - plane > 3.0 * (point - with_loops), "{with_loops}");
    // With little odometry noise most of the corridor is still missing; only the matcher changes that.
    let short = of(&[
        "lap.quiet.front_end.turn.short_m",
        "lap.quiet-p2l.front_end.turn.short_m",
        "lap.quiet-ndt.front_end.turn.short_m",
    ]);
    assert!(short.is_sorted_by(|a, b| a > b), "{short:?}");
    // In a bare corridor point to point is metres off.
    assert!(of(&["lap.corridor.rms"])[0] > 1.5);
}

#[test]
fn point_to_plane_is_better_in_nearly_every_lap_and_has_the_longer_tail() {
    let [point, plane, ndt] = of_matchers("front_end.rms.median");
    assert!(plane < 0.5 * point && ndt < 0.5 * point);
    // One lap in twenty does not part the two; one in a hundred does.
    let [point, plane, ndt] = of_matchers("front_end.rms.high");
    assert!((plane / point - 1.0).abs() < 0.1 && ndt < 0.5 * point);
    let [point, plane, worse_percent] = of(&[
        "sweep.once.front_end.rms.p99",
        "attempts.p2l.rms.p99",
        "attempts.p2l.worse_percent",
    ])[..] else {
        unreachable!("three names")
    };
    assert!(plane > 2.0 * point, "{plane} {point}");
    assert!(worse_percent < 12.0, "{worse_percent}");
    // Loops take more off a front end without the bias.
    let [point, plane, ndt] = of_matchers("rms.fall_percent");
    assert!(plane > 2.0 * point && ndt > 2.0 * point);
}

/// The cause is the normals: with narrower ones the same matcher measures the whole corridor.
#[test]
fn in_a_bare_corridor_the_matchers_hold_back_over_many_seeds_and_narrow_normals_do_not() {
    let [point, plane, narrow, ndt] = of(&[
        "corridor.p2p.driven_percent",
        "corridor.p2l.driven_percent",
        "corridor.p2l-narrow.driven_percent",
        "corridor.ndt.driven_percent",
    ])[..] else {
        unreachable!("four names")
    };
    assert!(point < 50.0 && ndt < 70.0, "{point} {ndt}");
    assert!(
        plane < 90.0 && (narrow - 100.0).abs() < 5.0,
        "{plane} {narrow}"
    );
}

#[test]
fn the_mean_innovation_of_a_lap_warns_of_the_bias_that_no_covariance_holds() {
    let [ratios, alarms] = ["step_ratio", "alarm_percent"].map(|what| {
        ["p2p", "p2l", "ndt"].map(|matcher| {
            of(&[&format!(
                "consistency.apartment.{matcher}.capped.front_end.{what}"
            )])[0]
        })
    });
    // The wheels have no bias, so the ratio of an unbiased matcher is 1 within its scatter of 0.04 over ten laps.
    assert!(ratios[0] < 0.95, "{ratios:?}");
    assert!(
        (ratios[1] - 1.0).abs() < 0.012 && (ratios[2] - 1.0).abs() < 0.025,
        "{ratios:?}"
    );
    // Chance alone sets it off in about 5 %.
    assert!(alarms[0] > 60.0 && alarms[1] < 6.0, "{alarms:?}");
}

#[test]
fn the_first_loop_raises_the_rms_error_of_the_canonical_run_and_of_about_every_other_lap() {
    let [before, after, share] = of(&[
        "lap.canonical.loop.0.rms_before",
        "lap.canonical.loop.0.rms_after",
        "sweep.once.first_loop_raised_percent",
    ])[..] else {
        unreachable!("three names")
    };
    assert!(after > before, "{before} {after}");
    assert!((share - 50.0).abs() < 10.0, "{share}");
}

#[test]
fn loops_raise_the_rms_error_more_often_without_a_false_one() {
    let [with_false, without] = of(&[
        "sweep.once.rms_grew_with_false_percent",
        "sweep.once.rms_grew_without_false_percent",
    ])[..] else {
        unreachable!("two names")
    };
    assert!(without > 2.0 * with_false, "{without} {with_false}");
}

#[test]
fn the_edge_of_point_to_point_is_that_of_its_basin_only_with_iterations_to_spare() {
    let edge = |name: &str| of(&[&format!("basin.{name}.edge_deg")])[0];
    assert!(edge("p2p") < edge("p2p.patient"));
    assert_eq!(edge("p2l"), edge("p2l.patient"));
    assert!(edge("p2l.patient") > edge("p2p.patient") + 5.0);
    // Twice the reach, and hardly a degree more: at the rim partners are wrong, not missing.
    assert!((edge("p2p.patient.wide") - edge("p2p.patient")).abs() < 3.0);
    let most = of(&["basin.p2p.patient.iterations_most"])[0];
    assert!(most > BasinScene::MAX_ITERS as f64 && most < BasinScene::PATIENT_ITERS as f64);
    let scene = BasinScene::new();
    let ending = |heading_deg, max_iterations| {
        let start = BasinStart {
            heading_deg,
            dx_m: 0.0,
            dy_m: 0.0,
        };
        let config = IcpConfig {
            max_iterations,
            ..BasinScene::config(IcpVariant::PointToPoint, TAU_M)
        };
        scene.register_from(&start, &config, &mut IcpWorkspace::new())
    };
    let between = ending(34.0, BasinScene::MAX_ITERS);
    assert_eq!(between.ending, Minimum::NotConverged);
    assert_eq!(
        ending(34.0, BasinScene::PATIENT_ITERS).ending,
        Minimum::Right
    );
    for beyond in [36.0, 40.0] {
        let caught = ending(beyond, BasinScene::PATIENT_ITERS);
        assert_eq!(caught.ending, Minimum::Other, "{beyond}°");
        assert!(caught.stop.converged());
        assert!(caught.inliers as f64 > 0.9 * scene.source().len() as f64);
    }
}

#[test]
fn the_quarter_turn_fits_worse_than_home_and_the_half_turn_of_point_to_plane_better() {
    for limit in ["", "patient."] {
        let rmse =
            |name: &str, heading: &str| of(&[&format!("basin.{name}.{limit}{heading}.rmse")])[0];
        assert!(rmse("p2p", "75") > 3.0 * rmse("p2p", "0"));
        assert!(rmse("p2l", "180") < rmse("p2l", "0"));
    }
    assert!(of(&["basin.p2p.75.rmse"]) < of(&["setup.loop.max_rmse_m"]));
}

#[test]
fn the_truncated_cost_has_creases_and_no_steps() {
    const SHIFT_M: f64 = 4e-4;
    let scene = TerrainScene::new(SceneKind::Room, TerrainScene::DEFAULT_NDT_CELL_M);
    let settings = TerrainSettings {
        tau_m: 0.2,
        ..TerrainSettings::default()
    };
    let probe = TerrainProbe::new(&scene, &settings);
    let costs: Vec<f64> = (0..3000)
        .map(|k| probe.icp_cost_m2(Vector2::new(SHIFT_M * f64::from(k), 0.3)))
        .collect();
    // min(d², τ²) changes by at most 2 τ times the change of d, and d by at most the shift.
    let bound = 2.0 * settings.tau_m * SHIFT_M;
    let steps: Vec<f64> = costs.windows(2).map(|pair| pair[1] - pair[0]).collect();
    assert!(steps.iter().all(|step| step.abs() <= bound));
    // The slope jumps at some shifts by far more than it changes between them.
    let mut bends: Vec<f64> = steps
        .windows(2)
        .map(|pair| (pair[1] - pair[0]).abs())
        .collect();
    bends.sort_by(f64::total_cmp);
    assert!(bends[bends.len() - 1] > 5.0 * bends[bends.len() / 2]);
}

#[test]
fn an_ndt_hessian_is_indefinite_beside_an_optimum_and_never_at_it() {
    let [corridors, negative, least] = of(&[
        "ndt.hessian.corridors",
        "ndt.hessian.negative_at_truth",
        "ndt.hessian.least_at_optimum",
    ])[..] else {
        unreachable!("three names")
    };
    assert!(negative >= 1.0 && negative <= corridors, "{negative}");
    assert!(least > 0.0, "{least}");
}

#[test]
fn along_a_bare_corridor_results_scatter_with_their_starts() {
    let scatter = of(&[
        "drops.long.from_0.std_x_cm",
        "drops.long.std_x_cm",
        "drops.long.from_60.std_x_cm",
    ]);
    assert!(scatter.is_sorted_by(|a, b| 1.2 * a < *b), "{scatter:?}");
    // What one sweep claims depends on the noise of the map by a factor.
    let claims = of(&[
        "drops.long.along_std_mm.least",
        "drops.long.along_std_mm.most",
    ]);
    assert!(claims[1] > 2.0 * claims[0], "{claims:?}");
    // Even from the truth the scatter exceeds every claim.
    assert!(10.0 * scatter[0] > claims[1], "{scatter:?} {claims:?}");
}

#[test]
fn descriptors_are_better_on_the_ring_beside_chance_and_look_worse_without_it() {
    for detector in ["context", "histogram"] {
        let [flat, ring] = ["apartment", "ring"].map(|world| {
            of(&[
                &format!("places.{world}.{detector}.area"),
                &format!("places.{world}.{detector}.over_chance"),
            ])
        });
        assert!(ring[0] < flat[0] && ring[1] > flat[1], "{detector}");
    }
    // No detector can be right more often than there are true pairs.
    for world in ["apartment", "ring"] {
        let perfect = of(&[&format!("places.{world}.perfect.called")])[0];
        for detector in ["nearby", "context", "histogram"] {
            let called = of(&[&format!("places.{world}.{detector}.called")])[0];
            assert!(called <= perfect, "{world} {detector}");
        }
    }
}

#[test]
fn kept_maximum_ranges_worsen_the_error_and_improve_all_that_the_robot_could_see() {
    let error = |what: &str| {
        of(&[
            &format!("lap.canonical.{what}"),
            &format!("lap.misses.{what}"),
        ])
    };
    let rms = error("rms");
    assert!(rms[1] > 1.4 * rms[0], "{rms:?}");
    for what in ["map_disagreement", "end_error"] {
        let values = error(what);
        assert!(values[1] < values[0], "{what}: {values:?}");
    }
    // The drive is the same.
    let wheels = error("odometry_end_error");
    assert_eq!(wheels[0], wheels[1]);
}

#[test]
fn a_loop_halves_the_variance_in_the_middle_and_leaves_a_shared_bias() {
    let [revisit, cycle, bias] = of(&[
        "rule.revisit_percent",
        "rule.cycle_left",
        "rule.bias_percent",
    ])[..] else {
        unreachable!("three names")
    };
    // 1e-4: the information of the loop is finite, and the solver adds to the diagonal.
    assert!(
        (revisit - 100.0 * (1.0 - 0.5_f64.sqrt())).abs() < 1e-4,
        "{revisit}"
    );
    // s (1 − s/L) over s, at a quarter of the path.
    assert!((cycle - 0.75).abs() < 1e-4, "{cycle}");
    assert!(bias.abs() < 1e-4, "{bias}");
}

/// A share among the accepted says nothing: it is near the base rate for a gate that does not look.
#[test]
fn the_exact_gate_accepts_true_and_false_alike_and_the_path_gate_does_not() {
    let rates = |case: &str| {
        let names = ["true_accepted_percent", "false_accepted_percent"];
        let [of_true, of_false] = names.map(|what| of(&[&format!("{case}.{what}")])[0]);
        of_true - of_false
    };
    // Percentage points: a rate of 130 attempts has a standard deviation of 3 to 4.
    assert!(rates("sweep.exact_gate").abs() < 8.0);
    assert!(rates("sweep.once").abs() < 8.0);
    assert!(rates("sweep.fourfold") > 12.0);
    assert!(rates("attempts.p2l") > 30.0);
    for case in ["sweep.fourfold", "sweep.exact_gate"] {
        let [among_accepted, base] =
            ["false_percent", "base_percent"].map(|what| of(&[&format!("{case}.{what}")])[0]);
        assert!(
            (among_accepted - base).abs() < 3.0,
            "{case}: {among_accepted} {base}"
        );
    }
    let wide = of(&["sweep.exact_gate.accepted", "sweep.fourfold.accepted"]);
    assert!(wide[0] > 1.3 * wide[1], "{wide:?}");
    let sigmas = of(&[
        "sweep.once.front_end.half_way_sigma.median",
        "sweep.fourfold.front_end.half_way_sigma.median",
    ]);
    assert!(sigmas[1] < 1.05 * sigmas[0], "{sigmas:?}");
}

#[test]
fn no_covariance_holds_a_bias_with_the_cap_or_without() {
    assert!(of(&["lap.canonical.capped_percent"])[0] > 95.0);
    let at_turn = |matcher: &str, bound: &str, what: &str| {
        let name = format!("consistency.apartment.{matcher}.{bound}.front_end.{what}");
        figures::value(&name).unwrap_or_else(|| panic!("{name}"))
    };
    for bound in ["capped", "uncapped"] {
        let [point, plane] = ["p2p", "p2l"].map(|of| at_turn(of, bound, "bias_m"));
        assert!(point > 5.0 * plane, "{bound}: {point} {plane}");
        let [point, plane] = ["p2p", "p2l"].map(|of| at_turn(of, bound, "sigma_m"));
        assert!(
            (point / plane - 1.0).abs() < 0.3,
            "{bound}: {point} {plane}"
        );
    }
    // The cap makes the covariances: without it they are less than half, of both unbiased matchers.
    for matcher in ["p2l", "ndt"] {
        let [capped, free] = ["capped", "uncapped"].map(|of| at_turn(matcher, of, "sigma_m"));
        assert!(free < 0.5 * capped, "{matcher}: {capped} {free}");
        // Neither is right: too cautious, too sure.
        let [capped, free] = ["capped", "uncapped"].map(|of| at_turn(matcher, of, "nees"));
        assert!(capped < 2.0 && free > 2.0, "{matcher}: {capped} {free}");
    }
}

#[test]
fn loops_reduce_the_scatter_on_the_ring_as_the_graph_predicts_by_point_to_plane_but_not_by_ndt() {
    let fall = |matcher: &str, bound: &str, what: &str| {
        let [before, after] = ["front_end", "with_loops"].map(|estimate| {
            let name = format!("consistency.ring.{matcher}.{bound}.{estimate}.{what}");
            figures::value(&name).unwrap_or_else(|| panic!("{name}"))
        });
        1.0 - after / before
    };
    for bound in ["capped", "uncapped"] {
        let [scatter, predicted] = ["scatter_m", "sigma_m"].map(|of| fall("p2l", bound, of));
        // The scatters of a hundred laps are uncertain by 7 % each.
        assert!(scatter > predicted - 0.1, "{bound}: {scatter} {predicted}");
        let [scatter, predicted] = ["scatter_m", "sigma_m"].map(|of| fall("ndt", bound, of));
        assert!(scatter < 0.7 * predicted, "{bound}: {scatter} {predicted}");
        // A bias that was not there before.
        assert!(fall("ndt", bound, "bias_m") < 0.0, "{bound}");
    }
}

#[test]
fn a_start_beyond_the_gaussians_ends_farther_off_than_it_began() {
    let far = of(&["ndt.far_start.offset_m", "ndt.far_start.error_m"]);
    assert!(far[1] > far[0], "{far:?}");
}

#[test]
fn the_gate_rejects_the_true_loop_that_drift_does_not_explain() {
    let [chi2, gate] = of(&[
        "lap.canonical.own.truth.25.0.quadratic.gate_chi2",
        "gate.chi2",
    ])[..] else {
        unreachable!("two names")
    };
    assert!(chi2 > gate, "{chi2}");
    // It is the simulator's: no sweep of the one reaches what the other sees.
    let [apart_m, range_m] = of(&[
        "lap.canonical.own.truth.25.0.quadratic.apart_m",
        "setup.lap.range_m",
    ])[..] else {
        unreachable!("two names")
    };
    assert!(apart_m > range_m, "{apart_m}");
}

#[test]
fn an_approximate_jacobian_moves_the_fixed_point_to_second_order_and_a_factor_does_not() {
    let off = of(&[
        "jacobians.3.approximate.off_mm",
        "jacobians.6.approximate.off_mm",
        "jacobians.3.residual.off_mm",
        "jacobians.6.residual.off_mm",
        "jacobians.6.twice.off_mm",
    ]);
    // Half of the contradiction leaves a quarter, or half; 10 % for the higher orders.
    assert!((off[1] / off[0] / 4.0 - 1.0).abs() < 0.1, "{off:?}");
    assert!((off[3] / off[2] / 2.0 - 1.0).abs() < 0.1, "{off:?}");
    assert!(off[4] < 1e-3, "{off:?}");
}

#[test]
fn results_are_in_the_classes_of_the_text() {
    let scene = BasinScene::new();
    let ending = |variant, heading_deg| {
        let start = BasinStart {
            heading_deg,
            dx_m: 0.0,
            dy_m: 0.0,
        };
        let config = BasinScene::config(variant, TAU_M);
        let found = scene.register_from(&start, &config, &mut IcpWorkspace::new());
        (found.ending, found.stop.converged())
    };
    let point = IcpVariant::PointToPoint;
    assert_eq!(ending(point, 25.0).0, Minimum::Right);
    assert_eq!(ending(point, 35.0), (Minimum::NotConverged, false));
    for sticks in [40.0, 45.0, 50.0] {
        assert_eq!(ending(point, sticks), (Minimum::Other, true), "{sticks}°");
    }
    assert_eq!(ending(point, 55.0), (Minimum::NotConverged, false));
    assert_eq!(ending(point, 60.0).0, Minimum::QuarterTurn);
    assert_eq!(ending(IcpVariant::PointToPlane, 180.0).0, Minimum::HalfTurn);
}
