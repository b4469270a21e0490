//! Both landscapes of a location, and what has to be recomputed if a setting changes.

use ch16_lab::terrain::{
    Ball, BallConfig, BallStop, Objective, PartnerChange, PlaneRows, RowConstraints, SceneKind,
    Terrain, TerrainProbe, TerrainScene, TerrainSettings,
};
use ch16_slam2d::cloud::{NearestMap, PointCloud};
use ch16_slam2d::ndt::NdtCell;
use pr_geom::{SE2, Vector2, math};
use widget_kit::scene::Bounds;

use super::landscape::{BallPath, End, Landscape};
use super::settings::TerraceSettings;
use crate::w16_3_cost_terraces::spec::{HALF_SPAN_M, MAX_BALL_STEPS, ReliefMeasure, SweepPlace};

/// Lower limit of the information for the drawing of the ellipse, 1/m²: no axis is longer than a metre.
const MIN_INFORMATION_PER_M2: f64 = 1.0;

/// Size of a shift within which a pair counts as about to change, m.
const ABOUT_M: f64 = 0.004;

/// Distance of the samples on the line from a ball's end to the truth, m: less than any step of the cost.
const AHEAD_SPACING_M: f64 = 0.01;
/// Half the width of the ground around a resting ball that is magnified, and its samples on either side, m.
const REST_REACH_M: f64 = 0.015;
const REST_SAMPLES: i32 = 10;

/// Everything that follows from the settings.
#[derive(Debug)]
pub struct Terrains {
    /// ICP's truncated cost, m².
    pub icp: Landscape,
    /// NDT's score, negated, so that low is good.
    pub ndt: Landscape,
    /// The point-to-plane information about a shift at the truth.
    pub information: Hold,
    /// The rows of the point-to-plane step at the truth.
    pub rows: PlaneRows,
    settings: TerraceSettings,
    scene: TerrainScene,
    grids: Terrain,
    turned: PointCloud,
    map_points_m: Vec<[f64; 2]>,
}

/// The information about a shift with fixed heading, along its principal directions: the largest first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hold {
    /// Eigenvalues, 1/cm².
    pub eigenvalues_per_cm2: [f64; 2],
    /// Angles from x, degrees in (−90, 90].
    pub directions_deg: [f64; 2],
    /// Half axes of the ellipse `δᵀ Ω δ = 1` along the directions, cm: long for little information.
    pub half_axes_cm: [[f64; 2]; 2],
    /// Rank of the information about the whole pose, including the heading: up to 3.
    pub rank: usize,
}

/// The pairs at a shift, m.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pairing {
    /// From each point to its partner, except those that are about to change.
    pub pairs: Vec<[[f64; 2]; 2]>,
    /// From each point that is about to change its partner to the current one.
    pub changing: Vec<[[f64; 2]; 2]>,
    /// From each of those, and from each that is about to get one, to the next partner.
    pub next: Vec<[[f64; 2]; 2]>,
    /// The points of both.
    pub points: Vec<[f64; 2]>,
}

/// One Gaussian of NDT's map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bell {
    /// Its center, m.
    pub mean_m: [f64; 2],
    /// One standard deviation along its principal axes, the longer first, m.
    pub half_axes_m: [[f64; 2]; 2],
    /// The cell of its points, m.
    pub cell_m: Bounds,
}

/// What depends on a change of settings.
#[derive(Clone, Copy, Debug)]
struct Stale {
    place: bool,
    ndt_map: bool,
    turn: bool,
    icp: bool,
    ndt: bool,
    colors: bool,
    icp_ball: bool,
    ndt_ball: bool,
}

impl Stale {
    const EVERYTHING: Self = Self {
        place: true,
        ndt_map: true,
        turn: true,
        icp: true,
        ndt: true,
        colors: true,
        icp_ball: true,
        ndt_ball: true,
    };

