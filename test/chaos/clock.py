#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""A simulated clock that jumps back and ahead and stands still at random times. The node recovers each time."""
import pathlib
import sys
import threading
import time

sys.path.insert(0, str(pathlib.Path(__file__).with_name("support")))

import rospy  # noqa: E402  (needs the path above)
from cell import FREE, HAND, POST, expect, robot  # noqa: E402
from chaos import Deadline, calm_after, main  # noqa: E402
from geometry_msgs.msg import TransformStamped  # noqa: E402
from rosgraph_msgs.msg import Clock  # noqa: E402
from tf2_msgs.msg import TFMessage  # noqa: E402

STEP = 0.01  # [s] period of /clock and of /tf
RECOVERY = 5.0  # [s] a complete world and right answers must come within this time


class Simulator(threading.Thread):
    """Publishes /clock and the frame of the hand. The clock can be set and stopped at any time."""

    def __init__(self, now):
        super().__init__(daemon=True)
        self.now, self.stands, self.ends = now, False, False
        self._clock = rospy.Publisher("/clock", Clock, queue_size=1)
        self._tf = rospy.Publisher("/tf", TFMessage, queue_size=1)
        self._message = TransformStamped()
        self._message.header.frame_id, self._message.child_frame_id = "world", "hand"
        self._message.transform.translation.x, self._message.transform.rotation.w = HAND[0], 1.0

    def run(self):
        while not self.ends:
            if not self.stands:
                self.now += STEP
            stamp = rospy.Time.from_sec(self.now)
            self._clock.publish(Clock(stamp))
            if not self.stands:
                self._message.header.stamp = stamp
                self._tf.publish(TFMessage([self._message]))
            time.sleep(STEP)


def jump(cell, simulator, to):
    """Sets the clock, and waits until a new epoch begins."""
    epoch = cell.status().world.epoch
    simulator.now = to
    cell.wait("another epoch than %d after the clock was set to %.3f s" % (epoch, to),
              lambda: cell.status().world.epoch != epoch)


def stand_still(cell, simulator, rng):
    """Stops the clock until the node notices that. Checks that no answer is CLEAR while the clock stands still."""
    simulator.stands = True
    cell.wait("an incomplete world while the clock stands still", lambda: not cell.status().world.complete)
    expect("verdict while the clock stands still", "UNKNOWN", cell.verdict(FREE))
    time.sleep(rng.uniform(0.0, 0.5))  # chaos: the clock continues at a random time
    simulator.stands = False


def disturb(cell, simulator, rng, kind):
    if kind == "back":
        jump(cell, simulator, rng.uniform(0.1, simulator.now - 0.1))
    elif kind == "ahead":
        jump(cell, simulator, simulator.now + rng.uniform(20.0, 2000.0))
    else:
        stand_still(cell, simulator, rng)


def check_clock(cell, simulator, rng, seconds):
    """Checks after each disturbance that the world is soon complete and that the answers are right."""
    counts, slowest, deadline = {"back": 0, "ahead": 0, "stands still": 0}, 0.0, Deadline(seconds)
    while deadline or not all(counts.values()):
        kind = rng.choice(sorted(counts))
        disturb(cell, simulator, rng, kind)
        begin = time.monotonic()
        cell.wait_until_right()
        took = time.monotonic() - begin
        expect("recovery after the clock: " + kind, "at most %g s" % RECOVERY, "%.2f s" % took, took <= RECOVERY)
        slowest, counts[kind] = max(slowest, took), counts[kind] + 1
    print("clock: %s; slowest recovery %.2f s" % (counts, slowest))


def clock(cell, rng, seconds):
    cell.set("/robot_description", robot("hand"))
    cell.params(obstacles=[POST])
    cell.node = cell.start_node()
    simulator = Simulator(1000.0)
    simulator.start()
    try:
        cell.wait_until_right()
        with calm_after(cell):
            check_clock(cell, simulator, rng, seconds)
    finally:
        simulator.ends = True
        simulator.join()


if __name__ == "__main__":
    main(clock, simulated=True)
