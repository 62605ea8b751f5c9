# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Checks the proximity node itself: whether it runs, answers and publishes ~status."""
from __future__ import annotations

from hgrid_doctor.facts import Facts
from hgrid_doctor.finding import ERROR, Findings, listing

RUN_IN_TERMINAL = "`rosrun hgrid_proximity proximity_node __name:={name}`"


def start_command(node: str) -> str:
    namespace, _, name = node.rpartition("/")
    command = RUN_IN_TERMINAL.format(name=name)
    return command if not namespace else command[:-1] + f" __ns:={namespace}`"


def check(facts: Facts, findings: Findings):
    node, host = facts.node, facts.host
    start = start_command(node)
    if not host:
        running = f" There is {listing(facts.others)}; ask it with --node." if facts.others else ""
        findings.add(
            "node_not_running",
            ERROR,
            f"The node {node} is not running: the master has never heard of it.{running}",
            f"Start it and read what it says, for example {start}; wrong parameters end it with a list of them.",
        )
        return
    known = facts.nodes.get(host)
    if known and known.host_error:
        return  # check_hosts has added a finding
    if known and known.error:
        findings.add(
            "node_gone",
            ERROR,
            f"The node {host} is registered, but does not answer at {known.uri or 'any address'} ({known.error}): it "
            "died or hangs.",
            f"Start it again, for example {start}; `rosnode cleanup` removes the registrations of dead nodes.",
        )
        return
    if known and facts.pid_after is not None and known.pid is not None and facts.pid_after != known.pid:
        findings.add(
            "node_restarts",
            ERROR,
            f"{host} was process {known.pid} and is now process {facts.pid_after}: it starts again and again, or two "
            "nodes"
            " fight for the name.",
            "Read the node's log (`roscd log`); look for a second one on all computers: `pgrep -af proximity_node`.",
        )
    check_status(facts, findings)


def check_status(facts: Facts, findings: Findings):
    node, topic = facts.node, facts.node + "/status"
    if facts.status is not None:
        return
    if facts.host not in facts.graph.publishers.get(topic, []):
        findings.add(
            "not_a_proximity_node",
            ERROR,
            f"The node {node} runs, but publishes no {topic}: it is another program, or it has not started completely.",
            f"Look at `rosnode info {node}`"
            + (f"; or ask {listing(facts.others)} with --node." if facts.others else "."),
        )
    elif "md5sum" in facts.status_error or "no messages of" in facts.status_error:
        findings.add(
            "other_version",
            ERROR,
            f"{topic} cannot be read: {facts.status_error}. The node and this shell use different versions.",
            "Source the workspace that the node was started from, or build both anew and start the node again.",
        )
    else:
        why = f" ({facts.status_error})" if facts.status_error else ""
        findings.add(
            "status_silent",
            ERROR,
            f"{topic} was silent for {facts.listened:.1f} s{why}, though {facts.host} answers: its ticks hang or fail.",
            f"Read the node's log (`roscd log`), then start it again: `rosnode kill {facts.host}` and "
            f"{start_command(node)}.",
        )
