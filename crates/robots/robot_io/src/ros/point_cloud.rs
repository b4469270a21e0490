//! Converts a point cloud of one ring to a scan.
//!
//! The points of a planar laser are at multiples of one angular step. The step is the median one between
//! neighbouring points, refined by the first and the last point. Each point is assigned to the nearest beam, and the
//! closer one wins. A single rotating beam sweeps a cone about its axis, or a plane, whatever the tilt of its frame:
//! heights are a linear function of x, y and range. If they are not, the cloud has several rings, whether or not it
//! states them.

use core::f64::consts::TAU;

use ch16_slam2d::scan::LaserScan;
use nalgebra::{Matrix4, Point3, Vector4};
use pr_geom::{math, sort_numbers, sort_pairs};

use super::messages::{Header, header};
use super::wire::{WireError, WireReader};

/// More beams than any planar laser has.
const MAX_BEAMS: f64 = 100_000.0;
/// Largest RMS distance of the points of one ring from their cone, m: rings a degree apart are farther from each other
/// beyond 6 m.
const RING_M: f64 = 0.05;

const SEVERAL_RINGS: &str =
    "the cloud has several rings; select a height band with --heights LOW,HIGH";

/// Offset and type of a number in each point.
#[derive(Clone, Copy, Debug)]
struct Field {
    offset: usize,
    kind: u8,
}

impl Field {
    /// Reads the number; `None` for types that no coordinate has.
    fn of(self, point: &[u8], is_big: bool) -> Option<f64> {
        let bytes = |count: usize| {
            let mut bytes = point
                .get(self.offset..self.offset.checked_add(count)?)?
                .to_vec();
            if is_big {
                bytes.reverse();
            }
            Some(bytes)
        };
        match self.kind {
            1 | 2 => Some(f64::from(*point.get(self.offset)?)),
            3 | 4 => Some(f64::from(u16::from_le_bytes(bytes(2)?.try_into().ok()?))),
            5 | 6 => Some(f64::from(u32::from_le_bytes(bytes(4)?.try_into().ok()?))),
            7 => Some(f64::from(f32::from_le_bytes(bytes(4)?.try_into().ok()?))),
            8 => Some(f64::from_le_bytes(bytes(8)?.try_into().ok()?)),
            _ => None,
        }
    }
}

/// Reads `sensor_msgs/PointCloud2` as a scan; the mounting is not in the message.
///
/// # Errors
/// If the message is truncated, or the cloud is not one ring.
pub fn point_cloud(fields: &mut WireReader<'_>) -> Result<(Header, LaserScan), String> {
    let (header, points) = ring(fields)?;
    let scan = scan_of(points).ok_or("a cloud must have at least two points")?;
    Ok((header, scan))
}

/// Reads the points of `sensor_msgs/PointCloud2` in the sensor's frame, m.
///
/// # Errors
/// If the message is truncated or has no coordinates.
pub fn cloud_points(fields: &mut WireReader<'_>) -> Result<Vec<Point3<f64>>, String> {
    let cloud = Cloud::parse(fields)?;
    let z = cloud
        .z
        .ok_or("a cloud must have a field z for a height band")?;
    let points = cloud.data.chunks_exact(cloud.step).filter_map(|point| {
        let number = |field: Field| {
            field
                .of(point, cloud.is_big)
                .filter(|value| value.is_finite())
        };
        Some(Point3::new(number(cloud.x)?, number(cloud.y)?, number(z)?))
    });
    Ok(points.collect())
}

/// The message with the offsets of its coordinates.
struct Cloud<'a> {
    header: Header,
    height: u32,
    x: Field,
    y: Field,
    z: Option<Field>,
    ring: Option<Field>,
    is_big: bool,
    step: usize,
    data: &'a [u8],
}

impl<'a> Cloud<'a> {
    fn parse(fields: &mut WireReader<'a>) -> Result<Self, String> {
        let in_words = |error: WireError| error.to_string();
        let header = header(fields).map_err(in_words)?;
        let height = fields.u32("height").map_err(in_words)?;
        fields.u32("width").map_err(in_words)?;
        let count = fields.count("fields", 10).map_err(in_words)?;
        let (mut x, mut y, mut z, mut ring) = (None, None, None, None);
        for _ in 0..count {
            let name = fields.name("a field's name").map_err(in_words)?;
            let field = Field {
                offset: fields.u32("a field's offset").map_err(in_words)? as usize,
                kind: fields.u8("a field's type").map_err(in_words)?,
            };
            fields.u32("a field's count").map_err(in_words)?;
            match name.as_str() {
                "x" => x = Some(field),
                "y" => y = Some(field),
                "z" => z = Some(field),
                "ring" => ring = Some(field),
                _ => {}
            }
        }
        let is_big = fields.u8("is_bigendian").map_err(in_words)? != 0;
        let step = fields.u32("point_step").map_err(in_words)? as usize;
        fields.u32("row_step").map_err(in_words)?;
        let data = fields.bytes("the points").map_err(in_words)?;
        let (Some(x), Some(y)) = (x, y) else {
            return Err("a cloud must have fields x and y".to_owned());
        };
        if step == 0 {
            return Err("point_step must not be 0".to_owned());
        }
        Ok(Self {
            header,
            height,
            x,
            y,
            z,
            ring,
            is_big,
            step,
            data,
        })
    }
}

