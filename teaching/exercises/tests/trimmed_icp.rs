//! 6. ICP with trimming, and the box that moved.

use ch16_lab::basin::BasinScene;
use ch16_lab::moving_box::{BoxConfig, BoxMethods, BoxScene};
use ch16_listings::{
    IcpConfig, IcpResult, IcpVariant, PointCloud, SE2, Translation, VoxelMap, associate,
};
use ch16_slam2d::icp::{self, IcpWorkspace};
use exercises::icp;
use nalgebra::{Point2, Vector2};
use serde::Deserialize;
use slam2d_tests::{assert_close, reference};

use crate::canonical::{assert_same_pose, listing};

fn map_of(cloud: &PointCloud, max_per_cell: usize) -> VoxelMap {
    let mut map = VoxelMap::new(0.25, max_per_cell);
    map.insert(&cloud.points, &cloud.normals(0.3));
    map
}

#[derive(Deserialize)]
struct Basin {
    target: Vec<[f64; 2]>,
    source: Vec<[f64; 2]>,
    truth: [f64; 3],
    runs: Vec<Run>,
}

#[derive(Deserialize)]
struct Run {
    heading_deg: f64,
    dx: f64,
    dy: f64,
    variant: String,
    tau: f64,
    pose: [f64; 3],
    iterations: usize,
    rmse: f64,
    inliers: usize,
}

/// Every fourth registration of `tests/reference/basin.json`: right answers, quarter turns, and other false minima.
#[test]
fn without_trimming_every_registration_ends_where_the_reference_ends() {
    let basin: Basin = reference("basin.json");
    let cloud = |points: &[[f64; 2]]| PointCloud {
        points: points.iter().map(|p| Point2::from(*p)).collect(),
        stamp: 0.0,
    };
    let (map, source) = (map_of(&cloud(&basin.target), 8), cloud(&basin.source));
    let pose = |[x, y, theta]: [f64; 3]| SE2::new(Vector2::new(x, y), theta);
    let [x, y, theta] = basin.truth;
    for run in basin.runs.iter().step_by(4) {
        let guess = [x + run.dx, y + run.dy, theta + run.heading_deg.to_radians()];
        let cfg = IcpConfig {
            variant: match run.variant.as_str() {
                "point-to-plane" => IcpVariant::PointToPlane,
                _ => IcpVariant::PointToPoint,
            },
            tau: run.tau,
            max_iters: BasinScene::MAX_ITERS,
            ..IcpConfig::default()
        };
        let found = icp(&source, &map, pose(guess), &cfg);
        assert_same_pose(found.pose, pose(run.pose), 1e-9);
        assert_eq!(found.trace.len(), run.iterations + 1);
        assert_eq!(found.trace.first(), Some(&pose(guess)));
        assert_eq!(found.trace.last(), Some(&found.pose));
        assert_eq!(found.inliers, run.inliers);
        assert_close("rmse", found.rmse, run.rmse, 1e-9);
    }
}

/// The sweeps of w16.8 with a fifth of the points on the box: source, map, and the core's answers.
fn moving_box(seed: u32) -> (PointCloud, VoxelMap, [icp::IcpSummary; 2]) {
    let scene = BoxScene::new(&BoxConfig {
        seed,
        ..BoxConfig::default()
    });
    let [plain, trimmed, _] = BoxMethods::default().configs();
    let core = [plain, trimmed].map(|cfg| scene.register(&cfg, &mut IcpWorkspace::new()));
    let map = map_of(&listing(scene.target()), scene.target().len());
    (listing(scene.source()), map, core)
}

fn settings(trim: f64) -> IcpConfig {
    IcpConfig {
        tau: 0.7,
        max_iters: 30,
        trim,
        ..IcpConfig::default()
    }
}

