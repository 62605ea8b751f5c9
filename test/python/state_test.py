#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""What survives a restart of the node with ~state_folder, also after kill -9 while changes are written."""
import os
import pathlib
import random
import shutil
import signal
import subprocess
import tempfile
import threading
import time
import unittest

import rospy
import rosunit
import yaml
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from hgrid_proximity import obstacles, robots, rules
from hgrid_proximity.client import Proximity
from hgrid_proximity.errors import NoAnswer, ProximityError, Refused
from hgrid_proximity.msg import Bodies, Rules, Status
from moving_ball import Ball

PATIENCE = 120.0  # [s] for a machine that is busy with other tests
KILLS = 20


class State(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("state_test")
        cls.ball = Ball()

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="state_test_"))
        rospy.set_param("/proximity/state_folder", str(self.folder / "own"))
        rospy.set_param("/proximity/map/folder", str(pathlib.Path(__file__).resolve().parents[2] / "demo"))
        self.node = None
        try:
            self.start()
        except BaseException:  # unittest calls no tearDown() then, and the node would hold its name
            self.tearDown()
            raise

    def tearDown(self):
        self.kill()
        shutil.rmtree(self.folder)

    def start(self):
        """Starts the node. Returns the time [s] until it answered a query."""
        begin = time.monotonic()
        self.node = subprocess.Popen(["rosrun", "hgrid_proximity", "proximity_node", "__name:=proximity"])
        self.proximity = Proximity(timeout=PATIENCE)
        while not self.serves():
            self.assertLess(time.monotonic(), begin + PATIENCE)
            self.assertIsNone(self.node.poll(), "the node has ended")
        return time.monotonic() - begin

    def serves(self):
        try:
            return self.proximity.query_sphere((0, 9, 0), 0.1).clear
        except NoAnswer:  # the master still names the killed node, and another process may have got its port
            return False
        except Refused as refused:
            if refused.code == "NOT_READY":  # the node has not made its first tick
                return False
            raise

    def kill(self, how=signal.SIGKILL):
        self.proximity.close()
        self.node.send_signal(how)
        self.node.wait()

    def restart(self, how=signal.SIGKILL):
        self.kill(how)
        return self.start()

    def apply(self, *changes, **options):
        response = self.proximity.apply_obstacles(*changes, **options)
        self.assertTrue(response.durable)

    def bodies(self):
        """The obstacles by name without "obstacle/"."""
        return {body.name[9:]: body for body in self.all_bodies() if body.name.startswith("obstacle/")}

    def all_bodies(self):
        return rospy.wait_for_message("/proximity/bodies", Bodies, PATIENCE).bodies

    def at(self, x, y, z):
        return self.proximity.query_sphere((x, y, z), 0.01, include="obstacle/*").names

    def diagnostic(self):
        """The status "state" of /diagnostics."""
        deadline = time.monotonic() + PATIENCE
        while time.monotonic() < deadline:
            for status in rospy.wait_for_message("/diagnostics", DiagnosticArray, PATIENCE).status:
                if status.name.endswith("state"):
                    return status
        raise AssertionError("/diagnostics has no status state")

    def test_obstacles_are_there_again(self):
        wedge = obstacles.hull([(0, 0, 0), (0.1, 0, 0), (0, 0.1, 0), (0, 0, 0.1)])
        self.apply(
            obstacles.add("part", wedge, (3, 0, 0), owner="me"),
            obstacles.add("held", obstacles.box((0.1, 0.2, 0.3))),
            obstacles.attach("held", "robot/ball", (0.5, 0, 0)),
            obstacles.move("lamp", (0, 0, 3)),
            obstacles.remove("crate"),
        )
        for how in (signal.SIGKILL, signal.SIGTERM):
            self.restart(how)
            bodies = self.bodies()
            self.assertEqual(set(bodies), {"part", "held", "lamp"})
            for body in bodies.values():
                self.assertTrue(body.note.startswith("RESTORED"), body.note)
            self.assertEqual(self.at(3.01, 0.01, 0.01), ["obstacle/part"])
            self.assertEqual(self.at(0, 0, 3), ["obstacle/lamp"])
            self.assertEqual(self.at(self.ball.x + 0.5, 0, 0), ["obstacle/held"])
        status = self.diagnostic()
        self.assertEqual(status.level, DiagnosticStatus.OK)
        self.assertEqual(status.message, "changes are stored in %s" % (self.folder / "own"))
        self.apply(obstacles.detach("held"), obstacles.move("lamp", (0, 0, 3)), complete_set=True, owner="me")
        self.restart()
        notes = {name: body.note[:8] for name, body in self.bodies().items()}
        self.assertEqual(notes, {"held": "RESTORED", "lamp": "RESTORED"})

    def test_robots_are_there_again(self):
        # Its root is the world frame, so that it needs no transforms.
        text = "<robot name='r'><link name='world'><collision><geometry><sphere radius='0.1'/></geometry></collision></link>" \
            "</robot>"

        def sources():
            message = rospy.wait_for_message("/proximity/status", Status, PATIENCE)
            return {source.name for source in message.sources}, message.absent_robots

        response = self.proximity.apply_robots(
            robots.add("twin1", urdf=text, tf_prefix="/"),
            robots.add("twin2", like="twin1", tf_prefix="/"),
            robots.absent("twin1"),
        )
        self.assertTrue(response.durable)
        self.restart()
        names, absent = sources()
        self.assertEqual((names & {"robot", "twin1", "twin2"}, absent), ({"robot", "twin2"}, ["twin1"]))
        self.proximity.apply_robots(
            robots.remove("twin2"), robots.present("twin1"), robots.add("twin3", like="twin1", tf_prefix="/")
        )
        self.proximity.apply_robots(robots.absent("robot"))
        self.restart()
        names, absent = sources()
        self.assertEqual((names & {"robot", "twin1", "twin2", "twin3"}, absent), ({"twin1", "twin3"}, ["robot"]))
        self.assertEqual(self.diagnostic().level, DiagnosticStatus.OK)

    def test_a_reset_is_there_again(self):
        self.apply(obstacles.add("part", obstacles.sphere(0.1), (3, 0, 0)), obstacles.remove("crate"))
        subprocess.check_call(["rosservice", "call", "/proximity/reset"], stdout=subprocess.DEVNULL)
        self.apply(obstacles.add("late", obstacles.sphere(0.1), (4, 0, 0)))
        self.restart()
        self.assertEqual(set(self.bodies()), {"crate", "lamp", "late"})

    def test_rules_are_there_again(self):
        rule = rules.allow("robot/ball", "obstacle/lamp", reason="for the test")
        self.assertTrue(self.proximity.set_allowed(rule).durable)
        self.restart()
        kept = rospy.wait_for_message("/proximity/rules", Rules, PATIENCE).rules
        stored = [(each.first, each.second, each.reason, each.set_by) for each in kept]
        self.assertEqual(stored, [("robot/ball", "obstacle/lamp", "for the test", rospy.get_name())])
        self.assertTrue(self.proximity.set_allowed(rule, remove=True).durable)
        self.restart()
        self.assertEqual(rospy.wait_for_message("/proximity/rules", Rules, PATIENCE).rules, [])

    def test_maps_are_there_again(self):
        loaded = self.proximity.load_octomap("room.bt", "room", (0, 0, 7), frame="world")
        self.assertTrue(loaded.durable)
        self.assertGreater(loaded.occupied_leaves, 0)
        self.restart()
        self.wait_for_bodies_of_maps(["map/room"])
        poses = [body.pose.position.z for body in self.all_bodies() if body.name == "map/room"]
        self.assertEqual(poses, [7.0])
        with self.assertRaisesRegex(Refused, "RESOURCE_MISSING"):
            self.proximity.load_octomap("none.bt", "room")
        self.assertTrue(self.proximity.clear_map("room").durable)
        self.restart()
        self.wait_for_bodies_of_maps([])

    def wait_for_bodies_of_maps(self, names):
        """Waits until the bodies whose names begin with "map/" are these. A map is loaded after the first tick."""
        deadline = time.monotonic() + PATIENCE
        found = None
        while found != names:
            self.assertLess(time.monotonic(), deadline, "the maps are %s" % found)
            found = [body.name for body in self.all_bodies() if body.name.startswith("map/")]

    def test_a_saved_scene_can_be_loaded_again(self):
        rule = rules.allow("robot/ball", "obstacle/part", reason="for the test")
        wedge = obstacles.hull([(0, 0, 0), (0.1, 0, 0), (0, 0.1, 0), (0, 0, 1e-5)])
        self.apply(
            obstacles.add("part", wedge, (3, 0, 0), owner="me"),
            obstacles.add("held", obstacles.box((0.1, 0.2, 0.3))),
            obstacles.attach("held", "robot/ball", (0.5, 0, 0)),
            obstacles.remove("crate"),
        )
        self.proximity.set_allowed(rule)
        saved = self.proximity.save_scene("night")
        self.assertEqual(saved.path, str(self.folder / "own" / "scenes" / "night.yaml"))
        with self.assertRaisesRegex(ProximityError, "exists already"):
            self.proximity.save_scene("night")
        self.proximity.save_scene("night", replace=True)

        # rosparam reads the file as the node does, and it is valid as parameters.
        content = yaml.safe_load(pathlib.Path(saved.path).read_text())
        self.assertEqual([entry["name"] for entry in content["obstacles"]], ["held", "lamp", "part"])
        self.assertEqual(content["obstacles"][2]["shapes"][0]["vertices"][3], [0.0, 0.0, 1e-5])
        self.assertEqual(content["obstacles"][0]["attached"]["link"], "robot/ball")
        self.assertEqual(content["allowed_pairs"][0]["reason"], "for the test")

        self.apply(obstacles.remove("part"), obstacles.remove("held"), obstacles.add("other", obstacles.sphere(0.1), (4, 0, 0)))
        self.assertTrue(self.proximity.load_scene("night").durable)
        self.assertEqual(set(self.bodies()), {"held", "lamp", "part", "other"})
        self.proximity.load_scene("night", replace=True)
        self.assertEqual(set(self.bodies()), {"held", "lamp", "part"})
        self.assertEqual(self.at(3.01, 0.01, 0.0), ["obstacle/part"])
        self.assertEqual(self.at(self.ball.x + 0.5, 0, 0), ["obstacle/held"])
        listed = self.proximity.get_allowed(rules=True).entries
        self.assertIn(("robot/ball", "obstacle/part"), [(each.first, each.second) for each in listed])
        with self.assertRaisesRegex(ProximityError, "there is no scene"):
            self.proximity.load_scene("day")
        pathlib.Path(saved.path).write_text("obstacles:\n- name: part\n  colour: red\n")
        with self.assertRaisesRegex(ProximityError, r"night.yaml/obstacles\[0\]/colour is not a field of an obstacle"):
            self.proximity.load_scene("night", replace=True)
        self.assertEqual(set(self.bodies()), {"held", "lamp", "part"})

    def test_scenes_are_listed(self):
        self.assertEqual(list(self.proximity.list_scenes().names), [])
        before = time.time()
        for name in ("night", "day"):
            self.proximity.save_scene(name)
        scenes = self.folder / "own" / "scenes"
        (scenes / "notes.txt").write_text("not a scene")
        (scenes / "other.yaml").symlink_to(scenes / "day.yaml")
        far = 2 ** 33  # [s] later than a stamp can be
        os.utime(str(scenes / "night.yaml"), (far, far))
        listed = self.proximity.list_scenes()
        self.assertEqual(list(listed.names), ["day", "night"])
        self.assertTrue(before - 1.0 < listed.saved[0].to_sec() < time.time() + 1.0, listed.saved[0])
        self.assertEqual(listed.saved[1].secs, min(2 ** 32 - 1, int((scenes / "night.yaml").stat().st_mtime)))
        self.assertEqual(len(listed.unusable), 1)
        self.assertIn("other.yaml' is a link", listed.unusable[0])

    def test_without_a_folder_no_scenes_are_listed(self):
        self.kill()
        rospy.set_param("/proximity/state_folder", "")
        self.start()
        with self.assertRaisesRegex(Refused, "RESOURCE_DENIED: scenes are stored in ~state_folder, which is not set"):
            self.proximity.list_scenes()

    def test_a_scene_is_valid_as_parameters(self):
        self.apply(
            obstacles.add("held", obstacles.box((0.1, 0.2, 0.3))),
            obstacles.attach("held", "robot/ball", (0.5, 0, 0), touch=["obstacle/lamp"]),
        )
        path = self.proximity.save_scene("night").path
        content = yaml.safe_load(pathlib.Path(path).read_text())
        self.kill()
        configured = rospy.get_param("/proximity/obstacles")
        shutil.rmtree(str(self.folder / "own"))
        try:
            rospy.set_param("/proximity/obstacles", content["obstacles"])
            self.start()
            self.assertEqual(set(self.bodies()), {"crate", "held", "lamp"})
            self.assertEqual(self.bodies()["held"].note, "")
            self.assertEqual(self.at(self.ball.x + 0.5, 0, 0), ["obstacle/held"])
            self.apply(obstacles.detach("held"))
        finally:
            rospy.set_param("/proximity/obstacles", configured)

    def test_a_damaged_file_is_kept_and_reported(self):
        self.apply(obstacles.add("first", obstacles.sphere(0.1), (3, 0, 0)))
        self.apply(obstacles.add("second", obstacles.sphere(0.1), (4, 0, 0)))
        self.kill()
        path = self.folder / "own" / "state"
        content = bytearray(path.read_bytes())
        content[-20] ^= 1
        path.write_bytes(content)
        self.node = subprocess.Popen(["rosrun", "hgrid_proximity", "proximity_node", "__name:=proximity"])
        self.proximity = Proximity(timeout=PATIENCE)
        deadline = time.monotonic() + PATIENCE
        while set(self.bodies()) != {"crate", "lamp", "first"}:
            self.assertLess(time.monotonic(), deadline)
        self.assertFalse(self.proximity.query_sphere((0, 9, 0), 0.1).clear)
        status = self.diagnostic()
        self.assertEqual(status.level, DiagnosticStatus.ERROR)
        self.assertIn("own/state' is damaged: the record at byte", status.message)
        self.assertEqual((self.folder / "own" / "state.damaged").read_bytes(), bytes(content))
        self.restart()
        self.assertEqual(set(self.bodies()), {"crate", "lamp", "first"})

    def test_no_durable_change_is_lost_by_kill_9(self):
        """Each round changes obstacles until the node is killed, and compares what the next run has: the changes that were
        confirmed, and perhaps the one that was not answered."""
        seed = 1
        chance = random.Random(seed)
        known = {}  # x of the obstacles, as confirmed
        slowest = 0.0
        for round_ in range(KILLS):
            pending = dict(known)
            killer = threading.Timer(chance.uniform(0.05, 0.6), lambda: self.node.send_signal(signal.SIGKILL))
            killer.start()
            impatient = Proximity(timeout=5.0)
            try:
                while True:
                    name = "thing%d" % chance.randrange(8)
                    pending = dict(known)
                    if name in known and chance.random() < 0.4:
                        pending.pop(name)
                        change = obstacles.remove(name)
                    else:
                        pending[name] = 10.0 + chance.randrange(1000)
                        change = obstacles.add(name, obstacles.sphere(0.1), (pending[name], 0, 0), replace=True)
                    if impatient.apply_obstacles(change).durable:
                        known = pending
            except ProximityError:
                pass  # the node was killed
            killer.join()
            impatient.close()
            self.kill()
            slowest = max(slowest, self.start())
            things = [(name, body) for name, body in self.bodies().items() if name.startswith("thing")]
            found = {name: round(body.pose.position.x, 6) for name, body in things}
            self.assertIn(found, (known, pending), "round %d, seed %d" % (round_, seed))
            known = found
        print("slowest restart: %.2f s" % slowest)


if __name__ == "__main__":
    rosunit.unitrun("hgrid_proximity", "state", State)
