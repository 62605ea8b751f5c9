# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Loads the figures of a run and selects records from them."""
import json

WORKLOADS = ['uniform', 'mixed', 'floor', 'robots']
QUERIES = ['sphere', 'segment', 'box', 'nearest', 'nearest8']
MAP_QUERIES = ['touches', 'small', 'overlapping', 'segment']
TREE = 'FCL DynamicAABBTree'
BROAD_PHASES = ['pairs', 'loading', 'ageing']  # kinds of records about pairs
WORLD = ['kind', 'workload', 'n', 'moving', 'movers', 'age', 'query', 'placed']  # fields: what is computed
SETTING = WORLD + ['peer', 'threads', 'isa', 'batched']                          # fields: what is computed and how


def world(record):
    return tuple(record.get(name) for name in WORLD)


def setting(record):
    return tuple(record.get(name) for name in SETTING)


class Figures:
    """The records of one or several figures files. If several records about broad phases have the same setting, the last
    one is used. A record of hgrid that no peer's result could be compared with is not used if there is another one. A
    wrong result is always used."""

    def __init__(self, paths):
        self.records = []
        for path in paths:
            with open(path) as file:
                self._add(json.load(file))
        runs = self.all('run')
        self.run = runs[0] if runs else {}

    def _add(self, records):
        """Adds the records of a file, and removes those that they replace."""
        for record in records:
            if record['kind'] in BROAD_PHASES:
                record.setdefault('movers', 'same')  # older files do not have this field
            if record['kind'] == 'query':
                record.setdefault('placed', 'near')
        judged = {world(record) for record in records if record.get('correct')}
        new = {setting(record): record for record in records if record['kind'] in BROAD_PHASES + ['query']}
        known = {setting(record) for record in self.records}
        useless = {key for key, record in new.items()
                   if not record['correct'] and world(record) not in judged and key in known}
        self.records = [record for record in self.records
                        if setting(record) not in new or setting(record) in useless or self._is_wrong(record)]
        self.records += [record for record in records
                         if setting(record) not in useless and new.get(setting(record), record) is record]

    def _is_wrong(self, record):
        """Returns whether the result of hgrid differs from that of the peers."""
        return (record['peer'] == 'hgrid' and not record['correct']
                and any(world(other) == world(record) for other in self.records if other.get('correct')))

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
