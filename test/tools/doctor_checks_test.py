#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Tests the checks of the doctor with invented facts. It must find each cause and report it once. Needs no ROS."""
import json
import pathlib
import re
import shlex
import sys
import unittest
from types import SimpleNamespace

import yaml

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "support"))

from sound_facts import (  # noqa: E402  (the path comes first)
    SRDF, UNIT, URDF, NodeFacts, RobotFacts, RobotSettings, Settings, TopicFacts, body, counter, parse_srdf, parse_urdf,
    sound, source, status, stream,
)

from hgrid_doctor import report  # noqa: E402
from hgrid_doctor.checks import diagnose  # noqa: E402
from hgrid_doctor.facts import LOST, STALE, UNPLACED, JointValue, MeshError, MeshFlaw, Touch  # noqa: E402
from hgrid_doctor.finding import EXIT_ERROR, EXIT_OK, EXIT_WARN, exit_code  # noqa: E402
from hgrid_doctor.settings import InputSettings, read_settings  # noqa: E402

NO_PACKAGE = MeshError(MeshFlaw.NO_PACKAGE, "there is no package 'arm_meshes'")
PROGRAMS = {
    *("cp", "date", "echo", "export", "grep", "pgrep", "source", "top", "unset", "xacro"),
    *("rosbag", "roscore", "roslaunch", "rosnode", "rospack", "rosparam", "rosrun", "rosservice", "rostopic"),
}
MOVED = (1.0, *UNIT[1:])  # a pose other than UNIT


