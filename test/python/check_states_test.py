#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""The services ~check_states and ~check_edges beside a running node. See turning_arm.py for the robot."""
import math
import unittest

import numpy
import rospy
import rosunit
from geometry_msgs.msg import Pose
from hgrid_proximity import obstacles, robots, srv
from hgrid_proximity.client import Proximity
from hgrid_proximity.errors import Refused
from hgrid_proximity.msg import CodeNames, Lease, UnknownReason
from turning_arm import TO_POST, TO_WALL, Arm, wait

JOINTS = ["shoulder", "slide"]


class CheckStates(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("check_states_test")
        cls.arm = Arm()
        cls.proximity = Proximity("/proximity", timeout=60.0)
        wait(lambda: cls.proximity.pairs().usable, "a complete world", 120.0)

    def states(self, rows, **options):
        return self.proximity.check_states(JOINTS, rows, **options)

    def edges(self, start, end, **options):
        return self.proximity.check_edges(JOINTS, start, end, **options)

    def assert_refused(self, code, act, *words):
        with self.assertRaises(Refused) as caught:
            act()
        self.assertEqual(caught.exception.code, code)
        for word in words:
            self.assertIn(word, str(caught.exception))

    def test_each_state_has_a_verdict_and_its_pair(self):
        found = self.states([[0, 0.5], [TO_POST, 0.5], [TO_WALL, 0.45]])
        self.assertEqual(found.clear.tolist(), [True, False, False])
        self.assertEqual(found.hit.tolist(), [False, True, True])
        self.assertEqual([found.pair(i) for i in range(3)],
                         [None, ("robot/arm", "obstacle/post"), ("robot/hand", "obstacle/wall")])
        self.assertEqual(found.response.names, ["obstacle/post", "obstacle/wall", "robot/arm", "robot/hand"])
        self.assertEqual((found.response.texts, len(found.clearance)), ([], 0))

    # Claim: the contact of two spheres is described as their centers and radii tell.
    def test_contacts_are_described_if_asked_for(self):
        rows = [[0, 0.5], [TO_POST - 0.1, 0.5]]
        self.assertEqual([len(array) for array in self._contacts(self.states(rows))], [0, 0, 0])
        points, normals, depths = self._contacts(self.states(rows, contacts=True))
        self.assertTrue(numpy.isnan(points[0]).all() and numpy.isnan(normals[0]).all() and numpy.isnan(depths[0]))
        self._expect_arm_at_post(TO_POST - 0.1, points[1], normals[1], depths[1])
        edges = self.edges([[0, 0.5]], [[TO_POST, 0.5]])
        points, normals, depths = self._contacts(edges)
        self._expect_arm_at_post(edges.at[0] * TO_POST, points[0], normals[0], depths[0])

    @staticmethod
    def _contacts(answer):
        return answer.points, answer.normals, answer.depths

    def _expect_arm_at_post(self, angle, point, normal, depth):
        center, post = 0.5 * numpy.array([math.cos(angle), math.sin(angle), 0]), numpy.array([0, 0.5, 0])
        gap = numpy.linalg.norm(post - center)
        self.assertLess(max(numpy.linalg.norm(point - center), numpy.linalg.norm(point - post)), 0.1 + 1e-6)
        self.assertLess(numpy.linalg.norm(normal - (post - center) / gap), 1e-6)
        self.assertAlmostEqual(depth, 0.2 - gap, delta=1e-6)

    # Claim: for random states, verdicts and clearances are those of the spheres, computed here.
    def test_verdicts_and_clearances_are_those_of_spheres(self):
        generator = numpy.random.RandomState(1)
        rows = numpy.column_stack([generator.uniform(-7, 7, 1000), generator.uniform(0, 1, 1000)])
        found = self.states(rows, max_clearance=0.4)
        gaps = []
        for angle, slide in rows:
            gaps.append(min(math.hypot(reach * math.cos(angle), reach * math.sin(angle) - y) - 0.2
                            for reach in (0.5, 1 + slide) for y in (0.5, -1.5)))
        gaps = numpy.array(gaps)
        self.assertEqual(found.hit.tolist(), (gaps <= 0).tolist())
        self.assertEqual(found.clear.tolist(), (gaps > 0).tolist())
        near = (gaps > 0) & (gaps <= 0.4)
        self.assertGreater(near.sum(), 100)
        self.assertLess(abs(found.clearance[near] - gaps[near]).max(), 1e-6)
        self.assertTrue(numpy.isinf(found.clearance[gaps > 0.4]).all())
        self.assertTrue((found.clearance[gaps <= 0] == 0).all())

    def test_gradients_are_those_of_spheres(self):
        found = self.states([[0.9, 0.5], [TO_POST, 0.5], [3, 0.5]], max_clearance=0.4, gradients=True)
        gap = lambda angle: math.hypot(0.5 * math.cos(angle), 0.5 * math.sin(angle) - 0.5) - 0.2
        self.assertAlmostEqual(found.gradient[0][0], (gap(0.9001) - gap(0.8999)) / 0.0002, delta=1e-4)
        self.assertAlmostEqual(found.gradient[0][1], 0.0, delta=1e-9)
        self.assertTrue(numpy.isnan(found.gradient[1:]).all(), "in contact, and too far")

    def test_joints_that_are_not_named_are_where_tf_says(self):
        self.assertTrue(self.proximity.check_states(["shoulder"], [[TO_WALL]]).clear[0], "the slide is at 0.25 m")
        self.assertTrue(self.proximity.check_states(["robot/shoulder"], [[TO_POST]]).hit[0])

    def test_a_base_puts_the_robot_elsewhere_and_ignored_bodies_do_not_count(self):
        base = Pose()
        base.position.x, base.orientation.w = 3.0, 1.0
        self.assertTrue(self.states([[TO_POST, 0.5]], base=base).clear[0])
        self.assertTrue(self.states([[TO_POST, 0.5]], ignore="obstacle/post").clear[0])
        self.assertTrue(self.states([[TO_POST, 0.5]], group="gripper").clear[0], "the arm touches the post, not the hand")

    def test_an_invalid_state_is_refused_and_the_others_are_answered(self):
        found = self.states([[0, 0.5], [math.nan, 0.5], [TO_POST, 0.5], [0, 2.0]])
        self.assertEqual(list(found.response.codes), [CodeNames.OK, CodeNames.NONFINITE, CodeNames.OK, CodeNames.OK])
        self.assertEqual(found.unknown.tolist(), [False, True, False, False])
        self.assertEqual(found.response.unknown_because[1], UnknownReason.REFUSED)
        self.assertIn("state 1: joint 'shoulder'", found.text(1))
        self.assertEqual((found.text(0), found.text(3)), ("", ""))
        self.assertEqual(found.beyond_limits.tolist(), [False, False, False, True])

    def test_an_empty_batch_is_answered(self):
        self.assertEqual(len(self.states(numpy.empty((0, 2)))), 0)
        self.assertEqual(len(self.edges(numpy.empty((0, 2)), numpy.empty((0, 2)))), 0)

    def test_an_invalid_request_is_refused_by_name(self):
        check = self.proximity.check_states
        self.assert_refused("UNKNOWN_ID", lambda: check(["elbow"], [[0]]), "elbow")
        self.assert_refused("UNKNOWN_ID", lambda: check(["elbow"], [[0]], robot="robot"), "elbow")
        self.assert_refused("UNKNOWN_ID", lambda: self.states([[0, 0]], robot="other"), "other", "robot")
        self.assert_refused("UNKNOWN_ID", lambda: self.states([[0, 0]], group="leg"), "leg")
        self.assert_refused("UNKNOWN_ID", lambda: self.states([[0, 0]], group="leg", robot="robot"), "leg")
        self.assert_refused("DUP_ID", lambda: check(["slide", "slide"], [[0, 0]]), "slide")
        self.assert_refused("UNKNOWN_ID", lambda: self.states([[0, 0]], ignore="robot/*"), "ignore")
        self.assert_refused("UNSUPPORTED", lambda: self.states([[0, 0]], group="carriage"), "carriage", "geometry")
        self.assert_refused("BAD_GEOMETRY", lambda: self.states([[0, 0]], max_clearance=-1.0), "clearance")
        self.assert_refused("OUT_OF_RANGE", lambda: self.states([[0, 0]], max_time=-1.0), "max_time")
        self.assert_refused("LIMIT", lambda: check(["slide"], numpy.zeros((1001, 1))), "1001", "1000", "~limits/max_batch")
        self.assert_refused("OUT_OF_RANGE", lambda: self.edges([[0, 0]], [[0, 0]], tolerance=2.0), "tolerance")
        self.assert_refused("OUT_OF_RANGE", lambda: self.edges([[0, 0]], [[0, 0], [0, 1]]), "start has 2 values")
        self.assert_refused("OUT_OF_RANGE", lambda: self.states([[0, 0]], max_clearance=11.0), "max_clearance")
        for rows in ([[0]], [[0, 0, 0]], [0, 0]):
            with self.assertRaises(ValueError):
                self.states(rows)
        self.assert_refused("LIMIT", lambda: self.edges(numpy.zeros((1001, 2)), numpy.zeros((1001, 2))), "~limits/max_batch")

    def test_edges_have_the_first_contact(self):
        found = self.edges([[0, 0.5], [0, 0.5], [TO_WALL, 0.0]], [[1, 0.5], [3, 0.5], [TO_WALL, 0.5]])
        self.assertEqual(found.clear.tolist(), [True, False, False])
        self.assertEqual(found.hit.tolist(), [False, True, True])
        touch = (TO_POST - 2 * math.asin(0.2)) / 3
        self.assertAlmostEqual(found.at[1], touch, delta=1e-3)
        self.assertLessEqual(found.free_until[1], touch)
        self.assertAlmostEqual(found.free_until[1], touch, delta=2e-3)
        self.assertAlmostEqual(found.at[2], 0.6, delta=2e-3)
        self.assertEqual((found.free_until[0], found.pair(0)), (1.0, None))
        self.assertTrue(math.isnan(found.at[0]))
        self.assertEqual(found.pair(2), ("robot/hand", "obstacle/wall"))
        self.assertAlmostEqual(found.response.point[2].y, -1.4, delta=0.01)
        hit = self.edges([[0, 0.5]], [[3, 0.5]], any_contact=True)
        self.assertTrue(hit.hit[0])

    def test_an_edge_that_passes_too_near_is_unknown(self):
        thin = obstacles.add("thin", obstacles.sphere(0.1), position=(0.0, -0.70001, 0.0))  # the arm passes it at 10 um
        self.proximity.apply_obstacles(thin)
        try:
            found = self.edges([[-1, 0.9]], [[-2.2, 0.9]], ignore="obstacle/wall")
            self.assertTrue(found.unknown[0])
            self.assertEqual(found.response.unknown_because[0], UnknownReason.TOLERANCE)
            self.assertEqual(found.pair(0), ("robot/arm", "obstacle/thin"))
            self.assertIn("come within", found.text(0))
            self.assertTrue(self.edges([[-1, 0.9]], [[-2.2, 0.9]], ignore="obstacle/wall", tolerance=1e-5).clear[0])
        finally:
            self.proximity.apply_obstacles(obstacles.remove("thin"))

    # Claim: requests with a lease are answered from the same world, whatever changes in between.
    def test_a_lease_keeps_the_world(self):
        row = [[1.0, 0.5]]
        first = self.states(row, keep=20.0)
        self.assertTrue(first.clear[0])
        lease = first.response.lease
        self.assertGreater(lease.lasts.to_sec(), 4.0)
        self.assertLessEqual(lease.lasts.to_sec(), 5.0, "~limits/lease_max")
        where = (0.5 * math.cos(1.0), 0.5 * math.sin(1.0), 0.0)
        self.proximity.apply_obstacles(obstacles.add("new", obstacles.sphere(0.1), position=where))
        try:
            self.assertTrue(self.states(row).hit[0])
            again = self.states(row, lease=lease)
            self.assertTrue(again.clear[0])
            self.assertEqual(again.response.world.sequence, lease.sequence)
            self.assertTrue(self.edges(row, row, lease=lease).clear[0])
            self.assertTrue(self.edges(row, row).hit[0])
        finally:
            self.proximity.apply_obstacles(obstacles.remove("new"))

        def is_over():
            try:
                self.states(row, lease=lease)
                return False
            except Refused as refused:
                self.assertEqual(refused.code, "EXTRAPOLATION")
                self.assertIn("tick %d" % lease.sequence, str(refused))
                return True

        wait(is_over, "the end of the lease")

    def test_a_lease_does_not_outlive_the_model_of_its_robot(self):
        reload_robot = rospy.ServiceProxy("/proximity/reload_robot", srv.ReloadRobot)
        lease = self.states([[0, 0.5]], keep=5.0).response.lease
        self.assertTrue(reload_robot(robot="robot").success)
        wait(lambda: self.proximity.pairs().usable, "the new model")
        self.assert_refused("CONFLICT", lambda: self.states([[0, 0.5]], lease=lease), "'robot' was loaded again",
                            "tick %d" % lease.sequence, "revision")
        self.assert_refused("CONFLICT", lambda: self.edges([[0, 0.5]], [[0, 0.6]], lease=lease), "loaded again")
        self.assertTrue(self.states([[0, 0.5]]).clear[0])

    def test_a_lease_of_another_world_is_refused(self):
        other = Lease(epoch=1, sequence=5)
        self.assert_refused("CONFLICT", lambda: self.states([[0, 0]], lease=other), "epoch 1")
        self.assert_refused("OUT_OF_RANGE", lambda: self.states([[0, 0]], keep=-1.0), "lasts")

    def test_only_so_many_leases_are_kept(self):
        leases, ticks = [], set()
        while len(ticks) < 20:
            response = self.states([[0, 0]], keep=5.0).response
            leases.append(response.lease)
            ticks.add(response.world.sequence)
        kept = [lease for lease in leases if lease.lasts.to_sec() > 0]
        self.assertEqual(len({lease.sequence for lease in kept}), 16)
        self.assertEqual(leases[-1].lasts.to_sec(), 0.0, "there is no room for more")
        wait(lambda: self.states([[0, 0]], keep=0.1).response.lease.lasts.to_sec() > 0, "the end of a lease")

    def add_twin(self):
        self.arm.twin_at = 3.0
        self.proximity.apply_robots(robots.add("twin", like="robot"))
        wait(lambda: self.proximity.pairs().usable, "the frames of the twin")

    def remove_twin(self):
        self.proximity.apply_robots(robots.remove("twin"))
        self.arm.twin_at = None

    # Claim: another robot, and what it holds, is where the request puts it.
    def test_another_robot_can_be_given_other_positions(self):
        self.add_twin()
        try:
            check = lambda rows, **options: self.states(rows, robot="robot", **options)
            facing = lambda slide: {"twin/shoulder": math.pi, "twin/slide": slide}
            self.assertTrue(check([[0, 0.5]]).clear[0], "on tf, the twin faces away")
            self.assertTrue(check([[0, 0.5]], others=facing(0.2)).clear[0])
            found = check([[0, 0.5], [TO_POST, 0.5], [1, 0.5]], others=facing(0.45), max_clearance=0.5)
            self.assertEqual(found.hit.tolist(), [True, True, False])
            self.assertEqual([found.pair(i) for i in range(2)],
                             [("robot/hand", "twin/hand"), ("robot/arm", "obstacle/post")])
            near = check([[0, 0.5]], others=facing(0.2), max_clearance=0.5)
            self.assertAlmostEqual(near.clearance[0], 0.1, delta=1e-6)
            self.assertEqual(near.pair(0), ("robot/hand", "twin/hand"))
            self.assertTrue(check([[0, 0.5]], others={"twin/shoulder": math.pi}).clear[0], "its slide is at 0.25 m")
            edge = self.edges([[-1, 0.5]], [[1, 0.5]], robot="robot", others=facing(0.45))
            self.assertEqual((edge.hit.tolist(), edge.pair(0)), ([True], ("robot/hand", "twin/hand")))
            self.assertTrue(self.edges([[-1, 0.5]], [[1, 0.5]], robot="robot", others=facing(0.2)).clear[0])
            held = obstacles.add("rod", obstacles.sphere(0.1), position=(0.25, 0.0, 0.0), frame="twin/hand")
            self.proximity.apply_obstacles(held)
            self.assertEqual(check([[0, 0.5]], others=facing(0.2)).pair(0), ("robot/hand", "obstacle/rod"))
            self.assertTrue(check([[0, 0.5]]).clear[0])
        finally:
            self.proximity.apply_obstacles(obstacles.remove("rod"))
            self.remove_twin()

    # Claim: while nobody knows where another robot stands, no state is CLEAR, even if the request gives all its joints.
    def test_another_robot_whose_place_is_old_makes_states_unknown(self):
        self.add_twin()
        try:
            shoulder, both = {"twin/shoulder": math.pi}, {"twin/shoulder": math.pi, "twin/slide": 0.2}
            check = lambda others: self.states([[0, 0.5], [TO_POST, 0.5]], robot="robot", others=others)
            self.assertEqual(check(both).clear.tolist(), [True, False])

            def is_clear(others):
                try:
                    return check(others).clear[0]
                except Refused as refused:
                    self.assertEqual(refused.code, "EXTRAPOLATION")
                    return False

            self.arm.twin_publishes = False
            for others in (shoulder, both):
                wait(lambda: not is_clear(others), "the end of the knowledge")
        finally:
            self.arm.twin_publishes = True
            self.remove_twin()

    def test_joints_of_other_robots_that_are_not_valid_are_refused_by_name(self):
        self.add_twin()
        try:
            refused = lambda code, words, others: self.assert_refused(
                code, lambda: self.states([[0, 0.5]], robot="robot", others=others), words)
            refused("UNKNOWN_ID", "elbow", {"twin/elbow": 0.0})
            refused("UNKNOWN_ID", "nobody", {"nobody/shoulder": 0.0})
            refused("UNKNOWN_ID", "robot/joint", {"shoulder": 0.0})
            refused("CONFLICT", "joint_names", {"robot/shoulder": 0.0})
            refused("NONFINITE", "finite", {"twin/shoulder": math.nan})
            response = self.proximity._services[srv.CheckStates](srv.CheckStatesRequest(
                robot="robot", joint_names=JOINTS, positions=[0, 0.5], other_joint_names=["twin/slide"]), 10.0)
            self.assertEqual(response.code.name, "OUT_OF_RANGE")
            self.assertIn("other_positions 0", response.code.text)
        finally:
            self.remove_twin()

    def test_a_group_with_a_virtual_joint_is_the_whole_robot(self):
        self.assertTrue(self.states([[TO_POST, 0.5]], group="whole").hit[0])

    # Claim: if nobody knows where a joint stands, only requests that give it can be CLEAR.
    def test_a_joint_whose_position_is_old_makes_states_unknown(self):
        self.assertTrue(self.proximity.check_states(["slide"], [[0.5]]).clear[0])
        self.arm.publishes = False
        try:
            wait(lambda: self.proximity.check_states(["slide"], [[0.5]]).unknown[0], "the end of the knowledge")
            self.assertTrue(math.isnan(self.proximity.check_states(["slide"], [[0.5]], max_clearance=0.4).clearance[0]))
            self.assertTrue(self.states([[0, 0.5]]).clear[0])
            edge = self.proximity.check_edges(["slide"], [[0.1]], [[0.5]])
            self.assertEqual((edge.unknown[0], edge.free_until[0]), (True, 0.0))
        finally:
            self.arm.publishes = True
            wait(lambda: self.proximity.check_states(["slide"], [[0.5]]).clear[0], "the poses of the links")


if __name__ == "__main__":
    rosunit.unitrun("hgrid_proximity", "check_states", CheckStates)
