# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""The facts: what was observed, as plain data. Facts can be created and judged without ROS."""
from __future__ import annotations

from dataclasses import dataclass, field
from enum import Enum
from typing import Any, Dict, List, Optional, Set, Tuple

from hgrid_doctor.description import Description, Semantic
from hgrid_doctor.settings import RobotSettings, Settings

STATES = ("FRESH", "LATE", "STALE", "LOST", "FROZEN", "INVALID", "UNPLACED")  # numbered as in BodyState.msg
STALE, LOST, FROZEN, INVALID, UNPLACED = range(2, 7)


@dataclass
class Environment:
    """How this shell sees the network."""

    master_uri: str = ""
    master_uri_is_set: bool = True
    ros_ip: str = ""
    ros_hostname: str = ""
    own_name: str = ""  # address that nodes of this shell announce
    own_name_error: str = ""  # why others cannot use it; empty: they can
    address_towards_master: str = ""  # address of this computer in the network of the master; empty: unknown


@dataclass
class Graph:
    """What the master reports: publishers, subscribers and types by topic, nodes by service."""

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
        """Returns the topics that a node publishes, and the topics that it subscribes to."""
        published = {topic for topic, nodes in self.publishers.items() if node in nodes}
        return published, {topic for topic, nodes in self.subscribers.items() if node in nodes}


@dataclass
class NodeFacts:
    """A node, and how it answered a request for its process id."""

    name: str
    uri: str = ""  # empty: the master does not know it
    host: str = ""
    host_error: str = ""  # why the host's name cannot be resolved
    pid: Optional[int] = None
    error: str = ""  # why the node does not answer


@dataclass
class TfStream:
    """What one publisher sends about one frame with one parent."""

    publisher: str
    parent: str
    child: str
    static: bool
    count: int = 0
    offsets: List[float] = field(default_factory=list)  # [s] stamp - time of arrival; negative for a stamp in the past
    zero_stamps: int = 0
    poses: List[Tuple[float, Tuple[float, ...]]] = field(default_factory=list)  # stamp [s]; x y z [m], quaternion


@dataclass
class TopicFacts:
    """What the publishers of a topic sent while the doctor listened. Each member is by name of the publisher."""

    counts: Dict[str, int] = field(default_factory=dict)  # number of messages
    errors: Dict[str, str] = field(default_factory=dict)  # why nothing could be received
    types: Dict[str, str] = field(default_factory=dict)
    frames: Dict[str, str] = field(default_factory=dict)  # frame_id of the newest header, for topics of maps and clouds

    def total(self) -> int:
        return sum(self.counts.values())


@dataclass(frozen=True)
class JointValue:
    """The newest position of a joint in a topic of joint states."""

    position: float  # [rad] or [m]; NaN: the message has none
    message: int  # number of the message: joints with equal numbers were measured together


class MeshFlaw(Enum):
    """The kinds of reasons why a mesh cannot be read."""

    NO_PACKAGE = 1
    OUTSIDE = 2  # the file is neither in a package nor in ~mesh_roots
    UNREADABLE = 3


@dataclass(frozen=True)
class MeshError:
    """Why a mesh cannot be read."""

    flaw: MeshFlaw
    text: str


@dataclass(frozen=True)
class Touch:
    """Two links of one robot that touch."""

    first: str  # full name: robot/link
    second: str
    since: float  # [s] ROS time when they became a near pair

    @property
    def robot(self) -> str:
        return self.first.partition("/")[0]


@dataclass
class RobotFacts:
    """A robot of the parameter ~robots, and its descriptions."""

    settings: RobotSettings
    key: str = ""  # name of the parameter that contains the URDF; empty if there is none
    candidates: List[str] = field(default_factory=list)  # other parameters whose name ends in robot_description
    description: Optional[Description] = None
    semantic_key: str = ""
    semantic: Optional[Semantic] = None
    mesh_errors: Dict[str, MeshError] = field(default_factory=dict)  # by the URI of the mesh


@dataclass
class Facts:
    """All facts that the checks use."""

    node: str = "/proximity"
    host: str = ""  # name of the process that runs the node: the node itself or a nodelet manager; empty: none
    others: List[str] = field(default_factory=list)  # names of other proximity nodes
    environment: Environment = field(default_factory=Environment)
    graph: Graph = field(default_factory=Graph)
    nodes: Dict[str, NodeFacts] = field(default_factory=dict)  # nodes that the checks need, by name
    pid_after: Optional[int] = None  # process id of `host` at the end of listening
    settings: Settings = field(default_factory=Settings)
    robots: List[RobotFacts] = field(default_factory=list)
    parameters: Set[str] = field(default_factory=set)  # names of all parameters
    listened: float = 0.0  # [s] how long the doctor listened to topics
    wall: float = 0.0  # [s] wall clock at the end of listening
    topics: Dict[str, TopicFacts] = field(default_factory=dict)
    clock: List[float] = field(default_factory=list)  # [s] values received on /clock
    streams: List[TfStream] = field(default_factory=list)
    joints: Dict[str, Dict[str, JointValue]] = field(default_factory=dict)  # received joints by name, by topic
    descriptions_of_nodes: Dict[str, str] = field(default_factory=dict)  # robot_description that a node finds
    status_error: str = ""  # why ~status could not be read
    first_status: Any = None  # hgrid_proximity/Status
    status: Any = None  # the newest status
    rules: List[Any] = field(default_factory=list)  # rules of ~set_allowed: hgrid_proximity/AllowedPair
    pairs_off: int = 0  # number of pairs that these rules switch off
    touching: List[Touch] = field(default_factory=list)
    map_file_errors: Dict[str, str] = field(default_factory=dict)  # why the file of a map cannot be read, by source

    def alive(self, node: str) -> bool:
        known = self.nodes.get(node)
        return known is None or not known.error

    def gone_publishers(self, topic: str) -> List[str]:
        """Returns the nodes that are registered as publishers of the topic but do not answer."""
        return [node for node in self.graph.publishers.get(topic, []) if not self.alive(node)]

    def alive_publishers(self, topic: str) -> List[str]:
        return [node for node in self.graph.publishers.get(topic, []) if self.alive(node)]

    def topic(self, name: str) -> TopicFacts:
        return self.topics.get(name) or TopicFacts()

    def world_frame(self) -> str:
        """Returns the name of the world frame; empty if it is the root of a robot whose description was not read."""
        if self.status is not None and self.status.header.frame_id:
            return self.status.header.frame_id
        if self.settings.world_frame:
            return self.settings.world_frame
        first = self.robots[0] if self.robots else RobotFacts(RobotSettings())
        root = first.description.root if first.description else ""
        return first.settings.frame(root) if root else ""

    def source(self, name: str) -> Any:
        """Returns the entry of a source in ~status; None if there is none."""
        sources = self.status.sources if self.status is not None else []
        return next((source for source in sources if source.name == name), None)

    def forget_robots_that_left(self):
        """Drops the robots of ~robots that ~apply_robots removed or declared absent: nothing need be there for them."""
        if self.status is None or self.status.sources_total > len(self.status.sources):
            return
        self.robots = [robot for robot in self.robots if self.source(robot.settings.name) is not None]

    def is_loaded(self, robot: str) -> bool:
        source = self.source(robot)
        return source is not None and source.bodies > 0
