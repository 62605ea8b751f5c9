# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Waits for events of the node."""
from __future__ import annotations

import queue
import time
from typing import NamedTuple, Optional
from xmlrpc.client import ServerProxy

import rosgraph
import rospy

from hgrid_proximity.errors import EventsMissed, NoAnswer
from hgrid_proximity.msg import EventKind
from hgrid_proximity.streams import BUFF_SIZE, EventArrays, as_arrays

MOST_MESSAGES = 1000  # messages that wait to be read; when there are so many, further ones are dropped


class Event(NamedTuple):
    """A pair began or ended. `rosmsg show -r hgrid_proximity/Events` explains the values."""

    number: int
    began: bool  # False: it ended
    first: str
    second: str
    gap: float  # [m] NaN if it is not known
    distance: float  # [m] NaN if it was not measured
    stamp: rospy.Time  # time of the data


class Events:
    """The events of the node from now on, in their order. One thread may wait at a time.

    A pair that is near already causes no event; `Proximity.pairs()` has it. In a new epoch (restart of the node,
    ~reset, jump of the clock) all pairs that are near begin again, and pairs of the old epoch do not end.
    """

    def __init__(self, node: str, timeout: float):
        """Subscribes to ~events of the node, and waits until the node has accepted that.

        @param timeout  [s, wall time]
        @throws NoAnswer  the node does not accept it in time
        """
        self._messages: queue.Queue = queue.Queue(MOST_MESSAGES)
        self._message, self._next = None, 0
        self._last = None  # (epoch, number) of the newest event that was read
        self._dropped = False
        self._topic = node + "/events"
        self._subscriber = rospy.Subscriber(
            self._topic, EventArrays, self._take, queue_size=MOST_MESSAGES, buff_size=BUFF_SIZE
        )
        deadline = time.monotonic() + timeout
        while not self._accepted():
            if rospy.is_shutdown():
                raise rospy.ROSInterruptException("rospy is shutting down")
            if time.monotonic() > deadline:
                self.close()
                raise NoAnswer(f"{self._topic}: no publisher within {timeout:g} s. Check the node: `rosnode ping {node}`")
            time.sleep(0.02)

    def __enter__(self) -> Events:
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        self._subscriber.unregister()

    def wait(self, one: str = "*", other: str = "*", began: Optional[bool] = True, timeout: float = 10.0):
        """Returns the next event of a pair whose bodies match the globs `one` and `other`, in either order.

        Events before it are skipped.

        @param began  True: the pair began; False: it ended; None: either
        @param timeout  [s, wall time]
        @returns None if there was no such event within the timeout
        @throws EventsMissed  events were lost before the next one; the next call goes on after them
        @throws NoAnswer  the connection to the node was lost
        @throws rospy.ROSInterruptException  this program is shutting down
        """
        deadline = time.monotonic() + timeout
        while True:
            if self._message is None and not self._receive(deadline):
                return None
            message, begin = self._message, self._next
            matching = message.select(one, other)
            for index in matching[matching >= begin]:
                if began is None or began == (message.kind[index] == EventKind.BEGIN):
                    self._next = index + 1
                    return _event(message, index)
            self._message = None

    def _accepted(self) -> bool:
        """Whether a publisher of the topic lists this program among its subscribers."""
        me, topic = rospy.get_name(), self._subscriber.resolved_name
        try:
            master = rosgraph.Master(me)
            for published, publishers in master.getSystemState()[0]:
                for publisher in publishers if published == topic else []:
                    links = ServerProxy(master.lookupNode(publisher)).getBusInfo(me)[2]
                    if any(link[1] == me and link[4] == topic for link in links):
                        return True
        except (OSError, rosgraph.MasterException):
            pass  # a node or the master does not answer at present
        return False

    def _take(self, message):
        try:
            self._messages.put_nowait(as_arrays(EventArrays, message))
        except queue.Full:
            self._dropped = True

    def _receive(self, deadline: float) -> bool:
        """Takes the next message. Returns False after the deadline."""
        message = self._next_message(deadline)
        if message is None:
            return False
        last, epoch, first = self._last, message.world.epoch, int(message.number[0])
        self._message, self._next = message, 0
        self._last = (epoch, int(message.number[-1]))
        expected = None if last is None else last[1] + 1 if last[0] == epoch else 1
        if expected is not None and first > expected:
            raise EventsMissed(f"{self._topic}: the events {expected} to {first - 1} were lost. Read ~pairs instead")
        return True

    def _next_message(self, deadline: float):
        """Returns the next message; None after the deadline."""
        while True:
            if rospy.is_shutdown():
                raise rospy.ROSInterruptException("rospy is shutting down")
            try:  # waits for a short time, so that Ctrl-C ends the wait
                return self._messages.get(timeout=min(0.1, max(0.0, deadline - time.monotonic())))
            except queue.Empty:
                if self._dropped:
                    self._dropped = False
                    raise EventsMissed(f"{self._topic}: more than {MOST_MESSAGES} messages waited. Read ~pairs instead")
                if self._subscriber.get_num_connections() == 0:
                    raise NoAnswer(f"{self._topic}: the connection to the node was lost")
                if time.monotonic() >= deadline:
                    return None


def _event(message: EventArrays, index: int) -> Event:
    names = message.names
    return Event(
        number=int(message.number[index]),
        began=bool(message.kind[index] == EventKind.BEGIN),
        first=names[message.first[index]],
        second=names[message.second[index]],
        gap=float(message.gap[index]),
        distance=float(message.distance[index]),
        stamp=message.header.stamp,
    )
