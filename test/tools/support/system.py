# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""A ROS system for one test: a master on a free port of 127.0.0.1, nodes and parameters. Also runs the doctor."""
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from xmlrpc.client import ServerProxy

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tools"))

from hgrid_doctor.observe.connection import Connection  # noqa: E402  (the path comes first)

PATIENCE = 100.0  # [s] timeout for everything that a test waits for
ARM = (ROOT / "demo/six_axis_arm.urdf").read_text()
ARM_SRDF = (ROOT / "demo/six_axis_arm.srdf").read_text()
ARM_JOINTS = ["joint_%d" % number for number in range(1, 7)]


def wait_for(what, condition):
    """Waits until the condition is true. Returns its value."""
    deadline = time.monotonic() + PATIENCE
    while time.monotonic() < deadline:
        value = condition()
        if value:
            return value
        time.sleep(0.01)  # polls, because the master sends no message when something registers
    raise AssertionError("waited %g s for %s" % (PATIENCE, what))


class System:
    """A system. Its end stops all processes that it started."""

    def __init__(self):
        self._port = int(subprocess.check_output([str(ROOT / "scripts/free_port")]))
        self.uri = "http://127.0.0.1:%d" % self._port
        self.folder = tempfile.mkdtemp(prefix="hgrid_doctor.")
        self.processes = []
        self.master = ServerProxy(self.uri)
        self.environment = dict(os.environ, ROS_MASTER_URI=self.uri, ROS_IP="127.0.0.1", ROS_HOME=self.folder)
        self.environment["ROS_LOG_DIR"] = self.folder + "/log"
        for name in ("ROS_HOSTNAME", "ROS_NAMESPACE"):
            self.environment.pop(name, None)

    def __enter__(self):
        self.start_master()
        return self

    def __exit__(self, *_):
        for process in self.processes:
            process.kill()  # SIGKILL is enough, because nothing of the process is used again
        for process in self.processes:
            process.wait()
        shutil.rmtree(self.folder, ignore_errors=True)

    def start_master(self):
        """Starts the master and waits for its first answer. Returns its process."""
        process = self.start("rosmaster", "--core", "-p", str(self._port))
        wait_for("the master", self._state)
        return process

    def lose_master(self):
        """From now on, the doctor uses an address at which there is no master."""
        self.environment["ROS_MASTER_URI"] = "http://127.0.0.1:1"

    def hang_master(self):
        """From now on, the master accepts connections but never answers."""
        os.kill(self.processes[0].pid, signal.SIGSTOP)

    def start(self, *command, **options):
        """Starts a process without input and output. Its options are those of subprocess.Popen."""
        silent = {stream: subprocess.DEVNULL for stream in ("stdin", "stdout", "stderr")}
        process = subprocess.Popen(command, env=self.environment, **{**silent, **options})
        self.processes.append(process)
        return process

    def set(self, name, value):
        self.master.setParam("/test", name, value)

    def robot(self, description=ARM, semantic=ARM_SRDF):
        """Sets the descriptions of the robot on the parameter server."""
        self.set("/robot_description", description)
        if semantic:
            self.set("/robot_description_semantic", semantic)

    def state_publisher(self, *arguments):
        self.start("rosrun", "robot_state_publisher", "robot_state_publisher", *arguments)
        wait_for("robot_state_publisher", lambda: "/robot_state_publisher" in self.publishers("/tf"))

    def puppet(self, name, *arguments):
        self.start(sys.executable, str(ROOT / "test/tools/support/puppet.py"), name, *arguments)
        topic = "/joint_states" if "--joints" in arguments else "/tf"
        wait_for(name, lambda: "/" + name in self.publishers(topic))

    def joint_states(self, joints=tuple(ARM_JOINTS)):
        self.puppet("driver", "--joints", ",".join(joints))

    def node(self, until, name="/proximity"):
        """Starts the node and waits until its ~status meets a condition."""
        self.set(name + "/rate", 20)  # [Hz] so low that ticks are not late while other tests run
        namespace, _, base = name.rpartition("/")
        process = self.start(
            "rosrun", "hgrid_proximity", "proximity_node", "__name:=" + base, "__ns:=" + (namespace or "/")
        )
        wait_for("~status of " + name, lambda: name in self.publishers(name + "/status"))
        uri = wait_for(name, lambda: self.master.lookupNode("/test", name)[2])
        self._wait_for_status(name, uri, until)
        return process

    def doctor(self, *arguments):
        """Runs the doctor. Returns its exit code and its findings."""
        command = ["rosrun", "hgrid_proximity", "doctor", "--json", "--listen", "1", "--timeout", "1", *arguments]
        streams = {"stdin": subprocess.DEVNULL, "stdout": subprocess.PIPE}
        ended = subprocess.run(command, env=self.environment, timeout=PATIENCE, check=False, **streams)
        return ended.returncode, json.loads(ended.stdout.decode())["findings"]

    def publishers(self, topic):
        return dict(self._state()[0]).get(topic, [])

    def _state(self):
        try:
            return self.master.getSystemState("/test")[2]
        except OSError:
            return None

    @staticmethod
    def _wait_for_status(name, uri, until):
        from hgrid_proximity.msg import Status

        connection = Connection(name + "/status", uri, time.monotonic() + PATIENCE, PATIENCE)
        try:
            for data in connection.messages():
                status = Status()
                status.deserialize(data)
                if until(status):
                    return
        finally:
            connection.close()
        raise AssertionError("waited %g s for a ~status of %s that meets a condition" % (PATIENCE, name))
