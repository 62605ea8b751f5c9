#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""The node is killed, shut down or crashed at random times. Each time, proximity.launch starts it again."""
import collections
import contextlib
import http.client
import json
import os
import pathlib
import signal
import subprocess
import sys
import time
import xmlrpc.client

sys.path.insert(0, str(pathlib.Path(__file__).with_name("support")))

from cell import AUDIT, NAME, POST, expect, robot  # noqa: E402  (needs the path above)
from chaos import Deadline, check_audit, main  # noqa: E402

RESTART = 2.0  # [s] a new process must exist within this time after the end of the old one
DEPTH = 200000  # number of nested arrays in the request of crash()


def node_uri(cell):
    return cell.master.lookupNode("/test", NAME)[2]


def is_running(pid):
    """Whether a process exists and is not a zombie."""
    try:
        return pathlib.Path("/proc/%d/stat" % pid).read_text().rpartition(")")[2].split()[0] != "Z"
    except FileNotFoundError:
        return False


def children_of(thread):
    """Returns the ids of the processes that a thread has started. `thread` is its folder below /proc."""
    try:
        return [int(pid) for pid in (thread / "children").read_text().split()]
    except (FileNotFoundError, ProcessLookupError):  # the thread has ended
        return []


def node_of(launch):
    """Returns the process id of the node that roslaunch has started; None if there is none."""
    threads = list(pathlib.Path("/proc/%d/task" % launch.pid).iterdir())
    running = [pid for thread in threads for pid in children_of(thread) if is_running(pid)]
    expect("nodes of one launch file", "at most 1", running, len(running) <= 1)
    return running[0] if running else None


def kill(_, pid):
    os.kill(pid, signal.SIGKILL)


def end_by_rosnode(cell, _):
    cell.start("rosnode", "kill", NAME).wait()


def crash(cell, _):
    """Sends a request with nested arrays. roscpp reads each of them by a recursive call, until the stack overflows."""
    body = "<methodCall><methodName>getPid</methodName><params><param>%s%s</param></params></methodCall>" % (
        "<value><array><data>" * DEPTH, "</data></array></value>" * DEPTH)
    host, port = node_uri(cell).rstrip("/").rpartition("//")[2].split(":")
    connection = http.client.HTTPConnection(host, int(port), timeout=10)
    try:
        connection.request("POST", "/", body, {"Content-Type": "text/xml"})
        connection.getresponse()
    except (OSError, http.client.HTTPException):
        pass  # the node has ended
    finally:
        connection.close()


WAYS = {"kill -9": kill, "rosnode kill": end_by_rosnode, "deep XML-RPC": crash}


def restart(cell, launch, way):
    """Ends the node by one of WAYS. Returns how long it took until roslaunch had started it again [s]."""
    old = cell.wait("a node", lambda: node_of(launch))
    WAYS[way](cell, old)
    cell.wait("the end of the node by " + way, lambda: not is_running(old))
    begin = time.monotonic()
    cell.wait("a new node after " + way, lambda: node_of(launch) not in (None, old))
    took = time.monotonic() - begin
    expect("new start after " + way, "at most %g s" % RESTART, "%.2f s" % took, took <= RESTART)
    cell.take()
    epoch = cell.status().world.epoch
    cell.wait("a message of the new node", lambda: cell.status().world.epoch != epoch)
    cell.wait_until_right()
    return took


@contextlib.contextmanager
def launched(cell):
    """Runs proximity.launch within this context. Then sends SIGINT to roslaunch, which must also end its node."""
    params = pathlib.Path(cell.folder) / "cell.yaml"
    params.write_text(json.dumps(dict({"world_frame": "world", "obstacles": [POST]}, **AUDIT)))  # JSON is also YAML
    with open(cell.output, "ab") as output:
        launch = cell.start("roslaunch", "-p", cell.uri.rpartition(":")[2], "hgrid_proximity", "proximity.launch",
                            "params:=%s" % params, stdout=output, stderr=subprocess.STDOUT)
    try:
        yield launch
    finally:
        last = node_of(launch)
        launch.send_signal(signal.SIGINT)
        launch.wait()
        expect("the node after the end of roslaunch", "it has ended", last, last is None or not is_running(last))


def restarts(cell, rng, seconds):
    cell.set("/robot_description", robot("hand"))
    cell.hand = cell.start_puppet()
    counts, slowest = collections.Counter(), 0.0
    with launched(cell) as launch:
        cell.wait_until_right()
        deadline = Deadline(seconds)
        while deadline or len(counts) < len(WAYS):
            time.sleep(rng.uniform(0.0, 0.5))  # chaos: the node ends at a random time
            way = rng.choice([way for way in WAYS if way not in counts] or sorted(WAYS))
            slowest = max(slowest, restart(cell, launch, way))
            counts[way] += 1
        check_audit(cell)
    print("%s; the slowest new start took %.2f s" % (dict(counts), slowest))


if __name__ == "__main__":
    main(restarts)