    fn between(old: &TerraceSettings, new: &TerraceSettings) -> Self {
        let place = old.place != new.place || old.seed != new.seed;
        let turn = place || old.heading_deg != new.heading_deg;
        let cells = old.cells != new.cells;
        let tau = old.tau_m != new.tau_m;
        let ndt_map = old.ndt_cell_m != new.ndt_cell_m;
        let probe = old.probe_m != new.probe_m;
        Self {
            place,
            ndt_map,
            turn,
            icp: turn || cells || tau,
            ndt: turn || cells || ndt_map,
            colors: old.colors != new.colors,
            icp_ball: turn || tau || probe,
            ndt_ball: turn || ndt_map || probe,
        }
    }
}

impl Terrains {
    /// Computes everything for these settings.
    pub fn new(settings: TerraceSettings) -> Self {
        let scene = scene_of(&settings);
        let mut terrains = Self {
            icp: Landscape::flat(),
            ndt: Landscape::flat(),
            information: Hold::from_scene(&scene),
            rows: rows_of(&scene),
            settings,
            scene,
            grids: Terrain::default(),
            turned: PointCloud::default(),
            map_points_m: Vec::new(),
        };
        terrains.renew(Stale::EVERYTHING);
        terrains
    }

    /// Recomputes only what depends on the changed settings.
    pub fn update(&mut self, settings: TerraceSettings) {
        let stale = Stale::between(&self.settings, &settings);
        self.settings = settings;
        if stale.place {
            self.scene = scene_of(&settings);
            self.information = Hold::from_scene(&self.scene);
            self.rows = rows_of(&self.scene);
        } else if stale.ndt_map {
            self.scene.set_ndt_cell(settings.ndt_cell_m);
        }
        self.renew(stale);
    }

    fn renew(&mut self, stale: Stale) {
        let TerraceSettings { cells, probe_m, .. } = self.settings;
        let grid = self.grid();
        if stale.place {
            let map = self.scene.map();
            self.map_points_m = (0..map.len()).map(|k| map.point(k).into()).collect();
        }
        if stale.turn {
            self.turned = self.scene.cloud().transformed(&self.world_from_turned());
        }
        match (stale.icp, stale.ndt) {
            (true, true) => self.grids.recompute(&self.scene, &grid),
            (true, false) => self.grids.recompute_icp(&self.scene, grid.tau_m),
            (false, true) => self.grids.recompute_ndt(&self.scene),
            (false, false) => {}
        }
        if stale.icp {
            self.icp
                .renew(cells, self.grids.icp_cost_m2().iter().copied());
        }
        if stale.ndt {
            let heights = self.grids.ndt_score().iter().map(|score| -score);
            self.ndt.renew(cells, heights);
        }
        if stale.icp || stale.colors {
            self.icp.color(self.settings.colors);
        }
        if stale.ndt || stale.colors {
            self.ndt.color(self.settings.colors);
        }
        if stale.icp_ball || stale.ndt_ball {
            let probe = TerrainProbe::new(&self.scene, &grid);
            if stale.icp_ball {
                let ball = roll(&probe, Objective::IcpCost, probe_m);
                rest(&mut self.icp, ball, |at| probe.icp_cost_m2(at));
            }
            if stale.ndt_ball {
                let ball = roll(&probe, Objective::NdtScore, probe_m);
                rest(&mut self.ndt, ball, |at| -probe.ndt_score(at));
            }
        }
    }

    /// The landscape of a measure.
    pub fn of(&self, measure: ReliefMeasure) -> &Landscape {
        match measure {
            ReliefMeasure::Icp => &self.icp,
            ReliefMeasure::Ndt => &self.ndt,
        }
    }

    /// The map's points, m.
    pub fn map_points_m(&self) -> &[[f64; 2]] {
        &self.map_points_m
    }

    /// The sweep at a shift, m.
    pub fn sweep_at(&self, [dx, dy]: [f64; 2]) -> Vec<[f64; 2]> {
        let points = self.turned.iter();
        points.map(|point| [point.x + dx, point.y + dy]).collect()
    }

