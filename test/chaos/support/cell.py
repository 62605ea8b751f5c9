# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""A master and a node for one chaos test. The world of the node is a robot with one moving link, and a post."""
import os
import pathlib
import signal
import sys
import threading
import time
from xmlrpc.client import ServerProxy

import rospy

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "test/tools/support"))

from system import System, wait_for  # noqa: E402  (needs the path above)
from hgrid_proximity.msg import Status, Verdict  # noqa: E402
from hgrid_proximity.srv import QuerySphere  # noqa: E402

NODE = str(ROOT / "devel/lib/hgrid_proximity/proximity_node")
NAME = "/proximity"
SPHERE = '<collision><origin xyz="%s"/><geometry><sphere radius="0.1"/></geometry></collision>'
# The node audits 10 ticks per second. Older nodes do not have the parameter and no audit.
AUDIT = {"audit_rate": 10.0} if "audit_rate" in (ROOT / "src/node/params/params.h").read_text() else {}
POST = {"name": "post", "pose": {"xyz": [2, 0, 0]}, "shapes": [{"type": "sphere", "radius": 0.1}]}
HAND, POST_PLACE, FREE = (1.0, 0.0, 0.0), (2.0, 0.0, 0.0), (0.0, 3.0, 0.0)  # [m] places of queries; FREE is empty
VERDICTS = {Verdict.UNKNOWN: "UNKNOWN", Verdict.CLEAR: "CLEAR", Verdict.HIT: "HIT"}


class Failure(AssertionError):
    """A failed check. Its text says what the test expected and what it saw."""


def expect(what, expected, seen, holds=None):
    """Raises Failure if `holds` is false. If `holds` is None: raises Failure if `seen` differs from `expected`."""
    if not (seen == expected if holds is None else holds):
        raise Failure("%s: expected %s, saw %s" % (what, expected, seen))


def sphere(place):
    """Returns a request to ~query_sphere for a sphere with a radius of 0.05 m at a place."""
    request = QuerySphere._request_class(radius=0.05)
    request.center.x, request.center.y, request.center.z = place
    return request


def robot(*links):
    """Returns the URDF of a robot. Floating joints connect its links to the root link "world"."""
    text = '<link name="world">%s</link>' % (SPHERE % "0 0 -5")
    for link in links:
        text += '<link name="%s">%s</link>' % (link, SPHERE % "0 0 0")
        text += '<joint name="to_%s" type="floating"><parent link="world"/><child link="%s"/></joint>' % (link, link)
    return "<robot name='r'>%s</robot>" % text


def resident(pid):
    """Returns the memory of a process that is in RAM [MB]."""
    for line in pathlib.Path("/proc/%d/status" % pid).read_text().splitlines():
        if line.startswith("VmRSS:"):
            return int(line.split()[1]) * 1024e-6
    raise Failure("process %d has ended" % pid)


