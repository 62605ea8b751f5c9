# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Collects the facts of a running system, step by step. Each step has a time limit."""
from __future__ import annotations

import time
from typing import Iterable, Set

from hgrid_doctor import description
from hgrid_doctor.facts import Facts, RobotFacts
from hgrid_doctor.frames import joint_state_topics
from hgrid_doctor.observe.bounded import call, call_all
from hgrid_doctor.observe.files import file_error, mesh_error
from hgrid_doctor.observe.graph import Api, ask_nodes, optional, read_environment, read_graph
from hgrid_doctor.observe.listener import Listener
from hgrid_doctor.observe.pairs import read_pairs
from hgrid_doctor.settings import absolute, read_settings

DEFAULT_NODE = "/proximity"
STATUS_TYPE = "hgrid_proximity/Status"


def gather(node: str, timeout: float, listen: float) -> Facts:
    """Collects all facts.

    @param node  name of the node; empty: the only proximity node that runs, otherwise /proximity
    @param timeout  [s] time limit of each call
    @param listen  [s] how long to listen to topics
    """
    facts = Facts(node=absolute(node.rstrip("/"), "") if node else DEFAULT_NODE)
    facts.environment = read_environment(timeout)
    uri = facts.environment.master_uri
    facts.graph = read_graph(uri, timeout)
    if facts.graph.error:
        return facts
    find_node(facts, node)
    master = Api(uri, timeout)
    read_parameters(facts, master, timeout)
    follow_remaps(facts)
    find_descriptions_of_nodes(facts, master, timeout)
    facts.nodes = ask_nodes(uri, sorted(nodes_that_matter(facts)), timeout)
    listen_to_topics(facts, listen, timeout)
    facts.forget_robots_that_left()
    if facts.host:
        facts.pid_after = ask_nodes(uri, [facts.host], timeout)[facts.host].pid
        read_pairs(facts, master, timeout)
    read_files(facts, timeout)
    return facts


def find_node(facts: Facts, asked: str):
    """Finds the process of the node. It is the publisher of ~status, because the process of a nodelet has another
    name."""
    running = {
        topic[: -len("/status")]: facts.graph.publishers.get(topic, [])
        for topic, kind in facts.graph.types.items()
        if kind == STATUS_TYPE and topic.endswith("/status") and facts.graph.publishers.get(topic)
    }
    if not asked and facts.node not in running and len(running) == 1 and facts.node not in facts.graph.nodes():
        facts.node = next(iter(running))
    publishers = running.get(facts.node, [])
    facts.host = publishers[0] if publishers else facts.node if facts.node in facts.graph.nodes() else ""
    facts.others = sorted(set(running) - {facts.node})


def read_parameters(facts: Facts, master: Api, timeout: float):
    values = call(lambda: optional(master, "getParam", facts.node), timeout).value
    facts.settings = read_settings(values, facts.node)
    names = call(lambda: master("getParamNames"), timeout).value or []
    facts.parameters = set(names)
    for settings in facts.settings.robots:
        robot = RobotFacts(settings)
        robot.key, text = find_parameter(facts.node, settings.description, master, timeout)
        robot.candidates = [name for name in names if name.endswith("robot_description") and name != robot.key]
        if robot.key:
            robot.description = description.parse_urdf(text)
        if settings.semantic:
            robot.semantic_key, text = find_parameter(facts.node, settings.semantic, master, timeout)
            if robot.semantic_key:
                robot.semantic = description.parse_srdf(text)
        facts.robots.append(robot)


def follow_remaps(facts: Facts):
    """Finds remapped input topics. If the node subscribes to exactly one unknown topic of the type, that topic is
    used."""
    subscribed = facts.graph.topics_of(facts.host)[1] if facts.host else set()
    expected = input_topics(facts)
    for each in facts.settings.inputs:
        if not each.topic or each.topic in subscribed:
            continue
        others = [topic for topic in subscribed - expected if facts.graph.types.get(topic) == each.type]
        if len(others) == 1:
            each.topic = others[0]


