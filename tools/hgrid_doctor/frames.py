# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""The tree of frames that was received on /tf and /tf_static."""
from __future__ import annotations

from statistics import median
from typing import Dict, Iterable, List, Set

from hgrid_doctor.facts import Facts, RobotFacts, TfStream


class Tree:
    """A tree of frames, with the streams that place each frame."""

    def __init__(self, streams: Iterable[TfStream]):
        self.of_child: Dict[str, List[TfStream]] = {}
        self._frames: Set[str] = set()
        for stream in streams:
            self.of_child.setdefault(stream.child, []).append(stream)
            self._frames |= {stream.parent, stream.child}

    def has(self, frame: str) -> bool:
        return frame in self._frames

    def frames(self) -> Set[str]:
        return self._frames

    def chain(self, frame: str) -> List[str]:
        """Returns the frame, its parent and so on, up to the root."""
        chain = [frame]
        while chain[-1] in self.of_child:
            parent = self.of_child[chain[-1]][0].parent
            if parent in chain:
                break
            chain.append(parent)
        return chain

    def root(self, frame: str) -> str:
        return self.chain(frame)[-1]

    def roots(self) -> List[str]:
        return sorted({self.root(frame) for frame in self._frames})

    def publishers(self, frame: str) -> Set[str]:
        """Returns the publishers of all frames in the chain of the frame."""
        return {stream.publisher for each in self.chain(frame) for stream in self.of_child.get(each, [])}


def shaped_links(robot: RobotFacts, facts: Facts) -> List[str]:
    """Returns the links that are bodies, which means that they have shapes."""
    if robot.description is None:
        return []
    return [
        link.name
        for link in robot.description.links.values()
        if link.collisions or (link.visuals and facts.settings.uses_visual(f"{robot.settings.name}/{link.name}"))
    ]


def frame_of_group(robot: RobotFacts, link: str) -> str:
    """Returns the frame with which the node places a link. Links that only fixed joints connect have the same frame."""
    return robot.settings.frame(robot.description.group_root(link))


def needed_frames(robot: RobotFacts, facts: Facts) -> Dict[str, str]:
    """Returns the frames that place the links of a robot, each with the link of the description that has this frame."""
    return {frame_of_group(robot, link): robot.description.group_root(link) for link in shaped_links(robot, facts)}


def needed_chains(facts: Facts, tree: Tree) -> Set[str]:
    """Returns all frames between the world and the robots. If no robot was read, returns all frames that were
    received."""
    needed = {frame for robot in facts.robots for frame in needed_frames(robot, facts)}
    return {above for frame in needed for above in tree.chain(frame)} if needed else set(tree.frames())


def robots_placed_by(facts: Facts, tree: Tree, frames: Set[str]) -> Set[str]:
    """Returns the names of the robots that need one of the frames."""
    return {
        robot.settings.name
        for robot in facts.robots
        if any(frames & set(tree.chain(frame)) for frame in needed_frames(robot, facts))
    }


def joint_state_topics(facts: Facts, node: str) -> Set[str]:
    """Returns the topics of joint states to which a node subscribes."""
    types = facts.graph.types
    return {topic for topic in facts.graph.topics_of(node)[1] if types.get(topic) == "sensor_msgs/JointState"}


def middle(values: List[float]) -> float:
    return median(values) if values else 0.0
