//! Registration of arbitrary clouds: empty, collinear, duplicate, and with extreme coordinates.

use arbitrary::{Result, Unstructured};
use ch16_slam2d::cloud::{DenseMap, NearestMap, PointCloud, VoxelMap};
use ch16_slam2d::icp::{Icp, IcpConfig, IcpSummary, IcpVariant, IcpWorkspace};
use ch16_slam2d::ndt::{NdtConfig, NdtMap, ndt_align};
use pr_geom::{Point2, SE2};

use crate::numbers::{finite, tame};

/// Largest number of points in a cloud.
const MAX_POINTS: usize = 32;
/// Largest number of iterations.
const MAX_ITERATIONS: usize = 12;
/// Radius of the normals, m.
const NORMAL_RADIUS_M: f64 = 0.5;

/// The result is finite and the same for both maps; no panic.
pub fn fuzz(data: &[u8]) {
    // Missing bytes read as zeros; nothing else can fail.
    let _ = case(&mut Unstructured::new(data));
}

fn case(bytes: &mut Unstructured<'_>) -> Result<()> {
    let map = cloud(bytes)?;
    let scan = if bytes.ratio(1, 4)? {
        map.clone()
    } else {
        cloud(bytes)?
    };
    let init = if bytes.ratio(7, 8)? {
        SE2::new(tame(bytes)?, tame(bytes)?, tame(bytes)?)
    } else {
        SE2::new(finite(bytes)?, finite(bytes)?, finite(bytes)?)
    };
    if bytes.arbitrary()? {
        align_by_ndt(bytes, &map, &scan, init)
    } else {
        align_by_icp(bytes, &map, &scan, init)
    }
}

fn cloud(bytes: &mut Unstructured<'_>) -> Result<PointCloud> {
    let mut cloud = PointCloud::default();
    let shape = bytes.int_in_range(0..=5)?;
    let factor = *bytes.choose(&[1.0, 1e-300, 1e300, 1e150, 1e9, 1e-9])?;
    let along = Point2::new(tame(bytes)?, tame(bytes)?);
    for _ in 0..bytes.int_in_range(0..=MAX_POINTS)? {
        let point = match shape {
            0 => along,
            1 => along * tame(bytes)?,
            2 => Point2::new(finite(bytes)?, finite(bytes)?),
            3 => Point2::new(tame(bytes)?, tame(bytes)?) * factor,
            _ => Point2::new(tame(bytes)?, tame(bytes)?),
        };
        let is_finite = point.x.is_finite() && point.y.is_finite();
        cloud.push(if is_finite { point } else { along });
    }
    if bytes.arbitrary()? {
        cloud.estimate_normals(NORMAL_RADIUS_M);
    }
    Ok(cloud)
}

fn align_by_icp(
    bytes: &mut Unstructured<'_>,
    cloud: &PointCloud,
    scan: &PointCloud,
    init: SE2,
) -> Result<()> {
    let config = IcpConfig {
        variant: *bytes.choose(&[IcpVariant::PointToPoint, IcpVariant::PointToPlane])?,
        max_iterations: bytes.int_in_range(0..=MAX_ITERATIONS)?,
        tau_m: *bytes.choose(&[0.6, 0.01, 0.1, 2.0, 10.0])?,
        tolerance: *bytes.choose(&[1e-4, 0.0])?,
        min_pairs: bytes.int_in_range(0..=8)?,
        trim: *bytes.choose(&[0.0, 0.5, 0.9, 1.0])?,
        huber_width_m: *bytes.choose(&[f64::INFINITY, 0.1, 1e-9])?,
    };
    let cell_m = *bytes.choose(&[0.25, 0.05, 3.0])?;
    let max_per_cell = *bytes.choose(&[6, 1, usize::MAX])?;
    let voxels = VoxelMap::from_cloud(cloud, cell_m, max_per_cell);
    let mut dense = DenseMap::new(cell_m, max_per_cell);
    dense.rebuild(cloud);
    let found = register(scan, &voxels, init, &config);
    let again = register(scan, &dense, init, &config);
    // Debug output contains every bit of a number.
    assert_eq!(format!("{found:?}"), format!("{again:?}"));
    Ok(())
}

/// Registers, and checks the guarantees of every registration.
pub fn register(
    scan: &PointCloud,
    map: &impl NearestMap,
    init: SE2,
    config: &IcpConfig,
) -> IcpSummary {
    let mut workspace = IcpWorkspace::new();
    let found = Icp::new(scan, map, init, config, &mut workspace).run();
    assert_finite(&found.pose, &init);
    assert!(found.inliers <= scan.len());
    assert!(found.iterations <= config.max_iterations);
    // Infinite without pairs.
    assert_eq!(found.rmse_m.is_finite(), found.inliers > 0, "{found:?}");
    found
}

fn align_by_ndt(
    bytes: &mut Unstructured<'_>,
    cloud: &PointCloud,
    scan: &PointCloud,
    init: SE2,
) -> Result<()> {
    let cell_m = *bytes.choose(&[0.5, 0.05, 3.0, 1e-3])?;
    let map = NdtMap::build(cloud, cell_m, bytes.int_in_range(2..=5)?);
    for cell in map.cells() {
        let numbers = cell.mean.iter().chain(&cell.covariance);
        let numbers: Vec<f64> = numbers.chain(&cell.information).copied().collect();
        assert!(numbers.iter().all(|value| value.is_finite()), "{cell:?}");
    }
    let config = NdtConfig {
        max_iterations: bytes.int_in_range(0..=MAX_ITERATIONS)?,
        ..NdtConfig::default()
    };
    let found = ndt_align(scan, &map, init, &config);
    assert_finite(&found.pose, &init);
    assert!(found.score.is_finite(), "{found:?}");
    assert!(found.score >= map.score(scan, &init), "{found:?}");
    assert!(found.iterations <= config.max_iterations);
    Ok(())
}

fn assert_finite(pose: &SE2, init: &SE2) {
    let is_finite = pose.to_array().iter().all(|value| value.is_finite());
    assert!(is_finite, "{pose:?} from {init:?}");
}
