# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""The commands and the lines for parameter files that fixes print, in backticks. A command works as it is printed.

Words in capitals stand for a value that the doctor cannot know, and my_robot.urdf for a file of the user.
"""
from __future__ import annotations

import shlex
from typing import Any, Dict, List, Set
from urllib.parse import urlparse

import yaml

from hgrid_doctor.facts import Facts, RobotFacts

PARAM_FILE = "proximity.yaml"
DEFAULT_PORT = 11311


def yaml_line(values: Dict[str, Any]) -> str:
    """Returns the values as one line of YAML, for example "margin: 0.2"."""
    return yaml.safe_dump(values, default_flow_style=True, width=1e9, sort_keys=False, allow_unicode=True).strip()[1:-1]


def start_command(node: str) -> str:
    """Starts the node with the parameters that are on the parameter server."""
    namespace, _, name = node.rpartition("/")
    place = f" __ns:={namespace}" if namespace else ""
    return f"`rosrun hgrid_proximity proximity_node __name:={name}{place}`"


def restart(facts: Facts) -> str:
    if facts.host != facts.node:
        return f"unload the nodelet {facts.node} and load it again"
    start = start_command(facts.node)
    return f"`rosnode kill {facts.node}`, then {start} if no launch file with respawn starts it"


def with_params(facts: Facts, values: Dict[str, Any]) -> str:
    """Returns how to change parameters. On the parameter server they would be lost, because a launch file clears the
    parameters of the node before it starts the node."""
    namespace, _, name = facts.node.rpartition("/")
    launch = f"roslaunch hgrid_proximity proximity.launch params:=$PWD/{PARAM_FILE}"
    launch = (f"ROS_NAMESPACE={namespace} " if namespace else "") + launch
    launch += f" name:={name}" if name != "proximity" else ""
    line = yaml_line(values)
    return f"put `{line}` into the node's parameter file, end the node, and start it with the file: `{launch}`"


def sentence(text: str) -> str:
    return text[:1].upper() + text[1:]


def robot_entries(robots: List[RobotFacts], changed: str, changes: Dict[str, Any]) -> List[Dict[str, Any]]:
    """Returns the value of ~robots, with changes of one robot. @param changed  name of this robot"""
    entries = []
    for robot in robots:
        settings = robot.settings
        entry = {"name": settings.name, "description": robot.key or settings.description}
        if robot.semantic_key:
            entry["semantic"] = robot.semantic_key
        if settings.tf_prefix:
            entry["tf_prefix"] = settings.tf_prefix
        entries.append({**entry, **changes} if settings.name == changed else entry)
    return entries


def load_file(key: str, file: str) -> str:
    """Returns a command that sets a parameter to the text of a file. Without -t, rosparam would read the text as YAML,
    and it would refuse most XML."""
    return f"`rosparam set -t {file} {key}`"


def reload_command(facts: Facts, robot: RobotFacts) -> str:
    request = shlex.quote(yaml_line({"robot": robot.settings.name}))
    return f"`rosservice call {facts.node}/reload_robot {request}`"


def remove_rule(facts: Facts, rule: Any) -> str:
    request = yaml_line({"rules": [{"first": rule.first, "second": rule.second}], "remove": True})
    return f"`rosservice call {facts.node}/set_allowed {shlex.quote('{' + request + '}')}`"


def publish_frame(parent: str, child: str) -> str:
    """Returns a command that places a frame at its parent. It needs no package beside rostopic."""
    rotation = {"rotation": {"w": 1.0}}
    transform = {"header": {"frame_id": parent}, "child_frame_id": child, "transform": rotation}
    message = "{" + yaml_line({"transforms": [transform]}) + "}"
    return f"`rostopic pub -l /tf_static tf2_msgs/TFMessage {shlex.quote(message)}`"


def state_publisher_command(facts: Facts, robot: RobotFacts) -> str:
    """Starts a robot_state_publisher that finds the description of the robot. Its name differs from others.

    Versions 1.15.0 and 1.15.1, as in Debian 11, ignore _tf_prefix: with them, the links of the description need the
    prefix in their names."""
    key = robot.key or robot.settings.description
    namespace, _, name = key.rpartition("/")
    place = f" robot_description:={key}" if name != "robot_description" else f" __ns:={namespace}" if namespace else ""
    alone = len(facts.robots) == 1 or " __ns:=" in place
    own_name = "" if alone else f" __name:={robot.settings.name}_state_publisher"
    prefix = f" _tf_prefix:={robot.settings.tf_prefix}" if robot.settings.tf_prefix else ""
    older = " (robot_state_publisher 1.15.0 and 1.15.1 ignore _tf_prefix; newer ones do not)" if prefix else ""
    return f"`rosrun robot_state_publisher robot_state_publisher{place}{own_name}{prefix}`{older}"


def play_joints(topic: str, joints: Set[str]) -> str:
    """Publishes joint states at rest. Needs no other package."""
    states = " ".join(f"{joint}:0:0" for joint in sorted(joints))
    return f"`rosrun hgrid_proximity play_robot.py {states} joint_states:={topic}`"


def master_command(uri: str) -> str:
    """Starts a master. Without -p, roscore uses the default port, whatever ROS_MASTER_URI says."""
    try:
        port = urlparse(uri).port or DEFAULT_PORT
    except ValueError:
        port = DEFAULT_PORT
    return "`roscore`" if port == DEFAULT_PORT else f"`roscore -p {port}`"


def log_command(facts: Facts) -> str:
    return f"`grep {facts.node} \"$(roslaunch-logs)/rosout.log\" | tail`"


COMPARE_CLOCKS = "compare `date +%s.%N` on both"
