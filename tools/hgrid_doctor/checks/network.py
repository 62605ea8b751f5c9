# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Checks the master, and whether this shell and the nodes can reach each other."""
from __future__ import annotations

from hgrid_doctor.facts import Facts
from hgrid_doctor.finding import ERROR, WARN, Findings, listing
from hgrid_doctor.fixes import master_command

OWN_ADDRESS = "`unset ROS_HOSTNAME; export ROS_IP={}`"  # roslaunch and nodes prefer ROS_HOSTNAME to ROS_IP


def check(facts: Facts, findings: Findings):
    check_master(facts, findings)
    check_own_name(facts, findings)
    check_hosts(facts, findings)


def check_master(facts: Facts, findings: Findings):
    if not facts.graph.error:
        return
    uri = facts.environment.master_uri
    origin = "ROS_MASTER_URI" if facts.environment.master_uri_is_set else "the default; ROS_MASTER_URI is not set"
    findings.add(
        "no_master",
        ERROR,
        f"The ROS master at {uri} ({origin}) cannot be reached: {facts.graph.error}.",
        f"Start it: {master_command(uri)}; if it hangs, end it before (`pgrep -af rosmaster` shows its process). Or "
        "name the right one: `export ROS_MASTER_URI=http://HOST:11311`.",
    )


def check_own_name(facts: Facts, findings: Findings):
    """Checks the address that nodes of this shell announce. Other computers must be able to reach it."""
    environment = facts.environment
    if not environment.own_name_error:
        return
    origin = (
        "ROS_HOSTNAME" if environment.ros_hostname else "ROS_IP" if environment.ros_ip else "this computer's host name"
    )
    findings.add(
        "bad_own_address",
        WARN,
        f"{origin} is '{environment.own_name}': {environment.own_name_error}. Other computers cannot "
        "reach nodes that start here by this name.",
        "Announce an address of this computer that the others can reach, in each shell before nodes start: "
        + OWN_ADDRESS.format(environment.address_towards_master or "ADDRESS")
        + ".",
    )


def check_hosts(facts: Facts, findings: Findings):
    """Finds nodes whose host name this computer cannot resolve. Nothing from their topics arrives here."""
    unknown = {}
    for node in facts.nodes.values():
        if node.host_error:
            unknown.setdefault(node.host, []).append(node.name)
    for host, nodes in sorted(unknown.items()):
        findings.add(
            "unknown_host",
            ERROR,
            f"The host '{host}' of {listing(sorted(nodes))} cannot be resolved here, so nothing of it arrives.",
            f"Announce an address of that computer that this one can reach, and start its nodes again: there "
            f"{OWN_ADDRESS.format('ADDRESS')}. Or name its address here: "
            f"`echo ADDRESS {host} | sudo tee -a /etc/hosts`.",
        )
