# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Reports problems that the node itself states in ~status and that no earlier finding explains."""
from __future__ import annotations

import re
from typing import Dict

from hgrid_doctor.facts import STALE, STATES, Facts
from hgrid_doctor.finding import ERROR, EVERYTHING, WARN, Findings, counted
from hgrid_doctor.fixes import COMPARE_CLOCKS, log_command, publish_frame, reload_command, with_params
from hgrid_doctor.frames import joint_state_topics

LATE_SHARE = 0.1  # fraction of the ticks that may be late
MOST_DROPPED = 1.5  # joint states per transform from which on a robot_state_publisher counts as too slow

POSES_FRAME = "~poses/"  # beginning of the frames of obstacles that messages on ~poses move
FRAME = re.compile(r"frame '([^']+)'")  # in a reason: the frame that has no pose, or whose pose is old
MOST_PAIRS = 10_000_000  # largest value of ~limits/max_pairs

HINTS = {  # fix by the first word of the reason
    "STALE": "See why its publisher is slow or has stopped: `rostopic hz {topic}`, `rosnode list`.",
    "LOST": "See why its publisher stopped: `rostopic hz {topic}`, `rosnode list`.",
    "FROZEN": "Let the clock run on, or wait for the first data after the jump of the clock.",
    "INVALID": "See what the publisher of its frame sends: `rostopic echo /tf`.",
    "REQUIRED": "Add what ~required names, or do not require it.",
    "REFUSED": "Correct the newest description, map or message. The node reads a description again by itself; send a map or a message again.",
}
UNSENT_HINT = "Send its pose to {topic}. See what arrives there: `rostopic echo {topic}`."  # UNPLACED, moved by ~poses
UNKNOWN_HINT = "Publish the frames of its bodies: `rostopic echo -n 1 {node}/status/bodies` names them."  # UNPLACED
OTHER_HINT = "Correct the cause; the status of the node says more: `rostopic echo -n 1 {node}/status`."


def check(facts: Facts, findings: Findings):
    if facts.status is None:
        return
    check_sources(facts, findings)
    check_contests(facts, findings)
    check_clocks(facts, findings)
    check_pairs(facts, findings)
    check_models(facts, findings)
    check_counters(facts, findings)
    check_ticks(facts, findings)


def check_sources(facts: Facts, findings: Findings):
    robot_explained = any(findings.explain(robot.settings.name, ERROR) for robot in facts.robots)
    for source in facts.status.sources:
        if not source.complete:
            # Without a reason of its own, the source waits for the world, which may wait for a robot.
            if findings.explain(source.name, ERROR) or (robot_explained and not source.reason):
                continue
            reason = source.reason or "; ".join(facts.status.not_ready) or "it says no reason"
            fix = fix_of(facts, source.name, reason)
            findings.add("source_incomplete", ERROR, f"{source.name} is not complete: {reason}.", fix, [source.name])
        elif source.state == STALE and not findings.explain(source.name):
            findings.add(
                "source_stale",
                WARN,
                f"Poses of {source.name} are {STATES[source.state]}: the oldest is {source.age:.2f} s old"
                f"{slow_state_publisher(facts)}.",
                "See which publisher is slow: `rosrun hgrid_proximity doctor -v`; a slow one may need a larger "
                "~stale_after.",
            )


def slow_state_publisher(facts: Facts) -> str:
    """Returns a possible cause of old poses, as the end of a sentence; empty: there is none.

    robot_state_publisher drops joint states that arrive less than 1 / ~publish_frequency after the last ones that it
    sent on. So of 60 messages a second it sends every second one if ~publish_frequency is 50 Hz."""
    for publisher in sorted({stream.publisher for stream in facts.streams if not stream.static}):
        sent = max(stream.count for stream in facts.streams if stream.publisher == publisher and not stream.static)
        for topic in sorted(joint_state_topics(facts, publisher)):
            received = facts.topic(topic).total()
            if received > MOST_DROPPED * sent:
                return (
                    f"; {publisher} sends only {sent / facts.listened:.0f} transforms a second of the "
                    f"{received / facts.listened:.0f} on {topic}: raise its ~publish_frequency (50 Hz by default)"
                )
    return ""


