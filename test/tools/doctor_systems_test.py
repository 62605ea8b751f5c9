#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Breaks real systems, runs the doctor, types the fix that it prints, and checks that it no longer reports the fault.

In each system, one fault comes after another, so that one run of the doctor shows both the end of the last fault and
the next one. With HGRID_TEST_DOCTOR_SYSTEMS=all, all systems are tried, otherwise the few that print most commands.
"""
import os
import pathlib
import re
import signal
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "support"))

from system import ARM, ARM_SRDF, PUPPET, ROOT, System, wait_for  # noqa: E402  (the path comes first)

from hgrid_doctor.facts import LOST, STALE  # noqa: E402

ALL = os.environ.get("HGRID_TEST_DOCTOR_SYSTEMS", "few") == "all"

XACRO = """<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:property name="length" value="1"/>
</robot>"""
SEEN_ARM = ARM.replace("collision>", "visual>")
TABLE = {"name": "table", "shapes": [{"type": "box", "size": [1.0, 1.0, 0.1]}]}
PEOPLE = {"name": "people", "topic": "/nobody", "type": "poses", "shapes": [{"type": "sphere", "radius": 0.3}]}
PERSONS = (
    "rostopic pub -s -r 10 /persons geometry_msgs/PoseArray "
    "'{header: {stamp: now, frame_id: camera}, poses: [{position: {x: 5.0}, orientation: {w: 1.0}}]}'"
)
BASE_MESH = '<mesh filename="%s"/>'
BASE_SHAPE = '<cylinder length="0.04" radius="0.10"/>'
OTHER_JOINT = '<joint name="z" type="continuous"><parent link="x"/><child link="y"/></joint>'
BALL = '<collision><geometry><sphere radius="0.1"/></geometry></collision>'
TOUCHING = """<robot name="touching"> <link name="a">{0}</link> <link name="b">{0}</link> <link name="c">{0}</link>
  <joint name="joint_1" type="continuous"><parent link="a"/><child link="b"/></joint>
  <joint name="joint_2" type="continuous"><parent link="b"/><child link="c"/></joint>
