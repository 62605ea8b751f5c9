# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Functions that make rules of which pairs may touch. Only Proximity.set_allowed() sends the rules to the node.

    from hgrid_proximity import rules

    held = rules.allow("robot/gripper", "obstacle/part", reason="the gripper holds it", lifetime=20.0)
    proximity.set_allowed(held)
    proximity.set_allowed(held, remove=True)
    proximity.set_allowed(rules.report("robot/gripper", "robot/camera"))  # although the SRDF allows it

`first` and `second` are full names of bodies, such as "obstacle/table", or globs over them.
"""
from __future__ import annotations

import rospy

from hgrid_proximity.msg import AllowedPair


def allow(first: str, second: str, reason: str = "", lifetime: float = 0.0) -> AllowedPair:
    """Returns a rule that lets bodies touch: pairs that match are not reported.

    @param reason  why, for people; at most 512 bytes
    @param lifetime  [s] the rule ends after this time, at least 0.001 s; 0: it never ends
    """
    return _rule(True, first, second, reason, lifetime)


def report(first: str, second: str, reason: str = "", lifetime: float = 0.0) -> AllowedPair:
    """Returns a rule that reports pairs when they are near, even if an earlier rule, the SRDF or a joint allows them.

    @param reason, lifetime  as for allow()
    """
    return _rule(False, first, second, reason, lifetime)


def _rule(allowed: bool, first: str, second: str, reason: str, lifetime: float) -> AllowedPair:
    until = rospy.Duration.from_sec(lifetime)
    return AllowedPair(first=first, second=second, allowed=allowed, reason=reason, lifetime=until)
