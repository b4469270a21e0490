//! Sentences of the page that claim more than their numbers: the core confirms each of them.

use ch16_lab::basin::{BasinScene, BasinStart, Minimum};
use ch16_slam2d::icp::{IcpVariant, IcpWorkspace};

use super::figures::Figures;
use super::figures::basin::TAU_M;

fn of(names: &[&str]) -> Vec<f64> {
    let mut figures = Figures::default();
    let value = |name: &&str| figures.value(name).unwrap_or_else(|| panic!("{name}"));
    names.iter().map(value).collect()
}

#[test]
fn one_residual_reduces_the_error_more_than_all_loops_without_effect_on_the_covariance() {
    let rms = of(&[
        "lap.canonical.front_end.rms",
        "lap.canonical.rms",
        "lap.p2l.front_end.rms",
        "lap.ndt.front_end.rms",
    ]);
    let [without, with_loops, plane, ndt] = rms[..] else {
        unreachable!("four names")
    };
    for other in [plane, ndt] {
        assert!(without - other > 3.0 * (without - with_loops), "{rms:?}");
    }
    // With little odometry noise most of the corridor is still missing; only the matcher changes that.
    let short = of(&[
        "lap.quiet.front_end.turn.short_m",
        "lap.quiet-p2l.front_end.turn.short_m",
        "lap.quiet-ndt.front_end.turn.short_m",
    ]);
    assert!(short.is_sorted_by(|a, b| a > b), "{short:?}");
    let sigmas = ["p2p", "p2l", "ndt"].map(|matcher| {
        of(&[&format!(
            "worlds.apartment.{matcher}.chapter.front_end.half_way_sigma.median"
        )])[0]
    });
    assert!(
        sigmas.iter().all(|sigma| (0.5..0.65).contains(sigma)),
        "{sigmas:?}"
    );
    // In a bare corridor each of them is metres off.
    let bare = of(&[
        "lap.corridor.rms",
        "lap.corridor-p2l.rms",
        "lap.corridor-ndt.rms",
    ]);
    assert!(bare.iter().all(|rms| *rms > 1.5), "{bare:?}");
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