def fix_of(facts: Facts, source: str, reason: str) -> str:
    """Returns the fix for a source that is not complete. @param reason  begins with a code"""
    code = reason.split(" ", 1)[0].rstrip(":")
    named = FRAME.search(reason)
    frame = named.group(1) if named else ""
    is_sent = frame.startswith(POSES_FRAME)
    robot = next((each for each in facts.robots if each.settings.name == source), None)
    hint = HINTS.get(code, OTHER_HINT)
    if code == "UNCOVERED":
        waivers = facts.settings.values.get("accept_uncovered")
        waivers = [*(waivers if isinstance(waivers, list) else []), {"pattern": body_of(reason), "reason": "REASON"}]
        return f"Correct the shape. If it need not be known, {with_params(facts, {'accept_uncovered': waivers})}."
    if code == "PARSE" and robot is not None:
        return f"Correct the description, then {reload_command(facts, robot)}."
    if code == "UNPLACED":
        if frame and not is_sent and facts.world_frame():
            publish = publish_frame(facts.world_frame(), frame)
            return f"Start what publishes the frame. If it stands still: {publish} (with the true pose)."
        hint = UNSENT_HINT if is_sent else UNKNOWN_HINT
    return hint.format(node=facts.node, topic=f"{facts.node}/poses" if is_sent else "/tf")


def body_of(reason: str) -> str:
    """Returns the name after the code, for example "robot/hand" of "UNCOVERED robot/hand: PARSE: ..."."""
    return reason.partition(" ")[2].partition(": ")[0]


def check_contests(facts: Facts, findings: Findings):
    if facts.status.contested_frames and not findings.has("contested_frame"):
        more = len(facts.status.contested_frames) - 1
        findings.add(
            "contested_frame",
            ERROR,
            facts.status.contested_frames[0] + (f" (and {more} more)." if more else "."),
            "Stop one of them: `rosnode kill NAME`, or give its frames other names.",
        )


def check_clocks(facts: Facts, findings: Findings):
    """Names the publishers of /tf whose stamps are constantly early or late."""
    offsets = facts.status.clock_offsets
    if not offsets or findings.has("stamps_early", "stamps_late", "stamps_zero", "stamps_of_other_clock"):
        return
    texts = [
        f"{each.publisher} {abs(each.offset):.2f} s {'ahead of' if each.offset > 0 else 'behind'} the clock"
        for each in offsets
    ]
    findings.add(
        "clock_offset",
        WARN,
        f"All stamps of a publisher of /tf are early or late: {', '.join(texts[:3])}"
        + (f", and {counted(len(texts) - 3, 'publisher')} more." if len(texts) > 3 else "."),
        f"Set the clocks of the computers by one server: {COMPARE_CLOCKS}. A localization node may stamp ahead on "
        "purpose; a slow source may need a larger ~late_after.",
    )


def check_pairs(facts: Facts, findings: Findings):
    world = facts.status.world
    if not world.complete and world.incomplete_total == 0 and world.sequence > 0:
        most = min(MOST_PAIRS, 10 * facts.settings.max_pairs)
        findings.add(
            "pairs_truncated",
            ERROR,
            f"~pairs does not list all pairs: {'; '.join(world.reasons) or 'truncated'}.",
            f"Lower ~margin, or {with_params(facts, {'limits': {'max_pairs': most}})}.",
        )
    own = facts.status.self_pairs[0] if len(facts.status.self_pairs) == 1 else None
    if len(facts.status.sources) == 1 and own and own.pairs and own.pairs == own.rigid + own.adjacent + own.srdf:
        findings.add(
            "all_pairs_off",
            WARN,
            f"No pair can ever be reported: the robot is alone, and of its {own.pairs} own pairs {own.rigid} are "
            "rigid,"
            f" {own.adjacent} adjacent and {own.srdf} off by the SRDF.",
            "Add obstacles, maps or clouds to the parameters.",
        )


