# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Waits for events of the node."""
from __future__ import annotations

import queue
import time
from typing import NamedTuple, Optional

import rospy

from hgrid_proximity.errors import EventsMissed, NoAnswer
from hgrid_proximity.msg import EventKind
from hgrid_proximity.streams import EventArrays

MOST_MESSAGES = 1000  # messages that wait to be read; more than that are lost, which EventsMissed reports


class Event(NamedTuple):
    """A pair began or ended. `hgrid_proximity/Events` explains the values."""

    number: int
    began: bool  # False: it ended
    first: str
    second: str
    gap: float  # [m] NaN if it is not known
    distance: float  # [m] NaN if it was not measured
    stamp: rospy.Time  # time of the data


class Events:
    """All events from the creation of this object on, in their order. One thread may wait at a time."""

    def __init__(self, node: str, timeout: float):
        """Subscribes to ~events. Throws NoAnswer if the node does not connect within `timeout` [s]."""
        self._messages: queue.Queue = queue.Queue(MOST_MESSAGES)
        self._message, self._next = None, 0
        self._last = None  # (epoch, number) of the newest event that was read
        self._topic = node + "/events"
        self._subscriber = rospy.Subscriber(self._topic, EventArrays, self._take, queue_size=MOST_MESSAGES)
        deadline = time.monotonic() + timeout
        while self._subscriber.get_num_connections() == 0:
            if time.monotonic() > deadline or rospy.is_shutdown():
                self.close()
                raise NoAnswer(f"{self._topic}: no publisher within {timeout:g} s. `rosnode list` shows whether it runs.")
            time.sleep(0.01)

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
        @param timeout  [s]
        @returns None if there was no such event within the timeout
        @throws EventsMissed  events were lost before this one; the next call goes on after the gap
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

    def _take(self, message):
        try:
            self._messages.put_nowait(message)
        except queue.Full:
            pass  # the numbers of the events show it

    def _receive(self, deadline: float) -> bool:
        """Takes the next message. Returns False after the deadline."""
        try:
            message = self._messages.get(timeout=max(0.0, deadline - time.monotonic()))
        except queue.Empty:
            return False
        last, epoch, first = self._last, message.world.epoch, int(message.number[0])
        self._message, self._next = message, 0
        self._last = (epoch, int(message.number[-1]))
        expected = None if last is None else last[1] + 1 if last[0] == epoch else 1
        if expected is not None and first > expected:
            raise EventsMissed(f"{self._topic}: the events {expected} to {first - 1} were lost; ~pairs has what is near now")
        return True


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
