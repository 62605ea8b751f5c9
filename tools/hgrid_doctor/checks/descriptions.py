# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Checks the robot descriptions: whether they exist, are valid XML, and name meshes that can be read."""
from __future__ import annotations

import os
from urllib.parse import unquote, urlparse

from hgrid_doctor.facts import Facts, MeshFlaw, RobotFacts
from hgrid_doctor.finding import ERROR, WARN, Findings, counted, listing
from hgrid_doctor.fixes import load_file, reload_command, restart, robot_entries, with_params
from hgrid_doctor.frames import shaped_links

MISSING = ": RESOURCE_MISSING"  # in a sentence of ~status: the node finds no such file
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


def check_missing(facts: Facts, robot: RobotFacts, findings: Findings):
    settings = robot.settings
    if facts.is_loaded(settings.name):
        return  # its name was remapped, or it existed when the node started
    there = f" (there is {listing(robot.candidates)})" if robot.candidates else ""
    first = robot.candidates[0] if robot.candidates else ""
    if first:
        semantic = {"semantic": first + "_semantic"} if first + "_semantic" in facts.parameters else {}
        robots = robot_entries(facts.robots, settings.name, {"description": first, **semantic})
        fix = f"Name {first} as its description: {with_params(facts, {'robots': robots})}."
    else:
        key = settings.description if settings.description.startswith("/") else "/" + settings.description
        fix = (
            f'Load it in the robot\'s launch file: `<param name="{key}" command="xacro my_robot.urdf.xacro"/>`; '
            f"or for now: {load_file(key, 'my_robot.urdf')}."
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
        "xacro": "Expand it: `xacro my_robot.urdf.xacro > my_robot.urdf`",
        "not_text": "Load the text of the URDF, not its file name or a number",
        "not_xml": "Correct the file",
        "not_robot": "Load a URDF, whose root element is <robot>",
    }
    load = load_file(robot.key, "my_robot.urdf")
    findings.add(
        "bad_description_" + description.flaw,
        ERROR,
        f"The parameter {robot.key} of robot '{robot.settings.name}' holds {FLAWS[description.flaw]}: "
        f"{description.detail}.",
        f"{fixes[description.flaw]}; then {load} and {reload_command(facts, robot)}. Change the launch file as well.",
        [robot.settings.name],
    )


def check_meshes(facts: Facts, robot: RobotFacts, findings: Findings):
    """Adds one finding per missing package, one for all files outside the folders that may be read, and one for all
    files that cannot be read for other reasons."""
    name = robot.settings.name
    flaws = []
    if facts.is_loaded(name):
        flaws = [text for text in facts.status.uncovered if text.startswith(name + "/")]
        if not flaws:
            return  # the node can read files that this shell cannot, for example on another computer
    packages, outside, others = {}, [], {}
    for uri, error in robot.mesh_errors.items():
        if error.flaw == MeshFlaw.NO_PACKAGE:
            packages.setdefault(uri.split("/")[2], []).append(uri)
        elif error.flaw == MeshFlaw.OUTSIDE:
            outside.append(uri)
        else:
            others[uri] = error
    for package, uris in sorted(packages.items()):
        findings.add(
            "no_mesh_package",
            ERROR,
            f"The package '{package}' cannot be found, but {counted(len(uris), 'mesh file')} of robot "
            f"'{robot.settings.name}' {'lies' if len(uris) == 1 else 'lie'} in it, for example {uris[0]}.",
            f"Install or build '{package}', or source its workspace in the shell or launch file that starts the node: "
            f"`source ~/my_ws/devel/setup.bash`, until `rospack find {package}` prints a folder. Then start the node "
            f"there again: {restart(facts)}.",
            [name],
        )
    if outside:
        folders = sorted({os.path.dirname(unquote(urlparse(uri).path)) for uri in outside})
        findings.add(
            "mesh_outside",
            ERROR,
            f"{counted(len(outside), 'mesh file')} of robot '{name}' may not be read, for example {outside[0]}: only "
            "files in packages and in ~mesh_roots may.",
            f"Allow the folder: {with_params(facts, {'mesh_roots': [*facts.settings.mesh_roots, *folders]})}.",
            [name],
        )
    if others:
        uri, error = next(iter(others.items()))
        findings.add(
            "bad_mesh",
            ERROR,
            f"{counted(len(others), 'mesh file')} of robot '{name}' cannot be read, for example {uri}: {error.text}.",
            f"Put the file there or correct the URDF, then {reload_command(facts, robot)}.",
            [name],
        )
    missing = [flaw for flaw in flaws if MISSING in flaw]
    if missing and not robot.mesh_errors:
        findings.add(
            "no_mesh_package",
            ERROR,
            f"The node does not find mesh files of robot '{name}', though this shell does: {missing[0]}.",
            "Start the node where the workspace of these files is sourced, for example in this shell: "
            f"{restart(facts)}.",
            [name],
        )


def check_shapes(facts: Facts, robot: RobotFacts, findings: Findings):
    name, links = robot.settings.name, robot.description.links
    if not shaped_links(robot, facts):
        findings.add(
            "no_collision",
            ERROR,
            f"Robot '{name}' has no <collision> on any of its {counted(len(links), 'link')}: it is in no pair.",
            f"Use its visual shapes: {with_params(facts, {'use_visual': [*facts.settings.use_visual, name + '/*']})}.",
            [name],
        )
        return
    only_visual = [
        link.name
        for link in links.values()
        if link.visuals and not link.collisions and not facts.settings.uses_visual(f"{name}/{link.name}")
    ]
    if only_visual:
        patterns = [*facts.settings.use_visual, *(f"{name}/{link}" for link in only_visual)]
        findings.add(
            "links_without_collision",
            WARN,
            f"{counted(len(only_visual), 'link')} of robot '{name}' can be seen but cannot collide, having <visual> "
            "and no "
            f"<collision>: {listing(only_visual)}.",
            f"Add <collision> to the URDF, or use the visual shapes: {with_params(facts, {'use_visual': patterns})}.",
        )