def find_parameter(node: str, name: str, master: Api, timeout: float):
    """Returns the name and the value of a parameter. Searches it like the node, from the node's namespace upwards."""

    def read():
        key = name if name.startswith("/") else optional(master, "searchParam", name, caller=node)
        value = optional(master, "getParam", key) if key else None
        return (key, value) if value is not None else ("", None)

    return call(read, timeout).value or ("", None)


def all_joint_state_topics(facts: Facts) -> Set[str]:
    """Returns the topics of joint states to which publishers of tf subscribe."""
    publishers = {node for topic in ("/tf", "/tf_static") for node in facts.graph.publishers.get(topic, [])}
    return {topic for node in publishers for topic in joint_state_topics(facts, node)}


def find_descriptions_of_nodes(facts: Facts, master: Api, timeout: float):
    """Finds the robot_description of each robot_state_publisher, which shows to which robot it belongs."""
    publishers = {node for topic in ("/tf", "/tf_static") for node in facts.graph.publishers.get(topic, [])}
    search = {
        node: lambda node=node: optional(master, "searchParam", "robot_description", caller=node)
        for node in publishers
        if joint_state_topics(facts, node)
    }
    outcomes = call_all(search, timeout)
    facts.descriptions_of_nodes = {node: outcome.value for node, outcome in outcomes.items() if outcome.value}


def input_topics(facts: Facts) -> Set[str]:
    return {each.topic for each in facts.settings.inputs if each.topic}


def nodes_that_matter(facts: Facts) -> Iterable[str]:
    topics = {"/tf", "/tf_static", "/clock", facts.node + "/status"}
    topics |= input_topics(facts) | all_joint_state_topics(facts)
    nodes = {node for topic in topics for node in facts.graph.publishers.get(topic, [])}
    return nodes | ({facts.host} if facts.host else set())


def listen_to_topics(facts: Facts, listen: float, timeout: float):
    status = status_class(facts) if facts.host else None  # importing takes time, so it comes before listening
    listener = Listener(facts, listen, timeout)
    listener.clock()
    listener.transforms("/tf", static=False)
    listener.transforms("/tf_static", static=True)
    for topic in all_joint_state_topics(facts):
        listener.joint_states(topic)
    for topic in input_topics(facts):
        listener.frame_of(topic)
    begin = time.monotonic()
    if status:
        listener.status(facts.node + "/status", facts.host, status)
    listener.finish()
    facts.listened = time.monotonic() - begin
    if facts.status is None and not facts.status_error:
        facts.status_error = facts.topic(facts.node + "/status").errors.get(facts.host, "")


def status_class(facts: Facts):
    """Returns the message class of ~status; None if this shell has none, which is noted as the error of ~status."""
    try:
        from hgrid_proximity.msg import Status
    except ImportError as error:
        facts.status_error = f"this shell has no messages of hgrid_proximity ({error})"
        return None
    return Status


def read_files(facts: Facts, timeout: float):
    for robot in facts.robots:
        uris = set()
        for link in (robot.description.links if robot.description else {}).values():
            uris.update(link.collision_meshes)
            if not link.collisions and facts.settings.uses_visual(f"{robot.settings.name}/{link.name}"):
                uris.update(link.visual_meshes)
        roots = facts.settings.mesh_roots
        read = call(lambda uris=uris, roots=roots: {uri: mesh_error(uri, roots) for uri in sorted(uris)}, timeout)
        robot.mesh_errors = {uri: error for uri, error in (read.value or {}).items() if error is not None}
    folder = facts.settings.map_folder
    files = {
        each.source: lambda file=each.file: file_error(f"{folder}/{file}") if folder else "~map/folder is not set"
        for each in facts.settings.inputs
        if each.file
    }
    outcomes = call_all(files, timeout)
    facts.map_file_errors = {name: outcome.value for name, outcome in outcomes.items() if outcome.value}
