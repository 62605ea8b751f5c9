#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Plays the robot of an example: publishes what the drivers of a real robot would publish, at 50 Hz.

Each joint swings around CENTER [rad]. Its state is published on joint_states. The parameter ~base is the tf of the
robot's base: CHILD is at X, Y, Z [m] in PARENT and drives along x by AMPLITUDE [m]. With ~post, a depth camera on
the base sees a post in PARENT and a part of the robot itself. It publishes points in CHILD on camera/depth/points.
All motion is a sine of the ROS time with a period of 8 s. Therefore it is the same after every start.

Other ROS remappings, such as __name:=NAME, may follow.
"""

import argparse
from math import pi, sin

import rospy
from geometry_msgs.msg import TransformStamped
from sensor_msgs import point_cloud2
from sensor_msgs.msg import JointState, PointCloud2
from std_msgs.msg import Header
from tf2_msgs.msg import TFMessage

PERIOD = 8.0  # [s]


def split(text):
    """Returns the parts of "a:b:1:2" as two lists: the words and the numbers."""
    words, numbers = [], []
    for part in text.split(":"):
        try:
            numbers.append(float(part))
        except ValueError:
            words.append(part)
    return words, numbers


def points_of(post, base_x, base_y):
    """Returns the points that the camera sees [m, frame of the base]: the post, and the edge of the robot's deck,
    every 3 cm."""
    x, y, height = post
    deck = [(0.39, 0.03 * i, 0.30) for i in range(-6, 7)]
    return deck + [
        (x + 0.03 * i - base_x, y + 0.03 * j - base_y, 0.03 * k)
        for i in (-1, 0, 1) for j in (-1, 0, 1) for k in range(1, int(height / 0.03))
    ]


def main():
    parser = argparse.ArgumentParser(
        usage="play_robot.py [-h] [JOINT:CENTER:AMPLITUDE...] [_base:=PARENT:CHILD:X:Y:Z:AMPLITUDE] [_post:=X:Y:HEIGHT]",
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("joints", nargs="*", type=split, metavar="JOINT:CENTER:AMPLITUDE", help="a joint that swings")
    joints = parser.parse_args(rospy.myargv()[1:]).joints
    rospy.init_node("play_robot")
    frames, place = split(rospy.get_param("~base", ""))
    post = split(rospy.get_param("~post", ""))[1]
    states = rospy.Publisher("joint_states", JointState, queue_size=10)
    tf = rospy.Publisher("/tf", TFMessage, queue_size=10)
    cloud = rospy.Publisher("camera/depth/points", PointCloud2, queue_size=1)
    rate = rospy.Rate(50.0)  # [Hz]
    tick = 0
    while not rospy.is_shutdown():
        now = rospy.Time.now()
        wave = sin(2.0 * pi * now.to_sec() / PERIOD)
        state = JointState(name=[words[0] for words, _ in joints])
        state.header.stamp = now
        state.position = [center + amplitude * wave for _, (center, amplitude) in joints]
        states.publish(state)
        if place:
            pose = TransformStamped(header=Header(stamp=now, frame_id=frames[0]), child_frame_id=frames[1])
            pose.transform.translation.x = place[0] + place[3] * wave
            pose.transform.translation.y, pose.transform.translation.z = place[1:3]
            pose.transform.rotation.w = 1.0
            tf.publish([pose])
        if post and tick % 5 == 0:  # 10 Hz
            points = points_of(post, pose.transform.translation.x, place[1])
            cloud.publish(point_cloud2.create_cloud_xyz32(Header(stamp=now, frame_id=frames[1]), points))
        tick += 1
        rate.sleep()


if __name__ == "__main__":
    try:
        main()
    except rospy.ROSInterruptException:
        pass
