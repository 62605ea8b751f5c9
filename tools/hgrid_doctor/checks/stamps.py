# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Checks for stamps on /tf that are always early or late: the clocks of two computers differ, or a publisher is
slow."""
from __future__ import annotations

from typing import List

from hgrid_doctor.checks.clock import OTHER_CLOCK
from hgrid_doctor.facts import Facts, TfStream
from hgrid_doctor.finding import ERROR, WARN, Findings
from hgrid_doctor.fixes import COMPARE_CLOCKS
from hgrid_doctor.frames import Tree, middle, needed_chains, robots_placed_by

EARLY = 0.2  # [s] some publishers deliberately use stamps in the near future, amcl by 0.1 s
LEAST_MESSAGES = 3  # a publisher with fewer messages is not judged


def check(facts: Facts, findings: Findings):
    if findings.has("no_clock", "clock_silent", "clock_stands_still", "clock_unused"):
        return
    tree = Tree(facts.streams)
    chains = needed_chains(facts, tree)
    of_publisher = {}
    for stream in facts.streams:
        if not stream.static and stream.child in chains:
            of_publisher.setdefault(stream.publisher, []).append(stream)
    for publisher, streams in sorted(of_publisher.items()):
        robots = robots_placed_by(facts, tree, {stream.child for stream in streams})
        check_zero(publisher, streams, robots, findings)
        check_offset(facts, publisher, streams, robots, findings)


def check_zero(publisher: str, streams: List[TfStream], robots, findings: Findings):
    zero = [stream.child for stream in streams if stream.zero_stamps]
    if zero:
        findings.add(
            "stamps_zero",
            ERROR,
            f"{publisher} sends transforms with stamp 0 on /tf, frame '{zero[0]}' for example; the node refuses them.",
            "Fill in header.stamp there; a robot_state_publisher copies the stamp of the joint states.",
            robots,
        )


def clock_step(facts: Facts) -> float:
    """Returns how far simulated time may lag [s]: the longest step between two messages of /clock."""
    return max((after - before for before, after in zip(facts.clock, facts.clock[1:])), default=0.0)


def stale_and_incomplete(facts: Facts, robot: str) -> bool:
    source = facts.source(robot)
    return source is not None and not source.complete and source.reason.startswith("STALE ")


def check_offset(facts: Facts, publisher: str, streams: List[TfStream], robots, findings: Findings):
    offsets = [offset for stream in streams for offset in stream.offsets]
    if len(offsets) < LEAST_MESSAGES:
        return
    offset, settings = middle(offsets), facts.settings
    early, late = offset > EARLY + clock_step(facts), offset < -settings.stale_after
    if not early and not late:
        return
    if abs(offset) > OTHER_CLOCK:
        findings.add(
            "stamps_of_other_clock",
            ERROR,
            f"The stamps of {publisher} on /tf are of another clock: they are {abs(offset):.0f} s off.",
            f"Start {publisher} again with the present /use_sim_time ({str(facts.graph.use_sim_time).lower()}), which "
            "it reads only when it starts.",
            robots,
        )
        return
    effect = ""
    if offset > settings.max_future:
        effect = "; the node refuses them"
    elif -offset > settings.lost_after:
        effect = "; its robots are LOST"
    elif late and any(stale_and_incomplete(facts, robot) for robot in robots):
        effect = "; its robots are STALE and not complete"
    findings.add(
        "stamps_early" if early else "stamps_late",
        ERROR if effect else WARN,
        f"The stamps of {publisher} on /tf are constantly {abs(offset):.2f} s in the {'future' if early else 'past'}"
        f" ({min(offsets):+.2f} .. {max(offsets):+.2f} s){effect}.",
        f"If it runs on another computer, set the clocks there and here by one server: {COMPARE_CLOCKS}. If not, see "
        f"what it is and what it stamps with: `rosnode info {publisher}`.",
        robots,
    )
