#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""The client for Python beside a running node: a robot with one moving sphere, and two obstacles."""
import os
import pathlib
import signal
import threading
import time
import unittest
from xmlrpc.client import ServerProxy

import rosgraph
import rospy
import rosunit
from geometry_msgs.msg import Point, TransformStamped
from hgrid_proximity import rules
from hgrid_proximity.client import Proximity
from hgrid_proximity.errors import EventsMissed, NoAnswer, Refused
from hgrid_proximity.msg import Pairs, Shape, ShapeKind
from tf2_msgs.msg import TFMessage

FAR, NEAR = 5.0, 0.25  # [m] x of the moving sphere: far from "crate", or 0.05 m from it
NODE = "/proximity"


class Mover:
    """Publishes the pose of the robot's sphere in the world."""

    def __init__(self):
        self.x, self.paused = FAR, False
        self._publisher = rospy.Publisher("/tf", TFMessage, queue_size=1)
        threading.Thread(target=self._run, daemon=True).start()

    def _run(self):
        while not rospy.is_shutdown():
            pose = TransformStamped(child_frame_id="ball")
            pose.header.frame_id, pose.header.stamp = "world", rospy.Time.now()
            pose.transform.translation.x, pose.transform.rotation.w = self.x, 1.0
            try:
                if not self.paused:
                    self._publisher.publish(TFMessage([pose]))
            except rospy.ROSException:
                break  # the test ends
            time.sleep(0.02)


