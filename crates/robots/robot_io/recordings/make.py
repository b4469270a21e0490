"""Writes the fixtures next to it with independent writers: PyPI `rosbags` and `mcap`.

    ch16 lap --frames lap.jsonl
    python3 -m venv venv && venv/bin/pip install rosbags==0.11.9 mcap==1.6.0
    venv/bin/python crates/robots/robot_io/recordings/make.py lap.jsonl

The first frames of the simulator's lap become recordings of a robot whose laser is 0.1 m in front
of its centre. Odometry is recorded 20 ms before and after each scan, so the reader must interpolate
the pose at the scan's stamp.
"""

import json
import math
import pathlib
import sys
import tempfile

import numpy as np
from mcap.writer import CompressionType, IndexType, Writer as McapWriter
from rosbags.rosbag1 import Writer as BagWriter
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer as Bag2Writer
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

FRAMES = 24
START_S = 1_700_000_000.0
LASER_X_M = 0.1
HERE = pathlib.Path(__file__).parent


def main(lap):
    lines = [json.loads(line) for line in open(lap)][:FRAMES]
    frames = {'plain.mcap': None, 'lz4.mcap': 'lz4', 'zstd.mcap': 'zstd'}
    for name, packing in frames.items():
        write_mcap(HERE / name, list(messages(lines, 'odometry')), packing)
    write_mcap(HERE / 'tf.mcap', list(messages(lines, 'tf')), 'zstd')
    write_mcap(HERE / 'cloud.mcap', list(messages(lines, 'cloud')), 'zstd')
    for name, packing in {'plain.bag': None, 'lz4.bag': 'LZ4', 'bz2.bag': 'BZ2'}.items():
        write_bag(HERE / name, list(messages(lines, 'odometry')), packing)
    write_db3(HERE / 'plain.db3', list(messages(lines, 'odometry')), None)
    write_db3(HERE / 'packed.db3', list(messages(lines, 'odometry')), 'message')
    with open(HERE / 'frames.jsonl', 'w') as out:
        for line in lines:
            line['stamp_s'] += START_S
            out.write(json.dumps(line, separators=(',', ':')) + '\n')


def messages(lines, kind):
    """Time, topic and a function that makes the message from the types of a store."""
    yield START_S - 1, '/tf_static', lambda m: m.tf([m.transform(START_S - 1, 'base_link', 'laser', (LASER_X_M, 0, 0))])
    before = lines[0]['odometry']
    for line in lines:
        pose, stamp = line['odometry'], START_S + line['stamp_s']
        # The pose of the scan is not recorded: it is interpolated between these two, on one twist.
        yield odometry(kind, stamp - 0.02, along(before, pose, 0.9))
        yield stamp + 0.001, '/scan', scan(kind, stamp, line)
        yield odometry(kind, stamp + 0.02, along(before, pose, 1.1))
        before = pose


def odometry(kind, stamp, pose):
    if kind == 'tf':
        return stamp, '/tf', lambda m: m.tf([m.transform(stamp, 'odom', 'base_link', pose)])
    return stamp, '/odom', lambda m: m.odometry(stamp, pose)


def scan(kind, stamp, line):
    return lambda m: m.cloud(stamp, line) if kind == 'cloud' else m.scan(stamp, line)


def along(a, b, share):
    """On the twist from a to b, and beyond b where the share is above one."""
    dx, dy, turn = b[0] - a[0], b[1] - a[1], math.remainder(b[2] - a[2], math.tau)
    x = math.cos(a[2]) * dx + math.sin(a[2]) * dy
    y = -math.sin(a[2]) * dx + math.cos(a[2]) * dy
    half = turn / 2
    scale = half / math.tan(half) if abs(half) > 1e-9 else 1.0
    vx, vy = scale * x + half * y, -half * x + scale * y
    turn, vx, vy = share * turn, share * vx, share * vy
    s = math.sin(turn) / turn if abs(turn) > 1e-9 else 1.0
    c = (1 - math.cos(turn)) / turn if abs(turn) > 1e-9 else turn / 2
    x, y = s * vx - c * vy, c * vx + s * vy
    return [a[0] + math.cos(a[2]) * x - math.sin(a[2]) * y, a[1] + math.sin(a[2]) * x + math.cos(a[2]) * y, a[2] + turn]


