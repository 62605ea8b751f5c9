#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Twenty equal robots join a running node in one request. One of them is declared absent."""
import threading
import time
import unittest

import rospy
import rosunit
from geometry_msgs.msg import TransformStamped
from hgrid_proximity import robots
from hgrid_proximity.client import Proximity
from hgrid_proximity.errors import Refused
from hgrid_proximity.msg import BodyState, Status
from tf2_msgs.msg import TFMessage

PATIENCE = 60.0  # [s] for a machine that is busy with other tests
NAMES = [f"amr{number}" for number in range(20)]


class Carts:
    """Publishes the poses of the robots: 0.25 m apart along x, so that each one is near the next one."""

    def __init__(self):
        self.silent = set()
        self._publisher = rospy.Publisher("/tf", TFMessage, queue_size=10)
        threading.Thread(target=self._run, daemon=True).start()

    def _run(self):
        while not rospy.is_shutdown():
            message = TFMessage()
            for number, name in enumerate(["first", *NAMES]):
                if name in self.silent:
                    continue
                pose = TransformStamped(child_frame_id=f"{name}/base")
                pose.header.frame_id, pose.header.stamp = "world", rospy.Time.now()
                pose.transform.translation.x, pose.transform.rotation.w = 0.25 * number, 1.0
                message.transforms.append(pose)
            try:
                self._publisher.publish(message)
            except rospy.ROSException:
                break  # the test ends
            time.sleep(0.02)


