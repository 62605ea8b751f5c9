# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Checks the proximity node itself: whether it runs, answers and publishes ~status."""
from __future__ import annotations

from hgrid_doctor.facts import Facts
from hgrid_doctor.finding import ERROR, Findings, listing
from hgrid_doctor.fixes import log_command, restart, start_command


def check(facts: Facts, findings: Findings):
    node, host = facts.node, facts.host
    start = start_command(node)
    if not host:
        running = f" There is {listing(facts.others)}: {ask_other(facts)}." if facts.others else ""
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
            "If it hangs, end it (`pgrep -af proximity_node` shows its process). Then start it again, for example "
            f"{start}.",
        )
        return
    if known and facts.pid_after is not None and known.pid is not None and facts.pid_after != known.pid:
        findings.add(
            "node_restarts",
            ERROR,
            f"{host} was process {known.pid} and is now process {facts.pid_after}: it starts again and again, or two "
            "nodes"
            " fight for the name.",
            f"Read what it says: {log_command(facts)}; look for a second one on all computers: "
            "`pgrep -af proximity_node`.",
        )
    check_status(facts, findings)


def ask_other(facts: Facts) -> str:
    return f"`rosrun hgrid_proximity doctor --node {facts.others[0]}`"


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
            + (f"; or ask the other one: {ask_other(facts)}." if facts.others else "."),
        )
    elif "md5sum" in facts.status_error or "no messages of" in facts.status_error:
        findings.add(
            "other_version",
            ERROR,
            f"{topic} cannot be read: {facts.status_error}. The node and this shell use different versions.",
            "Source the workspace from which the node was started (`source ~/my_ws/devel/setup.bash`), or build both "
            f"anew and start the node again: {restart(facts)}.",
        )
    else:
        why = f" ({facts.status_error})" if facts.status_error else ""
        findings.add(
            "status_silent",
            ERROR,
            f"{topic} was silent for {facts.listened:.1f} s{why}, though {facts.host} answers: its ticks hang or fail.",
            f"Read what it says: {log_command(facts)}; then start it again: {restart(facts)}.",
        )
