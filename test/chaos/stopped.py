#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Subscribers read nothing, publishers are stopped and killed, and the node itself is stopped for 10 s."""
import pathlib
import sys
import threading
import time

sys.path.insert(0, str(pathlib.Path(__file__).with_name("support")))

import rospy  # noqa: E402  (needs the path above)
import tcpros  # noqa: E402
from cell import FREE, HAND, NAME, POST, Cell, expect, resident, sphere  # noqa: E402
from chaos import FLOW, GROWTH, Deadline, calm_after, main  # noqa: E402
from geometry_msgs.msg import TransformStamped  # noqa: E402
from hgrid_proximity.msg import BodyState, Events, Pairs, Verdict  # noqa: E402
from tf2_msgs.msg import TFMessage  # noqa: E402

STALLED = 8  # subscribers that read nothing
PILE = 1000  # number of obstacles at one place; ~pairs then has megabytes per second
ENOUGH = 5 * GROWTH  # [MB] data that a topic must send; the test would notice if the node stored so much
EVENT_QUEUE = 10  # ~limits/event_queue
FAR = (-10.0, 0.0, 0.0)  # [m] a place far from the pile
STOPPED = 10.0  # [s] how long the node is stopped


def pile():
    """Returns the post, and obstacles around the hand. Each of these makes a pair with the hand only."""
    shape = [{"type": "sphere", "radius": 0.1}]
    return [POST] + [{"name": "pile_%04d" % i, "pose": {"xyz": [1, 0, 0]}, "shapes": shape} for i in range(PILE)]


def stall(uri, topic, kind):
    """Subscribes to a topic with a small buffer, and then reads nothing."""
    connection = tcpros.connect(tcpros.topic_place(uri, topic), receive_buffer=4096)
    connection.sendall(tcpros.header(topic=topic, md5sum=kind._md5sum, callerid="/stalled", type=kind._type))
    tcpros.answer(connection)
    return connection


class Listener:
    """A subscriber that reads all messages. Counts them and their bytes."""

    def __init__(self, topic):
        self.messages, self.megabytes, self.largest = 0, 0.0, 0.0
        self._subscriber = rospy.Subscriber(topic, rospy.AnyMsg, self._on_message)

    def _on_message(self, message):
        size = 1e-6 * len(message._buff)
        self.messages += 1
        self.megabytes += size
        self.largest = max(self.largest, size)

    def close(self):
        self._subscriber.unregister()


class Jumper:
    """Moves the hand in each tick, into the pile or far from it. So each tick begins or ends all pairs of the hand."""

    def __init__(self, rate):
        self._publisher = rospy.Publisher("/tf", TFMessage, queue_size=1)
        self._step = 0
        self._timer = rospy.Timer(rospy.Duration(1.0 / rate), self._jump)

    def _jump(self, _):
        self._place(HAND if self._step % 2 else FAR)
        self._step += 1

    def _place(self, place):
        message = TransformStamped()
        message.header.frame_id, message.child_frame_id, message.header.stamp = "world", "hand", rospy.Time.now()
        message.transform.translation.x = place[0]
        message.transform.rotation.w = 1.0
        self._publisher.publish(TFMessage([message]))

    def close(self, cell):
        """Stops the motion, and leaves the hand far from the pile."""
        self._timer.shutdown()
        self._timer.join()
        self._place(FAR)
        cell.wait("the hand at %s" % (FAR,), lambda: cell.verdict(FAR) == "HIT")
        self._publisher.unregister()


def check_stalled_subscribers(cell, topic, kind, queue, seconds):
    """Checks that subscribers that read nothing cost at most the memory of one queue.

    Meanwhile, ticks must continue, and another subscriber must receive messages. `queue` is a number of messages."""
    uri = cell.master.lookupNode("/test", NAME)[2]
    before, first, begin = resident(cell.node.pid), cell.status().world.sequence, time.monotonic()
    connections = [stall(uri, topic, kind) for _ in range(STALLED)]
    listener = Listener(topic)
    time.sleep(seconds)  # chaos: meanwhile, the node publishes far more than the buffers of the system hold
    cell.wait("%g MB of %s" % (ENOUGH, topic), lambda: listener.megabytes >= ENOUGH)
    grown = resident(cell.node.pid) - before
    ticks = cell.status().world.sequence - first
    rate = ticks / (time.monotonic() - begin)
    listener.close()
    most = GROWTH + queue * listener.largest  # roscpp keeps a message once for all subscribers
    expect("growth with %d stalled subscribers to %s" % (STALLED, topic), "at most %.1f MB" % most,
           "%.1f MB" % grown, grown <= most)
    expect("ticks per second", "at least %g of 100" % (100 * FLOW), "%.1f" % rate, rate >= 100 * FLOW)
    expect("messages of %s that another subscriber got" % topic, "at least a quarter of %d" % ticks,
           listener.messages, listener.messages >= 0.25 * ticks)
    for connection in connections:
        connection.close()
    print("%s: %d subscribers read nothing of %.0f MB; the node grew by %.1f MB; %.0f ticks per second" % (
        topic, STALLED, listener.megabytes, grown, rate))


def check_stalled_events(cell, seconds):
    """Runs check_stalled_subscribers() for ~events, while each tick begins or ends a thousand pairs."""
    cell.hand.kill()
    cell.hand.wait()
    jumper = Jumper(100)
    check_stalled_subscribers(cell, NAME + "/events", Events, EVENT_QUEUE, seconds)
    jumper.close(cell)
    cell.hand = cell.start_puppet()
    cell.wait("the hand to leave %s" % (FAR,), lambda: cell.verdict(FAR) == "CLEAR")


def check_publishers(cell, rng, seconds):
    """Stops or kills the publisher of the hand again and again.

    Checks that the hand is then LOST and that no query near it is CLEAR. When the publisher runs again, all answers
    must be right."""
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
    """Checks a query that waits while the node is stopped: its answer may be CLEAR only from a tick after the stop."""
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
    cell.begin(obstacles=pile(), rate=100, follow_data=False, limits={"event_queue": EVENT_QUEUE})
    with calm_after(cell):
        check_stalled_subscribers(cell, NAME + "/pairs", Pairs, 1, 0.3 * seconds)
    with calm_after(cell, growth=2 * GROWTH):
        check_stalled_events(cell, 0.3 * seconds)
    with calm_after(cell):
        check_publishers(cell, rng, 0.3 * seconds)
    with calm_after(cell):
        check_stopped_node(cell)


if __name__ == "__main__":
    main(stopped)
