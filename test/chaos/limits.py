#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""A node has no free file descriptors. Another node logs to a full disk. Both continue to answer, and recover."""
import pathlib
import resource
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).with_name("support")))

import tcpros  # noqa: E402  (needs the path above)
from cell import FREE, HAND, NAME, expect, robot, sphere  # noqa: E402
from chaos import Deadline, calm_after, main  # noqa: E402

DESCRIPTORS = 64  # the node may have at most so many open files
CONNECTIONS = 200


def limit_descriptors():
    """Limits the file descriptors of this process. The new process calls this before it becomes the node."""
    resource.setrlimit(resource.RLIMIT_NOFILE, (DESCRIPTORS, DESCRIPTORS))


def open_descriptors(pid):
    return len(list(pathlib.Path("/proc/%d/fd" % pid).iterdir()))


def processor_time(pid):
    """Returns the processor time that a process has used [s]."""
    fields = pathlib.Path("/proc/%d/stat" % pid).read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / 100.0


def check_descriptors(cell, rng, seconds):
    """Checks that a node without free descriptors serves existing clients. Later, it must serve new clients again."""
    cell.node = cell.start_node(preexec_fn=limit_descriptors)
    cell.wait_until_right()
    place = tcpros.service_place(cell.master, NAME + "/query_sphere")
    rounds, answers = 0, 0
    with calm_after(cell):
        deadline = Deadline(seconds)
        while deadline or rounds == 0:
            connections = [tcpros.connect(place) for _ in range(CONNECTIONS)]
            cell.wait("a node that can accept no more connections",  # accept() needs two, so one stays free
                      lambda: open_descriptors(cell.node.pid) >= DESCRIPTORS - 1)
            used, begin = processor_time(cell.node.pid), time.monotonic()
            full = Deadline(rng.uniform(0.5, 1.5))
            while full:
                expect("verdicts for an old client", ("HIT", "CLEAR"), (cell.verdict(HAND), cell.verdict(FREE)))
                answers += 2
                time.sleep(0.01)  # without a pause, the queries would load the processor
            share = (processor_time(cell.node.pid) - used) / (time.monotonic() - begin)
            for connection in connections:
                connection.close()
            cell.wait("free descriptors", lambda: open_descriptors(cell.node.pid) < DESCRIPTORS - 10)
            proxy = cell.client()
            expect("answer to a new client", True, proxy(sphere(FREE)).answer.success)
            proxy.close()
            rounds += 1
    print("%d times without free descriptors; %d answers; in the last round, the node used %.0f %% of a processor" % (
        rounds, answers, 100 * share))


def check_full_disk(cell, seconds):
    """Checks that a node whose log and output go to a full disk loses nothing except its log."""
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
    print("the node logged %d times to a full disk" % lines)


def limits(cell, rng, seconds):
    cell.set("/robot_description", robot("hand"))
    cell.params()
    cell.hand = cell.start_puppet()
    check_descriptors(cell, rng, 0.5 * seconds)
    check_full_disk(cell, 0.5 * seconds)


if __name__ == "__main__":
    main(limits)
