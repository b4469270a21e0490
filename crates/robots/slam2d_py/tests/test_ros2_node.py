"""The node of ROS 2 on a simulated drive. Where ROS is not installed, its modules are stood in for by empty ones."""

import importlib.util
import math
import sys
import types
from types import SimpleNamespace

import numpy as np
import pytest
import rustslam2d as rs
from conftest import ROOT


def tree():
    """A message whose fields exist once they are named."""

    class Message(SimpleNamespace):
        def __getattr__(self, name):
            if name.startswith("__"):
                raise AttributeError(name)
            setattr(self, name, Message())
            return getattr(self, name)

    return Message


class Transforms:
    """tf with what a test puts in."""

    def __init__(self):
        self.known = {}

    def lookup_transform(self, parent, child, stamp, timeout):
        if (parent, child) not in self.known:
            raise sys.modules["tf2_ros"].TransformException(f"no transform {parent} to {child}")
        x, y, heading = self.known[parent, child]
        translation = SimpleNamespace(x=x, y=y, z=0.0)
        rotation = SimpleNamespace(x=0.0, y=0.0, z=math.sin(heading / 2), w=math.cos(heading / 2))
        return SimpleNamespace(transform=SimpleNamespace(translation=translation, rotation=rotation))


class Sent(list):
    """A publisher or a broadcaster that keeps what is sent."""

    def __init__(self, *_):
        super().__init__()

    publish = sendTransform = list.append


class Node:
    """A node without a network."""

    def __init__(self, name):
        self.warned = []

    def declare_parameter(self, name, default):
        return SimpleNamespace(value=default)

    def create_publisher(self, kind, topic, profile):
        return Sent()

    def create_subscription(self, kind, topic, call, profile):
        pass

    def get_logger(self):
        return SimpleNamespace(warning=self.warned.append)


@pytest.fixture
def node(monkeypatch):
    """The node of the example over stubs."""
    message = tree()
    stubs = {
        "rclpy": {},
        "rclpy.duration": {"Duration": SimpleNamespace},
        "rclpy.node": {"Node": Node},
        "rclpy.qos": {
            "DurabilityPolicy": SimpleNamespace(TRANSIENT_LOCAL=1),
            "QoSProfile": SimpleNamespace,
            "qos_profile_sensor_data": 5,
        },
        "geometry_msgs.msg": {"TransformStamped": message},
        "nav_msgs.msg": {"OccupancyGrid": message},
        "sensor_msgs.msg": {"LaserScan": message},
        "tf2_ros": {
            "Buffer": Transforms,
            "TransformBroadcaster": Sent,
            "TransformException": type("TransformException", (Exception,), {}),
            "TransformListener": lambda *_, **__: None,
        },
    }
    for name, content in stubs.items():
        module = types.ModuleType(name)
        module.__dict__.update(content)
        monkeypatch.setitem(sys.modules, name, module)
    spec = importlib.util.spec_from_file_location("ros2_node", ROOT / "examples/ros2_node.py")
    example = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(example)
    return example.SlamNode()


def scan_of(drive, k):
    """A message of that scan."""
    stamp = SimpleNamespace(sec=int(drive.stamps[k]), nanosec=round(1e9 * (drive.stamps[k] % 1)))
    sensor = drive.sensor
    return SimpleNamespace(
        header=SimpleNamespace(stamp=stamp, frame_id="laser"), ranges=drive.ranges[k].tolist(),
        angle_min=sensor.first_angle_rad, angle_increment=sensor.angle_step_rad,
        range_min=sensor.range_min_m, range_max=sensor.range_max_m, time_increment=0.0,
    )


def test_the_node_publishes_map_and_correction_of_the_odometry(node, drive):
    node.tf.known["base_link", "laser"] = (0.0, 0.0, 0.0)
    alone = rs.Slam(sensor=drive.sensor)
    # Odometry that starts elsewhere than the map.
    odom_from_start = rs.compose((3.0, -1.0, 0.5), rs.inverse(drive.dead_reckoning[0]))
    for k in range(60):
        odom = rs.compose(odom_from_start, drive.dead_reckoning[k])
        node.tf.known["odom", "base_link"] = odom
        node.take(scan_of(drive, k))
        step = alone.step(drive.ranges[k], drive.odometry[k] if k else None, drive.stamps[k])
        sent = node.broadcaster[-1]
        assert (sent.header.frame_id, sent.child_frame_id) == ("map", "odom")
        found = sent.transform
        heading = 2 * math.atan2(found.rotation.z, found.rotation.w)
        pose = rs.compose((found.translation.x, found.translation.y, heading), odom)
        # 1e-6: the motion between two poses of tf has other roundings than the odometry of the drive.
        assert np.abs(rs.log(rs.between(step.pose, pose))).max() < 1e-6, k
    assert node.warned == []
    assert len(node.maps) == len(alone.poses) > 3
    grid, expected = node.maps[-1], alone.map(0.05)
    assert grid.header.frame_id == "map"
    assert (grid.info.height, grid.info.width) == expected.log_odds.shape
    assert (grid.info.origin.position.x, grid.info.origin.position.y) == pytest.approx(expected.origin)
    cells = np.array(grid.data).reshape(expected.log_odds.shape)[::-1]
    assert set(np.unique(cells)) - set(range(-1, 101)) == set()
    # Cells beside each other may differ by the roundings above.
    assert np.mean((cells == -1) == (expected.log_odds == 0)) > 0.999
    assert np.mean((cells > 50) == (expected.log_odds > 0)) > 0.999


def test_a_scan_without_odometry_is_left_out(node, drive):
    node.take(scan_of(drive, 0))
    assert node.slam is None and node.broadcaster == [] and "no transform" in node.warned[0]
