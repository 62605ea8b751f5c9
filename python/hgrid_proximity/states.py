# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Answers to Proximity.check_states() and Proximity.check_edges(), as numpy arrays."""
from __future__ import annotations

import numpy

from hgrid_proximity.errors import Refused
from hgrid_proximity.msg import Verdict

_NO_PAIR = 4294967295


class _Verdicts:
    """Exactly one of `clear`, `hit` and `unknown` is True for each state or edge.

    clear, hit, unknown: arrays of n bools
    beyond_limits: array of n bools: whether a joint is beyond its limits
    response: the whole response of the service; response.lease names the state of the world
    """

    def __init__(self, response):
        if not response.success:
            raise Refused(response.code.name, response.code.text)
        self.response = response
        verdicts = numpy.frombuffer(response.verdicts, numpy.uint8)  # genpy reads uint8[] as bytes
        self.clear, self.hit = verdicts == Verdict.CLEAR, verdicts == Verdict.HIT
        self.unknown = ~(self.clear | self.hit)
        self.beyond_limits = numpy.array(response.beyond_limits, bool)

    def __len__(self):
        return len(self.clear)

    def __bool__(self):
        raise TypeError("an answer is neither true nor false; read .clear, .hit or .unknown")

    def text(self, index: int) -> str:
        """Says why a state or edge is unknown or was refused; empty for others."""
        return self.response.texts[index] if self.response.texts else ""

    def pair(self, index: int):
        """Returns the names of two bodies that are in contact, nearest or too near; None if there are none."""
        first, second = self.response.first[index], self.response.second[index]
        return None if first == _NO_PAIR else (self.response.names[first], self.response.names[second])


class States(_Verdicts):
    """The answer to check_states().

    clearance: [m] array of n distances from contact; empty unless max_clearance was given. 0: in contact; infinite: more
        than max_clearance; NaN: not known
    gradient: [m/rad, or 1 for lengths] array of n rows: how the clearance changes with each joint; NaN: it has none; empty
        unless gradients was given
    """

    def __init__(self, response):
        super().__init__(response)
        self.clearance, gradient = numpy.array(response.clearance), numpy.array(response.gradient)
        self.gradient = gradient.reshape(len(self), -1) if len(gradient) else gradient


class Edges(_Verdicts):
    """The answer to check_edges().

    free_until: array of n numbers from 0 to 1: from the start to here, the edge is certainly free
    at: array of n numbers from 0 to 1: where the contact is; NaN: there is none
    """

    def __init__(self, response):
        super().__init__(response)
        self.free_until, self.at = numpy.array(response.free_until), numpy.array(response.at)
