#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Runs the doctor in real systems, some of them broken. Checks its findings and its exit code."""
import os
import pathlib
import re
import signal
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "support"))

from system import ARM, ARM_SRDF, System  # noqa: E402  (the path comes first)

XACRO = """<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:property name="length" value="1"/><link name="base_link"/>
</robot>"""
TABLE = {"name": "table", "shapes": [{"type": "box", "size": [1.0, 1.0, 0.1]}]}
LEFT_ARM = {"name": "arm", "description": "/arm/robot_description", "tf_prefix": "left"}
MESH = ARM.replace('<cylinder length="0.04" radius="0.10"/>', '<mesh filename="package://no_such_package/base.stl"/>')


def complete(status):
    return status.world.complete


def loaded(status):
    return status.robots == 1


class DoctorSystems(unittest.TestCase):
    def setUp(self):
        self.system = System()
        self.system.__enter__()
        self.addCleanup(self.system.__exit__)

    def sound_robot(self, **descriptions):
        self.system.robot(**descriptions)
        self.system.state_publisher()
        self.system.joint_states()

    def expect(self, code, *names, arguments=()):
        """Checks the exit code and the names of all findings. One cause must not be reported twice."""
        exit_code, findings = self.system.doctor(*arguments)
        self.assertEqual([finding["name"] for finding in findings], list(names), findings)
        self.assertEqual(exit_code, code, findings)
        for finding in findings:
            print("%s: %s" % (finding["severity"], finding["what"]))

    def test_a_sound_system_has_no_findings(self):
        self.sound_robot()
        self.system.node(complete)
        self.expect(0)

    def test_a_sound_node_in_a_namespace_is_found_by_itself(self):
        self.system.set("/arm/robot_description", ARM)
        self.system.set("/cell/prox/robots", [LEFT_ARM])
        self.system.set("/cell/prox/obstacles", [TABLE])
        self.system.set("/arm/tf_description", re.sub('link( name)?="', r"\g<0>left/", ARM))
        self.system.state_publisher("robot_description:=/arm/tf_description")
        self.system.joint_states()
        self.system.node(complete, name="/cell/prox")
        self.expect(0)
        self.expect(0, arguments=("--node", "/cell/prox"))

    def test_no_master(self):
        self.system.lose_master()
        self.expect(1, "no_master")

    def test_the_master_hangs(self):
        self.system.hang_master()
        self.expect(1, "no_master")

    def test_no_robot_state_publisher(self):
        self.system.robot()
        self.system.node(loaded)
        self.expect(1, "no_state_publisher")

    def test_no_joint_states(self):
        self.system.robot()
        self.system.state_publisher()
        self.system.node(loaded)
        self.expect(1, "no_joint_states")

    def test_unexpanded_xacro(self):
        self.system.robot(description=XACRO, semantic="")
        self.system.node(lambda status: status.sources)
        self.expect(1, "bad_description_xacro")

    def test_wrong_world_frame(self):
        self.sound_robot()
        self.system.set("/proximity/world_frame", "map")
        self.system.node(loaded)
        self.expect(1, "wrong_world_frame")

    def test_two_publishers_of_one_frame(self):
        self.sound_robot()
        self.system.puppet("intruder", "--tf", "base_link", "shoulder", "0.5")
        self.system.node(lambda status: status.contested_frames)
        self.expect(1, "contested_frame")

    def test_simulated_time_without_a_clock(self):
        self.system.robot()
        self.system.set("/use_sim_time", True)
        self.system.node(lambda status: status.sources)
        self.expect(1, "no_clock")

    def test_a_mesh_whose_package_is_missing(self):
        self.sound_robot(description=MESH)
        self.system.node(loaded)
        self.expect(1, "no_mesh_package")

    def test_srdf_of_another_robot(self):
        links = ("base_link", "shoulder", "upper_arm", "forearm", "wrist_1", "wrist_2", "flange", "gripper")
        other = ARM_SRDF.replace("six_axis_arm", "other")
        for link in links:
            other = other.replace('"%s"' % link, '"other_%s"' % link)
        self.sound_robot(semantic=other)
        self.system.node(complete)
        self.expect(1, "srdf_of_other_robot")

    def test_a_map_that_nobody_publishes(self):
        self.sound_robot()
        self.system.set("/proximity/maps", [{"name": "hall", "topic": "/octomap"}])
        self.system.node(loaded)
        self.expect(1, "no_input_publisher")

    def test_the_node_does_not_run(self):
        self.sound_robot()
        self.expect(1, "node_not_running")

    def test_the_node_was_killed_and_is_still_registered(self):
        self.sound_robot()
        node = self.system.node(loaded)
        os.kill(node.pid, signal.SIGKILL)
        node.wait()
        self.expect(1, "node_gone")

    def test_the_node_hangs(self):
        self.sound_robot()
        node = self.system.node(loaded)
        os.kill(node.pid, signal.SIGSTOP)
        self.expect(1, "node_gone")

    def base_from_other_clock(self, offset):
        self.sound_robot()
        self.system.puppet("localisation", "--tf", "map", "base_link", "1.0", "--offset", str(offset))
        self.system.set("/proximity/world_frame", "map")

    def test_stamps_of_tf_in_the_past(self):
        self.base_from_other_clock(-0.5)
        self.system.node(complete)
        self.expect(2, "stamps_late")

    def test_stamps_of_tf_in_the_future(self):
        self.base_from_other_clock(0.8)
        self.system.node(loaded)
        self.expect(1, "stamps_early")


if __name__ == "__main__":
    import rosunit

    rosunit.unitrun("hgrid_proximity", "doctor_systems", DoctorSystems)
