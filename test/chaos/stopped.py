#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Subscribers that read nothing, publishers that are stopped and killed, and the node itself stopped for 10 s."""
import pathlib
import sys
import threading
import time

sys.path.insert(0, str(pathlib.Path(__file__).with_name("support")))

import rospy  # noqa: E402  (the path comes first)
import tcpros  # noqa: E402
from cell import FREE, HAND, NAME, POST, Cell, expect, resident, sphere  # noqa: E402
from chaos import FLOW, GROWTH, Deadline, calm_after, main  # noqa: E402
from hgrid_proximity.msg import BodyState, Pairs, Verdict  # noqa: E402

STALLED = 8  # subscribers that read nothing
PILE = 1000  # obstacles at one place, so that ~pairs has megabytes per second
ENOUGH = 5 * GROWTH  # [MB] of ~pairs; if the node kept them for a stalled subscriber, its growth would show
STOPPED = 10.0  # [s] how long the node is stopped


def pile():
    """Returns obstacles around the hand. Each makes a pair with it and with nothing else."""
    shape = [{"type": "sphere", "radius": 0.1}]
    return [POST] + [{"name": "pile_%04d" % i, "pose": {"xyz": [1, 0, 0]}, "shapes": shape} for i in range(PILE)]


def stall(uri):
    """Subscribes to ~pairs with a small buffer, and then reads nothing."""
    topic = NAME + "/pairs"
    connection = tcpros.connect(tcpros.topic_place(uri, topic), receive_buffer=4096)
    connection.sendall(tcpros.header(topic=topic, md5sum=Pairs._md5sum, callerid="/stalled", type=Pairs._type))
    tcpros.answer(connection)
    return connection


class Listener:
    """A subscriber to ~pairs that reads everything. Counts what it gets."""

    def __init__(self):
        self.messages, self.megabytes = 0, 0.0
        self._subscriber = rospy.Subscriber(NAME + "/pairs", Pairs, self._on_pairs)

    def _on_pairs(self, pairs):
        self.messages += 1
        self.megabytes += 57e-6 * len(pairs.gap)  # the numbers of each pair alone, without names

    def close(self):
        self._subscriber.unregister()


def check_stalled_subscribers(cell, seconds):
    """Subscribers that read nothing cost little memory. Ticks and another subscriber go on."""
    uri = cell.master.lookupNode("/test", NAME)[2]
    with calm_after(cell):
        before, first, begin = resident(cell.node.pid), cell.status().world.sequence, time.monotonic()
        connections = [stall(uri) for _ in range(STALLED)]
        listener = Listener()
        time.sleep(seconds)  # the chaos: meanwhile, the node publishes far more than the buffers of the system hold
        cell.wait("%g MB of ~pairs" % ENOUGH, lambda: listener.megabytes >= ENOUGH)
        grown = resident(cell.node.pid) - before
        ticks = cell.status().world.sequence - first
        rate = ticks / (time.monotonic() - begin)
        listener.close()
        expect("growth with %d stalled subscribers" % STALLED, "at most %g MB" % GROWTH, "%.1f MB" % grown,
               grown <= GROWTH)
        expect("ticks per second", "at least %g of 100" % (100 * FLOW), "%.1f" % rate, rate >= 100 * FLOW)
        expect("messages that another subscriber got", "at least half of %d" % ticks, listener.messages,
               listener.messages >= 0.5 * ticks)
        for connection in connections:
            connection.close()
    print("%d subscribers read nothing of %.0f MB; the node grew by %.1f MB; %.0f ticks per second" % (
        STALLED, listener.megabytes, grown, rate))


def check_publishers(cell, rng, seconds):
    """While a publisher is stopped or killed, the hand is lost and nothing near it is CLEAR. Then all is as before."""
    deadline = Deadline(seconds)
    rounds = 0
    while deadline or rounds == 0:
        killed = rng.random() < 0.5
        if killed:
            cell.hand.kill()
            cell.hand.wait()
        else:
            cell.pause(cell.hand)
        cell.wait("LOST", lambda: cell.status().world.worst_state == BodyState.LOST)
        expect("complete while the hand is lost", False, cell.status().world.complete)
        expect("verdict at the last place of the hand", "HIT", cell.verdict(HAND))
        expect("verdict where the lost hand may be", "UNKNOWN", cell.verdict(FREE))
        if killed:
            cell.hand = cell.start_puppet()
        else:
            cell.resume(cell.hand)
        cell.wait_until_right()
        rounds += 1
    print("%d publishers were stopped or killed" % rounds)


def check_stopped_node(cell):
    """The answer to a question that waited while the node was stopped is CLEAR only from a tick after that."""
    answers = []
    proxy = Cell.client()
    expect("verdict before the stop", Verdict.CLEAR, proxy(sphere(FREE)).answer.verdict)
    cell.pause(cell.node)
    begin = rospy.get_time()
    thread = threading.Thread(target=lambda: answers.append(proxy(sphere(FREE))), daemon=True)
    thread.start()
    thread.join(STOPPED)
    expect("answers of a stopped node", [], answers)
    cell.resume(cell.node)
    resumed = rospy.get_time()
    thread.join(STOPPED)
    expect("answers after the node goes on", 1, len(answers))
    answer, world = answers[0].answer, answers[0].world
    fresh = world.valid_until.to_sec() > resumed
    expect("answer after %.1f s of standstill" % (resumed - begin), "UNKNOWN, or CLEAR from a new tick",
           answer.summary, answer.verdict == Verdict.UNKNOWN or fresh)
    print("answer after the standstill: " + answer.summary)


def stopped(cell, rng, seconds):
    cell.begin(obstacles=pile(), rate=100)
    check_stalled_subscribers(cell, 0.4 * seconds)
    with calm_after(cell):
        check_publishers(cell, rng, 0.4 * seconds)
    with calm_after(cell):
        check_stopped_node(cell)


if __name__ == "__main__":
    main(stopped)
