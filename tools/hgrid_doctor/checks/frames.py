# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Checks the frames that robots need: whether they are published, and whether tf connects them with the world frame."""
from __future__ import annotations

from typing import Dict, List, Set

from hgrid_doctor.checks.joint_states import (
    Absent,
    Waiting,
    add_no_joint_states,
    check_joint_states,
    state_publishers,
)
from hgrid_doctor.description import Joint
from hgrid_doctor.facts import LOST, UNPLACED, Facts, RobotFacts
from hgrid_doctor.finding import ERROR, EVERYTHING, Findings, counted, listing
from hgrid_doctor.fixes import (
    publish_frame,
    robot_entries,
    sentence,
    state_publisher_command,
    with_params,
)
from hgrid_doctor.frames import Tree, frame_of_group, joint_state_topics, needed_frames


def check(facts: Facts, findings: Findings):
    if findings.explain(EVERYTHING, ERROR):
        return
    tree = Tree(facts.streams)
    apart: Dict[str, Set[str]] = {}  # names of robots by the root of their tree, if the world frame is not in that tree
    waiting: List[Waiting] = []
    for robot in facts.robots:
        if robot.description is None or robot.description.flaw:
            continue
        check_free_joints(facts, tree, robot, findings)
        unplaced = unplaced_frames(facts, tree, robot)
        if findings.has("static_free_joint"):
            fixed = {robot.settings.frame(joint.child) for joint in static_free_joints(tree, robot)}
            unplaced = {frame: link for frame, link in unplaced.items() if not fixed & set(tree.chain(frame))}
        absent = {frame: link for frame, link in unplaced.items() if is_absent(facts, tree, robot, frame, link)}
        if absent:
            check_absent(facts, tree, robot, absent, findings, waiting)
        for frame in unplaced:
            if frame not in absent and tree.root(frame) != tree.root(facts.world_frame()):
                apart.setdefault(tree.root(frame), set()).add(robot.settings.name)
    if waiting:
        add_no_joint_states(waiting, findings)
    if apart and facts.world_frame() and not findings.has("contested_frame"):
        check_connected(facts, tree, apart, findings)


def static_free_joints(tree: Tree, robot: RobotFacts) -> List[Joint]:
    """Returns the planar and floating joints whose child frames are only on /tf_static. The node does not use them."""
    joints = [joint for joint in robot.description.joints if joint.type in ("planar", "floating")]
    streams = {joint.name: tree.of_child.get(robot.settings.frame(joint.child), []) for joint in joints}
    return [joint for joint in joints if streams[joint.name] and all(each.static for each in streams[joint.name])]


def check_free_joints(facts: Facts, tree: Tree, robot: RobotFacts, findings: Findings):
    for joint in static_free_joints(tree, robot):
        frame = robot.settings.frame(joint.child)
        publisher = tree.of_child[frame][0].publisher
        findings.add(
            "static_free_joint",
            ERROR,
            f"Where the {joint.type} joint '{joint.name}' of robot '{robot.settings.name}' stands is unknown: its "
            f"frame '{frame}' is only on /tf_static, from {publisher}. robot_state_publisher sends a planar joint as if "
            "it were fixed.",
            f"Publish the pose of '{frame}' in '{robot.settings.frame(joint.parent)}' on /tf (odometry, localization). "
            "If the joint never moves, make it fixed in the URDF.",
            sources_below(facts, tree, {frame}) | {robot.settings.name},
        )


def is_absent(facts: Facts, tree: Tree, robot: RobotFacts, frame: str, link: str) -> bool:
    """Returns whether nobody publishes the frame. The world frame and the root of a robot need no publisher of their
    own."""
    if frame in tree.of_child or frame == facts.world_frame():
        return False
    return link != robot.description.root or not tree.has(frame)


def unplaced_frames(facts: Facts, tree: Tree, robot: RobotFacts) -> Dict[str, str]:
    """Returns the frames whose links have no pose. Asks the node's ~status; if it does not say it, uses the received
    tf."""
    needed = needed_frames(robot, facts)
    name = robot.settings.name
    if facts.is_loaded(name):
        bad = set()
        for body in facts.status.bodies:
            source, _, link = body.name.partition("/")
            if source == name and body.state in (LOST, UNPLACED) and link in robot.description.links:
                bad.add(frame_of_group(robot, link))
        if facts.status.bodies_total <= len(facts.status.bodies):
            return {frame: link for frame, link in needed.items() if frame in bad}
    world = facts.world_frame()
    return {
        frame: link
        for frame, link in needed.items()
        if frame != world and (not tree.has(frame) or tree.root(frame) != tree.root(world))
    }


def sources_below(facts: Facts, tree: Tree, frames: Set[str]) -> Set[str]:
    """Returns the sources for which each body without a pose depends on one of the frames, directly or through
    others."""
    follow: Dict[str, List[bool]] = {}
    for body in facts.status.bodies if facts.status is not None else []:
        if body.state in (LOST, UNPLACED):
            kind, _, local = body.name.partition("/")
            source = body.name if kind in ("map", "cloud") else kind
            if kind == "track":
                source += "/" + local.partition("/")[0]
            follow.setdefault(source, []).append(bool(frames & set(tree.chain(body.frame))))
    return {source for source, each in follow.items() if all(each)}


