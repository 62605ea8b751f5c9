# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Checks the inputs of maps, clouds and trackers: files, topics, types and frames."""
from __future__ import annotations

from hgrid_doctor.facts import Facts
from hgrid_doctor.finding import ERROR, WARN, Findings, listing
from hgrid_doctor.frames import Tree
from hgrid_doctor.settings import InputSettings


def check(facts: Facts, findings: Findings):
    tree = Tree(facts.streams)
    for each in facts.settings.inputs:
        source = facts.source(each.source)
        if (source is not None and source.complete) or findings.explain(each.source):
            continue
        if each.topic:
            check_topic(facts, tree, each, findings)
        else:
            check_file(facts, each, findings)


def check_file(facts: Facts, each: InputSettings, findings: Findings):
    error = facts.map_file_errors.get(each.source)
    if error:
        findings.add(
            "no_map_file",
            ERROR,
            f"The file '{each.file}' of {each.source} cannot be read: {error}.",
            f"Put it there, or set the folder and start the node again: `rosparam set {facts.node}/map/folder "
            "<folder>`.",
            [each.source],
        )


def check_topic(facts: Facts, tree: Tree, each: InputSettings, findings: Findings):
    topic = each.topic
    publishers = facts.alive_publishers(topic)
    types = {facts.topic(topic).types.get(node) or facts.graph.types.get(topic, "") for node in publishers} - {"", "*"}
    if not publishers:
        check_absent(facts, each, findings)
    elif each.type not in types and types:
        findings.add(
            "wrong_input_type",
            ERROR,
            f"{topic} of {each.source} has the wrong type: {listing(publishers)} sends {sorted(types)[0]}, and "
            f"{each.type} is needed.",
            f"Name a topic of that type in the parameters: `rostopic find {each.type}`.",
            [each.source],
        )
    elif not facts.topic(topic).total():
        check_silent(facts, each, findings)
    else:
        check_frame(facts, tree, each, findings)


def check_absent(facts: Facts, each: InputSettings, findings: Findings):
    gone = facts.gone_publishers(each.topic)
    others = sorted(
        topic for topic, kind in facts.graph.types.items() if kind == each.type and facts.alive_publishers(topic)
    )
    what = f"{listing(gone)} is registered, but does not answer" if gone else "nobody publishes it"
    fix = (
        f"Name one of the topics of that type in ~{each.source.split('/')[0]}s: {listing(others)}."
        if others
        else f"Start what publishes it, or correct the topic in ~{each.source.split('/')[0]}s."
    )
    findings.add(
        "no_input_publisher", ERROR, f"Nothing comes for {each.source} on {each.topic}: {what}.", fix, [each.source]
    )


def check_silent(facts: Facts, each: InputSettings, findings: Findings):
    publishers = facts.alive_publishers(each.topic)
    errors = [facts.topic(each.topic).errors[node] for node in publishers if node in facts.topic(each.topic).errors]
    why = f" ({errors[0]})" if errors else ""
    findings.add(
        "input_silent",
        WARN if facts.status is None else ERROR,
        f"Nothing came for {each.source} on {each.topic} in {facts.listened:.1f} s{why}, though {listing(publishers)} "
        "publishes it.",
        f"Look at the sensor, the map server or the tracker: `rostopic hz {each.topic}`.",
        [each.source],
    )


def check_frame(facts: Facts, tree: Tree, each: InputSettings, findings: Findings):
    world = facts.world_frame()
    frame = next(iter(facts.topic(each.topic).frames.values()), "")
    if not world or not frame or frame == world or (tree.has(frame) and tree.root(frame) == tree.root(world)):
        return
    what = f"is not below the world frame '{world}'" if tree.has(frame) else "is unknown to tf"
    findings.add(
        "wrong_input_frame",
        ERROR,
        f"The messages of {each.source} on {each.topic} are in frame '{frame}', which {what}.",
        "Correct frame_id at the publisher, or say where it is: `rosrun tf2_ros static_transform_publisher 0 0 0 0 0 "
        f"0 {world} {frame}`.",
        [each.source],
    )
