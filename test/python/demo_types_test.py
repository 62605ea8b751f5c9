#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Runs one node for each ~broadphase/type with the parameters, the map and the robots of the demo. Stops the motion of
the demo at some moments, and compares the pairs of all nodes."""
import importlib.machinery
import importlib.util
import math
import re
import subprocess
import sys
import threading
import unittest
import xml.etree.ElementTree
from pathlib import Path

import rospkg
import rospy
import rosunit
import yaml
from geometry_msgs.msg import Pose, PoseArray, TransformStamped
from hgrid_proximity.msg import Pairs
from tf2_msgs.msg import TFMessage

MOMENTS = (2.0, 9.0, 14.5, 18.0, 21.75)  # [s] of the cycle of the demo; in each of them other bodies are near
SETTLED = 0.1  # [s] after a new moment begins, the data of all robots is from this moment
PACKAGE = Path(rospkg.RosPack().get_path("hgrid_proximity"))
DESCRIPTIONS = {"left_arm": "six_axis_arm", "right_arm": "six_axis_arm", "conveyor": "conveyor",
                "mobile_base": "mobile_base"}


def all_types():
    """Returns the values of ~broadphase/type, as doc/parameters.md lists them."""
    row = re.search(r"^\| `broadphase/type` \|.*$", (PACKAGE / "doc/parameters.md").read_text(), re.MULTILINE).group()
    return row.split("|")[5].strip().split(", ")


def demo_program(name):
    """Imports a program of the folder demo."""
    sys.dont_write_bytecode = True
    loader = importlib.machinery.SourceFileLoader(name, str(PACKAGE / "demo" / name))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(name, loader))
    loader.exec_module(module)
    return module


def numbers(element, name, default):
    text = element.get(name) if element is not None else None
    return [float(word) for word in (text or default).split()]


def product(a, b):
    """Returns the product of two quaternions x, y, z, w."""
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (aw * bx + ax * bw + ay * bz - az * by, aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw, aw * bw - ax * bx - ay * by - az * bz)


def about(axis, angle):
    return tuple(math.sin(angle / 2.0) * part for part in axis) + (math.cos(angle / 2.0),)


class Robot:
    """A robot of the demo and the transforms of its joints."""

    def __init__(self, name):
        self.name = name
        text = (PACKAGE / "demo" / (DESCRIPTIONS[name] + ".urdf")).read_text()
        rospy.set_param("/%s/robot_description" % name, text)
        semantic = PACKAGE / "demo" / (DESCRIPTIONS[name] + ".srdf")
        if semantic.exists():
            rospy.set_param("/%s/robot_description_semantic" % name, semantic.read_text())
        self.joints = xml.etree.ElementTree.fromstring(text).findall("joint")

    def transforms(self, stamp, positions):
        """Returns the transforms of all joints. @param positions  [rad or m] by the names of the joints"""
        return [self.transform(joint, stamp, positions.get(joint.get("name"), 0.0)) for joint in self.joints]

    def transform(self, joint, stamp, position):
        place, rpy = numbers(joint.find("origin"), "xyz", "0 0 0"), numbers(joint.find("origin"), "rpy", "0 0 0")
        axis = numbers(joint.find("axis"), "xyz", "1 0 0")
        turn = product(product(about((0, 0, 1), rpy[2]), about((0, 1, 0), rpy[1])), about((1, 0, 0), rpy[0]))
        if joint.get("type") == "prismatic":
            assert rpy == [0.0, 0.0, 0.0], "this test moves only joints whose origin is not rotated"
            place = [a + position * b for a, b in zip(place, axis)]
        elif joint.get("type") != "fixed":
            turn = product(turn, about(axis, position))
        result = TransformStamped()
        result.header.stamp = stamp
        result.header.frame_id = self.name + "/" + joint.find("parent").get("link")
        result.child_frame_id = self.name + "/" + joint.find("child").get("link")
        translation, rotation = result.transform.translation, result.transform.rotation
        translation.x, translation.y, translation.z = place
        rotation.x, rotation.y, rotation.z, rotation.w = turn
        return result


class Demo:
    """Publishes the transforms of all robots and the place of the person, as they are at one moment of the demo."""

    def __init__(self):
        self.motion, self.person = demo_program("move_cell"), demo_program("person")
        self.robots = [Robot(name) for name in DESCRIPTIONS]
        self.tf = rospy.Publisher("/tf", TFMessage, queue_size=10)
        self.people = rospy.Publisher("/people", PoseArray, queue_size=10)
        self.moment = MOMENTS[0]
        self.timer = rospy.Timer(rospy.Duration(0.04), self.publish)

    def publish(self, _):
        stamp, moment = rospy.Time.now(), self.moment
        bases = dict(self.motion.BASES)
        x, y, heading = self.motion.way_at(moment / self.motion.CYCLE * self.motion.way_length())
        bases["mobile_base"] = (x, y, 0.0, heading)
        joints = self.motion.joints_at(moment)
        message = TFMessage()
        for robot in self.robots:
            message.transforms.append(self.motion.transform(robot.name, stamp, *bases[robot.name]))
            message.transforms += robot.transforms(stamp, dict(zip(*joints[robot.name])))
        self.tf.publish(message)
        people = PoseArray(poses=[Pose()])
        people.header.stamp, people.header.frame_id = stamp, "world"
        people.poses[0].position.x, people.poses[0].position.y = self.person.position_at(0.0)
        people.poses[0].orientation.w = 1.0
        self.people.publish(people)


class DemoTypes(unittest.TestCase):
    def setUp(self):
        rospy.init_node("demo_types_test")
        self.news = threading.Condition()
        self.newest = {}
        self.types = all_types()
        self.demo = Demo()
        params = yaml.safe_load((PACKAGE / "demo/cell.yaml").read_text())
        params["map"] = {"folder": str(PACKAGE / "demo")}
        # Eleven nodes on a busy machine must not make the data old, because then margins grow.
        params.update(late_after=5.0, stale_after=10.0, lost_after=20.0, valid_for=10.0, rate=20.0)
        self.nodes = []
        for kind in self.types:
            node = "/proximity_" + kind
            rospy.set_param(node, dict(params, broadphase={"type": kind}))
            rospy.Subscriber(node + "/pairs", Pairs, self.hear, kind, queue_size=10)
            self.nodes.append(subprocess.Popen(["rosrun", "hgrid_proximity", "proximity_node", "__name:=" + node[1:]]))

    def tearDown(self):
        for node in self.nodes:
            node.terminate()
        for node in self.nodes:
            node.wait(timeout=60.0)

    def hear(self, message, kind):
        with self.news:
            self.newest[kind] = message
            self.news.notify_all()

    def pairs_of(self, kind, begin):
        """Waits for the pairs of a node in the moment that began at a time. Returns them with their gaps, rounded."""
        def is_there():
            message = self.newest.get(kind)
            return message and message.header.stamp > begin + rospy.Duration(SETTLED) and message.world.complete

        with self.news:
            self.assertTrue(self.news.wait_for(is_there, timeout=120.0), "no pairs of a complete world from " + kind)
            message = self.newest[kind]
        self.assertFalse(message.truncated)
        return [(message.names[first], message.names[second], round(gap, 6), round(margin, 6))
                for first, second, gap, margin in zip(message.first, message.second, message.gap, message.margin)]

    def test_all_types_list_the_same_pairs(self):
        """Claim: the demo with each ~broadphase/type lists the same pairs, with the same gaps and margins."""
        self.assertGreaterEqual(len(self.types), 11)
        seen = []
        for moment in MOMENTS:
            self.demo.moment = moment
            begin = rospy.Time.now()
            seen.append(self.pairs_of("hgrid", begin))
            for kind in self.types:
                self.assertEqual(self.pairs_of(kind, begin), seen[-1], "%s at %g s" % (kind, moment))
        for pairs in seen:
            self.assertGreaterEqual(len(pairs), 3)
        self.assertEqual(len({str(pairs) for pairs in seen}), len(MOMENTS), "the moments should differ")


if __name__ == "__main__":
    rosunit.unitrun("hgrid_proximity", "demo_types", DemoTypes)
