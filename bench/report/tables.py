# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Formats the result tables in Markdown."""
import world_tables
from figures import MAP_QUERIES, QUERIES, WORKLOADS, short, shown
from markdown import count, table

PEER_NOTE = ('Cells: %s. – = not run, since one frame or loading takes far too long; ✗ = wrong pair set; '
             'crash = the process of this peer crashed.')

THREADS_NOTE = ('Medians over turns. In the same turns, a loop that adds registers and touches no memory shows how '
                'much a second processor can gain at that time. Both processors count as free if this loop gains 1.9 '
                'or more.')

MAPS_NOTE = ('Load: read the file and prepare for questions; build: the same from a list of leaves. Questions: one by '
             'one in random order / batched in Morton order, including the time to sort them. Bytes: what the peer '
             'reports to hold; for FCL, what it has allocated. – = not measured, or too many leaves; ✗ = the '
             'answers differ from those of OctoMap, or there is no other peer to compare with.')

STATES_NOTE = ('Median processor time per state [µs], hgrid / FCL, and the median of the ratios of successive turns. hgrid gets '
               'batches of 1,000 states. FCL works in the way of MoveIt: a tree of links against a tree of the world, exact '
               'meshes, one state at a time, forward kinematics included. All verdicts are compared. FCL takes meshes as '
               'surfaces, so a shape inside a mesh does not count as a difference. The 143,729 boxes are the leaves of the '
               'map geb079; hgrid has them as a map.')
MESHES_NOTE = ('Mean µs per distance of two meshes, hgrid / FCL. The second mesh moves in steps of 2 mm and 0.01 rad. '
               'Without a limit: the search knows nothing. With a limit: it ends at the last distance plus the motion '
               'since then, as in the node. Both libraries find the same distances; ✗ = they differ by more than '
               '1e-9, or FCL was not found.')

EXACTNESS_NOTE = ('`scripts/bench --part exactness`: errors in meters, of the same pairs of convex shapes for each '
                  'library. In brackets: the deepest lost touch, and the distance of the farthest false one. '
                  'Differences of 1e-14 of the size do not count: doubles round as much. Overlap left: how much '
                  'farther the second shape must be moved along the normal, after it was moved by the depth. Depth '
                  'too large: how much shorter than this move in all another move is that separates the shapes, '
                  'too. Both are the largest of all pairs. – = the library does not tell it. ODE has no cones.')

EDGES_NOTE = ('Median processor time per edge [µs], hgrid / FCL, and the median of the ratios of successive turns. An edge '
              'goes straight from one state without contact to another, at most 1 rad or at most 4 rad far. hgrid '
              'examines all configurations; FCL tests one configuration for each 1 cm of motion, in the way of MoveIt, '
              'and stops at the first contact. In contact: hgrid looks for any contact; first: hgrid looks for the first '
              'one, to 1 mm. Missed: contacts that the samples miss. All verdicts are compared.')

NODE_MAPS_NOTE = ('Every second, a message (binary, like octomap_binary of octomap_server) brings a map in which 1 % '
                  'of the leaves have changed. Spans of time with the map at rest and with such messages take turns. '
                  'query_sphere and query_segment: round trips over persistent connections, 200 per second together. '
                  'The bench moves the robots, sends the prepared maps and the queries, and receives what the node '
                  'publishes, on the same processors as the node.')

PROCESSES = ('cpu', 'cpu of the bench', 'cpu of others')


def machine(figures):
    run = figures.run
    text = '%s · %s · commit %s · `%s`' % tuple(run.get(name) for name in ('cpu', 'compiler', 'commit', 'command'))
    if run.get('missing'):
        text += '\n\nNot measured, since the library was not found: %s.' % run['missing']
    return text


def pairs(figures, moving):
    """Returns one row per peer and one column per number of boxes. Each cell has one figure per even workload."""
    sizes = sorted({record['n'] for record in figures.even(moving)})
    rows = []
    for peer in figures.peers():
        cells = [[shown(figures.pairs(peer, workload, n, moving)) for workload in WORKLOADS] for n in sizes]
        if any(cell != '–' for row in cells for cell in row):
            bold = '**%s**' if peer == 'hgrid' else '%s'
            rows.append([bold % peer] + [' / '.join(row) if set(row) != {'–'} else '–' for row in cells])
    if moving == 1 and figures.all('floor'):
        floors = [figures.one('floor', n=n) for n in sizes]
        rows.append(['*the floor (uniform)*'] + [short(floor['median_ms']) if floor else '–' for floor in floors])
    return table(['median ms per frame'] + ['n = ' + count(n) for n in sizes], rows)


