# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Frames that robots need: who should publish them, and whether they hang below the world frame."""
from __future__ import annotations

from typing import Dict, Set

from hgrid_doctor.facts import LOST, UNPLACED, Facts, RobotFacts
from hgrid_doctor.finding import ERROR, EVERYTHING, Findings, counted, listing
from hgrid_doctor.frames import Tree, frame_of_group, joint_state_topics, needed_frames


def check(facts: Facts, findings: Findings):
    if findings.explain(EVERYTHING, ERROR):
        return
    tree = Tree(facts.streams)
    apart: Dict[str, Set[str]] = {}  # by root of a tree that is not the world's: robots
    for robot in facts.robots:
        if robot.description is None or robot.description.flaw:
            continue
        unplaced = unplaced_frames(facts, tree, robot)
        absent = {frame: link for frame, link in unplaced.items() if is_absent(facts, tree, robot, frame, link)}
        if absent:
            check_absent(facts, tree, robot, absent, findings)
            continue
        for frame in unplaced:
            if tree.root(frame) != tree.root(facts.world_frame()):
                apart.setdefault(tree.root(frame), set()).add(robot.settings.name)
    if apart and facts.world_frame() and not findings.has("contested_frame"):
        check_connected(facts, tree, apart, findings)


def is_absent(facts: Facts, tree: Tree, robot: RobotFacts, frame: str, link: str) -> bool:
    """Nobody sent it. The root of a robot and the world frame may be heard as the parent of others only."""
    if frame in tree.of_child or frame == facts.world_frame():
        return False
    return link != robot.description.root or not tree.has(frame)


def unplaced_frames(facts: Facts, tree: Tree, robot: RobotFacts) -> Dict[str, str]:
    """Frames whose links have no pose, by the node's word or, where it says nothing, by what was heard."""
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


def check_absent(facts: Facts, tree: Tree, robot: RobotFacts, absent: Dict[str, str], findings: Findings):
    name = robot.settings.name
    needed = needed_frames(robot, facts)
    what = f"{len(absent)} of {counted(len(needed), 'frame')} of robot '{name}' do not come ({listing(sorted(absent))})"
    prefix = other_prefix(tree, robot, absent)
    if prefix is not None:
        findings.add(
            "wrong_tf_prefix",
            ERROR,
            f"{what}: they are on /tf with the prefix '{prefix}', and tf_prefix of the robot is "
            f"'{robot.settings.tf_prefix}'.",
            f"Set tf_prefix: '{prefix}' for '{name}' in ~robots and start the node again.",
            [name],
        )
        return
    publishers = state_publishers(facts, tree, robot)
    alive = sorted(node for node in publishers if facts.alive(node))
    if alive:
        check_joint_states(facts, robot, absent, what, alive[0], findings)
    elif publishers:
        gone = sorted(publishers)[0]
        findings.add(
            "state_publisher_gone",
            ERROR,
            f"{what}: {gone} is registered to publish them, but does not answer ({facts.nodes[gone].error}).",
            f"Start it again; `rosnode cleanup` removes the registrations of dead nodes.",
            [name],
        )
    else:
        others = facts.alive_publishers("/tf")
        there = f"/tf comes from {listing(others)} only" if others else "nobody publishes /tf"
        key = robot.key or robot.settings.description
        remap = "" if key == "/robot_description" else f" robot_description:={key}"
        prefix = f" _tf_prefix:={robot.settings.tf_prefix}" if robot.settings.tf_prefix else ""
        findings.add(
            "no_state_publisher",
            ERROR,
            f"{what}: no robot_state_publisher runs for it, and {there}.",
            f"Start one: `rosrun robot_state_publisher robot_state_publisher{remap}{prefix}`.",
            [name],
        )


def other_prefix(tree: Tree, robot: RobotFacts, absent: Dict[str, str]):
    """Another prefix under which most of the links come; None: there is none."""
    votes: Dict[str, int] = {}
    for link in absent.values():
        for frame in tree.of_child:
            if frame == link or frame.endswith("/" + link):
                prefix = frame[: -len(link)].rstrip("/")
                votes[prefix] = votes.get(prefix, 0) + 1
    best = max(sorted(votes), key=votes.get, default=None)
    return best if best is not None and votes[best] * 2 > len(absent) else None


