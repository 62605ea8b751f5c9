# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Reports pairs that are easily forgotten: those that rules of ~set_allowed hide, and links that always touch."""
from __future__ import annotations

import time

from hgrid_doctor.facts import Facts
from hgrid_doctor.finding import WARN, Findings, counted
from hgrid_doctor.fixes import load_file, reload_command, remove_rule
from hgrid_doctor.settings import absolute


def check(facts: Facts, findings: Findings):
    check_rules(facts, findings)
    for robot in facts.robots:
        check_links(facts, robot, findings)


def check_rules(facts: Facts, findings: Findings):
    """A rule that ends by itself is no finding."""
    rules = [rule for rule in facts.rules if rule.allowed and rule.lifetime.to_sec() == 0.0]
    if not rules or facts.pairs_off == 0:
        return
    first = rules[0]
    more = f" (and {counted(len(rules) - 1, 'rule')} more)" if len(rules) > 1 else ""
    why = f', because "{first.reason}"' if first.reason else ""
    findings.add(
        "rules_hide_pairs",
        WARN,
        f"Rules of ~set_allowed hide {counted(facts.pairs_off, 'pair')} until somebody removes them, also after a "
        f"restart if ~state_folder is set: '{first.first}' with '{first.second}', set by {first.set_by} at "
        f"{moment(facts, first.since.to_sec())}{why}{more}.",
        f"If it is no longer true, remove it: {remove_rule(facts, first)}.",
    )


def check_links(facts: Facts, robot, findings: Findings):
    touching = [touch for touch in facts.touching if touch.robot == robot.settings.name]
    if not touching:
        return
    shown = ", ".join(f"'{touch.first}' with '{touch.second}'" for touch in touching[:3])
    more = f" and {len(touching) - 3} more" if len(touching) > 3 else ""
    key = robot.semantic_key or absolute(robot.settings.semantic or "robot_description_semantic", facts.node)
    findings.add(
        "links_touch",
        WARN,
        f"{counted(len(touching), 'pair')} of links of robot '{robot.settings.name}' touch each other, the first since "
        f"{moment(facts, min(touch.since for touch in touching))}: {shown}{more}.",
        "If they touch in every pose, an SRDF should say so. `rosrun hgrid_proximity make_srdf my_robot.urdf > "
        f"my_robot.srdf` writes one. Load it: {load_file(key, 'my_robot.srdf')}, then {reload_command(facts, robot)}.",
    )


def moment(facts: Facts, seconds: float) -> str:
    """Returns a ROS time for people."""
    if facts.graph.use_sim_time:
        return f"{seconds:.1f} s"
    return time.strftime("%Y-%m-%d %H:%M:%S", time.localtime(seconds))
