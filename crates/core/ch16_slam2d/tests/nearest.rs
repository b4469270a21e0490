//! Every map finds the nearest point of a linear scan.

use ch16_slam2d::cloud::{DenseMap, NearestMap, NearestTable, PointCloud, QueryCache, VoxelMap};
use pr_geom::{Point2, Vector2};
use proptest::prelude::*;

/// The chapter's rule, point by point: strictly nearer wins, among equals the smaller cell, then the
/// earlier point.
fn brute_force<M: NearestMap>(
    map: &M,
    query: Point2<f64>,
    radius_m: f64,
    cell_m: f64,
) -> Option<Point2<f64>> {
    let cell = |p: Point2<f64>| ((p.x / cell_m).floor() as i32, (p.y / cell_m).floor() as i32);
    let mut best: Option<(f64, (i32, i32), Point2<f64>)> = None;
    for index in 0..map.len() {
        let point = map.point(index);
        let squared = (point - query).norm_squared();
        let better = match best {
            None => squared < radius_m * radius_m,
            Some((least, least_cell, _)) => {
                squared < least || (squared == least && cell(point) < least_cell)
            }
        };
        if better {
            best = Some((squared, cell(point), point));
        }
    }
    best.map(|(_, _, point)| point)
}

fn found<M: NearestMap>(map: &M, query: Point2<f64>, radius_m: f64) -> Option<Point2<f64>> {
    map.neighbor(query, radius_m)
        .map(|neighbor| map.point(neighbor.index))
}

/// Points on a lattice of 1/8 m, so that exact ties are common, or anywhere.
fn points() -> impl Strategy<Value = Vec<Point2<f64>>> {
    let lattice = (-16_i32..16, -16_i32..16)
        .prop_map(|(x, y)| Point2::new(f64::from(x) / 8.0, f64::from(y) / 8.0));
    let anywhere = (-2.0..2.0, -2.0..2.0).prop_map(|(x, y)| Point2::new(x, y));
    prop::collection::vec(prop_oneof![lattice, anywhere], 0..120)
}

fn query() -> impl Strategy<Value = Point2<f64>> {
    let lattice = (-40_i32..40, -40_i32..40)
        .prop_map(|(x, y)| Point2::new(f64::from(x) / 16.0, f64::from(y) / 16.0));
    let anywhere = (-4.0..4.0, -4.0..4.0).prop_map(|(x, y)| Point2::new(x, y));
    prop_oneof![lattice, anywhere]
}

proptest! {
    #[test]
    fn all_maps_agree_with_brute_force(
        points in points(),
        queries in prop::collection::vec(query(), 1..20),
        cell_m in 0.05..0.8,
        max_per_cell in 1_usize..10,
        radius_m in 0.02..3.0,
    ) {
        let cloud = PointCloud::new(points.clone(), 0.0);
        let voxel = VoxelMap::from_cloud(&cloud, cell_m, max_per_cell);
        let dense = DenseMap::from_cloud(&cloud, cell_m, max_per_cell);
        let table = NearestTable::new(dense.clone(), 0.3, 0.7);
        prop_assert_eq!(voxel.len(), dense.len());
        for query in queries {
            let expected = brute_force(&voxel, query, radius_m, cell_m);
            prop_assert_eq!(found(&voxel, query, radius_m), expected);
            prop_assert_eq!(found(&dense, query, radius_m), expected);
            prop_assert_eq!(found(&table, query, radius_m), expected);
            for hint in 0..dense.len().min(3) {
                let from = dense.neighbor_from(query, radius_m, Some(hint));
                prop_assert_eq!(from.map(|found| dense.point(found.index)), expected);
            }
        }
    }

    #[test]
    fn a_cached_query_agrees_with_a_new_one(
        points in points(),
        start in query(),
        steps in prop::collection::vec((-0.1..0.1, -0.1..0.1), 1..40),
        radius_m in 0.05..1.0,
    ) {
        let dense = DenseMap::from_cloud(&PointCloud::new(points, 0.0), 0.25, 8);
        let mut cache = QueryCache::default();
        let mut query = start;
        for (k, (dx, dy)) in steps.into_iter().enumerate() {
            // Steps of every size: large ones make it search, small ones use the cache.
            let size = 0.1_f64.powi(k as i32 % 4);
            query += Vector2::new(dx, dy) * size;
            let again = dense.neighbor_cached(query, radius_m, &mut cache);
            prop_assert_eq!(again, dense.neighbor(query, radius_m));
        }
    }
}

