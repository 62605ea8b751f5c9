# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Compares measured values with targets."""
from figures import short


class Verdicts:
    """The rows of the table of targets: target, limit, measured value, and whether the target is met."""

    def __init__(self):
        self.rows = []

    def at_least(self, what, limit, value):
        self._add(what, '≥ ' + short(limit), value, value is not None and value >= limit)

    def at_most(self, what, limit, value):
        self._add(what, '≤ ' + short(limit), value, value is not None and value <= limit)

    def holds(self, what, value):
        self.rows.append([what, 'yes', 'yes' if value else 'no', 'met' if value else '**not met**'])

    def _add(self, what, limit, value, met):
        if value is not None:
            self.rows.append([what, limit, short(value), 'met' if met else '**not met**'])


def ms(record):
    return record['median_ms'] if record and record['correct'] else None


def ratio(above, below):
    return above / below if above and below else None
