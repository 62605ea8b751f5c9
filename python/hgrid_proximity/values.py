# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Points and poses from numbers."""
from geometry_msgs.msg import Point, Pose, Quaternion

UPRIGHT = (0.0, 0.0, 0.0, 1.0)  # no rotation, as a quaternion x, y, z, w


def numbers(name: str, value, fields: str):
    """Returns the fields of a message, or the elements of a sequence of as many numbers.

    @param name  what the value is, for the error
    @throws ValueError
    """
    if all(hasattr(value, field) for field in fields):
        return [getattr(value, field) for field in fields]
    try:
        found = [float(number) for number in value]
    except (TypeError, ValueError):
        found = []
    if len(found) != len(fields):
        raise ValueError(f"{name} is {value!r}; it must be {len(fields)} numbers: {', '.join(fields)}")
    return found


def as_point(name: str, value) -> Point:
    """@throws ValueError"""
    return Point(*numbers(name, value, "xyz"))


def as_pose(position, orientation) -> Pose:
    """@throws ValueError"""
    turned = Quaternion(*numbers("orientation", orientation, "xyzw"))
    return Pose(position=as_point("position", position), orientation=turned)


def globs(value):
    """Returns one glob, or several, as a list."""
    return [value] if isinstance(value, str) else list(value)
