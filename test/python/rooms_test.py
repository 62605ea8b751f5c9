#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""A node with the rooms and doors of config/rooms.yaml, and two obstacles that are near each other: a cart in the hall
and a person in the cell."""
import threading
import unittest

import rospy
import rosunit
from hgrid_proximity import obstacles
from hgrid_proximity.client import Proximity
from hgrid_proximity.msg import Pairs, Status
from visualization_msgs.msg import MarkerArray

BESIDE_THE_DOOR, IN_THE_DOOR = 0.5, 2.0  # [m] y of both obstacles
CART, PERSON = "obstacle/cart", "obstacle/person"


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
