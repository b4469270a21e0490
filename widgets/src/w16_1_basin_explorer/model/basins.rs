//! The two basin maps: the reader's own starts, then all of them in pieces, drawn as rasters with letters.

use std::cell::OnceCell;
use std::sync::Arc;

use ch16_lab::basin::{BasinMap, BasinMapAxes, BasinScene, BasinStart, Minimum, OffsetAxis};
use ch16_slam2d::icp::{IcpConfig, IcpVariant, IcpWorkspace};
use widget_kit::model::Activity;
use widget_kit::scene::{Bounds, Raster, RasterCell};
use widget_kit::values::Values;

use super::letters::{LetterCell, rooms, spread};
use super::settings::{axis, config, start};
use crate::w16_1_basin_explorer::spec::OFFSET_SPAN_M;

/// The reader's starts that stay on the maps: more would hide them.
const MAX_TRIES: usize = 24;
/// Registrations in one piece of work: some tenths of a millisecond.
pub const REGISTRATIONS_PER_PIECE: usize = 3;
/// Headings, 3° apart.
pub const COLUMNS: usize = 121;
/// Offsets, 7.5 cm apart.
pub const ROWS: usize = 41;

/// Both basin maps for the current settings: point-to-point, then point-to-plane.
pub struct Basins {
    maps: [BasinMap; 2],
    /// The variant whose map is filled from outside, by the reader's function.
    given: Option<IcpVariant>,
    tries: Vec<Try>,
    revision: u64,
    drawn: [Drawn; 2],
}

/// One of the reader's starts, and the minima that it reaches on both maps; `None` before they are computed.
struct Try {
    start: BasinStart,
    ends: Option<[Minimum; 2]>,
}

/// Cached drawing data of one map.
#[derive(Default)]
struct Drawn {
    cells: OnceCell<Arc<[RasterCell]>>,
    rooms: OnceCell<Vec<LetterCell<Minimum>>>,
}

impl Basins {
    /// Empty maps for these settings.
    pub fn new(values: &Values) -> Self {
        Self {
            maps: empty_maps(values),
            given: None,
            tries: Vec::new(),
            revision: 0,
            drawn: Default::default(),
        }
    }

    /// Empties the maps, because the sweeps changed.
    pub fn restart(&mut self, values: &Values) {
        self.empty(empty_maps(values));
    }

    /// Empties the maps; that of a variant is filled by [`Basins::put`] from now on.
    pub fn give(&mut self, given: Option<IcpVariant>, values: &Values) {
        self.given = given;
        self.empty(empty_maps(values));
    }

    /// The next cells of the map that is filled from outside.
    pub fn ahead(&self, count: usize) -> Vec<[usize; 2]> {
        let map = self.given.map(|variant| self.map(variant));
        map.map_or_else(Vec::new, |map| map.ahead(count))
    }

    /// Whether that map has these axes and settings.
    pub fn is_of(&self, axes: &BasinMapAxes, config: &IcpConfig) -> bool {
        let map = self.given.map(|variant| self.map(variant));
        map.is_some_and(|map| map.axes() == axes && map.config() == config)
    }

    /// Fills the next cells of that map, each with the letter of its minimum.
    pub fn put(&mut self, letters: &[f64]) {
        let Some(variant) = self.given else {
            return;
        };
        let cells = self.ahead(letters.len());
        for (cell, letter) in cells.into_iter().zip(letters) {
            let letter = char::from_u32(*letter as u32).and_then(Minimum::from_letter);
            self.maps[place(variant)].put(cell, letter.unwrap_or(Minimum::NotConverged));
        }
        self.changed();
    }

    /// Adds a start of the reader. Returns how many there are.
    pub fn add(&mut self, start: BasinStart) -> usize {
        if self.tries.iter().all(|tried| tried.start != start) {
            if self.tries.len() == MAX_TRIES {
                self.tries.remove(0);
            }
            self.tries.push(Try { start, ends: None });
        }
        self.tries.len()
    }

    /// Empties the maps if their settings changed; otherwise keeps what is filled.
    pub fn follow(&mut self, values: &Values) {
        let fresh = empty_maps(values);
        let differs = |(old, new): (&BasinMap, &BasinMap)| {
            old.axes() != new.axes() || old.config() != new.config()
        };
        // Both maps have the same axes and settings except for the variant.
        if self.maps.iter().zip(&fresh).any(differs) {
            self.empty(fresh);
        }
    }

    fn empty(&mut self, maps: [BasinMap; 2]) {
        self.maps = maps;
        for tried in &mut self.tries {
            tried.ends = None;
        }
        self.changed();
    }

    /// Registers one of the reader's starts, at the maps' other offset, or fills some cells of the less complete
    /// map.
    pub fn work(&mut self, scene: &BasinScene, workspace: &mut IcpWorkspace) -> Activity {
        if let Some(tried) = self.tries.iter_mut().find(|tried| tried.ends.is_none()) {
            let ends = self.maps.each_ref().map(|map| {
                let start = map.axes().through(&tried.start);
                scene.register_from(&start, map.config(), workspace).ending
            });
            tried.ends = Some(ends);
            return Activity::Busy;
        }
        let [point, plane] = &mut self.maps;
        let behind = match self.given {
            Some(IcpVariant::PointToPoint) => plane,
            Some(IcpVariant::PointToPlane) => point,
            None if plane.progress() < point.progress() => plane,
            None => point,
        };
        if behind.is_complete() {
            return Activity::Idle;
        }
        behind.advance(scene, workspace, REGISTRATIONS_PER_PIECE);
        self.changed();
        Activity::Busy
    }

