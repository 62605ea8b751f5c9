#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Changes of obstacles with the client for Python, beside a running node: a robot with one moving sphere, and two obstacles
from the parameters."""
import io
import math
import random
import threading
import time
import unittest

import numpy as np
import rospy
import rosunit
from geometry_msgs.msg import Point, Quaternion
from hgrid_proximity import obstacles
from hgrid_proximity.client import Proximity
from hgrid_proximity.errors import Refused
from hgrid_proximity.msg import Bodies, Poses, Status
from hgrid_proximity.poses import PosesPublisher, _Poses
from hgrid_proximity.srv import ExplainPair
from moving_ball import Ball

MARGIN = 0.1  # [m] ~margin
CONFIGURED = {"obstacle/crate", "obstacle/lamp"}


class Obstacles(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("obstacles_test")
        cls.ball = Ball()
        cls.proximity = Proximity(timeout=60.0)
        deadline = time.monotonic() + 120.0
        while not cls.proximity.pairs().usable:
            if time.monotonic() > deadline:
                raise AssertionError("the node is not complete after 120 s")

    def test_zz_the_audit_has_found_no_difference(self):
        """Claim: the audit of the node, which computes ticks again by brute force, has found no difference.

        The name puts it behind the other tests."""
        counters = {}
        deadline = time.monotonic() + 60.0
        while counters.get("audit.checked", 0) < 10:
            if time.monotonic() > deadline:
                raise AssertionError("the audit has not checked 10 ticks: %s" % counters)
            status = rospy.wait_for_message("/proximity/status", Status, 60.0)
            counters = {counter.name: counter.value for counter in status.counters}
        if "audit.different" in counters:
            raise AssertionError("the audit has found differences: %s" % counters)

    def tearDown(self):
        self.apply(*[obstacles.remove(name[9:]) for name in self.names() - CONFIGURED])

    def apply(self, *changes, **options):
        return self.proximity.apply_obstacles(*changes, **options)

    def names(self):
        """Names of all obstacles, from the latched topic ~bodies."""
        bodies = rospy.wait_for_message("/proximity/bodies", Bodies, 60.0)
        return {body.name for body in bodies.bodies if body.name.startswith("obstacle/")}

    def at(self, x, y, z, **options):
        return self.proximity.query_sphere((x, y, z), 0.01, include="obstacle/*", **options).names

    def assert_refused(self, code, index, *changes, **options):
        with self.assertRaises(Refused) as refused:
            self.apply(*changes, **options)
        self.assertEqual((refused.exception.code, refused.exception.failed_index), (code, index))
        return refused.exception.text

    def test_a_change_is_in_force_when_the_call_returns(self):
        before = self.proximity.pairs().world.sequence
        response = self.apply(obstacles.add("part", obstacles.sphere(0.1), (1, 0, 0)))
        self.assertGreater(response.world.sequence, before)
        self.assertFalse(response.durable)
        self.assertEqual(self.at(1, 0, 0), ["obstacle/part"])
        self.apply(obstacles.move("part", (1, 0, 3)))
        self.assertEqual((self.at(1, 0, 0), self.at(1, 0, 3)), ([], ["obstacle/part"]))
        self.apply(obstacles.remove("part"))
        self.assertEqual(self.at(1, 0, 3), [])
        self.assertEqual(self.names(), CONFIGURED)

    def test_pairs_of_a_moved_obstacle_begin_and_end_once(self):
        with self.proximity.events() as events:
            self.apply(obstacles.add("part", obstacles.box((0.2, 0.2, 0.2)), (5.25, 0, 0)))
            began = events.wait("robot/ball", "obstacle/part", timeout=60.0)
            self.assertAlmostEqual(began.gap, 0.05, 5)
            for y in (0.01, 0.02, 0.03):
                self.apply(obstacles.move("part", (5.25, y, 0)))
            self.apply(obstacles.move("part", (8, 0, 0)))
            ended = events.wait("robot/ball", "obstacle/part", began=None, timeout=60.0)
            self.assertEqual((ended.began, ended.number), (False, began.number + 1))
        self.assertIn("are not reported: their boxes are 2.7", self.proximity.explain_pair("robot/ball", "obstacle/part").explanation)

    def test_a_request_is_refused_as_a_whole(self):
        good = [obstacles.add("good", obstacles.sphere(0.1), (1, 0, 0)), obstacles.remove("crate")]
        sphere = obstacles.sphere(0.1)
        wrong = {
            "UNKNOWN_ID": obstacles.remove("nothing"),
            "DUP_ID": obstacles.add("lamp", sphere),
            "BAD_ID": obstacles.add("a\nb", sphere),
            "BAD_GEOMETRY": obstacles.add("empty", []),
            "NONFINITE": obstacles.move("lamp", (math.nan, 0, 0)),
            "OUT_OF_RANGE": obstacles.add("far", sphere, (1e7, 0, 0)),
            "BAD_ROTATION": obstacles.add("turned", sphere, orientation=(1, 1, 1, 1)),
            "UNKNOWN_FRAME": obstacles.add("placed", sphere, frame="nowhere", stamp=rospy.Time(0)),
            "UNSUPPORTED": obstacles.add("plane", obstacles.plane(), moving=True),
        }
        for code, change in wrong.items():
            text = self.assert_refused(code, 2, *good, change)
            self.assertIn(change.name.replace("\n", "\\x0a"), text, code)
            self.assertEqual(self.names(), CONFIGURED)
        self.assertEqual(self.at(0, 0, 0), ["obstacle/crate"])

    def test_adding_the_same_again_changes_nothing(self):
        part = obstacles.add("part", obstacles.box((0.1, 0.1, 0.1)), (1, 0, 0))
        self.apply(part)
        self.apply(part, part)
        larger = obstacles.add("part", obstacles.box((0.3, 0.1, 0.1)), (1, 0, 0))
        self.assertIn("replace", self.assert_refused("DUP_ID", 0, larger))
        self.assertEqual(self.at(1.12, 0, 0), [])
        larger.replace = True
        self.apply(larger)
        self.assertEqual(self.at(1.12, 0, 0), ["obstacle/part"])

    def test_all_kinds_of_shape_have_their_form(self):
        corners = [(x, y, z) for x in (-0.1, 0.1) for y in (-0.1, 0.1) for z in (-0.1, 0.1)]
        pyramid = [(0.1, 0, -0.1), (-0.1, 0.1, -0.1), (-0.1, -0.1, -0.1), (0, 0, 0.1)]
        faces = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)]
        shapes = {  # shape, a point inside, a point outside of it but inside its box
            "sphere": (obstacles.sphere(0.1), (0, 0, 0), (0.09, 0.09, 0)),
            "box": (obstacles.box((0.2, 0.2, 0.2), orientation=(0, 0, math.sin(0.3927), math.cos(0.3927))), (0.12, 0, 0),
                    (0.12, 0.12, 0)),
            "cylinder": (obstacles.cylinder(0.2, 0.1), (0, 0, 0.09), (0.09, 0.09, 0)),
            "cone": (obstacles.cone(0.2, 0.1), (0, 0, 0.08), (0.08, 0, 0.08)),
            "capsule": (obstacles.capsule(0.2, 0.1), (0, 0, 0.19), (0.09, 0, 0.19)),
            "hull": (obstacles.hull(corners + [(0.2, 0, 0)]), (0.17, 0, 0), (0.17, 0.08, 0)),
            "mesh": (obstacles.mesh(pyramid, faces), (0, 0, 0), (0.08, 0.08, 0.05)),
            "shifted": ([obstacles.sphere(0.05, position=(0.1, 0, 0)), obstacles.sphere(0.05, position=(-0.1, 0, 0))],
                        (-0.1, 0, 0), (0.1, 0.045, 0.045)),
        }
        places = {name: (10.0 + number, 0, 0) for number, name in enumerate(shapes)}
        self.apply(*[obstacles.add(name, shape, places[name]) for name, (shape, _, _) in shapes.items()])
        for name, (_, inside, outside) in shapes.items():
            x = places[name][0]
            self.assertEqual(self.at(x + inside[0], *inside[1:], exact=True), ["obstacle/" + name])
            self.assertEqual(self.at(x + outside[0], *outside[1:], exact=True), [], name)
            self.assertEqual(self.at(x + outside[0], *outside[1:]), ["obstacle/" + name])

    def test_a_plane_is_a_half_space(self):
        """Claim: everything below a plane touches it, however far it is; what is above does not."""
        self.apply(obstacles.add("floor", obstacles.plane(position=(0, 0, -3), padding=0.5), (500, 0, 0)))
        self.assertEqual(self.at(-900, 70, -2.6), ["obstacle/floor"])
        self.assertEqual(self.at(-900, 70, -800, exact=True), ["obstacle/floor"])
        self.assertEqual(self.at(-900, 70, -2.3, exact=True), [])
        self.assert_refused("UNSUPPORTED", 0, obstacles.attach("floor", "robot/ball", (0, 0, 0)))

    def test_padding_and_margin_reach_the_node(self):
        self.apply(obstacles.add("part", obstacles.sphere(0.1, padding=0.2), (1, 0, 0)))
        self.assertEqual(self.at(1.28, 0, 0), ["obstacle/part"])
        self.apply(obstacles.add("wide", obstacles.sphere(0.1), (5.5, 0, 0), margin=0.4))
        self.assertIn(("obstacle/wide", "robot/ball"), self.near())

    def near(self):
        pairs = self.proximity.pairs()
        return set(zip(pairs.first_names, pairs.second_names))

    def test_obstacles_follow_their_frame_or_stay_where_it_was(self):
        self.apply(
            obstacles.add("load", obstacles.sphere(0.05), (0, 0, 1), frame="ball"),
            obstacles.add("left", obstacles.sphere(0.05), (0, 0, 2), frame="ball", stamp=rospy.Time(0)),
        )
        self.assertEqual((self.at(5, 0, 1), self.at(5, 0, 2)), (["obstacle/load"], ["obstacle/left"]))
        self.ball.x = 6.0
        try:
            self.wait_for(lambda: self.at(6, 0, 1) == ["obstacle/load"])
            self.assertEqual((self.at(5, 0, 1), self.at(5, 0, 2)), ([], ["obstacle/left"]))
        finally:
            self.ball.x = 5.0

    def test_an_attached_obstacle_follows_its_link_and_may_touch_it(self):
        self.apply(obstacles.add("part", obstacles.sphere(0.05), (5.1, 0, 0)), obstacles.add("lid", obstacles.sphere(0.05)))
        self.assertIn(("obstacle/part", "robot/ball"), self.near())
        self.apply(obstacles.attach("part", "robot/ball", touch=["obstacle/lid"]))
        self.assertNotIn(("obstacle/part", "robot/ball"), self.near())
        explained = self.proximity.explain_pair("robot/ball", "obstacle/part").explanation
        self.assertIn("obstacle/part may touch 'robot/ball' because obstacle/part is attached to robot/ball", explained)
        self.assertTrue(self.proximity.query_sphere((5.1, 0, 0), 0.01, include="obstacle/*").hits[0].carried)
        self.ball.x = 6.0
        try:
            self.wait_for(lambda: self.at(6.1, 0, 0) == ["obstacle/part"])
            self.assertEqual(self.at(5.1, 0, 0), [])
            self.apply(obstacles.detach("part"))
            self.assertIn(("obstacle/part", "robot/ball"), self.near())
        finally:
            self.ball.x = 5.0
        self.wait_for(lambda: ("obstacle/part", "robot/ball") not in self.near())
        self.assertEqual(self.at(6.1, 0, 0), ["obstacle/part"])
        self.assertFalse(self.proximity.query_sphere((6.1, 0, 0), 0.01, include="obstacle/*").hits[0].carried)
        self.assert_refused("UNKNOWN_ID", 0, obstacles.attach("part", "robot/ball", touch=["robot/bal"]))
        self.assert_refused("CONFLICT", 0, obstacles.detach("part"))

    def wait_for(self, condition):
        deadline = time.monotonic() + 60.0
        while not condition():
            self.assertLess(time.monotonic(), deadline)

    def test_a_lifetime_ends_unless_it_begins_again(self):
        brief, long = (obstacles.add(name, obstacles.sphere(0.1), (x, 0, 0), lifetime=life)
                       for name, x, life in (("brief", 1, 0.5), ("long", 2, 1000.0)))
        self.apply(brief, long)
        self.wait_for(lambda: not self.at(1, 0, 0))
        self.assertEqual(self.at(2, 0, 0), ["obstacle/long"])

    def test_poses_move_many_obstacles(self):
        """Claim: obstacles of the frame ~poses are where the messages of ~poses say. Without a pose, they are UNPLACED; if
        the messages stop, they become LOST, and a move ends that."""
        names = ["n%d" % i for i in range(200)]
        self.apply(*(obstacles.add(name, obstacles.sphere(0.01), (0, 0, 0.5), frame=obstacles.POSES) for name in names))
        self.assertFalse(self.proximity.query_sphere((50, 0, 0), 0.01).clear)
        self.assertIn("UNPLACED", self.proximity.query_sphere((50, 0, 0), 0.01).summary)
        publisher = PosesPublisher(names, "world")
        publisher.wait_for_node(60.0)
        positions = np.random.default_rng(1).uniform(20.0, 30.0, (200, 3))
        turned = np.tile((1.0, 0.0, 0.0, 0.0), (200, 1))  # half a turn about x: the offset in z is negative then
        for orientations, offset in ((None, 0.5), (turned, -0.5)):
            positions += 1.0

            def is_there():
                publisher.publish(positions, orientations)
                pairs = self.proximity.query_box((30, 30, 30), (40, 40, 40), include="obstacle/n*")
                return pairs.response.answer.total == 200 and self.is_at(positions + (0, 0, offset))

            self.wait_for(is_there)
        self.assertTrue(self.proximity.query_sphere((50, 0, 0), 0.01).clear)
        self.wait_for(lambda: "LOST" in self.proximity.query_sphere((50, 0, 0), 0.01).summary)
        self.apply(*(obstacles.move(name, (20, 20, 20)) for name in names))
        self.assertTrue(self.proximity.query_sphere((50, 0, 0), 0.01).clear)
        publisher.close()

    def is_at(self, positions):
        """Returns whether sample obstacles are at these positions."""
        return all(self.at(*positions[i]) == ["obstacle/n%d" % i] for i in (0, 77, 199))

    def test_bytes_of_poses_are_those_of_the_message(self):
        """Claim: PosesPublisher writes the bytes that genpy writes for the same message."""
        array = _Poses(names_version=3, names=["a", "b"])
        array.header.frame_id, array.header.stamp = "world", rospy.Time(1, 2)
        plain = Poses(names_version=3, names=["a", "b"], header=array.header)
        array.position, array.orientation = np.arange(6.0).reshape(2, 3), np.arange(8.0).reshape(2, 4)
        plain.position = [Point(*row) for row in array.position]
        plain.orientation = [Quaternion(*row) for row in array.orientation]
        written = [io.BytesIO(), io.BytesIO()]
        array.serialize(written[0])
        plain.serialize(written[1])
        self.assertEqual(written[0].getvalue(), written[1].getvalue())

    def test_obstacles_of_one_group_move_as_one(self):
        near = dict(moving=True, group="rack")
        self.apply(obstacles.add("left", obstacles.sphere(0.1), (30, 0, 0), **near),
                   obstacles.add("right", obstacles.sphere(0.1), (30.25, 0, 0), **near))
        self.apply(obstacles.move("left", (40, 0, 0)))
        self.assertEqual(self.proximity.query_sphere((40.25, 0, 0), 0.05).names, ["obstacle/right"])
        explained = rospy.ServiceProxy("/proximity/explain_pair", ExplainPair)(first="obstacle/left", second="obstacle/right")
        self.assertIn("both belong to the group 'rack'", explained.explanation)
        with self.assertRaises(Refused):
            self.apply(obstacles.add("far", obstacles.sphere(0.1), frame="ball", group="rack"))

    def test_a_complete_set_removes_the_others_of_its_owner(self):
        mine, other = (obstacles.add(name, obstacles.sphere(0.1), owner=owner) for name, owner in
                       (("mine", ""), ("other", "planner")))
        self.apply(mine, other)
        self.apply(complete_set=True, owner="planner")
        self.assertEqual(self.names(), CONFIGURED | {"obstacle/mine"})
        self.apply(obstacles.add("new", obstacles.sphere(0.1)), complete_set=True)
        self.assertEqual(self.names(), CONFIGURED | {"obstacle/new"})

    def test_four_clients_at_once_leave_what_a_simple_model_says(self):
        """Claim: random changes by four clients at once end in the world that each of them expects, and ~pairs lists
        exactly the pairs of this world, with their gaps."""
        worlds, failures = [{} for _ in range(4)], []

        def change(client, world):
            try:
                draw = random.Random(client)
                with Proximity(timeout=60.0) as proximity:
                    for _ in range(40):
                        changes = []
                        for _ in range(draw.randrange(1, 5)):
                            name = "c%d_%d" % (client, draw.randrange(8))
                            place = tuple(20 + draw.randrange(0, 13) / 8 for _ in range(3))
                            if name not in world:
                                world[name] = (place, 0.125 * draw.randrange(1, 4))
                                size = (world[name][1],) * 3
                                changes.append(obstacles.add(name, obstacles.box(size), place, moving=True))
                            elif draw.randrange(3):
                                world[name] = (place, world[name][1])
                                changes.append(obstacles.move(name, place))
                            else:
                                del world[name]
                                changes.append(obstacles.remove(name))
                        proximity.apply_obstacles(*changes)
            except Exception as error:  # the test must fail, whatever it is
                failures.append(error)

        threads = [threading.Thread(target=change, args=each) for each in enumerate(worlds)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(failures, [])
        world = {"obstacle/" + name: what for part in worlds for name, what in part.items()}
        self.assertEqual(self.names(), CONFIGURED | set(world))
        expected = {}
        for first in world:
            for second in world:
                gap = math.hypot(*[max(0.0, abs(a - b) - (world[first][1] + world[second][1]) / 2)
                                   for a, b in zip(world[first][0], world[second][0])])
                if first < second and gap <= MARGIN:
                    expected[(first, second)] = gap
        pairs = self.proximity.pairs()
        found = dict(zip(zip(pairs.first_names, pairs.second_names), pairs.gap))
        self.assertEqual(set(found), set(expected))
        self.assertGreater(len(expected), 3)
        for pair, gap in expected.items():
            self.assertAlmostEqual(found[pair], gap, 4)  # boxes are floats, 20 m from the origin


if __name__ == "__main__":
    rosunit.unitrun("hgrid_proximity", "obstacles", Obstacles)