/// The page's exercise 6: a share of 25 % is dropped.
#[test]
fn trimming_takes_most_of_the_pull_of_a_box_that_moved() {
    let truth = SE2::from(BoxScene::truth());
    let mut bias = [Vector2::zeros(); 2];
    for seed in 1..=10 {
        let (source, map, core) = moving_box(seed);
        for (k, trim) in [0.0, 0.25].into_iter().enumerate() {
            let found = icp(&source, &map, SE2::identity(), &settings(trim));
            assert_same_pose(found.pose, core[k].pose.into(), 1e-9);
            assert_eq!(found.inliers, core[k].inliers, "trim {trim}");
            bias[k] += (found.pose.translation() - truth.translation()) / 10.0;
        }
    }
    assert!(bias[1].norm() < bias[0].norm() / 3.0, "{bias:?}");
}

#[test]
fn the_longest_pairs_go_and_at_least_one_stays() {
    let (source, map, _) = moving_box(1);
    for (trim, share) in [(0.25, 0.75), (0.37, 0.63)] {
        let cfg = settings(trim);
        let found = icp(&source, &map, SE2::identity(), &cfg);
        let pairs = associate(&source, &map, &found.pose, cfg.tau);
        let mut squared: Vec<f64> = pairs.iter().map(|pair| pair.distance_squared()).collect();
        squared.sort_by(f64::total_cmp);
        let kept = (share * pairs.len() as f64).ceil() as usize;
        assert_eq!(found.inliers, kept);
        let mean = squared[..kept].iter().sum::<f64>() / kept as f64;
        assert_close("rmse", found.rmse, mean.sqrt(), 1e-12);
    }
    let all = IcpConfig {
        min_pairs: 1,
        ..settings(1.0)
    };
    assert_eq!(icp(&source, &map, SE2::identity(), &all).inliers, 1);
}

#[test]
fn too_few_pairs_end_it_at_the_guess() {
    let (source, map, _) = moving_box(1);
    let away = SE2::new(Vector2::new(50.0, 0.0), 0.0);
    let found = icp(&source, &map, away, &settings(0.25));
    assert_eq!((found.pose, found.inliers, found.trace.len()), (away, 0, 1));
    assert_eq!(found.rmse, f64::INFINITY);
    for (points, is_enough) in [(7, false), (8, true)] {
        let few = PointCloud {
            points: source.points[..points].to_vec(),
            stamp: 0.0,
        };
        let found = icp(&few, &map, SE2::identity(), &settings(0.0));
        let moves = found.trace.len() > 1;
        assert_eq!(moves, is_enough, "{points} pairs, and min_pairs is 8");
    }
}

/// Two walls that meet and a third: points every 10 cm, each with its normal.
fn room() -> (PointCloud, Vec<Option<Vector2<f64>>>) {
    let places = (1..=20).map(|k| 0.1 * f64::from(k));
    let (points, normals) = places
        .flat_map(|along| {
            [
                (Point2::new(along, 0.0), Some(Vector2::y())),
                (Point2::new(0.0, along), Some(Vector2::x())),
                (Point2::new(along, 3.0), Some(-Vector2::y())),
            ]
        })
        .unzip();
    (PointCloud { points, stamp: 0.0 }, normals)
}

/// Registers a cloud, moved by less than half the distance of its points, on itself.
fn on_itself(
    cloud: &PointCloud,
    normals: &[Option<Vector2<f64>>],
    init: SE2,
    cfg: &IcpConfig,
) -> IcpResult {
    let mut map = VoxelMap::new(0.25, cloud.points.len());
    map.insert(&cloud.points, normals);
    let off = SE2::new(Vector2::new(0.02, 0.03), 0.005).inverse();
    let points = cloud.points.iter().map(|p| off.transform(p)).collect();
    icp(&PointCloud { points, stamp: 0.0 }, &map, init, cfg)
}

fn claims(variant: IcpVariant) -> IcpConfig {
    IcpConfig {
        variant,
        max_iters: 100,
        ..settings(0.0)
    }
}

#[test]
fn it_has_converged_only_if_a_small_increment_ended_it() {
    let (cloud, normals) = room();
    for variant in [IcpVariant::PointToPoint, IcpVariant::PointToPlane] {
        let at = |init, cfg: &IcpConfig| on_itself(&cloud, &normals, init, cfg).converged;
        let cfg = claims(variant);
        assert!(
            at(SE2::identity(), &cfg),
            "{variant:?}: all pairs are there"
        );
        let early = IcpConfig {
            max_iters: 1,
            ..cfg
        };
        assert!(
            !at(SE2::identity(), &early),
            "{variant:?}: the last increment is large, and converged is true"
        );
        let away = SE2::new(Vector2::new(50.0, 0.0), 0.0);
        assert!(
            !at(away, &cfg),
            "{variant:?}: there is no pair, and converged is true"
        );
    }
}