class DoctorChecks(unittest.TestCase):
    def setUp(self):
        self.facts = sound()

    def expect(self, *names, code=EXIT_ERROR):
        """Checks the names of all findings and their order. @returns the first finding"""
        findings = diagnose(self.facts)
        self.assertEqual([finding.name for finding in findings], list(names), findings)
        self.assertEqual(exit_code(findings), code if names else EXIT_OK)
        for finding in findings:
            self.assertTrue(finding.what.endswith(".") and finding.fix.endswith("."), finding)
            for text in re.findall("`([^`]+)`", finding.fix):
                self.check_typed(text)
        return findings[0] if findings else None

    def check_typed(self, text):
        """Checks a text in backticks: XML, a line of YAML, or a command that needs only ROS and a usual system."""
        if re.match(r"\w+: ", text):
            self.assertIsInstance(yaml.safe_load(text), dict)
        elif not text.startswith("<param "):
            words = [word for word in shlex.split(text) if "=" not in word.partition(":=")[0]]
            self.assertIn(words[0], PROGRAMS, text)

    def unplace(self, *links, state=UNPLACED):
        """Removes the poses of these links from the node, and their frames from tf."""
        self.facts.streams = [each for each in self.facts.streams if each.child not in links]
        self.break_source("robot", f"UNPLACED robot/{links[0]}")
        self.facts.status.bodies = [body(f"robot/{link}", state) for link in links]

    def break_source(self, name, reason):
        kept = [each for each in self.facts.status.sources if each.name != name]
        self.facts.status.sources = [*kept, source(name, complete=False, state=UNPLACED, reason=reason)]
        self.facts.status.world.complete = False
        self.facts.status.world.incomplete_total = 1

    def add_input(self, name, reason, **settings):
        parameter = name.partition("/")[0] + "s"
        self.facts.settings.values = {parameter: [{"name": name.partition("/")[2], **settings}]}
        self.facts.settings.inputs = [
            InputSettings(name, type="sensor_msgs/PointCloud2", parameter=parameter, **settings)
        ]
        self.break_source(name, reason)

    def without_node(self):
        self.facts.host, self.facts.status, self.facts.first_status = "", None, None
        del self.facts.nodes["/proximity"]
        del self.facts.graph.publishers["/proximity/status"]

    def test_nothing_is_wrong_with_a_sound_system(self):
        self.expect()
        text = report.as_text(self.facts, [], False, False)
        self.assertIn("robot robot: 4 links, 3 with shapes, in 3 frames; all placed, FRESH, poses 10 ms old", text)
        self.assertIn("refused so far: nothing", text)
        self.assertTrue(text.endswith("OK: nothing wrong was found with /proximity."), text)

    def test_each_finding_is_tested_here_and_its_fix_is_typed_or_has_a_reason_not_to_be(self):
        tests = pathlib.Path(__file__).resolve().parent
        checks = (tests.parents[1] / "tools/hgrid_doctor/checks").glob("*.py")
        names = {name for file in checks for name in re.findall(r'findings\.add\(\s*"(\w+)"', file.read_text())}
        self.assertGreater(len(names), 40)
        for test in ("doctor_checks_test.py", "doctor_systems_test.py"):
            text = (tests / test).read_text()
            self.assertEqual([name for name in sorted(names) if f'"{name}' not in text], [], test)

    # The network and the node

    def test_without_a_master_nothing_else_is_said(self):
        self.facts.graph.error = "Connection refused"
        self.facts.environment.master_uri = "http://host:12345/"
        self.facts.environment.own_name_error = "it cannot be resolved"
        self.assertIn("`roscore -p 12345`", self.expect("no_master", "bad_own_address").fix)
        self.facts.environment.master_uri = "http://host:11311"
        self.assertIn("`roscore`", self.expect("no_master", "bad_own_address").fix)

    def test_a_host_that_cannot_be_resolved_is_told_once_for_all_its_nodes(self):
        for name in ("/rsp", "/driver"):
            self.facts.nodes[name] = NodeFacts(name, "http://robot:1/", "robot", "Name or service not known")
        self.assertIn("'/driver', '/rsp'", self.expect("unknown_host").what)

    def test_a_wrong_own_address_is_a_warning(self):
        self.facts.environment.own_name_error = "it is no address of this computer"
        self.facts.environment.address_towards_master = "10.0.0.7"
        fix = self.expect("bad_own_address", code=EXIT_WARN).fix
        self.assertIn("`unset ROS_HOSTNAME; export ROS_IP=10.0.0.7`", fix)

    def test_no_node(self):
        self.without_node()
        self.expect("node_not_running")

    def test_no_node_of_this_name_but_another(self):
        self.without_node()
        self.facts.others = ["/cell/prox"]
        self.assertIn("/cell/prox", self.expect("node_not_running").what)

    def test_a_node_that_does_not_answer(self):
        self.facts.nodes["/proximity"].error = "Connection refused"
        self.facts.status = self.facts.first_status = None
        self.expect("node_gone")

    def test_a_node_that_starts_again_and_again(self):
        self.facts.pid_after = 77
        self.assertIn("77", self.expect("node_restarts").what)

    def test_a_node_that_is_no_proximity_node(self):
        self.facts.status = self.facts.first_status = None
        self.facts.graph.publishers["/proximity/status"] = []
        self.expect("not_a_proximity_node")

    def test_a_node_of_another_version(self):
        self.facts.status = self.facts.first_status = None
        self.facts.status_error = "it sends hgrid_proximity/Status with md5sum 1, not 2"
        self.expect("other_version")

    def test_a_node_whose_status_is_silent(self):
        self.facts.status = self.facts.first_status = None
        self.expect("status_silent")

    # The clock

    def test_simulated_time_explains_everything(self):
        self.facts.graph.use_sim_time = True
        self.unplace("elbow", "hand")
        self.facts.streams = []
        self.expect("no_clock")
        self.facts.graph.publishers["/clock"] = ["/gazebo"]
        self.expect("clock_silent")
        self.facts.clock = [5.0, 5.0, 5.0]
        self.expect("clock_stands_still")

    def test_simulated_time_that_runs(self):
        self.facts.graph.use_sim_time = True
        self.facts.graph.publishers["/clock"] = ["/gazebo"]
        self.facts.clock = [4.0, 5.0]
        self.facts.status.made = status(made=5.0).made
        self.expect()

    def test_a_node_that_started_before_simulated_time_was_set(self):
        self.facts.graph.use_sim_time = True
        self.facts.graph.publishers["/clock"] = ["/gazebo"]
        self.facts.clock = [4.0, 5.0]
        self.facts.status.made = status(made=1.7e9).made
        self.expect("node_on_other_clock")

    def test_a_clock_that_nobody_uses(self):
        self.facts.graph.publishers["/clock"] = ["/gazebo"]
        self.facts.clock = [4.0, 5.0]
        self.expect("clock_unused", code=EXIT_WARN)
        self.facts.streams[0].offsets = self.facts.streams[1].offsets = [-1.7e9] * 50
        self.expect("clock_unused")

    def test_clocks_that_differ_explain_everything(self):
        self.facts.graph.publishers["/clock"] = ["/gazebo"]
        self.facts.clock = [4.0, 5.0]
        self.break_source("obstacle", "UNPLACED obstacle/crate")
        self.facts.streams[0].offsets = self.facts.streams[1].offsets = [-1.7e9] * 50
        self.assertIn("simulated stamps", self.expect("clock_unused").what)
        self.facts.graph.publishers.pop("/clock")
        self.facts.clock = []
        self.facts.status.made, self.facts.wall = status(made=5.0).made, 1.7e9
        for each in self.facts.streams:
            each.offsets = [0.0] * len(each.offsets)
        self.assertIn("uses a simulated clock", self.expect("node_on_other_clock").what)

    # Descriptions

    def test_a_robot_that_was_declared_absent_needs_nothing(self):
        other = RobotFacts(RobotSettings("other", "/other_description", "", "other"))
        self.facts.robots.append(other)
        self.facts.status.absent_robots = ["other"]
        self.facts.status.sources_total = 2  # sources may be cut off, so it is not known whether the robot is one
        self.facts.forget_robots_that_left()
        self.expect("no_description")
        self.facts.status.sources_total = 1
        self.facts.forget_robots_that_left()
        self.expect()
        self.assertIn("declared absent with ~apply_robots: 'other'", report.as_text(self.facts, [], False, False))

    def test_no_description(self):
        self.facts.robots[0].key, self.facts.robots[0].description = "", None
        self.expect()  # the node has loaded the description under another name
        self.break_source("robot", "NOT_READY robot 'robot': parameter 'robot_description' is not set")
        self.facts.status.sources[0].bodies = 0
        self.facts.robots[0].candidates = ["/arm/robot_description"]
        self.facts.robots[0].semantic_key = ""
        fix = self.expect("no_description").fix
        self.assertIn("`robots: [{name: robot, description: /arm/robot_description}]`", fix)
        self.facts.parameters = {"/arm/robot_description_semantic"}
        self.assertIn("semantic: /arm/robot_description_semantic}]`", self.expect("no_description").fix)
        self.break_source("obstacle", "")  # it waits for the world, whose frame is the root of the robot
        self.expect("no_description")
        self.facts.robots[0].candidates = []
        self.assertIn("`rosparam set -t my_robot.urdf /robot_description`", self.expect("no_description").fix)

    def test_texts_that_are_no_description(self):
        namespace = 'xmlns:xacro="http://ros.org/wiki/xacro"'
        texts = {
            "xacro": ["<robot><xacro:a/></robot>", f"<robot {namespace}><xacro:a/></robot>", '<robot name="${n}"/>'],
            "not_text": ["", " ", 5, ["a"]],
            "not_xml": ["arm.urdf", "<robot>"],
            "not_robot": ["<sdf/>"],
        }
        self.break_source("robot", "PARSE")
        for flaw, examples in texts.items():
            for text in examples:
                with self.subTest(text=text):
                    self.facts.robots[0].description = parse_urdf(text)
                    self.expect("bad_description_" + flaw)

    def test_an_expanded_xacro_may_still_declare_its_namespace(self):
        text = URDF.replace('name="arm"', 'name="arm" xmlns:xacro="http://ros.org/wiki/xacro"', 1)
        self.facts.robots[0].description = parse_urdf(text)
        self.expect()

    def test_a_robot_without_collision(self):
        self.facts.robots[0].description = parse_urdf(URDF.replace("collision>", "visual>"))
        self.break_source("robot", "UNCOVERED")
        self.expect("no_collision")
        self.facts.settings.use_visual = ["robot/*"]
        self.facts.status = status()
        self.expect()

    def test_a_link_that_is_only_seen(self):
        text = URDF.replace('<link name="tip"/>', '<link name="tip"><visual/></link>')
        self.facts.robots[0].description = parse_urdf(text)
        self.expect("links_without_collision", code=EXIT_WARN)

    def test_a_missing_package_is_told_once_for_all_its_meshes(self):
        self.break_source("robot", "UNCOVERED robot/hand")
        self.facts.status.uncovered = ["robot/hand: RESOURCE_MISSING"]
        uris = [f"package://arm_meshes/{number}.stl" for number in range(30)]
        self.facts.robots[0].mesh_errors = {uri: NO_PACKAGE for uri in uris}
        self.assertIn("30 mesh files", self.expect("no_mesh_package").what)
        self.facts.robots[0].mesh_errors = {uris[0]: MeshError(MeshFlaw.UNREADABLE, "there is no file /x/0.stl")}
        self.expect("bad_mesh")

    def test_meshes_outside_of_packages_are_allowed_by_their_folders(self):
        self.break_source("robot", "UNCOVERED robot/hand")
        self.facts.status.uncovered = ["robot/hand: RESOURCE_DENIED"]
        self.facts.settings.mesh_roots = ["/old"]
        uris = ("file:///my%20meshes/a.stl", "file:///my%20meshes/b.stl")
        self.facts.robots[0].mesh_errors = {uri: MeshError(MeshFlaw.OUTSIDE, "") for uri in uris}
        self.assertIn("`mesh_roots: [/old, /my meshes]`", self.expect("mesh_outside").fix)

    def test_meshes_that_only_this_shell_finds_are_no_reason_for_a_waiver(self):
        self.break_source("robot", "UNCOVERED robot/hand")
        self.facts.status.uncovered = ["robot/hand: RESOURCE_MISSING: there is no package 'arm_meshes'"]
        finding = self.expect("no_mesh_package")
        self.assertIn("though this shell does", finding.what)
        self.assertIn("Start the node where the workspace of these files is sourced", finding.fix)

    def test_meshes_that_the_node_can_read_are_not_reported(self):
        self.facts.robots[0].mesh_errors = {"package://arm_meshes/hand.stl": NO_PACKAGE}
        self.expect()

    # SRDF

    def test_the_srdf_of_another_robot(self):
        self.facts.status.model_warnings = ["robot: disable_collisions names link 'x', which robot 'arm' does not have"]
        other = SRDF.replace('"arm"', '"ur5"')
        self.facts.robots[0].semantic = parse_srdf(other.replace("base", "x").replace("hand", "y"))
        self.expect("srdf_of_other_robot")
        self.facts.robots[0].semantic = parse_srdf(SRDF.replace("base", "x"))
        self.expect("srdf_unknown_links", code=EXIT_WARN)
        self.facts.status.model_warnings = []
        self.facts.robots[0].semantic = parse_srdf(other)
        self.expect("srdf_other_name", code=EXIT_WARN)

    def test_an_srdf_that_is_missing_or_no_xml(self):
        self.facts.robots[0].semantic = None
        self.expect()  # the SRDF may be missing if no parameter names it
        self.facts.robots[0].settings.semantic = "my_srdf"
        self.expect("no_srdf", code=EXIT_WARN)
        self.facts.robots[0].semantic = parse_srdf("<robot>")
        self.break_source("robot", "PARSE")
        self.expect("bad_srdf")

    def test_an_srdf_of_another_name_with_unknown_links_is_of_another_robot(self):
        rule = '<disable_collisions link1="elbow" link2="flange"/></robot>'
        self.facts.robots[0].semantic = parse_srdf(SRDF.replace('"arm"', '"ur5"').replace("</robot>", rule))
        self.expect("srdf_of_other_robot")

    def test_a_missing_srdf_is_told_once(self):
        self.facts.robots[0].semantic = None
        self.facts.robots[0].settings.semantic = "my_srdf"
        self.facts.status.model_warnings = ["robot: parameter 'my_srdf' is not set; it was to hold the SRDF"]
        self.expect("no_srdf", code=EXIT_WARN)
        self.facts.robots[0].semantic = parse_srdf("<robot>")
        self.expect("bad_srdf")

    # Frames

    def test_no_state_publisher(self):
        self.unplace("elbow", "hand")
        self.facts.streams = []
        self.facts.graph.publishers["/tf"] = self.facts.graph.publishers["/tf_static"] = []
        self.assertIn("nobody publishes /tf", self.expect("no_state_publisher").what)

    def test_no_state_publisher_is_found_without_the_node_too(self):
        self.without_node()
        self.facts.streams = []
        self.facts.graph.publishers["/tf"] = self.facts.graph.publishers["/tf_static"] = []
        self.expect("node_not_running", "no_state_publisher")

    def test_a_state_publisher_that_is_gone(self):
        self.unplace("elbow", "hand")
        self.facts.streams = []
        self.facts.nodes["/rsp"].error = "Connection refused"
        self.expect("state_publisher_gone")

    def test_joint_states(self):
        self.unplace("elbow", "hand")
        self.facts.joints = {}
        self.expect("joint_states_silent")
        self.facts.graph.publishers["/joint_states"] = []
        self.expect("no_joint_states")

    def test_joint_states_that_lack_a_joint(self):
        self.unplace("hand")
        del self.facts.joints["/joint_states"]["bend"]
        self.assertIn("'bend'", self.expect("joint_states_incomplete").what)

    def set_joints(self, **positions):
        self.facts.joints["/joint_states"] = {name: JointValue(value, 1) for name, value in positions.items()}

    def test_a_joint_that_follows_a_follower_whose_name_comes_later(self):
        mimics = {"bend": "zoom", "zoom": "turn"}
        text = URDF.replace('<joint name="weld"', '<joint name="zoom" type="prismatic"><parent link="base"/>'
                            '<child link="lens"/></joint><link name="lens"/><joint name="weld"')
        for name, leader in mimics.items():
            mimic = f'<mimic joint="{leader}" multiplier="2" offset="0.1"/>'
            text = re.sub(f'(<joint name="{name}".*?)</joint>', rf"\g<1>{mimic}</joint>", text, flags=re.S)
        self.facts.robots[0].description = parse_urdf(text)
        self.unplace("hand")
        self.set_joints(turn=0.0)
        finding = self.expect("mimic_of_mimic")
        self.assertIn("joint 'bend' follows 'zoom'", finding.what)
        self.assertIn("let 'bend' follow 'turn', with multiplier 4 and offset 0.3", finding.fix)
        self.facts.robots[0].description = parse_urdf(text.replace("zoom", "axis"))  # it comes before "bend"
        self.assertIn("refuses their stamps", self.expect("state_publisher_silent").what)

    def test_a_joint_that_does_not_follow_its_rule(self):
        follow = '<mimic joint="turn" multiplier="2"/></joint>'
        self.facts.robots[0].description = parse_urdf(re.sub('(name="bend".*?)</joint>', rf"\1{follow}", URDF))
        self.set_joints(turn=0.5, bend=1.005)
        self.expect()
        self.set_joints(turn=0.5, bend=0.5)
        what = self.expect("mimic_differs", code=EXIT_WARN).what
        self.assertIn("'bend' of robot 'robot' is at 0.5 on /joint_states", what)
        self.facts.joints["/joint_states"]["bend"] = JointValue(0.5, 2)  # another message
        self.expect()
        self.set_joints(turn=0.5, bend=float("nan"))
        self.expect()

    def test_a_planar_joint_that_is_sent_as_a_fixed_one(self):
        text = URDF.replace('name="turn" type="revolute"', 'name="turn" type="planar"')
        self.facts.robots[0].description = parse_urdf(text)
        self.expect()
        self.facts.streams[0].static = True
        self.facts.status.bodies = [body("robot/elbow", UNPLACED), body("robot/hand", UNPLACED)]
        self.break_source("robot", "UNPLACED robot/elbow")
        finding = self.expect("static_free_joint")
        self.assertIn("the planar joint 'turn' of robot 'robot'", finding.what)
        self.assertIn("Publish the pose of 'elbow' in 'base' on /tf", finding.fix)

    def test_a_state_publisher_of_another_description(self):
        self.unplace("elbow", "hand")
        self.expect("state_publisher_silent")

    def test_another_tf_prefix(self):
        self.unplace("elbow", "hand")
        self.facts.streams = [stream("/rsp", "left/base", "left/elbow"), stream("/rsp", "left/elbow", "left/hand")]
        fix = self.expect("wrong_tf_prefix").fix
        semantic = "semantic: /robot_description_semantic, tf_prefix: left"
        self.assertIn(f"`robots: [{{name: robot, description: /robot_description, {semantic}}}]`", fix)

    def test_a_world_frame_that_is_unknown(self):
        self.facts.status.header.frame_id = "map"
        self.unplace("tip", state=LOST)
        self.facts.status.bodies = [body(f"robot/{link}", UNPLACED) for link in ("base", "elbow", "hand")]
        self.assertIn("`world_frame: base`", self.expect("wrong_world_frame").fix)
        self.facts.graph.publishers["/tf"].append("/odometry")
        self.facts.nodes["/odometry"] = NodeFacts("/odometry", error="Connection refused")
        self.expect("tf_publisher_gone")

    def test_a_world_frame_that_no_longer_comes(self):
        self.facts.status.header.frame_id = "map"
        self.break_source("robot", "LOST robot/base")
        self.facts.status.bodies = [body(f"robot/{link}", LOST) for link in ("base", "elbow", "hand")]
        self.expect("world_frame_lost")

    def test_two_trees(self):
        self.test_a_world_frame_that_is_unknown()
        del self.facts.nodes["/odometry"]
        self.facts.graph.publishers["/tf"].remove("/odometry")
        self.facts.streams.append(stream("/amcl", "map", "odom"))
        self.expect("two_trees")

    def test_one_world_frame_for_two_robots_is_told_once(self):
        self.test_a_world_frame_that_is_unknown()
        self.facts.nodes.pop("/odometry")
        self.facts.graph.publishers["/tf"].remove("/odometry")
        right = RobotFacts(RobotSettings("right", tf_prefix="right"), "/right", [], parse_urdf(URDF))
        self.facts.robots.append(right)
        self.facts.streams.append(stream("/rsp2", "right/base", "right/elbow"))
        self.facts.streams.append(stream("/rsp2", "right/elbow", "right/hand"))
        self.break_source("right", "UNPLACED right/base")
        self.facts.status.bodies += [body(f"right/{link}", UNPLACED) for link in ("base", "elbow", "hand")]
        self.assertIn("robots 'right', 'robot'", self.expect("wrong_world_frame").what)

    def test_a_slow_frame_that_the_node_knows_is_not_missing(self):
        self.facts.streams = []
        self.expect()

    def test_links_without_moving_joints_need_no_joint_states(self):
        self.facts.robots[0].description = parse_urdf(URDF.replace("revolute", "fixed"))
        self.facts.streams = [stream("/rsp", "x", "y")]
        self.facts.settings.world_frame = self.facts.status.header.frame_id = "x"
        self.facts.graph.publishers["/tf"].append("/other")
        self.facts.streams = [stream("/other", "x", "y")]
        self.unplace("base")
        self.expect("state_publisher_of_other_robot")

    def test_the_state_publisher_of_another_robot_is_not_taken_for_this_ones(self):
        self.unplace("elbow", "hand")
        self.facts.streams = [stream("/rsp", "left/base", "left/arm")]
        self.assertIn("/tf comes from '/rsp' only", self.expect("no_state_publisher").what)

    def add_left_arm(self):
        """Adds a second arm. Its robot_state_publisher waits for joint states on a topic of its own."""
        robot = RobotFacts(RobotSettings("left", tf_prefix="left"), "/left/robot_description", [], parse_urdf(URDF))
        self.facts.robots.append(robot)
        self.facts.graph.publishers["/tf"].append("/left_rsp")
        self.facts.graph.subscribers["/left/joint_states"] = ["/left_rsp"]
        self.facts.graph.types["/left/joint_states"] = "sensor_msgs/JointState"
        keys = {"/rsp": "/robot_description", "/left_rsp": "/left/robot_description"}
        self.facts.descriptions_of_nodes = keys
        self.facts.status.bodies += [body(f"left/{link}", UNPLACED, f"left/{link}") for link in ("elbow", "hand")]
        self.break_source("left", "UNPLACED left/elbow")

    def test_each_of_two_robots_waits_for_its_own_joint_states(self):
        self.add_left_arm()
        finding = self.expect("no_joint_states")
        self.assertIn("/left_rsp waits for joint states on /left/joint_states", finding.what)
        self.unplace("elbow", "hand")
        self.facts.status.bodies += [body(f"left/{link}", UNPLACED, f"left/{link}") for link in ("elbow", "hand")]
        self.facts.graph.publishers["/joint_states"] = []
        self.assertIn("4 frames of robots 'robot', 'left'", self.expect("no_joint_states").what)

    def test_the_frames_of_another_robot_are_no_wrong_prefix(self):
        self.add_left_arm()
        self.facts.graph.publishers["/tf"].remove("/left_rsp")
        self.expect("no_state_publisher")

    def test_what_rides_on_an_absent_frame_is_explained_by_it(self):
        self.unplace("elbow", "hand")
        self.facts.joints = {}
        self.facts.status.bodies += [body("obstacle/crate", UNPLACED, "hand"), body("map/shelf", UNPLACED, "elbow")]
        self.break_source("obstacle", "UNPLACED obstacle/crate")
        self.break_source("map/shelf", "UNPLACED map/shelf")
        self.expect("joint_states_silent")
        self.facts.status.bodies.append(body("obstacle/lamp", UNPLACED, "ceiling"))
        self.expect("joint_states_silent", "source_incomplete")

    def test_the_command_for_a_state_publisher_names_its_parameter_and_prefix(self):
        self.unplace("elbow", "hand")
        self.facts.robots[0].key, self.facts.robots[0].settings.tf_prefix = "/left/description", "left"
        self.facts.streams, self.facts.graph.publishers["/tf"] = [], []
        self.facts.graph.publishers["/tf_static"] = []
        fix = self.expect("no_state_publisher").fix
        self.assertIn("robot_description:=/left/description _tf_prefix:=left", fix)
        self.facts.robots[0].key = "/left/robot_description"
        self.assertIn("robot_state_publisher __ns:=/left _tf_prefix:=left", self.expect("no_state_publisher").fix)

    def test_only_bodies_of_this_robot_without_a_pose_count(self):
        self.facts.status.bodies = [body("other/elbow", UNPLACED), body("robot/elbow", STALE), body("robot/x", LOST)]
        self.facts.status.header.frame_id = "nowhere"
        self.expect()

    def test_two_trees_are_found_without_the_node_too(self):
        self.without_node()
        self.facts.settings.world_frame = "map"
        self.facts.streams.append(stream("/amcl", "map", "odom"))
        self.expect("node_not_running", "two_trees")
        self.facts.streams.append(stream("/odometry", "odom", "base"))
        self.expect("node_not_running")

    # Publishers of /tf

    def test_two_publishers_of_frames_are_told_once(self):
        links = (("base", "elbow"), ("elbow", "hand"))
        self.facts.streams += [stream("/other", *each, pose=MOVED) for each in links]
        finding = self.expect("contested_frame")
        self.assertIn("2 frames ('elbow', 'hand') come from /rsp", finding.what)
        self.assertIn("`rosnode kill /other`", finding.fix, "the robot_state_publisher must stay")

    def test_two_publishers_that_agree_are_a_warning(self):
        self.facts.streams.append(stream("/other", "base", "elbow"))
        self.expect("doubled_frame", code=EXIT_WARN)

    def test_two_parents(self):
        self.facts.streams.append(stream("/other", "map", "elbow"))
        self.assertIn("different parents", self.expect("contested_frame").what)

    def test_a_frame_on_tf_and_on_tf_static(self):
        self.facts.streams.append(stream("/rsp", "base", "elbow", pose=MOVED, static=True, count=1))
        finding = self.expect("contested_frame")
        self.assertIn("on /tf and on /tf_static", finding.what)
        self.assertIn("Let /rsp send", finding.fix)

    def test_a_contest_about_frames_that_no_robot_needs_is_a_warning(self):
        self.facts.streams += [stream("/a", "base", "lamp"), stream("/b", "hand", "lamp")]
        self.expect("contested_frame", code=EXIT_WARN)

    def test_stamps_of_frames_that_no_robot_needs_do_not_count(self):
        self.facts.streams.append(stream("/lamp", "base", "lamp", offset=5.0))
        self.expect()

    def test_a_contest_that_only_the_node_has_seen(self):
        self.facts.status.contested_frames = ["frame 'x' comes from /a with parent 'b' and from /c with parent 'd'"]
        self.expect("contested_frame")

    def test_clocks_that_only_the_node_has_seen_differ(self):
        self.facts.status.clock_offsets = [
            SimpleNamespace(publisher="/arm", offset=-1.25),
            SimpleNamespace(publisher="/base", offset=0.3),
        ]
        finding = self.expect("clock_offset", code=EXIT_WARN)
        self.assertIn("/arm 1.25 s behind the clock, /base 0.30 s ahead of the clock", finding.what)

    def test_stamps(self):
        cases = (
            (0.1, ()),
            (-0.2, ()),
            (0.4, ("stamps_early", EXIT_WARN)),
            (0.6, ("stamps_early", EXIT_ERROR)),
            (-0.5, ("stamps_late", EXIT_WARN)),
            (-2.5, ("stamps_late", EXIT_ERROR)),
            (-1e9, ("stamps_of_other_clock", EXIT_ERROR)),
        )
        for offset, expected in cases:
            with self.subTest(offset=offset):
                for each in self.facts.streams[:2]:
                    each.offsets = [offset] * 50
                self.expect(*expected[:1], code=expected[-1] if expected else EXIT_OK)

    def test_simulated_time_that_advances_in_long_steps_makes_no_stamp_early(self):
        self.facts.graph.use_sim_time = True
        self.facts.graph.publishers["/clock"] = ["/gazebo"]
        self.facts.clock = [4.0, 4.5, 5.0]
        self.facts.status.made = status(made=5.0).made
        self.facts.streams[0].offsets = self.facts.streams[1].offsets = [0.3] * 50
        self.expect()
        self.facts.clock = [4.9, 5.0]
        self.expect("stamps_early", code=EXIT_WARN)

    def test_late_stamps_explain_stale_poses(self):
        self.facts.streams[0].offsets = self.facts.streams[1].offsets = [-0.5] * 50
        self.facts.status.sources[0].state = STALE
        self.expect("stamps_late", code=EXIT_WARN)

    def test_late_stamps_explain_a_robot_that_is_incomplete_because_its_poses_are_stale(self):
        self.facts.streams[0].offsets = self.facts.streams[1].offsets = [-0.5] * 50
        robot = self.facts.status.sources[0]
        robot.complete, robot.reason = False, "STALE robot/hand: its pose is 0.5 s old"
        self.assertIn("its robots are STALE", self.expect("stamps_late").what)
        robot.reason = "UNCOVERED robot/hand: PARSE: <geometry> is empty"
        self.expect("source_incomplete", "stamps_late")

    def test_early_stamps_explain_refusals(self):
        self.facts.streams[0].offsets = self.facts.streams[1].offsets = [0.8] * 50
        self.facts.status.counters = [counter("tf.refused.CLOCK", 300)]
        self.unplace("tip")
        self.expect("stamps_early")

    def test_stamps_of_zero(self):
        self.facts.streams[0].zero_stamps = 50
        self.expect("stamps_zero")

    # Maps and clouds

    def test_a_cloud_without_publisher(self):
        self.add_input("cloud/front", "NOT_READY cloud 'front': nothing came", topic="/points")
        self.expect("no_input_publisher")
        self.facts.graph.publishers["/points"] = ["/camera"]
        self.expect("input_silent")
        self.facts.nodes["/camera"] = NodeFacts("/camera", error="Connection refused")
        self.assertIn("does not answer", self.expect("no_input_publisher").what)

    def test_a_cloud_of_the_wrong_type_or_frame(self):
        self.add_input("cloud/front", "UNKNOWN_FRAME", topic="/points")
        self.facts.graph.publishers["/points"] = ["/camera"]
        types, frames = {"/camera": "sensor_msgs/Image"}, {"/camera": "lens"}
        self.facts.topics["/points"] = TopicFacts({"/camera": 1}, {}, types, frames)
        self.expect("wrong_input_type")
        self.facts.topics["/points"].types["/camera"] = "sensor_msgs/PointCloud2"
        self.assertIn("'lens', which is unknown to tf", self.expect("wrong_input_frame").what)
        self.facts.topics["/points"].frames["/camera"] = "hand"
        self.expect("source_incomplete")

    def test_a_cloud_in_the_world_frame_is_in_the_right_frame(self):
        self.add_input("cloud/front", "LIMIT cloud 'front' has too many bytes", topic="/points")
        self.facts.graph.publishers["/points"] = ["/camera"]
        self.facts.streams = []
        self.facts.topics["/points"] = TopicFacts({"/camera": 1}, {}, {}, {"/camera": "base"})
        self.expect("source_incomplete")

    def test_another_topic_of_the_type_is_offered(self):
        self.add_input("cloud/front", "NOT_READY", topic="/points")
        self.facts.graph.publishers.update({"/camera/points": ["/camera"], "/rosout": ["/camera"]})
        self.facts.graph.types.update({"/camera/points": "sensor_msgs/PointCloud2", "/rosout": "rosgraph_msgs/Log"})
        self.assertIn("`clouds: [{name: front, topic: /camera/points}]`", self.expect("no_input_publisher").fix)

    def test_inputs_whose_source_is_complete_are_sound(self):
        self.add_input("cloud/front", "", topic="/points")
        self.facts.status = status(sequence=151, sources=[source("robot"), source("cloud/front")])
        self.expect()

    def test_refusals_of_an_explained_cloud_are_not_told_again(self):
        self.add_input("cloud/front", "UNKNOWN_FRAME", topic="/points")
        self.facts.graph.publishers["/points"] = ["/camera"]
        self.facts.topics["/points"] = TopicFacts({"/camera": 1}, {}, {}, {"/camera": "lens"})
        self.facts.status.counters = [counter("cloud/front.refused.UNKNOWN_FRAME", 9), counter("maps.refused.LIMIT", 9)]
        self.expect("wrong_input_frame")

    def test_a_tracker_without_publisher_or_of_the_wrong_type(self):
        tracker = read_settings({"tracks": [{"name": "people", "topic": "/people"}]}, "/proximity").inputs
        self.add_input("track/people", "NOT_READY tracker 'people'", topic="/people")
        self.facts.settings.inputs = tracker
        self.assertIn("topic in ~tracks", self.expect("no_input_publisher").fix)
        self.facts.graph.publishers["/people"] = ["/legs"]
        self.facts.topics["/people"] = TopicFacts({"/legs": 1}, {}, {"/legs": "geometry_msgs/PoseArray"}, {"/legs": ""})
        self.assertIn("visualization_msgs/MarkerArray is needed", self.expect("wrong_input_type").what)

    def test_a_map_file(self):
        self.add_input("map/hall", "RESOURCE_MISSING", file="hall.bt")
        self.facts.map_file_errors = {"map/hall": "there is no file /maps/hall.bt"}
        self.expect("no_map_file")

    # Findings from the node's ~status

    def test_a_source_that_nothing_else_explains(self):
        self.break_source("obstacle", "UNPLACED obstacle/crate: it never had a pose (frame 'cart')")
        self.assertIn("{frame_id: base}, child_frame_id: cart,", self.expect("source_incomplete").fix)
        reason = "UNPLACED robot 'arm': 2 of its 9 links never had a pose: frame 'tool' was never published"
        self.break_source("obstacle", reason)
        self.assertIn("{frame_id: base}, child_frame_id: tool,", self.expect("source_incomplete").fix)

    def test_an_obstacle_that_no_message_on_poses_has_placed(self):
        self.break_source("obstacle", "UNPLACED obstacle/cart: it never had a pose (frame '~poses/cart')")
        self.assertIn("Send its pose to /proximity/poses.", self.expect("source_incomplete").fix)

    def test_an_obstacle_that_messages_on_poses_no_longer_move(self):
        self.break_source("obstacle", "LOST obstacle/cart: its pose is 3 s old (frame '~poses/cart')")
        self.assertIn("rostopic hz /proximity/poses", self.expect("source_incomplete").fix)
        self.break_source("obstacle", "LOST obstacle/cart: its pose is 3 s old (frame 'cart')")
        self.assertIn("rostopic hz /tf", self.expect("source_incomplete").fix)

    def test_stale_poses(self):
        self.facts.status.sources[0].state = STALE
        self.assertNotIn("publish_frequency", self.expect("source_stale", code=EXIT_WARN).what)
        self.facts.topics["/joint_states"] = TopicFacts({"/driver": 100})
        what = self.expect("source_stale", code=EXIT_WARN).what
        self.assertIn("/rsp sends only 17 transforms a second of the 33 on /joint_states", what)
        self.assertIn("~publish_frequency", what)

    def test_pairs_that_are_cut_off(self):
        self.facts.status.world.complete = False
        self.expect("pairs_truncated")

    def test_a_robot_that_can_have_no_pair(self):
        self.facts.status.self_pairs[0].adjacent = 2
        self.expect("all_pairs_off", code=EXIT_WARN)
        self.facts.status.sources.append(source("obstacle"))
        self.expect()

    def test_rules_that_hide_pairs_until_somebody_removes_them(self):
        def rule(lifetime):
            times = {name: SimpleNamespace(to_sec=lambda value=value: value)
                     for name, value in (("lifetime", lifetime), ("since", 12.0))}
            return SimpleNamespace(first="robot/*", second="b", allowed=True, reason="test", set_by="/x", **times)

        self.facts.graph.use_sim_time, self.facts.clock = True, [1.0, 2.0]
        self.facts.graph.publishers["/clock"] = ["/driver"]
        self.facts.rules = [rule(5.0)]
        self.facts.pairs_off = 8
        self.expect()
        self.facts.rules = [rule(0.0)]
        finding = self.expect("rules_hide_pairs", code=EXIT_WARN)
        self.assertIn("hide 8 pairs", finding.what)
        self.assertIn("""'robot/*' with 'b', set by /x at 12.0 s, because "test".""", finding.what)
        self.assertIn("remove: true", finding.fix)
        self.facts.pairs_off = 0
        self.expect()

    def test_links_that_touch(self):
        self.facts.touching = [Touch("robot/base", "robot/hand", 5.0), Touch("other/a", "other/b", 5.0)]
        finding = self.expect("links_touch", code=EXIT_WARN)
        self.assertIn("1 pair of links of robot 'robot' touch each other", finding.what)
        self.assertIn("make_srdf", finding.fix)

    def test_static_transforms_that_a_python_broadcaster_may_have_dropped(self):
        self.facts.streams = [stream("/lamp", "map", "lamp", static=True, count=1), *self.facts.streams[1:]]
        self.facts.settings.world_frame = self.facts.status.header.frame_id = "map"
        self.unplace("hand")
        self.facts.streams.append(stream("/rsp", "elbow", "hand"))
        self.assertIn("'/lamp' on /tf_static may have sent more than it latches", self.expect("two_trees").what)

    def test_warnings_of_the_node(self):
        self.facts.status.model_warnings = ["~margins: 'x' matches no body", "another"]
        self.assertIn("1 warning more", self.expect("model_warnings", code=EXIT_WARN).what)

    def test_only_counters_that_grow_are_findings(self):
        names = ("tf.refused.NONFINITE", "tick.failed.INTERNAL")
        self.facts.first_status.counters = [counter(name, 7) for name in names]
        self.facts.status.counters = [counter(name, 7) for name in names]
        self.expect()
        self.facts.status.counters = [counter(names[0], 9), counter(names[1], 8)]
        self.expect("work_fails", "input_refused")
        self.facts.status.counters = [counter("cloud/x.refused.LIMIT", 1), counter("maps.refused.LIMIT", 1)]
        self.expect("input_refused", code=EXIT_WARN)

    def test_late_and_slow_ticks(self):
        self.facts.status.counters = [counter("tick.late", 10)]
        self.expect()
        self.facts.status.counters = [counter("tick.late", 40)]
        self.expect("ticks_late", code=EXIT_WARN)
        self.facts.status.counters = []
        self.facts.status.timings[0].median = 0.03
        self.expect("ticks_slow", code=EXIT_WARN)

    # Parameters and reports

    def test_parameters_are_read_as_the_node_reads_them(self):
        values = {
            "world_frame": "/map",
            "rate": 100,
            "margin": "wide",
            "robots": [{"name": "a", "description": "b", "tf_prefix": "/p"}],
            "maps": [{"name": "m"}, {"name": "f", "file": "f.bt"}],
            "clouds": [{"name": "c", "topic": "/t"}],
            "tracks": [{"name": "p", "topic": "people", "type": "poses"}],
            "map": {"folder": "/x"},
        }
        settings = read_settings(values, "/cell/prox")
        self.assertEqual((settings.world_frame, settings.map_folder), ("map", "/x"))
        self.assertEqual((settings.rate, settings.margin), (100.0, 0.1))
        self.assertEqual(settings.robots[0].frame("l"), "p/l")
        self.assertEqual([each.topic for each in settings.inputs], ["/cell/octomap_binary", "", "/t", "/cell/people"])
        self.assertEqual(settings.inputs[3].type, "geometry_msgs/PoseArray")
        for nonsense in (None, 5, {"robots": 5, "maps": [5], "map": 5, "rate": True}):
            self.assertEqual(read_settings(nonsense, "/proximity"), Settings())

    def test_errors_come_before_warnings(self):
        self.facts.environment.own_name_error = "it is no address of this computer"
        self.facts.pid_after = 77
        self.expect("node_restarts", "bad_own_address")
        findings = diagnose(self.facts)
        value = json.loads(report.as_json(self.facts, findings))
        self.assertEqual([each["severity"] for each in value["findings"]], ["ERROR", "WARN"])
        self.assertEqual(value["exit_code"], EXIT_ERROR)
        text = report.as_text(self.facts, findings, False, False)
        self.assertTrue(text.startswith("ERROR") and "\033" not in text, text)
        self.assertTrue(text.endswith("ERROR: 1 error and 1 warning found for /proximity."), text)
        self.assertIn("\033[1;31mERROR", report.as_text(self.facts, findings, False, True))


if __name__ == "__main__":
    import rosunit

    rosunit.unitrun("hgrid_proximity", "doctor_checks", DoctorChecks)