    /// Invalidates the cached drawing data.
    fn changed(&mut self) {
        self.revision += 1;
        self.drawn = Default::default();
    }

    /// The map of a variant.
    pub fn map(&self, variant: IcpVariant) -> &BasinMap {
        &self.maps[place(variant)]
    }

    /// The reader's starts on a variant's map, with the minima that they reach; none once the map is complete,
    /// because its cells then show the same.
    pub fn tries(&self, variant: IcpVariant) -> impl Iterator<Item = ([f64; 2], Minimum)> {
        let along_y = self.map(variant).axes().axis == OffsetAxis::Dy;
        let spot = move |tried: &Try| {
            let ends = tried.ends?;
            Some((start_spot(&tried.start, along_y), ends[place(variant)]))
        };
        let is_filling = !self.map(variant).is_complete() && self.given != Some(variant);
        let tries = self.tries.iter().filter(move |_| is_filling);
        tries.filter_map(spot)
    }

    /// The picture of a variant's map.
    pub fn raster(&self, variant: IcpVariant) -> Raster {
        let draw = || {
            let cells = minima(self.map(variant)).map(|minimum| match minimum {
                Some(minimum) => RasterCell::Class(class(minimum)),
                None => RasterCell::Unknown,
            });
            cells.collect()
        };
        let cells: &Arc<[RasterCell]> = self.drawn[place(variant)].cells.get_or_init(draw);
        // The centers of the cells are on the grid, so the picture is larger by half a cell on each side.
        let half = [
            180.0 / (COLUMNS - 1) as f64,
            OFFSET_SPAN_M / (ROWS - 1) as f64,
        ];
        let reach = [180.0 + half[0], OFFSET_SPAN_M + half[1]];
        Raster {
            bounds: Bounds {
                min: reach.map(|value| -value),
                max: reach,
            },
            columns: COLUMNS,
            rows: ROWS,
            cells: Arc::clone(cells),
            revision: self.revision,
        }
    }

    /// Positions of the letters on a variant's map: heading in degrees, offset in metres.
    pub fn letters(&self, variant: IcpVariant, values: &Values) -> Vec<([f64; 2], Minimum)> {
        let map = self.map(variant);
        let find = || rooms(&minima(map).collect::<Vec<_>>(), COLUMNS);
        let rooms = self.drawn[place(variant)].rooms.get_or_init(find);
        let marked = map.axes().position(&start(values));
        spread(rooms, marked)
            .into_iter()
            .map(|room| {
                let start = map.axes().start(room.column, room.row);
                let spot = [start.heading_deg, offset(map.axes().axis, &start)];
                (spot, room.class)
            })
            .collect()
    }
}

/// Index of a variant.
fn place(variant: IcpVariant) -> usize {
    match variant {
        IcpVariant::PointToPoint => 0,
        IcpVariant::PointToPlane => 1,
    }
}

/// The start at a spot of a basin map; the other offset does not change.
pub fn start_at(values: &Values, [heading_deg, offset_m]: [f64; 2]) -> BasinStart {
    let mut at = start(values);
    at.heading_deg = heading_deg.clamp(-180.0, 180.0);
    match axis(values) {
        OffsetAxis::Dx => at.dx_m = offset_m,
        OffsetAxis::Dy => at.dy_m = offset_m,
    }
    at
}

/// The spot of the start on the basin maps.
pub fn spot_of(values: &Values) -> [f64; 2] {
    let at = start(values);
    [at.heading_deg, offset(axis(values), &at)]
}

/// The minimum as the map has it: one that is right but for its heading is another false one.
pub fn in_the_map(minimum: Minimum) -> Minimum {
    match minimum {
        Minimum::WrongHeading => Minimum::Other,
        other => other,
    }
}

/// Index of a minimum's colour.
pub fn class(minimum: Minimum) -> u8 {
    match minimum {
        Minimum::Right => 0,
        Minimum::QuarterTurn | Minimum::OnePost => 1,
        Minimum::HalfTurn | Minimum::MorePosts => 2,
        Minimum::Other | Minimum::WrongHeading => 3,
        Minimum::NotConverged => 6,
    }
}

fn minima(map: &BasinMap) -> impl Iterator<Item = Option<Minimum>> + '_ {
    (0..ROWS).flat_map(move |row| (0..COLUMNS).map(move |column| map.shown(column, row)))
}

/// The spot of a start on a map of Δx, or of Δy.
pub fn start_spot(start: &BasinStart, along_y: bool) -> [f64; 2] {
    let axis = if along_y {
        OffsetAxis::Dy
    } else {
        OffsetAxis::Dx
    };
    [start.heading_deg, offset(axis, start)]
}

fn offset(axis: OffsetAxis, start: &BasinStart) -> f64 {
    match axis {
        OffsetAxis::Dx => start.dx_m,
        OffsetAxis::Dy => start.dy_m,
    }
}

/// What the axes of the maps show.
pub fn map_axes(values: &Values) -> BasinMapAxes {
    let axis = axis(values);
    let other = start(values);
    BasinMapAxes {
        columns: COLUMNS,
        rows: ROWS,
        offset_span_m: OFFSET_SPAN_M,
        axis,
        other_offset_m: match axis {
            OffsetAxis::Dx => other.dy_m,
            OffsetAxis::Dy => other.dx_m,
        },
    }
}

fn empty_maps(values: &Values) -> [BasinMap; 2] {
    let axes = map_axes(values);
    [IcpVariant::PointToPoint, IcpVariant::PointToPlane]
        .map(|variant| BasinMap::new(axes, config(values, variant)))
}
