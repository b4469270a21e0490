"""SLAM for a planar laser as a node of ROS 2: it publishes the map and the transform map → odom.

    python examples/ros2_node.py --ros-args -p odom:=odom -p body:=base_link -p resolution:=0.05

It takes the topic scan (sensor_msgs/LaserScan), and from tf the odometry, odom → body, and the mounting of the laser.
"""

import math

import numpy as np
import rclpy
import rustslam2d as rs
from geometry_msgs.msg import TransformStamped
from nav_msgs.msg import OccupancyGrid
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, qos_profile_sensor_data
from sensor_msgs.msg import LaserScan
from tf2_ros import Buffer, TransformBroadcaster, TransformException, TransformListener

#: Longest wait for the odometry of a scan, which often arrives after it.
PATIENCE = Duration(seconds=0.2)


class SlamNode(Node):
    """Registers each scan; `map` → `odom` corrects the odometry."""

    def __init__(self):
        super().__init__("rustslam2d")
        self.odom, self.body, self.resolution = (
            self.declare_parameter(name, default).value
            for name, default in (("odom", "odom"), ("body", "base_link"), ("resolution", 0.05))
        )
        self.slam, self.last = None, None
        self.tf, self.broadcaster = Buffer(), TransformBroadcaster(self)
        self.listener = TransformListener(self.tf, self, spin_thread=True)
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.maps = self.create_publisher(OccupancyGrid, "map", latched)
        self.create_subscription(LaserScan, "scan", self.take, qos_profile_sensor_data)

    def pose(self, parent, child, stamp):
        """parent_from_child of tf in the plane: x, y, θ."""
        found = self.tf.lookup_transform(parent, child, stamp, PATIENCE).transform
        q = found.rotation
        heading = math.atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y**2 + q.z**2))
        return np.array([found.translation.x, found.translation.y, heading])

    def take(self, scan):
        """Takes a scan; one without odometry, or that the estimator rejects, is left out."""
        stamp = scan.header.stamp
        try:
            odom_from_body = self.pose(self.odom, self.body, stamp)
            if self.slam is None:
                self.slam = rs.Slam(sensor=self.sensor(scan, self.pose(self.body, scan.header.frame_id, stamp)))
            motion = None if self.last is None else rs.between(self.last, odom_from_body)
            step = self.slam.step(scan.ranges, motion, stamp.sec + 1e-9 * stamp.nanosec)
        except (TransformException, rs.SlamError) as problem:
            self.get_logger().warning(f"a scan is left out: {problem}")
            return
        self.last = odom_from_body
        self.send_correction(rs.compose(step.pose, rs.inverse(odom_from_body)), stamp)
        if step.keyframe is not None:
            self.maps.publish(self.grid(stamp))

    def sensor(self, scan, body_from_sensor):
        """The geometry of the laser."""
        return rs.Sensor(
            first_angle_rad=scan.angle_min, angle_step_rad=scan.angle_increment, range_min_m=scan.range_min,
            range_max_m=scan.range_max, beam_interval_s=scan.time_increment, body_from_sensor=body_from_sensor,
        )

    def send_correction(self, map_from_odom, stamp):
        """Broadcasts map → odom."""
        sent = TransformStamped()
        sent.header.stamp, sent.header.frame_id, sent.child_frame_id = stamp, "map", self.odom
        x, y, heading = (float(number) for number in map_from_odom)
        sent.transform.translation.x, sent.transform.translation.y = x, y
        sent.transform.rotation.z, sent.transform.rotation.w = math.sin(heading / 2), math.cos(heading / 2)
        self.broadcaster.sendTransform(sent)

    def grid(self, stamp):
        """The map as a message: −1 is unknown, else the probability of occupancy in per cent, the lowest row first."""
        built = self.slam.map(self.resolution)
        odds = built.log_odds[::-1]
        cells = np.where(odds == 0, -1, np.rint(100 / (1 + np.exp(-odds)))).astype(np.int8)
        sent = OccupancyGrid()
        sent.header.stamp, sent.header.frame_id = stamp, "map"
        sent.info.height, sent.info.width, sent.info.resolution = *cells.shape, built.cell
        sent.info.origin.position.x, sent.info.origin.position.y = built.origin
        sent.info.origin.orientation.w = 1.0
        sent.data = cells.ravel().tolist()
        return sent


def main():
    """Runs the node until it is interrupted."""
    rclpy.init()
    rclpy.spin(SlamNode())


if __name__ == "__main__":
    main()
