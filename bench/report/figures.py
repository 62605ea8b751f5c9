# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Loads the figures of a run and selects records from them."""
import json

WORKLOADS = ['uniform', 'mixed', 'floor', 'robots']
QUERIES = ['sphere', 'segment', 'box', 'nearest', 'nearest8']
MAP_QUERIES = ['touches', 'small', 'overlapping', 'segment']
TREE = 'FCL DynamicAABBTree'
# The fields that make up the setting of a record about broad phases.
SETTING = ['kind', 'peer', 'workload', 'n', 'moving', 'movers', 'threads', 'isa', 'age', 'query', 'placed', 'batched']


class Figures:
    """The records of one or several figures files. If several records have the same setting, the last one is used."""

    def __init__(self, paths):
        self.records = []
        for path in paths:
            with open(path) as file:
                self.records += json.load(file)
        for record in self.all('pairs'):
            record.setdefault('movers', 'same')  # older files do not have this field
        for record in self.all('query'):
            record.setdefault('placed', 'near')
        newest = {tuple(record.get(name) for name in SETTING): record for record in self.records}
        self.records = [record for record in self.records
                        if record['kind'] not in ('pairs', 'loading', 'ageing', 'query')
                        or newest[tuple(record.get(name) for name in SETTING)] is record]
        runs = self.all('run')
        self.run = runs[0] if runs else {}

    def all(self, kind, **wanted):
        """Returns the records of a kind whose fields equal the `wanted` values."""
        return [record for record in self.records if record['kind'] == kind
                and all(record.get(name) == value for name, value in wanted.items())]

    def one(self, kind, **wanted):
        found = self.all(kind, **wanted)
        return found[-1] if found else None

    def best_isa(self):
        """Returns the instruction set that hgrid chooses by itself. It is the one of hgrid's first record."""
        found = self.all('pairs', peer='hgrid') or self.all('ageing', peer='hgrid')
        return found[0]['isa'] if found else None

    def pairs(self, peer, workload, n, moving=1, threads=1, isa=None, movers='same'):
        """Returns the record of the frames of a peer. For hgrid, `isa` defaults to the instruction set that it
        chooses by itself."""
        wanted = dict(peer=peer, workload=workload, n=n, moving=moving, threads=threads, movers=movers)
        if peer == 'hgrid':
            wanted['isa'] = isa or self.best_isa()
        return self.one('pairs', **wanted)

    def sizes(self):
        return sorted({record['n'] for record in self.all('pairs')})

    def even(self, moving):
        """Returns the records of pairs in the even worlds in which the same boxes move in all frames."""
        return [record for record in self.all('pairs', moving=moving, movers='same') if record['workload'] in WORKLOADS]

    def uneven(self):
        """Returns the names of the uneven workloads, in order of appearance. They have separate tables."""
        names = dict.fromkeys(record['workload'] for record in self.all('pairs'))
        return [name for name in names if name not in WORKLOADS]

    def peers(self, kind='pairs', **wanted):
        """Returns the names of the peers: hgrid first, then the others in order of appearance."""
        names = list(dict.fromkeys(record['peer'] for record in self.all(kind, **wanted)))
        return sorted(names, key=lambda name: name != 'hgrid')

    def rivals(self, workload, n, moving=1, movers='same'):
        """Returns the correct records of all peers except hgrid."""
        return [record for record in self.all('pairs', workload=workload, n=n, moving=moving, movers=movers)
                if record['peer'] != 'hgrid' and record['correct']]


def short(value):
    """Formats a number with three significant digits and as few characters as possible."""
    if value == 0:
        return '0'
    text = '%.3g' % value
    return '%d' % round(value) if 'e' in text and value >= 1 else text


def shown(record, field='median_ms', scale=1.0):
    """Formats a figure for a table. The text is "–" if the figure was not measured, and contains ✗ if the answer was
    wrong."""
    if record is None:
        return '–'
    if record['status'] != 'ok':
        return 'crash' if 'crash' in record['status'] else 'too slow' if 'answer' in record['status'] else 'error'
    return short(scale * record[field]) + ('' if record['correct'] else ' ✗')
