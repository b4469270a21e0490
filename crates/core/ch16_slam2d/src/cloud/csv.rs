//! Clouds as text: one point a line, `x,y` or `x,y,nx,ny`, in metres.
//!
//! Blanks around numbers, empty lines, a byte order mark and either line end are allowed.

use nalgebra::{Point2, Vector2};
use thiserror::Error;

use super::PointCloud;

/// Byte order mark, which some editors write before UTF-8 text.
const BYTE_ORDER_MARK: &[u8] = b"\xEF\xBB\xBF";

/// Why a text is not a cloud.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum CsvError {
    /// A line is not a point.
    #[error("line {line}: expected x,y or x,y,nx,ny as finite numbers")]
    Line {
        /// Line number, from 1.
        line: usize,
    },
    /// The text has no point.
    #[error("no points")]
    Empty,
}

impl PointCloud {
    /// Reads a cloud. A normal of (0, 0) means none; any other is scaled to length 1.
    ///
    /// # Errors
    /// The first line that is not a point, or [`CsvError::Empty`].
    pub fn from_csv(text: impl AsRef<[u8]>) -> Result<Self, CsvError> {
        let text = text.as_ref();
        let text = text.strip_prefix(BYTE_ORDER_MARK).unwrap_or(text);
        let mut cloud = Self::default();
        for (index, line) in text.split(|&byte| byte == b'\n').enumerate() {
            if line.trim_ascii().is_empty() {
                continue;
            }
            let point = core::str::from_utf8(line).ok().and_then(parse_point);
            let (point, normal) = point.ok_or(CsvError::Line { line: index + 1 })?;
            cloud.push_with_normal(point, normal);
        }
        if cloud.is_empty() {
            return Err(CsvError::Empty);
        }
        Ok(cloud)
    }
}

fn parse_point(line: &str) -> Option<(Point2<f64>, Option<Vector2<f64>>)> {
    let mut numbers = [0.0; 4];
    let mut count = 0;
    for field in line.split(',') {
        let number = field.trim().parse().ok().filter(|v: &f64| v.is_finite())?;
        *numbers.get_mut(count)? = number;
        count += 1;
    }
    let [x, y, nx, ny] = numbers;
    match count {
        2 => Some((Point2::new(x, y), None)),
        4 => Some((Point2::new(x, y), unit(nx, ny))),
        _ => None,
    }
}

/// The direction of a vector, even if its square overflows or underflows.
fn unit(x: f64, y: f64) -> Option<Vector2<f64>> {
    let largest = x.abs().max(y.abs());
    if largest == 0.0 {
        return None;
    }
    let vector = Vector2::new(x, y);
    let square = vector.norm_squared();
    let vector = if square.is_normal() {
        vector
    } else {
        vector / largest
    };
    Some(vector / vector.norm())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_a_point_with_or_without_its_normal() {
        let point = Point2::new(1.0, -2.5);
        assert_eq!(parse_point("1, -2.5"), Some((point, None)));
        let up = Some(Vector2::new(0.0, 1.0));
        assert_eq!(parse_point("1,-2.5,0,2"), Some((point, up)));
        assert_eq!(parse_point("1,-2.5,0,0"), Some((point, None)));
        for wrong in ["1", "1,2,3", "1,2,3,4,5", "a,b", "1,nan", "1,inf", "x,y"] {
            assert_eq!(parse_point(wrong), None, "{wrong}");
        }
    }

    #[test]
    fn a_normal_has_length_one_whatever_was_written() {
        // The square of 1e300 is infinite, that of 1e-300 is zero.
        for size in [1e300, 1e-300, 5e-324, f64::MAX] {
            let normal = unit(size, -size).unwrap();
            assert!((normal.norm() - 1.0).abs() < 1e-15, "{size}: {normal}");
        }
    }

    #[test]
    fn the_first_wrong_line_is_reported_counting_empty_ones() {
        let read = |text: &[u8]| PointCloud::from_csv(text);
        assert_eq!(
            read("\u{feff}1,2\r\n\r\n 3 , 4 \r\n".as_bytes())
                .unwrap()
                .len(),
            2
        );
        assert_eq!(read(b"1,2\n\nx,y\n"), Err(CsvError::Line { line: 3 }));
        assert_eq!(read(b"1,2\n\xFF,3"), Err(CsvError::Line { line: 2 }));
        assert_eq!(read(b" \n\n"), Err(CsvError::Empty));
    }
}
