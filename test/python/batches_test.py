#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""The services ~query_batch and ~distance_field of a running node. The answers must equal those of the services for single
queries, which have tests of their own."""
import math
import threading
import unittest

import numpy
import rospy
import rosunit
from geometry_msgs.msg import TransformStamped
from hgrid_proximity import obstacles
from hgrid_proximity.client import Proximity
from hgrid_proximity.errors import Refused
from hgrid_proximity.msg import CodeNames, Lease, Shape, ShapeKind, UnknownReason
from tf2_msgs.msg import TFMessage
from turning_arm import wait

FIELDS = ("shape", "distance", "signed_distance", "center_distance", "status", "state", "carried")


def close(one, other):
    return abs(one - other) <= 1e-12 or one == other or (math.isnan(one) and math.isnan(other))


class Batches(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("batches_test")
        turned = TransformStamped(child_frame_id="tool")
        turned.header.frame_id = "world"
        turned.transform.translation.x = 0.5
        turned.transform.rotation.z, turned.transform.rotation.w = math.sin(0.4), math.cos(0.4)
        cls.frames = rospy.Publisher("/tf_static", TFMessage, queue_size=1, latch=True)
        cls.frames.publish(TFMessage([turned]))
        cls.proximity = Proximity("/proximity", timeout=60.0)
        cls.rng = numpy.random.RandomState(1)
        kinds = (lambda: obstacles.sphere(cls.rng.uniform(0.05, 0.2)),
                 lambda: obstacles.box(cls.rng.uniform(0.05, 0.4, 3)))
        changes = [obstacles.add("part%d" % i, kinds[i % 2](), position=cls.rng.uniform(-1, 1, 3)) for i in range(60)]
        cls.proximity.apply_obstacles(*changes)
        wait(lambda: cls.sees_all(), "the frame 'tool'")

    @classmethod
    def sees_all(cls):
        try:
            return cls.proximity.query_sphere((0, 0, 0), 5.0, frame="tool").hit
        except Refused:
            return False

    def points(self, count):
        return self.rng.uniform(-1.2, 1.2, (count, 3))

    def expect(self, batch, index, answer):
        """Claim: question `index` of a batch has the answer of a single query."""
        self.assertEqual((batch.clear[index], batch.hit[index]), (answer.clear, answer.hit))
        self.assertEqual(batch.names(index), answer.names)
        self.assertEqual(batch.total[index], answer.response.answer.total)
        response, exact = batch.response, len(batch.response.normal) > 0
        for at, hit in zip(range(*batch.hits(index).indices(len(response.body))), answer.hits):
            for field in FIELDS:
                self.assertTrue(close(float(getattr(response, field)[at]), float(getattr(hit, field))), field)
            vectors = [(response.point[at], hit.point)]
            vectors += [(response.normal[at], hit.normal)] if exact else []
            vectors += [(response.own_point[at], hit.own_point)] if len(response.own_point) else []
            for row, vector in vectors:
                self.assertTrue(all(close(a, b) for a, b in zip(row, (vector.x, vector.y, vector.z))))
            self.assertTrue(not len(response.along) or close(response.along[at], hit.along))

    # Claim: every question has the answer that the service for single queries gives, with all combinations of options.
    def test_answers_are_those_of_single_queries(self):
        ask = self.proximity
        for options in ({}, {"exact": True}, {"limit": 3}, {"limit": 50, "exact": True, "exclude": "obstacle/part1*"},
                        {"include": ["obstacle/part2*", "obstacle/part3*"]}, {"frame": "tool", "exact": True},
                        {"as_body": "obstacle/part5", "limit": 9}):
            single = dict(options, limit=options.get("limit", 1))
            centers, radii = self.points(40), self.rng.uniform(0, 0.3, 40)
            starts, ends, thick = self.points(30), self.points(30), self.rng.uniform(0, 0.1, 30)
            middles, sizes, turns = self.points(20), self.rng.uniform(0, 0.4, (20, 3)), self.rng.normal(size=(20, 4))
            turns /= numpy.linalg.norm(turns, axis=1)[:, None]
            shapes = [Shape(kind=ShapeKind.SPHERE, dimensions=[0.2]), obstacles.box((0.3, 0.1, 0.2))]
            points, bodies = self.points(20), ["obstacle/part%d" % i for i in (3, 20, 21)]
            batch = ask.query_batch((centers, radii), (starts, ends, thick), (middles, sizes, turns), shapes, points, bodies,
                                    max_distance=0.4, **options)
            self.assertEqual(len(batch), 115)
            answers = [ask.query_sphere(c, r, **single) for c, r in zip(centers, radii)]
            answers += [ask.query_segment(a, b, r, **single) for a, b, r in zip(starts, ends, thick)]
            answers += [ask.query_box(c, s, q, **single) for c, s, q in zip(middles, sizes, turns)]
            answers += [ask.query_shape(shape, **single) for shape in shapes]
            answers += [ask.query_nearest(point, max_distance=0.4, **single) for point in points]
            answers += [ask.query_nearest(body=body, max_distance=0.4, **single) for body in bodies]
            for index, answer in enumerate(answers):
                self.expect(batch, index, answer)
            # Two obstacles that never move are never reported as a pair, so as_body leaves out all of them.
            if "as_body" in options:
                self.assertEqual(batch.hit.sum(), 0)
            else:
                self.assertGreater(batch.hit.sum(), 20)
            self.assertGreater(batch.clear.sum(), 5)
            self.assertEqual(batch.response.header.frame_id, options.get("frame", "world"))
            self.assertEqual(list(batch.response.names), sorted(set(batch.response.names)))

    def test_one_body_may_be_a_text(self):
        self.assertEqual(len(self.proximity.query_batch(bodies="obstacle/part3")), 1)

    def test_arrays_that_no_question_needs_are_empty(self):
        response = self.proximity.query_batch((self.points(100), 0.3)).response
        self.assertGreater(len(response.body), 10)
        self.assertEqual([len(array) for array in (response.along, response.own_point, response.normal,
                                                   response.cell_edge, response.texts)], [0] * 5)

    def test_an_invalid_question_is_refused_and_the_others_are_answered(self):
        batch = self.proximity.query_batch(
            ([[9, 9, 9], [math.nan, 0, 0], [9, 9, 9]], [0.1, 0.1, -1.0]),
            boxes=([[9, 9, 9]], [[1, 1, 1]], [[0, 0, 0.5, 0.5]]), bodies=["obstacle/part1", "obstacle/part1000"])
        self.assertEqual(batch.clear.tolist(), [True, False, False, False, False, False])
        self.assertEqual(batch.response.codes.tolist(),
                         [CodeNames.OK, CodeNames.NONFINITE, CodeNames.BAD_GEOMETRY, CodeNames.BAD_ROTATION, CodeNames.OK,
                          CodeNames.UNKNOWN_ID])
        self.assertEqual(batch.unknown.tolist(), [False, True, True, True, False, True])
        self.assertEqual(batch.response.unknown_because[1], UnknownReason.REFUSED)
        self.assertEqual(batch.text(0), "")
        for index, words in ((1, "sphere 1: "), (2, "sphere 2: "), (3, "box 0: "), (5, "body 1: ")):
            self.assertTrue(batch.text(index).startswith(words), batch.text(index))
        self.assertIn("part1000", batch.text(5))
        self.assertTrue(numpy.isnan(batch.nearest[[0, 1]]).all())

    def assert_refused(self, code, act, *words):
        with self.assertRaises(Refused) as caught:
            act()
        self.assertEqual(caught.exception.code, code)
        for word in words:
            self.assertIn(word, str(caught.exception))

    def test_an_invalid_request_is_refused_by_name(self):
        ask, spheres = self.proximity.query_batch, (self.points(2), 0.1)
        self.assertEqual(len(ask()), 0)
        self.assert_refused("LIMIT", lambda: ask((self.points(3001), 0.1)), "3001 questions", "3000", "~limits/max_batch")
        self.assert_refused("LIMIT", lambda: ask((self.points(3000), 0.1), limit=1000), "3000 questions", "1000000")
        self.assert_refused("UNKNOWN_ID", lambda: ask(spheres, include="obstacle/cup"), "obstacle/cup")
        self.assert_refused("UNKNOWN_ID", lambda: ask(spheres, as_body="obstacle/cup"), "obstacle/cup")
        self.assert_refused("UNKNOWN_FRAME", lambda: ask(spheres, frame="moon"), "moon")
        self.assert_refused("OUT_OF_RANGE", lambda: ask(spheres, max_time=-1.0), "max_time")
        for wrong in ({"spheres": (self.points(2), [0.1])}, {"spheres": (self.points(2),)}, {"points": [[0, 0]]},
                      {"boxes": (self.points(2), [[1, 1, 1]])}):
            with self.assertRaises(ValueError):
                ask(**wrong)
        request = self.proximity._services  # only a program without the client can send lists of different lengths
        kind = next(kind for kind in request if kind._type.endswith("QueryBatch"))
        response = request[kind](kind._request_class(sphere_radius=[1.0, 2.0]))
        self.assertEqual((response.success, response.code.name), (False, "OUT_OF_RANGE"))
        self.assertIn("sphere_center has 0 elements and sphere_radius has 2", response.code.text)

    def test_a_lease_keeps_the_world_and_a_stamp_asks_about_the_past(self):
        here = ([[5, 5, 5]], 0.1)
        add = obstacles.add("late", obstacles.sphere(0.1), position=(5, 5, 5))
        before = self.proximity.query_batch(here, keep=30.0)
        self.assertTrue(before.clear[0])
        self.assertGreater(before.response.lease.lasts.to_sec(), 20.0)
        past = before.response.header.stamp
        self.proximity.apply_obstacles(add)
        self.assertTrue(self.proximity.query_batch(here).hit[0])
        again = self.proximity.query_batch(here, lease=before.response.lease)
        self.assertTrue(again.clear[0])
        self.assertEqual(again.response.lease.sequence, before.response.lease.sequence)
        self.assertEqual(again.response.world.sequence, before.response.world.sequence)
        self.assertTrue(self.proximity.query_batch(here, stamp=past).clear[0])
        self.assert_refused("CONFLICT", lambda: self.proximity.query_batch(here, lease=before.response.lease, stamp=past),
                            "lease", "stamp")
        self.assert_refused("CONFLICT", lambda: self.proximity.query_batch(here, lease=Lease(epoch=77, sequence=1)), "77")
        self.assert_refused("EXTRAPOLATION", lambda: self.proximity.query_batch(
            here, lease=Lease(epoch=before.response.lease.epoch, sequence=10**15)), "keep")

    # Claim: when the time is over, questions without an answer are UNKNOWN, and there is a sentence for each.
    def test_a_time_limit_leaves_questions_unknown(self):
        everywhere = numpy.tile([[0, 0, 0]], (3000, 1))
        batch = self.proximity.query_batch((everywhere, 5.0), exact=True, limit=60, max_time=1e-4)
        late = batch.response.unknown_because == UnknownReason.BUDGET
        self.assertGreater(late.sum(), 1000)
        self.assertTrue(batch.unknown[late].all())
        self.assertIn("max_time", batch.text(2999))
        self.assertEqual(len(batch.response.texts), 3000)

    # Claim: each point has the distance that a single exact query returns. Each gradient is a unit vector, or 0 where the
    # distance is cut at max_distance.
    def test_a_distance_field_has_the_distances_of_single_queries(self):
        for options in ({}, {"frame": "tool", "exclude": "obstacle/part1*"}):
            field = self.proximity.distance_field((-1, -0.9, -0.8), (1.9, 1.5, 1.0), 0.25, 0.6, gradients=True, **options)
            self.assertEqual((field.distance.shape, field.gradient.shape), ((8, 7, 5), (8, 7, 5, 3)))
            self.assertEqual((field.unknown, field.text), (0, ""))
            self.assertEqual(field.response.header.frame_id, options.get("frame", "world"))
            inside = 0
            for index in numpy.ndindex(*field.distance.shape):
                answer = self.proximity.query_nearest(numpy.array((-1, -0.9, -0.8)) + 0.25 * numpy.array(index),
                                                      max_distance=0.6, exact=True, **options)
                truth, found = answer.hits[0].distance if answer.hit else 0.6, field.distance[index]
                self.assertAlmostEqual(max(0.0, found), truth, delta=1e-9)
                length = numpy.linalg.norm(field.gradient[index])
                self.assertAlmostEqual(length, 0.0 if found == 0.6 else 1.0, delta=1e-6)
                inside += found < 0.0
            self.assertGreater(inside, 5)

    def test_the_field_of_one_sphere_is_the_distance_from_the_sphere(self):
        ask = lambda **options: self.proximity.distance_field((20, 0, 0), (2, 0, 0), 0.5, 5.0, include="obstacle/lone",
                                                              **options)
        before = self.proximity.query_batch(keep=30.0).response.lease
        self.proximity.apply_obstacles(obstacles.add("lone", obstacles.sphere(0.6), position=(20, 0, 0)))
        field = ask(gradients=True)
        self.assertTrue(numpy.allclose(field.distance[:, 0, 0], [-0.6, -0.1, 0.4, 0.9, 1.4], atol=1e-9))
        self.assertTrue(numpy.allclose(field.gradient[1:, 0, 0], [[1, 0, 0]] * 4, atol=1e-9))
        self.assertIsNone(ask().gradient)
        self.assert_refused("UNKNOWN_ID", lambda: ask(lease=before), "obstacle/lone")

    def test_an_invalid_distance_field_is_refused_by_name(self):
        ask = self.proximity.distance_field
        for code, arguments, words in (("OUT_OF_RANGE", ((1, 1, 1), 0.0, 1.0), "resolution"),
                                       ("OUT_OF_RANGE", ((1, -1, 1), 0.1, 1.0), "size.y"),
                                       ("OUT_OF_RANGE", ((1, 1, 1), 0.1, 0.0), "max_distance"),
                                       ("LIMIT", ((1, 1, 1e9), 0.1, 1.0), "size.z"),
                                       ("LIMIT", ((10, 10, 10), 0.1, 1.0), "101 x 101 x 101"),
                                       ("LIMIT", ((9e4, 9e4, 9e4), 0.1, 1.0), "1000000")):
            self.assert_refused(code, lambda: ask((0, 0, 0), *arguments), words)
        self.assert_refused("BAD_ROTATION", lambda: ask((0, 0, 0), (1, 1, 1), 0.5, 1.0, orientation=(0, 0, 0.5, 0.5)))
        self.assert_refused("UNKNOWN_FRAME", lambda: ask((0, 0, 0), (1, 1, 1), 0.5, 1.0, frame="moon"), "moon")
        late = ask((-2, -2, -2), (4, 4, 4), 0.05, 1.0, max_time=1e-4)
        self.assertGreater(late.unknown, 1000)
        self.assertEqual(late.response.unknown_because, UnknownReason.BUDGET)
        self.assertEqual(numpy.isnan(late.distance).sum(), late.unknown)
        self.assertTrue(late.text)

    # Claim: queries are answered while four long requests are in progress. A query that waited for a long request would be
    # the last one before its end. The node has one query thread and one batch thread. On a busy machine the queries may
    # start after the long requests have ended; then the test tries again.
    def test_queries_do_not_wait_for_long_requests(self):
        clients = [Proximity("/proximity", timeout=60.0) for _ in range(4)]
        for client in clients:  # opens the connection
            self.assertEqual(client.distance_field((0, 0, 0), (0, 0, 0), 1.0, 1.0).distance.size, 1)
        for _ in range(5):
            done, answered = [], 0
            requests = [threading.Thread(target=self.ask_for_long, args=(client, done)) for client in clients]
            for request in requests:
                request.start()
            while not done:
                self.assertTrue(self.proximity.query_sphere((0, 0, 0), 5.0).hit)
                answered += not done
            for request in requests:
                request.join()
            self.assertEqual([field.distance.size for field in done], [98**3] * 4)
            if answered > 4:
                return
        self.fail("no query was answered while the long requests were in progress")

    def ask_for_long(self, client, done):
        done.append(client.distance_field((-2, -2, -2), (3.9, 3.9, 3.9), 0.04, 5.0, gradients=True, max_time=10.0))


if __name__ == "__main__":
    rosunit.unitrun("hgrid_proximity", "batches", Batches)