#[test]
fn steps_of_zero_for_want_of_normals_are_no_convergence() {
    let (cloud, normals) = room();
    let cfg = claims(IcpVariant::PointToPlane);
    for (known, measures) in [(0, false), (2, false), (15, false), (16, true)] {
        let few: Vec<_> = normals
            .iter()
            .enumerate()
            .map(|(k, normal)| normal.filter(|_| k < known))
            .collect();
        let found = on_itself(&cloud, &few, SE2::identity(), &cfg);
        assert_eq!(
            found.converged, measures,
            "{known} pairs have a normal, and 16 are needed: twice min_pairs"
        );
    }
}

/// Along a corridor every pose fits: the ridge takes no step there, and no pair measures how far it is.
#[test]
fn parallel_normals_measure_no_pose() {
    for heading in [0.0, 0.7, 2.5] {
        let turn = SE2::new(Vector2::zeros(), heading);
        let along = (0..80).map(|k| 0.05 * f64::from(k));
        let points = along.flat_map(|x| [Point2::new(x, 0.0), Point2::new(x, 2.0)]);
        let points: Vec<_> = points.map(|p| turn.transform(&p)).collect();
        let across = turn.transform(&Point2::new(0.0, 1.0)).coords;
        let normals = vec![Some(across); points.len()];
        let corridor = PointCloud { points, stamp: 0.0 };
        let cfg = claims(IcpVariant::PointToPlane);
        let found = on_itself(&corridor, &normals, SE2::identity(), &cfg);
        assert!(
            !found.converged && found.inliers > 100,
            "all {} normals point across the corridor, and converged is true",
            found.inliers
        );
    }
}

#[test]
fn coincident_points_measure_no_rotation() {
    let one_place = PointCloud {
        points: vec![Point2::new(0.3, 0.3); 20],
        stamp: 0.0,
    };
    let cfg = claims(IcpVariant::PointToPoint);
    let found = on_itself(&one_place, &[None; 20], SE2::identity(), &cfg);
    assert!(
        !found.converged && found.inliers == 20,
        "every rotation about the place fits, and converged is true"
    );
    assert!(found.rmse < 1e-9, "the position is found: {found:?}");
}

#[test]
fn trimming_away_the_pairs_leaves_no_claim() {
    let (cloud, normals) = room();
    for variant in [IcpVariant::PointToPoint, IcpVariant::PointToPlane] {
        for (trim, min_pairs) in [(0.95, 8), (0.99, 8), (1.0, 8), (1.0, 0)] {
            let cfg = IcpConfig {
                trim,
                min_pairs,
                ..claims(variant)
            };
            let found = on_itself(&cloud, &normals, SE2::identity(), &cfg);
            assert!(
                !found.converged,
                "{variant:?}: {} of {} pairs are left, which measure no pose, and converged is true",
                found.inliers,
                cloud.points.len()
            );
        }
    }
}

#[test]
fn a_small_increment_ends_it() {
    let (source, map, _) = moving_box(1);
    let guess = SE2::new(Vector2::new(0.3, 0.2), 0.1);
    let at = |tolerance| {
        let cfg = IcpConfig {
            tolerance,
            ..settings(0.0)
        };
        icp(&source, &map, guess, &cfg).trace
    };
    let (rough, fine) = (at(0.02), at(1e-6));
    assert!(rough.len() < fine.len(), "{} increments", rough.len() - 1);
    // The last increment is the first below the tolerance.
    let step = |pair: &[SE2]| (pair[1] * pair[0].inverse()).step_size();
    let steps: Vec<f64> = rough.windows(2).map(step).collect();
    let (last, before) = steps.split_last().expect("it moves");
    assert!(
        *last < 0.02 && before.iter().all(|step| *step >= 0.02),
        "{steps:?}"
    );
}