/// Bearing (rad) and range (m) of each point.
fn ring(fields: &mut WireReader<'_>) -> Result<(Header, Vec<(f64, f64)>), String> {
    let Cloud {
        header,
        height,
        x,
        y,
        z,
        ring,
        is_big,
        step,
        data,
    } = Cloud::parse(fields)?;
    if height > 1 {
        return Err(format!(
            "the cloud has {height} rows; select a height band with --heights LOW,HIGH"
        ));
    }
    let mut first_ring = None;
    let mut points = Vec::with_capacity(data.len() / step);
    let mut cone = Cone::default();
    for point in data.chunks_exact(step) {
        if let Some(this) = ring.and_then(|ring| ring.of(point, is_big))
            && *first_ring.get_or_insert(this) != this
        {
            return Err(SEVERAL_RINGS.to_owned());
        }
        let number = |field: Field| {
            let value = field.of(point, is_big);
            value.ok_or("x and y must be numbers inside a point")
        };
        let (x, y) = (number(x)?, number(y)?);
        let range_m = math::norm2(x, y);
        if range_m.is_finite() && range_m > 0.0 {
            points.push((math::atan2(y, x), range_m));
            if let Some(z) = z.and_then(|z| z.of(point, is_big)) {
                cone.add(x, y, z);
            }
        }
    }
    if cone.error_m() > RING_M {
        return Err(SEVERAL_RINGS.to_owned());
    }
    Ok((header, points))
}

/// Least-squares cone or plane: `z = a x + b y + c r + d`.
#[derive(Clone, Copy, Debug, Default)]
struct Cone {
    count: f64,
    normal: Matrix4<f64>,
    right: Vector4<f64>,
    squares: f64,
}

impl Cone {
    fn add(&mut self, x: f64, y: f64, z: f64) {
        if !z.is_finite() {
            return;
        }
        let row = Vector4::new(x, y, math::norm2(x, y), 1.0);
        self.count += 1.0;
        self.normal += row * row.transpose();
        self.right += row * z;
        self.squares += z * z;
    }

    /// RMS vertical distance of the points from it, m; 0 without points.
    fn error_m(&self) -> f64 {
        if self.count == 0.0 {
            return 0.0;
        }
        // The ridge keeps unobservable coefficients at 0; 1e-9 of the number of points is negligible.
        let ridge = Matrix4::identity() * (1e-9 * self.count);
        let Some(factors) = (self.normal + ridge).cholesky() else {
            return 0.0;
        };
        let left = self.squares - self.right.dot(&factors.solve(&self.right));
        math::sqrt(math::max(left, 0.0) / self.count)
    }
}

/// The scan whose beams pass through these bearings and ranges.
fn scan_of(mut points: Vec<(f64, f64)>) -> Option<LaserScan> {
    sort_pairs(&mut points);
    let (first, last) = (points.first()?.0, points.last()?.0);
    let mut steps: Vec<f64> = points.windows(2).map(|two| two[1].0 - two[0].0).collect();
    steps.retain(|&step| step > TAU / MAX_BEAMS);
    sort_numbers(&mut steps);
    let median = *steps.get(steps.len() / 2)?;
    let count = ((last - first) / median).round();
    let step = (last - first) / count;
    let mut ranges_m = vec![0.0; count as usize + 1];
    for (bearing, range_m) in points {
        let slot = &mut ranges_m[((bearing - first) / step).round() as usize];
        if *slot == 0.0 {
            *slot = range_m;
        } else {
            *slot = math::min(*slot, range_m);
        }
    }
    Some(LaserScan {
        first_angle_rad: first,
        angle_step_rad: step,
        ranges_m,
        ..LaserScan::default()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn beams_without_a_return_leave_gaps_and_not_a_wider_step() {
        let bearing = |beam: usize| -2.0 + 0.01 * beam as f64;
        let seen = (0..300).filter(|beam| beam % 7 != 3 && !(100..130).contains(beam));
        // Not in the order of the beams, as clouds may be.
        let points: Vec<(f64, f64)> = seen
            .rev()
            .map(|beam| (bearing(beam), 1.0 + beam as f64))
            .collect();
        let count = points.len();
        let scan = scan_of(points).unwrap();
        assert_eq!(scan.ranges_m.len(), 300);
        let seen = scan.ranges_m.iter().filter(|&&range_m| range_m > 0.0);
        assert_eq!(seen.count(), count);
        for (beam, &range_m) in scan.ranges_m.iter().enumerate() {
            assert!(range_m == 0.0 || range_m == 1.0 + beam as f64);
            assert!((scan.bearing_rad(beam) - bearing(beam)).abs() < 1e-12);
        }
    }

    /// The error of a cloud of a rectangular room, scanned at these elevations (rad) from a tilted frame.
    fn error_of_rings_m(elevations: &[f64]) -> f64 {
        let mut cone = Cone::default();
        for &elevation in elevations {
            for beam in 0..360 {
                let (sin, cos) = math::sin_cos(f64::from(beam).to_radians());
                let range_m = math::min(3.0 / cos.abs(), 5.0 / sin.abs());
                let (x, y) = (range_m * cos, range_m * sin);
                cone.add(x, y, 0.4 + 0.1 * x + range_m * elevation.tan());
            }
        }
        cone.error_m()
    }

    #[test]
    fn rings_are_distinguished_by_height_without_a_ring_field() {
        for one in [0.0, 0.2, -0.3] {
            assert!(error_of_rings_m(&[one]) < 1e-3, "{one}");
        }
        // Two degrees apart, as with the usual sixteen-ring scanners.
        let step = 2_f64.to_radians();
        let rings: Vec<f64> = (0..16).map(|ring| step * (f64::from(ring) - 7.5)).collect();
        for several in [&rings[..], &rings[..2]] {
            assert!(error_of_rings_m(several) > RING_M);
        }
        assert_eq!(Cone::default().error_m(), 0.0);
    }

    #[test]
    fn clouds_without_two_bearings_are_no_scan() {
        for points in [vec![], vec![(0.1, 1.0)], vec![(0.1, 1.0), (0.1, 2.0)]] {
            assert_eq!(scan_of(points), None);
        }
    }
}
