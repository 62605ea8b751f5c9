# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Compares the figures with the targets. Leaves out targets for which there are no figures."""
from figures import TREE, WORKLOADS, short
from markdown import count, table
from verdicts import Verdicts, ms, ratio
from world_targets import all_uneven, changing


def against_tree(figures, verdicts, n, workload):
    least = {1000: 4, 10000: 6, 100000: 7, 1000000: 7}.get(n)
    if workload == 'mixed':
        least = 4
    if workload == 'robots' and n == 1000000:
        least = 5
    ours, tree = (ms(figures.pairs(peer, workload, n)) for peer in ('hgrid', TREE))
    if least:
        what = '%s, n = %s, all move: times faster than FCL\'s tree, fresh' % (workload, count(n))
        verdicts.at_least(what, least, ratio(tree, ours))


def against_fastest(figures, verdicts, n, workload, moving):
    ours = ms(figures.pairs('hgrid', workload, n, moving))
    rivals = [record for record in figures.rivals(workload, n, moving) if record['peer'] != TREE]
    if not rivals or n not in (1000, 10000, 100000, 1000000):
        return
    if moving < 1 and n < 10000:
        return
    fastest = min(rivals, key=ms)
    least = 1.0
    if moving == 1 and n >= 100000:
        least = 1.5 if workload == 'mixed' else 2
    verdicts.at_least('%s, n = %s, %g %% move: times faster than the fastest other peer (%s)'
                      % (workload, count(n), 100 * moving, fastest['peer']), least, ratio(ms(fastest), ours))


def floor_and_growth(figures, verdicts):
    def per_floor(n):
        return ratio(ms(figures.pairs('hgrid', 'uniform', n)), (figures.one('floor', n=n) or {}).get('median_ms'))
    verdicts.at_most('uniform, n = 100,000: time ÷ floor', 3.5, per_floor(100000))
    verdicts.at_most('uniform, n = 1,000,000: time ÷ floor', 2, per_floor(1000000))
    mixed, uniform = (ms(figures.pairs('hgrid', workload, 100000)) for workload in ('mixed', 'uniform'))
    verdicts.at_most('n = 100,000: mixed ÷ uniform', 2, ratio(mixed, uniform))


def part_moving(figures, verdicts, n, workload):
    whole = ms(figures.pairs('hgrid', workload, n))
    for moving, most in ((0.1, 0.5), (0.01, 0.15)):
        part = ms(figures.pairs('hgrid', workload, n, moving))
        what = '%s, n = %s: %g %% moving ÷ all moving' % (workload, count(n), 100 * moving)
        verdicts.at_most(what, most, ratio(part, whole))


def ages(figures, verdicts):
    for workload in WORKLOADS:
        early, late = (ms(figures.one('ageing', peer='hgrid', workload=workload, age=age)) for age in (10, 1500))
        verdicts.at_most('%s, n = 10,000: frame 1,500 ÷ frame 10' % workload, 1.1, ratio(late, early))
    tree, ours = (ms(figures.one('ageing', peer=peer, workload='uniform', age=300)) for peer in (TREE, 'hgrid'))
    verdicts.at_least('uniform, n = 10,000: times faster than FCL\'s tree after 300 frames', 20, ratio(tree, ours))


def queries(figures, verdicts):
    def us(peer, kind, workload):
        record = figures.one('query', peer=peer, query=kind, workload=workload, n=100000, placed='near')
        return record['median_us'] if record and record['correct'] else None
    rows = (('sphere', 'Boost R-tree', 1), ('sphere', TREE, 2), ('segment', 'Boost R-tree', 1.5))
    for kind, peer, least in rows:
        for workload in WORKLOADS:
            value = ratio(us(peer, kind, workload), us('hgrid', kind, workload))
            verdicts.at_least('%s, n = 100,000: %s queries, times faster than %s' % (workload, kind, peer), least, value)


def maps(figures, verdicts):
    """Judges loading and memory on every map. Judges questions only on the synthetic map "building"."""
    for name, leaves in dict.fromkeys((record['map'], record['leaves']) for record in figures.all('map')):
        def figure(peer, query, field, **wanted):
            record = figures.one('map', map=name, leaves=leaves, peer=peer, query=query, **wanted)
            return record[field] if record and record['correct'] else None

        where = 'map %s, %s leaves: ' % (name, count(leaves))
        ours, octomap = (figure(peer, 'load', 'median_ms') for peer in ('hgrid', 'OctoMap'))
        verdicts.at_least(where + 'load and index, times faster than OctoMap\'s readBinary', 1, ratio(octomap, ours))
        verdicts.at_most(where + 'bytes per leaf', 16, figure('hgrid', 'load', 'bytes_per_leaf'))
        rows = (('touches', 'spheres that touch, times faster than FCL\'s OcTree', 'FCL OcTree', 10),
                ('overlapping', 'leaves in spheres, times faster than FCL\'s tree of leaves', TREE + ' of leaves', 10),
                ('segment', 'segments, times faster than OctoMap\'s castRay', 'OctoMap', 3))
        for query, what, peer, least in rows if name == 'building' else ():
            for batched in (False, True):
                us, theirs = (figure(one, query, 'median_us', batched=batched) for one in ('hgrid', peer))
                verdicts.at_least(where + what + (', batched' if batched else ''), least, ratio(theirs, us))
    asked = figures.all('map', peer='hgrid') if figures.all('map', peer='OctoMap') else []
    if asked:
        verdicts.holds('hgrid\'s leaves and answers on maps equal OctoMap\'s in all %d settings' % len(asked),
                       all(record['correct'] for record in asked))


