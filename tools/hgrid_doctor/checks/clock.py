# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Checks the ROS clock: whether it is simulated, and whether it runs."""
from __future__ import annotations

from hgrid_doctor.facts import Facts
from hgrid_doctor.finding import ERROR, EVERYTHING, WARN, Findings, listing
from hgrid_doctor.fixes import restart
from hgrid_doctor.frames import middle

OTHER_CLOCK = 1e6  # [s] if two clocks differ by more, one is a wall clock and the other a simulated clock


def check(facts: Facts, findings: Findings):
    if facts.graph.use_sim_time:
        check_simulated(facts, findings)
    else:
        check_wall(facts, findings)
    check_clock_of_node(facts, findings)


def check_simulated(facts: Facts, findings: Findings):
    publishers = facts.alive_publishers("/clock")
    if not publishers:
        findings.add(
            "no_clock",
            ERROR,
            "/use_sim_time is true, but nobody publishes /clock: there is no time, and nothing is placed.",
            "Start the simulation, or play the bag with `rosbag play --clock BAG`; on a real robot "
            "`rosparam set /use_sim_time false` and start all nodes again.",
            [EVERYTHING],
        )
    elif not facts.clock:
        findings.add(
            "clock_silent",
            ERROR,
            f"/use_sim_time is true, but nothing came on /clock from {listing(publishers)} in {facts.listened:.1f} s.",
            "Let the simulation or the bag run on: they may be paused.",
            [EVERYTHING],
        )
    elif len(facts.clock) > 1 and max(facts.clock) == min(facts.clock):
        findings.add(
            "clock_stands_still",
            ERROR,
            f"/clock stands still at {facts.clock[-1]:.3f} s: {listing(publishers)} sent that {len(facts.clock)} "
            "times.",
            "Let the simulation or the bag run on: they are paused.",
            [EVERYTHING],
        )


def check_wall(facts: Facts, findings: Findings):
    """Finds a simulation that runs although /use_sim_time is not set."""
    if not facts.clock:
        return
    offsets = [offset for stream in facts.streams if not stream.static for offset in stream.offsets]
    foreign = bool(offsets) and abs(middle(offsets)) > OTHER_CLOCK
    findings.add(
        "clock_unused",
        ERROR if foreign else WARN,
        f"{listing(facts.alive_publishers('/clock'))} publishes /clock, but /use_sim_time is not set"
        + (": transforms have simulated stamps, while nodes that start now use the wall clock." if foreign else "."),
        "Run `rosparam set /use_sim_time true` and start all nodes again.",
        [EVERYTHING] if foreign else [],
    )


def check_clock_of_node(facts: Facts, findings: Findings):
    """Compares the clock of the node with the ROS clock. A node reads /use_sim_time only when it starts."""
    if facts.status is None or findings.has("no_clock", "clock_silent", "clock_unused"):
        return
    made = facts.status.made.to_sec()
    now = facts.clock[-1] if facts.graph.use_sim_time else facts.wall
    if abs(made - now) <= OTHER_CLOCK:
        return
    kind = "the wall clock, though /use_sim_time is true" if facts.graph.use_sim_time else "a simulated clock"
    findings.add(
        "node_on_other_clock",
        ERROR,
        f"{facts.node} uses {kind}: its newest tick is of {made:.1f} s, and it is {now:.1f} s now.",
        f"Start the node again, because it reads /use_sim_time only when it starts: {restart(facts)}.",
        [EVERYTHING],
    )
