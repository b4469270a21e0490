//! What a registration claims while its input loses what it measures with.

use std::sync::Arc;

use ch16_slam2d::cloud::{DenseMap, PointCloud};
use ch16_slam2d::graph::Keyframe;
use ch16_slam2d::icp::{IcpConfig, IcpResult, IcpVariant, StopReason, closed_form, icp};
use ch16_slam2d::loops::{KeyframeView, LoopCandidate, LoopConfig, LoopWorkspace, verify_loop};
use ch16_slam2d::matching::{InformationFrame, MatcherKind, TrustConfig, result_information};
use ch16_slam2d::ndt::{NdtConfig, NdtMap, NdtStop, ndt_align};
use nalgebra::Matrix3;
use pr_geom::{Point2, SE2};

const TRUST: TrustConfig = TrustConfig {
    sigma_m: 0.05,
    covariance_scale: 12.0,
    information_cap: f64::INFINITY,
};
const VARIANTS: [IcpVariant; 2] = [IcpVariant::PointToPlane, IcpVariant::PointToPoint];

/// Points every `spacing_m` along the walls of a room of 4 m by 3 m with an alcove.
fn room(spacing_m: f64) -> Vec<Point2<f64>> {
    let corners = [
        (0.0, 0.0),
        (4.0, 0.0),
        (4.0, 3.0),
        (2.5, 3.0),
        (2.5, 2.2),
        (0.0, 2.2),
    ];
    let ends = corners.iter().cycle().skip(1);
    let walls = corners.iter().zip(ends).flat_map(|(&(x0, y0), &(x1, y1))| {
        let length_m = f64::hypot(x1 - x0, y1 - y0);
        let count = (length_m / spacing_m).floor() as usize;
        (0..count).map(move |k| {
            let share = k as f64 * spacing_m / length_m;
            Point2::new(x0 + share * (x1 - x0), y0 + share * (y1 - y0))
        })
    });
    walls.collect()
}

fn moved() -> SE2 {
    SE2::new(0.15, 0.1, 0.03)
}

/// Registers `target` on itself, moved, and returns the result, the information and the distance from the truth, m.
fn registered(target: &[Point2<f64>], config: &IcpConfig) -> (IcpResult, Matrix3<f64>, f64) {
    let mut target: PointCloud = target.iter().copied().collect();
    let source = target.transformed(&moved().inverse());
    target.estimate_normals(0.3);
    let map = DenseMap::from_cloud(&target, 0.25, usize::MAX);
    let found = icp(&source, &map, SE2::identity(), config);
    let information = result_information(&found, config, &TRUST);
    let off_m = (found.pose.position() - moved().position()).norm();
    (found, information, off_m)
}

fn settings(variant: IcpVariant) -> IcpConfig {
    IcpConfig {
        variant,
        max_iterations: 200,
        ..IcpConfig::default()
    }
}

#[test]
fn no_wrong_pose_of_an_ever_coarser_room_claims_to_have_converged() {
    let mut converged = [0; 2];
    for spacing_m in [0.03, 0.05, 0.1, 0.15, 0.25, 0.4, 0.8, 1.5] {
        for (variant, converged) in VARIANTS.into_iter().zip(&mut converged) {
            let (found, information, off_m) = registered(&room(spacing_m), &settings(variant));
            let what = format!(
                "{variant:?}, {spacing_m} m: {off_m:.3} m off, {}",
                found.stop
            );
            if found.stop.converged() {
                *converged += 1;
                // Point to point is at rest with points beside each other's, up to half their distance off in x and y.
                let apart_m = match variant {
                    IcpVariant::PointToPlane => 0.0,
                    IcpVariant::PointToPoint => 0.71 * spacing_m,
                };
                assert!(off_m < apart_m.max(0.05), "{what}");
            }
            // No normals without three others within 0.3 m, and eight points are left of the coarsest room at most.
            if variant == IcpVariant::PointToPlane && spacing_m > 0.2 {
                let is_refused = matches!(
                    found.stop,
                    StopReason::TooFewNormals { .. } | StopReason::TooFewPairs { .. }
                );
                assert!(is_refused && !found.stop.is_supported(), "{what}");
                assert_eq!(information, Matrix3::zeros());
            }
        }
    }
    assert!(converged[0] >= 3 && converged[1] >= 4, "{converged:?}");
}

