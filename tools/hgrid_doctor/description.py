# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""The data of robot descriptions that the checks need: links, joints, shapes, and why a text is not a description."""
from __future__ import annotations

import re
import xml.etree.ElementTree as xml
from dataclasses import dataclass, field
from typing import Dict, List, Set, Tuple


@dataclass
class Link:
    """A link and how many shapes it has."""

    name: str
    collisions: int = 0
    visuals: int = 0
    collision_meshes: List[str] = field(default_factory=list)  # URIs
    visual_meshes: List[str] = field(default_factory=list)


@dataclass
class Joint:
    name: str
    type: str
    parent: str
    child: str
    mimic: str = ""  # name of the joint that it follows; empty: none
    multiplier: float = 1.0  # of the position of that joint
    offset: float = 0.0  # [rad] or [m]


@dataclass
class Description:
    """A URDF. If `flaw` is not empty, the members below `detail` are empty."""

    name: str = ""
    flaw: str = ""  # one of FLAWS; empty: none
    detail: str = ""  # where the flaw is
    links: Dict[str, Link] = field(default_factory=dict)
    joints: List[Joint] = field(default_factory=list)
    root: str = ""
    joint_above: Dict[str, Joint] = field(default_factory=dict)  # joint by its child link

    def group_root(self, link: str) -> str:
        """Returns the topmost link that only fixed joints connect with `link`. Its frame places `link`."""
        above, seen = self.joint_above, set()
        while link in above and above[link].type == "fixed" and link not in seen:
            seen.add(link)
            link = above[link].parent
        return link

    def moving_joints_above(self, link: str) -> Set[str]:
        above, names, seen = self.joint_above, set(), set()
        while link in above and link not in seen:
            seen.add(link)
            if above[link].type != "fixed":
                names.add(above[link].name)
            link = above[link].parent
        return names

    def known_to_state_publisher(self, received: Set[str]) -> Set[str]:
        """Returns the joints whose positions robot_state_publisher knows. It goes once through the joints that follow
        others, in the order of their names."""
        known = set(received)
        for joint in sorted(self.joints, key=lambda each: each.name):
            if joint.mimic in known:
                known.add(joint.name)
        return known

    def end_of_mimicry(self, joint: Joint) -> Tuple[str, float, float]:
        """Returns the joint that moves by itself at the end of a chain of joints that follow each other, and the
        multiplier and offset by which `joint` follows it."""
        by_name = {each.name: each for each in self.joints}
        leader, multiplier, offset = joint.mimic, joint.multiplier, joint.offset
        for _ in self.joints:
            if leader not in by_name or not by_name[leader].mimic:
                break
            followed = by_name[leader]
            leader, offset = followed.mimic, offset + multiplier * followed.offset
            multiplier *= followed.multiplier
        return leader, multiplier, offset


@dataclass
class Semantic:
    """An SRDF. If `flaw` is not empty, the members below `detail` are empty."""

    name: str = ""
    flaw: str = ""
    detail: str = ""
    links: Set[str] = field(default_factory=set)  # links that its rules name
    rules: int = 0


FLAWS = ("not_text", "xacro", "not_xml", "not_robot")


def parse_urdf(text: object) -> Description:
    root, flaw, detail = _parse(text)
    if flaw:
        return Description(flaw=flaw, detail=detail)
    result = Description(name=root.get("name", ""))
    for element in root.findall("link"):
        link = Link(element.get("name", ""))
        link.collisions, link.visuals = len(element.findall("collision")), len(element.findall("visual"))
        link.collision_meshes = [mesh.get("filename", "") for mesh in element.findall("collision/geometry/mesh")]
        link.visual_meshes = [mesh.get("filename", "") for mesh in element.findall("visual/geometry/mesh")]
        result.links[link.name] = link
    for element in root.findall("joint"):
        parent, child = element.find("parent"), element.find("child")
        if parent is not None and child is not None:
            names = parent.get("link", ""), child.get("link", "")
            result.joints.append(Joint(element.get("name", ""), element.get("type", ""), *names, *_mimic_of(element)))
    result.joint_above = {joint.child: joint for joint in result.joints}
    result.root = next((name for name in result.links if name not in result.joint_above), "")
    return result


def parse_srdf(text: object) -> Semantic:
    root, flaw, detail = _parse(text)
    if flaw:
        return Semantic(flaw=flaw, detail=detail)
    result = Semantic(name=root.get("name", ""))
    for tag in ("disable_collisions", "enable_collisions"):
        for element in root.findall(tag):
            result.rules += 1
            result.links |= {element.get("link1", ""), element.get("link2", "")}
    for element in root.findall("disable_default_collisions"):
        result.rules += 1
        result.links.add(element.get("link", ""))
    return result


def _mimic_of(joint):
    """Returns the joint that this joint follows, the multiplier and the offset. Numbers that are none count as NaN."""

    def number(name, default):
        try:
            return float(mimic.get(name, default))
        except ValueError:
            return float("nan")

    mimic = joint.find("mimic")
    return () if mimic is None else (mimic.get("joint", ""), number("multiplier", 1.0), number("offset", 0.0))


def _parse(text):
    """Returns the root element, the flaw and its details."""
    if not isinstance(text, str) or not text.strip():
        return None, "not_text", "it is empty" if isinstance(text, str) else f"it is of type {type(text).__name__}"
    try:
        root = xml.fromstring(text.strip())
    except (xml.ParseError, ValueError) as error:
        # XML with an undeclared prefix is invalid. But the cause is that the xacro was not expanded.
        return (None, "xacro", "it uses <xacro:...>") if "<xacro:" in text else (None, "not_xml", str(error))
    macro = _macro_in(root)
    if macro:
        return None, "xacro", f"it has {macro}"
    if root.tag != "robot":
        return None, "not_robot", f"its root element is <{root.tag}>"
    return root, "", ""


def _macro_in(root):
    """Returns an element or an expression of xacro that was not expanded; empty if there is none."""
    for element in root.iter():
        if isinstance(element.tag, str) and re.match(r"\{[^}]*xacro[^}]*\}", element.tag):
            return f"<xacro:{element.tag.rpartition('}')[2]}>"
        for name, value in element.attrib.items():
            if re.search(r"\$[({]", value):
                return f'{name}="{value}"'
    return ""
