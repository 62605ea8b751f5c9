# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Draws charts as SVG. It writes the SVG text directly, so no library is needed."""
import math

from figures import WORKLOADS

COLORS = {
    'hgrid': '#d62728', 'sweep': '#1f77b4', 'FCL DynamicAABBTree': '#2ca02c', 'Embree rtcCollide': '#9467bd',
    'Embree': '#9467bd', 'Bullet dbvt': '#ff7f0e', 'Bullet AxisSweep3': '#e0a030', 'Boost R-tree': '#17becf',
    'ODE SAP space': '#7f7f7f', 'ODE hash space': '#bcbd22', 'CGAL box_self_intersection_d': '#8c564b',
    'FCL DynamicAABBTree_Array': '#98df8a', 'FCL SSaP': '#c49c94', 'FCL SaP': '#c7c7c7', 'FCL SpatialHash': '#aec7e8',
    'brute force': '#444444',
}
FONT = 'font-family="DejaVu Sans, Helvetica, Arial, sans-serif"'


class Svg:
    def __init__(self, width, height):
        self.width, self.height, self.parts = width, height, []

    def text(self, x, y, text, size=12, anchor='start', color='#222', weight='normal'):
        text = text.replace('&', '&amp;').replace('<', '&lt;')
        self.parts.append('<text x="%.1f" y="%.1f" font-size="%g" text-anchor="%s" fill="%s" font-weight="%s">%s'
                          '</text>' % (x, y, size, anchor, color, weight, text))

    def line(self, x1, y1, x2, y2, color='#ddd', width=1.0):
        self.parts.append('<line x1="%.1f" y1="%.1f" x2="%.1f" y2="%.1f" stroke="%s" stroke-width="%g"/>'
                          % (x1, y1, x2, y2, color, width))

    def polyline(self, points, color, width):
        self.parts.append('<polyline fill="none" stroke="%s" stroke-width="%g" points="%s"/>'
                          % (color, width, ' '.join('%.1f,%.1f' % point for point in points)))
        for x, y in points:
            self.parts.append('<circle cx="%.1f" cy="%.1f" r="%g" fill="%s"/>' % (x, y, width + 0.8, color))

    def bar(self, x, y, width, height, color):
        self.parts.append('<rect x="%.1f" y="%.1f" width="%.1f" height="%.1f" fill="%s"/>'
                          % (x, y, width, height, color))

    def save(self, path):
        with open(path, 'w') as file:
            file.write('<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 %d %d" width="%d" height="%d" %s>\n'
                       '<rect width="100%%" height="100%%" fill="white"/>\n%s\n</svg>\n'
                       % (self.width, self.height, self.width, self.height, FONT, '\n'.join(self.parts)))


def legend(svg, names, x, y, columns, step):
    for i, name in enumerate(names):
        left, top = x + step * (i % columns), y + 18 * (i // columns)
        svg.line(left, top - 4, left + 22, top - 4, COLORS.get(name, '#000'), 4 if name == 'hgrid' else 2)
        svg.text(left + 28, top, name)


def panel(svg, figures, workload, moving, left, top, width, height, low, high):
    """Draws the time per box against the number of boxes, both on logarithmic scales. Each peer with correct results
    has a line."""
    sizes = figures.sizes()
    first, last = math.log10(sizes[0]), math.log10(sizes[-1])

    def at(n, value):
        x = left + width * (math.log10(n) - first) / max(last - first, 1e-9)
        return x, top + height * (high - math.log10(value)) / (high - low)

    svg.text(left + width / 2, top - 8, workload, 14, 'middle', weight='bold')
    for power in range(low, high + 1):
        y = at(sizes[0], 10.0 ** power)[1]
        svg.line(left, y, left + width, y)
        svg.text(left - 6, y + 4, '%g' % 10.0 ** power, 11, 'end')
    for n in sizes:
        x = at(n, 10.0 ** low)[0]
        svg.line(x, top, x, top + height)
        svg.text(x, top + height + 16, '{:,}'.format(n), 11, 'middle')
    for peer in reversed(figures.peers()):  # draws hgrid last, on top
        records = [figures.pairs(peer, workload, n, moving) for n in sizes]
        points = [at(record['n'], 1e3 * record['median_ms'] / record['n'])
                  for record in records if record and record['correct']]
        if points:
            svg.polyline(points, COLORS.get(peer, '#000'), 3.5 if peer == 'hgrid' else 1.6)


def pairs_chart(figures, moving, path):
    records = [record for record in figures.even(moving) if record['threads'] == 1 and record['correct']]
    values = [1e3 * record['median_ms'] / record['n'] for record in records]
    low, high = math.floor(math.log10(min(values))), math.ceil(math.log10(max(values)))
    names = [name for name in figures.peers() if any(record['peer'] == name for record in records)]
    svg = Svg(1000, 800 + 18 * math.ceil(len(names) / 4))
    svg.text(20, 30, 'Update and all pairs: µs per box and frame over the number of boxes (%g %% move, one thread)'
             % (100 * moving), 16, weight='bold')
    for i, workload in enumerate(WORKLOADS):
        panel(svg, figures, workload, moving, 70 + 490 * (i % 2), 80 + 360 * (i // 2), 400, 290, low, high)
    legend(svg, names, 70, 800, 4, 232)
    svg.save(path)


def queries_chart(figures, kinds, path):
    """Draws bars of millions of queries per second, one group of bars per workload."""
    svg = Svg(1000, 60 + 330 * len(kinds))
    n = figures.all('query', placed='near')[0]['n']
    svg.text(20, 30, 'Queries, n = {:,}, one thread: millions per second'.format(n), 16, weight='bold')
    for row, kind in enumerate(kinds):
        query_panel(svg, figures, kind, 70, 90 + 330 * row, 900, 190)
    svg.save(path)


def query_panel(svg, figures, kind, left, top, width, height):
    peers = list(dict.fromkeys(record['peer'] for record in figures.all('query', query=kind, placed='near')))
    peers.sort(key=lambda peer: peer != 'hgrid')
    speeds = {(record['peer'], record['workload']): 1 / record['median_us']
              for record in figures.all('query', query=kind, placed='near') if record['correct']}
    most = max(speeds.values(), default=1.0)
    step = 10.0 ** math.floor(math.log10(most))
    step = next(s for s in (step / 5, step / 2, step, 2 * step) if most / s <= 6)
    svg.text(left, top - 14, kind, 14, weight='bold')
    for i in range(int(most / step) + 1):
        y = top + height * (1 - i * step / most)
        svg.line(left, y, left + width, y)
        svg.text(left - 6, y + 4, '%g' % (i * step), 11, 'end')
    group = width / len(WORKLOADS)
    bar = min(28.0, group * 0.85 / len(peers))
    for column, workload in enumerate(WORKLOADS):
        begin = left + group * (column + 0.5) - bar * len(peers) / 2
        svg.text(left + group * (column + 0.5), top + height + 18, workload, 12, 'middle')
        for i, peer in enumerate(peers):
            speed = speeds.get((peer, workload), 0.0)
            tall = height * speed / most
            svg.bar(begin + i * bar, top + height - tall, bar - 2, tall, COLORS.get(peer, '#000'))
    for i, peer in enumerate(peers):
        x = left + i * width / max(len(peers), 5)
        svg.bar(x, top + height + 32, 12, 12, COLORS.get(peer, '#000'))
        svg.text(x + 17, top + height + 42, peer, 11)
