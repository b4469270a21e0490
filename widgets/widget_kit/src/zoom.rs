//! The zoom of each map, and its visible part.

use std::collections::BTreeMap;

use crate::scene::{Aspect, Bounds, Panel};

/// Largest zoom factor.
const MAX_ZOOM: f64 = 40.0;
/// Zoom factor of a key press.
const ZOOM_STEP: f64 = 1.5;
/// Shift of a key press as a share of the visible part.
const SHIFT_STEP: f64 = 0.25;

/// A zoom or move of the maps without a pointer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Look {
    /// Zooms in, about the center of the visible part.
    In,
    /// Zooms out.
    Out,
    /// Moves left by a quarter of the visible part.
    Left,
    /// Moves right.
    Right,
    /// Moves up.
    Up,
    /// Moves down.
    Down,
    /// Shows everything again.
    Whole,
}

impl Look {
    /// Every variant with its name.
    pub const NAMES: [(&'static str, Self); 7] = [
        ("in", Self::In),
        ("out", Self::Out),
        ("left", Self::Left),
        ("right", Self::Right),
        ("up", Self::Up),
        ("down", Self::Down),
        ("whole", Self::Whole),
    ];

    /// The variant of that name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        let found = Self::NAMES.iter().find(|(known, _)| *known == name);
        found.map(|(_, look)| *look)
    }
}

/// The visible part of each map, in units of its axes; only maps (equal axes) zoom.
#[derive(Clone, Debug, Default)]
pub struct Zoom {
    windows: BTreeMap<&'static str, Bounds>,
}

impl Zoom {
    /// The visible part of a panel: everything, or the part to which it is zoomed.
    #[must_use]
    pub fn window(&self, panel: &Panel) -> Bounds {
        self.windows
            .get(panel.id)
            .copied()
            .unwrap_or_else(|| panel.bounds())
    }

    /// Whether a panel is zoomed in.
    #[must_use]
    pub fn is_zoomed(&self, panel: &str) -> bool {
        self.windows.contains_key(panel)
    }

    /// Shows a panel completely again.
    pub fn reset(&mut self, panel: &str) {
        self.windows.remove(panel);
    }

    /// Zooms a map by a factor about `spot`, which keeps its position on the screen.
    pub fn by(&mut self, panel: &Panel, factor: f64, spot: [f64; 2]) {
        if panel.aspect != Aspect::Equal {
            return;
        }
        let full = panel.bounds();
        let shown = self.window(panel);
        let width = (shown.size()[0] / factor).max(full.size()[0] / MAX_ZOOM);
        if width >= full.size()[0] {
            self.reset(panel.id);
            return;
        }
        let kept = width / shown.size()[0];
        let window = Bounds {
            min: core::array::from_fn(|i| spot[i] + (shown.min[i] - spot[i]) * kept),
            max: core::array::from_fn(|i| spot[i] + (shown.max[i] - spot[i]) * kept),
        };
        let within = moved_within(window, [0.0; 2], &full);
        self.windows.insert(panel.id, within);
    }

    /// Moves the visible part of a zoomed map; an unzoomed map does not move.
    pub fn shift(&mut self, panel: &Panel, shift: [f64; 2]) {
        if let Some(window) = self.windows.get_mut(panel.id) {
            *window = moved_within(*window, shift, &panel.bounds());
        }
    }

    /// Zooms or moves a map.
    pub fn look(&mut self, panel: &Panel, look: Look) {
        let window = self.window(panel);
        let [width, height] = window.size().map(|size| size * SHIFT_STEP);
        match look {
            Look::In => self.by(panel, ZOOM_STEP, window.middle()),
            Look::Out => self.by(panel, 1.0 / ZOOM_STEP, window.middle()),
            Look::Left => self.shift(panel, [-width, 0.0]),
            Look::Right => self.shift(panel, [width, 0.0]),
            Look::Up => self.shift(panel, [0.0, height]),
            Look::Down => self.shift(panel, [0.0, -height]),
            Look::Whole => self.reset(panel.id),
        }
    }
}

/// A window moved by `shift`, limited to `full`.
fn moved_within(window: Bounds, shift: [f64; 2], full: &Bounds) -> Bounds {
    let size = window.size();
    let min: [f64; 2] = core::array::from_fn(|i| {
        let most = (full.max[i] - size[i]).max(full.min[i]);
        (window.min[i] + shift[i]).clamp(full.min[i], most)
    });
    Bounds {
        min,
        max: core::array::from_fn(|i| min[i] + size[i]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Axis, Weight};

    const FULL: Bounds = Bounds {
        min: [0.0, 0.0],
        max: [12.0, 9.0],
    };

    fn map() -> Panel {
        Panel {
            id: "map",
            title: String::new(),
            weight: Weight::Main,
            aspect: Aspect::Equal,
            x: Axis::new("x (m)", FULL.min[0], FULL.max[0]),
            y: Axis::new("y (m)", FULL.min[1], FULL.max[1]),
            layers: Vec::new(),
            legend: Vec::new(),
            color_bar: None,
        }
    }

    #[test]
    fn a_zoomed_map_stays_within_its_full_range() {
        let window = Bounds {
            min: [1.0, 1.0],
            max: [5.0, 4.0],
        };
        let moved = moved_within(window, [100.0, -100.0], &FULL);
        assert_eq!(moved.min, [8.0, 0.0]);
        assert_eq!(moved.size(), window.size());
    }

    #[test]
    fn keys_zoom_about_the_center_and_move_by_a_quarter_of_the_view() {
        let map = map();
        let mut zoom = Zoom::default();
        zoom.look(&map, Look::Left);
        assert!(!zoom.is_zoomed("map"), "what is seen whole does not move");
        zoom.look(&map, Look::In);
        assert_eq!(zoom.window(&map).middle(), FULL.middle());
        assert_eq!(zoom.window(&map).size(), [8.0, 6.0]);
        zoom.look(&map, Look::Right);
        assert_eq!(zoom.window(&map).middle(), [8.0, 4.5]);
        zoom.look(&map, Look::Out);
        assert!(!zoom.is_zoomed("map"), "out again is the whole");
    }
}
