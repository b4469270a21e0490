//! The state of the basin explorer and its logic.
//!
//! # Computed
//!
//! ICP (`ch16_slam2d::icp`) from the reader's start, iteration by iteration, on two simulated sweeps of the scene: at most
//! thirty iterations, the limit of the chapter. The basin maps run the same code from every cell of the map. The
//! outcome compares the end with the true pose; the algorithm does not see it.
//!
//! # Numbers
//!
//! Sensor, thinning and the radius of success: `crates/chapter/ch16_lab/src/basin/scene.rs`.
//!
//! # Simplified
//!
//! Both sweeps are of the same room, in which nothing moves, and each is taken at one instant. Range noise is normal
//! and independent from beam to beam; every beam returns.

mod basins;
mod curve;
mod edge;
mod interaction;
mod letters;
mod paths;
mod picture;
mod settings;
mod tables;
mod texts;
mod turns;
mod your_code;

use ch16_lab::basin::{BasinOutcome, BasinScene, BasinStart, OffsetAxis};
use ch16_slam2d::icp::{IcpTrace, IcpWorkspace, Pair, correspondences};
use widget_kit::disclosure::{Disclosure, Opening};
use widget_kit::host_messages::Delivery;
use widget_kit::model::{
    Activity, Assessment, Handle, Model, Motion, Table, Timeline, TimelineMark, press_preset,
};
use widget_kit::param::{MORE, ParamError};
use widget_kit::playback::Playback;
use widget_kit::playback::SPEED;
use widget_kit::scene::Axis;
use widget_kit::spec::DEFAULTS;
use widget_kit::values::{Changed, Values};

use crate::from_modules::from_modules;
use crate::w16_1_basin_explorer::spec::{AXIS, DX, DY, EDGE, HEADING, PATHS, Phase};
use crate::w16_1_basin_explorer::spec::{EDGES, ITERATION, OFFSET_SPAN_M, PARAMS, SPEC, SWEEP};
use basins::Basins;
use edge::Edges;
use paths::Paths;
use settings::{config, other_variant, start, variant};
use turns::Turns;
use your_code::YourCode;

/// Names of the panels.
pub mod panel {
    /// The two sweeps.
    pub const SWEEPS: &str = "sweeps";
    /// The basin map of point-to-point.
    pub const POINT: &str = "basin-point-to-point";
    /// The basin map of point-to-plane.
    pub const PLANE: &str = "basin-point-to-plane";
    /// RMSE and error over the iterations.
    pub const CURVE: &str = "rmse";
}

/// The parameters of the start.
const START: [&str; 3] = ["heading", "dx", "dy"];

/// A start counts as one of the reader's once it has not moved for so long, s: a drag is one start.
const SETTLES_AFTER_S: f64 = 0.7;

/// The maps enter with so many starts of the reader: the picture comes first, and a map of two points asks for more.
const STARTS_BEFORE_MAPS: usize = 2;

/// Iterations a second at normal speed.
const STEPS_PER_S: f64 = 6.0;

/// The model of the widget.
pub struct BasinExplorer {
    values: Values,
    playback: Playback,
    scene: BasinScene,
    workspace: IcpWorkspace,
    run: Run,
    /// The result of the other variant from the same start, for comparison.
    other: BasinOutcome,
    basins: Basins,
    /// Time until the start counts as one of the reader's, s; `None` if it does or never moved.
    settles_in_s: Option<f64>,
    /// Whether the reader's starts have opened the maps.
    maps_are_open: bool,
    /// Paths from other starts, over the map of the selected variant.
    paths: Paths,
    /// How the turns of the first guess end.
    turns: Turns,
    /// The edge of the basin along pure rotations, for the question about it.
    edges: Edges,
    preview: Preview,
    /// The reader's function, if it drives.
    yours: Option<YourCode>,
    /// The axes of the sweeps from the first drag on, until a value is set otherwise: a sweep stays where the reader
    /// lets it go.
    held_frame: Option<[Axis; 2]>,
    /// Whether something is being dragged.
    is_held: bool,
}

/// Whether the result of the run is shown before it is played.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Preview {
    /// Hidden: the reader is to find out.
    Hidden,
    /// Shown: the reader moves the start and sees the result.
    Shown,
}

/// One registration: its trace and its result.
struct Run {
    trace: Vec<IcpTrace>,
    outcome: BasinOutcome,
}

impl Default for BasinExplorer {
    /// The widget with every setting at its default.
    fn default() -> Self {
        let values = Values::defaults(PARAMS);
        let scene = settings::scene(&values);
        let mut workspace = IcpWorkspace::new();
        let config = config(&values, variant(&values));
        let outcome = scene.register_from(&start(&values), &config, &mut workspace);
        let basins = Basins::new(&values);
        let mut explorer = Self {
            paths: Paths::new(&values),
            turns: Turns::default(),
            edges: Edges::new(&values),
            preview: Preview::Hidden,
            yours: None,
            held_frame: None,
            is_held: false,
            settles_in_s: None,
            maps_are_open: false,
            run: Run {
                trace: workspace.trace().to_vec(),
                outcome,
            },
            other: outcome,
            playback: Playback::default(),
            values,
            scene,
            workspace,
            basins,
        };
        explorer.register();
        explorer
    }
}

