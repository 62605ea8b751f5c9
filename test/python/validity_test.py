#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""MoveIt's service check_state_validity, with its type name and MD5, beside a running node. See turning_arm.py for the
robot."""
import math
import random
import unittest

import rospy
import rosunit
from geometry_msgs.msg import Transform
from hgrid_proximity import obstacles
from hgrid_proximity.client import Proximity
from hgrid_proximity.msg import Status
from moveit_types import Types
from shape_msgs.msg import SolidPrimitive
from turning_arm import TO_POST, TO_WALL, Arm, wait

TYPES = Types()
LINK, OBJECT, ATTACHED = 0, 1, 2


class Validity(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("validity_test")
        cls.arm = Arm()
        cls.kind = TYPES.service("GetStateValidity")
        cls.check = rospy.ServiceProxy("check_state_validity", cls.kind)
        cls.check.wait_for_service(60.0)
        cls.apply = rospy.ServiceProxy("apply_planning_scene", TYPES.service("ApplyPlanningScene"))
        cls.proximity = Proximity("/proximity", timeout=60.0)
        wait(lambda: cls.proximity.pairs().usable, "a complete world", 120.0)

    def request(self, **joints):
        request = self.kind._request_class()
        request.robot_state.joint_state.name = list(joints)
        request.robot_state.joint_state.position = list(joints.values())
        return request

    def answer(self, group="", **joints):
        request = self.request(**joints)
        request.group_name = group
        return self.check(request)

    def contacts(self, answer):
        return sorted((each.contact_body_1, each.body_type_1, each.contact_body_2, each.body_type_2)
                      for each in answer.contacts)

    def assert_refused(self, request):
        with self.assertRaises(rospy.ServiceException):
            self.check(request)

    def counters(self):
        status = rospy.wait_for_message("/proximity/status", Status, 60.0)
        return {counter.name: counter.value for counter in status.counters}

    def test_the_type_is_that_of_moveit(self):
        self.assertEqual(self.kind._md5sum, "06ea62db671e4dbf878eaca241db51ad")

    def test_a_state_in_contact_is_not_valid_and_names_all_contacts(self):
        free = self.answer(shoulder=0.0, slide=0.5)
        self.assertTrue(free.valid)
        self.assertEqual((free.contacts, free.cost_sources, free.constraint_result), ([], [], []))
        post = self.answer(shoulder=TO_POST, slide=0.5)
        self.assertFalse(post.valid)
        self.assertEqual(self.contacts(post), [("arm", LINK, "post", OBJECT)])
        contact = post.contacts[0]
        self.assertEqual(contact.header.frame_id, "world")
        self.assertAlmostEqual(contact.position.y, 0.5, delta=0.11)
        self.assertAlmostEqual(contact.depth, 0.2, delta=0.01)
        wall = self.answer(shoulder=TO_WALL, slide=0.45)
        self.assertEqual(self.contacts(wall), [("hand", LINK, "wall", OBJECT)])
        both = self.answer(shoulder=TO_WALL, slide=0.45, grip=7.0)
        self.assertEqual(self.contacts(both), self.contacts(wall), "a joint that mimics another does not count")

    # Claim: for random states, the service agrees with the distances of the spheres, computed here.
    def test_it_agrees_with_spheres_in_random_states(self):
        generator = random.Random(1)
        seen = set()
        for _ in range(300):
            angle, slide = generator.uniform(-7, 7), generator.uniform(0, 1)
            expected = []
            for link, reach in (("arm", 0.5), ("hand", 1 + slide)):
                for name, y in (("post", 0.5), ("wall", -1.5)):
                    gap = math.hypot(reach * math.cos(angle), reach * math.sin(angle) - y) - 0.2
                    if abs(gap) < 1e-5:
                        break
                    if gap < 0:
                        expected.append((link, LINK, name, OBJECT))
            answer = self.answer(shoulder=angle, slide=slide)
            self.assertEqual((answer.valid, self.contacts(answer)), (not expected, sorted(expected)), (angle, slide))
            seen.add(tuple(expected))
        self.assertGreaterEqual(len(seen), 3)

    def test_joints_that_the_request_leaves_out_are_where_they_are(self):
        self.arm.angle = TO_WALL
        try:
            wait(lambda: not self.proximity.query_sphere((0, -0.5, 0), 0.01).clear, "the arm at the wall")
            self.assertFalse(self.answer(slide=0.5).valid)
            self.assertTrue(self.answer(slide=0.0).valid)
            self.assertTrue(self.answer().valid, "the slide is at 0.25 m")
            self.assertTrue(self.answer(shoulder=0.0, slide=0.5).valid)
        finally:
            self.arm.angle = 0.0
            wait(lambda: not self.proximity.query_sphere((0.5, 0, 0), 0.01).clear, "the arm at its place")

    def test_of_a_group_only_the_links_that_it_moves_count(self):
        self.assertFalse(self.answer("all", shoulder=TO_POST).valid)
        self.assertTrue(self.answer("gripper", shoulder=TO_POST).valid, "the arm touches the post, but not the hand")
        self.assertFalse(self.answer("gripper", shoulder=TO_WALL, slide=0.5).valid)
        self.assert_refused(self.kind._request_class(group_name="leg"))

    def moved(self, joint, x, y, z=0.0, **joints):
        """Returns a request that gives a joint a pose."""
        request = self.request(**joints)
        place = Transform()
        place.translation.x, place.translation.y, place.translation.z, place.rotation.w = x, y, z, 1.0
        request.robot_state.multi_dof_joint_state.joint_names = [joint]
        request.robot_state.multi_dof_joint_state.transforms = [place]
        return request

    def test_a_virtual_joint_puts_the_whole_robot_elsewhere(self):
        at_post = {"shoulder": TO_POST, "slide": 0.5}
        self.assertTrue(self.check(self.moved("odometry", 3.0, 0.0, **at_post)).valid)
        answer = self.check(self.moved("odometry", 0.0, -2.0, **at_post))
        self.assertEqual(self.contacts(answer), [("arm", LINK, "wall", OBJECT)])
        self.assertFalse(self.check(self.moved("stand", 3.0, 0.0, **at_post)).valid, "a fixed joint moves nothing")
        self.assert_refused(self.moved("rail", 3.0, 0.0, **at_post))
        self.assert_refused(self.moved("wheels", 3.0, 0.0, **at_post))
        elsewhere = self.moved("odometry", 3.0, 0.0, **at_post)
        elsewhere.robot_state.multi_dof_joint_state.header.frame_id = "nowhere"
        self.assert_refused(elsewhere)

    def test_a_planar_joint_stays_in_its_plane(self):
        self.assertTrue(self.check(self.moved("plane", 0.5, 0.5, shoulder=0.0, slide=0.5)).valid)
        self.assert_refused(self.moved("plane", 0.5, 0.5, 0.1, shoulder=0.0, slide=0.5))

    # Claim: if the links have no pose any more, only a state that gives all joints is valid.
    def test_joints_of_which_nobody_knows_where_they_stand_are_unknown(self):
        self.assertTrue(self.answer().valid)
        self.arm.publishes = False
        try:
            wait(lambda: not self.answer().valid, "the end of the knowledge")
            self.assertEqual(self.answer().contacts, [])
            self.assertFalse(self.answer(slide=0.5).valid)
            self.assertTrue(self.answer(shoulder=0.0, slide=0.5).valid, "no pose of a link is needed")
        finally:
            self.arm.publishes = True
            wait(lambda: self.answer().valid, "the poses of the links")

    # Claim: an obstacle in a frame below a link moves with the link, but nobody knows how, because the model lacks it.
    def test_what_follows_the_robot_over_other_frames_is_unknown(self):
        self.proximity.apply_obstacles(obstacles.add("cup", obstacles.sphere(0.05), position=(0.5, 0, 0), frame="tcp"))
        try:
            self.assertTrue(self.answer().valid, "the cup is where it is")
            self.assertFalse(self.answer(shoulder=0.1).valid)
            self.assertEqual(self.answer(shoulder=0.1).contacts, [])
        finally:
            self.proximity.apply_obstacles(obstacles.remove("cup"))
        self.assertTrue(self.answer(shoulder=0.1).valid)

    def test_an_attached_object_moves_with_the_arm(self):
        scene = TYPES["PlanningScene"](is_diff=True)
        held = TYPES["AttachedCollisionObject"](link_name="hand", touch_links=["hand", "finger"])
        held.object.id, held.object.header.frame_id = "bottle", "hand"
        held.object.primitives = [SolidPrimitive(type=SolidPrimitive.SPHERE, dimensions=[0.05])]
        pose = TYPES["CollisionObject"]().pose
        pose.position.x, pose.orientation.w = 0.5, 1.0
        held.object.primitive_poses = [pose]
        scene.robot_state.attached_collision_objects = [held]
        self.assertTrue(self.apply(scene=scene).success)
        try:
            answer = self.answer(shoulder=TO_WALL, slide=0.0)
            self.assertEqual(self.contacts(answer), [("bottle", ATTACHED, "wall", OBJECT)])
            request = self.request(shoulder=0.0)
            request.robot_state.attached_collision_objects = [held]
            self.assert_refused(request)
        finally:
            held.object.operation = 1
            scene.world.collision_objects = [TYPES["CollisionObject"](id="bottle", operation=1)]
            self.assertTrue(self.apply(scene=scene).success)

    def test_joint_constraints_are_evaluated(self):
        def constrained(position, above, below, **joints):
            request = self.request(**joints)
            request.constraints.joint_constraints = [TYPES["JointConstraint"](
                joint_name="shoulder", position=position, tolerance_above=above, tolerance_below=below, weight=2.0)]
            return self.check(request)

        inside = constrained(0.5, 0.3, 0.1, shoulder=0.75)
        self.assertTrue(inside.valid)
        self.assertTrue(inside.constraint_result[0].result)
        self.assertAlmostEqual(inside.constraint_result[0].distance, 0.5)
        for angle in (0.85, 0.35):
            outside = constrained(0.5, 0.3, 0.1, shoulder=angle)
            self.assertFalse(outside.valid)
            self.assertFalse(outside.constraint_result[0].result)
            self.assertEqual(outside.contacts, [])
        self.assertTrue(constrained(3.1, 0.2, 0.2, shoulder=-3.1).valid, "the joint turns without limits")
        with self.assertRaises(rospy.ServiceException):
            constrained(0.5, -0.3, 0.1, shoulder=0.5)

    def test_a_request_that_the_node_cannot_answer_fails(self):
        before = self.counters()
        self.assert_refused(self.request(elbow=0.0))
        self.assert_refused(self.request(shoulder=math.nan))
        self.assert_refused(self.request(odometry=1.0))
        uneven = self.request(shoulder=0.0)
        uneven.robot_state.joint_state.position = []
        self.assert_refused(uneven)
        twice = self.request(shoulder=0.0)
        twice.robot_state.joint_state.name, twice.robot_state.joint_state.position = ["shoulder"] * 2, [0.0, 1.0]
        self.assert_refused(twice)
        for part in ("Position", "Orientation", "Visibility"):
            request = self.request(shoulder=0.0)
            setattr(request.constraints, part.lower() + "_constraints", [TYPES[part + "Constraint"]()])
            self.assert_refused(request)
        unknown = self.request()
        unknown.constraints.joint_constraints = [TYPES["JointConstraint"](joint_name="elbow")]
        self.assert_refused(unknown)

        def refused():
            after = self.counters()
            return sum(after[name] - before.get(name, 0) for name in after if name.startswith("moveit.validity_failed."))

        wait(lambda: refused() == 9, "nine refusals in ~status")

    # Claim: while something is missing in the world, no state is valid, because the robot may touch it.
    def test_an_unknown_state_is_not_valid(self):
        publisher = rospy.Publisher("/collision_object", TYPES["CollisionObject"], queue_size=10)
        wait(lambda: publisher.get_num_connections() > 0, "a connection")
        flat = TYPES["CollisionObject"](id="flat")
        flat.header.frame_id = "world"
        flat.primitives = [SolidPrimitive(type=SolidPrimitive.SPHERE, dimensions=[0.0])]
        flat.primitive_poses = [flat.pose]
        publisher.publish(flat)
        wait(lambda: not self.proximity.query_sphere((9, 9, 9), 0.01).response.world.complete, "the gap")
        answer = self.answer(shoulder=0.0, slide=0.5)
        self.assertFalse(answer.valid)
        self.assertEqual(answer.contacts, [])
        wait(lambda: self.counters().get("moveit.validity_unknown.NOT_READY", 0) >= 1, "the counter")
        flat.operation = 1
        publisher.publish(flat)
        wait(lambda: self.proximity.query_sphere((9, 9, 9), 0.01).response.world.complete, "the end of the gap")
        self.assertTrue(self.answer(shoulder=0.0, slide=0.5).valid)

    def test_it_is_not_offered_unless_it_is_configured(self):
        with self.assertRaises(rospy.ROSException):
            rospy.wait_for_service("/without/check_state_validity", 0.2)


if __name__ == "__main__":
    rosunit.unitrun("hgrid_proximity", "validity", Validity)
