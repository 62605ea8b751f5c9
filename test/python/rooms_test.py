#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""A node with the rooms and doors of config/rooms.yaml, and two obstacles that are near each other: a cart in the hall
and a person in the cell."""
import importlib.machinery
import importlib.util
import os
import sys
import threading
import unittest

import numpy as np
import rospkg
import rospy
import rosunit
import yaml
from hgrid_proximity import obstacles
from hgrid_proximity.client import Proximity
from hgrid_proximity.msg import Pairs, Status
from visualization_msgs.msg import MarkerArray

BESIDE_THE_DOOR, IN_THE_DOOR = 0.5, 2.0  # [m] y of both obstacles
CART, PERSON = "obstacle/cart", "obstacle/person"


def show_program():
    """Imports the program that opens RViz."""
    sys.dont_write_bytecode = True
    path = os.path.join(rospkg.RosPack().get_path("hgrid_proximity"), "tools", "show")
    loader = importlib.machinery.SourceFileLoader("show", path)
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("show", loader))
    loader.exec_module(module)
    return module


class Rooms(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("rooms_test")
        cls.news = threading.Condition()
        cls.pairs, cls.status, cls.markers = [], [], []
        for name, kind, heard in (("pairs", Pairs, cls.pairs), ("status", Status, cls.status),
                                  ("markers", MarkerArray, cls.markers)):
            rospy.Subscriber("/proximity/" + name, kind, cls.hear, heard, queue_size=100)
        cls.proximity = Proximity("/proximity", timeout=60.0)
        cls.wait("a complete world", lambda: cls.pairs and cls.pairs[-1].world.complete)

    @classmethod
    def hear(cls, message, heard):
        with cls.news:
            heard.append(message)
            cls.news.notify_all()

    @classmethod
    def wait(cls, what, holds):
        with cls.news:
            if not cls.news.wait_for(holds, timeout=60.0):
                raise AssertionError("not seen after 60 s: " + what)

    def move_both(self, y):
        """Moves the obstacles. Returns the first message of ~pairs with the new poses."""
        answer = self.proximity.apply_obstacles(obstacles.move("cart", (3.78, y, 1.0)),
                                                obstacles.move("person", (4.42, y, 1.0)))
        sequence = answer.world.sequence
        self.wait("the next tick", lambda: self.pairs[-1].world.sequence >= sequence)
        return next(message for message in self.pairs if message.world.sequence >= sequence)

    def counter(self, name):
        return {counter.name: counter.value for counter in self.status[-1].counters}.get(name, 0)

    def test_only_in_the_door_they_are_a_pair(self):
        """Claim: a wall separates near bodies, a door joins them, and ~explain_pair says so, also about the past."""
        self.assertEqual(self.move_both(BESIDE_THE_DOOR).names, [])
        separate = self.proximity.explain_pair(CART, PERSON)
        self.assertFalse(separate.reported)
        self.assertAlmostEqual(separate.gap, 0.24, places=5)
        words = ("they have no room of ~rooms in common, so they are never a pair: obstacle/cart is in 'hall', and "
                 "obstacle/person is in 'cell'. Otherwise they would be reported")
        self.assertIn(words, separate.explanation)
        message = self.move_both(IN_THE_DOOR)
        self.assertEqual(message.names, [CART, PERSON])
        self.assertAlmostEqual(message.gap[0], 0.24, places=5)
        self.assertTrue(self.proximity.explain_pair(CART, PERSON).reported)
        past = self.proximity.explain_pair(CART, PERSON, stamp=separate.header.stamp)
        self.assertFalse(past.reported)
        self.assertIn(words, past.explanation)
        self.assertEqual(self.move_both(BESIDE_THE_DOOR).names, [])

    def test_queries_see_through_walls(self):
        """Claim: rooms are about pairs only. A query finds the bodies of all rooms."""
        self.move_both(BESIDE_THE_DOOR)
        answer = self.proximity.query_sphere((4.1, BESIDE_THE_DOOR, 1.0), 0.2)
        self.assertEqual(sorted(answer.names), [CART, PERSON])

    def test_markers_show_rooms_and_doors(self):
        """Claim: ~markers has the edges and the names of rooms and doors."""
        names = {"hall", "cell", "corner", "hall - cell", "hall - corner"}

        def shown():
            drawn = [marker for message in self.markers for marker in message.markers if marker.ns in ("rooms", "doors")]
            lines = {marker.ns for marker in drawn if len(marker.points) >= 24}
            return lines == {"rooms", "doors"} and {marker.text for marker in drawn if marker.text} == names

        self.wait("all names and lines", shown)

    def test_show_opens_rviz_with_the_whole_world(self):
        """Claim: the camera that `show` gives to RViz sees all boxes and the text above them, and they fill the picture."""
        show = show_program()
        markers = show.first_markers("/proximity")
        boxes = next(marker for marker in markers if marker.ns == "boxes")
        verdict = next(marker for marker in markers if marker.ns == "verdict")
        self.assertEqual(len(boxes.points), 2 * 24)
        view = yaml.safe_load(show.config_for(markers))["Visualization Manager"]["Views"]["Current"]
        self.assertEqual(view["Near Clip Distance"], 0.01)
        yaw, pitch = view["Yaw"], view["Pitch"]
        away = np.array([np.cos(yaw) * np.cos(pitch), np.sin(yaw) * np.cos(pitch), np.sin(pitch)])
        right = np.array([-np.sin(yaw), np.cos(yaw), 0.0])
        camera = np.array([view["Focal Point"][axis] for axis in "XYZ"]) + view["Distance"] * away
        points = boxes.points + [verdict.pose.position]
        seen = np.array([(point.x, point.y, point.z) for point in points]) - camera
        depth = -seen @ away
        half_height = np.tan(np.radians(22.5)) * depth
        self.assertTrue(np.all(depth > 0.0))
        self.assertTrue(np.all(np.abs(seen @ np.cross(away, right)) <= 1.001 * half_height))
        self.assertTrue(np.all(np.abs(seen @ right) <= 1.001 * 4.0 / 3.0 * half_height))
        self.assertLess(view["Distance"], 5.0 * np.linalg.norm(seen.max(axis=0) - seen.min(axis=0)))

    def test_without_a_body_show_opens_rviz_as_configured(self):
        show = show_program()
        with open(show.CONFIG, encoding="utf-8") as file:
            self.assertEqual(show.config_for([]), file.read())

    def test_zz_the_audit_has_found_no_difference(self):
        """Claim: the audit, which computes ticks again by brute force, knows the rooms.

        The name puts it behind the other tests."""
        for y in (BESIDE_THE_DOOR, IN_THE_DOOR):
            self.move_both(y)
            checked = self.counter("audit.checked") + 2
            self.wait("more audits", lambda: self.counter("audit.checked") >= checked)
        self.assertEqual(self.counter("audit.different"), 0)


if __name__ == "__main__":
    rosunit.unitrun("hgrid_proximity", "rooms", Rooms)
