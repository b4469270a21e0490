//! A small model with every kind of parameter, for tests of code that draws and drives models.

use widget_kit::disclosure::Opening;
use widget_kit::model::{
    Activity, Assessment, Fact, Handle, Model, Outcome, Table, TablePlace, Timeline, TimelineMark,
    press_preset,
};
use widget_kit::param::{Choice, MORE, ParamError, ParamKind, ParamSpec};
use widget_kit::playback::{Playback, SPEED};
use widget_kit::scene::{
    Aspect, Axis, Bounds, ColorBar, Layer, LegendEntry, Mark, Panel, Raster, RasterCell, Scene,
    Stroke, Tone, Weight,
};
use widget_kit::spec::{Awaits, DEFAULTS, PLAY, Preset, RESET, STEP, WidgetSpec};
use widget_kit::values::{Changed, Values};

const PARAMS: &[&ParamSpec] = &[
    &ParamSpec {
        id: "x",
        label: "place along x",
        unit: "m",
        kind: ParamKind::Slider {
            min: 0.0,
            max: 4.0,
            step: 0.1,
        },
        default: 1.0,
        help: "Where the thing stands.",
    },
    &ParamSpec {
        id: "kind",
        label: "kind",
        unit: "",
        kind: ParamKind::Choice {
            options: &[
                Choice {
                    id: "one",
                    label: "one",
                },
                Choice {
                    id: "two",
                    label: "two",
                },
            ],
        },
        default: 0.0,
        help: "Which of two.",
    },
    &ParamSpec {
        id: "ghost",
        label: "show the ghost",
        unit: "",
        kind: ParamKind::Switch,
        default: 1.0,
        help: "Whether the ghost shows.",
    },
    &ParamSpec {
        id: "seed",
        label: "seed",
        unit: "",
        kind: ParamKind::Seed {
            max: 4_294_967_295.0,
        },
        default: 7.0,
        help: "Where the numbers start.",
    },
    &ParamSpec {
        id: "time",
        label: "tick",
        unit: "",
        kind: ParamKind::Timeline { max: 1000.0 },
        default: 0.0,
        help: "Which tick is shown.",
    },
    &SPEED.spec,
    // Everything is shown, as without layers, until a test sets it.
    &ParamSpec {
        default: 1.0,
        ..MORE.spec
    },
];

const SPEC: WidgetSpec = WidgetSpec {
    id: "w0.0",
    name: "One of everything",
    title: "Where does it go?",
    claim: "A test that only looks at the code does not see what the reader sees.",
    gesture: "Drag it.",
    awaits: Awaits::Nothing,
    notice: &[
        "The thing follows the pointer.",
        "The timeline plays to its end.",
    ],
    opening: Opening {
        panels: &["map"],
        params: &["x"],
        buttons: &["play"],
    },
    params: PARAMS,
    buttons: &[PLAY, STEP, RESET, DEFAULTS],
    presets: &[Preset {
        id: "far",
        label: "Far away",
        help: "The thing goes to the far end.",
        set: &[("x", 3.5)],
        then: &[],
    }],
};

/// Something draggable on a map, a run of twenty ticks, and a picture that fills in ten pieces, the last
/// of them after the run.
pub struct Fake {
    values: Values,
    playback: Playback,
    filled: usize,
}

impl Fake {
    pub fn new() -> Self {
        Self {
            values: Values::defaults(PARAMS),
            playback: Playback::default(),
            filled: 0,
        }
    }
}

