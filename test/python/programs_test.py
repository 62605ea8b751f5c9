#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Asks every program of the package for help. The program must not look for a ROS master, nor start a node."""

import os
import socket
import subprocess
import sys
import unittest

import rosgraph
import rospy
import rosunit
from hgrid_proximity.msg import Status
from roslib.packages import find_node

PACKAGE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.realpath(__file__))))
COMPILED = ["ask_node", "check_audit", "make_srdf", "proximity_mesh_reader", "proximity_node"]
WRONG_ARGUMENT = {"doctor": 64}  # exit codes other than 2
PASSES_ON = ["show"]  # gives unknown options to another program
FROM_ROSLAUNCH = ["__name:=proximity", "__log:=" + os.devnull]


def scripts():
    """Returns the paths of all programs that are scripts."""
    for folder in ("demo", "examples", "tools"):
        for name in sorted(os.listdir(os.path.join(PACKAGE, folder))):
            path = os.path.join(PACKAGE, folder, name)
            if os.path.isfile(path):
                with open(path, "rb") as file:
                    if file.read(2) == b"#!":
                        yield path


def programs():
    return list(scripts()) + [find_node("hgrid_proximity", name)[0] for name in COMPILED]


def run(program, *arguments, **environment):
    command = [program, *arguments]
    if program in scripts():
        command.insert(0, sys.executable)  # some scripts become executable when they are installed
    return subprocess.run(command, env=dict(os.environ, **environment), stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True, timeout=60)


class Programs(unittest.TestCase):
    def setUp(self):
        """Listens in place of a ROS master."""
        self.listener = socket.socket()
        self.listener.bind(("127.0.0.1", 0))
        self.listener.listen(5)
        self.listener.setblocking(False)
        self.uri = "http://127.0.0.1:%d" % self.listener.getsockname()[1]

    def tearDown(self):
        self.listener.close()

    def expect_no_connection(self):
        with self.assertRaises(BlockingIOError, msg="the program has connected to the ROS master"):
            self.listener.accept()

    def expect_help(self, done):
        self.assertEqual(0, done.returncode, done.stderr)
        self.assertEqual("", done.stderr)
        self.assertIn("usage:", done.stdout)
        self.assertIn("-h", done.stdout)

    def test_make_srdf_writes_pairs_with_their_reasons(self):
        urdf = os.path.join(PACKAGE, "demo", "six_axis_arm.urdf")
        done = run(find_node("hgrid_proximity", "make_srdf")[0], "--states", "200", urdf)
        self.assertEqual(0, done.returncode, done.stderr)
        self.assertIn('<robot name="six_axis_arm">', done.stdout)
        for reason in ("Adjacent", "Never in 200 states"):
            self.assertIn('" reason="%s"/>' % reason, done.stdout)
        self.assertEqual(2, run(find_node("hgrid_proximity", "make_srdf")[0], "--states", "9", urdf).returncode)
        self.assertEqual(1, run(find_node("hgrid_proximity", "make_srdf")[0], os.devnull).returncode)
        self.expect_no_connection()

    def test_scripts_are_found(self):
        names = [os.path.basename(path) for path in scripts()]
        for name in ("ask.py", "carry_part", "doctor", "make_room", "move_cell", "person", "plan.py", "play_robot.py",
                     "show", "watch"):
            self.assertIn(name, names)

    def test_help_needs_no_master(self):
        for program in programs():
            with self.subTest(program):
                self.expect_help(run(program, "--help", *FROM_ROSLAUNCH, ROS_MASTER_URI=self.uri))
                self.expect_no_connection()

    def test_help_leaves_running_nodes_alone(self):
        rospy.init_node("programs_test")
        rospy.wait_for_message("/proximity/status", Status, timeout=60.0)  # the node has registered everything
        master = rosgraph.Master("/programs_test")
        before = master.getSystemState(), master.lookupNode("/proximity")
        for program in programs():
            with self.subTest(program):
                self.expect_help(run(program, "-h", *FROM_ROSLAUNCH))
                self.assertEqual(before, (master.getSystemState(), master.lookupNode("/proximity")))

    def test_an_unknown_option_is_refused(self):
        for program in programs():
            name = os.path.basename(program)
            if name in PASSES_ON:
                continue
            with self.subTest(program):
                done = run(program, "--no-such-option", *FROM_ROSLAUNCH, ROS_MASTER_URI=self.uri)
                self.expect_no_connection()
                self.assertEqual(WRONG_ARGUMENT.get(name, 2), done.returncode, done.stderr)
                self.assertEqual("", done.stdout)
                said = [line for line in done.stderr.splitlines() if line and not line.startswith((" ", "usage:"))]
                self.assertEqual(1, len(said), done.stderr)
                self.assertIn(name, said[0])

    def test_options_of_the_node_that_contradict_each_other_are_refused(self):
        done = run(find_node("hgrid_proximity", "proximity_node")[0], "--wait", "--replace", ROS_MASTER_URI=self.uri)
        self.expect_no_connection()
        self.assertEqual(2, done.returncode)
        self.assertIn("exclude each other", done.stderr)


if __name__ == "__main__":
    rosunit.unitrun("hgrid_proximity", "programs", Programs)