#[test]
fn a_table_beyond_its_budget_is_not_used_and_answers_are_unchanged() {
    let hall = |k: i32| Point2::new(3.0 * f64::from(k), 2.0 * f64::from(k % 7));
    let cloud: PointCloud = (0..1000).map(hall).collect();
    let map = DenseMap::from_cloud(&cloud, 0.25, 8);
    // 3 km by 14 m: 600,000 squares of 0.3 m with their margin, but 65 million of 3 cm.
    let (coarse, fine) = (
        NearestTable::new(map.clone(), 0.3, 0.7),
        NearestTable::new(map.clone(), 0.03, 0.7),
    );
    assert!(coarse.is_tabulated() && !fine.is_tabulated());
    for k in 0..200 {
        let query = Point2::new(15.1 * f64::from(k), 0.07 * f64::from(k));
        let expected = map.neighbor(query, 2.0);
        assert_eq!(coarse.neighbor(query, 2.0), expected);
        assert_eq!(fine.neighbor(query, 2.0), expected);
    }
    let nowhere = [Point2::new(0.0, 0.0), Point2::new(f64::INFINITY, 0.0)];
    let map = DenseMap::from_cloud(&nowhere.into_iter().collect(), 0.25, 8);
    let _ = NearestTable::new(map, 0.1, 0.7).neighbor(Point2::new(0.1, 0.0), 1.0);
}

#[test]
fn maps_far_larger_than_their_points_stay_small_and_exact() {
    // 2·10⁶ m across in cells of 0.25 m: a table of all cells would take 256 TB.
    let points: Vec<_> = (0..40)
        .map(|k| {
            let k = f64::from(k);
            Point2::new(
                (k * 1.7).sin() * 10.0_f64.powf(k / 7.0),
                (k * 2.3).cos() * 10.0_f64.powf(k / 7.0),
            )
        })
        .collect();
    let cloud = PointCloud::new(points.clone(), 0.0);
    let voxel = VoxelMap::from_cloud(&cloud, 0.25, 8);
    let dense = DenseMap::from_cloud(&cloud, 0.25, 8);
    for point in &points {
        for offset in [0.0, 0.1, 3.0] {
            let query = point + Vector2::repeat(offset);
            let expected = brute_force(&voxel, query, 1e4, 0.25);
            assert_eq!(found(&voxel, query, 1e4), expected);
            assert_eq!(found(&dense, query, 1e4), expected);
        }
    }
}

#[test]
fn full_cells_ignore_further_points_and_the_radius_is_exclusive() {
    let mut map = VoxelMap::new(1.0, 2);
    let points = [0.1, 0.2, 0.3, 1.5].map(|x| Point2::new(x, 0.5));
    map.insert(&points, &[None; 4]);
    assert_eq!(map.len(), 3);
    assert_eq!(map.nearest(&Point2::new(2.0, 0.5), 0.5), None);
    assert_eq!(map.nearest(&Point2::new(2.0, 0.5), 0.500_001), Some(2));
}

#[test]
fn points_that_are_not_finite_are_left_out() {
    let cloud = PointCloud::from_iter([
        Point2::new(f64::NAN, 0.0),
        Point2::new(f64::INFINITY, 0.0),
        Point2::new(1.0, 0.0),
    ]);
    let dense = DenseMap::from_cloud(&cloud, 0.25, 8);
    let voxel = VoxelMap::from_cloud(&cloud, 0.25, 8);
    assert_eq!((dense.len(), voxel.len()), (1, 1));
    assert_eq!(dense.source_index(0), 2);
    let nowhere = Point2::new(f64::NAN, 0.0);
    assert!(dense.neighbor(nowhere, 10.0).is_none());
    assert!(voxel.neighbor(nowhere, 10.0).is_none());
}