def state_publishers(facts: Facts, tree: Tree, robot: RobotFacts) -> Set[str]:
    """Nodes that make frames of joint states, and that no frame of another robot came from."""
    own = {robot.settings.frame(link) for link in robot.description.links}
    result = set()
    for node in {node for topic in ("/tf", "/tf_static") for node in facts.graph.publishers.get(topic, [])}:
        published = {stream.child for stream in facts.streams if stream.publisher == node}
        if joint_state_topics(facts, node) and (published & own or not published):
            result.add(node)
    return result


def check_joint_states(facts, robot: RobotFacts, absent: Dict[str, str], what: str, publisher: str, findings: Findings):
    name = robot.settings.name
    topic = sorted(joint_state_topics(facts, publisher))[0]
    sources = facts.alive_publishers(topic)
    wanted = {joint for link in absent.values() for joint in robot.description.moving_joints_above(link)}
    missing = sorted(wanted - facts.joints.get(topic, set()))
    if not wanted:
        findings.add(
            "state_publisher_of_other_robot",
            ERROR,
            f"{what}, though {publisher} runs: it has read another description.",
            f"Start it again after {robot.key} was set: `rosnode kill {publisher}`.",
            [name],
        )
    elif not sources:
        findings.add(
            "no_joint_states",
            ERROR,
            f"{what}: {publisher} waits for joint states on {topic}, and nobody publishes them.",
            "Start the robot's driver, or for a trial without it"
            f" `rosrun joint_state_publisher joint_state_publisher joint_states:={topic}`.",
            [name],
        )
    elif not facts.joints.get(topic):
        findings.add(
            "joint_states_silent",
            ERROR,
            f"{what}: {publisher} waits for joint states, and {listing(sources)} sent none on {topic} in "
            f"{facts.listened:.1f} s.",
            f"Look at the driver: `rostopic hz {topic}`.",
            [name],
        )
    elif missing:
        findings.add(
            "joint_states_incomplete",
            ERROR,
            f"{what}: {counted(len(missing), 'joint')} ({listing(missing)}) are in no message of {listing(sources)} "
            f"on {topic}.",
            f"Compare the names of the driver's joints with the URDF's: `rostopic echo -n 1 {topic}/name`.",
            [name],
        )
    else:
        findings.add(
            "state_publisher_silent",
            ERROR,
            f"{what}, though {publisher} runs and has joint states: it has read another description, or refuses their "
            "stamps.",
            f"Start it again after {robot.key} was set: `rosnode kill {publisher}`.",
            [name],
        )


def check_connected(facts: Facts, tree: Tree, apart: Dict[str, Set[str]], findings: Findings):
    """The frames come, but not below the world frame."""
    world, roots = facts.world_frame(), sorted(apart)
    names = sorted({name for robots in apart.values() for name in robots})
    who = f"robot{'s' if len(names) > 1 else ''} {listing(names)}"
    gone = facts.gone_publishers("/tf")
    set_frame = f"`rosparam set {facts.node}/world_frame {roots[0]}` and start the node again"
    publish = f"`rosrun tf2_ros static_transform_publisher 0 0 0 0 0 0 {world} {roots[0]}`"
    if gone:
        findings.add(
            "tf_publisher_gone",
            ERROR,
            f"Nothing connects the world frame '{world}' with {who}, below {listing(roots)}: {listing(gone)} is "
            "registered"
            " for /tf, but does not answer.",
            "Start it again; `rosnode cleanup` removes the registrations of dead nodes.",
            names,
        )
    elif not tree.has(world):
        findings.add(
            "wrong_world_frame",
            ERROR,
            f"The world frame '{world}' is unknown to tf: nobody publishes it now, and {who} hangs below "
            f"{listing(roots)}.",
            f"Choose a frame that is there: {set_frame}; or publish where the robot is: {publish}.",
            names,
        )
    else:
        findings.add(
            "two_trees",
            ERROR,
            f"tf is in parts that nothing connects: the world frame '{world}' is below '{tree.root(world)}', {who} "
            "below"
            f" {listing(roots)}.",
            f"Start what says where the robot is (localization, odometry), or publish it: {publish}; or {set_frame}.",
            names,
        )
