//! The worker's reports on a log. `web/robot/src/update.rs` defines the kinds of deliveries; a malformed
//! delivery is ignored.

use std::sync::Arc;

use widget_kit::host_messages::Delivery;
use widget_kit::scene::{Bounds, Cell, Raster};

use super::other_log::OtherLog;

/// Progress of the worker.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Stage {
    /// No log is open.
    #[default]
    Empty,
    /// A log was opened, and the worker has not started yet.
    Opening,
    /// Scans are read.
    Reading,
    /// Keyframes are registered again on everything around them.
    Finishing,
    /// A graph from a file is solved.
    Solving,
    /// The covariances are computed.
    Checking,
    /// The map is finished.
    Done,
    /// The file could not be processed.
    Failed,
}

impl Stage {
    fn from_number(number: f64) -> Option<Self> {
        let stages = [
            Self::Reading,
            Self::Finishing,
            Self::Solving,
            Self::Checking,
            Self::Done,
            Self::Failed,
        ];
        stages.get((number as usize).checked_sub(1)?).copied()
    }

    /// Whether the worker can be paused.
    #[must_use]
    pub fn is_under_way(self) -> bool {
        matches!(
            self,
            Self::Opening | Self::Reading | Self::Finishing | Self::Solving
        )
    }
}

/// A keyframe.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Keyframe {
    /// Time of its scan, s.
    pub stamp_s: f64,
    /// `[x, y, θ]`, m and rad.
    pub pose: [f64; 3],
    /// Share of its scan that fits; NaN if it was not registered.
    pub fit: f64,
    /// Standard deviation of its position, m; NaN until it is known.
    pub sigma_m: f64,
}

/// The decision on a loop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// It passed the tests.
    Closed,
    /// It failed the tests.
    Rejected,
    /// The reader rejected it.
    Removed,
    /// The reader added it.
    Added,
    /// The reader kept it although the rest of the graph contradicts it.
    Confirmed,
}

/// A loop with its evidence; NaN for missing numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Link {
    /// The newer keyframe.
    pub new: usize,
    /// The older keyframe.
    pub old: usize,
    /// Share of the newer scan that fits.
    pub share: f64,
    /// Root mean square distance of the points that fit, m.
    pub rmse_m: f64,
    /// Points that fit.
    pub points: f64,
    /// Score margin to the best other pose.
    pub margin: f64,
    /// Squared innovation against the graph.
    pub chi2: f64,
    /// The gate's threshold.
    pub gate_chi2: f64,
    /// The decision.
    pub verdict: Verdict,
    /// Why it failed the tests.
    pub reason: String,
}

impl Link {
    /// Whether it is in the graph.
    #[must_use]
    pub fn is_in_graph(&self) -> bool {
        matches!(
            self.verdict,
            Verdict::Closed | Verdict::Added | Verdict::Confirmed
        )
    }

    /// Whether it is in the graph, and the rest of the graph contradicts it.
    #[must_use]
    pub fn is_contradicted(&self) -> bool {
        self.is_in_graph() && self.chi2 > self.gate_chi2
    }
}

/// The errors against a reference.
#[derive(Clone, Debug, PartialEq)]
pub struct Grade {
    /// In words.
    pub words: String,
    /// Mean error against relations, or RMSE against the truth, m.
    pub error_m: f64,
}

/// The choices that a recording offers for an option.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Offer {
    /// Name of the option: `scan-topic`.
    pub option: String,
    /// The current choice; empty if there is none.
    pub taken: String,
    /// The possible choices.
    pub names: Vec<String>,
}

