//! The matcher of the page: two sweeps of one room that the reader lays on each other, and ICP from there; won, the next.
//!
//! Poses are `world_from_source`, `[x, y, θ]` in metres and radians, so that the room stands upright.

use ch16_lab::basin::{BasinPlace, BasinScene, HOME_HEADING_DEG, SUCCESS_RADIUS_M};
use ch16_lab::lap::{BuiltInWorld, LapConfig, LapRunner};
use ch16_slam2d::icp::{IcpVariant, IcpWorkspace};
use pr_geom::SE2;
use serde_json::{Value, json};

use crate::story::{pose, short};

/// Pairing distance of w16.1 at its defaults, m.
const TAU_M: f64 = 0.7;

/// Where the canonical lap closes its first loop: the true poses of the old keyframe and of the new one.
fn first_loop() -> [SE2; 2] {
    let record = LapRunner::new().run(&LapConfig::default());
    let first = record
        .lap
        .loop_attempts()
        .find(|attempt| attempt.accepted());
    let found = first.expect("the canonical lap closes loops").verification;
    [found.candidate.node, found.from_node].map(|node| record.lap.keyframes[node].truth)
}

/// The sweeps of a room: the first one's, or from two poses in a built-in world.
fn room(name: &str) -> BasinScene {
    let at = SE2::new;
    let (world, sensors) = match name {
        // Only doors determine the position along it.
        "corridor" => (BuiltInWorld::Apartment, first_loop()),
        "hall" => (BuiltInWorld::Hall, [at(4.5, 3.5, 0.0), at(3.9, 4.3, 0.3)]),
        // Before both doors.
        "twins" => (
            BuiltInWorld::TwinRooms,
            [at(5.5, 0.8, 0.0), at(6.2, 0.7, 0.15)],
        ),
        _ => return BasinScene::new(),
    };
    BasinScene::in_world(
        world.course().world(),
        sensors,
        BasinPlace::Room,
        BasinScene::SEED,
    )
}

/// Runs ICP on the sweeps of a room, from one guess after the other.
pub struct RoomMatcher {
    scene: BasinScene,
    workspace: IcpWorkspace,
}

impl RoomMatcher {
    /// The matcher of a room; an unknown name is that of the first.
    #[must_use]
    pub fn new(name: &str) -> Self {
        Self {
            scene: room(name),
            workspace: IcpWorkspace::new(),
        }
    }

    /// The sweeps as JSON: points of the target in the world, points of the source in its sensor's frame,
    /// `[x0, y0, x1, y1, …]`, the true pose of the source, and how near counts as right, in metres and degrees.
    #[must_use]
    pub fn scene(&self) -> Value {
        let scene = &self.scene;
        let world_from_target = scene.world_from_target();
        let target = scene.target().iter();
        let target = target.map(|point| world_from_target.transform(point));
        let source = scene.source().iter();
        let flat = |points: Vec<[f64; 2]>| -> Vec<Value> {
            points.into_iter().flatten().map(short).collect()
        };
        json!({
            "target": flat(target.map(|point| [point.x, point.y]).collect()),
            "source": flat(source.map(|point| [point.x, point.y]).collect()),
            "truth": pose(&(world_from_target * scene.truth())),
            "home": [SUCCESS_RADIUS_M, HOME_HEADING_DEG],
        })
    }

    /// Point-to-point from a guess: `{"poses", "rmse", "reach", "ending"}`, the guess and the pose after each iteration,
    /// the final rmse and the pairing distance in metres, and the name of the minimum.
    pub fn run(&mut self, world_from_source: &SE2) -> Value {
        let world_from_target = self.scene.world_from_target();
        let start = self
            .scene
            .start_of(&world_from_target.between(world_from_source));
        let config = BasinScene::config(IcpVariant::PointToPoint, TAU_M);
        let found = self
            .scene
            .register_from(&start, &config, &mut self.workspace);
        let trace = self.workspace.trace().iter();
        let poses: Vec<Value> = trace
            .map(|state| pose(&(world_from_target * state.pose)))
            .collect();
        json!({
            "poses": poses,
            "rmse": short(found.rmse_m),
            "reach": TAU_M,
            "ending": found.ending.name(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn truth() -> SE2 {
        let scene = BasinScene::new();
        scene.world_from_target() * scene.truth()
    }

    fn turned(degrees: f64) -> SE2 {
        let truth = truth();
        SE2::new(truth.x(), truth.y(), truth.theta() + degrees.to_radians())
    }

    /// The endings that the page tells of the two starts.
    #[test]
    fn a_guess_nearby_comes_home_and_a_quarter_turn_does_not() {
        let mut matcher = RoomMatcher::new("room");
        let near = matcher.run(&turned(20.0));
        assert_eq!(near["ending"], "right minimum");
        let quarter = matcher.run(&turned(90.0));
        assert_eq!(quarter["ending"], "quarter turn");
        // The figure says that both fit: w16.1 has 0.03 m and 0.13 m.
        assert!(near["rmse"].as_f64().unwrap() < 0.04, "{near}");
        assert!(quarter["rmse"].as_f64().unwrap() < 0.15, "{quarter}");
    }

    #[test]
    fn a_run_begins_at_the_guess_and_the_scene_has_its_truth() {
        let mut matcher = RoomMatcher::new("room");
        let run = matcher.run(&turned(10.0));
        assert_eq!(run["poses"][0], pose(&turned(10.0)));
        let scene = matcher.scene();
        assert_eq!(scene["truth"], pose(&truth()));
        let points = |name: &str| scene[name].as_array().unwrap().len();
        assert!(points("target") > 300 && points("source") > 200);
    }

    /// The run in a room from an offset of the true pose, m and degrees.
    fn ending(name: &str, [right, up, degrees]: [f64; 3]) -> Value {
        let mut matcher = RoomMatcher::new(name);
        let scene = &matcher.scene;
        let truth = scene.world_from_target() * scene.truth();
        let start = SE2::new(
            truth.x() + right,
            truth.y() + up,
            truth.theta() + degrees.to_radians(),
        );
        matcher.run(&start)["ending"].clone()
    }

    /// What the hints of the rooms say.
    #[test]
    fn each_room_is_won_from_nearby_and_has_a_false_minimum_of_its_own() {
        for name in ["room", "corridor", "hall", "twins"] {
            assert_eq!(ending(name, [0.1, 0.05, 2.0]), "right minimum", "{name}");
        }
        assert_ne!(ending("corridor", [-1.2, 0.0, 0.0]), "right minimum");
        assert_ne!(ending("twins", [-1.3, 0.0, 0.0]), "right minimum");
    }
}
