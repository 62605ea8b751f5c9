#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""The ROS master is stopped for a while, killed, and started again. The node serves its connections all the time."""
import pathlib
import sys
import time
import xmlrpc.client

sys.path.insert(0, str(pathlib.Path(__file__).with_name("support")))

from cell import FREE, HAND, NAME, expect, robot  # noqa: E402  (needs the path above)
from chaos import FLOW, Deadline, calm_after, main  # noqa: E402


def check_service(cell, seconds, what):
    """Checks for some seconds that an existing client gets right answers, and that ticks continue."""
    first, begin, answers = cell.status().world.sequence, time.monotonic(), 0
    deadline = Deadline(seconds)
    while deadline:
        expect("verdicts while " + what, ("HIT", "CLEAR"), (cell.verdict(HAND), cell.verdict(FREE)))
        expect("complete while " + what, True, cell.status().world.complete)
        answers += 2
        time.sleep(0.01)  # without a pause, the queries would load the processor
    ticks = (cell.status().world.sequence - first) / (time.monotonic() - begin)
    expect("ticks per second while " + what, "at least %g of 50" % (50 * FLOW), "%.1f" % ticks, ticks >= 50 * FLOW)
    print("while %s: %d answers, %.1f ticks per second" % (what, answers, ticks))


def is_registered(cell):
    try:
        return cell.master.lookupService("/test", NAME + "/query_sphere")[0] == 1
    except (OSError, xmlrpc.client.Error):
        return False


def master(cell, rng, seconds):
    cell.begin()
    process = cell.processes[0]
    with calm_after(cell):
        cell.pause(process)
        check_service(cell, 0.2 * seconds, "the master does not answer")
        cell.resume(process)
    with calm_after(cell):
        time.sleep(rng.uniform(0.0, 0.5))  # chaos: the master ends at a random time
        process.kill()
        process.wait()
        check_service(cell, 0.3 * seconds, "there is no master")
        cell.start_master()
        check_service(cell, 0.3 * seconds, "there is another master")
    expect("the node is registered with the other master", False, is_registered(cell))
    cell.node.terminate()
    expect("exit code after SIGTERM", 0, cell.node.wait(10))
    cell.set("/robot_description", robot("hand"))
    cell.params()
    cell.node = cell.start_node()
    cell.wait("the new node to register", lambda: is_registered(cell))


if __name__ == "__main__":
    main(master)
