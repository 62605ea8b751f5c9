# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Formats the findings and the values that were looked at, for people or for scripts."""
from __future__ import annotations

import json
from typing import Iterator, List

from hgrid_doctor.facts import STATES, Facts, RobotFacts
from hgrid_doctor.finding import ERROR, WARN, Finding, counted, exit_code, listing
from hgrid_doctor.frames import middle, needed_frames, shaped_links

COLORS = {ERROR: "31", WARN: "33", "OK": "32"}


def as_text(facts: Facts, findings: List[Finding], verbose: bool, color: bool) -> str:
    lines = []
    for finding in findings:
        word = painted(finding.severity, color) + " " * (5 - len(finding.severity))
        lines += [f"{word} {printable(finding.what)}", f"      fix: {printable(finding.fix)}", ""]
    if verbose or not any(finding.severity == ERROR for finding in findings):
        lines += ["Looked at:", *(f"  {printable(line)}" for line in looked_at(facts)), ""]
    return "\n".join([*lines, summary(facts, findings, color)])


def as_json(facts: Facts, findings: List[Finding]) -> str:
    value = {
        "node": facts.node,
        "exit_code": exit_code(findings),
        "findings": [
            {
                "name": each.name,
                "severity": each.severity,
                "what": each.what,
                "fix": each.fix,
                "explains": sorted(each.explains),
            }
            for each in findings
        ],
        "looked_at": list(looked_at(facts)),
    }
    return json.dumps(value, indent=2)


def printable(text: str) -> str:
    """Replaces characters that could control the terminal. Names come from outside."""
    return "".join(character if character.isprintable() else "?" for character in text)


def painted(word: str, color: bool) -> str:
    return f"\033[1;{COLORS[word]}m{word}\033[0m" if color else word


def summary(facts: Facts, findings: List[Finding], color: bool) -> str:
    errors = sum(finding.severity == ERROR for finding in findings)
    warnings = len(findings) - errors
    if not findings:
        return f"{painted('OK', color)}: nothing wrong was found with {facts.node}."
    worst = painted(ERROR if errors else WARN, color)
    counts = [counted(number, noun) for number, noun in ((errors, "error"), (warnings, "warning")) if number]
    return f"{worst}: {' and '.join(counts)} found for {facts.node}."


def looked_at(facts: Facts) -> Iterator[str]:
    """Yields about ten lines with the values that were found."""
    graph = facts.graph
    if graph.error:
        yield f"master: {facts.environment.master_uri} does not answer"
        return
    nodes = counted(len(graph.nodes()), "node")
    yield f"master: {facts.environment.master_uri}, {nodes}; listened for {facts.listened:.1f} s"
    yield node_line(facts)
    yield clock_line(facts)
    yield from tf_lines(facts)
    for robot in facts.robots:
        yield robot_line(facts, robot)
        if robot.semantic is not None and not robot.semantic.flaw:
            rules = counted(robot.semantic.rules, "rule")
            yield f"SRDF of {robot.settings.name}: {rules}, {counted(len(robot.semantic.links), 'link')} named"
    robots = {robot.settings.name for robot in facts.robots}
    for source in facts.status.sources if facts.status is not None else []:
        if source.name not in robots:
            yield source_line(facts, source)
    if facts.status is not None and facts.status.absent_robots:
        yield f"declared absent with ~apply_robots: {listing(facts.status.absent_robots)}"
    if facts.status is not None:
        yield pairs_line(facts)
        yield refusals_line(facts)


def node_line(facts: Facts) -> str:
    known = facts.nodes.get(facts.host)
    if known is None:
        return f"node: {facts.node} is not running"
    if known.error or facts.status is None:
        answers = "does not answer" if known.error else "answers"
        return f"node: {facts.host} {answers}, {facts.node}/status is silent"
    complete = "complete" if facts.status.world.complete else "not complete"
    return f"node: {facts.node}, version {facts.status.node_version}, process {known.pid}: the world is {complete}"


def clock_line(facts: Facts) -> str:
    if not facts.graph.use_sim_time:
        return "clock: the wall clock (/use_sim_time is not set)"
    now = f"{facts.clock[-1]:.2f} s" if facts.clock else "unknown"
    return f"clock: /clock of {listing(facts.alive_publishers('/clock')) or 'nobody'}, now {now}"


def tf_lines(facts: Facts) -> Iterator[str]:
    moving = {}
    for stream in facts.streams:
        if not stream.static:
            moving.setdefault(stream.publisher, []).append(stream)
    for publisher, streams in sorted(moving.items())[:3]:
        rate = max(stream.count for stream in streams) / max(facts.listened, 0.001)
        age = -1e3 * middle([offset for stream in streams for offset in stream.offsets])
        frames = counted(len(streams), "frame")
        yield f"/tf: {frames} from {publisher}, {rate:.0f} Hz, {round(age)} ms old when they arrive"
    if len(moving) > 3:
        yield f"/tf: {len(moving) - 3} more publishers"
    static = [stream for stream in facts.streams if stream.static]
    publishers = counted(len({stream.publisher for stream in static}), "publisher")
    yield f"/tf_static: {counted(len(static), 'frame')} from {publishers}"


def robot_line(facts: Facts, robot: RobotFacts) -> str:
    name, source = robot.settings.name, facts.source(robot.settings.name)
    if robot.description is None or robot.description.flaw:
        text = "description not found" if robot.description is None else "description not readable"
    else:
        links, bodies = counted(len(robot.description.links), "link"), len(shaped_links(robot, facts))
        text = f"{links}, {bodies} with shapes, in {counted(len(needed_frames(robot, facts)), 'frame')}"
    return f"robot {name}: {text}{state_text(source)}"


def source_line(facts: Facts, source) -> str:
    bodies = counted(source.bodies, "body").replace("bodys", "bodies")
    return f"{source.name}: {bodies}{state_text(source)}"


def state_text(source) -> str:
    if source is None:
        return ""
    if not source.complete:
        return "; not complete"
    placed = "all placed" if source.state != len(STATES) - 1 else STATES[source.state]
    return f"; {placed}, {STATES[source.state]}" + (f", poses {source.age * 1e3:.0f} ms old" if source.age > 0 else "")


def refusals_line(facts: Facts) -> str:
    """Returns counts since the node started or was reset. The checks judge only counters that grow now."""
    refused = [f"{each.name} {each.value}" for each in facts.status.counters if ".refused." in each.name]
    return f"refused so far: {', '.join(refused) or 'nothing'}"


def pairs_line(facts: Facts) -> str:
    timing = next((each for each in facts.status.timings if each.name == "tick"), None)
    took = f", a tick takes {timing.median * 1e3:.2f} of {1e3 / facts.settings.rate:.0f} ms" if timing else ""
    return f"pairs: {facts.status.pair_count} near now, margin {facts.settings.margin:g} m{took}"
