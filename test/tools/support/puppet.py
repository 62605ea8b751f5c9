#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Publishes joint states and transforms 50 times per second until it is stopped.

usage: puppet.py NAME [--joints JOINT,JOINT,...] [--tf PARENT CHILD X] [--offset S]
"""
import argparse

import rospy
from geometry_msgs.msg import TransformStamped
from sensor_msgs.msg import JointState
from tf2_msgs.msg import TFMessage


def transform(parent, child, x, stamp):
    message = TransformStamped()
    message.header.frame_id, message.header.stamp, message.child_frame_id = parent, stamp, child
    message.transform.translation.x, message.transform.rotation.w = float(x), 1.0
    return message


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("name")
    parser.add_argument("--joints", default="")
    parser.add_argument("--tf", nargs=3, action="append", default=[])
    parser.add_argument("--offset", type=float, default=0.0)
    args = parser.parse_args()
    rospy.init_node(args.name)
    joints = args.joints.split(",") if args.joints else []
    states = rospy.Publisher("/joint_states", JointState, queue_size=1) if joints else None
    transforms = rospy.Publisher("/tf", TFMessage, queue_size=1) if args.tf else None
    rate = rospy.Rate(50)
    while not rospy.is_shutdown():
        now = rospy.Time.now()
        if states:
            message = JointState(name=joints, position=[0.3] * len(joints))
            message.header.stamp = now
            states.publish(message)
        if transforms:
            stamp = now + rospy.Duration(args.offset)
            transforms.publish(TFMessage([transform(*each, stamp) for each in args.tf]))
        rate.sleep()


if __name__ == "__main__":
    try:
        main()
    except rospy.ROSInterruptException:
        pass
