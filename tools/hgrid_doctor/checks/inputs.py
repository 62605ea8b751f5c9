# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Checks the inputs of maps, clouds and trackers: files, topics, types and frames."""
from __future__ import annotations

from hgrid_doctor.facts import Facts
from hgrid_doctor.finding import ERROR, WARN, Findings, listing
from hgrid_doctor.fixes import publish_frame, with_params
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
        folder = facts.settings.map_folder
        maps = facts.settings.values.get("map")
        set_folder = with_params(facts, {"map": {**(maps if isinstance(maps, dict) else {}), "folder": "FOLDER"}})
        findings.add(
            "no_map_file",
            ERROR,
            f"The file '{each.file}' of {each.source} cannot be read: {error}.",
            (f"Put it there: `cp {each.file} {folder}`. Or name" if folder else "Name")
            + f" the folder in which it is: {set_folder}.",
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
            f"Name a topic of that type in ~{each.parameter}: `rostopic find {each.type}` lists them.",
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
    if others:
        other = use_topic(facts, each, others[0])
        fix = f"Start what publishes it, or use a topic of that type that is there: {other}."
    else:
        fix = f"Start what publishes it, or correct the topic in ~{each.parameter}."
    findings.add(
        "no_input_publisher", ERROR, f"Nothing comes for {each.source} on {each.topic}: {what}.", fix, [each.source]
    )


def use_topic(facts: Facts, each: InputSettings, topic: str) -> str:
    """Returns how to let the node read an input from another topic."""
    entries = facts.settings.values[each.parameter]
    name = each.source.partition("/")[2]
    changed = [{**entry, "topic": topic} if entry.get("name") == name else entry for entry in entries]
    return with_params(facts, {each.parameter: changed})


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
        "Correct frame_id at the publisher, or publish where the frame is: "
        f"{publish_frame(world, tree.root(frame))} (with the true pose).",
        [each.source],
    )
