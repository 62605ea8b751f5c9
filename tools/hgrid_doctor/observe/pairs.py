# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Asks the node which rules of ~set_allowed are in force, and which links of one robot touch each other."""
from __future__ import annotations

import time
from typing import Any, List

from hgrid_doctor.facts import Facts, Touch
from hgrid_doctor.observe.bounded import call
from hgrid_doctor.observe.connection import Connection, ServiceConnection
from hgrid_doctor.observe.graph import Api

MOST_RULES = 100
MOST_ASKED = 100  # pairs whose distance the node is asked for


def read_pairs(facts: Facts, master: Api, timeout: float):
    """A node that does not answer, or has other messages, has other findings. Then nothing is added here."""
    if facts.status is None:
        return
    facts.rules, facts.pairs_off = call(lambda: _rules(facts, master, timeout), timeout).value or ([], 0)
    facts.touching = call(lambda: _touching(facts, master, timeout), timeout).value or []


def _rules(facts: Facts, master: Api, timeout: float):
    """Returns the rules of ~set_allowed, and how many pairs they switch off."""
    from hgrid_proximity.msg import RuleOrigin
    from hgrid_proximity.srv import GetAllowed, GetAllowedRequest

    service = _service(facts, master, "get_allowed", GetAllowed, timeout)
    try:
        rules = service.call(GetAllowedRequest(rules=True)).entries
        rules = [rule for rule in rules if rule.origin == RuleOrigin.SERVICE][:MOST_RULES]
        pairs = service.call(GetAllowedRequest()).entries if rules else []
        return rules, sum(pair.origin == RuleOrigin.SERVICE and pair.allowed for pair in pairs)
    finally:
        service.close()


def _touching(facts: Facts, master: Api, timeout: float) -> List[Touch]:
    """Returns the pairs of links of one robot that touch."""
    from hgrid_proximity.msg import Pairs
    from hgrid_proximity.srv import ExplainPair, ExplainPairRequest

    pairs = Pairs()
    connection = Connection(f"{facts.node}/pairs", facts.nodes[facts.host].uri, time.monotonic() + timeout, timeout)
    try:
        pairs.deserialize(next(connection.messages()))
    finally:
        connection.close()
    robots = {robot.settings.name for robot in facts.robots}
    near = []
    for first, second, gap, since in zip(pairs.first, pairs.second, pairs.gap, pairs.since):
        touch = Touch(pairs.names[first], pairs.names[second], since.to_sec())
        if gap == 0.0 and touch.robot in robots and touch.second.startswith(touch.robot + "/"):
            near.append(touch)
    if not near:
        return []
    service = _service(facts, master, "explain_pair", ExplainPair, timeout)
    try:
        return [
            touch
            for touch in near[:MOST_ASKED]
            if service.call(ExplainPairRequest(first=touch.first, second=touch.second)).distance == 0.0
        ]
    finally:
        service.close()


def _service(facts: Facts, master: Api, name: str, kind: Any, timeout: float) -> ServiceConnection:
    full_name = f"{facts.node}/{name}"
    return ServiceConnection(full_name, kind, master("lookupService", full_name), timeout)
