# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""The robot of validity.test, and helpers.

An arm turns about z. It has a sphere of radius 0.1 m at 0.5 m, and a hand: such a sphere at 1 m plus the position of the
joint 'slide'. The obstacle 'post' is such a sphere at 0.5 m on y, the obstacle 'wall' at 1.5 m on -y."""
import math
import threading
import time

import rospy
from geometry_msgs.msg import TransformStamped
from tf2_msgs.msg import TFMessage

TO_POST, TO_WALL = math.pi / 2, -math.pi / 2


class Arm:
    """Publishes the poses of the links while `publishes` is true: the base at the origin, the shoulder at `angle`, and the
    joint 'slide' at 0.25 m. The frame 'tcp' is at the hand."""

    def __init__(self):
        self.angle, self.publishes = 0.0, True
        self.twin_at = None  # [m] x of the base of the robot 'twin', an equal arm at rest; None: nobody publishes it
        self.twin_publishes = True
        self.extra = []  # further transforms: (parent, child, x [m], turn about z [rad])
        self._static = rospy.Publisher("/tf_static", TFMessage, queue_size=1, latch=True)
        self._static.publish(TFMessage([transform("world", "base", 0.0), transform("hand", "tcp", 0.0)]))
        self._moving = rospy.Publisher("/tf", TFMessage, queue_size=1)
        threading.Thread(target=self._run, daemon=True).start()

    def _run(self):
        while not rospy.is_shutdown():
            turned = (math.sin(self.angle / 2), math.cos(self.angle / 2))
            poses = [transform("base", "arm", 0.0, turned), transform("arm", "hand", 1.25),
                     transform("hand", "finger", 0.25)]
            if self.twin_at is not None and self.twin_publishes:
                poses += [transform("world", "twin/base", self.twin_at), transform("twin/base", "twin/arm", 0.0),
                          transform("twin/arm", "twin/hand", 1.25), transform("twin/hand", "twin/finger", 0.25)]
            poses += [transform(parent, child, x, (math.sin(turn / 2), math.cos(turn / 2)))
                      for parent, child, x, turn in self.extra]
            try:
                if self.publishes:
                    self._moving.publish(TFMessage(poses))
            except rospy.ROSException:
                break  # the test ends
            time.sleep(0.02)


def transform(parent, child, x, turned=(0.0, 1.0)):
    pose = TransformStamped(child_frame_id=child)
    pose.header.frame_id, pose.header.stamp = parent, rospy.Time.now()
    pose.transform.translation.x = x
    pose.transform.rotation.z, pose.transform.rotation.w = turned
    return pose


def wait(condition, what, seconds=60.0):
    deadline = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > deadline:
            raise AssertionError("%s did not come within %s s" % (what, seconds))
        time.sleep(0.05)
