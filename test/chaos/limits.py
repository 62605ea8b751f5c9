#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""A node runs out of file descriptors, and logs to a full disk. It goes on, and recovers."""
import pathlib
import resource
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).with_name("support")))

import tcpros  # noqa: E402  (the path comes first)
from cell import FREE, HAND, NAME, expect, robot, sphere  # noqa: E402
from chaos import Deadline, calm_after, main  # noqa: E402

DESCRIPTORS = 64  # limit of the node
CONNECTIONS = 200


def limit_descriptors():
    """Runs in the process of the node before the node."""
    resource.setrlimit(resource.RLIMIT_NOFILE, (DESCRIPTORS, DESCRIPTORS))


def open_descriptors(pid):
    return len(list(pathlib.Path("/proc/%d/fd" % pid).iterdir()))


def processor_time(pid):
    """Returns the processor time that a process has used [s]."""
    fields = pathlib.Path("/proc/%d/stat" % pid).read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / 100.0


def check_descriptors(cell, rng, seconds):
    """Without free descriptors, existing clients are served. When connections end, new clients are served again."""
    cell.node = cell.start_node(preexec_fn=limit_descriptors)
    cell.wait_until_right()
    place = tcpros.service_place(cell.master, NAME + "/query_sphere")
    rounds, answers = 0, 0
    with calm_after(cell):
        deadline = Deadline(seconds)
        while deadline or rounds == 0:
            connections = [tcpros.connect(place) for _ in range(CONNECTIONS)]
            cell.wait("a node that can accept no more connections",  # one descriptor stays free; accept() needs two
                      lambda: open_descriptors(cell.node.pid) >= DESCRIPTORS - 1)
            used, begin = processor_time(cell.node.pid), time.monotonic()
            full = Deadline(rng.uniform(0.5, 1.5))
            while full:
                expect("verdicts for a client from before", ("HIT", "CLEAR"), (cell.verdict(HAND), cell.verdict(FREE)))
                answers += 2
                time.sleep(0.01)  # else the questions of this program would be the load
            share = (processor_time(cell.node.pid) - used) / (time.monotonic() - begin)
            for connection in connections:
                connection.close()
            cell.wait("free descriptors", lambda: open_descriptors(cell.node.pid) < DESCRIPTORS - 10)
            proxy = cell.client()
            expect("answer to a new client", True, proxy(sphere(FREE)).answer.success)
            proxy.close()
            rounds += 1
    print("%d times without free descriptors; %d answers; last share of a processor %.0f %%" % (
        rounds, answers, 100 * share))


def check_full_disk(cell, seconds):
    """The log goes to a file on a full disk, and the output as well. Only the log is lost."""
    cell.node.terminate()
    cell.node.wait()
    with open("/dev/full", "wb") as full:
        cell.node = cell.start_node("__log:=/dev/full", stdout=full, stderr=full)
    cell.wait_until_right()
    with calm_after(cell):
        deadline = Deadline(seconds)
        lines = 0
        while deadline:
            cell.pause(cell.hand)
            cell.wait("an incomplete world, which is logged", lambda: not cell.status().world.complete)
            cell.resume(cell.hand)
            cell.wait_until_right()
            lines += 1
    print("%d times, the node logged to a full disk" % lines)


def limits(cell, rng, seconds):
    cell.set("/robot_description", robot("hand"))
    cell.params()
    cell.hand = cell.start_puppet()
    check_descriptors(cell, rng, 0.5 * seconds)
    check_full_disk(cell, 0.5 * seconds)


if __name__ == "__main__":
    main(limits)
