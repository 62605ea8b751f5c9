# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Finds out why a robot_state_publisher does not publish frames that it should publish."""
from __future__ import annotations

from dataclasses import dataclass
from typing import Dict, List, Set

from hgrid_doctor.facts import Facts, RobotFacts
from hgrid_doctor.finding import ERROR, WARN, Findings, counted, listing
from hgrid_doctor.fixes import play_joints, state_publisher_command
from hgrid_doctor.frames import joint_state_topics


TURN_TOLERANCE, SLIDE_TOLERANCE = 0.01, 0.001  # [rad], [m]: simulations and encoders do not follow exactly


@dataclass
class Absent:
    """Frames of a robot that nobody publishes."""

    robot: RobotFacts
    frames: Dict[str, str]  # frame: a link that needs the frame
    what: str  # the begin of a sentence about the frames
    explains: Set[str]  # sources that are incomplete because of the missing frames


@dataclass
class Waiting:
    """A robot_state_publisher that waits for joint states on a topic without a publisher."""

    absent: Absent
    publisher: str
    topic: str


def state_publishers(facts: Facts, robot: RobotFacts) -> Set[str]:
    """Returns the nodes that turn joint states into frames. Leaves out nodes that are known to serve another robot."""
    own = {robot.settings.frame(link) for link in robot.description.links}
    others = {other.key for other in facts.robots if other is not robot}
    sending, silent = set(), set()
    for node in {node for topic in ("/tf", "/tf_static") for node in facts.graph.publishers.get(topic, [])}:
        if not joint_state_topics(facts, node):
            continue
        published = {stream.child for stream in facts.streams if stream.publisher == node}
        if published & own:
            sending.add(node)
        elif not published and facts.descriptions_of_nodes.get(node) not in others:
            silent.add(node)
    return sending or silent


def check_joint_states(facts: Facts, absent: Absent, publisher: str, findings: Findings, waiting: List[Waiting]):
    robot, what = absent.robot, absent.what
    topic = sorted(joint_state_topics(facts, publisher))[0]
    start = state_publisher_command(facts, robot)
    again = f"Start it again now that {robot.key} is set: `rosnode kill {publisher}`, then {start}"
    sources = facts.alive_publishers(topic)
    wanted = {joint for link in absent.frames.values() for joint in robot.description.moving_joints_above(link)}
    received = set(facts.joints.get(topic, {}))
    known = robot.description.known_to_state_publisher(received)
    missing = sorted(wanted - known)
    late = [joint for joint in robot.description.joints if joint.name in missing and joint.mimic in known]
    if not wanted:
        findings.add(
            "state_publisher_of_other_robot",
            ERROR,
            f"{what}, though {publisher} runs: it has read another description.",
            f"{again}.",
            absent.explains,
        )
    elif not sources:
        waiting.append(Waiting(absent, publisher, topic))
    elif not facts.joints.get(topic):
        findings.add(
            "joint_states_silent",
            ERROR,
            f"{what}: {publisher} waits for joint states, and {listing(sources)} sent none on {topic} in "
            f"{facts.listened:.1f} s.",
            f"Look at the driver: `rostopic hz {topic}`.",
            absent.explains,
        )
    elif late:
        leader, multiplier, offset = robot.description.end_of_mimicry(late[0])
        findings.add(
            "mimic_of_mimic",
            ERROR,
            f"{what}: joint '{late[0].name}' follows '{late[0].mimic}', which itself follows a joint, and {publisher} "
            "computes such joints once, in the order of their names (robot_state_publisher 1.15.2 does).",
            f"In the URDF, let '{late[0].name}' follow '{leader}', with multiplier {multiplier:g} and offset "
            f"{offset:g}.",
            absent.explains,
        )
    elif missing:
        findings.add(
            "joint_states_incomplete",
            ERROR,
            f"{what}: {counted(len(missing), 'joint')} ({listing(missing)}) are in no message of {listing(sources)} "
            f"on {topic}.",
            f"Compare the names of the driver's joints with the URDF's: `rostopic echo -n 1 {topic}/name`.",
            absent.explains,
        )
    else:
        findings.add(
            "state_publisher_silent",
            ERROR,
            f"{what}, though {publisher} runs and has joint states: it has read another description, or refuses their "
            "stamps.",
            f"{again}.",
            absent.explains,
        )


def check(facts: Facts, findings: Findings):
    """Compares joints that follow others with the joint states, if these hold both."""
    for robot in facts.robots:
        if robot.description is None or robot.description.flaw:
            continue
        for publisher in sorted(state_publishers(facts, robot)):
            for topic in sorted(joint_state_topics(facts, publisher)):
                check_mimics(facts, robot, topic, findings)


def check_mimics(facts: Facts, robot: RobotFacts, topic: str, findings: Findings):
    joints = facts.joints.get(topic, {})
    for joint in robot.description.joints:
        own, leader = joints.get(joint.name), joints.get(joint.mimic)
        if own is None or leader is None or own.message != leader.message:
            continue
        rule = joint.multiplier * leader.position + joint.offset
        tolerance = SLIDE_TOLERANCE if joint.type == "prismatic" else TURN_TOLERANCE
        if not abs(own.position - rule) > tolerance:  # also if one of them is NaN
            continue
        findings.add(
            "mimic_differs",
            WARN,
            f"Joint '{joint.name}' of robot '{robot.settings.name}' is at {own.position:.4g} on {topic}, but by the "
            f"URDF it follows '{joint.mimic}' and would be at {rule:.4g}: tf follows the message, states that are "
            "checked follow the URDF.",
            f"Leave '{joint.name}' out of the joint states, so that robot_state_publisher computes it, or correct its "
            "<mimic> in the URDF.",
        )
        return


def add_no_joint_states(waiting: List[Waiting], findings: Findings):
    """Adds one finding for all robots, because the same driver may be missing for all of them."""
    first = waiting[0]
    topics = sorted({each.topic for each in waiting})
    joints = set()
    for each in waiting:
        if each.topic == first.topic:
            for link in each.absent.frames.values():
                joints |= each.absent.robot.description.moving_joints_above(link)
    if len(waiting) == 1:
        what = f"{first.absent.what}: {first.publisher} waits for joint states on {first.topic}"
    else:
        names = [each.absent.robot.settings.name for each in waiting]
        frames = sum(len(each.absent.frames) for each in waiting)
        what = f"{frames} frames of robots {listing(names)} do not come: they wait for joint states"
        what += f" on {listing(topics)}"
    findings.add(
        "no_joint_states",
        ERROR,
        f"{what}, and nobody publishes them.",
        f"Start the robot's driver. For a trial without it: {play_joints(first.topic, joints)}.",
        {source for each in waiting for source in each.absent.explains},
    )
