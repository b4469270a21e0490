//! Point clouds as CSV: the input of `ch16 register`, and the registration of it.

use ch16_slam2d::cloud::{DenseMap, PointCloud};
use ch16_slam2d::icp::{IcpConfig, IcpVariant};
use pr_geom::SE2;

use crate::registration::register;

/// Larger clouds are read, but not registered: this target tests the reader.
const MAX_REGISTERED: usize = 24;

/// An error names a line. A cloud that is read has finite points and normals of length 1.
pub fn fuzz(text: &[u8]) {
    let lines = text.split(|&byte| byte == b'\n').count();
    let cloud = match PointCloud::from_csv(text) {
        Ok(cloud) => cloud,
        Err(rejection) => {
            assert!(rejection.to_string().len() < 100, "{rejection}");
            return;
        }
    };
    assert!((1..=lines).contains(&cloud.len()));
    for index in 0..cloud.len() {
        let point = cloud.point(index);
        assert!(point.x.is_finite() && point.y.is_finite(), "{point}");
        if let Some(normal) = cloud.normal(index) {
            // 1e-15: a few last digits of a number near 1.
            assert!((normal.norm() - 1.0).abs() < 1e-15, "{normal}");
        }
    }
    if cloud.len() <= MAX_REGISTERED {
        let again = PointCloud::from_csv(written(&cloud)).expect("what was written can be read");
        assert_eq!((again.xs(), again.ys()), (cloud.xs(), cloud.ys()));
        register_on_itself(&cloud);
    }
}

fn written(cloud: &PointCloud) -> String {
    let lines = cloud
        .iter()
        .map(|point| format!("{},{}\n", point.x, point.y));
    lines.collect()
}

fn register_on_itself(cloud: &PointCloud) {
    for variant in [IcpVariant::PointToPlane, IcpVariant::PointToPoint] {
        let config = IcpConfig {
            variant,
            tau_m: 0.5,
            ..IcpConfig::default()
        };
        let mut map = DenseMap::new(0.25, usize::MAX);
        map.rebuild(cloud);
        register(cloud, &map, SE2::identity(), &config);
    }
}
