# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Answers to Proximity.check_states() and Proximity.check_edges(), as numpy arrays."""
from __future__ import annotations

import numpy

from hgrid_proximity.verdicts import Verdicts

_NO_PAIR = 4294967295


class _Pairs(Verdicts):
    """beyond_limits: array of n bools: whether a joint is beyond its limits"""

    def __init__(self, response):
        super().__init__(response)
        self.beyond_limits = numpy.array(response.beyond_limits, bool)

    def pair(self, index: int):
        """Returns the names of two bodies that are in contact, nearest or too near; None if there are none."""
        first, second = self.response.first[index], self.response.second[index]
        return None if first == _NO_PAIR else (self.response.names[first], self.response.names[second])

    def _read_contacts(self):
        self.points, self.normals = _vectors(self.response.point), _vectors(self.response.normal)
        self.depths = numpy.array(self.response.depth)


def _vectors(messages):
    """Returns an array with one row x, y, z for each message."""
    return numpy.array([[one.x, one.y, one.z] for one in messages]).reshape(-1, 3)


class States(_Pairs):
    """The answer to check_states(). It has `clear`, `hit`, `unknown` and `text()` of Verdicts.

    beyond_limits: array of n bools: whether a joint is beyond its limits
    clearance: [m] array of n distances from contact; empty unless max_clearance was given. 0: in contact; infinite: more
        than max_clearance; NaN: not known
    points, normals, depths: arrays of n points, n vectors and n numbers: the contact of each state that is hit, as
        `rossrv show -r hgrid_proximity/CheckStates` describes it; NaN: it has none; empty unless contacts was given
    gradient: [m/rad, or 1 for lengths] array of n rows: how the clearance changes with each joint; NaN: it has none; empty
        unless gradients was given
    """

    def __init__(self, response):
        super().__init__(response)
        self.clearance, gradient = numpy.array(response.clearance), numpy.array(response.gradient)
        self._read_contacts()
        self.gradient = gradient.reshape(len(self), -1) if len(gradient) else gradient


class Edges(_Pairs):
    """The answer to check_edges(). It has `clear`, `hit`, `unknown` and `text()` of Verdicts.

    beyond_limits: array of n bools: whether a joint is beyond its limits
    free_until: array of n numbers from 0 to 1: from the start to here, the edge is certainly free
    at: array of n numbers from 0 to 1: where the contact is; NaN: there is none
    points, normals, depths: arrays of n points, n vectors and n numbers: the contact of each edge that is hit, as
        `rossrv show -r hgrid_proximity/CheckEdges` describes it; NaN: it has none
    """

    def __init__(self, response):
        super().__init__(response)
        self.free_until, self.at = numpy.array(response.free_until), numpy.array(response.at)
        self._read_contacts()