impl Model for Fake {
    fn spec(&self) -> &'static WidgetSpec {
        &SPEC
    }

    fn values(&self) -> &Values {
        &self.values
    }

    fn set(&mut self, id: &str, value: f64) -> Result<(), ParamError> {
        if self.values.set(SPEC.id, id, value)? == Changed::Yes && id == "kind" {
            self.filled = 0;
        }
        Ok(())
    }

    fn press(&mut self, id: &str) -> Result<(), ParamError> {
        let time = self.values.number("time");
        match id {
            "play" => {
                let time = self.playback.toggle(time, 20.0);
                self.set("time", time)
            }
            "step" => self.set("time", (time + 1.0).min(20.0)),
            "reset" => self.set("time", 0.0),
            "defaults" => {
                self.values.reset();
                self.playback.pause();
                self.filled = 0;
                Ok(())
            }
            _ => press_preset(self, id),
        }
    }

    fn advance(&mut self, elapsed_s: f64) -> Activity {
        if !self.playback.is_playing() {
            return Activity::Idle;
        }
        let rate = 5.0 * self.values.get(&SPEED);
        let time = self
            .playback
            .advance(self.values.number("time"), 20.0, elapsed_s, rate);
        self.set("time", time)
            .expect("the timeline takes its own positions");
        Activity::Busy
    }

    fn work(&mut self) -> Activity {
        let has_run = self.values.number("time") == 20.0;
        if self.filled == 9 + usize::from(has_run) {
            return Activity::Idle;
        }
        self.filled += 1;
        Activity::Busy
    }

    fn scene(&self) -> Scene {
        let x = self.values.number("x");
        let cells: Vec<RasterCell> = (0..100)
            .map(|k| {
                if k / 10 < self.filled {
                    RasterCell::Level(k as f32 / 99.0)
                } else {
                    RasterCell::Unknown
                }
            })
            .collect();
        let bounds = Bounds {
            min: [0.0, 0.0],
            max: [4.0, 3.0],
        };
        let map = Panel {
            id: "map",
            title: "Map <of> \"things\" & ghosts".to_owned(),
            weight: Weight::Main,
            aspect: Aspect::Equal,
            x: Axis::new("x (m)", 0.0, 4.0),
            y: Axis::new("y (m)", 0.0, 3.0),
            layers: vec![
                Layer::Raster(Raster {
                    bounds,
                    columns: 10,
                    rows: 10,
                    cells: cells.into(),
                    revision: self.filled as u64,
                }),
                Layer::Pose {
                    pose: [2.0, 2.0, 0.5],
                    mark: Mark::Square,
                    tone: Tone::Posterior,
                    radius_px: 6.0,
                },
                Layer::Ellipse {
                    center: [2.0, 2.0],
                    half_axes: [[0.5, 0.2], [-0.1, 0.25]],
                    stroke: Stroke::Dotted,
                    tone: Tone::Ink,
                },
                Layer::Text {
                    at: [3.0, 0.4],
                    text: "A & B".to_owned(),
                    tone: Tone::Class(1),
                },
                Layer::Handle {
                    at: [x, 1.0],
                    tone: Tone::Prior,
                    label: "move the thing",
                },
            ],
            legend: vec![LegendEntry {
                label: "thing".to_owned(),
                tone: Tone::Prior,
                mark: Some(Mark::Circle),
                stroke: None,
            }],
            color_bar: Some(ColorBar {
                label: "height (m²)".to_owned(),
                min: 0.0,
                max: 1.0,
            }),
        };
        let plot = Panel {
            id: "plot",
            title: "Error over time".to_owned(),
            weight: Weight::Side,
            aspect: Aspect::Free,
            x: Axis::new("tick", 0.0, 20.0),
            y: Axis::new("error (m)", 0.0, 0.3),
            layers: vec![Layer::Line {
                points: vec![
                    [0.0, 0.1],
                    [5.0, 0.2],
                    [f64::NAN, 0.0],
                    [8.0, 0.1],
                    [20.0, 0.3],
                ],
                stroke: Stroke::Dashed,
                tone: Tone::Truth,
                width_px: 2.0,
            }],
            legend: vec![LegendEntry {
                label: "truth".to_owned(),
                tone: Tone::Truth,
                mark: None,
                stroke: Some(Stroke::Dashed),
            }],
            color_bar: None,
        };
        Scene {
            panels: vec![map, plot],
        }
    }

    fn outcome(&self) -> Outcome {
        Outcome {
            standing: Assessment::Good,
            verdict: "in place".to_owned(),
            sentence: format!("The thing stands at {:.1} m.", self.values.number("x")),
            facts: vec![Fact {
                id: "x_m",
                label: "place",
                value: self.values.number("x"),
                unit: "m",
                decimals: 2,
            }],
        }
    }

    fn summary(&self) -> String {
        "A thing on a map.".to_owned()
    }

    fn timeline(&self) -> Option<Timeline> {
        Some(Timeline {
            param: "time",
            last: 20.0,
            playing: self.playback.is_playing(),
            marks: vec![TimelineMark {
                at: 10.0,
                label: "half-way".to_owned(),
                standing: Assessment::Bad,
            }],
        })
    }

    fn tables(&self) -> Vec<Table> {
        vec![Table {
            id: "places",
            title: "Places".to_owned(),
            columns: vec!["place".to_owned(), "x (m)".to_owned()],
            rows: vec![vec![
                "thing".to_owned(),
                format!("{:.2}", self.values.number("x")),
            ]],
            place: TablePlace::Shown,
        }]
    }

    fn grab(&self, panel: &str, at: [f64; 2], reach: [f64; 2]) -> Option<Handle> {
        let offset = [at[0] - self.values.number("x"), at[1] - 1.0];
        let near = panel == "map" && (0..2).all(|i| offset[i].abs() <= reach[i]);
        near.then_some(Handle {
            panel: "map",
            id: "thing",
            offset,
            ..Handle::default()
        })
    }

    fn drag(&mut self, handle: Handle, at: [f64; 2]) {
        let x = (at[0] - handle.offset[0]).clamp(0.0, 4.0);
        self.set("x", x).expect("clamped to the range");
    }
}
