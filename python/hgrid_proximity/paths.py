# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""The answer to Proximity.guard()."""
from __future__ import annotations

from hgrid_proximity.errors import Refused
from hgrid_proximity.msg import Verdict


class GuardedPath:
    """Whether a path is free, in the world as it is now: exactly one of `clear`, `hit` and `unknown` is True.

    clear: the robot touches nothing within ~guard/ahead seconds, if all robots with paths follow them and everything else
        stays where it is
    hit: it will touch something; `first` and `second` are the names of the bodies, `point` [m, world frame] is where they
        meet, and `at` [rospy.Time] is when; `response.normal` and `response.depth` describe a move that separates them
    unknown: it may touch something; `reason` says why nobody knows
    free_for: [s] for this long from now on, the robot is proved to touch nothing
    response: the whole response of the service
    """

    def __init__(self, response):
        if not response.success:
            raise Refused(response.code.name, response.code.text)
        self.response = response
        self.clear = response.verdict == Verdict.CLEAR
        self.hit = response.verdict == Verdict.HIT
        self.unknown = not self.clear and not self.hit
        self.reason, self.free_for = response.reason, response.free_for
        self.first, self.second, self.point, self.at = response.first, response.second, response.point, response.at

    def __bool__(self):
        raise TypeError("a path is neither true nor false; read .clear, .hit or .unknown")

    def __repr__(self):
        if self.hit:
            return f"<HIT {self.first} and {self.second}, free for {self.free_for:.3g} s>"
        return "<CLEAR>" if self.clear else f"<UNKNOWN: {self.reason}>"
