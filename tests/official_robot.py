"""A robot that drives: the official server of Foxglove's WebSocket protocol sends a recording to its first client.

python tests/official_robot.py RECORDING.mcap [--speed 20] [--without TOPIC]

It prints its address. Once a client has subscribed to all topics, every message is sent at its time, the rate multiplied by
the speed. It ends when its standard input does.
"""

import argparse
import sys
import threading
import time

import foxglove
from mcap.reader import make_reader


class Subscriptions(foxglove.websocket.ServerListener):
    """The topics that are not subscribed to yet."""

    def __init__(self, topics):
        self.missing = set(topics)
        self.are_complete = threading.Event()

    def on_subscribe(self, client, channel):
        self.missing.discard(channel.topic)
        if not self.missing:
            self.are_complete.set()


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("recording")
    arguments.add_argument("--speed", type=float, default=20)
    arguments.add_argument("--without", default="")
    options = arguments.parse_args()
    with open(options.recording, "rb") as file:
        messages = list(make_reader(file).iter_messages(log_time_order=False))
    messages = [one for one in messages if one[1].topic != options.without]
    channels = {}
    for schema, channel, _ in messages:
        if channel.id not in channels:
            schema = foxglove.Schema(name=schema.name, encoding=schema.encoding, data=schema.data)
            channels[channel.id] = foxglove.Channel(
                channel.topic, schema=schema, message_encoding=channel.message_encoding
            )
    subscriptions = Subscriptions({channel.topic for _, channel, _ in messages})
    # By default it drops messages if more than 1,024 wait.
    server = foxglove.start_server(port=0, server_listener=subscriptions, message_backlog_size=len(messages) + 100)
    print(f"ws://127.0.0.1:{server.port}", flush=True)

    def play():
        subscriptions.are_complete.wait()
        started, first = time.monotonic(), messages[0][2].log_time
        for _, channel, message in messages:
            due = started + (message.log_time - first) * 1e-9 / options.speed
            time.sleep(max(0, due - time.monotonic()))
            channels[channel.id].log(message.data, log_time=message.log_time)

    threading.Thread(target=play, daemon=True).start()
    sys.stdin.read()
    server.stop()


main()
