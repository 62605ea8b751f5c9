# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Formats Markdown, which is also the format of the printed tables."""


def table(head, rows):
    """Returns a Markdown table. The first column is text, the others are numbers."""
    lines = ['| ' + ' | '.join(head) + ' |', '| --- ' + '| ---: ' * (len(head) - 1) + '|']
    return '\n'.join(lines + ['| ' + ' | '.join(row) + ' |' for row in rows])


def count(n):
    return '{:,}'.format(int(n))
