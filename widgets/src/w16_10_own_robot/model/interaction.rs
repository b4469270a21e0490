//! Draggable things: any keyframe, to select it, and the selected one, to move it.

use log_messages::{MapperOrder, Stage};
use widget_kit::model::Handle;

use super::{OwnRobot, panel};

/// Largest distance to which a keyframe can be dragged from the origin, m.
const FARTHEST_M: f64 = 1e6;
/// Step of an arrow key, m.
const NUDGE_M: f64 = 0.05;
/// A press that moves a keyframe by less does not count as a drag, m.
const STILL_M: f64 = 1e-6;

/// The nearest keyframe within reach.
fn nearest(robot: &OwnRobot, at: [f64; 2], reach: [f64; 2]) -> Option<Handle> {
    let keyframes = robot.robot.keyframes.iter().enumerate();
    let things =
        keyframes.map(|(k, keyframe)| ("keyframe", k, [keyframe.pose[0], keyframe.pose[1]]));
    Handle::nearest(panel::MAP, things, at, reach)
}

/// Whether the worker takes changes of the graph.
pub fn may_edit(robot: &OwnRobot) -> bool {
    matches!(robot.robot.progress.stage, Stage::Done | Stage::Checking)
}

/// Grabs the selected keyframe itself; a press on another one selects it.
pub fn grab(robot: &OwnRobot, panel: &str, at: [f64; 2], reach: [f64; 2]) -> Option<Handle> {
    match panel {
        panel::MAP => {}
        panel::FIT | panel::SURE => {
            let now = robot.keyframe() as f64;
            let panel = if panel == panel::FIT {
                panel::FIT
            } else {
                panel::SURE
            };
            return widget_kit::chart::grab_now(panel, now, at, reach);
        }
        _ => return None,
    }
    let handle = nearest(robot, at, reach)?;
    let [near, shown] = [handle.index, robot.keyframe()].map(|k| &robot.robot.keyframes[k].pose);
    let id = if near[..2] == shown[..2] && may_edit(robot) {
        "held"
    } else {
        handle.id
    };
    Some(Handle { id, ..handle })
}

/// Moves the selected keyframe by steps, like a drag.
pub fn nudge(robot: &mut OwnRobot, steps: [f64; 2]) {
    let shown = robot.robot.keyframes.get(robot.keyframe());
    if let Some(at) = shown.map(|shown| [shown.pose[0], shown.pose[1]])
        && may_edit(robot)
    {
        let handle = Handle {
            panel: panel::MAP,
            id: "held",
            offset: steps.map(|steps| -NUDGE_M * steps),
            ..Handle::default()
        };
        drag(robot, handle, at);
    }
}

/// Selects the keyframe at the pointer, or moves the grabbed one.
pub fn drag(robot: &mut OwnRobot, handle: Handle, at: [f64; 2]) {
    let spot = [at[0] - handle.offset[0], at[1] - handle.offset[1]];
    if !spot.iter().all(|value| value.abs() < FARTHEST_M) {
        return;
    }
    let shown = robot.keyframe();
    match handle.id {
        "now" => {
            let to = widget_kit::chart::dragged_to(handle, at) as usize;
            robot.playback.pause();
            robot.show(to.min(robot.last()));
        }
        "held" => {
            let Some(keyframe) = robot.robot.keyframes.get_mut(shown) else {
                return;
            };
            let moved = [0, 1].map(|i| (keyframe.pose[i] - spot[i]).abs());
            if moved.iter().all(|&moved_m| moved_m < STILL_M) {
                return;
            }
            // It follows the pointer at once; the others follow after the optimization.
            (keyframe.pose[0], keyframe.pose[1]) = (spot[0], spot[1]);
            let [x, y, theta] = keyframe.pose;
            robot.robot.answer = format!("Keyframe {shown} is held at x {x:.2} m, y {y:.2} m.");
            robot.order(MapperOrder::Pin(shown, [x, y, theta]));
        }
        _ => {
            if let Some(near) = nearest(robot, spot, [f64::MAX; 2]) {
                robot.playback.pause();
                if near.index != shown {
                    robot.show(near.index);
                }
            }
        }
    }
}