def sameness(figures, verdicts):
    """Judges whether hgrid's results are correct, and whether two threads give the same bytes as one thread."""
    ours = figures.all('pairs', peer='hgrid')
    verdicts.holds('hgrid\'s pair sets equal the reference in all %d settings' % len(ours),
                   all(record['correct'] for record in ours))
    threaded = figures.all('threads')
    if threaded:
        verdicts.holds('two threads write the same bytes as one in all %d settings' % len(threaded),
                       all(record['same_bytes'] for record in threaded))
    asked = figures.all('query', peer='hgrid')
    if asked:
        verdicts.holds('hgrid\'s query hits equal the reference in all %d settings' % len(asked),
                       all(record['correct'] for record in asked))


def meshes(figures, verdicts):
    """With the bound of the last measurement, as in the node, and without any bound. FCL has no bound in both."""
    for field, what in (('hgrid_limited_us', 'with the bound of the last measurement'), ('hgrid_us', 'without a bound')):
        times = [ratio(record['fcl_us'], record[field]) for record in figures.all('mesh') if record['correct']]
        verdicts.at_least('distances of meshes %s: times faster than FCL alone, least of %d rows' % (what, len(times)), 3,
                          min(times) if times else None)


def states(figures, verdicts):
    for record in figures.all('states'):
        least = 6 if record['which'] == 'in contact' else {10: 4, 1000: 5, 10000: 8, 143729: 8}.get(record['boxes'])
        if least and record['correct'] and 'spheres' not in record['robot']:
            verdicts.at_least('states of %s %s among %s boxes: times faster than FCL'
                              % (record['robot'], record['which'], count(record['boxes'])), least, record['ratio'])


def sweep_fairness(figures, verdicts):
    """Judges whether the sweep peer is about as fast, relative to FCL's tree, as when the targets were set."""
    was = {'uniform': 26 / 32, 'mixed': 18 / 34, 'floor': 7.7 / 34, 'robots': 10 / 32}
    for workload, share in was.items():
        sweep, tree = (ms(figures.pairs(peer, workload, 100000)) for peer in ('sweep', TREE))
        verdicts.at_most('%s, n = 100,000: our sweep ÷ FCL\'s tree' % workload, 1.2 * share, ratio(sweep, tree))


def node(figures, verdicts):
    for part, most in (('tick', 1.5), ('broad phase', 0.1)):
        record = figures.one('node', bodies=992, part=part, distances=False, maps_per_s=None)
        verdicts.at_most('node, 992 links: median ms of the %s' % part, most, record and record['median_ms'])
    for part in ('tick', 'query_sphere', 'query_segment'):
        without, with_maps = (figures.one('node', part=part, maps_per_s=often) for often in (0, 1))
        added = with_maps['p99_ms'] - without['p99_ms'] if without and with_maps else None
        what = 'node, a map of 1,000,000 leaves replaced every second, 1 %% changed: ms added to the p99 of %s' % part
        verdicts.at_most(what, 2, added)
    for record in figures.all('node batch'):
        if 'check_states' in record['title']:
            verdicts.at_most('node, %s: time ÷ library alone' % record['title'], 1.5, record['ratio'])
    for record in figures.all('node guard'):
        for field, when in (('free_ms', 'free'), ('conflict_ms', 'in conflict')):
            verdicts.at_most('node, 4 arms with paths of 10 s, %s: median ms from a tick to ~conflicts' % when, 5,
                             record[field])


def threads(figures, verdicts):
    """Judges only turns in which both processors were free. If there are none, judges all turns. The table counts
    them."""
    for record in figures.all('threads'):
        what = '%s, n = %s: two threads, times faster than one' % (record['workload'], count(record['n']))
        if record['free_turns']:
            verdicts.at_least(what + ', both processors free', 1.7, record['gain_in_free_turns'])
        else:
            verdicts.at_least(what + ' (register loop: %s)' % short(record['gain_of_registers']), 1.7, record['gain'])


def verdicts_table(figures):
    verdicts = Verdicts()
    for n in figures.sizes():
        for workload in WORKLOADS:
            against_tree(figures, verdicts, n, workload)
            for moving in (1, 0.1, 0.01):
                against_fastest(figures, verdicts, n, workload, moving)
            if n >= 10000:
                part_moving(figures, verdicts, n, workload)
    all_uneven(figures, verdicts)
    changing(figures, verdicts)
    floor_and_growth(figures, verdicts)
    threads(figures, verdicts)
    ages(figures, verdicts)
    held = [record['bytes_per_object'] for record in figures.all('pairs', peer='hgrid') if record['n'] >= 10000]
    verdicts.at_most('most bytes per box, n from 10,000 up', 96, max(held) if held else None)
    queries(figures, verdicts)
    maps(figures, verdicts)
    if figures.all('pairs', peer='hgrid'):
        sameness(figures, verdicts)
    meshes(figures, verdicts)
    states(figures, verdicts)
    sweep_fairness(figures, verdicts)
    node(figures, verdicts)
    met = sum(row[-1] == 'met' for row in verdicts.rows)
    return ('%d of %d met.\n\n' % (met, len(verdicts.rows))
            + table(['target', 'wanted', 'reached', 'verdict'], verdicts.rows))