def check_models(facts: Facts, findings: Findings):
    warnings = list(facts.status.model_warnings)
    if findings.has("srdf_of_other_robot", "srdf_unknown_links"):
        warnings = [text for text in warnings if "names link" not in text]
    if findings.has("no_srdf", "bad_srdf"):  # while an SRDF cannot be read, the warnings of the old model stay
        warnings = [text for text in warnings if "SRDF" not in text]
    warnings = [text for text in warnings if not text.startswith("... and")]  # the end of a list that is cut
    if warnings:
        more = f" (and {counted(len(warnings) - 1, 'warning')} more)" if len(warnings) > 1 else ""
        findings.add(
            "model_warnings",
            WARN,
            f"The node accepted descriptions or parameters that are unusual: {warnings[0]}{more}.",
            f"See all warnings: `rostopic echo -n 1 {facts.node}/status/model_warnings`.",
        )


def growth(facts: Facts) -> Dict[str, int]:
    """Returns by how much each counter grew while the doctor listened."""
    before = {counter.name: counter.value for counter in facts.first_status.counters}
    now = {counter.name: counter.value for counter in facts.status.counters}
    return {name: value - before.get(name, 0) for name, value in now.items() if value > before.get(name, 0)}


def check_counters(facts: Facts, findings: Findings):
    grown = growth(facts)
    failed = {name: by for name, by in grown.items() if ".failed" in name}
    if failed:
        findings.add(
            "work_fails",
            ERROR,
            f"Work of the node fails: {amounts(failed)} in {facts.listened:.1f} s.",
            f"Read what it says, and report it as a fault of this package: {log_command(facts)}.",
        )
    refused = {name: by for name, by in grown.items() if ".refused." in name or name == "tf.dropped.LIMIT"}
    refused = {name: by for name, by in refused.items() if not is_explained(name, findings)}
    if refused:
        findings.add(
            "input_refused",
            WARN,
            f"The node refuses messages or transforms: {amounts(refused)} in {facts.listened:.1f} s.",
            "It says each cause once a second: `rostopic echo /rosout/msg`.",
        )


def amounts(counters: Dict[str, int]) -> str:
    return ", ".join(f"{name} {by} times" for name, by in sorted(counters.items()))


def is_explained(counter: str, findings: Findings) -> bool:
    """Returns whether an earlier finding explains why the counter grows."""
    if counter.startswith("tf.refused.CLOCK"):
        stamps = findings.has("stamps_early", "stamps_zero", "stamps_of_other_clock")
        return stamps or findings.explain(EVERYTHING)
    if counter.startswith(("cloud/", "track/")):
        return findings.explain(counter.partition(".")[0])
    if counter.startswith("maps."):
        return findings.has("no_map_file", "wrong_input_frame", "source_incomplete")
    return False


def check_ticks(facts: Facts, findings: Findings):
    first, last = facts.first_status, facts.status
    ticks = last.world.sequence - first.world.sequence
    late = growth(facts).get("tick.late", 0)
    period = 1.0 / facts.settings.rate
    timing = next((each for each in last.timings if each.name == "tick"), None)
    if ticks <= 0:
        return
    lower = f"lower ~rate: {with_params(facts, {'rate': facts.settings.rate / 2})}"
    if late > max(1.0, LATE_SHARE * ticks):
        findings.add(
            "ticks_late",
            WARN,
            f"{late} of {ticks} ticks were late: this computer is too busy, or ~rate ({facts.settings.rate:g} Hz) is "
            "too high.",
            f"See what uses the processors (`top`), or {lower}. With many thousands of shapes, set ~threads to more "
            "than 1.",
        )
    elif timing is not None and timing.median > period:
        findings.add(
            "ticks_slow",
            WARN,
            f"A tick takes {timing.median * 1e3:.1f} ms, longer than its period of {period * 1e3:.1f} ms.",
            f"See where the time goes: `rostopic echo -n 1 {facts.node}/status/timings`, or {lower}.",
        )
