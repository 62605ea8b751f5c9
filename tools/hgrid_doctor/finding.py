# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Findings: what is wrong and how to fix it. Also the exit codes, which scripts read."""
from __future__ import annotations

from dataclasses import dataclass
from typing import FrozenSet, Iterable, List

ERROR, WARN = "ERROR", "WARN"
SEVERITIES = (ERROR, WARN)  # the worst first

EXIT_OK, EXIT_ERROR, EXIT_WARN = 0, 1, 2
EXIT_USAGE = 64  # EX_USAGE of sysexits.h; differs from the codes of findings

EVERYTHING = "*"  # a value in `explains`: all sources of the world


@dataclass(frozen=True)
class Finding:
    """One thing that is wrong."""

    name: str  # never changes, because scripts read it; for example "no_joint_states"
    severity: str
    what: str  # one sentence with names and values
    fix: str  # one sentence, with a command where possible
    explains: FrozenSet[str] = frozenset()  # sources that are incomplete because of it: "robot", "map/hall", "*"


class Findings:
    """The findings so far. A later check uses them to find out whether a problem is only a consequence of an earlier
    one."""

    def __init__(self):
        self._all: List[Finding] = []

    def add(self, name: str, severity: str, what: str, fix: str, explains: Iterable[str] = ()):
        self._all.append(Finding(name, severity, what, fix, frozenset(explains)))

    def has(self, *names: str) -> bool:
        return any(finding.name in names for finding in self._all)

    def explain(self, source: str, *severities: str) -> bool:
        """Returns whether an earlier finding explains why a source is incomplete. Considers all severities if none
        is given."""
        explaining = [each for each in self._all if source in each.explains or EVERYTHING in each.explains]
        return any(not severities or each.severity in severities for each in explaining)

    def ordered(self) -> List[Finding]:
        """Returns the findings, the worst first. Findings of one severity keep their order: causes before
        consequences."""
        return sorted(self._all, key=lambda finding: SEVERITIES.index(finding.severity))


def exit_code(findings: Iterable[Finding]) -> int:
    severities = {finding.severity for finding in findings}
    if ERROR in severities:
        return EXIT_ERROR
    return EXIT_WARN if WARN in severities else EXIT_OK


def listing(names: Iterable[str], shown: int = 3) -> str:
    """Returns a list as text, for example: 'a', 'b', 'c' and 4 more."""
    names = list(names)
    text = ", ".join(f"'{name}'" for name in names[:shown])
    return text if len(names) <= shown else f"{text} and {len(names) - shown} more"


def counted(number: int, noun: str) -> str:
    """Returns the number with its noun, for example "1 link" or "2 links"."""
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"