impl BasinExplorer {
    /// Registers from the current start, in both variants.
    fn register(&mut self) {
        self.turns.clear();
        let start = start(&self.values);
        let variant = variant(&self.values);
        let mut run = |variant| {
            let config = config(&self.values, variant);
            self.scene
                .register_from(&start, &config, &mut self.workspace)
        };
        self.other = run(other_variant(variant));
        self.run.outcome = run(variant);
        self.run.trace.clear();
        self.run.trace.extend_from_slice(self.workspace.trace());
        self.order_registration();
    }

    /// Last iteration of the run.
    fn last(&self) -> usize {
        self.run.trace.len() - 1
    }

    /// The current iteration.
    fn iteration(&self) -> usize {
        (self.values.get(&ITERATION) as usize).min(self.last())
    }

    /// The state at the current iteration.
    fn shown(&self) -> &IcpTrace {
        &self.run.trace[self.iteration()]
    }

    /// Whether the result of the run is shown ahead of it: while the reader chooses a start.
    fn previews_end(&self) -> bool {
        self.preview == Preview::Shown && self.iteration() < self.last()
    }

    /// The pairs at the current iteration.
    fn pairs(&self) -> Vec<Pair> {
        let mut config = config(&self.values, variant(&self.values));
        let dropped = self.dropped_at(self.iteration());
        if dropped.is_some() {
            config.trim = 0.0;
        }
        let (source, map) = (self.scene.source(), self.scene.map());
        let pairs = correspondences(source, map, self.shown().pose, &config);
        let pairs = pairs.into_iter().enumerate();
        let kept = |index: &usize| !dropped.is_some_and(|dropped| dropped.contains(index));
        let pairs = pairs.filter(|(index, _)| kept(index));
        pairs.map(|(_, pair)| pair).collect()
    }

    /// Sets and shows a new start, rounded, which keeps links short.
    fn start_at(&mut self, start: BasinStart) {
        let rounded = |value: f64, per_unit: f64| (value * per_unit).round() / per_unit;
        let heading_deg = rounded(start.heading_deg, 10.0);
        let offset = |value: f64| rounded(value, 100.0).clamp(-OFFSET_SPAN_M, OFFSET_SPAN_M);
        self.playback.pause();
        let values = &mut self.values;
        values.put(&HEADING, heading_deg.clamp(-180.0, 180.0));
        values.put(&DX, offset(start.dx_m));
        values.put(&DY, offset(start.dy_m));
        values.put(&ITERATION, 0.0);
        self.register();
        self.follow();
        self.preview = Preview::Shown;
        self.settles_in_s = Some(SETTLES_AFTER_S);
    }

    /// Whether it is shown how other turns end: after the run, and never of the reader's function, whose map is apart.
    fn shows_turns(&self) -> bool {
        let is_over = self.iteration() == self.last();
        is_over && self.driver().is_none() && self.values.get(&EDGE) != Phase::Marking
    }

    /// Whether the basin maps are shown: after the reader's first starts, or if a state is about them.
    fn shows_maps(&self) -> bool {
        let values = &self.values;
        self.maps_are_open
            || values.get(&MORE)
            || values.get(&PATHS)
            || values.get(&EDGE) != Phase::Off
            || values.get(&AXIS) != OffsetAxis::default()
    }

    /// Counts the start as one of the reader's once it has stood still.
    fn count_start(&mut self, elapsed_s: f64) -> Activity {
        let Some(left_s) = self.settles_in_s.filter(|_| !self.is_held) else {
            return Activity::Idle;
        };
        if left_s > elapsed_s {
            self.settles_in_s = Some(left_s - elapsed_s);
            return Activity::BusyUnchanged;
        }
        self.settles_in_s = None;
        let starts = self.basins.add(start(&self.values));
        self.maps_are_open |= starts >= STARTS_BEFORE_MAPS;
        Activity::Busy
    }

    /// Updates maps and paths to the settings.
    fn follow(&mut self) {
        self.basins.follow(&self.values);
        self.paths.follow(&self.values);
        self.edges.follow(&self.values);
    }
}

impl Model for BasinExplorer {
    from_modules!();

    fn disclosure(&self) -> Disclosure {
        let opening = match self.values.get(&EDGE) {
            Phase::Off if self.shows_maps() => SPEC.opening,
            Phase::Off => Opening {
                panels: &[panel::SWEEPS],
                ..SPEC.opening
            },
            Phase::Marking | Phase::Swept => edge::OPENING,
        };
        Disclosure::visible(opening, &self.values)
    }