    /// ICP's partners at a shift, and those that change nearby.
    pub fn pairing_at(&self, [dx, dy]: [f64; 2]) -> Pairing {
        let settings = self.grid();
        let partners = self
            .scene
            .partners(&settings, Vector2::new(dx, dy), ABOUT_M);
        let mut pairing = Pairing::default();
        for partner in partners {
            let from: [f64; 2] = partner.point.into();
            let now = partner.partner.map(|to| [from, to.into()]);
            if partner.change.is_none() {
                pairing.pairs.extend(now);
                continue;
            }
            pairing.points.push(from);
            pairing.changing.extend(now);
            match partner.change {
                Some(PartnerChange::Other(to) | PartnerChange::Found(to)) => {
                    pairing.next.push([from, to.into()]);
                }
                Some(PartnerChange::Lost) | None => {}
            }
        }
        pairing
    }

    /// The Gaussians of NDT's map.
    pub fn bells(&self) -> Vec<Bell> {
        let ndt = self.scene.ndt();
        let width_m = ndt.cell_m();
        ndt.cells()
            .iter()
            .map(|cell| Bell::from_cell(cell, width_m))
            .collect()
    }

    /// Number of rows so far.
    pub fn rows_taken(&self) -> usize {
        self.settings.rows.min(self.rows.rows.len())
    }

    /// Their constraints, with the row of odometry if there is one.
    pub fn row_constraints(&self) -> RowConstraints {
        self.rows
            .constraints(self.rows_taken(), self.settings.odometry_m)
    }

    /// Width of NDT's cells, m.
    pub fn ndt_cell_m(&self) -> f64 {
        self.scene.ndt().cell_m()
    }

    /// The core's scene.
    pub fn scene(&self) -> &TerrainScene {
        &self.scene
    }

    fn grid(&self) -> TerrainSettings {
        TerrainSettings {
            n: self.settings.cells,
            span_m: HALF_SPAN_M,
            tau_m: self.settings.tau_m,
            heading_deg: self.settings.heading_deg,
        }
    }

    /// Rotates the sweep about the sensor.
    fn world_from_turned(&self) -> SE2 {
        let world_from_sensor = self.scene.world_from_sensor();
        let turn = SE2::new(0.0, 0.0, self.settings.heading_deg.to_radians());
        world_from_sensor * turn * world_from_sensor.inverse()
    }
}

fn scene_of(settings: &TerraceSettings) -> TerrainScene {
    TerrainScene::with_seed(kind(settings), settings.ndt_cell_m, settings.seed)
}

fn kind(settings: &TerraceSettings) -> SceneKind {
    match settings.place {
        SweepPlace::Room => SceneKind::Room,
        SweepPlace::Corridor => SceneKind::LongCorridor,
        SweepPlace::OwnCorridor => SceneKind::Corridor,
    }
}

/// Drops a ball at a shift and follows it until it stops.
fn roll(probe: &TerrainProbe<'_>, objective: Objective, [x, y]: [f64; 2]) -> BallPath {
    let config = BallConfig {
        max_steps: MAX_BALL_STEPS,
        ..BallConfig::default()
    };
    let sign = match objective {
        Objective::IcpCost => 1.0,
        Objective::NdtScore => -1.0,
    };
    let start = Vector2::new(x, y);
    let mut ball = Ball::new(objective, start, config);
    let mut heights = vec![sign * probe.slope(objective, start).value];
    let end = loop {
        let step = ball.step(probe);
        match step.stop {
            None => heights.push(sign * step.value),
            Some(BallStop::StepLimit { .. }) => break End::OutOfSteps,
            Some(BallStop::Settled { .. } | BallStop::Level { .. }) => break End::Rests,
        }
    };
    BallPath {
        path_m: ball.path().iter().map(|at| [at.x, at.y]).collect(),
        heights,
        end,
    }
}

