#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""MoveIt's topics and services, with its type names and MD5s, beside two running nodes. The node /proximity offers topics
and services. The node /topics/proximity offers only topics."""
import io
import pathlib
import random
import re
import struct
import time
import unittest

import rospy
import rosunit
from geometry_msgs.msg import Pose
from hgrid_proximity.client import Proximity
from hgrid_proximity.msg import Pairs, Status
from moveit_types import Types
from moving_ball import Ball
from shape_msgs.msg import SolidPrimitive

ADD, REMOVE, APPEND, MOVE = range(4)
TYPES = Types()
MD5S = {
    "CollisionObject": "dbba710596087da521c07564160dfccb",
    "AttachedCollisionObject": "30199ef516f64c8bc1edb1084ce4584e",
    "PlanningScene": "acfc50bcfd6c7b978066bfa7c786002c",
}
SERVICE_MD5S = {
    "GetPlanningScene": "65cf69d3e7a0342e16374024d4eeef65",
    "ApplyPlanningScene": "d4d1599e0b6f71a6a8a10cb34780619c",
}
NAMES, GEOMETRY, ATTACHED, MATRIX, PADDING = 8, 16, 4, 128, 256
ROOM = pathlib.Path(__file__).resolve().parents[2] / "demo" / "room.bt"


def pose_at(x, y=0.0):
    pose = Pose()
    pose.position.x, pose.position.y, pose.orientation.w = x, y, 1.0
    return pose


def sphere(name, x, radius=0.1, operation=ADD, frame="world"):
    """Returns a message for an object of one sphere."""
    message = TYPES["CollisionObject"](id=name, operation=operation)
    message.header.frame_id = frame
    message.primitives = [SolidPrimitive(type=SolidPrimitive.SPHERE, dimensions=[radius])]
    message.primitive_poses = [pose_at(x)]
    return message


def remove(name):
    return TYPES["CollisionObject"](id=name, operation=REMOVE)


def attached(link, message, touch=()):
    return TYPES["AttachedCollisionObject"](link_name=link, object=message, touch_links=list(touch))


class Cut(TYPES["CollisionObject"]):
    """A message of which only the first bytes are sent."""

    size = 0

    def serialize(self, buffer):
        whole = io.BytesIO()
        super().serialize(whole)
        buffer.write(whole.getvalue()[: self.size])



class Node:
    """One of the two nodes, and publishers for its topics."""

    def __init__(self, namespace):
        self.namespace = namespace
        self.proximity = Proximity(namespace + "/proximity", timeout=60.0)
        self.publishers, self.sent = {}, 0

    def publisher(self, topic, kind):
        if topic not in self.publishers:
            publisher = rospy.Publisher(self.namespace + "/" + topic, kind, queue_size=100000)
            self.publishers[topic] = publisher
            wait(lambda: publisher.get_num_connections() > 0, "a connection to " + topic)
        return self.publishers[topic]

    def send(self, topic, kind, message):
        publisher = self.publisher(topic, TYPES[kind])
        self.sent += 1
        publisher.publish(message)

    def object(self, message):
        self.send("collision_object", "CollisionObject", message)

    def attached(self, message):
        self.send("attached_collision_object", "AttachedCollisionObject", message)

    def planning_scene(self, *objects, **options):
        self.send("planning_scene", "PlanningScene", self.scene(*objects, **options))

    def scene(self, objects=(), held=(), is_diff=True):
        message = TYPES["PlanningScene"](is_diff=is_diff)
        message.robot_state.joint_state.name = ["j"]  # MoveIt ignores a state of the robot without joints
        message.world.collision_objects, message.robot_state.attached_collision_objects = list(objects), list(held)
        return message

    def counters(self):
        status = rospy.wait_for_message(self.namespace + "/proximity/status", Status, 60.0)
        return {counter.name: counter.value for counter in status.counters if counter.name.startswith("moveit.")}

    def settled(self):
        """Waits until all messages that were sent were applied, refused or dropped. Returns the sums."""
        found = {}

        def is_settled():
            counters = self.counters()
            for kind in ("received", "applied", "refused", "dropped"):
                names = [name for name in counters if name.split(".")[1] == kind]
                found[kind] = sum(counters[name] for name in names)
            return self.sent == found["received"] == found["applied"] + found["refused"] + found["dropped"]

        wait(is_settled, "all messages", 300.0)
        return found

    def names_at(self, x, y=0.0):
        names = self.proximity.query_sphere((x, y, 0), 0.01).names
        return [name for name in names if name.startswith("obstacle/")]

    def world(self):
        return self.proximity.query_sphere((100, 0, 0), 0.01).response.world


def wait(condition, what, seconds=120.0):
    deadline = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > deadline:
            raise AssertionError("%s did not come within %s s" % (what, seconds))
        time.sleep(0.05)


class MoveIt(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("moveit_test")
        cls.ball = Ball()
        cls.noetic, cls.topics = Node(""), Node("/topics")
        cls.get = rospy.ServiceProxy("get_planning_scene", TYPES.service("GetPlanningScene"))
        cls.apply = rospy.ServiceProxy("apply_planning_scene", TYPES.service("ApplyPlanningScene"))
        cls.get.wait_for_service(60.0)
        for node in (cls.noetic, cls.topics):
            wait(lambda node=node: node.proximity.pairs().usable, "a complete world", 120.0)

    def tearDown(self):
        for node in (self.noetic, self.topics):
            node.planning_scene(is_diff=False)
            node.settled()
            wait(lambda node=node: node.world().complete, "a complete world")

    def scene(self, components):
        request = TYPES["PlanningSceneComponents"](components=components)
        return self.get(components=request).scene

    def names(self):
        return [each.id for each in self.scene(NAMES).world.collision_objects]

    def test_the_types_are_those_of_moveit(self):
        for name, md5 in MD5S.items():
            self.assertEqual(TYPES[name]._md5sum, md5)
        for name, md5 in SERVICE_MD5S.items():
            self.assertEqual(TYPES.service(name)._md5sum, md5)

    def test_messages_change_the_world(self):
        for node in (self.noetic, self.topics):
            node.object(sphere("part", 1))
            wait(lambda node=node: node.names_at(1) == ["obstacle/part"], "the part")
            move = TYPES["CollisionObject"](id="part", operation=MOVE)
            move.primitive_poses = [pose_at(2)]
            node.object(move)
            wait(lambda node=node: node.names_at(2) == ["obstacle/part"], "the moved part")
            node.attached(attached("ball", sphere("held", 0.5, frame="ball")))
            x = self.ball.x + 0.5
            wait(lambda node=node, x=x: node.names_at(x) == ["obstacle/held"], "the held part")
            node.object(remove(""))
            wait(lambda node=node: node.names_at(2) == [], "the removal")
            self.assertEqual(node.names_at(x), ["obstacle/held"])
            node.planning_scene([sphere("new", 1)], is_diff=False)
            wait(lambda node=node: node.names_at(1) == ["obstacle/new"], "the new scene")
            self.assertEqual(node.names_at(x), [])

    # As PlanningSceneInterface of MoveIt uses the services.
    def test_the_services_apply_and_return_a_scene(self):
        self.assertEqual(self.names(), ["crate"])
        self.assertTrue(self.apply(scene=self.noetic.scene([sphere("part", 1, 0.25)])).success)
        self.assertEqual(self.names(), ["crate", "part"], "in force when the call returns")
        part = self.scene(GEOMETRY).world.collision_objects[1]
        self.assertEqual((part.pose.position.x, part.primitives[0].dimensions), (1.0, (0.25,)))
        self.assertEqual(part.header.frame_id, "world")
        self.assertFalse(self.apply(scene=self.noetic.scene(held=[attached("ball", remove("part"))])).success)
        hold = attached("ball", TYPES["CollisionObject"](id="part"), touch=["ball"])
        self.assertTrue(self.apply(scene=self.noetic.scene(held=[hold])).success)
        self.assertEqual(self.names(), ["crate"])
        held = self.scene(ATTACHED).robot_state.attached_collision_objects
        self.assertEqual([(each.link_name, each.object.id, each.touch_links) for each in held], [("ball", "part", ["ball"])])
        self.assertTrue(self.apply(scene=self.noetic.scene(held=[attached("ball", remove("part"))])).success)
        self.assertEqual(self.names(), ["crate", "part"])

    # Claim: paddings and the allowed collision matrix of a scene are in force until the next complete scene.
    def test_paddings_and_the_matrix_of_a_scene_are_in_force(self):
        scene = self.noetic.scene([sphere("part", self.ball.x + 0.3, 0.1)])
        scene.link_padding = [TYPES["LinkPadding"](link_name="ball", padding=0.15)]
        self.assertTrue(self.apply(scene=scene).success)
        self.assertEqual(self.noetic.proximity.query_sphere((self.ball.x - 0.2, 0, 0), 0.01).names, ["robot/ball"])
        padding = self.scene(PADDING).link_padding
        self.assertEqual([(each.link_name, each.padding) for each in padding], [("ball", 0.15)])
        self.assertIn("obstacle/part", self.near_pairs())
        matrix = self.noetic.scene()
        matrix.allowed_collision_matrix.entry_names = ["part", "ball"]
        entry = TYPES["AllowedCollisionEntry"]
        matrix.allowed_collision_matrix.entry_values = [entry(enabled=[False, True]), entry(enabled=[True, False])]
        self.assertTrue(self.apply(scene=matrix).success)
        self.assertNotIn("obstacle/part", self.near_pairs())
        known = self.scene(MATRIX).allowed_collision_matrix
        self.assertEqual((known.entry_names, known.entry_values[0].enabled), (["ball", "part"], [False, True]))
        matrix.allowed_collision_matrix.entry_values.pop()
        self.assertFalse(self.apply(scene=matrix).success)
        self.noetic.planning_scene([sphere("part", self.ball.x + 0.3, 0.1)], is_diff=False)
        wait(lambda: "obstacle/part" in self.near_pairs(), "the end of the matrix")
        self.assertEqual([each.padding for each in self.scene(PADDING).link_padding], [0.0])

    def near_pairs(self):
        """Names of all bodies that a new ~pairs lists."""
        pairs = rospy.wait_for_message("/proximity/pairs", Pairs, 60.0)
        return [pairs.names[i] for i in list(pairs.first) + list(pairs.second)]

    # Claim: the octomap of a scene is a map of the world until a complete scene comes without one. While the octomap of a
    # message is refused, the map that was there goes on to answer, and the world is not complete.
    def test_the_octomap_of_a_scene_is_a_map(self):
        inside = self.noetic.scene()
        header, data = ROOM.read_bytes().split(b"data\n", 1)
        octomap = inside.world.octomap
        octomap.header.frame_id, octomap.origin.position.x, octomap.origin.orientation.w = "world", 50.0, 1.0
        octomap.octomap.binary, octomap.octomap.id = True, "OcTree"
        octomap.octomap.resolution = float(re.search(rb"\nres ([0-9.]+)", header).group(1))
        octomap.octomap.data = list(struct.unpack("%db" % len(data), data))
        self.assertTrue(self.apply(scene=inside).success)

        def maps():
            return {name for name in self.noetic.proximity.query_sphere((50, 0, 0), 20.0).names if name.startswith("map/")}

        self.assertEqual(maps(), {"map/planning_scene"})
        octomap.octomap.data = octomap.octomap.data[:-1]
        self.assertFalse(self.apply(scene=inside).success)
        self.assertTrue(self.noetic.world().complete, "the caller knows")
        self.noetic.send("planning_scene", "PlanningScene", inside)
        wait(lambda: self.noetic.world().incomplete == ["map/planning_scene"], "the gap")
        self.assertEqual(maps(), {"map/planning_scene"})
        self.noetic.planning_scene(is_diff=False)
        wait(lambda: self.noetic.world().complete, "the end of the gap")
        self.assertEqual(maps(), set())

    def test_a_refused_scene_changes_nothing(self):
        flat = sphere("flat", 1, 0.0)
        self.assertFalse(self.apply(scene=self.noetic.scene([sphere("good", 1), flat])).success)
        self.assertEqual(self.names(), ["crate"])

    def test_services_that_are_not_configured_are_not_offered(self):
        for name in ("get_planning_scene", "apply_planning_scene"):
            with self.assertRaises(rospy.ROSException):
                rospy.wait_for_service("/topics/" + name, 0.2)

    # Claim: while an object is missing because its message was refused, the world is not complete, and says why.
    def test_a_refused_message_makes_the_world_incomplete_until_it_is_mended(self):
        self.noetic.object(sphere("part", 1, 0.0))
        wait(lambda: not self.noetic.world().complete, "the gap")
        world = self.noetic.world()
        self.assertEqual(world.incomplete, ["obstacle"])
        self.assertTrue(any("obstacle/part" in reason and "radius" in reason for reason in world.reasons), world.reasons)
        self.assertTrue(self.noetic.proximity.query_sphere((1, 0, 0), 0.2).unknown)
        self.noetic.object(sphere("part", 1, 0.1))
        wait(lambda: self.noetic.world().complete, "the end of the gap")
        self.noetic.object(remove("nothing"))
        self.noetic.settled()
        self.assertTrue(self.noetic.world().complete, "nothing is missing if a removal is refused")

    def test_messages_that_are_cut_off_are_refused(self):
        before = self.topics.settled()
        self.topics.object(sphere("whole", 1))
        whole = io.BytesIO()
        sphere("cut", 2, frame="").serialize(whole)
        sizes = range(0, len(whole.getvalue()), 7)
        for size in sizes:
            message = Cut(id="cut", operation=ADD)
            message.primitives, message.primitive_poses = sphere("cut", 2).primitives, sphere("cut", 2).primitive_poses
            message.size = size
            self.topics.object(message)
        after = self.topics.settled()
        self.assertEqual(after["refused"] - before["refused"], len(sizes))
        self.assertEqual((self.topics.names_at(1), self.topics.names_at(2)), (["obstacle/whole"], []))

    # Claim: of a flood, every message that the node received was applied, refused or dropped, and the node answers.
    def test_a_flood_is_accounted_for(self):
        before = self.noetic.settled()
        generator = random.Random(1)
        messages = [sphere("part%d" % i, 20 + i) for i in range(20)] + [remove("part%d" % i) for i in range(20)]
        messages += [sphere("flat", 1, 0.0)]
        sent = 4000
        for _ in range(sent):
            self.noetic.object(generator.choice(messages))
        after = self.noetic.settled()
        self.assertGreater(after["applied"], before["applied"])
        self.assertGreater(after["refused"], before["refused"])
        self.assertEqual(after["dropped"], before["dropped"])


if __name__ == "__main__":
    rosunit.unitrun("hgrid_proximity", "moveit", MoveIt)
