# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""The streams of the node as numpy arrays.

Each class has the fields of its message, with arrays as `hgrid_proximity.arrays` describes. `rosmsg show -r
hgrid_proximity/Pairs` explains the fields. Points are in the world frame. Subscribe to the stream with the class:
`rospy.Subscriber("/proximity/pairs", PairArrays, callback, queue_size=1, buff_size=BUFF_SIZE)`. All subscribers to a topic
in one program must use the same class, because rospy reads each message only once.

`buff_size` matters: rospy reads at most that many bytes at a time, by default 64 kB, and applies `queue_size` to what it has
read only. While a callback runs, larger messages wait in the socket, which no queue limits. Each of them is then so old that
its `valid_until` is over, and a careful program says "stop" for ever.
"""
from __future__ import annotations

import io
import re

import numpy
import rospy

from hgrid_proximity.arrays import with_arrays
from hgrid_proximity.msg import Distances, Events, Pairs

BUFF_SIZE = 2**24  # [bytes] for subscribers of these streams; more than the largest message


def as_arrays(kind, message):
    """Returns the message as an object of one of the classes below, even if it was read with another class."""
    if isinstance(message, kind):
        return message
    buffer = io.BytesIO()
    message.serialize(buffer)
    return kind().deserialize(buffer.getvalue())


class _AboutPairs:
    """What the streams have in common: element i of each array is about names[first[i]] and names[second[i]]."""

    __slots__ = ()

    @property
    def first_names(self) -> numpy.ndarray:
        """Names of the first bodies, as an array of strings."""
        return numpy.array(self.names, dtype=object)[self.first]

    @property
    def second_names(self) -> numpy.ndarray:
        """Names of the second bodies, as an array of strings."""
        return numpy.array(self.names, dtype=object)[self.second]

    def select(self, one: str = "*", other: str = "*") -> numpy.ndarray:
        """Returns the indices of all elements of which one body matches the glob `one`, and the other body `other`."""
        ones, others = self._matching(one), self._matching(other)
        straight = ones[self.first] & others[self.second]
        return numpy.flatnonzero(straight | (others[self.first] & ones[self.second]))

    def _matching(self, glob: str) -> numpy.ndarray:
        """Returns for each name whether it matches: `*` stands for any characters, `?` for one of them."""
        pattern = re.compile(re.escape(glob).replace(r"\*", ".*").replace(r"\?", "."), re.DOTALL)
        return numpy.fromiter((pattern.fullmatch(name) is not None for name in self.names), bool, len(self.names))


class _State(_AboutPairs):
    """What ~pairs and ~distances have in common: they list all pairs that are near."""

    __slots__ = ()

    @property
    def usable(self) -> bool:
        """Whether the message is complete and still valid.

        True: every pair that ~pairs does not list is farther apart than its margin. False: it may be near.
        """
        now = rospy.Time.now()
        return self.world.complete and not now.is_zero() and now <= self.world.valid_until


class PairArrays(_State, with_arrays(Pairs)):
    """A message of ~pairs."""

    __slots__ = Pairs.__slots__


class DistanceArrays(_State, with_arrays(Distances)):
    """A message of ~distances."""

    __slots__ = Distances.__slots__


class EventArrays(_AboutPairs, with_arrays(Events)):
    """A message of ~events."""

    __slots__ = Events.__slots__
