# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""What was observed, as plain data: no ROS is needed to make it or to judge it."""
from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Dict, List, Optional, Set, Tuple

from hgrid_doctor.description import Description, Semantic
from hgrid_doctor.settings import RobotSettings, Settings

STATES = ("FRESH", "LATE", "STALE", "LOST", "FROZEN", "INVALID", "UNPLACED")  # as BodyState.msg numbers them
STALE, LOST, FROZEN, INVALID, UNPLACED = range(2, 7)


@dataclass
class Environment:
    """This shell's idea of the network."""

    master_uri: str = ""
    master_uri_is_set: bool = True
    ros_ip: str = ""
    ros_hostname: str = ""
    own_name: str = ""  # what nodes of this shell would announce
    own_name_error: str = ""


@dataclass
class Graph:
    """What the master says: nodes by topic, types by topic."""

    error: str = ""  # why the master does not answer
    publishers: Dict[str, List[str]] = field(default_factory=dict)
    subscribers: Dict[str, List[str]] = field(default_factory=dict)
    services: Dict[str, List[str]] = field(default_factory=dict)
    types: Dict[str, str] = field(default_factory=dict)
    use_sim_time: bool = False

    def nodes(self) -> Set[str]:
        registrations = [*self.publishers.values(), *self.subscribers.values(), *self.services.values()]
        return {node for nodes in registrations for node in nodes}

    def topics_of(self, node: str) -> Tuple[Set[str], Set[str]]:
        """What a node publishes, and what it subscribes to."""
        published = {topic for topic, nodes in self.publishers.items() if node in nodes}
        return published, {topic for topic, nodes in self.subscribers.items() if node in nodes}


@dataclass
class NodeFacts:
    """A node and its ping."""

    name: str
    uri: str = ""  # empty: the master does not know it
    host: str = ""
    host_error: str = ""  # why the host's name cannot be resolved
    pid: Optional[int] = None
    error: str = ""  # why it does not answer


@dataclass
class TfStream:
    """What one publisher says of one frame in one parent."""

    publisher: str
    parent: str
    child: str
    static: bool
    count: int = 0
    offsets: List[float] = field(default_factory=list)  # [s] stamp - time of arrival; negative: in the past
    zero_stamps: int = 0
    poses: List[Tuple[float, Tuple[float, ...]]] = field(default_factory=list)  # stamp [s]; x y z [m], quaternion


@dataclass
class TopicFacts:
    """What came on a topic while it was listened to, by publisher."""

    counts: Dict[str, int] = field(default_factory=dict)
    errors: Dict[str, str] = field(default_factory=dict)  # why nothing could come
    types: Dict[str, str] = field(default_factory=dict)
    frames: Dict[str, str] = field(default_factory=dict)  # frame_id of the newest header, where that was looked at

    def total(self) -> int:
        return sum(self.counts.values())


@dataclass
class RobotFacts:
    """A robot of the node's parameters, with its descriptions."""

    settings: RobotSettings
    key: str = ""  # the parameter that holds the URDF; empty: there is none
    candidates: List[str] = field(default_factory=list)  # other parameters of that name
    description: Optional[Description] = None
    semantic_key: str = ""
    semantic: Optional[Semantic] = None
    mesh_errors: Dict[str, str] = field(default_factory=dict)  # by URI


@dataclass
class Facts:
    """Everything that the checks look at."""

    node: str = "/proximity"
    host: str = ""  # the process that serves the node: itself, or a nodelet manager; empty: nobody
    others: List[str] = field(default_factory=list)  # other proximity nodes
    environment: Environment = field(default_factory=Environment)
    graph: Graph = field(default_factory=Graph)
    nodes: Dict[str, NodeFacts] = field(default_factory=dict)  # those that matter
    pid_after: Optional[int] = None  # of the host, when listening was over
    settings: Settings = field(default_factory=Settings)
    robots: List[RobotFacts] = field(default_factory=list)
    listened: float = 0.0  # [s]
    wall: float = 0.0  # [s] the wall clock when listening was over
    topics: Dict[str, TopicFacts] = field(default_factory=dict)
    clock: List[float] = field(default_factory=list)  # [s] values of /clock
    streams: List[TfStream] = field(default_factory=list)
    joints: Dict[str, Set[str]] = field(default_factory=dict)  # names that came, by topic of joint states
    descriptions_of_nodes: Dict[str, str] = field(default_factory=dict)  # robot_description as they find it
    status_error: str = ""  # why ~status could not be read
    first_status: Any = None  # hgrid_proximity/Status
    status: Any = None  # the newest
    map_file_errors: Dict[str, str] = field(default_factory=dict)  # by name of the map

    def alive(self, node: str) -> bool:
        known = self.nodes.get(node)
        return known is None or not known.error

    def gone_publishers(self, topic: str) -> List[str]:
        """Nodes that are registered, but do not answer."""
        return [node for node in self.graph.publishers.get(topic, []) if not self.alive(node)]

    def alive_publishers(self, topic: str) -> List[str]:
        return [node for node in self.graph.publishers.get(topic, []) if self.alive(node)]

    def topic(self, name: str) -> TopicFacts:
        return self.topics.get(name) or TopicFacts()

    def world_frame(self) -> str:
        """Empty: it follows from a robot that was not read."""
        if self.status is not None and self.status.header.frame_id:
            return self.status.header.frame_id
        if self.settings.world_frame:
            return self.settings.world_frame
        first = self.robots[0] if self.robots else RobotFacts(RobotSettings())
        root = first.description.root if first.description else ""
        return first.settings.frame(root) if root else ""

    def source(self, name: str) -> Any:
        """The node's own word about a source; None if it said nothing."""
        sources = self.status.sources if self.status is not None else []
        return next((source for source in sources if source.name == name), None)

    def is_loaded(self, robot: str) -> bool:
        source = self.source(robot)
        return source is not None and source.bodies > 0