</robot>""".format(BALL)
UNKNOWN_LINK = '<disable_collisions link1="base_link" link2="unknown" reason="Never"/></robot>'
TRIANGLE = """solid a
facet normal 0 0 1 outer loop vertex 0 0 0 vertex 0.1 0 0 vertex 0 0.1 0 endloop endfacet
endsolid a
"""
INSPECTIONS = (  # commands that show something and change nothing
    "rostopic hz /tf",
    "rostopic hz /joint_states",
    "rostopic echo -n 1 /joint_states/name",
    "rostopic echo /proximity/poses",
    "rostopic echo /rosout/msg",
    "rostopic echo /tf",
    "rostopic echo -n 1 /proximity/status",
    "rostopic echo -n 1 /proximity/status/bodies",
    "rostopic echo -n 1 /proximity/status/model_warnings",
    "rostopic echo -n 1 /proximity/status/timings",
    "rostopic find geometry_msgs/PoseArray",
    "rosnode list",
    "rosnode info /robot_state_publisher",
    "pgrep -af rosmaster",
    "pgrep -af proximity_node",
    "date +%s.%N",
)

OF_A_BUSY_COMPUTER = ("clock_offset", "source_stale", "stamps_late", "ticks_late", "ticks_slow")

NO_COMMAND = "its fix has no command"
SHOWS = "its command shows something; INSPECTIONS has it"
OTHER = "its command is that of another finding, with other values"
NOT_TYPED = {  # findings whose fix no test types, and why; doctor_checks_test.py tests the text of each
    "all_pairs_off": NO_COMMAND,
    "clock_offset": SHOWS,
    "clock_silent": NO_COMMAND,
    "clock_stands_still": NO_COMMAND,
    "clock_unused": OTHER,  # no_clock
    "doubled_frame": OTHER,  # contested_frame
    "input_refused": SHOWS,
    "input_silent": SHOWS,
    "joint_states_incomplete": SHOWS,
    "joint_states_silent": SHOWS,
    "links_without_collision": OTHER,  # no_collision
    "mimic_differs": NO_COMMAND,
    "mimic_of_mimic": NO_COMMAND,
    "model_warnings": SHOWS,
    "node_restarts": SHOWS,
    "not_a_proximity_node": SHOWS,
    "other_version": OTHER,  # no_mesh_package
    "source_stale": SHOWS,
    "stamps_of_other_clock": NO_COMMAND,
    "stamps_zero": NO_COMMAND,
    "state_publisher_of_other_robot": OTHER,  # state_publisher_silent
    "static_free_joint": NO_COMMAND,
    "status_silent": OTHER,  # node_on_other_clock
    "tf_publisher_gone": NO_COMMAND,
    "ticks_late": OTHER,  # pairs_truncated
    "ticks_slow": OTHER,  # pairs_truncated
    "work_fails": SHOWS,
    "world_frame_lost": SHOWS,
    "wrong_input_type": SHOWS,
}


def complete(status):
    return status.world.complete and not status.contested_frames


def loaded(status):
    return status.robots == 1


def known(status):
    return status.sources


def reasons(status):
    return [*status.not_ready, *(source.reason for source in status.sources)]


def in_all_systems(test):
    """Leaves out a test unless all systems are to be tried."""
    return test if ALL else None


class DoctorSystems(unittest.TestCase):
    def setUp(self):
        self.system = System()
        self.system.__enter__()
        self.addCleanup(self.system.__exit__)
        self.type = self.system.type
        self.launch = ""  # process id of the roslaunch that a fix has started

    def sound_robot(self, **descriptions):
        self.system.robot(**descriptions)
        self.system.state_publisher()
        return self.system.joint_states()

    def expect(self, code, *names, arguments=()):
        """Checks the exit code and the names of all findings. One cause must not be reported twice.

        Returns the texts in backticks of each fix.
        """
        exit_code, all_findings = self.system.doctor(*arguments)
        findings = [each for each in all_findings if each["name"] in names or each["name"] not in OF_A_BUSY_COMPUTER]
        self.assertEqual([finding["name"] for finding in findings], list(names), findings)
        if findings == all_findings:
            self.assertEqual(exit_code, code, findings)
        for finding in findings:
            print("%s: %s\n  fix: %s" % (finding["severity"], finding["what"], finding["fix"]))
        return [re.findall("`([^`]+)`", finding["fix"]) for finding in findings]

    def expect_quiet(self, arguments=()):
        self.system.wait_for_status(complete, arguments[1] if arguments else "/proximity")
        self.expect(0, arguments=arguments)

    def test_the_master_and_the_node(self):
        system = self.system
        system.hang(system.master_process)
        self.expect(1, "no_master")
        system.kill(system.master_process)
        (fix,) = self.expect(1, "no_master")
        self.type(fix[0])
        wait_for("the master", system.state)
        self.sound_robot()
        (start,) = self.expect(1, "node_not_running")
        self.type(start[0])
        system.wait_for_status(complete)
        self.type("export ROS_HOSTNAME=nowhere.invalid")
        lamp = self.lamp()
        host, own = self.expect(1, "unknown_host", "bad_own_address")
        self.type(own[0])
        self.assertEqual(host[0].replace("ADDRESS", "127.0.0.1"), own[0])
        system.shell.end_job(lamp)
        self.lamp()
        self.expect_quiet()
        self.type('grep /proximity "$(roslaunch-logs)/rosout.log" | tail')
        pid = system.pid("/proximity")
        for number in (signal.SIGSTOP, signal.SIGKILL):
            os.kill(pid, number)
            (start,) = self.expect(1, "node_gone")
        self.type(start[-1])
        self.expect_quiet()

    def lamp(self):
        """Starts a publisher of /tf in the shell. Returns its process id."""
        puppet = "%s %s lamp --tf base_link lamp 1" % (sys.executable, PUPPET)
        process = self.type(puppet + " </dev/null >/dev/null 2>&1 & echo $!")
        wait_for("the lamp", lambda: "/lamp" in self.system.publishers("/tf"))
        return process

    def test_frames_of_a_robot(self):
        system = self.system
        system.robot()
        system.node(loaded)
        (fix,) = self.expect(1, "no_state_publisher")
        self.type(fix[0])
        wait_for("robot_state_publisher", lambda: "/robot_state_publisher" in system.publishers("/tf"))
        (fix,) = self.expect(1, "no_joint_states")
        self.type(fix[0])
        system.wait_for_status(complete)
        system.puppet("intruder", "--tf", "base_link", "shoulder", "0.5")
        system.wait_for_status(lambda status: status.contested_frames)
        (fix,) = self.expect(1, "contested_frame")
        self.assertEqual(fix, ["rosnode kill /intruder"], "not the robot_state_publisher")
        self.type(fix[0])
        self.expect_quiet()

    def test_the_description_of_a_robot(self):
        system = self.system
        self.sound_robot()
        system.master.deleteParam("/test", "/robot_description")
        system.node(known)
        (fix,) = self.expect(1, "no_description")
        system.write("my_robot.urdf", XACRO)
        self.assertIn("<param", fix[0])
        self.type(fix[1])
        system.wait_for_status(lambda status: not any("is not set" in reason for reason in reasons(status)))
        (fix,) = self.expect(1, "bad_description_xacro")
        system.write("bin/xacro", '#!/bin/sh\ncat "$1"\n')  # Debian has no xacro
        self.type("chmod +x bin/xacro")
        system.write("my_robot.urdf.xacro", SEEN_ARM)
        self.assertEqual(len(fix), 3)
        for command in fix:
            self.type(command)
        (fix,) = self.expect(1, "no_collision")
        self.restart_with(fix)
        self.expect_quiet()

    def restart_with(self, fix, node="/proximity", **values):
        """Does what the last two texts of a fix say: puts a line into the parameter file, and starts the node with it.

        @param values  for words in capitals
        """
        if self.launch:
            self.system.shell.end_job(self.launch)
        else:
            self.type("rosnode kill " + node)
        line = fix[-2]
        for word, value in values.items():
            line = line.replace(word, value)
        self.type(line)
        self.assertIn("roslaunch", fix[-1])
        self.launch = self.type(fix[-1])

    @in_all_systems
    def test_a_state_publisher(self):
        system = self.system
        system.robot(description='<robot name="a"><link name="x"/><link name="y"/>%s</robot>' % OTHER_JOINT)
        publisher = system.state_publisher()
        system.joint_states()
        system.robot()
        system.node(loaded)
        (fix,) = self.expect(1, "state_publisher_silent")
        for command in fix:
            self.type(command)
        system.wait_for_status(complete)
        publisher.wait()
        os.kill(system.pid("/robot_state_publisher"), signal.SIGKILL)
        system.wait_for_status(lambda status: any(body.state == LOST for body in status.bodies))
        (fix,) = self.expect(1, "state_publisher_gone")
        self.type(fix[0])
        self.expect_quiet()
        for command in INSPECTIONS:
            code, output = system.shell.type("timeout 2 " + command)
            self.assertIn(code, (0, 124), command + ": " + output)  # 124: it runs until it is ended

    @in_all_systems
    def test_a_node_in_a_namespace_and_a_wrong_prefix(self):
        system = self.system
        system.set("/arm/robot_description", ARM)
        system.set("/arm/tf_description", re.sub('link( name)?="', r"\g<0>left/", ARM))
        system.state_publisher("robot_description:=/arm/tf_description")
        system.joint_states()
        node = {"name": "/cell/prox", "obstacles": [TABLE]}
        (fix,) = self.start_and_expect(known, "no_description", **node)
        self.restart_with(fix, "/cell/prox")
        system.wait_for_status(loaded, "/cell/prox")
        (fix,) = self.expect(1, "wrong_tf_prefix")
        self.restart_with(fix, "/cell/prox")
        self.expect_quiet(("--node", "/cell/prox"))
        self.expect(0)  # the only node is found by itself

    def start_and_expect(self, until, *names, **node):
        self.system.node(until, **node)
        return self.expect(1, *names)

    @in_all_systems
    def test_a_wrong_world_frame(self):
        system = self.system
        self.sound_robot()
        (fix,) = self.start_and_expect(loaded, "wrong_world_frame", world_frame="map")
        self.type(fix[0])
        self.expect_quiet()
        system.shell.end_jobs()
        self.type("rosnode kill /proximity")
        system.puppet("lamp", "--tf", "map", "lamp", "1")
        (fix,) = self.start_and_expect(loaded, "two_trees", world_frame="map")
        self.restart_with(fix)
        self.expect_quiet()

    @in_all_systems
    def test_simulated_time_without_a_clock(self):
        system = self.system
        system.robot()
        system.set("/use_sim_time", True)
        (fix,) = self.start_and_expect(known, "no_clock")
        self.type(fix[1])
        self.sound_robot()
        (fix,) = self.expect(1, "node_on_other_clock")
        for command in fix:
            self.type(command)
        self.expect_quiet()

    @in_all_systems
    def test_meshes(self):
        system = self.system
        self.sound_robot(description=ARM.replace(BASE_SHAPE, BASE_MESH % "package://my_meshes/base.stl"))
        system.node(loaded)
        (fix,) = self.expect(1, "no_mesh_package")
        system.write("my_ws/src/my_meshes/package.xml", "<package><name>my_meshes</name></package>")
        system.write("my_ws/src/my_meshes/base.stl", TRIANGLE)
        path = "$HOME/my_ws/src:$ROS_PACKAGE_PATH"
        system.write("my_ws/devel/setup.bash", 'export ROS_PACKAGE_PATH="%s"\n' % path)
        for command in fix[:2]:
            self.type(command)
        (again,) = self.expect(1, "no_mesh_package")
        self.assertEqual(again, fix[2:])
        for command in again:
            self.type(command)
        self.expect_quiet()
        system.write("base.stl", TRIANGLE)
        self.load_urdf(ARM.replace(BASE_SHAPE, BASE_MESH % ("file://%s/base.stl" % system.folder)))
        (fix,) = self.expect(1, "mesh_outside")
        self.restart_with(fix)
        self.expect_quiet()
        self.load_urdf(ARM.replace(BASE_SHAPE, BASE_MESH % ("file://%s/other.stl" % system.folder)))
        (fix,) = self.expect(1, "bad_mesh")
        system.write("other.stl", TRIANGLE)
        self.type(fix[0])
        self.expect_quiet()

    def load_urdf(self, text):
        self.system.set("/robot_description", text)
        self.system.wait_for_status(lambda status: not status.world.complete)

    @in_all_systems
    def test_an_srdf(self):
        system = self.system
        self.sound_robot(semantic="")
        robot = {"name": "robot", "description": "robot_description", "semantic": "my_srdf"}
        system.node(lambda status: status.model_warnings, robots=[robot])
        other = re.sub('link([12])="', 'link\\1="other_', ARM_SRDF.replace("six_axis_arm", "other"))
        self.assertIn('"other_', other)
        steps = (
            (2, "no_srdf", "no xml"),
            (1, "bad_srdf", other),
            (1, "srdf_of_other_robot", ARM_SRDF.replace("</robot>", UNKNOWN_LINK)),
            (2, "srdf_unknown_links", ARM_SRDF.replace("six_axis_arm", "other")),
            (2, "srdf_other_name", ARM_SRDF),
        )
        for code, name, semantic in steps:
            (fix,) = self.expect(code, name)
            system.write("my_robot.srdf", semantic)
            for command in fix:
                self.type(command)
        self.expect_quiet()

    @in_all_systems
    def test_pairs_that_rules_hide_and_links_that_touch(self):
        system = self.system
        self.sound_robot(description=TOUCHING, semantic="")
        system.node(complete, obstacles=[TABLE, {**TABLE, "name": "lamp"}])
        (fix,) = self.expect(2, "links_touch")
        system.write("my_robot.urdf", TOUCHING)
        for command in fix:
            self.type(command)
        self.expect_quiet()
        rule = "{rules: [{first: robot/*, second: obstacle/table, allowed: true, reason: a test}]}"
        self.type("rosservice call /proximity/set_allowed '%s'" % rule)
        (fix,) = self.expect(2, "rules_hide_pairs")
        self.type(fix[0])
        self.expect_quiet()

    @in_all_systems
    def test_inputs(self):
        system = self.system
        self.sound_robot()
        system.write("room.bt", (ROOT / "demo/room.bt").read_bytes())
        self.type(PERSONS)
        wait_for("the persons", lambda: system.publishers("/persons"))
        node = {"maps": [{"name": "room", "file": "room.bt"}], "tracks": [PEOPLE]}
        file, topic = self.start_and_expect(loaded, "no_map_file", "no_input_publisher", **node)
        self.restart_with(file, FOLDER=system.folder)
        system.wait_for_status(lambda status: any(each.name == "map/room" and each.complete for each in status.sources))
        (topic,) = self.expect(1, "no_input_publisher")
        self.restart_with(topic)
        system.wait_for_status(lambda status: any("camera" in each.reason for each in status.sources))
        (fix,) = self.expect(1, "wrong_input_frame")
        self.type(fix[0])
        self.expect_quiet()

    @in_all_systems
    def test_what_only_the_node_says(self):
        system = self.system
        self.sound_robot(description=ARM.replace(BASE_SHAPE, '<sphere radius="nan"/>'))
        (cart, shape) = self.start_and_expect(
            loaded,
            "source_incomplete",
            "source_incomplete",
            obstacles=[{**TABLE, "frame": "cart"}],
            limits={"max_pairs": 5},
            margin=1.0,
        )
        self.type(cart[0])
        self.restart_with(shape, REASON="only a test")
        system.wait_for_status(lambda status: status.world.incomplete_total == 0 and status.pair_count > 0)
        (fix,) = self.expect(1, "pairs_truncated")
        self.restart_with(fix)
        self.expect_quiet()

    @in_all_systems
    def test_stamps_of_tf_in_the_past_and_in_the_future(self):
        system = self.system
        self.sound_robot()
        base = ("localisation", "--tf", "map", "base_link", "1.0", "--offset")
        late = system.puppet(*base, "-0.5")
        system.node(lambda status: any(source.state == STALE for source in status.sources), world_frame="map")
        self.expect(1, "stamps_late")
        system.end(late)
        system.puppet(*base, "0.8")
        system.wait_for_status(lambda status: not status.world.complete)
        self.expect(1, "stamps_early")


if __name__ == "__main__":
    import rosunit

    rosunit.unitrun("hgrid_proximity", "doctor_systems", DoctorSystems)
