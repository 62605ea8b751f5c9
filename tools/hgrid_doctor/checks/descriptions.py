# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Checks the robot descriptions: whether they exist, are valid XML, and name meshes that can be read."""
from __future__ import annotations

from hgrid_doctor.facts import Facts, RobotFacts
from hgrid_doctor.finding import ERROR, WARN, Findings, counted, listing
from hgrid_doctor.frames import shaped_links

FLAWS = {
    "not_text": "no text",
    "xacro": "an unexpanded xacro",
    "not_xml": "no XML",
    "not_robot": "no URDF",
}


def check(facts: Facts, findings: Findings):
    for robot in facts.robots:
        if robot.description is None:
            check_missing(facts, robot, findings)
        elif robot.description.flaw:
            check_flaw(facts, robot, findings)
        else:
            check_meshes(facts, robot, findings)
            check_shapes(facts, robot, findings)


def reload_command(facts: Facts, robot: RobotFacts) -> str:
    return f"`rosservice call {facts.node}/reload_robot {robot.settings.name}`"


def check_missing(facts: Facts, robot: RobotFacts, findings: Findings):
    settings = robot.settings
    if facts.is_loaded(settings.name):
        return  # its name was remapped, or it existed when the node started
    there = f" (there is {listing(robot.candidates)})" if robot.candidates else ""
    first = robot.candidates[0] if robot.candidates else ""
    fix = (
        f"Start the node with `{settings.description}:={first}`, or name {first} as description in ~robots."
        if first
        else "Load it in the robot's launch file: "
        f'`<param name="{settings.description}" command="xacro my_robot.urdf.xacro"/>`.'
    )
    findings.add(
        "no_description",
        ERROR,
        f"The description of robot '{settings.name}' is missing: no parameter '{settings.description}' from "
        f"{facts.node} upwards{there}.",
        fix,
        [settings.name],
    )


def check_flaw(facts: Facts, robot: RobotFacts, findings: Findings):
    description = robot.description
    fixes = {
        "xacro": f"Expand it: `rosparam set {robot.key} \"$(xacro my_robot.urdf.xacro)\"`",
        "not_text": "Load the text of the URDF (<param textfile=...>), not its file name or a number",
        "not_xml": f"Check it: `rosparam get {robot.key} | check_urdf /dev/stdin`",
        "not_robot": "Load a URDF, whose root element is <robot>",
    }
    findings.add(
        "bad_description_" + description.flaw,
        ERROR,
        f"The parameter {robot.key} of robot '{robot.settings.name}' holds {FLAWS[description.flaw]}: "
        f"{description.detail}.",
        f"{fixes[description.flaw]}, then {reload_command(facts, robot)}.",
        [robot.settings.name],
    )


def check_meshes(facts: Facts, robot: RobotFacts, findings: Findings):
    """Adds one finding per missing package, and one finding for all files that cannot be read for other reasons."""
    if facts.is_loaded(robot.settings.name) and not any(
        text.startswith(robot.settings.name + "/") for text in facts.status.uncovered
    ):
        return  # the node can read files that this shell cannot, for example on another computer
    packages, others = {}, {}
    for uri, error in robot.mesh_errors.items():
        if error.startswith("there is no package"):
            packages.setdefault(uri.split("/")[2], []).append(uri)
        else:
            others[uri] = error
    for package, uris in sorted(packages.items()):
        findings.add(
            "no_mesh_package",
            ERROR,
            f"The package '{package}' cannot be found, but {counted(len(uris), 'mesh file')} of robot "
            f"'{robot.settings.name}' "
            f"lie in it, for example {uris[0]}.",
            f"Install or build '{package}', or source its workspace where the node starts (`rospack find {package}` "
            "must "
            "succeed), and start the node again.",
            [robot.settings.name],
        )
    if others:
        uri, error = next(iter(others.items()))
        findings.add(
            "bad_mesh",
            ERROR,
            f"{counted(len(others), 'mesh file')} of robot '{robot.settings.name}' cannot be read, for example {uri}: "
            f"{error}.",
            f"Put the file there or correct the URDF, then {reload_command(facts, robot)}.",
            [robot.settings.name],
        )


def check_shapes(facts: Facts, robot: RobotFacts, findings: Findings):
    name, links = robot.settings.name, robot.description.links
    if not shaped_links(robot, facts):
        findings.add(
            "no_collision",
            ERROR,
            f"Robot '{name}' has no <collision> on any of its {counted(len(links), 'link')}: it is in no pair.",
            f"Use its visual shapes, then start the node again: `rosparam set {facts.node}/use_visual "
            f"\"['{name}/*']\"`.",
            [name],
        )
        return
    only_visual = [
        link.name
        for link in links.values()
        if link.visuals and not link.collisions and not facts.settings.uses_visual(f"{name}/{link.name}")
    ]
    if only_visual:
        findings.add(
            "links_without_collision",
            WARN,
            f"{counted(len(only_visual), 'link')} of robot '{name}' can be seen but cannot collide, having <visual> "
            "and no "
            f"<collision>: {listing(only_visual)}.",
            "Add <collision> to the URDF, or use the visual shapes and start the node again: `rosparam set "
            f"{facts.node}/use_visual"
            f" \"['{name}/{only_visual[0]}']\"`.",
        )
