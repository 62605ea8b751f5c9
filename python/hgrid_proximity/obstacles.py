# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Functions that make changes of obstacles, and shapes. Only Proximity.apply_obstacles() sends the changes to the node.

    from hgrid_proximity import obstacles

    proximity.apply_obstacles(
        obstacles.add("table", obstacles.box((1.2, 0.8, 0.04)), position=(0.6, 0.0, 0.7)),
        obstacles.add("part", obstacles.cylinder(height=0.1, radius=0.03), position=(0.5, 0.1, 0.77), lifetime=60.0),
    )
    proximity.apply_obstacles(obstacles.move("part", position=(0.5, 0.3, 0.77)), obstacles.remove("table"))

Lengths are in meters. The name of an obstacle is given without its source: "table" is the body "obstacle/table". `link` and
`touch` are full names. Positions are three numbers, or a message with the fields x, y and z. An orientation is a quaternion
x, y, z, w. The functions that make shapes return a hgrid_proximity/Shape. Their arguments position and orientation give the
pose of the shape in the frame of the obstacle; `padding` grows the shape on all sides.
"""
from __future__ import annotations

from typing import Iterable, Optional, Union

import rospy
from geometry_msgs.msg import Point, Vector3
from shape_msgs.msg import Mesh, MeshTriangle

from hgrid_proximity.msg import LifetimeEnd, Obstacle, ObstacleOperation, Shape, ShapeKind
from hgrid_proximity.values import UPRIGHT, as_pose, globs, numbers

POSES = "~poses"  # frame of the obstacles that messages on ~poses move; see poses.PosesPublisher

Shapes = Union[Shape, Iterable[Shape]]


def add(
    name: str,
    shapes: Shapes,
    position=(0.0, 0.0, 0.0),
    orientation=UPRIGHT,
    frame: str = "",
    stamp: Optional[rospy.Time] = None,
    replace: bool = False,
    moving: bool = False,
    margin: float = 0.0,
    max_speed: float = 0.0,
    lifetime: float = 0.0,
    lost_at_end: bool = False,
    owner: str = "",
    group: str = "",
) -> Obstacle:
    """Returns a change that adds an obstacle.

    @param shapes  a shape, or several
    @param frame  tf frame of the pose, which the obstacle follows; empty: the world frame. If tf does not know the frame,
        the obstacle is UNPLACED, and the world is not complete.
    @param stamp  the obstacle is placed where the frame was at this time, and stays there; rospy.Time(0): at the newest
        pose of the frame, refused if it is older than ~stale_after; None: the obstacle follows the frame
    @param replace  what happens to another obstacle of this name. True: it is replaced, and detached. False: the request is
        refused. An equal obstacle at the same place is accepted, unless it is attached.
    @param moving  True: it makes pairs with fixed bodies, too. An obstacle that follows another frame always does.
    @param margin  [m] distance at which other bodies are near, at least ~margin; 0: as ~margins and ~margin say
    @param max_speed  [m/s] upper bound of its speed, used while its data is old; 0: as the parameters say
    @param lifetime  [s, ROS time] it ends after this time without a change, even while it is attached; 0: it never ends
    @param lost_at_end  what the end of the lifetime means. True: the obstacle stays and becomes LOST, because its place is no
        longer known, until it is added or changed again. False: it is removed.
    @param owner  name of its owner (see Proximity.apply_obstacles); empty: the name of this node. An anonymous node has a
        new name in each run, so give an owner.
    @param group  name of a group of obstacles that move as one and make no pairs with each other; empty: no group. They must
        follow the same frame or be attached to the same link.
    """
    change = _placed(ObstacleOperation.ADD, name, position, orientation, frame, stamp)
    change.shapes = [shapes] if isinstance(shapes, Shape) else list(shapes)
    change.replace, change.moving, change.owner, change.group = replace, moving, owner, group
    change.lifetime_end = LifetimeEnd.LOST if lost_at_end else LifetimeEnd.REMOVE
    change.margin, change.max_speed, change.lifetime = margin, max_speed, rospy.Duration.from_sec(lifetime)
    return change


def move(
    name: str, position, orientation=UPRIGHT, frame: str = "", stamp: Optional[rospy.Time] = None
) -> Obstacle:
    """Returns a change that gives an obstacle another pose. Its lifetime begins again. `frame` and `stamp` are as in add().
    The obstacles of its group move as one with it. Refused while the obstacle is attached."""
    return _placed(ObstacleOperation.MOVE, name, position, orientation, frame, stamp)


def remove(name: str) -> Obstacle:
    """Returns a change that removes an obstacle."""
    return Obstacle(operation=ObstacleOperation.REMOVE, name=name)


def attach(
    name: str, link: str, position=None, orientation=UPRIGHT, touch: Union[str, Iterable[str]] = ()
) -> Obstacle:
    """Returns a change that attaches an obstacle to a link of a robot, such as "robot/gripper". It then follows the link.

    @param position  position in the frame of the link; None: the obstacle keeps its present pose relative to the link,
        refused if this pose is not known or older than ~stale_after
    @param orientation  orientation in the frame of the link; used only with a position
    @param touch  a glob over the full names of bodies that may touch it while it is attached, or several of them. The link
        and its rigid group may touch it, too. Fingers that move relative to the link do not belong to this group.
    """
    change = Obstacle(operation=ObstacleOperation.ATTACH, name=name, link=link, touch=globs(touch))
    if position is not None:
        change.at_attach_pose, change.attach_pose = True, as_pose(position, orientation)
    return change


def detach(name: str) -> Obstacle:
    """Returns a change that detaches an obstacle. It stays at its present pose in the world, and may no longer touch the
    link. Refused if the pose of the link is older than ~stale_after."""
    return Obstacle(operation=ObstacleOperation.DETACH, name=name)


def sphere(radius: float, **place) -> Shape:
    """@param place  position, orientation and padding of the shape"""
    return _shape(ShapeKind.SPHERE, [radius], **place)


def box(size, **place) -> Shape:
    """@param size  full lengths of the sides @param place  as in sphere()"""
    return _shape(ShapeKind.BOX, numbers("size", size, "xyz"), **place)


def cylinder(height: float, radius: float, **place) -> Shape:
    """A cylinder around the z axis, its center at the position. @param place  as in sphere()"""
    return _shape(ShapeKind.CYLINDER, [height, radius], **place)


def cone(height: float, radius: float, **place) -> Shape:
    """A cone around the z axis, its tip at +z, the middle of its height at the position. @param place  as in sphere()"""
    return _shape(ShapeKind.CONE, [height, radius], **place)


def capsule(height: float, radius: float, **place) -> Shape:
    """A cylinder with two round ends, which `height` does not include. @param place  as in sphere()"""
    return _shape(ShapeKind.CAPSULE, [height, radius], **place)


def hull(vertices, **place) -> Shape:
    """The convex hull of points. @param vertices  rows x, y, z @param place  as in sphere()"""
    return _shape(ShapeKind.HULL, [], Mesh(vertices=_points(vertices)), **place)


def mesh(vertices, triangles, **place) -> Shape:
    """A mesh. If it is closed, it is solid.

    @param vertices  rows x, y, z
    @param triangles  rows of three indices into vertices
    @param place  as in sphere()
    """
    faces = [MeshTriangle(vertex_indices=[int(index) for index in triangle]) for triangle in triangles]
    return _shape(ShapeKind.MESH, [], Mesh(vertices=_points(vertices), triangles=faces), **place)


def plane(**place) -> Shape:
    """A half-space, such as a floor: everything below the plane z = 0 of its pose is solid. The position is a point of the
    surface, and the z axis of the orientation points out of the solid. Only an obstacle that is fixed in the world frame
    may have planes.

    @param place  as in sphere(); the padding moves the surface outward
    """
    return _shape(ShapeKind.PLANE, [], **place)


def file(resource: str, scale=(1.0, 1.0, 1.0), convex: bool = False, **place) -> Shape:
    """A mesh in a file (STL, DAE or OBJ) on the computer of the node.

    @param resource  URI, such as "package://my_robot/meshes/part.stl"; file:// only below ROS_PACKAGE_PATH and ~mesh_roots
    @param convex  True: the convex hull of the mesh
    @param place  as in sphere()
    """
    shape = _shape(ShapeKind.HULL if convex else ShapeKind.MESH, [], **place)
    shape.resource, shape.scale = resource, Vector3(*numbers("scale", scale, "xyz"))
    return shape


def _points(rows):
    return [Point(*numbers("a vertex", row, "xyz")) for row in rows]


def _shape(kind, dimensions, surface=None, position=(0.0, 0.0, 0.0), orientation=UPRIGHT, padding: float = 0.0) -> Shape:
    shape = Shape(kind=kind, dimensions=dimensions, pose=as_pose(position, orientation), padding=padding)
    if surface is not None:
        shape.mesh = surface
    return shape


def _placed(operation, name, position, orientation, frame, stamp) -> Obstacle:
    change = Obstacle(operation=operation, name=name, pose=as_pose(position, orientation), at_stamp=stamp is not None)
    change.header.frame_id = frame
    if stamp is not None:
        change.header.stamp = stamp
    return change
