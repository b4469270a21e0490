//! What is known of a log: the worker's reports, and messages of the page.

use std::sync::Arc;

use log_messages::{
    GradeReport, KeyframeReport, LoopReport, MapReport, MapperProgress, MapperReport, Offer,
    OtherLog, ScanReport, Stage,
};
use widget_kit::host_messages::Delivery;
use widget_kit::scene::{Bounds, Raster, RasterCell};

/// The state of a log.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LogState {
    /// Name of the file.
    pub name: String,
    /// What the worker has done.
    pub progress: MapperProgress,
    /// Whether it is paused.
    pub paused: bool,
    /// Whether there are scans; a graph from a file has none.
    pub has_scans: bool,
    /// The keyframes in order.
    pub keyframes: Vec<KeyframeReport>,
    /// The map.
    pub map: Option<Raster>,
    /// The loops, the least certain first.
    pub links: Vec<LoopReport>,
    /// Keyframes to check.
    pub look_into: Vec<usize>,
    /// Doubts about the result, a sentence each.
    pub doubts: Vec<String>,
    /// Remarks for the owner of the log, a sentence each.
    pub remarks: Vec<String>,
    /// The scan of a keyframe.
    pub scan: Option<ScanReport>,
    /// The grade, if a reference was given.
    pub grade: Option<GradeReport>,
    /// The choices for the options of a recording.
    pub offers: Vec<Offer>,
    /// The robot of another log on this map.
    pub other_log: Option<OtherLog>,
    /// The reply to the last order.
    pub answer: String,
}

impl LogState {
    /// A log that was opened.
    #[must_use]
    pub fn opening(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            progress: MapperProgress {
                stage: Stage::Opening,
                ..MapperProgress::default()
            },
            ..Self::default()
        }
    }

    /// Whether the worker is busy and can be paused.
    #[must_use]
    pub fn is_under_way(&self) -> bool {
        self.progress.stage.is_under_way() || self.other_log.as_ref().is_some_and(|it| !it.is_over)
    }

    /// Error of each keyframe against the reference, m; NaN if unknown, empty without a reference.
    #[must_use]
    pub fn errors_m(&self) -> &[f64] {
        self.grade.as_ref().map_or(&[], |grade| &grade.errors_m)
    }

    /// Error of a keyframe against the reference, m; NaN if unknown.
    #[must_use]
    pub fn error_m(&self, keyframe: usize) -> f64 {
        self.errors_m().get(keyframe).copied().unwrap_or(f64::NAN)
    }

    /// Processes a delivery; one that is malformed is ignored.
    pub fn receive(&mut self, delivery: &Delivery<'_>) {
        let Delivery { text, numbers, .. } = *delivery;
        match delivery.kind {
            "opening" => {
                // A pause requested before the file arrived remains in effect.
                let is_held = self.paused && self.progress.stage == Stage::Opening;
                *self = Self::opening(text);
                self.paused = is_held;
            }
            "failed" => {
                self.progress.stage = Stage::Failed;
                self.progress.problem = text.to_owned();
                // Clears messages about the previous log.
                self.answer.clear();
            }
            "paused" => self.paused = numbers.first() == Some(&1.0),
            // The page answers some requests itself.
            "answer" if delivery.bytes.is_empty() => self.answer = text.to_owned(),
            _ => {
                if let Some(report) = MapperReport::from_bytes(delivery.bytes) {
                    self.take(report);
                }
            }
        }
    }

    fn take(&mut self, report: MapperReport) {
        match report {
            MapperReport::File { name, has_scans } => {
                (self.name, self.has_scans) = (name, has_scans)
            }
            MapperReport::Progress(progress) => {
                self.progress = progress;
                self.paused &= self.is_under_way();
            }
            MapperReport::Keyframes(keyframes) => self.keyframes = keyframes,
            MapperReport::Map(map) => self.take_map(&map),
            MapperReport::Loops(links) => self.links = links,
            MapperReport::Doubts {
                sentences,
                keyframes,
            } => (self.doubts, self.look_into) = (sentences, keyframes),
            MapperReport::Remarks(remarks) => self.remarks = remarks,
            MapperReport::Scan(scan) => self.scan = Some(scan),
            MapperReport::Grade(grade) => self.grade = Some(grade),
            MapperReport::Offers(offers) => self.offers = offers,
            MapperReport::OtherLog(other) => {
                self.other_log = Some(other);
                self.paused &= self.is_under_way();
            }
            MapperReport::Answer(answer) => self.answer = answer,
        }
    }

    fn take_map(&mut self, map: &MapReport) {
        let &MapReport {
            columns,
            min: [x, y],
            cell_m,
            ..
        } = map;
        let Some(rows) = map.cells.len().checked_div(columns) else {
            return;
        };
        if !(x + y + cell_m).is_finite() || cell_m <= 0.0 || rows * columns != map.cells.len() {
            return;
        }
        let cells: Arc<[RasterCell]> = map.cells.iter().map(|&byte| cell(byte)).collect();
        self.map = Some(Raster {
            bounds: Bounds {
                min: [x, y],
                max: [x + columns as f64 * cell_m, y + rows as f64 * cell_m],
            },
            columns,
            rows,
            cells,
            revision: self.map.as_ref().map_or(0, |map| map.revision + 1),
        });
    }
}

/// 0 is unknown, 1 free, 255 occupied.
fn cell(byte: u8) -> RasterCell {
    match byte.checked_sub(1) {
        None => RasterCell::Unknown,
        Some(level) => RasterCell::Occupancy(f32::from(level) / 254.0),
    }
}
