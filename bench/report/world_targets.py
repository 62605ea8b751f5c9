# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Targets for uneven worlds, for worlds in which different boxes move in each frame."""
from markdown import count
from verdicts import ms, ratio


def per_box_and_pair(record):
    return ms(record) / (record['n'] + record['pairs']) if ms(record) else None


def all_uneven(figures, verdicts):
    """Compares hgrid in uneven worlds with the fastest peer there, and with hgrid in the uniform world."""
    for n in figures.sizes():
        for workload in figures.uneven():
            ours, rivals = figures.pairs('hgrid', workload, n), figures.rivals(workload, n)
            where = '%s, n = %s' % (workload, count(n))
            if rivals:
                fastest = min(rivals, key=ms)
                least = 1.3 if n >= 100000 and workload != 'diagonal' else 1
                verdicts.at_least('%s, 100 %% move: times faster than the fastest peer (%s)' % (where, fastest['peer']),
                                  least, ratio(ms(fastest), ms(ours)))
            uniform = figures.pairs('hgrid', 'uniform', n)
            verdicts.at_most(where + ': time per box and pair ÷ that of uniform', 3,
                             ratio(per_box_and_pair(ours), per_box_and_pair(uniform)))


def changing(figures, verdicts):
    for record in figures.all('pairs', peer='hgrid', movers='changing', isa=figures.best_isa(), threads=1):
        workload, n, moving = (record[field] for field in ('workload', 'n', 'moving'))
        what = '%s, n = %s: %g %% moving, others in each frame, ÷ all moving' % (workload, count(n), 100 * moving)
        verdicts.at_most(what, 0.2 if moving <= 0.01 else 1, ratio(ms(record), ms(figures.pairs('hgrid', workload, n))))
