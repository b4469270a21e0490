//! The fast rows of the landscapes against point-by-point evaluation, and the slopes.

use ch16_lab::terrain::{
    Objective, SceneKind, Terrain, TerrainProbe, TerrainScene, TerrainSettings,
};
use pr_geom::Vector2;
use proptest::prelude::*;

fn kind() -> impl Strategy<Value = SceneKind> {
    prop_oneof![Just(SceneKind::Room), Just(SceneKind::Corridor)]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn every_cell_is_what_a_search_for_each_point_finds(
        kind in kind(),
        ndt_cell_m in 0.2..1.5,
        n in 2_usize..60,
        tau_m in 0.05..1.6,
        heading_deg in -180.0..180.0,
    ) {
        let scene = TerrainScene::new(kind, ndt_cell_m);
        let settings = TerrainSettings { n, tau_m, heading_deg, ..TerrainSettings::default() };
        let terrain = Terrain::compute(&scene, &settings);
        let probe = TerrainProbe::new(&scene, &settings);
        for row in (0..n).step_by(7) {
            for column in 0..n {
                let offset = Vector2::new(settings.offset_m(column), settings.offset_m(row));
                let cell = row * n + column;
                // 1e-11: sums in another order; a wrong interval or border would show as 1e-4.
                let cost = terrain.icp_cost_m2()[cell];
                prop_assert!((cost - probe.icp_cost_m2(offset)).abs() < 1e-11);
                let score = terrain.ndt_score()[cell];
                prop_assert!((score - probe.ndt_score(offset)).abs() < 1e-11);
            }
        }
    }

    #[test]
    fn slopes_agree_with_finite_differences(
        kind in kind(), x in -1.3..1.3, y in -1.3..1.3, heading_deg in -20.0..20.0,
    ) {
        let scene = TerrainScene::new(kind, TerrainScene::DEFAULT_NDT_CELL_M);
        let settings = TerrainSettings { heading_deg, ..TerrainSettings::default() };
        let probe = TerrainProbe::new(&scene, &settings);
        let at = Vector2::new(x, y);
        let h = 1e-7;
        for objective in [Objective::IcpCost, Objective::NdtScore] {
            let slope = probe.slope(objective, at);
            for axis in 0..2 {
                let mut step = Vector2::zeros();
                step[axis] = h;
                let ahead = probe.slope(objective, at + step).value;
                let behind = probe.slope(objective, at - step).value;
                let (forward, backward) = ((ahead - slope.value) / h, (slope.value - behind) / h);
                // Where a pair or a cell changes within h, the two sides differ and neither is the
                // gradient; elsewhere they agree to the curvature times h.
                if (forward - backward).abs() < 1e-3 {
                    let numeric = 0.5 * (forward + backward);
                    prop_assert!((numeric - slope.gradient[axis]).abs() < 1e-3);
                }
            }
        }
    }
}

#[test]
fn the_chapters_facts_about_the_two_places() {
    let value = |kind, objective, x, y| {
        let scene = TerrainScene::new(kind, TerrainScene::DEFAULT_NDT_CELL_M);
        let probe = TerrainProbe::new(&scene, &TerrainSettings::default());
        probe.slope(objective, Vector2::new(x, y)).value
    };
    // Source of the figures: the chapter, section on the shape of the cost; printed digits.
    let icp = |kind, x, y| value(kind, Objective::IcpCost, x, y);
    for (kind, x, y, expected) in [
        (SceneKind::Room, 0.6, 0.0, 0.189),
        (SceneKind::Room, 0.0, 0.6, 0.160),
        (SceneKind::Corridor, 0.6, 0.0, 0.053),
        (SceneKind::Corridor, 0.0, 0.6, 0.347),
    ] {
        let cost = icp(kind, x, y);
        assert!((cost - expected).abs() < 5e-4, "{kind:?} {x} {y}: {cost}");
    }
    let ndt = |x, y| value(SceneKind::Corridor, Objective::NdtScore, x, y);
    let along = ndt(0.6, 0.0) / ndt(0.0, 0.0);
    assert!((along - 0.74).abs() < 5e-3, "{along}");
    assert!(ndt(0.0, 0.6) < 1e-9);
}

#[test]
fn the_truth_is_the_best_cell_of_both_landscapes_of_the_room() {
    let scene = TerrainScene::new(SceneKind::Room, TerrainScene::DEFAULT_NDT_CELL_M);
    let terrain = Terrain::compute(&scene, &TerrainSettings::default());
    let lowest = terrain.icp_minimum().expect("49 × 49 cells");
    assert_eq!((lowest.column, lowest.row), (24, 24));
    // Every point is its own nearest: the cost is zero but for the points of full buckets.
    assert!(lowest.value < 1e-4, "{lowest:?}");
    let highest = terrain.ndt_maximum().expect("49 × 49 cells");
    assert!(
        highest.column.abs_diff(24) <= 1 && highest.row.abs_diff(24) <= 1,
        "{highest:?}"
    );
}

#[test]
fn rows_one_by_one_are_the_whole() {
    let scene = TerrainScene::new(SceneKind::Corridor, TerrainScene::DEFAULT_NDT_CELL_M);
    let settings = TerrainSettings {
        n: 21,
        ..TerrainSettings::default()
    };
    let whole = Terrain::compute(&scene, &settings);
    let mut rows = Terrain::default();
    rows.begin(&scene, &settings);
    for row in 0..21 {
        assert_eq!(rows.rows(), row);
        assert!(rows.compute_row());
    }
    assert!(!rows.compute_row());
    assert_eq!(rows.icp_cost_m2(), whole.icp_cost_m2());
    assert_eq!(rows.ndt_score(), whole.ndt_score());
}