/// Sets a ball that has come to rest, and the ground between its end and the truth.
fn rest(landscape: &mut Landscape, ball: BallPath, height: impl Fn(Vector2<f64>) -> f64) {
    landscape.ahead = ahead(ball.end_m(), &height);
    landscape.around = if ball.is_home() {
        Vec::new()
    } else {
        around(ball.end_m(), &height)
    };
    landscape.ball = ball;
}

/// Heights on the straight line from a shift to the truth, both ends included.
fn ahead(from_m: [f64; 2], height: impl Fn(Vector2<f64>) -> f64) -> Vec<[f64; 2]> {
    let from = Vector2::from(from_m);
    let length_m = math::norm2(from.x, from.y);
    let pieces = (length_m / AHEAD_SPACING_M).ceil().max(1.0) as usize;
    (0..=pieces)
        .map(|k| k as f64 / pieces as f64)
        .map(|share| [share * length_m, height(from * (1.0 - share))])
        .collect()
}

/// Heights on the same line just behind and ahead of a resting ball, as `[distance ahead of it (m), height]`.
fn around(rest_m: [f64; 2], height: impl Fn(Vector2<f64>) -> f64) -> Vec<[f64; 2]> {
    let rest = Vector2::from(rest_m);
    let length_m = math::norm2(rest.x, rest.y).max(1e-9);
    (-REST_SAMPLES..=REST_SAMPLES)
        .map(|k| REST_REACH_M * f64::from(k) / f64::from(REST_SAMPLES))
        .map(|at| [at, height(rest * (1.0 - at / length_m))])
        .collect()
}

/// With pairs up to the chapter's τ, like the information.
fn rows_of(scene: &TerrainScene) -> PlaneRows {
    PlaneRows::from_scene(scene, TerrainSettings::default().tau_m)
}

impl Bell {
    fn from_cell(cell: &NdtCell, width_m: f64) -> Self {
        let [(xx, xy), (_, yy)] =
            [0, 1].map(|k| (cell.covariance[(k, 0)], cell.covariance[(k, 1)]));
        let center = 0.5 * (xx + yy);
        let half_gap = math::norm2(0.5 * (xx - yy), xy);
        let (sin, cos) = math::sin_cos(0.5 * math::atan2(2.0 * xy, xx - yy));
        let [long, short] =
            [center + half_gap, center - half_gap].map(|m2| math::sqrt(math::max(m2, 0.0)));
        let corner = [cell.cell.0, cell.cell.1].map(|index| f64::from(index) * width_m);
        Self {
            mean_m: cell.mean.into(),
            half_axes_m: [[long * cos, long * sin], [-short * sin, short * cos]],
            cell_m: Bounds {
                min: corner,
                max: corner.map(|at| at + width_m),
            },
        }
    }
}

impl Hold {
    /// About a shift at the truth, with pairs up to the chapter's τ, independent of the map's.
    fn from_scene(scene: &TerrainScene) -> Self {
        let pose = scene.information(TerrainSettings::default().tau_m);
        let shift = pose.of_shift();
        // The sign of an axis is arbitrary: towards positive x.
        let axes = shift
            .axes
            .map(|axis| axis * if axis.x < 0.0 { -1.0 } else { 1.0 });
        let half_axis_cm = |k: usize| {
            let per_m2 = f64::max(shift.eigenvalues[k], MIN_INFORMATION_PER_M2);
            (axes[k] * (100.0 / math::sqrt(per_m2))).into()
        };
        Self {
            eigenvalues_per_cm2: shift.eigenvalues.map(|per_m2| 1e-4 * per_m2),
            directions_deg: axes.map(|axis| math::atan2(axis.y, axis.x).to_degrees()),
            half_axes_cm: [half_axis_cm(0), half_axis_cm(1)],
            rank: pose.rank(),
        }
    }
}
