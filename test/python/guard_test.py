#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""The service ~guard and the topic ~conflicts beside a running node. See turning_arm.py for the robot."""
import math
import threading
import unittest

import numpy
import rospy
import rosunit
from hgrid_proximity import obstacles, robots, srv
from hgrid_proximity.client import Proximity
from hgrid_proximity.errors import Refused
from hgrid_proximity.msg import Conflicts, Verdict
from moveit_types import Types
from sensor_msgs.msg import JointState
from turning_arm import TO_POST, Arm, wait

JOINTS = ["shoulder", "slide"]
TYPES = Types()
TYPES["DisplayTrajectory"]  # makes the classes of its parts, too
TYPES["actionlib_msgs/GoalStatusArray"]
STATUS = TYPES["actionlib_msgs/GoalStatus"]
TRAJECTORY, POINT = TYPES["trajectory_msgs/JointTrajectory"], TYPES["trajectory_msgs/JointTrajectoryPoint"]


def trajectory(*points, joints=JOINTS):
    """Returns a trajectory_msgs/JointTrajectory. Each point is its time [s] and its positions."""
    return TRAJECTORY(joint_names=joints, points=[POINT(time_from_start=rospy.Duration(seconds), positions=positions)
                                                  for seconds, *positions in points])


class Guard(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("guard_test")
        cls.arm = Arm()
        cls.proximity = Proximity("/proximity", timeout=60.0)
        cls.lock, cls.last = threading.Lock(), None
        cls.guard = rospy.ServiceProxy("/proximity/guard", srv.Guard)
        rospy.Subscriber("/proximity/conflicts", Conflicts, cls.take)
        wait(lambda: cls.proximity.pairs().usable, "a complete world", 120.0)

    @classmethod
    def take(cls, message):
        cls.last = message

    def follow(self, rows, seconds, robot="robot", **options):
        response = self.guard(robot=robot, joint_names=JOINTS, positions=[value for row in rows for value in row],
                              time_from_start=[rospy.Duration(second) for second in seconds], **options)
        self.assertTrue(response.success, response.code.text)
        return response

    def conflict(self, robot="robot"):
        """Returns the index of the conflict of a robot in the last message, or None."""
        message = self.last
        if message is None or robot not in message.robots:
            return None
        number = message.robots.index(robot)
        return next((i for i, of in enumerate(message.robot) if of == number), None)

    def tearDown(self):
        self.guard(robot="robot")
        wait(lambda: self.last is None or not self.last.robots, "an empty message")

    def test_a_free_path_is_clear_and_reported(self):
        response = self.follow([[0, 0.5], [1.0, 0.5]], [0, 4])
        self.assertEqual(response.verdict, Verdict.CLEAR)
        self.assertAlmostEqual(response.free_for, 10.0, delta=0.01)
        wait(lambda: self.last and self.last.robots == ["robot"], "the path")
        self.assertEqual((list(self.last.verdicts), self.last.first), ([Verdict.CLEAR], []))

    def test_a_conflict_has_its_pair_time_and_place(self):
        start = rospy.Time.now()
        response = self.follow([[0, 0.5], [3, 0.5]], [0, 6], start=start)
        touch = (TO_POST - 2 * math.asin(0.2)) / 3 * 6  # [s] until the arm touches the post
        self.assertEqual((response.verdict, response.first, response.second), (Verdict.HIT, "robot/arm", "obstacle/post"))
        self.assertAlmostEqual(response.free_for, touch, delta=0.3)
        self.assertAlmostEqual((response.at - start).to_sec(), touch, delta=0.01)
        self.assertAlmostEqual(math.hypot(response.point.x, response.point.y), 0.49, delta=0.03)
        wait(lambda: self.conflict() is not None, "the conflict")
        message, i = self.last, self.conflict()
        self.assertEqual((message.first[i], message.second[i]), ("robot/arm", "obstacle/post"))
        self.assertAlmostEqual((message.at[i] - start).to_sec(), touch, delta=0.01)
        self.assertAlmostEqual(math.hypot(message.point[i].x, message.point[i].y), 0.49, delta=0.03)

    # Claim: before `free_for` no sample of the path touches anything, and at `at` the robot does.
    def test_random_paths_agree_with_samples(self):
        random = numpy.random.default_rng(7)
        verdicts = {Verdict.CLEAR: 0, Verdict.HIT: 0}
        for number in range(40):
            times = numpy.cumsum(numpy.append(0, random.uniform(0.3, 3, random.integers(1, 5))))
            rows = numpy.cumsum(random.uniform(-1.5, 1.5, (len(times), 2)), axis=0)
            rows[:, 1] = random.uniform(0, 1, len(times))
            path = self.proximity.guard("robot", JOINTS, rows, times)
            now = path.response.world.valid_until - rospy.Duration(10)  # ~valid_for

            def touches(at):
                """Which of these times after `now` [s] have a contact?"""
                states = numpy.column_stack([numpy.interp(at, times, rows[:, joint]) for joint in range(2)])
                return self.proximity.check_states(JOINTS, states).hit

            with self.subTest(number=number, rows=rows.tolist(), times=times.tolist()):
                if path.free_for > 0:
                    self.assertFalse(touches(numpy.linspace(0, path.free_for, 500, endpoint=False)).any())
                if path.hit:
                    at = (path.at - now).to_sec()
                    self.assertGreaterEqual(at, path.free_for - 1e-6)
                    self.assertTrue(touches(at + numpy.linspace(0, 0.01, 20)).any())
                verdicts[path.response.verdict] += 1
        self.assertGreater(min(verdicts.values()), 5, verdicts)

    def test_the_python_client_says_what_the_service_says(self):
        free = self.proximity.guard("robot", JOINTS, [[0, 0.5], [1.0, 0.5]], [0, 4])
        self.assertEqual((free.clear, free.hit, free.unknown), (True, False, False))
        found = self.proximity.guard("robot", JOINTS, [[3, 0.5]], [6])
        self.assertEqual((found.hit, found.first, found.second), (True, "robot/arm", "obstacle/post"))
        lost = self.proximity.guard("robot", JOINTS, [[0, 5.0], [0, 5.0]], [0, 8])
        self.assertTrue(lost.unknown, lost)
        with self.assertRaises(Refused):
            self.proximity.guard("nobody", JOINTS, [[0, 5.0]], [1])
        with self.assertRaises(ValueError):
            self.proximity.guard("robot", JOINTS, [0, 5.0], [1])
        self.proximity.stop_guard("robot")
        wait(lambda: not self.last.robots, "an empty message")

    def test_a_robot_that_is_not_on_its_path_makes_it_unknown(self):
        response = self.follow([[0, 5.0], [0, 5.0]], [0, 8])
        self.assertEqual((response.verdict, response.free_for), (Verdict.UNKNOWN, 0.0))
        self.assertIn("joint 'slide' of robot 'robot' is at 0.25", response.reason)
        wait(lambda: self.last and self.last.reasons, "the reason")
        self.assertIn("joint 'slide' of robot 'robot' is at 0.25", self.last.reasons[0])

    def test_a_change_of_the_world_is_found(self):
        self.follow([[0, 0.5], [1.0, 0.5]], [0, 8])
        wait(lambda: self.last and self.last.robots and not self.last.first, "the free path")
        where = (0.5 * math.cos(0.9), 0.5 * math.sin(0.9), 0.0)
        self.proximity.apply_obstacles(obstacles.add("new", obstacles.sphere(0.05), position=where))
        try:
            wait(lambda: self.conflict() is not None, "the conflict")
            self.assertEqual(self.last.second[0], "obstacle/new")
            since = self.last.since[0]
            wait(lambda: self.last.header.stamp > since + rospy.Duration(0.3), "a later message")
            self.assertEqual(self.last.since[0], since)
        finally:
            self.proximity.apply_obstacles(obstacles.remove("new"))
        wait(lambda: self.last.robots and not self.last.first, "the free path")

    # Claim: two robots whose paths cross conflict only if they are at the same place at the same time.
    def test_paths_of_two_robots_are_compared_by_time(self):
        self.arm.twin_at = 3.0
        self.proximity.apply_robots(robots.add("twin", like="robot"))
        try:
            wait(lambda: self.proximity.pairs().usable, "the frames of the twin")
            start = rospy.Time.now()
            # The hands are 1.5 m from their bases, so both are at x = 1.5 m when the arms face each other.
            sweep, back = [[-1, 0.5], [1, 0.5]], [[math.pi + 1, 0.5], [math.pi - 1, 0.5]]
            self.follow(sweep, [2, 4], start=start)
            late = self.follow(back, [6, 8], robot="twin", start=start)
            self.assertEqual(late.verdict, Verdict.CLEAR, "the twin is at another angle at that time")
            same = self.follow(back, [2, 4], robot="twin", start=start)
            self.assertEqual(same.verdict, Verdict.HIT)
            wait(lambda: self.conflict("twin") is not None and self.conflict("robot") is not None, "both conflicts")
            i = self.conflict("twin")
            self.assertEqual((self.last.first[i], self.last.second[i]), ("twin/hand", "robot/hand"))
        finally:
            self.guard(robot="twin")
            self.proximity.apply_robots(robots.remove("twin"))
            self.arm.twin_at = None

    def publish(self, topic, message):
        """Publishes a message when the node is there to receive it. Returns the time before that."""
        publisher = rospy.Publisher(topic, type(message), queue_size=1)
        wait(lambda: publisher.get_num_connections() > 0, "a subscriber of " + topic)
        before = rospy.Time.now()
        publisher.publish(message)
        self.addCleanup(publisher.unregister)
        return before

    # Claim: a robot that is switched off takes its path with it, and hides no conflict of the others.
    def test_a_robot_that_is_absent_hides_no_conflict(self):
        self.arm.twin_at = 3.0
        self.proximity.apply_robots(robots.add("twin", like="robot"))
        try:
            wait(lambda: self.proximity.pairs().usable, "the frames of the twin")
            self.follow([[0, 0.5], [3, 0.5]], [0, 30])
            self.follow([[0, 0.5], [0.5, 0.5]], [0, 30], robot="twin")
            wait(lambda: self.last.robots == ["robot", "twin"] and self.conflict() is not None, "both paths")
            self.proximity.apply_robots(robots.absent("twin"))
            wait(lambda: self.last.robots == ["robot"], "the path of the robot alone")
            self.assertIsNotNone(self.conflict())
        finally:
            self.proximity.apply_robots(robots.remove("twin"))
            self.arm.twin_at = None

    # Claim: a message of each type is read, and a robot that must first go to the start of its path is watched there.
    def test_paths_are_taken_from_topics(self):
        touch = (TO_POST - 2 * math.asin(0.2)) / 3 * 6  # [s]
        path = trajectory((6, 3, 0.25), (8, 3, 0.25))
        goal = TYPES["control_msgs/FollowJointTrajectoryActionGoal"]()
        goal.goal.trajectory = path
        messages = [("arm/command", path), ("arm/goal", goal)]
        # Its parts follow one another. The second one moves another joint.
        parts = [trajectory((6, 3), joints=["shoulder"]), trajectory((0, 0.25), (2, 0.3), joints=["slide"])]
        display = TYPES["DisplayTrajectory"]()
        display.trajectory = [TYPES["RobotTrajectory"](joint_trajectory=part) for part in parts]
        messages.append(("display", display))
        for topic, message in messages:
            with self.subTest(topic=topic, type=message._md5sum):
                start = self.publish(topic, message)
                wait(lambda: self.conflict() is not None, "the conflict")
                at, second = self.last.at[self.conflict()], self.last.second[self.conflict()]
                self.assertEqual(second, "obstacle/post")
                self.assertAlmostEqual((at - start).to_sec(), touch, delta=0.3)
                self.publish(topic, type(message)())  # without points: the robot stops
                wait(lambda: not self.last.robots, "an empty message")

    # Claim: the joints of two topics move at the same time. Either of these paths alone would be free.
    def test_paths_from_two_topics_are_joined(self):
        self.publish("arm/command", trajectory((6, -2), joints=["shoulder"]))
        wait(lambda: self.last and list(self.last.verdicts) == [Verdict.CLEAR], "a free path")
        self.publish("hand/command", trajectory((0.5, 0.5), (9, 0.5), joints=["slide"]))
        wait(lambda: self.conflict() is not None, "the conflict")
        self.assertEqual((self.last.first[0], self.last.second[0]), ("robot/hand", "obstacle/wall"))

    # Claim: a path that starts later does not hide where the robot moves until then.
    def test_a_later_path_leaves_the_present_one_until_it_starts(self):
        start = self.publish("arm/command", trajectory((6, 3, 0.25), (30, 3, 0.25)))
        wait(lambda: self.conflict() is not None, "the conflict")
        at = self.last.at[self.conflict()]
        later = trajectory((1, 0, 0.25), (8, 0, 0.25))
        later.header.stamp = start + rospy.Duration(9)
        sent = self.publish("arm/command", later)
        wait(lambda: self.last.header.stamp > sent + rospy.Duration(0.5), "a later message")
        self.assertIsNotNone(self.conflict())
        self.assertAlmostEqual((self.last.at[self.conflict()] - at).to_sec(), 0.0, delta=0.3)

    # Claim: a message that names one joint leaves the path of the other one as it is.
    def test_a_message_replaces_the_paths_of_its_joints_only(self):
        self.publish("arm/command", trajectory((6, 3, 0.25), (30, 3, 0.25)))
        wait(lambda: self.conflict() is not None, "the conflict")
        sent = self.publish("arm/command", trajectory((8, 0.25), joints=["slide"]))
        wait(lambda: self.last.header.stamp > sent + rospy.Duration(0.3), "a later message")
        self.assertIsNotNone(self.conflict())

    def goal(self, name, path):
        goal = TYPES["control_msgs/FollowJointTrajectoryActionGoal"]()
        goal.goal_id.id, goal.goal.trajectory = name, path
        self.publish("arm/goal", goal)

    def status(self, name, status):
        array = TYPES["actionlib_msgs/GoalStatusArray"]()
        array.status_list = [STATUS(status=status)]
        array.status_list[0].goal_id.id = name
        self.publish("arm/status", array)

    # Claim: the node follows what becomes of a goal: it is accepted, replaced by a command, canceled or refused.
    def test_goals_are_followed_until_they_end(self):
        to_post, free = trajectory((6, 3, 0.25), (30, 3, 0.25)), trajectory((0.5, 0.3, 0.25), (1, 0.3, 0.25))
        verdict = lambda *verdicts: self.last and tuple(self.last.verdicts) == verdicts
        self.status("unseen", STATUS.ACTIVE)
        wait(lambda: verdict(Verdict.UNKNOWN) and "did not receive it" in self.last.reasons[0], "the unseen goal")
        self.goal("first", trajectory((8, 0.3, 0.25)))
        wait(lambda: verdict(Verdict.UNKNOWN) and "not accepted yet" in self.last.reasons[0], "the goal")
        self.status("first", STATUS.ACTIVE)
        wait(lambda: verdict(Verdict.CLEAR), "the accepted goal")
        self.goal("second", to_post)
        wait(lambda: verdict(Verdict.HIT), "the conflict")
        self.status("second", STATUS.REJECTED)
        wait(lambda: verdict(Verdict.CLEAR) or verdict(Verdict.UNKNOWN), "the path of the first goal")
        self.goal("third", to_post)
        self.status("third", STATUS.ACTIVE)
        wait(lambda: verdict(Verdict.HIT), "the conflict of the third goal")
        self.publish("arm/command", free)
        wait(lambda: verdict(Verdict.CLEAR), "the command instead of the goal")
        wait(lambda: verdict(), "an empty message, and no conflict of the goal that was replaced")
        self.goal("fourth", to_post)
        self.status("fourth", STATUS.ACTIVE)
        wait(lambda: verdict(Verdict.HIT), "the conflict of the fourth goal")
        self.publish("arm/cancel", TYPES["actionlib_msgs/GoalID"](id="fourth"))
        result = TYPES["control_msgs/FollowJointTrajectoryActionResult"]()
        result.status.goal_id.id, result.status.status = "fourth", STATUS.PREEMPTED
        self.publish("arm/result", result)
        wait(lambda: verdict(), "an empty message")

    # Claim: on tf, -2.78 and 3.5 rad look alike. Joint states tell at which turn a joint is; without them nobody knows.
    def test_joint_states_tell_full_turns_apart(self):
        urdf = """<robot name='w'><link name='base'/>
          <link name='arm'><collision><origin xyz='0.5 0 0'/><geometry><sphere radius='0.1'/></geometry>
          </collision></link>
          <joint name='wrist' type='revolute'><parent link='base'/><child link='arm'/><axis xyz='0 0 1'/>
          <limit lower='-6.28' upper='6.28' effort='1' velocity='3'/></joint></robot>"""
        self.arm.extra = [("world", "wide/base", 9.0, 0.0), ("wide/base", "wide/arm", 0.0, 3.5)]
        self.proximity.apply_obstacles(obstacles.add("far", obstacles.sphere(0.1), position=(9.5, 0, 0)))
        self.proximity.apply_robots(robots.add("wide", urdf=urdf))
        states = rospy.Publisher("/wide/joint_states", JointState, queue_size=1)
        try:
            wait(lambda: self.proximity.pairs().usable, "the frames of the robot")

            def verdict(told):
                for value in told:
                    states.publish(JointState(name=["wrist"], position=[value]))
                path = self.proximity.guard("wide", ["wrist"], [[3.5], [3.5]], [5, 30])
                return path.response.verdict

            self.assertEqual(verdict([]), Verdict.UNKNOWN)
            wait(lambda: states.get_num_connections() > 0, "a subscriber of the joint states")
            wait(lambda: verdict([3.5]) == Verdict.CLEAR, "a free path")
            wait(lambda: verdict([3.5 - 2 * math.pi]) == Verdict.HIT, "the conflict on the way around")
        finally:
            self.guard(robot="wide")
            self.proximity.apply_robots(robots.remove("wide"))
            self.proximity.apply_obstacles(obstacles.remove("far"))
            self.arm.extra = []

    # Claim: a message whose times are all over changes nothing, as controllers ignore it.
    def test_a_path_of_the_past_is_ignored(self):
        self.publish("arm/command", trajectory((6, 3, 0.25), (30, 3, 0.25)))
        wait(lambda: self.conflict() is not None, "the conflict")
        past = trajectory((1, 0, 0.25))
        past.header.stamp = rospy.Time.now() - rospy.Duration(10)
        sent = self.publish("arm/command", past)
        wait(lambda: self.last.header.stamp > sent + rospy.Duration(0.5), "a later message")
        self.assertIsNotNone(self.conflict())

    # Claim: a robot that has not arrived when its path ends may still move.
    def test_a_path_ends_when_the_robot_has_arrived(self):
        self.follow([[0, 0.25], [0, 5.0]], [0, 1])
        end = rospy.Time.now() + rospy.Duration(1.5)
        wait(lambda: self.last and self.last.header.stamp > end, "a later message")
        self.assertEqual((self.last.robots, list(self.last.verdicts)), (["robot"], [Verdict.UNKNOWN]))
        self.assertIn("slide", self.last.reasons[0])

    # Claim: a joint without limits goes the way that its path says, even if it is the longer one.
    def test_a_long_turn_is_checked_on_the_way_that_the_path_takes(self):
        self.assertEqual(self.follow([[0, 0.5], [0.78, 0.5]], [0, 8]).verdict, Verdict.CLEAR)
        around = self.follow([[0, 0.5], [0.78 - 2 * math.pi, 0.5]], [0, 8])
        self.assertEqual((around.verdict, around.second), (Verdict.HIT, "obstacle/wall"))

    # Claim: after a message that cannot be read, nobody knows where the robot moves, until the next one.
    def test_a_path_that_cannot_be_read_makes_it_unknown(self):
        cases = [(trajectory((1, 1), joints=["elbow"]), "UNKNOWN_ID"), (trajectory((1, 1)), "OUT_OF_RANGE"),
                 (trajectory((1, math.nan, 0)), "NONFINITE"), (trajectory((1, 1, 1), (1, 1, 1)), "OUT_OF_RANGE"),
                 (trajectory((-1, 1, 1)), "OUT_OF_RANGE"), (trajectory((90000, 1, 1)), "OUT_OF_RANGE"),
                 (trajectory((1, 0, 0), joints=["slide", "slide"]), "CONFLICT"),
                 (trajectory((1, 0, 0), (2, 1e6, 0)), "OUT_OF_RANGE")]
        for topic, message, code in [("arm/command", *case) for case in cases] + [("other", Conflicts(), "UNSUPPORTED")]:
            with self.subTest(code=code, message=message):
                self.publish(topic, message)
                wait(lambda: self.last and self.last.reasons and code in self.last.reasons[0], "the reason")
                self.assertEqual(list(self.last.verdicts), [Verdict.UNKNOWN])
                self.assertIn(topic, self.last.reasons[0])
        self.guard(robot="robot")  # forgets the paths of all topics
        self.publish("arm/command", trajectory((1, 0.1, 0.25), (8, 0.1, 0.25)))
        wait(lambda: list(self.last.verdicts) == [Verdict.CLEAR], "the free path")

    def test_an_invalid_path_is_refused_by_name(self):
        def refused(code, words, **request):
            response = self.guard(**dict(dict(robot="robot", joint_names=JOINTS), **request))
            self.assertEqual((response.success, response.code.name), (False, code))
            self.assertIn(words, response.code.text)

        seconds = lambda *all: [rospy.Duration(second) for second in all]
        refused("UNKNOWN_ID", "nobody", robot="nobody", positions=[0, 0], time_from_start=seconds(1))
        refused("CONFLICT", "twice", joint_names=["slide", "robot/slide"], positions=[0, 0], time_from_start=seconds(1))
        refused("UNKNOWN_ID", "elbow", joint_names=["elbow"], positions=[0], time_from_start=seconds(1))
        refused("OUT_OF_RANGE", "3 positions", positions=[0, 0, 0], time_from_start=seconds(1))
        refused("OUT_OF_RANGE", "point 1", positions=[0, 0, 0, 0], time_from_start=seconds(1, 1))
        refused("NONFINITE", "slide", positions=[0, math.nan], time_from_start=seconds(1))
        refused("OUT_OF_RANGE", "before now", positions=[0, 0], time_from_start=seconds(1), start=rospy.Time(1))


if __name__ == "__main__":
    rosunit.unitrun("hgrid_proximity", "guard", Guard)
