//! Filtered scans within a bound of bytes.
//!
//! If the mean size fits the bound, all scans keep all bits. Otherwise each scan is stored as precisely as its share of
//! the bytes allows: with all bits, as 32-bit floats, or as 16-bit multiples of a power of two of a metre. A scan with
//! more points is downsampled until it fits. Normals are stored only if they cannot be computed from the scan's own
//! points, which works for every scan of [`ScanPreparer`](ch16_slam2d::scan::ScanPreparer). A scan that was read is
//! stored in the same form again.
//! again.

use std::borrow::Cow;

use ch16_slam2d::cloud::PointCloud;
use pr_geom::{Point2, Vector2, math};

use super::bytes::{Broken, Cursor, Writer};

/// Bytes before the points: encoding, shift, count, stamp.
const HEAD_BYTES: usize = 14;
/// Finest step of a 16-bit coordinate: 2⁻¹² m.
const FINEST_SHIFT: i8 = 12;
/// Coarsest step: 2¹⁰ m.
const COARSEST_SHIFT: i8 = -10;
/// Code of a missing normal among the 16-bit angles.
const NO_NORMAL: u16 = u16::MAX;
/// Number of 16-bit angles in a turn.
const ANGLES: f64 = 65534.0;
/// Larger coordinates are not stored as 32-bit floats, m.
const LARGEST_SINGLE_M: f64 = 1e30;
/// Growth of the cells while a scan does not fit.
const THINNER: f64 = 1.25;

/// Encoding of a coordinate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Precision {
    /// All bits.
    Exact,
    /// A 32-bit float.
    Single,
    /// A 16-bit multiple of 2^−shift m.
    Fixed(i8),
}

impl Precision {
    fn code(self) -> u8 {
        match self {
            Self::Exact => 0,
            Self::Single => 1,
            Self::Fixed(_) => 2,
        }
    }

    fn point_bytes(self) -> usize {
        match self {
            Self::Exact => 16,
            Self::Single => 8,
            Self::Fixed(_) => 4,
        }
    }

    fn normal_bytes(self) -> usize {
        match self {
            Self::Exact => 16,
            Self::Single | Self::Fixed(_) => 2,
        }
    }
}

/// A scan that fits into its share of the bytes, and its encoding.
struct Fitted<'a> {
    scan: Cow<'a, PointCloud>,
    precision: Precision,
    is_derived: bool,
}

impl Fitted<'_> {
    fn bytes(&self, precision: Precision) -> usize {
        bytes(self.scan.len(), precision, self.is_derived)
    }

    fn write(&self, precision: Precision, out: &mut Writer) {
        write_as(&self.scan, precision, self.is_derived, out);
    }
}

/// Writes scans with a mean of at most `most_bytes` each; normals are computed from the points within `radius_m`.
pub fn write_all<'a>(
    scans: impl Iterator<Item = &'a PointCloud>,
    radius_m: f64,
    most_bytes: usize,
    out: &mut Writer,
) {
    let fitted: Vec<Fitted<'_>> = scans.map(|scan| fit(scan, radius_m, most_bytes)).collect();
    let exact: usize = fitted.iter().map(|scan| scan.bytes(Precision::Exact)).sum();
    let all_exact = exact <= most_bytes * fitted.len();
    for scan in &fitted {
        let precision = if all_exact {
            Precision::Exact
        } else {
            scan.precision
        };
        scan.write(precision, out);
    }
}

/// Writes a scan with all bits, whatever its size.
pub fn write_exactly(scan: &PointCloud, radius_m: f64, out: &mut Writer) {
    fit(scan, radius_m, usize::MAX).write(Precision::Exact, out);
}

fn bytes(points: usize, precision: Precision, is_derived: bool) -> usize {
    let normal = if is_derived {
        0
    } else {
        precision.normal_bytes()
    };
    HEAD_BYTES + points * (precision.point_bytes() + normal)
}

/// Chooses the best precision that fits; downsamples the scan if none does.
fn fit(scan: &PointCloud, radius_m: f64, most_bytes: usize) -> Fitted<'_> {
    let mut fitting = Cow::Borrowed(scan);
    let mut cell_m = radius_m.max(1e-3) / 16.0;
    loop {
        let is_derived = *fitting == derived(&fitting, radius_m);
        let fixed = (COARSEST_SHIFT..=FINEST_SHIFT).rev().map(Precision::Fixed);
        let all = [Precision::Exact, Precision::Single]
            .into_iter()
            .chain(fixed);
        let fits = |precision: &Precision| {
            bytes(fitting.len(), *precision, is_derived) <= most_bytes
                && is_representable(*precision, &fitting)
        };
        if let Some(precision) = all.into_iter().find(fits) {
            return Fitted {
                scan: fitting,
                precision,
                is_derived,
            };
        }
        let mut thinned = scan.downsample(cell_m);
        thinned.estimate_normals(radius_m);
        fitting = Cow::Owned(thinned);
        cell_m *= THINNER;
    }
}

