# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""The robot of the tests in this folder: one sphere that moves."""
import threading
import time

import rospy
from geometry_msgs.msg import TransformStamped
from tf2_msgs.msg import TFMessage


class Ball:
    """Publishes the pose of the robot's sphere in the world."""

    def __init__(self):
        self.x = 5.0
        self._publisher = rospy.Publisher("/tf", TFMessage, queue_size=1)
        threading.Thread(target=self._run, daemon=True).start()

    def _run(self):
        while not rospy.is_shutdown():
            pose = TransformStamped(child_frame_id="ball")
            pose.header.frame_id, pose.header.stamp = "world", rospy.Time.now()
            pose.transform.translation.x, pose.transform.rotation.w = self.x, 1.0
            try:
                self._publisher.publish(TFMessage([pose]))
            except rospy.ROSException:
                break  # the test ends
            time.sleep(0.02)
