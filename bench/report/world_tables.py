# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Tables of uneven worlds, of worlds in which different boxes move in each frame, and of queries anywhere."""
from figures import short, shown
from markdown import count, table

UNEVEN_NOTE = ('Median ms per frame. Pairs: per box. – = not run, since one frame or loading takes far too long; '
               'too slow = no answer in time; ✗ = wrong pair set, or no other peer to compare it with; crash = the '
               'process of this peer crashed.')

LOADING_NOTE = 'Median ms in which a new peer loads all boxes and finds the pairs of the first frame.'

MOVERS_NOTE = ('Median ms per frame: the same boxes move in every frame / other boxes move in each frame, chosen at '
               'random. In the second case, 30 frames come before the measured ones.')

PREPARATION_NOTE = ('Median of three measurements: storing all boxes, and building what makes later queries faster. '
                    'For hgrid this is one bulk update.')
EMPTY_NOTE = ('Median µs per query. The queries are at random places in the bounds of all boxes. Their size gives '
              'about half a hit per query if the world is not too empty for that.')


def uneven(figures):
    """Returns a note and one table per number of boxes. A table has one row per workload and one column per peer."""
    tables = []
    for n in sorted({record['n'] for name in figures.uneven() for record in figures.all('pairs', workload=name)}):
        rows, ran = [], lambda peer: any(figures.pairs(peer, name, n) for name in figures.uneven())
        peers = [peer for peer in figures.peers() if ran(peer)]
        for name in figures.uneven():
            records = [figures.pairs(peer, name, n) for peer in peers]
            right = next((record for record in records if record and record['correct']), None)
            if any(records):
                rows.append([name, short(right['pairs_per_box']) if right else '–']
                            + [shown(record) for record in records])
        tables.append(table(['n = ' + count(n), 'pairs'] + peers, rows))
    return '\n\n'.join([UNEVEN_NOTE] + tables)


def loading(figures):
    """Returns a note and a table with one row per workload and number of boxes, and one column per peer."""
    found = figures.all('loading')
    peers = figures.peers('loading')
    rows = []
    for workload, n in dict.fromkeys((record['workload'], record['n']) for record in found):
        rows.append(['%s, %s' % (workload, count(n))]
                    + [shown(figures.one('loading', peer=peer, workload=workload, n=n)) for peer in peers])
    return LOADING_NOTE + '\n\n' + table(['median ms'] + peers, rows)


def changing(figures):
    """Returns a note and one table per number of boxes. A table has one row per peer, one column per workload and
    fraction."""
    tables = []
    found = figures.all('pairs', movers='changing')
    for n in sorted({record['n'] for record in found}):
        settings = list(dict.fromkeys((record['workload'], record['moving']) for record in found if record['n'] == n))
        rows = []
        for peer in figures.peers(movers='changing', n=n):
            rows.append([peer] + [' / '.join(shown(figures.pairs(peer, workload, n, moving, movers=movers))
                                             for movers in ('same', 'changing')) for workload, moving in settings])
        rows.append(['*hgrid, all move*'] + [shown(figures.pairs('hgrid', workload, n)) for workload, _ in settings])
        heads = ['%s, %g %%' % (workload, 100 * moving) for workload, moving in settings]
        tables.append(table(['n = ' + count(n)] + heads, rows))
    return '\n\n'.join([MOVERS_NOTE] + tables)


def preparation(figures):
    """Returns one row per workload and one column per peer."""
    found = figures.all('preparation')
    peers = list(dict.fromkeys(record['peer'] for record in found))
    rows = [[workload] + [shown(figures.one('preparation', peer=peer, workload=workload)) for peer in peers]
            for workload in dict.fromkeys(record['workload'] for record in found)]
    return PREPARATION_NOTE + '\n\n' + table(['ms, n = ' + count(found[-1]['n'])] + peers, rows)


def empty_space(figures):
    """Returns a note and one table per kind of query. A table has one row per workload and one column per peer."""
    tables = []
    found = figures.all('query', placed='anywhere')
    for kind, n in dict.fromkeys((record['query'], record['n']) for record in found):
        these = [record for record in found if record['query'] == kind and record['n'] == n]
        peers = list(dict.fromkeys(record['peer'] for record in these))
        rows = []
        for workload in dict.fromkeys(record['workload'] for record in these):
            of = {record['peer']: record for record in these if record['workload'] == workload}
            right = next((record for record in of.values() if record['correct']), None)
            rows.append([workload, short(right['hits_per_query']) if right else '–']
                        + [shown(of.get(peer), 'median_us') for peer in peers])
        tables.append(table(['%s, n = %s' % (kind, count(n)), 'hits'] + peers, rows))
    return '\n\n'.join([EMPTY_NOTE] + tables)