def spread(figures):
    spreads = sorted(record['spread'] for record in figures.all('pairs') if record['correct'])
    if not spreads:
        return ''
    return ('Spread of the medians of single rounds, (largest − smallest) ÷ median: below %.0f %% for half of all '
            'figures, below %.0f %% for nine in ten.'
            % (100 * spreads[len(spreads) // 2], 100 * spreads[9 * len(spreads) // 10]))


def variants(figures):
    """Returns one row per instruction set and number of threads of hgrid."""
    sizes = sorted({record['n'] for record in figures.all('pairs', peer='hgrid', moving=1)})
    ways = list(dict.fromkeys((record['isa'], record['threads']) for record in figures.all('pairs', peer='hgrid')))
    rows = []
    for isa, threads in sorted(ways, key=lambda way: (way[1], ways.index(way))):
        cells = [[shown(figures.pairs('hgrid', workload, n, 1, threads, isa)) for workload in WORKLOADS] for n in sizes]
        rows.append(['%s, %d thread%s' % (isa, threads, 's' if threads > 1 else '')]
                    + [' / '.join(row) if set(row) != {'–'} else '–' for row in cells])
    return table(['median ms per frame'] + ['n = ' + count(n) for n in sizes], rows)


def threads(figures):
    """Returns one row per world: how much a second thread gains, and how much it could gain at that time."""
    rows = [[record['workload'], count(record['n']), short(record['gain']), short(record['gain_of_registers']),
             '%d of %d' % (record['free_turns'], record['turns']),
             short(record['gain_in_free_turns']) if record['free_turns'] else '–'] for record in figures.all('threads')]
    return table(['two threads, times faster than one', 'n', 'hgrid', 'register loop',
                  'turns with both processors free', 'hgrid in these turns'], rows)


def ageing(figures):
    ages = sorted({record['age'] for record in figures.all('ageing')})
    rows = []
    for peer in [name for name in figures.peers('ageing') if name != 'brute force']:
        cells = [[shown(figures.one('ageing', peer=peer, workload=workload, age=age)) for workload in WORKLOADS]
                 for age in ages]
        rows.append([peer] + [' / '.join(row) if set(row) != {'–'} else '–' for row in cells])
    return table(['median ms per frame, n = 10,000'] + ['after %s frames' % count(age) for age in ages], rows)


def memory(figures):
    sizes = figures.sizes()
    n = 100000 if 100000 in sizes else sizes[-1]
    rows = []
    for peer in figures.peers():
        records = [figures.pairs(peer, workload, n) for workload in WORKLOADS]
        if any(records):
            rows.append([peer] + [shown(record, 'bytes_per_object') for record in records])
    return table(['bytes per box, n = %s' % count(n)] + WORKLOADS, rows)


def queries(figures):
    kinds = [kind for kind in QUERIES if figures.all('query', query=kind, placed='near')]
    rows = []
    for peer in figures.peers('query', placed='near'):
        records = [[figures.one('query', peer=peer, workload=workload, query=kind, placed='near')
                    for workload in WORKLOADS] for kind in kinds]
        cells = [[shown(record, 'median_us') for record in row] for row in records]
        if any(cell != '–' for row in cells for cell in row):
            rows.append([peer] + [' / '.join(row) if set(row) != {'–'} else '–' for row in cells])
    n = figures.all('query', placed='near')[-1]['n']
    right = [[figures.one('query', workload=workload, query=kind, correct=True, placed='near')
              for workload in WORKLOADS]
             for kind in kinds]
    rows.append(['*hits per query*']
                + [' / '.join(short(one['hits_per_query']) if one else '–' for one in row) for row in right])
    return table(['median µs per query, n = %s' % count(n)] + kinds, rows)


def maps(figures):
    """Returns one table per map: times to load and to build the map, bytes per leaf, and times of questions about
    its leaves."""
    tables = []
    for name, leaves in dict.fromkeys((record['map'], record['leaves']) for record in figures.all('map')):
        def one(peer, query, **wanted):
            return figures.one('map', map=name, leaves=leaves, peer=peer, query=query, **wanted)

        rows = []
        for peer in figures.peers('map'):
            made = [one(peer, query) for query in ('load', 'build')]
            asked = [[one(peer, query, batched=batched) for batched in (False, True)] for query in MAP_QUERIES]
            if any(made):
                rows.append([peer] + [shown(record) for record in made] + [shown(made[0] or made[1], 'bytes_per_leaf')]
                            + [' / '.join(shown(record, 'median_us') for record in row) if any(row) else '–'
                               for row in asked])
        head = ['load ms', 'build ms', 'bytes per leaf'] + ['%s µs' % query for query in MAP_QUERIES]
        tables.append(table(['%s, %s leaves' % (name, count(leaves))] + head, rows))
    asked = [record for record in figures.all('map', peer='hgrid', batched=False)]
    doubt = 'Not compared, since rounding may decide the answer: %d of %d questions.' % (
        sum(record['in_doubt'] for record in asked),
        sum(record['in_doubt'] + record['compared'] for record in asked))
    return '\n\n'.join(tables + [doubt] + clouds(figures))


def clouds(figures):
    rows = [[count(record['points']), short(record['edge']), count(record['cells']), short(record['median_ms']),
             short(record['p99_ms'])] for record in figures.all('cloud')]
    head = ['cloud: points per message', 'edge of a cell [m]', 'cells held', 'median ms', 'p99 ms']
    return [table(head, rows)] if rows else []


def node(figures):
    rows = [[record['part'], record['world'], short(record['rate_hz']), short(record['median_ms']),
             short(record['p99_ms'])] for record in figures.all('node', maps_per_s=None) if 'median_ms' in record]
    return table(['part of the tick', 'world', 'Hz', 'median ms', 'p99 ms'], rows)


def node_maps(figures):
    """Returns one table per world with a map: ticks and queries while the map does not change, and while it is
    replaced."""
    tables = []
    for world in dict.fromkeys(record['world'] for record in figures.all('node', maps_per_s=1)):
        def both(part, field):
            records = [figures.one('node', world=world, part=part, maps_per_s=often) for often in (0, 1)]
            return [record[field] for record in records if record and field in record]

        rows = []
        for part in dict.fromkeys(record['part'] for record in figures.all('node', world=world, maps_per_s=1)):
            median, p99 = both(part, 'median_ms'), both(part, 'p99_ms')
            if len(p99) == 2:
                rows.append([part] + [' / '.join(map(short, pair)) for pair in (median, p99)]
                            + ['%+.3f' % (p99[1] - p99[0])])
        tables.append(table(['%s: map at rest / replaced' % world, 'median ms', 'p99 ms', 'p99, difference'], rows))
        shares = tuple(' / '.join(map(short, both(part, 'percent'))) for part in PROCESSES)
        tables.append('The node uses %s %% of one processor, the bench %s %%, all other programs %s %%.' % shares)
    return '\n\n'.join(tables)


def mesh_times(record, field):
    if record is None:
        return '–'
    times = '%s / %s' % (short(record['hgrid' + field]), short(record['fcl' + field]))
    return times + ('' if record['correct'] else ' ✗')


def meshes(figures):
    """One row per pair of meshes, one column per distance and kind of search. Then a row per winding number."""
    found = figures.all('mesh')
    gaps = sorted({record['gap'] for record in found})
    rows = []
    for first, second in dict.fromkeys((record['first'], record['second']) for record in found):
        records = [figures.one('mesh', first=first, second=second, gap=gap) for gap in gaps]
        cells = [mesh_times(record, field) for field in ('_us', '_limited_us') for record in records]
        rows.append(['%s, %s' % (first, second)] + cells)
    heads = ['%g m%s' % (gap, kind) for kind in ('', ', with a limit') for gap in gaps]
    text = table(['µs, hgrid / FCL'] + heads, rows)
    for record in figures.all('inside'):
        text += '\n\nWinding number of a point in a sphere of %s triangles: %s µs.' % (count(record['triangles']),
                                                                                    short(record['us']))
    return text


def exactness_cells(record):
    """Returns the cells of one library. Lengths have two digits, as more would not mean anything."""
    def length(name):
        return '%.2g' % record[name] if name in record else '–'

    def counted(count_name, length_name):
        return '%d' % record[count_name] + (' (%s)' % length(length_name) if record[count_name] else '')

    depth = (length('left'), length('too_long')) if record['depths'] else ('–', '–')
    return [count(record['pairs']), '%d' % record['unanswered'], counted('lost', 'deepest_lost'),
            counted('false', 'farthest_false'), length('median_error'), length('largest_error'), *depth]


def exactness(figures):
    """One table per class of shapes, with one row per size and library. Then a table of the intervals of hgrid."""
    tables = []
    found = figures.all('exactness')
    head = ['pairs', 'no answer', 'lost touches', 'false touches', 'error, median', 'error, largest', 'overlap left',
            'depth too large']
    for shapes in dict.fromkeys(record['shapes'] for record in found):
        rows = [['%g m, %s' % (record['size'], record['peer'])] + exactness_cells(record)
                for record in found if record['shapes'] == shapes]
        tables.append(table(['%s shapes, [m]' % shapes] + head, rows))
    rows = [['%s, %g m' % (record['shapes'], record['size']), '%.2g' % record['widest'], '%.2g' % record['outside'],
             '%d' % record['unsure']] for record in found if 'widest' in record]
    if rows:
        tables.append(table(['intervals of hgrid, [m]', 'width, at most', 'truth outside, at most',
                             'pairs not counted'], rows))
    return '\n\n'.join(tables)


def states(figures):
    """One row per robot and number of boxes: times for states without contact and in contact."""
    rows = []
    found = figures.all('states')
    for robot, boxes in dict.fromkeys((record['robot'], record['boxes']) for record in found):
        cells = []
        for which in ('clear', 'in contact'):
            record = figures.one('states', robot=robot, boxes=boxes, which=which)
            if record is None:
                cells.append('–')
                continue
            cells.append('%s / %s: %s times%s' % (short(record['hgrid_us']), short(record['fcl_us']),
                                                  short(record['ratio']), '' if record['correct'] else ' ✗'))
        rows.append([robot, count(boxes)] + cells)
    return table(['robot', 'boxes', 'without contact', 'in contact'], rows)


def edges(figures):
    """One row per robot and number of boxes: times for edges without contact and in contact."""
    rows = []
    found = figures.all('edges')
    for robot, boxes in dict.fromkeys((record['robot'], record['boxes']) for record in found):
        clear = figures.one('edges', robot=robot, boxes=boxes, which='clear')
        hit = figures.one('edges', robot=robot, boxes=boxes, which='in contact')
        cells = []
        for record, ours, ratio in ((clear, 'hgrid_us', 'ratio'), (clear, None, 'ratio_1mm'), (hit, 'any_us', 'any_ratio'),
                                    (hit, 'hgrid_us', 'ratio')):
            if record is None:
                cells.append('–')
                continue
            times = '' if ours is None else '%s / %s: ' % (short(record[ours]), short(record['fcl_us']))
            cells.append('%s%s times%s' % (times, short(record[ratio]), '' if record['correct'] else ' ✗'))
        any_record = clear or hit
        rows.append([robot, count(boxes)] + cells + ['%d of %d' % (any_record['missed'], any_record['edges'])])
    return table(['robot', 'boxes', 'clear', 'clear, each 1 mm', 'in contact', 'in contact, first', 'missed'], rows)


def sections(figures):
    """Returns title and text of each table for which there are figures."""
    cells = PEER_NOTE % 'uniform / mixed / floor / robots'
    found = [('Machine', machine(figures))]
    for moving, title in ((1, 'Pairs, all boxes move'), (0.1, 'Pairs, 10 % move'), (0.01, 'Pairs, 1 % move')):
        if figures.even(moving):
            found.append((title, cells + '\n\n' + pairs(figures, moving)))
    if figures.uneven():
        found.append(('Pairs in uneven worlds, all boxes move', world_tables.uneven(figures)))
    if figures.all('pairs', movers='changing'):
        found.append(('Pairs, other boxes move in each frame', world_tables.changing(figures)))
    if figures.all('pairs'):
        found[-1] = (found[-1][0], found[-1][1] + '\n\n' + spread(figures))
        found.append(('hgrid: instruction sets and threads', variants(figures)))
        found.append(('Memory', memory(figures)))
    if figures.all('loading'):
        found.append(('Loading', world_tables.loading(figures)))
    if figures.all('threads'):
        found.append(('Two threads', THREADS_NOTE + '\n\n' + threads(figures)))
    if figures.all('ageing'):
        found.append(('Aging', ageing(figures)))
    if figures.all('preparation'):
        found.append(('Preparation for queries', world_tables.preparation(figures)))
    if figures.all('query', placed='near'):
        found.append(('Queries near boxes', queries(figures)))
    if figures.all('query', placed='anywhere'):
        found.append(('Queries anywhere', world_tables.empty_space(figures)))
    if figures.all('map'):
        found.append(('Maps', MAPS_NOTE + '\n\n' + maps(figures)))
    if figures.all('mesh'):
        found.append(('Meshes', MESHES_NOTE + '\n\n' + meshes(figures)))
    if figures.all('exactness'):
        found.append(('Exactness', EXACTNESS_NOTE + '\n\n' + exactness(figures)))
    if figures.all('states'):
        found.append(('States of robots', STATES_NOTE + '\n\n' + states(figures)))
    if figures.all('edges'):
        found.append(('Edges of robots', EDGES_NOTE + '\n\n' + edges(figures)))
    if figures.all('node', maps_per_s=None):
        found.append(('The node', node(figures)))
    if figures.all('node', maps_per_s=1):
        found.append(('The node while its map is replaced', NODE_MAPS_NOTE + '\n\n' + node_maps(figures)))
    return found
