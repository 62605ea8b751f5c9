# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Functions that make changes of robots. Only Proximity.apply_robots() sends the changes to the node.

    from hgrid_proximity import robots

    names = [f"amr{number}" for number in range(20)]
    proximity.apply_robots(robots.add(names, description="amr_description"))  # one description, twenty equal robots
    proximity.apply_robots(robots.absent("amr7"))    # it was switched off, so nobody waits for it
    proximity.apply_robots(robots.present("amr7"))
    proximity.apply_robots(robots.add("amr20", like="amr0"), robots.remove(["amr1", "amr2"]))

Each function takes the name of a robot, or several names, for each of which the change is made.
"""
from __future__ import annotations

from typing import Iterable, Union

from hgrid_proximity.msg import RobotChange, RobotOperation

Names = Union[str, Iterable[str]]


def add(
    names: Names,
    like: str = "",
    description: str = "",
    semantic: str = "",
    urdf: str = "",
    srdf: str = "",
    tf_prefix: str = "",
) -> RobotChange:
    """Returns a change that adds robots. Give exactly one of `like`, `description` and `urdf`.

    @param like  name of a loaded robot, to which the new ones are equal; nothing is read again
    @param description  name of the parameter that holds the URDF
    @param semantic  name of the parameter that holds the SRDF; empty: there is none
    @param urdf  the URDF itself
    @param srdf  the SRDF itself; empty: there is none
    @param tf_prefix  prefix of the tf frames; empty: the name of the robot; "/": no prefix
    """
    return _change(
        RobotOperation.ADD,
        names,
        like=like,
        description=description,
        semantic=semantic,
        urdf=urdf,
        srdf=srdf,
        tf_prefix=tf_prefix,
    )


def remove(names: Names) -> RobotChange:
    """Returns a change that removes robots and their models."""
    return _change(RobotOperation.REMOVE, names)


def absent(names: Names) -> RobotChange:
    """Returns a change that declares robots absent: their bodies leave the world, and nobody waits for their data."""
    return _change(RobotOperation.ABSENT, names)


def present(names: Names) -> RobotChange:
    """Returns a change that declares absent robots present again, with the models that they had."""
    return _change(RobotOperation.PRESENT, names)


def _change(operation: int, names: Names, **fields) -> RobotChange:
    return RobotChange(operation=operation, names=[names] if isinstance(names, str) else list(names), **fields)