#[test]
fn ever_fewer_pairs_end_without_a_claim() {
    for variant in VARIANTS {
        for trim in [0.0, 0.5, 0.99, 1.0] {
            let config = IcpConfig {
                trim,
                ..settings(variant)
            };
            let (found, information, _) = registered(&room(0.05), &config);
            let is_cut = matches!(
                found.stop,
                StopReason::TooFewPairs { .. } | StopReason::TooFewNormals { .. }
            );
            assert_eq!(is_cut, trim > 0.9, "{variant:?}, {trim}: {}", found.stop);
            assert_eq!(
                information == Matrix3::zeros(),
                is_cut,
                "{variant:?}, {trim}"
            );
        }
        // Zero is no number of pairs that measures a pose.
        let config = IcpConfig {
            min_pairs: 0,
            ..settings(variant)
        };
        let (found, ..) = registered(&[], &config);
        assert!(
            !found.stop.converged() && !found.stop.is_supported(),
            "{}",
            found.stop
        );
    }
}

#[test]
fn a_kernel_that_takes_all_pairs_for_outliers_ends_without_a_claim() {
    for variant in VARIANTS {
        let at = |huber_width_m, off_m: f64| {
            let config = IcpConfig {
                huber_width_m,
                ..settings(variant)
            };
            let mut target: PointCloud = room(0.05).into_iter().collect();
            // Every second point is off to one side, and every other to the other: no pose fits any.
            let off = |k: usize| if k.is_multiple_of(2) { off_m } else { -off_m };
            let source = target.iter().enumerate();
            let source: PointCloud = source
                .map(|(k, p)| Point2::new(p.x + off(k), p.y + off(k / 2)))
                .collect();
            target.estimate_normals(0.3);
            let map = DenseMap::from_cloud(&target, 0.25, usize::MAX);
            let found = icp(&source, &map, SE2::identity(), &config);
            let information = result_information(&found, &config, &TRUST);
            (found.stop, information.trace())
        };
        let (fits, known) = at(0.05, 0.01);
        assert!(fits.is_supported(), "{variant:?}: {fits}");
        let (stop, unknown) = at(1e-12, 0.01);
        assert!(
            matches!(stop, StopReason::TooFewInliers { .. }),
            "{variant:?}: {stop}"
        );
        assert!(known > 0.0 && unknown == 0.0, "{known} {unknown}");
    }
}

#[test]
fn a_corridor_names_the_direction_that_no_pair_measures() {
    let wall = |y: f64| (0..200).map(move |k| Point2::new(0.05 * f64::from(k), y));
    let corridor: Vec<_> = wall(0.0).chain(wall(2.0)).collect();
    for heading in [0.0, 0.7, 2.5] {
        let turn = SE2::new(0.0, 0.0, heading);
        let turned: Vec<_> = corridor.iter().map(|p| turn.transform(*p)).collect();
        let (found, information, _) = registered(&turned, &settings(IcpVariant::PointToPlane));
        let StopReason::Unobservable {
            direction: [x, y, rotation],
        } = found.stop
        else {
            panic!("{heading}: {}", found.stop)
        };
        // 1e-3: the normals of straight walls.
        let across = x * heading.sin() - y * heading.cos();
        assert!(
            across.abs() < 1e-3 && rotation.abs() < 1e-3,
            "{:?}",
            found.stop
        );
        let degrees = format!("along {:.0}°", heading.to_degrees());
        assert!(found.stop.to_string().contains(&degrees), "{}", found.stop);
        // It keeps the guess along the corridor, and is right across.
        let error = found.pose.position() - moved().position();
        let off_m = error.y * heading.cos() - error.x * heading.sin();
        assert!(off_m.abs() < 0.1, "{off_m}");
        assert!(information.symmetric_eigenvalues().min() < 1e-3 * information.trace());
        assert!(found.stop.is_supported() && !found.stop.converged());
    }
}