def check_absent(
    facts: Facts, tree: Tree, robot: RobotFacts, absent: Dict[str, str], findings: Findings, waiting: List[Waiting]
):
    """Adds a finding for frames that are not published.

    @param waiting  the robot is added if its joint states have no publisher
    """
    name = robot.settings.name
    needed = needed_frames(robot, facts)
    what = f"{len(absent)} of {counted(len(needed), 'frame')} of robot '{name}' do not come ({listing(sorted(absent))})"
    explained = sources_below(facts, tree, set(absent)) | {name}
    prefix = other_prefix(facts, tree, robot, absent)
    if prefix is not None:
        findings.add(
            "wrong_tf_prefix",
            ERROR,
            f"{what}: they are on /tf with the prefix '{prefix}', and tf_prefix of the robot is "
            f"'{robot.settings.tf_prefix}'.",
            sentence(with_params(facts, {"robots": robot_entries(facts.robots, name, {"tf_prefix": prefix})})) + ".",
            explained,
        )
        return
    publishers = state_publishers(facts, robot)
    alive = sorted(node for node in publishers if facts.alive(node))
    if alive:
        missing = Absent(robot, absent, what, explained)
        check_joint_states(facts, missing, alive[0], findings, waiting)
    elif publishers:
        gone = sorted(publishers)[0]
        findings.add(
            "state_publisher_gone",
            ERROR,
            f"{what}: {gone} is registered to publish them, but does not answer ({facts.nodes[gone].error}).",
            f"Start it again: {state_publisher_command(facts, robot)}.",
            explained,
        )
    else:
        others = facts.alive_publishers("/tf")
        there = f"/tf comes from {listing(others)} only" if others else "nobody publishes /tf"
        there += latched_hint(facts)
        findings.add(
            "no_state_publisher",
            ERROR,
            f"{what}: no robot_state_publisher runs for it, and {there}.",
            f"Start one: {state_publisher_command(facts, robot)}.",
            explained,
        )


def other_prefix(facts: Facts, tree: Tree, robot: RobotFacts, absent: Dict[str, str]):
    """Returns the prefix under which most of the links are published, if no other robot uses the prefix; otherwise
    None."""
    taken = {other.settings.tf_prefix.lstrip("/") for other in facts.robots if other is not robot}
    votes: Dict[str, int] = {}
    for link in absent.values():
        for frame in tree.of_child:
            if frame == link or frame.endswith("/" + link):
                prefix = frame[: -len(link)].rstrip("/")
                if prefix not in taken:
                    votes[prefix] = votes.get(prefix, 0) + 1
    best = max(sorted(votes), key=votes.get, default=None)
    return best if best is not None and votes[best] * 2 > len(absent) else None


def latched_hint(facts: Facts) -> str:
    """Returns a possible cause of a static frame that is missing, as the end of a sentence; empty: there is none.

    A StaticTransformBroadcaster in Python latches one message, that of its last call. tf2's in C++ sends all
    transforms of its earlier calls again."""
    latched = {each.publisher for each in facts.streams if each.static} - {
        node for node in facts.graph.nodes() if joint_state_topics(facts, node)
    }
    if not latched:
        return ""
    return (
        f"; {listing(sorted(latched))} on /tf_static may have sent more than it latches: a Python "
        "StaticTransformBroadcaster keeps only its last call, so it must send all transforms in one call"
    )


def was_connected(facts: Facts, robots: List[str]) -> bool:
    """Returns whether the node once had a pose of a link of one of the robots."""
    bodies = facts.status.bodies if facts.status is not None else []
    return any(body.state == LOST and body.name.partition("/")[0] in robots for body in bodies)


def check_connected(facts: Facts, tree: Tree, apart: Dict[str, Set[str]], findings: Findings):
    """Adds a finding for robots whose frames are published, but are not connected with the world frame."""
    world, roots = facts.world_frame(), sorted(apart)
    names = sorted({name for robots in apart.values() for name in robots})
    who = f"robot{'s' if len(names) > 1 else ''} {listing(names)}"
    explained = sources_below(facts, tree, set(apart)) | set(names)
    gone = facts.gone_publishers("/tf")
    set_frame = with_params(facts, {"world_frame": roots[0]})
    publish = f"{publish_frame(world, roots[0])} (with the true pose)"
    if gone:
        findings.add(
            "tf_publisher_gone",
            ERROR,
            f"Nothing connects the world frame '{world}' with {who}, below {listing(roots)}: {listing(gone)} is "
            "registered"
            " for /tf, but does not answer.",
            "Start it again.",
            explained,
        )
    elif was_connected(facts, names):
        findings.add(
            "world_frame_lost",
            ERROR,
            f"Nothing connects the world frame '{world}' any more with {who}, below {listing(roots)}.",
            "Start the node again that published where the robot is (localization, odometry): see `rosnode list`.",
            explained,
        )
    elif not tree.has(world):
        findings.add(
            "wrong_world_frame",
            ERROR,
            f"The world frame '{world}' is unknown to tf: nobody publishes it now, and {who} hangs below "
            f"{listing(roots)}.",
            f"Publish where the robot is: {publish}. Or choose a frame that is there: {set_frame}.",
            explained,
        )
    else:
        findings.add(
            "two_trees",
            ERROR,
            f"tf is in parts that nothing connects: the world frame '{world}' is below '{tree.root(world)}', {who} "
            f"below {listing(roots)}{latched_hint(facts)}.",
            f"Publish where the robot is: start the node that does (localization, odometry), or {publish}. Or choose "
            f"another frame: {set_frame}.",
            explained,
        )