class Cell(System):
    """A System with the node. The world is complete while the process "puppet" publishes the frame of the hand."""

    def __init__(self, simulated=False):
        super().__init__()
        self.simulated = simulated
        self.node = self.hand = None
        self.output = pathlib.Path(self.folder) / "node.log"
        self._lock = threading.Lock()
        self._heard = []
        self._proxy = self._answers = None

    def __enter__(self):
        super().__enter__()
        for name in ("ROS_MASTER_URI", "ROS_IP", "ROS_HOME", "ROS_LOG_DIR"):
            os.environ[name] = self.environment[name]
        self.set("/use_sim_time", self.simulated)
        rospy.init_node("chaos", disable_signals=True, disable_rosout=True)
        rospy.Subscriber(NAME + "/status", Status, self._on_status, queue_size=100)
        return self

    def __exit__(self, *details):
        rospy.signal_shutdown("the test has ended")
        super().__exit__(*details)

    def begin(self, **options):
        """Starts the node and the puppet. Waits until the world is complete. `options` are parameters of the node."""
        self.start_all(**options)
        self.wait_until_right()

    def start_all(self, **options):
        self.set("/robot_description", robot("hand"))
        self.params(**options)
        self.hand = self.start_puppet()
        self.node = self.start_node()

    def params(self, **options):
        self.set(NAME, {"world_frame": "world", "obstacles": [POST], **AUDIT, **options})

    def start_node(self, *arguments, **options):
        with open(self.output, "ab") as output:
            options = dict({"stdout": output, "stderr": output}, **options)
            return self.start(NODE, "__name:=proximity", *arguments, **options)

    def start_puppet(self, links=("hand",), name="puppet"):
        """Starts a process that publishes the frames of links 50 times per second."""
        frames = [word for link in links for word in ("--tf", "world", link, str(HAND[0]))]
        return self.start(sys.executable, str(ROOT / "test/tools/support/puppet.py"), name, *frames)

    def _on_status(self, status):
        with self._lock:
            self._heard.append((time.monotonic(), status))

    def take(self):
        """Returns the messages of ~status since the last call, as pairs: time of receipt [s, monotonic], message."""
        with self._lock:
            taken, self._heard = self._heard, self._heard[-1:]
        return taken

    def status(self):
        """Returns the newest message of ~status; None if none was received."""
        with self._lock:
            return self._heard[-1][1] if self._heard else None

    def counters(self):
        """Returns all counters of a tick that begins after this call."""
        before = time.monotonic()
        self.wait("two more ticks", lambda: len([1 for at, _ in list(self._heard) if at > before]) > 1)
        return {counter.name: counter.value for counter in self.status().counters}

    def wait(self, what, condition):
        """Waits until the condition is true. Returns its value."""
        try:
            return wait_for(what, condition)
        except AssertionError as late:
            raise Failure("%s; %s" % (late, self.gist())) from late

    def gist(self):
        """Returns a text for the message of a failure: newest status, last answers, end of the output of the node."""
        status, log = self.status(), ""
        if self.output.exists():
            log = "\n".join(self.output.read_text(errors="replace").splitlines()[-15:])
        if status is None:
            return "no ~status was heard; end of the node's output:\n" + log
        answers = self._answers
        if isinstance(answers, list):
            answers = [answer.summary for answer in answers]
        world = status.world
        state = "sequence %d, complete %s, reasons %s" % (world.sequence, world.complete, world.reasons)
        return "newest ~status: %s; last answers: %s; end of the node's output:\n%s" % (state, answers, log)

    def ask(self, place):
        """Asks what a small sphere touches. Returns the response. Only one thread may call this."""
        if self._proxy is None:
            self._proxy = self.client()
        try:
            return self._proxy(sphere(place))
        except rospy.ServiceException:
            self._proxy.close()
            self._proxy = None
            raise

    @staticmethod
    def client():
        """Returns a persistent client of ~query_sphere. One thread may use it."""
        return rospy.ServiceProxy(NAME + "/query_sphere", QuerySphere, persistent=True)

    def verdict(self, place):
        return VERDICTS[self.ask(place).answer.verdict]

    def is_right(self):
        """Whether the world is complete, and the answers about three places are right."""
        try:
            self._answers = [self.ask(place).answer for place in (HAND, POST_PLACE, FREE)]
        except (rospy.ServiceException, rospy.ROSException, OSError) as error:
            self._answers = error
            return False
        status = self.status()
        seen = [VERDICTS[answer.verdict] for answer in self._answers]
        return bool(status and status.world.complete and seen == ["HIT", "HIT", "CLEAR"])

    def wait_until_right(self):
        self.wait("a complete world with right answers", self.is_right)

    def received(self, topic):
        """Returns how many messages of a topic roscpp received in the node, and how many of them it dropped.

        roscpp reports only one connection of each topic."""
        subscriptions = ServerProxy(self.master.lookupNode("/test", NAME)[2]).getBusStats("/test")[1]
        links = [link for name, stats in subscriptions if name == topic for link in stats]
        return sum(link[2] for link in links), sum(link[3] for link in links)  # link: id, bytes, messages, dropped, ...

    @staticmethod
    def pause(process):
        """Stops a child process, and waits until all its threads have stopped."""
        os.kill(process.pid, signal.SIGSTOP)
        os.waitid(os.P_PID, process.pid, os.WSTOPPED | os.WEXITED | os.WNOWAIT)  # also ends if the process has died

    @staticmethod
    def resume(process):
        os.kill(process.pid, signal.SIGCONT)
