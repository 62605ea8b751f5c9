#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Asks the running node from Python: sends queries over persistent connections, and checks every message of ~pairs.

Start it beside any launch file of this package: rosrun hgrid_proximity ask.py
"""

import rospy
from geometry_msgs.msg import Point
from hgrid_proximity.msg import Pairs, Verdict
from hgrid_proximity.srv import QuerySegment, QuerySegmentRequest, QuerySphere, QuerySphereRequest

NODE = "/proximity"  # name of the proximity node


class Question:
    """A service with a connection that stays open. It connects again after a restart of the node."""

    def __init__(self, name, kind):
        self._name, self._kind, self._proxy = name, kind, None

    def ask(self, request):
        """Sends the query and prints the answer. Only CLEAR means that nothing is there."""
        if self._proxy is None:
            self._proxy = rospy.ServiceProxy(self._name, self._kind, persistent=True)
        try:
            answer = self._proxy(request).answer
        except (rospy.ServiceException, rospy.ROSException, OSError) as error:
            print(f"{self._name} does not answer; that is not CLEAR: {error}")
            self._proxy.close()
            self._proxy = None
            return
        if not answer.success:
            print(f"refused with {answer.code.name}: {answer.code.text}")
        elif answer.verdict == Verdict.UNKNOWN:
            print(f"{answer.summary}; treat it as occupied")
        else:
            print(answer.summary)
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
    rospy.init_node("ask", anonymous=True)
    rospy.Subscriber(NODE + "/pairs", Pairs, on_pairs, queue_size=1)
    sphere = Question(NODE + "/query_sphere", QuerySphere)
    segment = Question(NODE + "/query_segment", QuerySegment)
    rospy.wait_for_service(NODE + "/query_sphere")
    rate = rospy.Rate(2.0)  # [Hz]
    while not rospy.is_shutdown():
        sphere.ask(QuerySphereRequest(center=Point(0.0, 0.0, 0.9), radius=0.4))
        segment.ask(QuerySegmentRequest(start=Point(0.4, -2.0, 0.5), end=Point(0.4, 2.0, 0.5), exact=True))
        rate.sleep()


if __name__ == "__main__":
    try:
        main()
    except rospy.ROSInterruptException:
        pass
