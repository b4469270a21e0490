//! The paths from other starts over a basin map: heading and offset, iteration by iteration.

use ch16_lab::basin::{BasinScene, BasinStart, OffsetAxis};
use ch16_slam2d::icp::{IcpConfig, IcpWorkspace};
use widget_kit::model::Activity;
use widget_kit::values::Values;

use super::basins::{start_at, start_spot};
use super::settings::{config, variant};
use crate::w16_1_basin_explorer::spec::{AXIS, DX, DY, OFFSET_SPAN_M, PATHS};

/// Step between the headings of the starts, degrees.
const HEADING_STEP_DEG: f64 = 20.0;
/// Offsets of the starts, as shares of the map's height.
const OFFSETS: [f64; 3] = [-2.0 / 3.0, 0.0, 2.0 / 3.0];
/// A path that jumps by more crosses ±180° and is drawn in two pieces, degrees.
const OVER_THE_BORDER_DEG: f64 = 180.0;

/// One path.
pub struct IterationPath {
    /// Spots on the map from the start on; NaN where the path crosses ±180°.
    pub spots: Vec<[f64; 2]>,
}

/// Paths from starts all over the map, computed one at a time; none if they are off.
pub struct Paths {
    /// The settings of the computed paths.
    key: Option<Key>,
    waiting: Vec<BasinStart>,
    done: Vec<IterationPath>,
}

/// The settings on which a path depends, apart from the sweeps.
#[derive(Clone, Copy, PartialEq)]
struct Key {
    config: IcpConfig,
    axis: OffsetAxis,
    other_offset_m: f64,
}

impl Paths {
    /// The paths for these settings, before any is computed.
    pub fn new(values: &Values) -> Self {
        let mut paths = Self {
            key: None,
            waiting: Vec::new(),
            done: Vec::new(),
        };
        paths.follow(values);
        paths
    }

    /// Starts over, because the sweeps changed.
    pub fn restart(&mut self, values: &Values) {
        *self = Self::new(values);
    }

    /// Starts over if the settings changed.
    pub fn follow(&mut self, values: &Values) {
        let key = Key::from_values(values);
        if key == self.key {
            return;
        }
        self.done.clear();
        self.waiting = match key {
            Some(_) => starts(values),
            None => Vec::new(),
        };
        self.key = key;
    }

    /// Computes the path from one start.
    pub fn work(&mut self, scene: &BasinScene, workspace: &mut IcpWorkspace) -> Activity {
        let (Some(key), Some(start)) = (self.key, self.waiting.pop()) else {
            return Activity::Idle;
        };
        scene.register_from(&start, &key.config, workspace);
        let along_y = key.axis == OffsetAxis::Dy;
        let poses = workspace.trace().iter().map(|state| state.pose);
        let spots = poses.map(|pose| start_spot(&scene.start_of(&pose), along_y));
        self.done.push(IterationPath {
            spots: split_at_half_turn(spots),
        });
        Activity::Busy
    }

    /// The computed paths.
    pub fn done(&self) -> &[IterationPath] {
        &self.done
    }
}

impl Key {
    fn from_values(values: &Values) -> Option<Self> {
        let other = match values.get(&AXIS) {
            OffsetAxis::Dx => &DY,
            OffsetAxis::Dy => &DX,
        };
        values.get(&PATHS).then(|| Self {
            config: config(values, variant(values)),
            axis: values.get(&AXIS),
            other_offset_m: values.get(other),
        })
    }
}

/// Starts on a grid over the map; the last ones, which are popped first, are in the middle row.
fn starts(values: &Values) -> Vec<BasinStart> {
    let columns = (360.0 / HEADING_STEP_DEG) as usize;
    let at = |column: usize, offset: f64| {
        let heading_deg = HEADING_STEP_DEG * (column as f64 + 0.5) - 180.0;
        start_at(values, [heading_deg, offset * OFFSET_SPAN_M])
    };
    let rows = OFFSETS.iter();
    rows.flat_map(|offset| (0..columns).map(move |column| at(column, *offset)))
        .collect()
}

/// The spots of a path as a line with a gap where it crosses ±180°.
pub fn split_at_half_turn(spots: impl Iterator<Item = [f64; 2]>) -> Vec<[f64; 2]> {
    let mut line: Vec<[f64; 2]> = Vec::new();
    for spot in spots {
        if let Some(last) = line.last()
            && (spot[0] - last[0]).abs() > OVER_THE_BORDER_DEG
        {
            line.push([f64::NAN; 2]);
        }
        line.push(spot);
    }
    line
}
