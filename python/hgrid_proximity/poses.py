# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Moves many obstacles at a high rate.

    from hgrid_proximity import obstacles
    from hgrid_proximity.poses import PosesPublisher

    names = ["part%d" % i for i in range(1000)]
    proximity.apply_obstacles(*(obstacles.add(name, obstacles.sphere(0.05), frame=obstacles.POSES) for name in names))
    publisher = PosesPublisher(names, frame="world")
    while not rospy.is_shutdown():
        publisher.publish(positions)  # array of shape (1000, 3) [m]
        rate.sleep()
"""
from __future__ import annotations

import time
import zlib
from typing import Iterable, Optional

import numpy as np
import rospy

from hgrid_proximity.arrays import with_arrays
from hgrid_proximity.msg import Poses


# with_arrays() writes all poses as one block of bytes. rospy would take longer for a list of 10,000 poses than the period
# at which they are published.
_Poses = with_arrays(Poses)


class PosesPublisher:
    """Publishes the poses of the same obstacles on ~poses. It sends the names once per second, so that a node that starts
    later knows them. Only one thread at a time may use it."""

    def __init__(self, names: Iterable[str], frame: str, node: str = "proximity"):
        """@param names  obstacles, without their source; see obstacles.POSES
        @param frame  tf frame of the poses, such as the world frame
        @param node  name of the node, in the namespace of this program unless it begins with a slash
        """
        self._names, self._frame, self._named = list(names), frame, None
        self._version = zlib.crc32("\0".join(self._names).encode())  # the same list has the same version
        topic = rospy.resolve_name(node).rstrip("/") + "/poses"
        self._topic = topic
        self._publisher = rospy.Publisher(topic, Poses, queue_size=2, tcp_nodelay=True)

    def publish(self, positions, orientations=None, stamp: Optional[rospy.Time] = None):
        """Sends one pose for each name.

        @param positions  [m] array of shape (number of names, 3)
        @param orientations  quaternions x, y, z, w: array of shape (number of names, 4); None: no rotations
        @param stamp  time at which the poses were valid; None: now
        @throws ValueError if an array has another shape
        """
        count = len(self._names)
        message = _Poses(names_version=self._version)
        message.position = _array("positions", positions, (count, 3))
        if orientations is None:
            orientations = np.broadcast_to((0.0, 0.0, 0.0, 1.0), (count, 4))
        message.orientation = _array("orientations", orientations, (count, 4))
        message.header.frame_id = self._frame
        message.header.stamp = rospy.Time.now() if stamp is None else stamp
        now = rospy.get_time()
        if self._named is None or not 0.0 <= now - self._named < 1.0:
            message.names, self._named = self._names, now
        self._publisher.publish(message)

    def wait_for_node(self, timeout: float = 5.0):
        """Waits until somebody has subscribed: the node, or another subscriber such as rosbag.

        @param timeout  [s, wall time]
        @throws rospy.ROSException
        """
        end = time.monotonic() + timeout
        while self._publisher.get_num_connections() == 0:
            if time.monotonic() > end:
                raise rospy.ROSException(f"nobody subscribed to {self._topic} within {timeout} s; is the node running?")
            time.sleep(0.02)

    def close(self):
        """Ends the publisher."""
        self._publisher.unregister()


def _array(name: str, value, shape) -> np.ndarray:
    array = np.ascontiguousarray(value, dtype="<f8")
    if array.shape != shape:
        raise ValueError(f"{name} has the shape {array.shape}; it must be {shape}")
    return array