#[test]
fn coincident_points_measure_no_rotation() {
    let at = |spread_m: f64| {
        let place = |k: i32| Point2::new(1.3, -0.7 + spread_m * f64::from(k));
        let points: Vec<_> = (0..9).map(place).collect();
        let turned: Vec<_> = points.iter().map(|p| moved().transform(*p)).collect();
        (closed_form(&points, &turned), points)
    };
    for spread_m in [1.0, 1e-2, 1e-4] {
        let (found, _) = at(spread_m);
        assert!(found.measures_rotation);
        // 1e-8: the last bits of coordinates of 1 m, over a millimetre.
        assert!(
            (found.pose.theta() - moved().theta()).abs() < 1e-8,
            "{spread_m}"
        );
    }
    for spread_m in [1e-8, 0.0] {
        let (found, points) = at(spread_m);
        assert!(!found.measures_rotation);
        let (found, information, _) = registered(&points, &settings(IcpVariant::PointToPoint));
        let unobservable = StopReason::Unobservable {
            direction: [0.0, 0.0, 1.0],
        };
        assert_eq!(found.stop, unobservable);
        assert!(found.stop.to_string().contains("rotation"));
        assert!(!found.stop.converged() && information.m11 > 0.0);
    }
}

#[test]
fn ndt_without_points_in_cells_claims_nothing() {
    let mut converged = 0;
    for spacing_m in [0.03, 0.05, 0.1, 0.15, 0.25, 0.4, 0.8] {
        let target: PointCloud = room(spacing_m).into_iter().collect();
        let source = target.transformed(&moved().inverse());
        let map = NdtMap::build(&target, 0.6, 4);
        let config = NdtConfig {
            max_iterations: 200,
            ..NdtConfig::default()
        };
        let found = ndt_align(&source, &map, SE2::identity(), &config);
        let off_m = (found.pose.position() - moved().position()).norm();
        let what = format!("{spacing_m} m: {off_m:.3} m off, {}", found.stop);
        if found.stop.converged() {
            converged += 1;
            assert!(off_m < 0.1, "{what}");
        }
        if map.cells().is_empty() {
            assert!(!found.stop.is_supported(), "{what}");
        }
    }
    assert!(converged > 0);
    let cloud: PointCloud = room(0.05).into_iter().collect();
    let nothing = NdtMap::build(&PointCloud::default(), 0.6, 4);
    let stop = ndt_align(&cloud, &nothing, SE2::identity(), &NdtConfig::default()).stop;
    assert_eq!(
        stop,
        NdtStop::TooFewPoints {
            points: 0,
            min_points: 16
        }
    );
    // Points of one place lie in a cell, and measure no rotation.
    let one_place: PointCloud = [Point2::new(0.3, 0.3); 20].into_iter().collect();
    let map = NdtMap::build(&one_place, 0.6, 4);
    let at = SE2::from_xy(0.01, 0.0);
    let stop = ndt_align(&one_place, &map, at, &NdtConfig::default()).stop;
    assert!(!stop.converged(), "{stop}");
}

/// Without normals the pose of a loop is the guess, which fits: no edge may hold it.
#[test]
fn a_loop_that_nothing_registered_is_rejected() {
    let verdict = |with_normals: bool| {
        let mut old: PointCloud = room(0.1).into_iter().collect();
        let new = Arc::new(old.transformed(&moved().inverse()));
        if with_normals {
            old.estimate_normals(0.3);
        }
        let keyframes = [Arc::new(old), new].into_iter().enumerate();
        let keyframes = keyframes.map(|(node, scan)| Keyframe {
            node,
            frame: node,
            stamp_s: node as f64,
            scan,
        });
        let config = LoopConfig {
            matcher: MatcherKind::PointToPlane,
            submap_half_width: 0,
            max_rmse_m: f64::INFINITY,
            ..LoopConfig::default()
        };
        let view = KeyframeView {
            poses: &[SE2::identity(); 2],
            keyframes: &keyframes.collect::<Vec<_>>(),
        };
        let candidate = LoopCandidate {
            node: 0,
            distance_m: 0.0,
            proposal: None,
        };
        let mut workspace = LoopWorkspace::new(config.matcher.build(&config.submap));
        let frame = InformationFrame::Exact;
        let assumed = Ok(Matrix3::identity());
        verify_loop(view, 1, candidate, assumed, frame, &config, &mut workspace)
    };
    let found = verdict(true);
    assert_eq!(found.rejection, None);
    assert!((found.registered.position() - moved().position()).norm() < 0.01);
    let refused = verdict(false);
    assert_eq!(refused.registered, SE2::identity(), "the guess");
    let why = refused
        .rejection
        .expect("nothing supports the pose")
        .to_string();
    assert!(why.starts_with("not registered: ICP: 0 of "), "{why}");
}
