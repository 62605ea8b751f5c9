#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Asks the running node from Python: sends queries over persistent connections, and checks every message of ~pairs.

Start it beside any launch file of this package: rosrun hgrid_proximity ask.py
Takes no arguments but ROS remappings, such as __ns:=NAMESPACE.
"""

import argparse

import rospy
from hgrid_proximity.client import Proximity
from hgrid_proximity.errors import ProximityError
from hgrid_proximity.streams import BUFF_SIZE, PairArrays

NODE = "proximity"  # name of the proximity node


def show(ask):
    """Sends a query and prints the answer. Only CLEAR means that nothing is there."""
    try:
        answer = ask()
    except ProximityError as error:
        print(f"no answer; that is not CLEAR: {error}")
        return
    print(f"{answer.summary}; treat it as occupied" if answer.unknown else answer.summary)
    for hit in answer.hits:
        print(f"  {hit.name}, {hit.distance:.3f} m")


def on_pairs(pairs):
    """Judges a message of ~pairs. "Nothing is near" requires a complete world and a message that is still valid."""
    if rospy.Time.now() > pairs.world.valid_until:
        rospy.logwarn_throttle(1.0, "stop: the pairs are too old")
    elif not pairs.world.complete:
        rospy.logwarn_throttle(1.0, "stop: the pairs are not complete: " + "; ".join(pairs.world.reasons))
    else:
        rospy.loginfo_throttle(1.0, f"{pairs.total} near pairs, complete and valid")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.parse_args(rospy.myargv()[1:])
    rospy.init_node("ask", anonymous=True)
    rospy.Subscriber(NODE + "/pairs", PairArrays, on_pairs, queue_size=1, buff_size=BUFF_SIZE)
    proximity = Proximity(NODE)
    rate = rospy.Rate(2.0)  # [Hz]
    while not rospy.is_shutdown():
        show(lambda: proximity.query_sphere((0.0, 0.0, 0.9), radius=0.4))
        show(lambda: proximity.query_segment((0.4, -2.0, 0.5), (0.4, 2.0, 0.5), exact=True))
        rate.sleep()


if __name__ == "__main__":
    try:
        main()
    except rospy.ROSInterruptException:
        pass
