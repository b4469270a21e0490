//! Transforms between the units of a panel's axes and pixels.

use crate::scene::{Aspect, Bounds};
use crate::surface::{Px, PxRect};

/// An affine map with y upwards on the axes and downwards in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transform {
    plot: PxRect,
    shown: Bounds,
}

impl Transform {
    /// Shows `wanted` in the rectangle; with equal aspect, the longer side shows more.
    #[must_use]
    pub fn new(plot: PxRect, wanted: Bounds, aspect: Aspect) -> Self {
        let mut shown = wanted;
        for (max, min) in shown.max.iter_mut().zip(shown.min) {
            // Avoids a division by zero for an axis without extent.
            *max = max.max(min + 1e-9);
        }
        if aspect == Aspect::Equal {
            let size = shown.size();
            let px = [f64::from(plot.width), f64::from(plot.height)];
            let px_per_unit = (px[0] / size[0]).min(px[1] / size[1]);
            let middle = wanted.middle();
            shown.min = core::array::from_fn(|i| middle[i] - 0.5 * px[i] / px_per_unit);
            shown.max = core::array::from_fn(|i| middle[i] + 0.5 * px[i] / px_per_unit);
        }
        Self { plot, shown }
    }

    /// The rectangle of the plot in pixels.
    #[must_use]
    pub fn plot(&self) -> PxRect {
        self.plot
    }

    /// The visible range, in units of the axes.
    #[must_use]
    pub fn shown(&self) -> Bounds {
        self.shown
    }

    /// Units of the axes per pixel.
    #[must_use]
    pub fn units_per_px(&self) -> [f64; 2] {
        let size = self.shown.size();
        [
            size[0] / f64::from(self.plot.width),
            size[1] / f64::from(self.plot.height),
        ]
    }

    /// A point of the axes in pixels.
    #[must_use]
    pub fn to_px(&self, at: [f64; 2]) -> Px {
        let units_per_px = self.units_per_px();
        [
            self.plot.left + ((at[0] - self.shown.min[0]) / units_per_px[0]) as f32,
            self.plot.bottom() - ((at[1] - self.shown.min[1]) / units_per_px[1]) as f32,
        ]
    }

    /// A pixel in units of the axes.
    #[must_use]
    pub fn from_px(&self, px: Px) -> [f64; 2] {
        let units_per_px = self.units_per_px();
        [
            self.shown.min[0] + f64::from(px[0] - self.plot.left) * units_per_px[0],
            self.shown.min[1] + f64::from(self.plot.bottom() - px[1]) * units_per_px[1],
        ]
    }

    /// A rectangle of the axes in pixels.
    #[must_use]
    pub fn rect_to_px(&self, bounds: &Bounds) -> PxRect {
        let [left, bottom] = self.to_px(bounds.min);
        let [right, top] = self.to_px(bounds.max);
        PxRect::new(left, top, right - left, bottom - top)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn transform(aspect: Aspect) -> Transform {
        let wanted = Bounds {
            min: [-2.0, 1.0],
            max: [10.0, 4.0],
        };
        Transform::new(PxRect::new(30.0, 20.0, 400.0, 300.0), wanted, aspect)
    }

    #[test]
    fn pixels_map_back_to_the_same_point() {
        for aspect in [Aspect::Equal, Aspect::Free] {
            let transform = transform(aspect);
            for at in [[-2.0, 1.0], [3.3, 2.2], [10.0, 4.0]] {
                let back = transform.from_px(transform.to_px(at));
                // Pixels are single precision: 1e-4 units are 1/300 of a pixel here.
                assert!((back[0] - at[0]).abs() < 1e-4 && (back[1] - at[1]).abs() < 1e-4);
            }
        }
    }

    #[test]
    fn equal_axes_show_the_wanted_range_at_one_scale() {
        let transform = transform(Aspect::Equal);
        let [x, y] = transform.units_per_px();
        assert!((x - y).abs() < 1e-12);
        let shown = transform.shown();
        assert!(shown.min[0] <= -2.0 && shown.max[0] >= 10.0);
        assert!(shown.min[1] <= 1.0 && shown.max[1] >= 4.0);
    }

    #[test]
    fn up_on_the_axis_is_up_on_the_screen() {
        let transform = transform(Aspect::Free);
        assert_eq!(transform.to_px([-2.0, 1.0]), [30.0, 320.0]);
        assert_eq!(transform.to_px([10.0, 4.0]), [430.0, 20.0]);
    }
}
