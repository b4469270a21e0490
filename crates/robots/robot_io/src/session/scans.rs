//! Filtered scans within a bound of bytes.
//!
//! If the mean size fits the bound, all scans keep all bits. Otherwise each scan is stored as precisely as its share of
//! the bytes allows: with all bits, or as 16-bit multiples of a power of two of a metre. A scan with more points is
//! downsampled until it fits. Normals are stored only if they cannot be computed from the scan's own points, which works
//! for every scan of [`ScanPreparer`](ch16_slam2d::scan::ScanPreparer). A scan that was read is stored in the same form
//! again.

use std::borrow::Cow;

use ch16_slam2d::cloud::PointCloud;
use pr_geom::{Point2, Vector2, math};
use serde::{Deserialize, Serialize};

/// Bytes beside the points: stamp, kinds, shift, counts.
const HEAD_BYTES: usize = 15;
/// Finest step of a 16-bit coordinate: 2⁻¹² m.
const FINEST_SHIFT: i8 = 12;
/// Coarsest step: 2¹⁰ m.
const COARSEST_SHIFT: i8 = -10;
/// Code of a missing normal among the 16-bit angles.
const NO_NORMAL: u16 = u16::MAX;
/// Number of 16-bit angles in a turn.
const ANGLES: f64 = 65534.0;
/// Growth of the cells while a scan does not fit.
const THINNER: f64 = 1.25;

/// A scan as it stands in the file.
#[derive(Serialize, Deserialize)]
pub struct StoredScan {
    stamp_s: f64,
    points: Points,
    normals: Normals,
}

/// Coordinates in the body frame.
#[derive(Serialize, Deserialize)]
enum Points {
    /// x and y with all bits, m.
    Exact(Vec<[f64; 2]>),
    /// Multiples of 2^−shift m.
    Steps { shift: i8, steps: Vec<[Step; 2]> },
}

/// Normals of the points.
#[derive(Serialize, Deserialize)]
enum Normals {
    /// They follow from the points.
    Computed,
    /// With all bits; `[0, 0]` if a point has none.
    Exact(Vec<[f64; 2]>),
    /// Fractions of a turn, beginning at −π.
    Angles(Vec<Angle>),
}

/// A coordinate of two bytes, whatever its value.
#[derive(Clone, Copy, Serialize, Deserialize)]
struct Step(#[serde(with = "postcard::fixint::le")] i16);

/// A direction of two bytes.
#[derive(Clone, Copy, Serialize, Deserialize)]
struct Angle(#[serde(with = "postcard::fixint::le")] u16);

/// Encoding of coordinates.
#[derive(Clone, Copy)]
enum Precision {
    Exact,
    /// Multiples of 2^−shift m.
    Steps(i8),
}

/// A scan that fits into its share of the bytes, and its encoding.
struct Fitted<'a> {
    scan: Cow<'a, PointCloud>,
    precision: Precision,
    has_computed_normals: bool,
}

/// Stores scans with a mean of at most `most_bytes` each; normals are computed from the points within `radius_m`.
pub fn store_all<'a>(
    scans: impl Iterator<Item = &'a PointCloud>,
    radius_m: f64,
    most_bytes: usize,
) -> Vec<StoredScan> {
    let fitted: Vec<Fitted<'_>> = scans.map(|scan| fit(scan, radius_m, most_bytes)).collect();
    let exact: usize = fitted.iter().map(|scan| scan.bytes(Precision::Exact)).sum();
    let all_exact = exact <= most_bytes * fitted.len();
    let store = |scan: &Fitted<'_>| {
        scan.stored(if all_exact {
            Precision::Exact
        } else {
            scan.precision
        })
    };
    fitted.iter().map(store).collect()
}

/// Stores a scan with all bits, whatever its size.
pub fn store_exactly(scan: &PointCloud, radius_m: f64) -> StoredScan {
    fit(scan, radius_m, usize::MAX).stored(Precision::Exact)
}

/// Chooses the best precision that fits; downsamples the scan if none does.
fn fit(scan: &PointCloud, radius_m: f64, most_bytes: usize) -> Fitted<'_> {
    let mut cell_m = radius_m.max(1e-3) / 16.0;
    let mut fitted = Fitted::new(Cow::Borrowed(scan), radius_m);
    loop {
        let steps = (COARSEST_SHIFT..=FINEST_SHIFT).rev().map(Precision::Steps);
        for precision in [Precision::Exact].into_iter().chain(steps) {
            if fitted.bytes(precision) <= most_bytes && fitted.is_representable(precision) {
                return Fitted {
                    precision,
                    ..fitted
                };
            }
        }
        let mut thinned = scan.downsample(cell_m);
        thinned.estimate_normals(radius_m);
        fitted = Fitted::new(Cow::Owned(thinned), radius_m);
        cell_m *= THINNER;
    }
}

