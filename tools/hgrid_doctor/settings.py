# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""The parameters of the node that the checks need. A wrong value is replaced by the default; the node reports it."""
from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import Any, Dict, List


def _matches(glob: str, name: str) -> bool:
    return re.fullmatch(".*".join(map(re.escape, glob.split("*"))), name, re.DOTALL) is not None


@dataclass
class RobotSettings:
    """A robot of the parameter ~robots."""

    name: str = "robot"
    description: str = "robot_description"
    semantic: str = "robot_description_semantic"
    tf_prefix: str = ""

    def frame(self, link: str) -> str:
        prefix = self.tf_prefix.lstrip("/")
        return f"{prefix}/{link}" if prefix else link


@dataclass
class InputSettings:
    """A map, a cloud or a tracker of the parameters ~maps, ~clouds and ~tracks."""

    source: str  # name of the source, for example map/hall
    topic: str = ""  # absolute name; empty: the map comes from a file
    file: str = ""
    type: str = ""  # message type of the topic
    parameter: str = ""  # the parameter that lists it: "maps", "clouds" or "tracks"


@dataclass
class Settings:
    """The parameters, see config/params.yaml."""

    world_frame: str = ""
    rate: float = 50.0
    margin: float = 0.1
    stale_after: float = 0.25
    lost_after: float = 2.0
    max_future: float = 0.5
    max_pairs: int = 100_000
    map_folder: str = ""
    use_visual: List[str] = field(default_factory=list)
    mesh_roots: List[str] = field(default_factory=list)
    robots: List[RobotSettings] = field(default_factory=lambda: [RobotSettings()])
    inputs: List[InputSettings] = field(default_factory=list)
    values: Dict[str, Any] = field(default_factory=dict, compare=False)  # all parameters as they were read

    def uses_visual(self, body: str) -> bool:
        return any(_matches(pattern, body) for pattern in self.use_visual)


def read_settings(values: Any, node: str) -> Settings:
    """Returns the settings. @param values  the private parameters of the node, as the parameter server returns them"""
    values = values if isinstance(values, dict) else {}
    settings = Settings(values=values)
    settings.world_frame = _text(values, "world_frame", "").lstrip("/")
    limits = values.get("limits")
    limits = limits if isinstance(limits, dict) else {}
    for name in ("rate", "margin", "stale_after", "lost_after", "max_future"):
        value = limits.get(name) if name == "max_future" else values.get(name)
        if isinstance(value, (int, float)) and not isinstance(value, bool) and value > 0:
            setattr(settings, name, float(value))
    max_pairs = limits.get("max_pairs")
    if isinstance(max_pairs, int) and max_pairs > 0:
        settings.max_pairs = max_pairs
    settings.use_visual = [text for text in _list(values, "use_visual") if isinstance(text, str)]
    settings.mesh_roots = [text for text in _list(values, "mesh_roots") if isinstance(text, str)]
    maps = values.get("map")
    settings.map_folder = _text(maps if isinstance(maps, dict) else {}, "folder", "")
    robots = [_robot(entry) for entry in _list(values, "robots") if isinstance(entry, dict)]
    settings.robots = robots or [RobotSettings()]
    settings.inputs = [_map(entry, node) for entry in _list(values, "maps") if isinstance(entry, dict)]
    settings.inputs += [_cloud(entry, node) for entry in _list(values, "clouds") if isinstance(entry, dict)]
    settings.inputs += [_tracker(entry, node) for entry in _list(values, "tracks") if isinstance(entry, dict)]
    return settings


def absolute(name: str, node: str) -> str:
    """Returns the absolute name of a topic. A relative name is in the namespace of the node."""
    return name if name.startswith("/") else node.rpartition("/")[0] + "/" + name


def _robot(entry: Dict[str, Any]) -> RobotSettings:
    return RobotSettings(
        _text(entry, "name", "robot"),
        _text(entry, "description", "robot_description"),
        _text(entry, "semantic", ""),
        _text(entry, "tf_prefix", ""),
    )


def _map(entry: Dict[str, Any], node: str) -> InputSettings:
    source, file = "map/" + _text(entry, "name", ""), _text(entry, "file", "")
    topic = "" if file else absolute(_text(entry, "topic", "octomap_binary"), node)
    return InputSettings(source, topic, file, "octomap_msgs/Octomap", "maps")


def _cloud(entry: Dict[str, Any], node: str) -> InputSettings:
    topic = absolute(_text(entry, "topic", "cloud"), node)
    return InputSettings("cloud/" + _text(entry, "name", ""), topic, "", "sensor_msgs/PointCloud2", "clouds")


def _tracker(entry: Dict[str, Any], node: str) -> InputSettings:
    poses = _text(entry, "type", "markers") == "poses"
    kind = "geometry_msgs/PoseArray" if poses else "visualization_msgs/MarkerArray"
    topic = absolute(_text(entry, "topic", ""), node)
    return InputSettings("track/" + _text(entry, "name", ""), topic, "", kind, "tracks")


def _text(values: Dict[str, Any], name: str, default: str) -> str:
    value = values.get(name)
    return value if isinstance(value, str) and value else default


def _list(values: Dict[str, Any], name: str) -> List[Any]:
    value = values.get(name)
    return value if isinstance(value, list) else []
