# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""The figures of one run, and how to ask for them."""
import json

WORKLOADS = ['uniform', 'mixed', 'floor', 'robots']
QUERIES = ['sphere', 'segment', 'box', 'nearest', 'nearest8']
MAP_QUERIES = ['touches', 'overlapping', 'segment']
TREE = 'FCL DynamicAABBTree'


class Figures:
    """Records of one or several figures files; of those that say the same, the last one counts."""

    def __init__(self, paths):
        self.records = []
        for path in paths:
            with open(path) as file:
                self.records += json.load(file)
        for record in self.all('pairs'):
            record.setdefault('movers', 'same')  # older files do not have these fields
        for record in self.all('query'):
            record.setdefault('placed', 'near')
        runs = self.all('run')
        self.run = runs[0] if runs else {}

    def all(self, kind, **wanted):
        """Records of a kind whose fields equal what is wanted."""
        return [record for record in self.records if record['kind'] == kind
                and all(record.get(name) == value for name, value in wanted.items())]

    def one(self, kind, **wanted):
        found = self.all(kind, **wanted)
        return found[-1] if found else None

    def best_isa(self):
        """The instruction set that hgrid uses by itself: the first one of every match."""
        found = self.all('pairs', peer='hgrid') or self.all('ageing', peer='hgrid')
        return found[0]['isa'] if found else None

    def pairs(self, peer, workload, n, moving=1, threads=1, isa=None, movers='same'):
        """The record of a peer's frames; hgrid's with the instruction set that it uses by itself."""
        wanted = dict(peer=peer, workload=workload, n=n, moving=moving, threads=threads, movers=movers)
        if peer == 'hgrid':
            wanted['isa'] = isa or self.best_isa()
        return self.one('pairs', **wanted)

    def sizes(self):
        return sorted({record['n'] for record in self.all('pairs')})

    def even(self, moving):
        """Records of pairs of the workloads that the main tables show, where the same boxes always move."""
        return [record for record in self.all('pairs', moving=moving, movers='same') if record['workload'] in WORKLOADS]

    def uneven(self):
        """Names of the workloads with tables of their own, in order of appearance."""
        names = dict.fromkeys(record['workload'] for record in self.all('pairs'))
        return [name for name in names if name not in WORKLOADS]

    def peers(self, kind='pairs', **wanted):
        """Names of the peers in order of appearance, hgrid first."""
        names = list(dict.fromkeys(record['peer'] for record in self.all(kind, **wanted)))
        return sorted(names, key=lambda name: name != 'hgrid')

    def rivals(self, workload, n, moving=1, movers='same'):
        """Correct records of all peers but hgrid."""
        return [record for record in self.all('pairs', workload=workload, n=n, moving=moving, movers=movers)
                if record['peer'] != 'hgrid' and record['correct']]


def short(value):
    """Three digits, as few characters as that takes."""
    if value == 0:
        return '0'
    text = '%.3g' % value
    return '%d' % round(value) if 'e' in text and value >= 1 else text


def shown(record, field='median_ms', scale=1.0):
    """A figure for a table: "–" if it was not measured, and never a bare number for a wrong answer."""
    if record is None:
        return '–'
    if record['status'] != 'ok':
        return 'crash' if 'crash' in record['status'] else 'too slow' if 'answer' in record['status'] else 'error'
    return short(scale * record[field]) + ('' if record['correct'] else ' ✗')
