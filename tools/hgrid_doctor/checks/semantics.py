# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Checks the SRDF: whether it exists, is valid XML, and belongs to the robot."""
from __future__ import annotations

from hgrid_doctor.facts import Facts, RobotFacts
from hgrid_doctor.finding import ERROR, WARN, Findings, counted, listing
from hgrid_doctor.fixes import load_file, reload_command
from hgrid_doctor.settings import absolute

DEFAULT = "robot_description_semantic"


def check(facts: Facts, findings: Findings):
    for robot in facts.robots:
        check_one(facts, robot, findings)


def check_one(facts: Facts, robot: RobotFacts, findings: Findings):
    settings, semantic = robot.settings, robot.semantic
    if semantic is None:
        if settings.semantic not in ("", DEFAULT):
            findings.add(
                "no_srdf",
                WARN,
                f"The SRDF of robot '{settings.name}' is missing: there is no parameter '{settings.semantic}'.",
                f"{load(facts, robot, absolute(settings.semantic, facts.node))}. Or leave out semantic in ~robots.",
            )
        return
    if semantic.flaw:
        findings.add(
            "bad_srdf",
            ERROR,
            f"The parameter {robot.semantic_key} holds no SRDF that can be read: {semantic.detail}.",
            f"Correct the file. {load(facts, robot, robot.semantic_key)}.",
            [settings.name],
        )
        return
    if robot.description is not None and not robot.description.flaw:
        check_links(facts, robot, findings)


def load(facts: Facts, robot: RobotFacts, key: str) -> str:
    commands = f"{load_file(key, 'my_robot.srdf')}, then {reload_command(facts, robot)}"
    return f"Load the SRDF of this robot: {commands}. Change the launch file as well"


def check_links(facts: Facts, robot: RobotFacts, findings: Findings):
    semantic, description = robot.semantic, robot.description
    unknown = sorted(semantic.links - set(description.links))
    foreign = len(unknown) * 2 > len(semantic.links)
    other_name = semantic.name != description.name
    fix = f"{load(facts, robot, robot.semantic_key)}."
    if foreign or (other_name and unknown):
        findings.add(
            "srdf_of_other_robot",
            ERROR,
            f"The SRDF in {robot.semantic_key} is of another robot: it is for '{semantic.name}', the URDF for"
            f" '{description.name}', and {len(unknown)} of the {len(semantic.links)} links that it names do not exist"
            f" ({listing(unknown)}).",
            fix,
        )
    elif unknown:
        findings.add(
            "srdf_unknown_links",
            WARN,
            f"The SRDF in {robot.semantic_key} names {counted(len(unknown), 'link')} that '{description.name}' does "
            "not have:"
            f" {listing(unknown)}.",
            f"Correct the names, or write the SRDF anew with the MoveIt setup assistant. {fix}",
        )
    elif other_name:
        findings.add(
            "srdf_other_name",
            WARN,
            f"The SRDF in {robot.semantic_key} is for '{semantic.name}', the URDF for '{description.name}'; all links "
            "are known.",
            fix,
        )