/// The scan with normals computed from its own points.
fn derived(scan: &PointCloud, radius_m: f64) -> PointCloud {
    let mut with_normals = PointCloud::new(scan.iter().collect(), scan.stamp_s());
    with_normals.estimate_normals(radius_m);
    with_normals
}

fn coordinates(scan: &PointCloud) -> impl Iterator<Item = f64> + '_ {
    scan.xs().iter().chain(scan.ys()).copied()
}

fn is_representable(precision: Precision, scan: &PointCloud) -> bool {
    match precision {
        Precision::Exact => true,
        Precision::Single => coordinates(scan).all(|value| value.abs() < LARGEST_SINGLE_M),
        Precision::Fixed(shift) => {
            let limit = f64::from(i16::MAX);
            coordinates(scan).all(|value| (value * steps(shift)).round().abs() <= limit)
        }
    }
}

/// Steps per metre: a power of two.
fn steps(shift: i8) -> f64 {
    let power = (1_u64 << shift.unsigned_abs()) as f64;
    if shift >= 0 { power } else { 1.0 / power }
}

fn write_as(scan: &PointCloud, precision: Precision, is_derived: bool, out: &mut Writer) {
    out.u8(precision.code() | (u8::from(!is_derived) << 2));
    let shift = match precision {
        Precision::Fixed(shift) => shift,
        _ => 0,
    };
    out.bytes(&shift.to_le_bytes());
    out.count(scan.len());
    out.f64(scan.stamp_s());
    for point in scan.iter() {
        for value in [point.x, point.y] {
            match precision {
                Precision::Exact => out.f64(value),
                Precision::Single => out.bytes(&(value as f32).to_le_bytes()),
                Precision::Fixed(shift) => {
                    let step = (value * steps(shift)).round() as i16;
                    out.bytes(&step.to_le_bytes());
                }
            }
        }
    }
    if is_derived {
        return;
    }
    for index in 0..scan.len() {
        let normal = scan.normal(index);
        if precision == Precision::Exact {
            let normal = normal.unwrap_or_default();
            out.f64(normal.x);
            out.f64(normal.y);
            continue;
        }
        let angle = normal.map_or(NO_NORMAL, |normal| {
            let turn = 0.5 + math::atan2(normal.y, normal.x) / core::f64::consts::TAU;
            (turn * ANGLES).round() as u16
        });
        out.bytes(&angle.to_le_bytes());
    }
}

/// Reads a scan.
pub fn read(from: &mut Cursor<'_>, radius_m: f64) -> Result<PointCloud, Broken> {
    let code = from.u8()?;
    let shift = from.u8()? as i8;
    let (precision, is_derived) = match code & 3 {
        0 if shift == 0 => (Precision::Exact, code & 4 == 0),
        1 if shift == 0 => (Precision::Single, code & 4 == 0),
        2 if (COARSEST_SHIFT..=FINEST_SHIFT).contains(&shift) => {
            (Precision::Fixed(shift), code & 4 == 0)
        }
        _ => {
            return Err(from.broken(format!(
                "unknown encoding {code} of points with shift {shift}"
            )));
        }
    };
    if code > 7 {
        return Err(from.broken(format!("unknown encoding {code} of points")));
    }
    let count = from.u32()? as usize;
    let stamp_s = from.f64()?;
    let each = bytes(1, precision, is_derived) - HEAD_BYTES;
    let bytes = count.saturating_mul(each);
    if bytes > from.left() || !stamp_s.is_finite() {
        let left = from.left();
        return Err(from.broken(format!(
            "expected a scan of {count} points in {bytes} bytes, {left} are left"
        )));
    }
    let mut points = Vec::with_capacity(count);
    for _ in 0..count {
        let mut value = || -> Result<f64, Broken> {
            Ok(match precision {
                Precision::Exact => from.number()?,
                Precision::Single => f64::from(from.f32()?),
                Precision::Fixed(shift) => f64::from(from.i16()?) / steps(shift),
            })
        };
        let (x, y) = (value()?, value()?);
        if !x.is_finite() || !y.is_finite() {
            return Err(from.broken("expected a point with finite coordinates"));
        }
        points.push(Point2::new(x, y));
    }
    let cloud = PointCloud::new(points, stamp_s);
    if is_derived {
        return Ok(derived(&cloud, radius_m));
    }
    let mut with_normals = PointCloud::new(Vec::new(), stamp_s);
    for point in cloud.iter() {
        let normal = if precision == Precision::Exact {
            let normal = Vector2::new(from.f64()?, from.f64()?);
            let is_normal = normal.iter().all(|value| value.abs() <= 1.5);
            if !is_normal {
                return Err(from.broken("expected a normal of length 1"));
            }
            (normal != Vector2::zeros()).then_some(normal)
        } else {
            let angle = from.u16()?;
            (angle != NO_NORMAL).then(|| {
                let turn = f64::from(angle) / ANGLES - 0.5;
                let (sin, cos) = math::sin_cos(turn * core::f64::consts::TAU);
                Vector2::new(cos, sin)
            })
        };
        with_normals.push_with_normal(point, normal);
    }
    Ok(with_normals)
}