class Fleet(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("fleet_test")
        cls.carts = Carts()
        cls.proximity = Proximity(timeout=PATIENCE)
        cls.status = []
        rospy.Subscriber("/proximity/status", Status, cls.status.append)
        cls.wait_for_status(lambda status: status.world.complete)

    @classmethod
    def wait_for_status(cls, wanted):
        deadline = time.monotonic() + PATIENCE
        while not (cls.status and wanted(cls.status[-1])):
            if time.monotonic() > deadline:
                raise AssertionError(str(cls.status[-1:]))
            time.sleep(0.02)
        return cls.status[-1]

    def setUp(self):
        rospy.set_param("/cart", rospy.get_param("/cart"))
        self.carts.silent.clear()
        here = set(self.wait_for_status(lambda status: True).absent_robots)
        here.update(source.name for source in self.status[-1].sources)
        gone = [name for name in NAMES if name in here]
        if gone:
            self.proximity.apply_robots(robots.remove(gone))
        self.wait_for_status(lambda status: status.robots == 1 and status.world.complete)

    def test_a_robot_that_is_declared_absent_is_not_lost(self):
        response = self.proximity.apply_robots(robots.add(NAMES, like="first"))
        self.assertEqual((response.uncovered, response.warnings, response.durable), ([], [], False))
        status = self.wait_for_status(lambda status: status.robots == 21 and status.world.complete)
        self.assertEqual(status.world.bodies_revision, response.world.bodies_revision, "one change for all of them")
        self.assertEqual(status.pair_count, 20)

        self.carts.silent.add("amr7")
        with self.proximity.events() as events:
            response = self.proximity.apply_robots(robots.absent("amr7"))
            self.assertTrue(response.world.complete)
            ends = [events.wait("amr7/*", began=False, timeout=PATIENCE) for _ in range(2)]
        self.assertEqual({(end.first, end.second) for end in ends},
                         {("amr6/base", "amr7/base"), ("amr7/base", "amr8/base")})
        status = self.wait_for_status(lambda status: status.absent_robots == ["amr7"])
        self.assertEqual(status.pair_count, 18)
        self.assertNotIn("amr7", [source.name for source in status.sources])
        self.assertTrue(self.proximity.query_sphere((2.0, 0, 0), 0.05).clear, "it is not there")

        self.carts.silent.add("amr3")
        status = self.wait_for_status(lambda status: status.world.worst_state == BodyState.LOST)
        self.assertEqual(status.world.incomplete, ["amr3"], "nobody said that it was switched off")
        self.carts.silent.clear()
        response = self.proximity.apply_robots(robots.absent("amr3"), robots.present("amr7"))
        self.wait_for_status(lambda status: status.absent_robots == ["amr3"] and status.world.complete)
        self.assertEqual(self.proximity.query_sphere((2.0, 0, 0), 0.05).names, ["amr7/base"])
        counters = {counter.name: counter.value for counter in self.status[-1].counters}
        self.assertEqual(counters.get("audit.different", 0), 0)

    def test_robots_come_from_texts_and_parameters_and_a_template_is_not_read_again(self):
        text = rospy.get_param("/cart")
        broken = text.replace("</robot>", "")
        rospy.set_param("/cart", broken)
        self.proximity.apply_robots(robots.add("amr0", like="first"))  # `first` was read before
        with self.assertRaises(Refused) as refused:
            self.proximity.apply_robots(robots.add("amr1", urdf=text), robots.add("amr2", description="cart"))
        self.assertEqual((refused.exception.code, refused.exception.failed_index), ("PARSE", 1))
        rospy.set_param("/cart", text)
        self.proximity.apply_robots(
            robots.add("amr1", urdf=text), robots.add("amr2", description="cart"), robots.add("amr3", like="amr1")
        )
        self.wait_for_status(lambda status: status.robots == 5 and status.world.complete)
        response = self.proximity.apply_robots(robots.add("amr4", urdf=text, tf_prefix="amr3"))
        self.assertIn("robots 'amr3' and 'amr4' have the same root frame 'amr3/base'", response.warnings[0])

    def test_bad_requests_are_refused_by_name(self):
        text = rospy.get_param("/cart")
        for code, words, changes in (
            ("BAD_ID", "names is empty", [robots.remove([])]),
            ("BAD_ID", "control characters", [robots.absent("a\n")]),
            ("BAD_ID", "reserved", [robots.add("map", like="first")]),
            ("DUP_ID", "twice", [robots.add(["amr1", "amr1"], like="first")]),
            ("DUP_ID", "another description or tf_prefix", [robots.add("first", urdf=text)]),
            ("UNKNOWN_ID", "there is no robot 'amr9'", [robots.absent("amr9")]),
            ("UNKNOWN_ID", "cannot be added like 'nobody'", [robots.add("amr1", like="nobody")]),
            ("BAD_ID", "give one of them", [robots.add("amr1")]),
            ("CONFLICT", "give only one", [robots.add("amr1", like="first", urdf=text)]),
            ("CONFLICT", "semantic belongs to description", [robots.add("amr1", like="first", semantic="s")]),
            ("CONFLICT", "srdf belongs to urdf", [robots.add("amr1", description="cart", srdf="<robot/>")]),
            ("CONFLICT", "whose frames must differ", [robots.add(["amr1", "amr2"], like="first", tf_prefix="x")]),
            ("BAD_ID", "cannot be the name of a parameter", [robots.add("amr1", description="a b")]),
            ("NOT_READY", "parameter 'none' is not set", [robots.add("amr1", description="none")]),
            ("PARSE", "", [robots.add("amr1", urdf="<robot>")]),
            ("LIMIT", "~limits/max_robots is 30", [robots.add([f"a{number}" for number in range(31)], like="first")]),
            ("LIMIT", "4 * ~limits/max_robots", [robots.absent([str(number) for number in range(121)])]),
        ):
            with self.subTest(words):
                first = [] if words.startswith("4 *") else [robots.add("amr0", like="first")]
                with self.assertRaises(Refused) as refused:
                    self.proximity.apply_robots(*first, *changes)
                self.assertEqual((refused.exception.code, refused.exception.failed_index), (code, len(first)))
                self.assertIn(words, refused.exception.text)
                self.assertEqual(self.wait_for_status(lambda status: True).robots, 1)
        change = robots.remove("first")
        change.operation = 9
        with self.assertRaisesRegex(Refused, "operation is 9; it must be 0"):
            self.proximity.apply_robots(change)


if __name__ == "__main__":
    rosunit.unitrun("hgrid_proximity", "fleet", Fleet)
