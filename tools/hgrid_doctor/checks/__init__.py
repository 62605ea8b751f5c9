# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Pure functions that turn facts into findings. They run in an order in which causes come before consequences."""
from __future__ import annotations

from typing import List

from hgrid_doctor.checks import (
    clock,
    contests,
    descriptions,
    frames,
    inputs,
    joint_states,
    network,
    node,
    pairs,
    semantics,
    stamps,
    status,
)
from hgrid_doctor.facts import Facts
from hgrid_doctor.finding import Finding, Findings

CHECKS = (
    node.check,
    clock.check,
    descriptions.check,
    stamps.check,
    contests.check,
    frames.check,
    joint_states.check,
    semantics.check,
    inputs.check,
    status.check,
    pairs.check,
)


def diagnose(facts: Facts) -> List[Finding]:
    """Returns the findings, the worst first."""
    findings = Findings()
    network.check(facts, findings)
    if facts.graph.error:
        return findings.ordered()  # without a master or the network, nothing else is known
    for check in CHECKS:
        check(facts, findings)
    return findings.ordered()