impl<'a> Fitted<'a> {
    fn new(scan: Cow<'a, PointCloud>, radius_m: f64) -> Self {
        Self {
            has_computed_normals: *scan
                == with_computed_normals(scan.iter().collect(), scan.stamp_s(), radius_m),
            scan,
            precision: Precision::Exact,
        }
    }

    fn bytes(&self, precision: Precision) -> usize {
        let (point, normal) = match precision {
            Precision::Exact => (16, 16),
            Precision::Steps(_) => (4, 2),
        };
        let stored_normal = if self.has_computed_normals { 0 } else { normal };
        HEAD_BYTES + self.scan.len() * (point + stored_normal)
    }

    fn is_representable(&self, precision: Precision) -> bool {
        let Precision::Steps(shift) = precision else {
            return true;
        };
        let limit = f64::from(i16::MAX);
        let mut coordinates = self.scan.xs().iter().chain(self.scan.ys());
        coordinates.all(|value| (value * per_metre(shift)).round().abs() <= limit)
    }

    fn stored(&self, precision: Precision) -> StoredScan {
        let scan = &self.scan;
        let normals = (0..scan.len()).map(|index| scan.normal(index));
        let (points, normals) = match precision {
            Precision::Exact => {
                let exact = normals.map(|normal| normal.unwrap_or_default().into());
                (
                    Points::Exact(scan.iter().map(|point| point.into()).collect()),
                    Normals::Exact(exact.collect()),
                )
            }
            Precision::Steps(shift) => {
                let step = |value: f64| Step((value * per_metre(shift)).round() as i16);
                let steps = scan.iter().map(|point| [step(point.x), step(point.y)]);
                (
                    Points::Steps {
                        shift,
                        steps: steps.collect(),
                    },
                    Normals::Angles(normals.map(Angle::new).collect()),
                )
            }
        };
        StoredScan {
            stamp_s: scan.stamp_s(),
            points,
            normals: if self.has_computed_normals {
                Normals::Computed
            } else {
                normals
            },
        }
    }
}

impl StoredScan {
    /// The scan; computed normals use the points within `radius_m`.
    ///
    /// # Errors
    /// What is invalid.
    pub fn restored(self, radius_m: f64) -> Result<PointCloud, String> {
        let points: Vec<Point2<f64>> = match self.points {
            Points::Exact(points) => points.into_iter().map(Point2::from).collect(),
            Points::Steps { shift, steps } => {
                if !(COARSEST_SHIFT..=FINEST_SHIFT).contains(&shift) {
                    return Err(format!(
                        "a scan has coordinates of the unknown shift {shift}"
                    ));
                }
                let coordinate = |step: Step| f64::from(step.0) / per_metre(shift);
                let points = steps.into_iter().map(|step| step.map(coordinate));
                points.map(Point2::from).collect()
            }
        };
        if !self.stamp_s.is_finite() || !points.iter().all(|p| p.x.is_finite() && p.y.is_finite()) {
            return Err("a scan has a value that is not finite".to_owned());
        }
        let normals: Vec<Option<Vector2<f64>>> = match self.normals {
            Normals::Computed => return Ok(with_computed_normals(points, self.stamp_s, radius_m)),
            Normals::Exact(normals) => normals.into_iter().map(present).collect(),
            Normals::Angles(angles) => angles.into_iter().map(Angle::normal).collect(),
        };
        let is_normal = |normal: &Vector2<f64>| normal.iter().all(|value| value.abs() <= 1.5);
        if normals.len() != points.len() || !normals.iter().flatten().all(is_normal) {
            return Err("a scan needs one normal of length 1 for each point".to_owned());
        }
        let mut cloud = PointCloud::new(Vec::new(), self.stamp_s);
        for (point, normal) in points.into_iter().zip(normals) {
            cloud.push_with_normal(point, normal);
        }
        Ok(cloud)
    }
}

impl Angle {
    fn new(normal: Option<Vector2<f64>>) -> Self {
        Self(normal.map_or(NO_NORMAL, |normal| {
            let turn = 0.5 + math::atan2(normal.y, normal.x) / core::f64::consts::TAU;
            (turn * ANGLES).round() as u16
        }))
    }

    fn normal(self) -> Option<Vector2<f64>> {
        (self.0 != NO_NORMAL).then(|| {
            let turn = f64::from(self.0) / ANGLES - 0.5;
            let (sin, cos) = math::sin_cos(turn * core::f64::consts::TAU);
            Vector2::new(cos, sin)
        })
    }
}

fn present(normal: [f64; 2]) -> Option<Vector2<f64>> {
    (normal != [0.0; 2]).then(|| Vector2::from(normal))
}

fn with_computed_normals(points: Vec<Point2<f64>>, stamp_s: f64, radius_m: f64) -> PointCloud {
    let mut cloud = PointCloud::new(points, stamp_s);
    cloud.estimate_normals(radius_m);
    cloud
}

/// Steps per metre: a power of two.
fn per_metre(shift: i8) -> f64 {
    let power = (1_u64 << shift.unsigned_abs()) as f64;
    if shift >= 0 { power } else { 1.0 / power }
}
