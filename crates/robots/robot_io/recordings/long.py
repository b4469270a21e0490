"""Writes a long log of a given size, to measure the memory that a large file takes.

    slam2d-dev buildings --kind ring --seeds 145 --log drive.clf
    slam2d convert drive.clf drive.jsonl
    python3 crates/robots/robot_io/recordings/long.py drive.jsonl long.clf --megabytes 500
    venv/bin/python crates/robots/robot_io/recordings/long.py drive.jsonl long.mcap --megabytes 500

The drive is repeated over time, as by a robot that patrols all day. The scanner gets three times the beams and
sixteen times the rate, as current ones have: new beams are interpolated between their neighbours, and
each scan is recorded sixteen times at the same pose. A name that ends in .mcap is written by the
PyPI packages that `make.py` needs; .clf needs none.
"""

import argparse
import json
import struct

BEAMS = 3
RATE = 16
# Neighbours that differ by more hit different objects, and are not interpolated.
ONE_WALL_M = 0.3
START_S = 1_700_000_000


def main():
    asked = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    asked.add_argument('drive', help='a log as lines of JSON')
    asked.add_argument('output', help='long.clf or long.mcap')
    asked.add_argument('--megabytes', type=float, default=500)
    args = asked.parse_args()
    with open(args.drive) as drive:
        lines = [finer(json.loads(line)) for line in drive]
    write = write_mcap if args.output.endswith('.mcap') else write_carmen
    write(args.output, lines, args.megabytes * 1e6)


def finer(line):
    """The same scan with more beams."""
    ranges = line['ranges_m']
    nothing = line['range_max_m'] or 0.0
    between = []
    for a, b in zip(ranges, ranges[1:]):
        a, b = (nothing if r is None else r for r in (a, b))
        for k in range(BEAMS):
            near = a if 2 * k < BEAMS else b
            between.append(round(a + (b - a) * k / BEAMS if abs(a - b) < ONE_WALL_M else near, 3))
    between.append(nothing if ranges[-1] is None else ranges[-1])
    return {**line, 'ranges_m': between, 'angle_step_rad': line['angle_step_rad'] / BEAMS}


def stamps(lines):
    """Frame after frame with its time, without end."""
    first, last = lines[0]['stamp_s'], lines[-1]['stamp_s']
    step = (last - first) / (len(lines) - 1)
    time = 0.0
    while True:
        for line in lines:
            for _ in range(RATE):
                yield time, line
                time += step / RATE


def write_carmen(path, lines, size):
    texts = {}
    with open(path, 'w') as out:
        written = 0
        for time, line in stamps(lines):
            if id(line) not in texts:
                ranges, step = line['ranges_m'], line['angle_step_rad']
                pose = ' '.join(map(str, line['odometry']))
                texts[id(line)] = (
                    f'ROBOTLASER1 0 {line["first_angle_rad"]} {step * (len(ranges) - 1)} {step} {line["range_max_m"]} '
                    f'0.01 0 {len(ranges)} {" ".join(map(str, ranges))} 0 {pose} {pose} 0 0 0 0 0')
            written += out.write(f'{texts[id(line)]} {time:.6f} robot {time:.6f}\n')
            if written >= size:
                return


def write_mcap(path, lines, size):
    from mcap.writer import CompressionType, Writer
    from make import Messages, Stores

    kinds = Messages(Stores.ROS2_HUMBLE, has_sequence=False)
    packed = {}

    def pack(line):
        messages = [kinds.odometry(0, line['odometry']), kinds.scan(0, line)]
        return [bytes(kinds.store.serialize_cdr(message, message.__msgtype__)) for message in messages]

    with open(path, 'wb') as out:
        writer = Writer(out, compression=CompressionType.NONE, chunk_size=1 << 20)
        writer.start(profile='ros2', library='long')
        channels = []
        for topic, name in [('/odom', 'nav_msgs/msg/Odometry'), ('/scan', 'sensor_msgs/msg/LaserScan')]:
            definition, _ = kinds.store.generate_msgdef(name, ros_version=2)
            schema = writer.register_schema(name=name, encoding='ros2msg', data=definition.encode())
            channels.append(writer.register_channel(topic=topic, message_encoding='cdr', schema_id=schema))
        written = 0
        for time, line in stamps(lines):
            if id(line) not in packed:
                packed[id(line)] = pack(line)
            time_ns = START_S * 10**9 + round(time * 1e9)
            stamp = struct.pack('<iI', *divmod(time_ns, 10**9))
            for channel, data in zip(channels, packed[id(line)]):
                # The stamp comes first in a message, after the four bytes of its encoding.
                writer.add_message(channel, log_time=time_ns, publish_time=time_ns, data=data[:4] + stamp + data[12:])
                written += len(data)
            if written >= size:
                break
        writer.finish()


main()