class Messages:
    """Messages of one version of ROS."""

    def __init__(self, store, has_sequence):
        self.store = get_typestore(store)
        if 'tf2_msgs/msg/TFMessage' not in self.store.types:
            definition = 'geometry_msgs/TransformStamped[] transforms'
            self.store.register(get_types_from_msg(definition, 'tf2_msgs/msg/TFMessage'))
        self.types = self.store.types
        self.has_sequence = has_sequence

    def make(self, name, /, **fields):
        return self.types[name](**fields)

    def header(self, stamp, frame):
        seconds = math.floor(stamp)
        time = self.make('builtin_interfaces/msg/Time', sec=seconds, nanosec=round((stamp - seconds) * 1e9))
        sequence = {'seq': 0} if self.has_sequence else {}
        return self.make('std_msgs/msg/Header', stamp=time, frame_id=frame, **sequence)

    def rotation(self, theta):
        return self.make('geometry_msgs/msg/Quaternion', x=0.0, y=0.0, z=math.sin(theta / 2), w=math.cos(theta / 2))

    def transform(self, stamp, parent, child, pose):
        x, y, theta = map(float, pose)
        return self.make(
            'geometry_msgs/msg/TransformStamped',
            header=self.header(stamp, parent),
            child_frame_id=child,
            transform=self.make(
                'geometry_msgs/msg/Transform',
                translation=self.make('geometry_msgs/msg/Vector3', x=x, y=y, z=0.2),
                rotation=self.rotation(theta),
            ),
        )

    def tf(self, transforms):
        return self.make('tf2_msgs/msg/TFMessage', transforms=transforms)

    def odometry(self, stamp, pose):
        x, y, theta = map(float, pose)
        zero = self.make('geometry_msgs/msg/Vector3', x=0.0, y=0.0, z=0.0)
        covariance = np.zeros(36)
        return self.make(
            'nav_msgs/msg/Odometry',
            header=self.header(stamp, 'odom'),
            child_frame_id='base_link',
            pose=self.make(
                'geometry_msgs/msg/PoseWithCovariance',
                pose=self.make(
                    'geometry_msgs/msg/Pose',
                    position=self.make('geometry_msgs/msg/Point', x=x, y=y, z=0.0),
                    orientation=self.rotation(theta),
                ),
                covariance=covariance,
            ),
            twist=self.make(
                'geometry_msgs/msg/TwistWithCovariance',
                twist=self.make('geometry_msgs/msg/Twist', linear=zero, angular=zero),
                covariance=covariance,
            ),
        )

    def scan(self, stamp, line):
        ranges = np.array(line['ranges_m'], dtype=np.float32)
        return self.make(
            'sensor_msgs/msg/LaserScan',
            header=self.header(stamp, 'laser'),
            angle_min=line['first_angle_rad'],
            angle_max=line['first_angle_rad'] + (len(ranges) - 1) * line['angle_step_rad'],
            angle_increment=line['angle_step_rad'],
            time_increment=0.0,
            scan_time=0.0,
            range_min=line['range_min_m'],
            range_max=line['range_max_m'],
            ranges=ranges,
            intensities=np.array([], dtype=np.float32),
        )

    def cloud(self, stamp, line):
        points = []
        for beam, range_m in enumerate(line['ranges_m']):
            if range_m < line['range_max_m']:
                bearing = line['first_angle_rad'] + beam * line['angle_step_rad']
                points.append((range_m * math.cos(bearing), range_m * math.sin(bearing), 0.0))
        data = np.array(points, dtype='<f4')
        fields = [
            self.make('sensor_msgs/msg/PointField', name=name, offset=4 * index, datatype=7, count=1)
            for index, name in enumerate('xyz')
        ]
        return self.make(
            'sensor_msgs/msg/PointCloud2',
            header=self.header(stamp, 'laser'),
            height=1,
            width=len(points),
            fields=fields,
            is_bigendian=False,
            point_step=12,
            row_step=12 * len(points),
            data=np.frombuffer(data.tobytes(), dtype=np.uint8),
            is_dense=True,
        )


def write_mcap(path, recorded, packing):
    kinds = Messages(Stores.ROS2_HUMBLE, has_sequence=False)
    compression = {None: CompressionType.NONE, 'lz4': CompressionType.LZ4, 'zstd': CompressionType.ZSTD}[packing]
    with open(path, 'wb') as out:
        writer = McapWriter(out, chunk_size=8192, compression=compression, index_types=IndexType.ALL)
        writer.start(profile='ros2', library='fixture')
        channels = {}
        for stamp, topic, make in recorded:
            message = make(kinds)
            name = message.__msgtype__
            if topic not in channels:
                definition, _ = kinds.store.generate_msgdef(name, ros_version=2)
                schema = writer.register_schema(name=name, encoding='ros2msg', data=definition.encode())
                channels[topic] = writer.register_channel(topic=topic, message_encoding='cdr', schema_id=schema)
            data = bytes(kinds.store.serialize_cdr(message, name))
            time = round(stamp * 1e9)
            writer.add_message(channels[topic], log_time=time, publish_time=time, data=data)
        writer.finish()


def write_bag(path, recorded, packing):
    kinds = Messages(Stores.ROS1_NOETIC, has_sequence=True)
    path.unlink(missing_ok=True)
    writer = BagWriter(path)
    if packing:
        writer.set_compression(BagWriter.CompressionFormat[packing])
    with writer:
        connections = {}
        for stamp, topic, make in recorded:
            message = make(kinds)
            name = message.__msgtype__
            if topic not in connections:
                connections[topic] = writer.add_connection(topic, name, typestore=kinds.store)
            data = bytes(kinds.store.serialize_ros1(message, name))
            writer.write(connections[topic], round(stamp * 1e9), data)


def write_db3(path, recorded, packing):
    """A recording of rosbag2 in SQLite; its messages may be packed one by one."""
    kinds = Messages(Stores.ROS2_HUMBLE, has_sequence=False)
    with tempfile.TemporaryDirectory() as folder:
        writer = Bag2Writer(pathlib.Path(folder) / 'bag', version=8, storage_plugin=StoragePlugin.SQLITE3)
        if packing:
            writer.set_compression(CompressionMode.MESSAGE, CompressionFormat.ZSTD)
        with writer:
            connections = {}
            for stamp, topic, make in recorded:
                message = make(kinds)
                name = message.__msgtype__
                if topic not in connections:
                    connections[topic] = writer.add_connection(topic, name, typestore=kinds.store)
                data = bytes(kinds.store.serialize_cdr(message, name))
                writer.write(connections[topic], round(stamp * 1e9), data)
        (written,) = pathlib.Path(folder).glob('bag/*.db3')
        path.write_bytes(written.read_bytes())


if __name__ == '__main__':
    main(sys.argv[1])