class Client(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("client_test")
        cls.mover = Mover()
        cls.proximity = Proximity(timeout=20.0)
        deadline = time.monotonic() + 60.0
        while not cls.proximity.pairs().usable:
            if time.monotonic() > deadline:
                raise AssertionError("the node is not complete after 60 s")

    def setUp(self):
        self.move(FAR)

    def move(self, x):
        """Moves the sphere. Waits until the node places it there."""
        self.mover.x = x
        deadline = time.monotonic() + 20.0
        while not self.proximity.query_sphere((x, 0, 0), include="robot/*").hit:
            if time.monotonic() > deadline:
                self.fail("the sphere does not arrive at %g m" % x)

    def test_queries_answer_hit_or_clear(self):
        ask = self.proximity
        self.assertEqual(ask.query_sphere((0, 0, 0), 0.05).names, ["obstacle/crate"])
        self.assertTrue(ask.query_sphere(Point(0, 0, 3), 0.05).clear)
        self.assertEqual(ask.query_segment((0, 0, -5), (0, 0, 5)).names, ["obstacle/crate", "obstacle/lamp"])
        self.assertCountEqual(ask.query_box((0, 0, 1), (0.1, 0.1, 3.0)).names, ["obstacle/crate", "obstacle/lamp"])
        shape = Shape(kind=ShapeKind.SPHERE, dimensions=[0.1])
        shape.pose.position.z, shape.pose.orientation.w = 2.0, 1.0
        self.assertEqual(ask.query_shape(shape).names, ["obstacle/lamp"])
        self.assertEqual(ask.query_nearest((0, 0, 1.5)).names, ["obstacle/lamp"])
        self.assertEqual(ask.query_nearest(body="robot/ball", limit=2).names, ["obstacle/crate", "obstacle/lamp"])

    def test_options_reach_the_node(self):
        ask = self.proximity
        corner = (0.09, 0.09, 0.0)  # inside the box of the lamp, which is a sphere, but not inside the lamp
        self.assertTrue(ask.query_sphere(corner, frame="world", include="obstacle/lamp").clear)
        above = (corner[0], corner[1], 2.0)
        self.assertTrue(ask.query_sphere(above).hit)
        self.assertTrue(ask.query_sphere(above, exact=True).clear)
        self.assertTrue(ask.query_sphere((0, 0, 0), exclude=["robot/*", "obstacle/crate"]).clear)
        self.assertEqual(len(ask.query_segment((0, 0, -5), (0, 0, 5), limit=1).names), 1)
        self.assertEqual(ask.query_sphere((0, 0, 0), frame="ball", max_time=1.0).names, ["robot/ball"])
        self.assertEqual(ask.query_sphere((0, 0, 0), 9.0, include="robot/*", as_body="robot/ball").names, [])

    def test_a_body_that_may_have_moved_makes_answers_unknown(self):
        self.mover.paused = True
        try:
            deadline = time.monotonic() + 60.0
            while not self.proximity.query_sphere((4, 0, 0), 0.1).unknown:
                self.assertLess(time.monotonic(), deadline)
                time.sleep(0.2)
            answer = self.proximity.query_sphere((4, 0, 0), 0.1)
            self.assertEqual((answer.clear, answer.hit, answer.hits), (False, False, []))
        finally:
            self.mover.paused = False

    def test_an_answer_is_neither_true_nor_false(self):
        with self.assertRaisesRegex(TypeError, "read .clear, .hit or .unknown"):
            bool(self.proximity.query_sphere((0, 0, 0)))

    def test_a_refusal_names_the_reason(self):
        with self.assertRaises(Refused) as refused:
            self.proximity.query_sphere((0, 0, 0), frame="nowhere")
        self.assertEqual(refused.exception.code, "UNKNOWN_FRAME")
        self.assertIn("nowhere", refused.exception.text)
        for max_time in (float("nan"), -1.0):
            with self.assertRaises(Refused):
                self.proximity.query_sphere((0, 0, 0), max_time=max_time)
        with self.assertRaises(Refused) as refused:
            self.proximity.explain_pair("robot/ball", "obstacle/none")
        self.assertEqual(refused.exception.code, "UNKNOWN_ID")

    def test_wrong_arguments_are_named(self):
        for center in ((0, 0), None, "here", (0, 0, 0, 0), (0, 0, "x")):
            with self.assertRaisesRegex(ValueError, "center is .*; it must be 3 numbers: x, y, z"):
                self.proximity.query_sphere(center)
        with self.assertRaisesRegex(ValueError, "either a point or a body"):
            self.proximity.query_nearest()
        for options in ({"radius": "wide"}, {"limit": -1}, {"limit": 2.5}, {"exact": "yes"}, {"stamp": 1.5}):
            with self.assertRaises(TypeError, msg=options):
                self.proximity.query_sphere((0, 0, 0), **options)
        for timeout in (0.0, -1.0, float("nan"), float("inf")):
            with self.assertRaisesRegex(ValueError, "timeout is .*; it must be greater than 0"):
                Proximity(timeout=timeout)

    def test_explanations_are_sentences(self):
        self.assertIn("robot/ball", self.proximity.explain_pair("robot/ball", "obstacle/crate").explanation)

    def test_rules_are_set_read_and_removed(self):
        ask = self.proximity
        held = rules.allow("robot/*", "obstacle/crate", reason="for the test", lifetime=300.0)
        self.assertEqual(ask.set_allowed(held, rules.report("robot/ball", "obstacle/lamp")).pairs_changed, 1)
        try:
            pairs = ask.get_allowed("obstacle/*", "robot/ball", as_srdf=True)
            decided = [(pair.first, pair.second, pair.allowed, pair.reason) for pair in pairs.entries]
            self.assertEqual(
                decided,
                [("obstacle/crate", "robot/ball", True, "for the test"), ("obstacle/lamp", "robot/ball", False, "")],
            )
            self.assertTrue(200.0 < pairs.entries[0].lifetime.to_sec() <= 300.0)
            given = ask.get_allowed(rules=True, limit=1)
            self.assertEqual((given.entries[0].first, given.total, given.truncated), ("robot/*", 2, True))
        finally:
            ask.set_allowed(held, rules.report("robot/ball", "obstacle/lamp"), remove=True)
        self.assertEqual(ask.get_allowed(rules=True).total, 0)

    def test_rules_that_are_refused_change_nothing(self):
        ask = self.proximity
        with self.assertRaises(Refused) as refused:
            ask.set_allowed(rules.allow("robot/ball", "obstacle/crate"), rules.allow("robot/ball", "obstacle/none"))
        self.assertEqual(refused.exception.code, "UNKNOWN_ID")
        with self.assertRaises(Refused) as refused:
            ask.set_allowed(rules.allow("*", "*"))
        self.assertEqual(refused.exception.code, "NEEDS_FORCE")
        with self.assertRaises(Refused) as refused:
            ask.get_allowed(513 * "*")
        self.assertEqual(refused.exception.code, "BAD_ID")
        self.assertEqual(ask.get_allowed(rules=True).total, 0)
        ask.set_allowed(rules.allow("*", "*"), force=True)
        ask.set_allowed(rules.allow("*", "*"), remove=True)

    def test_pairs_and_distances_are_arrays(self):
        self.move(NEAR)
        pairs = self.proximity.pairs()
        self.assertEqual(list(pairs.select("robot/*", "obstacle/*")), [0])
        self.assertEqual((pairs.first_names[0], pairs.second_names[0]), ("obstacle/crate", "robot/ball"))
        self.assertAlmostEqual(pairs.gap[0], 0.05, 5)
        distances = self.proximity.distances()
        self.assertAlmostEqual(distances.distance[0], 0.05, 5)
        self.assertAlmostEqual(distances.point_on_second[0, 0], 0.15, 5)

    def test_events_come_in_their_order(self):
        with self.proximity.events() as events:
            self.move(NEAR)
            self.move(FAR)
            began = events.wait("robot/*", "obstacle/*", timeout=20.0)
            ended = events.wait("robot/*", "obstacle/crate", began=False, timeout=20.0)
            self.assertEqual((began.began, began.first, began.second), (True, "obstacle/crate", "robot/ball"))
            self.assertEqual((ended.began, ended.number > began.number), (False, True))
            self.assertIsNone(events.wait("robot/*", "obstacle/lamp", timeout=0.1))
            self.move(NEAR)
            self.move(FAR)
            self.assertIsNone(events.wait("map/*", "obstacle/*", began=None, timeout=1.0), "no map is near")
            self.move(NEAR)
            self.assertTrue(events.wait(began=None, timeout=20.0).began)

    def test_lost_events_are_reported(self):
        with self.proximity.events() as events:
            self.move(NEAR)
            self.assertIsNotNone(events.wait(timeout=20.0))
            self.move(FAR)
            lost = events._messages.get(timeout=20.0)  # the end of the pair
            self.move(NEAR)
            with self.assertRaisesRegex(EventsMissed, "the events %d to %d were lost" % (lost.number[0], lost.number[-1])):
                events.wait(timeout=20.0)
            self.assertIsNotNone(events.wait(timeout=20.0))

    def test_a_node_that_does_not_run_gives_no_answer(self):
        absent = Proximity("/absent", timeout=0.5)
        for ask in (lambda: absent.query_sphere((0, 0, 0)), absent.pairs, absent.events):
            with self.assertRaisesRegex(NoAnswer, "/absent/.*rosnode ping /absent"):
                ask()

    def test_a_node_that_hangs_gives_no_answer_in_time(self):
        ask = Proximity(timeout=2.0)

        def hits():
            try:
                return ask.query_sphere((0, 0, 0)).hit
            except NoAnswer:
                return False

        self.assertTrue(any(hits() for _ in range(10)))
        process = ServerProxy(rosgraph.Master("/client_test").lookupNode(NODE)).getPid("/client_test")[2]
        os.kill(process, signal.SIGSTOP)
        try:
            while not all(stat.read_text().rpartition(")")[2].split()[0] == "T"
                          for stat in pathlib.Path("/proc/%d/task" % process).glob("*/stat")):
                time.sleep(0.01)
            begin = time.monotonic()
            for _ in range(2):  # with the open connection, then with a new one
                with self.assertRaisesRegex(NoAnswer, "did not answer in time|cannot be reached"):
                    ask.query_sphere((0, 0, 0))
            self.assertLess(time.monotonic() - begin, 20.0)
        finally:
            os.kill(process, signal.SIGCONT)
        self.assertTrue(any(hits() for _ in range(10)), "the same client works again")

    def test_a_call_that_is_interrupted_leaves_no_answer_for_the_next(self):
        class Interrupted(BaseException):
            pass

        def interrupt(*_):
            raise Interrupted

        before = signal.signal(signal.SIGALRM, interrupt)
        try:
            wrong = []
            for delay in [0.0002 * step for step in range(1, 40)]:
                try:
                    signal.setitimer(signal.ITIMER_REAL, delay)
                    self.proximity.query_sphere((0, 0, 0))
                    signal.setitimer(signal.ITIMER_REAL, 0.0)
                except Interrupted:
                    pass
                names = self.proximity.query_sphere((0, 0, 2)).names
                if names != ["obstacle/lamp"]:
                    wrong.append(names)
            self.assertEqual(wrong, [])
        finally:
            signal.signal(signal.SIGALRM, before)

    def test_a_message_read_with_the_plain_class_becomes_arrays(self):
        plain = rospy.Subscriber(NODE + "/pairs", Pairs, lambda _: None)
        try:
            self.assertEqual(len(self.proximity.pairs().select()), 0)
        finally:
            plain.unregister()

    def test_several_threads_may_share_a_client(self):
        wrong = []

        def ask(z, names):
            for _ in range(20):
                if self.proximity.query_sphere((0, 0, z)).names != names:
                    wrong.append(z)

        places = ((0.0, ["obstacle/crate"]), (2.0, ["obstacle/lamp"]), (3.0, []))
        threads = [threading.Thread(target=ask, args=place) for place in places]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(wrong, [])


if __name__ == "__main__":
    rosunit.unitrun("hgrid_proximity", "client", Client)