    fn set(&mut self, id: &str, value: f64) -> Result<(), ParamError> {
        if self.values.set(SPEC.id, id, value)? == Changed::No {
            return Ok(());
        }
        if !["iteration", "speed", "more"].contains(&id) {
            self.held_frame = None;
        }
        match id {
            "iteration" | "speed" | "more" | "edge" => {}
            _ if EDGES.iter().any(|edge| edge.id == id) => {}
            "seed" | "scene" => {
                self.scene = settings::scene(&self.values);
                self.basins.restart(&self.values);
                self.paths.restart(&self.values);
                self.edges = Edges::new(&self.values);
                self.register();
            }
            _ => {
                if START.contains(&id) {
                    self.preview = Preview::Shown;
                    self.settles_in_s = Some(SETTLES_AFTER_S);
                }
                self.register();
                self.follow();
            }
        }
        Ok(())
    }

    fn press(&mut self, id: &str) -> Result<(), ParamError> {
        let (here, last) = (self.iteration() as f64, self.last() as f64);
        if let Some(position) = self.playback.press(id, here, last) {
            self.preview = Preview::Hidden;
            self.values.put(&ITERATION, position);
            return Ok(());
        }
        if id == SWEEP.id {
            self.values.put(&EDGE, Phase::Swept);
        } else if id != DEFAULTS.id {
            press_preset(self, id)?;
        } else {
            self.playback.pause();
            for spec in PARAMS.iter().filter(|spec| spec.id != MORE.id) {
                self.set(spec.id, spec.default)?;
            }
        }
        self.preview = Preview::Hidden;
        Ok(())
    }

    fn advance(&mut self, elapsed_s: f64) -> Activity {
        let counting = self.count_start(elapsed_s);
        if !self.playback.is_playing() {
            return counting;
        }
        let rate = STEPS_PER_S * self.values.get(&SPEED);
        let (here, last) = (self.iteration() as f64, self.last() as f64);
        let next = self.playback.advance(here, last, elapsed_s, rate);
        self.values.put(&ITERATION, next);
        Activity::Busy
    }

    fn work(&mut self) -> Activity {
        if self.settle() == Activity::Busy {
            return Activity::Busy;
        }
        if self.paths.work(&self.scene, &mut self.workspace) == Activity::Busy {
            return Activity::Busy;
        }
        if self.shows_turns()
            && self
                .turns
                .work(&self.scene, &self.values, &mut self.workspace)
                == Activity::Busy
        {
            return Activity::Busy;
        }
        if !self.shows_maps() {
            return Activity::Idle;
        }
        // Ours is filled while the worker fills the other one.
        let ordered = self.order_cells();
        match self.basins.work(&self.scene, &mut self.workspace) {
            Activity::Idle => ordered,
            busy => busy,
        }
    }

    fn settle(&mut self) -> Activity {
        if self.values.get(&EDGE) == Phase::Swept {
            self.edges.work(&self.scene, &mut self.workspace)
        } else {
            Activity::Idle
        }
    }

    fn timeline(&self) -> Option<Timeline> {
        let last = self.last() as f64;
        let minimum = self.run.outcome.ending;
        let standing = texts::standing(minimum);
        let name = minimum.name();
        Some(Timeline {
            param: "iteration",
            last,
            playing: self.playback.is_playing(),
            marks: vec![TimelineMark {
                at: last,
                label: match standing {
                    Assessment::Good => format!("ends in the {name}"),
                    _ => format!("ends wrong: {name}"),
                },
                standing,
            }],
        })
    }

    fn shown_tables(&self) -> Vec<Table> {
        tables::shown(self)
    }

    fn receive(&mut self, delivery: &Delivery<'_>) {
        self.take_delivery(delivery);
    }

    fn take_requests(&mut self) -> Vec<String> {
        let orders = self.yours.as_mut().map(|yours| yours.orders.take());
        orders.unwrap_or_default()
    }

    fn grab(&self, panel: &str, at: [f64; 2], reach: [f64; 2]) -> Option<Handle> {
        interaction::grab(self, panel, at, reach)
    }

    fn drag(&mut self, handle: Handle, at: [f64; 2]) {
        if self.held_frame.is_none() {
            self.held_frame = Some(picture::frame(self));
        }
        self.is_held = true;
        interaction::drag(self, handle, at);
    }

    fn release(&mut self) {
        self.is_held = false;
        // The axes stay, and grow only if the sweep would be cut off.
        if let Some(held) = self.held_frame.take() {
            let fitting = picture::frame(self);
            self.held_frame = Some([0, 1].map(|axis| {
                let (held, fitting) = (&held[axis], &fitting[axis]);
                Axis::hidden(held.min.min(fitting.min), held.max.max(fitting.max))
            }));
        }
    }

    fn plays_when_let_go(&self, handle: &Handle) -> bool {
        handle.panel == panel::SWEEPS
    }

    fn set_motion(&mut self, motion: Motion) {
        if let Some(end) = self.playback.set_motion(motion, self.last() as f64) {
            self.values.put(&ITERATION, end);
        }
    }
}