/// The state of a log.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LogState {
    /// Name of the file.
    pub name: String,
    /// Progress of the worker.
    pub stage: Stage,
    /// Whether it is paused.
    pub paused: bool,
    /// Finished share of the work.
    pub share: f64,
    /// Number of processed scans.
    pub scans: f64,
    /// Loops that were tried and closed while reading.
    pub tried: [f64; 2],
    /// Whether there are scans; a graph from a file has none.
    pub has_scans: bool,
    /// The error.
    pub problem: String,
    /// The keyframes in order.
    pub keyframes: Vec<Keyframe>,
    /// The map.
    pub map: Option<Raster>,
    /// The loops, the least certain first.
    pub links: Vec<Link>,
    /// Keyframes to check.
    pub look_into: Vec<usize>,
    /// Doubts about the result, a sentence each.
    pub doubts: Vec<String>,
    /// Remarks for the owner of the log, a sentence each.
    pub remarks: Vec<String>,
    /// A keyframe's points in its own frame, m.
    pub scan: Option<(usize, Vec<[f64; 2]>)>,
    /// The same as it was measured, with the motion during the sweep in it; `None` if it counts as one instant.
    pub sweep: Option<(usize, Vec<[f64; 2]>)>,
    /// The grade, if a reference was given.
    pub grade: Option<Grade>,
    /// Error of each keyframe against the reference, m.
    pub errors_m: Vec<f64>,
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
            stage: Stage::Opening,
            ..Self::default()
        }
    }

    /// Whether the worker is busy and can be paused.
    #[must_use]
    pub fn is_under_way(&self) -> bool {
        self.stage.is_under_way() || self.other_log.as_ref().is_some_and(|it| !it.is_over)
    }

    /// Processes a delivery.
    pub fn receive(&mut self, delivery: &Delivery<'_>) {
        let Delivery { text, numbers, .. } = *delivery;
        match delivery.kind {
            "opening" => {
                // A pause requested before the file arrived remains in effect.
                let is_held = self.paused && self.stage == Stage::Opening;
                *self = Self::opening(text);
                self.paused = is_held;
            }
            "failed" => {
                self.stage = Stage::Failed;
                self.problem = text.to_owned();
                // Clears messages about the previous log.
                self.answer.clear();
            }
            "paused" => self.paused = numbers.first() == Some(&1.0),
            "file" => {
                self.name = text.to_owned();
                self.has_scans = numbers.get(1) == Some(&1.0);
            }
            "stage" => self.receive_stage(text, numbers),
            "keyframes" => self.keyframes = numbers.chunks_exact(6).map(keyframe).collect(),
            "map" => self.receive_map(delivery),
            "loops" => {
                let reasons = text.split('\n').chain(core::iter::repeat(""));
                let links = numbers.chunks_exact(10).zip(reasons);
                self.links = links
                    .filter_map(|(numbers, why)| link(numbers, why))
                    .collect();
            }
            "doubts" => {
                self.doubts = lines(text);
                self.look_into = numbers.iter().map(|&number| number as usize).collect();
            }
            "remarks" => self.remarks = lines(text),
            "scan" => self.scan = points(numbers).or(self.scan.take()),
            "sweep" => self.sweep = points(numbers).or(self.sweep.take()),
            "grade" => {
                self.grade = Some(Grade {
                    words: text.to_owned(),
                    error_m: numbers.get(2).copied().unwrap_or(f64::NAN),
                });
            }
            "errors" => self.errors_m = numbers.to_vec(),
            "offers" => self.offers = text.lines().filter_map(offer).collect(),
            "where" => {
                if let Some(other) = OtherLog::from_delivery(delivery) {
                    self.other_log = Some(other);
                }
                self.paused &= self.is_under_way();
            }
            "answer" => self.answer = text.to_owned(),
            _ => {}
        }
    }

    fn receive_stage(&mut self, text: &str, numbers: &[f64]) {
        let &[stage, share, scans, tried, closed] = numbers else {
            return;
        };
        let Some(stage) = Stage::from_number(stage) else {
            return;
        };
        self.stage = stage;
        self.share = share;
        self.scans = scans;
        self.tried = [tried, closed];
        self.problem = text.to_owned();
        self.paused &= self.is_under_way();
    }

    fn receive_map(&mut self, delivery: &Delivery<'_>) {
        let &[columns, rows, x, y, cell_m] = delivery.numbers else {
            return;
        };
        let (columns, rows) = (columns as usize, rows as usize);
        let is_whole = columns.checked_mul(rows) == Some(delivery.bytes.len());
        if !is_whole || columns == 0 || !(x + y + cell_m).is_finite() || cell_m <= 0.0 {
            return;
        }
        let cells: Arc<[Cell]> = delivery.bytes.iter().map(|&byte| cell(byte)).collect();
        let size = [columns as f64 * cell_m, rows as f64 * cell_m];
        self.map = Some(Raster {
            bounds: Bounds {
                min: [x, y],
                max: [x + size[0], y + size[1]],
            },
            columns,
            rows,
            cells,
            revision: self.map.as_ref().map_or(0, |map| map.revision + 1),
        });
    }
}

/// A keyframe and points in its frame.
fn points(numbers: &[f64]) -> Option<(usize, Vec<[f64; 2]>)> {
    let (&keyframe, points) = numbers.split_first()?;
    let points = points.chunks_exact(2).map(|point| [point[0], point[1]]);
    Some((keyframe as usize, points.collect()))
}

fn lines(text: &str) -> Vec<String> {
    text.lines().map(str::to_owned).collect()
}

fn offer(line: &str) -> Option<Offer> {
    let mut words = line.split('\t').map(str::to_owned);
    Some(Offer {
        option: words.next()?,
        taken: words.next()?,
        names: words.collect(),
    })
}

fn keyframe(numbers: &[f64]) -> Keyframe {
    Keyframe {
        stamp_s: numbers[0],
        pose: [numbers[1], numbers[2], numbers[3]],
        fit: numbers[4],
        sigma_m: numbers[5],
    }
}

fn link(numbers: &[f64], reason: &str) -> Option<Link> {
    let verdicts = [
        Verdict::Closed,
        Verdict::Rejected,
        Verdict::Removed,
        Verdict::Added,
        Verdict::Confirmed,
    ];
    Some(Link {
        new: numbers[0] as usize,
        old: numbers[1] as usize,
        share: numbers[2],
        rmse_m: numbers[3],
        points: numbers[4],
        margin: numbers[5],
        chi2: numbers[6],
        gate_chi2: numbers[7],
        verdict: *verdicts.get(numbers[8] as usize)?,
        reason: reason.to_owned(),
    })
}

/// 0 is unknown, 1 free, 255 occupied.
fn cell(byte: u8) -> Cell {
    match byte.checked_sub(1) {
        None => Cell::Unknown,
        Some(level) => Cell::Occupancy(f32::from(level) / 254.0),
    }
}
