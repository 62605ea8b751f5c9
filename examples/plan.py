#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Plans a motion between two joint positions with RRT-Connect (Kuffner and LaValle, 2000). The node proves that each edge
is free. The plan is printed with three decimals; the proof is for the values before rounding.

usage: rosrun hgrid_proximity plan.py [-h] [--joints NAME,NAME,...] START... : GOAL... [REMAPPING...]

Start it beside one_arm.launch. START and GOAL have one value [rad or m] for each joint, in the order of --joints. The
default joints are joint_1 to joint_6. ROS remappings, such as __ns:=NAMESPACE, may follow.

exit codes: 0 the plan was printed; 1 there is none, or the node does not answer; 2 an argument is wrong
"""
import sys

import numpy
import rospy
from hgrid_proximity.client import Proximity
from hgrid_proximity.errors import ProximityError

JOINTS = ["joint_1", "joint_2", "joint_3", "joint_4", "joint_5", "joint_6"]
STEP = 1.0  # [rad, or m for prismatic joints] largest length of an edge in joint space
MAX_TRIES = 3000  # number of tries


class Planner:
    """Plans for one state of the world: the first request gets a lease, and all other requests use it."""

    def __init__(self, proximity, joints, start, goal):
        self._proximity, self._joints, self._ends = proximity, joints, (start, goal)
        ends = proximity.check_states(joints, [start, goal], keep=10.0)
        if not ends.clear.all():
            end = int(numpy.argmin(ends.clear))
            why = ends.text(end) or " touches ".join(ends.pair(end))
            sys.exit(f"the {('start', 'goal')[end]} is not free: {why}")
        self._lease, self.edges = ends.response.lease, 0

    def extend(self, tree, target):
        """Adds edges from the node nearest to `target` toward `target`, until one is not free. Returns whether the tree
        reached `target`."""
        states = numpy.array([state for state, _ in tree])
        nearest = int(numpy.argmin(numpy.linalg.norm(states - target, axis=1)))
        way = target - states[nearest]
        length = numpy.linalg.norm(way)
        end = states[nearest] + way * min(1.0, STEP / max(length, STEP))
        found = self._proximity.check_edges(self._joints, [states[nearest]], [end], any_contact=True, lease=self._lease,
                                            keep=10.0)
        self.edges += 1
        if not found.clear[0] or found.beyond_limits[0]:
            return False
        tree.append((end, nearest))
        return length <= STEP or self.extend(tree, target)

    def plan(self, seed=1):
        """Returns the states of a free way, or None."""
        random = numpy.random.RandomState(seed)
        trees = [[(numpy.array(end), None)] for end in self._ends]
        for turn in range(MAX_TRIES):
            one, other = trees[turn % 2], trees[1 - turn % 2]
            self.extend(one, random.uniform(-3, 3, len(self._joints)))
            if self.extend(other, one[-1][0]):
                ways = [to_root(tree, len(tree) - 1) for tree in trees]
                return ways[0][::-1] + ways[1][1:]
        return None


def to_root(tree, node):
    """Returns the states from a node of a tree to its root."""
    way = []
    while node is not None:
        state, node = tree[node]
        way.append(state)
    return way


def arguments():
    """Returns the joints, the start and the goal. Ends the program after --help, or if an argument is wrong."""
    words, joints = rospy.myargv()[1:], JOINTS
    if "--help" in words or "-h" in words:
        print(__doc__)
        sys.exit(0)
    if words[:1] == ["--joints"] and len(words) > 1:
        joints, words = words[1].split(","), words[2:]
    try:
        start, goal = ([float(number) for number in end.split()] for end in " ".join(words).split(":"))
    except ValueError:
        start = goal = []
    if len(start) != len(joints) or len(goal) != len(joints):
        print(f"plan.py: give {len(joints)} numbers, a colon and {len(joints)} numbers; see --help", file=sys.stderr)
        sys.exit(2)
    return joints, start, goal


def main():
    joints, start, goal = arguments()
    rospy.init_node("plan", anonymous=True)
    try:
        planner = Planner(Proximity(), joints, start, goal)
        way = planner.plan()
    except ProximityError as error:
        sys.exit(f"no answer; that is not CLEAR: {error}")
    if way is None:
        sys.exit(f"no free way was found; {planner.edges} edges were checked")
    print(f"a free way of {len(way)} states; {planner.edges} edges were checked")
    print("\n".join(" ".join(f"{value:7.3f}" for value in state) for state in way))


if __name__ == "__main__":
    main()
