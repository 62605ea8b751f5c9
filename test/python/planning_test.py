#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Plans for a Panda in the map of a building with examples/plan.py. Then publishes the plan as joint states, and expects no
contact in ~distances. Skipped if the data do not exist."""
import os
import subprocess
import sys
import time
import unittest

import numpy
import rospy
import rosunit
from geometry_msgs.msg import TransformStamped
from hgrid_proximity.client import Proximity
from hgrid_proximity.msg import MeasureStatus
from sensor_msgs.msg import JointState
from tf2_msgs.msg import TFMessage
from turning_arm import wait

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.realpath(__file__))))
DATA = os.environ.get("HGRID_TEST_DATA") or os.path.join(os.path.dirname(ROOT), "shared", "data")
sys.path.insert(0, os.path.join(ROOT, "examples"))
from plan import Planner

JOINTS = ["panda_joint%d" % i for i in range(1, 8)] + ["panda_finger_joint1"]
START = [0.0, -0.3, 0.0, -2.0, 0.0, 1.8, 0.8, 0.02]
GOAL = [2.6] + START[1:]  # the straight way leads through furniture


def contacts_of(distances):
    """Returns the pairs in contact, each as two names in alphabetical order."""
    touching = distances.status >= MeasureStatus.CONTACT
    pairs = zip(distances.first_names[touching], distances.second_names[touching])
    return [tuple(sorted(pair)) for pair in pairs]


class Drivers:
    """Publishes joint states, as the drivers of the robot would. Holds the newest state until the next one is set."""

    def __init__(self, state):
        self._publisher = rospy.Publisher("joint_states", JointState, queue_size=10)
        self.set(state)
        self._timer = rospy.Timer(rospy.Duration(0.02), self._publish)

    def set(self, state):
        """Returns the time from which on all published states are this one."""
        self._state = list(state)
        time.sleep(0.001)  # a state that the timer is about to publish has an earlier stamp
        return self._publish(None)

    def _publish(self, _):
        state = JointState(name=JOINTS, position=self._state)
        state.header.stamp = rospy.Time.now()
        self._publisher.publish(state)
        return state.header.stamp


MAP = os.path.join(DATA, "octomap", "geb079.bt")


@unittest.skipUnless(os.path.exists(MAP), MAP + " does not exist; set HGRID_TEST_DATA")
class Planning(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("planning_test")
        folder = os.path.join(DATA, "example-robot-data", "robots", "panda_description")
        for name, file in (("robot_description", "urdf/panda.urdf"), ("robot_description_semantic", "srdf/panda.srdf")):
            with open(os.path.join(folder, file), encoding="utf-8") as text:
                rospy.set_param(name, text.read())
        rospy.set_param("proximity", {
            "world_frame": "world", "margin": 0.2, "valid_for": 10.0, "late_after": 2.0, "stale_after": 3.0,
            "lost_after": 6.0, "map": {"folder": os.path.join(DATA, "octomap")},
            "maps": [{"name": "building", "file": "geb079.bt"}]})
        environment = dict(os.environ)
        environment["ROS_PACKAGE_PATH"] = DATA + ":" + environment.get("ROS_PACKAGE_PATH", "")
        base = TransformStamped(child_frame_id="panda_link0")
        base.header.frame_id, base.transform.rotation.w = "world", 1.0
        base.transform.translation.y, base.transform.translation.z = -2.0, 0.1
        cls.base = rospy.Publisher("/tf_static", TFMessage, queue_size=1, latch=True)
        cls.base.publish(TFMessage([base]))
        cls.drivers = Drivers(START)
        commands = (["rosrun", "robot_state_publisher", "robot_state_publisher"],
                    ["rosrun", "hgrid_proximity", "proximity_node", "__name:=proximity"])
        cls.processes = [subprocess.Popen(command, env=environment) for command in commands]
        cls.proximity = Proximity("/proximity", timeout=60.0)
        wait(lambda: cls.proximity.pairs().usable, "a complete world", 120.0)

    @classmethod
    def tearDownClass(cls):
        for process in cls.processes:
            process.terminate()
        for process in cls.processes:
            process.wait()

    # Claim: the node sees no contact while the robot follows the plan.
    def test_a_way_that_was_planned_has_no_contact_when_it_is_played(self):
        straight = self.proximity.check_edges(JOINTS, [START], [GOAL])
        self.assertTrue(straight.hit[0], "the straight way is free, so there is nothing to plan")
        planner = Planner(self.proximity, JOINTS, START, GOAL)
        way = planner.plan()
        self.assertIsNotNone(way)
        self.assertGreater(len(way), 2)
        seen = 0
        for begin, end in zip(way, way[1:]):
            steps = int(numpy.ceil(numpy.linalg.norm(end - begin) / 0.1))
            for step in range(steps):
                messages = self.distances_at(begin + (end - begin) * (step + 1) / steps)
                for distances in messages:
                    self.assertTrue(distances.usable)
                    self.assertEqual(contacts_of(distances), [])
                self.assertNotIn(MeasureStatus.NOT_MEASURED, messages[-1].status)
                seen += len(messages[-1].status)
        self.assertGreater(seen, 100)
        contact = START + straight.at[0] * (numpy.array(GOAL) - START)
        self.assertIn(tuple(sorted(straight.pair(0))), contacts_of(self.distances_at(contact)[-1]))

    def distances_at(self, state):
        """Moves the robot to a state. Returns messages of ~distances about this state. Every pair was measured in the last
        of them. On a busy computer, some ticks before it have no time to measure all pairs."""
        since = self.drivers.set(state) + rospy.Duration(0.005)
        messages = []
        while not messages or messages[-1].longest_wait > 0:
            distances = self.proximity.distances()
            if distances.header.stamp > since:
                messages.append(distances)
        return messages


if __name__ == "__main__":
    rosunit.unitrun("hgrid_proximity", "planning", Planning)
