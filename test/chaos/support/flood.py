#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Floods one input of the node with messages. Some of them are invalid. Prints how many messages it has sent.

usage: flood.py KIND RATE SECONDS SEED, where KIND is tf, tf_static, poses, tracks, cloud, map or collision_object

If SEED is negative, all messages are valid.

The last message is valid. The program ends when its standard input is closed. Until then, roscpp keeps the counters of
the connection.
"""
import pathlib
import random
import struct
import sys
import time

import rospy
from geometry_msgs.msg import PoseArray
from hgrid_proximity.msg import Poses
from sensor_msgs.msg import PointCloud2
from tf2_msgs.msg import TFMessage

ROOM = pathlib.Path(__file__).resolve().parents[3] / "demo/room.bt"
COLLISION_OBJECT = "dbba710596087da521c07564160dfccb"  # MD5 sum of moveit_msgs/CollisionObject in Noetic
BATCH = 0.01  # [s] pause between two groups of messages


def text(value):
    return struct.pack("<I", len(value)) + value.encode()


def header(stamp, frame):
    nanoseconds = round(1e9 * stamp)
    return struct.pack("<III", 0, nanoseconds // 10**9, nanoseconds % 10**9) + text(frame)


def transform(rng, stamp, child):
    """Returns a message with one transform: valid, not finite, too old, from the future, or with missing bytes."""
    kind = rng.choice(("valid",) * 6 + ("nan", "old", "future", "short"))
    stamp += {"old": -100.0, "future": 100.0}.get(kind, 0.0)
    x = float("nan") if kind == "nan" else 1.0
    data = struct.pack("<I", 1) + header(stamp, "world") + text(child) + struct.pack("<7d", x, 0, 0, 0, 0, 0, 1)
    return data[:-8] if kind == "short" else data


def poses(rng, stamp):
    """Returns a message of ~poses that places the obstacle "cart". Some are not valid, as those of transform()."""
    kind = rng.choice(("valid",) * 6 + ("nan", "old", "future", "short"))
    stamp += {"old": -100.0, "future": 100.0}.get(kind, 0.0)
    x = float("nan") if kind == "nan" else 200.0
    names = struct.pack("<II", 1, 1) + text("cart")
    place = struct.pack("<II3d", 0, 1, x, 0, 0) + struct.pack("<I4d", 1, 0, 0, 0, 1)
    data = header(stamp, "world") + names + place + struct.pack("<III", 0, 0, 0)
    return data[:-20] if kind == "short" else data


def tracks(rng, stamp):
    """Returns a message of a tracker that reports one person. Some are not valid, as those of transform()."""
    kind = rng.choice(("valid",) * 6 + ("nan", "old", "future", "short"))
    stamp += {"old": -100.0, "future": 100.0}.get(kind, 0.0)
    x = float("nan") if kind == "nan" else 400.0
    data = header(stamp, "world") + struct.pack("<I7d", 1, x, 0, 0, 0, 0, 0, 1)
    return data[:-8] if kind == "short" else data


def collision_object(rng, stamp):
    """Returns a message of MoveIt that adds one of three spheres. One in every five has no valid radius.

    All of those name "part0", as the last message does. A refused message is missed until a valid one about the same object arrives.
    """
    refused = rng.random() < 0.2
    radius = -1.0 if refused else 0.1
    place = struct.pack("<7d", 250.0 + 10.0 * rng.random(), 0, 0, 0, 0, 0, 1)
    primitive = struct.pack("<IBIdI", 1, 2, 1, radius, 1) + struct.pack("<7d", 0, 0, 0, 0, 0, 0, 1)
    name = text("part%d" % (0 if refused else rng.choice(range(3))))
    return header(stamp, "world") + place + name + text("") + text("") + primitive + struct.pack("<6Ib", *[0] * 7)


def cloud(rng, stamp):
    """Returns a cloud of 20 points far from all bodies. One in every five declares more bytes than it has."""
    points = struct.pack("<60f", *[300.0 + rng.random() for _ in range(60)])
    fields = b"".join(text(name) + struct.pack("<IBI", 4 * i, 7, 1) for i, name in enumerate("xyz"))
    declared = len(points) + (1000 if rng.random() < 0.2 else 0)
    return (header(stamp, "world") + struct.pack("<II", 1, 20) + struct.pack("<I", 3) + fields +
            struct.pack("<BII", 0, 12, 240) + struct.pack("<I", declared) + points + struct.pack("<B", 1))


def octomap(rng, stamp, nodes):
    """Returns a map of the demo room. In one of every five, the last bytes are missing."""
    data = nodes[:-7] if rng.random() < 0.2 else nodes
    return header(stamp, "room") + b"\1" + text("OcTree") + struct.pack("<dI", 0.05, len(data)) + data


class Sound:
    """Replaces the random numbers for the last message, which is then valid."""

    @staticmethod
    def random():
        return 0.5

    @staticmethod
    def choice(options):
        return options[0]


def kinds():
    """Returns for each kind: the topic, the type, the md5 sum, and a function that makes a message."""
    nodes = ROOM.read_bytes().split(b"data\n", 1)[1]
    tf = (TFMessage._type, TFMessage._md5sum)
    return {
        "tf": ("/tf",) + tf + (lambda rng, stamp: transform(rng, stamp, "hand"),),
        "tf_static": ("/tf_static",) + tf + (lambda rng, stamp: transform(rng, stamp, "room"),),
        "poses": ("/proximity/poses", Poses._type, Poses._md5sum, poses),
        "tracks": ("/people", PoseArray._type, PoseArray._md5sum, tracks),
        "collision_object": ("/collision_object", "moveit_msgs/CollisionObject", COLLISION_OBJECT, collision_object),
        "cloud": ("/cloud", PointCloud2._type, PointCloud2._md5sum, cloud),
        "map": ("/octomap_binary", "octomap_msgs/Octomap", "9a45536b45c5e409cd49f04bb2d9999f",
                lambda rng, stamp: octomap(rng, stamp, nodes)),
    }


def publisher(topic, type_name, md5sum):
    """Creates a publisher of raw bytes, and waits for its first subscriber. Returns both: publisher, connection."""
    raw = type("Raw", (rospy.AnyMsg,), {"_type": type_name, "_md5sum": md5sum, "_full_text": ""})
    found = rospy.Publisher(topic, raw, queue_size=None)
    while not found.impl.connections:
        time.sleep(0.01)
    return found, found.impl.connections[0]


def main():
    kind, rate, seconds, seed = sys.argv[1], float(sys.argv[2]), float(sys.argv[3]), int(sys.argv[4])
    rospy.init_node("flood_" + kind, disable_signals=True, disable_rosout=True)
    topic, type_name, md5sum, make = kinds()[kind]
    rng = random.Random(seed) if seed >= 0 else Sound
    kept, connection = publisher(topic, type_name, md5sum)
    begin, sent, last = time.monotonic(), 0, False
    while not last:
        last = time.monotonic() - begin > seconds
        due = 1 if last else int(rate * (time.monotonic() - begin)) - sent
        messages = [make(Sound if last else rng, time.time()) for _ in range(due)]
        connection.write_data(b"".join(struct.pack("<I", len(each)) + each for each in messages))
        sent += due
        time.sleep(BATCH)
    print(sent, flush=True)
    sys.stdin.read()
    kept.unregister()


if __name__ == "__main__":
    main()
