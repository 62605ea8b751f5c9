# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Checks for frames that several publishers place."""
from __future__ import annotations

from math import acos, dist
from typing import List

from hgrid_doctor.facts import Facts, TfStream
from hgrid_doctor.finding import ERROR, WARN, Findings, counted, listing
from hgrid_doctor.frames import Tree, joint_state_topics, needed_chains, robots_placed_by

SAME_TIME = 0.02  # [s] two poses are compared if their stamps differ by at most this time
SAME_DISTANCE, SAME_ANGLE = 0.01, 0.01  # [m], [rad] the limits that the node uses


def check(facts: Facts, findings: Findings):
    tree = Tree(facts.streams)
    chains = needed_chains(facts, tree)
    groups = {}  # frames by (publishers, whether the publishers contradict each other)
    for child, streams in sorted(tree.of_child.items()):
        if len(streams) < 2:
            continue
        contradicted = contradict(streams) or said_by_node(facts, child)
        publishers = tuple(sorted({stream.publisher for stream in streams}))
        groups.setdefault((publishers, contradicted), []).append(child)
    for (publishers, contradicted), frames in groups.items():
        streams = tree.of_child[frames[0]]
        if contradicted:
            severity = ERROR if chains & set(frames) else WARN
            what = contradiction(streams, publishers, frames)
            robots = robots_placed_by(facts, tree, set(frames))
            findings.add("contested_frame", severity, what, remedy(facts, publishers), robots)
        else:
            frames_text = f"{counted(len(frames), 'frame')} ({listing(frames)})"
            what = f"{frames_text} come from {who(streams)}; their poses agree now."
            findings.add("doubled_frame", WARN, what, remedy(facts, publishers))


def who(streams: List[TfStream]) -> str:
    return " and ".join(f"{stream.publisher} (parent '{stream.parent}')" for stream in streams[:2])


def contradiction(streams: List[TfStream], publishers, frames) -> str:
    if len(publishers) == 1 and len({stream.static for stream in streams}) == 2:
        where = "on /tf and on /tf_static"
    else:
        where = "at different poses" if len({stream.parent for stream in streams}) == 1 else "with different parents"
    noun = f"Frame {listing(frames)} comes" if len(frames) == 1 else f"{len(frames)} frames ({listing(frames)}) come"
    return f"{noun} from {who(streams)} {where}: only one publisher may place a frame."


def remedy(facts: Facts, publishers) -> str:
    if len(publishers) == 1:
        return f"Let {publishers[0]} send each frame on one topic with one parent."
    extra = min(reversed(publishers), key=lambda publisher: weight(facts, publisher))
    return f"Stop one of them, for example `rosnode kill {extra}`, or give its frames other names."


def weight(facts: Facts, publisher: str):
    """Returns a value that is larger for publishers that are more likely to be right: robot_state_publishers, then
    those with more frames."""
    frames = sum(stream.publisher == publisher for stream in facts.streams)
    return bool(joint_state_topics(facts, publisher)), frames


def said_by_node(facts: Facts, child: str) -> bool:
    return facts.status is not None and any(f"frame '{child}'" in text for text in facts.status.contested_frames)


def contradict(streams: List[TfStream]) -> bool:
    """Returns whether the streams have different parents, or different poses at about the same time."""
    if len({stream.parent for stream in streams}) > 1:
        return True
    return any(differ(a, b) for i, a in enumerate(streams) for b in streams[i + 1 :])


def differ(a: TfStream, b: TfStream) -> bool:
    static = a.static or b.static  # the stamp of a static transform means nothing
    for stamp, pose in a.poses:
        nearest = min(b.poses, key=lambda other: abs(other[0] - stamp), default=None)
        if nearest and (static or abs(nearest[0] - stamp) <= SAME_TIME) and not same(pose, nearest[1]):
            return True
    return False


def same(a, b) -> bool:
    angle = 2.0 * acos(min(1.0, abs(sum(x * y for x, y in zip(a[3:], b[3:])))))
    return dist(a[:3], b[:3]) <= SAME_DISTANCE and angle <= SAME_ANGLE
