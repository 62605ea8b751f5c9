# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""The streams of the node as numpy arrays.

Each class has the fields of its message (see `rosmsg show`), with arrays as `arrays` describes: `gap` is an array of n
numbers, `point_on_first` has n rows, `since` is in nanoseconds. Subscribe to the stream with the class:
`rospy.Subscriber("/proximity/pairs", PairArrays, callback, queue_size=1)`.
"""
from __future__ import annotations

import re

import numpy
import rospy

from hgrid_proximity.arrays import with_arrays
from hgrid_proximity.msg import Distances, Events, Pairs


class _AboutPairs:
    """What the streams have in common: element i of each array is about names[first[i]] and names[second[i]]."""

    __slots__ = ()

    @property
    def usable(self) -> bool:
        """Whether the message is complete and still valid. Only then is a pair that it does not list not near."""
        return self.world.complete and rospy.Time.now() <= self.world.valid_until

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


class PairArrays(_AboutPairs, with_arrays(Pairs)):
    """A message of ~pairs."""

    __slots__ = Pairs.__slots__


class DistanceArrays(_AboutPairs, with_arrays(Distances)):
    """A message of ~distances."""

    __slots__ = Distances.__slots__


class EventArrays(_AboutPairs, with_arrays(Events)):
    """A message of ~events."""

    __slots__ = Events.__slots__
