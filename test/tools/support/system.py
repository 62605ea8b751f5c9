# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""A ROS system for one test: a master on a free port of 127.0.0.1, nodes and parameters, and a shell for what the
doctor says."""
import json
import functools
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from xmlrpc.client import ServerProxy

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tools"))

import yaml  # noqa: E402  (the path comes first)
from hgrid_doctor.fixes import PARAM_FILE  # noqa: E402
from hgrid_doctor.observe.connection import Connection  # noqa: E402
from hgrid_doctor.observe.graph import ApiError  # noqa: E402
from shell import Shell  # noqa: E402

PUPPET = str(ROOT / "test/tools/support/puppet.py")
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
        time.sleep(0.03)  # polls, because the master sends no message when something registers
    raise AssertionError("waited %g s for %s" % (PATIENCE, what))


@functools.lru_cache(maxsize=None)
def program(package, name):
    return subprocess.check_output(["catkin_find", "--first-only", "--libexec", package, name]).decode().strip()


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
        self.environment["HOME"] = self.folder
        self.environment["PATH"] = self.folder + "/bin:" + self.environment["PATH"]
        for name in ("ROS_HOSTNAME", "ROS_NAMESPACE"):
            self.environment.pop(name, None)

    def __enter__(self):
        self.start_master()
        self.shell = Shell(self.environment, self.folder, PATIENCE)
        return self

    def __exit__(self, *_):
        self.shell.end()
        for process in self.processes:
            process.kill()  # SIGKILL is enough, because nothing of the process is used again
        for process in self.processes:
            process.wait()
        shutil.rmtree(self.folder, ignore_errors=True)

    def start_master(self):
        """Starts the master and waits for its first answer."""
        self.master_process = self.start("rosmaster", "--core", "-p", str(self._port))
        wait_for("the master", self.state)

    @staticmethod
    def hang(process):
        """From now on, the process accepts connections but never answers."""
        os.kill(process.pid, signal.SIGSTOP)

    @staticmethod
    def kill(process):
        process.kill()
        process.wait()

    @staticmethod
    def end(process):
        """Ends a node in order, as Ctrl-C does."""
        process.send_signal(signal.SIGINT)
        process.wait(PATIENCE)

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
        process = self.start("rosrun", "robot_state_publisher", "robot_state_publisher", *arguments)
        wait_for("robot_state_publisher", lambda: "/robot_state_publisher" in self.publishers("/tf"))
        return process

    def puppet(self, name, *arguments):
        process = self.start(sys.executable, PUPPET, name, *arguments)
        topic = "/joint_states" if "--joints" in arguments else "/tf"
        wait_for(name, lambda: "/" + name in self.publishers(topic))
        return process

    def joint_states(self, joints=tuple(ARM_JOINTS)):
        return self.puppet("driver", "--joints", ",".join(joints))

    def node(self, until, name="/proximity", **params):
        """Starts the node with parameters, on the server and in a file. Waits until its ~status meets a condition."""
        params["rate"] = 10  # [Hz] so low that ticks are not late while other tests run
        self.write(PARAM_FILE, yaml.safe_dump(params))
        for key, value in params.items():
            self.set(name + "/" + key, value)
        namespace, _, base = name.rpartition("/")
        place = "__ns:=" + (namespace or "/")
        process = self.start(program("hgrid_proximity", "proximity_node"), "__name:=" + base, place)
        self.wait_for_status(until, name)
        return process

    def write(self, file, text):
        path = pathlib.Path(self.folder, file)
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(text if isinstance(text, bytes) else text.encode())

    def change_params(self, line):
        """Puts a line into the parameter file of the node."""
        file = pathlib.Path(self.folder, PARAM_FILE)
        file.write_text(yaml.safe_dump({**yaml.safe_load(file.read_text()), **yaml.safe_load(line)}))

    def doctor(self, *arguments):
        """Runs the doctor in the shell. Returns its exit code and its findings."""
        command = [sys.executable, str(ROOT / "tools/doctor"), "--json", "--listen", "1", *arguments]
        code, output = self.shell.type(" ".join(command))
        return code, json.JSONDecoder().raw_decode(output, output.index("{"))[0]["findings"]  # bash may add notices

    def type(self, text):
        """Types what a fix says in backticks: a command into the shell, or a line into the parameter file.

        Returns the output of the command, see Shell.type().
        """
        if re.match(r"\w+: ", text):
            return self.change_params(text)
        code, output = self.shell.type(text)
        if code != 0:
            raise AssertionError("'%s' ends with %d: %s" % (text, code, output))
        if text.startswith("rosnode kill "):
            wait_for("the end of " + text.split()[-1], lambda: text.split()[-1] not in self.nodes())
        return output.strip()

    def publishers(self, topic):
        return dict(self.state()[0]).get(topic, [])

    def nodes(self):
        return {node for registrations in self.state() for _, nodes in registrations for node in nodes}

    def pid(self, node):
        return ServerProxy(self.master.lookupNode("/test", node)[2]).getPid("/test")[2]

    def state(self):
        try:
            return self.master.getSystemState("/test")[2]
        except OSError:
            return None

    def wait_for_status(self, until, name="/proximity"):
        """Waits until the ~status of the node meets a condition. The node may be started or replaced meanwhile."""
        wait_for("a ~status of %s that meets a condition" % name, lambda: self._has_status(until, name))

    def _has_status(self, until, name):
        """Reads ~status until it meets a condition. Returns False if there is no such node, or if it ends."""
        from hgrid_proximity.msg import Status

        if name not in self.publishers(name + "/status"):
            return False
        try:
            uri = self.master.lookupNode("/test", name)[2]
            connection = Connection(name + "/status", uri, time.monotonic() + PATIENCE, PATIENCE)
        except (OSError, ApiError):
            return False
        try:
            for data in connection.messages():
                status = Status()
                status.deserialize(data)
                if until(status):
                    return True
        finally:
            connection.close()
        return False
