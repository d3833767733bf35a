#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""Draws docs/architecture.png: the rooms on their floors, with arrows from the includes, and the way of a datum.

usage: draw_architecture.py SOURCE_DIR OUT.png
"""
import math
import pathlib
import random
import sys

import matplotlib
matplotlib.use('Agg')
import matplotlib.patches as patches
import matplotlib.pyplot as plt

sys.dont_write_bytecode = True
sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / 'test'))
import wall_test  # noqa: E402  # it knows the floors

WHAT = {  # of each room, in a few words
    'math': 'angles, statistics', 'parallel': 'threads', 'io': 'files', 'robust': 'losses, gates', 'navigation': 'earth, attitude', 'config': 'YAML',
    'filters': 'Kalman, particle', 'noise': 'laws to draw from', 'estimate': 'solution, audit', 'session': 'readings in order', 'imaging': 'sonar images',
    'evaluation': 'scores, bounds', 'campaign': 'suites of runs', 'graph': 'solver helpers', 'systems/*/graph': 'factors, smoothers',
    'ros': 'server, messages', 'bag': 'reader, reprocess', 'systems/*/ros': 'messages to readings', 'systems': 'registry, nodelets', 'tools': 'command line'}
CORE, GTSAM, ROS = ('#dcebf7', '#2f6f9f'), ('#dff0df', '#3b8a4a'), ('#fbe6d2', '#c0641a')
STARTS = [('a message, live', 'ros/server'), ('a message of a bag', 'bag/reprocess')]  # the way of a datum: what it is, and where
WAY = [
    ('a reading', 'ros/system_run, by systems/NAME/ros:\nwhat the messages of each source become'),
    ('a reading in its place', 'session: ReadingQueue, Timeline, Present:\ntime order, late data, clock faults'),
    ('an estimate', 'filters, systems/NAME and its graph:\npredict and update, or a factor graph'),
    ('a solution and an audit', 'estimate: what every estimator says,\nwith the innovation z − h(x)'),
    ('messages', 'ros/solution_messages: the one place\nthat writes and reads answers')]
ENDS = [('NAME/odometry, …', 'ros/publisher'), ('a bag, tables', 'bag/reprocess')]


def edges(root):
    """Which kind of room includes which, of different kinds; how the includes within a kind go is said by no arrow."""
    pairs = {(wall_test.kind_of(room), wall_test.kind_of(included)) for _, _, room, included in wall_test.room_includes(root)}
    return {(a, b) for a, b in pairs if a != b and a in wall_test.ORDER and b in wall_test.ORDER}


def reduced(arrows):
    """The arrows without those that others already say: a to c, where there are a to b and b to c."""
    below = {}
    for room in wall_test.ORDER:  # from the bottom, so that those below are known
        below[room] = {b for a, b in arrows if a == room}
        for b in list(below[room]):
            below[room] |= below.get(b, set())
    return {(a, c) for a, c in arrows if not any((a, b) in arrows and c in below[b] for b in below if b != c)}


def colours(kind):
    return GTSAM if kind in wall_test.GRAPH_ROOMS else ROS if kind in wall_test.ROS_ROOMS else CORE


def names_of(kind, root):
    """What a box is called, and what is said below it."""
    if kind == 'systems/*':
        systems = sorted({room.split('/')[1] for _, room, _ in wall_test.files(root) if room.count('/') == 1})
        return 'systems/NAME', '\n'.join(', '.join(systems[i:i + 3]) for i in range(0, len(systems), 3))
    return kind.replace('*', 'NAME'), WHAT.get(kind, '')


def box(axes, x, y, width, height, title, text, fill, edge):
    axes.add_patch(patches.FancyBboxPatch((x - width / 2, y - height / 2), width, height, boxstyle='round,pad=0,rounding_size=0.12',
                                          facecolor=fill, edgecolor=edge, lw=1.2, zorder=3))
    lines = text.count('\n') + 1 if text else 0
    shift = 0.11 * lines if text else 0
    axes.text(x, y + shift, title, ha='center', va='center', fontsize=9.5, fontweight='bold', color='#222222', zorder=4)
    if text:
        axes.text(x, y + shift - 0.15, text, ha='center', va='top', fontsize=7.5, color='#444444', linespacing=1.25, zorder=4)


def arrow(axes, start, end, color):
    axes.annotate('', end, start, zorder=2, arrowprops={'arrowstyle': '-|>,head_width=0.18,head_length=0.35', 'color': color, 'lw': 1.1,
                                                        'shrinkA': 0, 'shrinkB': 0})


class Layout:
    """Where the boxes of the rooms stand: each on its floor, side by side so that few arrows run behind boxes or across one another."""

    HALF = 4.5  # of the picture's width
    SEED = 6    # of some that were tried the one with the clearest picture

    def __init__(self, arrows):
        self.arrows = sorted(arrows)
        self.y, self.height, top = {}, {}, 0.0
        for floor in wall_test.FLOORS:
            height = 0.8 if 'systems/*' in floor else 0.6
            for kind in floor:
                self.y[kind], self.height[kind] = top + height / 2, height
            top += height + 0.36
        self.top = top
        self.width = {kind: 2.9 if kind == 'systems/*' else 2.1 if '*' in kind else 1.75 for kind in wall_test.ORDER}
        self.x = {kind: (i - (len(floor) - 1) / 2) * 2.2 for floor in wall_test.FLOORS for i, kind in enumerate(floor)}
        self.arrange()

    def line(self, a, b):
        """Where the arrow from a to b begins and ends."""
        (xa, ya), (xb, yb) = (self.x[a], self.y[a]), (self.x[b], self.y[b])
        if ya == yb:
            side = math.copysign(0.5, xb - xa)
            return (xa + side * self.width[a], ya), (xb - side * self.width[b], yb)
        down = math.copysign(0.5, ya - yb)
        reach_a, reach_b, slant = 0.32 * self.width[a], 0.32 * self.width[b], 0.3 * (xb - xa)
        return ((xa + max(-reach_a, min(reach_a, slant)), ya - down * self.height[a]),
                (xb - max(-reach_b, min(reach_b, slant)), yb + down * self.height[b]))

    def behind(self, line, kind):
        """Whether a line runs behind a box, with some air around it."""
        (xa, ya), (xb, yb) = line
        half, low, high = self.width[kind] / 2 + 0.08, self.y[kind] - self.height[kind] / 2, self.y[kind] + self.height[kind] / 2
        if ya == yb:
            return ya == self.y[kind] and min(xa, xb) < self.x[kind] < max(xa, xb)
        if min(ya, yb) > low or max(ya, yb) < high:
            return False
        at = [xa + (xb - xa) * (y - ya) / (yb - ya) for y in (low, high)]
        return min(at) < self.x[kind] + half and max(at) > self.x[kind] - half

    def cost(self):
        lines = [self.line(a, b) for a, b in self.arrows]
        cost = sum(100 for arrow, line in zip(self.arrows, lines) for kind in self.x if kind not in arrow and self.behind(line, kind))
        cost += sum(8 * crosses(p, q) for i, p in enumerate(lines) for q in lines[:i])
        return cost + sum((p[0] - q[0]) ** 2 for p, q in lines) + sum(0.05 * x * x for x in self.x.values())

    def fits(self, floor):
        placed = sorted(floor, key=lambda kind: self.x[kind])
        return (all(self.x[b] - self.x[a] > (self.width[a] + self.width[b]) / 2 + 0.15 for a, b in zip(placed, placed[1:]))
                and all(abs(self.x[kind]) + self.width[kind] / 2 < self.HALF for kind in floor))

    def arrange(self, rounds=4, steps=12000):
        """Moves one box at a time, at first also for the worse: simulated annealing, which takes half a minute."""
        draw, best, least = random.Random(self.SEED), dict(self.x), math.inf
        for _ in range(rounds):
            heat, cost = 100.0, self.cost()
            for _ in range(steps):
                heat *= 0.9993
                floor = draw.choice(wall_test.FLOORS)
                before, kind = dict(self.x), draw.choice(floor)
                move = draw.random()
                if move < 0.3:
                    other = draw.choice(floor)
                    self.x[kind], self.x[other] = before[other], before[kind]
                elif move < 0.4:
                    self.x.update({each: -before[each] for each in floor})
                else:
                    self.x[kind] = round(self.x[kind] + draw.gauss(0, 1.2), 1)
                changed = self.cost() if self.fits(floor) else math.inf
                if changed < cost or draw.random() < math.exp((cost - changed) / heat):
                    cost = changed
                else:
                    self.x = before
                if cost < least:
                    best, least = dict(self.x), cost
        self.x = best


def crosses(p, q):
    """Whether two lines cross."""
    def side(line, point):
        (xa, ya), (xb, yb) = line
        return (xb - xa) * (point[1] - ya) - (yb - ya) * (point[0] - xa)
    return side(p, q[0]) * side(p, q[1]) < 0 and side(q, p[0]) * side(q, p[1]) < 0


def draw_rooms(axes, root):
    layout = Layout(reduced(edges(root)))
    for kind in wall_test.ORDER:
        box(axes, layout.x[kind], layout.y[kind], layout.width[kind], layout.height[kind], *names_of(kind, root), *colours(kind))
    for a, b in layout.arrows:
        up = wall_test.ORDER.index(a) < wall_test.ORDER.index(b)  # the test of the floors fails then
        arrow(axes, *layout.line(a, b), '#cc2222' if up else '#777777')
    axes.set_title('Rooms: an arrow is “includes”', loc='left', fontsize=11)
    axes.set(xlim=(-Layout.HALF, Layout.HALF), ylim=(-0.55, layout.top))
    return layout.top


def draw_datum(axes, top):
    step, height, width, plain = (top - 1.0) / (len(WAY) + 1), 1.0, 4.6, ('#f4f4f4', '#666666')
    ys = [top - 0.75 - i * step for i in range(len(WAY) + 2)]
    for x, (title, text) in zip((-1.2, 1.2), STARTS):
        box(axes, x, ys[0], 2.2, 0.8, title, text, *plain)
        arrow(axes, (x, ys[0] - 0.4), (x * 0.6, ys[1] + height / 2), '#333333')
    for y, (title, text) in zip(ys[1:], WAY):
        box(axes, 0, y, width, height, title, text, *plain)
    for above, below in zip(ys[1:], ys[2:-1]):
        arrow(axes, (0, above - height / 2), (0, below + height / 2), '#333333')
    for x, (title, text) in zip((-1.2, 1.2), ENDS):
        box(axes, x, ys[-1], 2.2, 0.8, title, text, *plain)
        arrow(axes, (x * 0.6, ys[-2] - height / 2), (x, ys[-1] + 0.4), '#333333')
    axes.set_title('The way of a datum', loc='left', fontsize=11)
    axes.set(xlim=(-2.5, 2.5), ylim=(-0.55, top))
    for i, (name, (fill, edge)) in enumerate((('no ROS, no GTSAM', CORE), ('may use GTSAM', GTSAM), ('may use ROS', ROS))):
        axes.add_patch(patches.Rectangle((-2.3 + 1.7 * i, -0.5), 0.22, 0.2, facecolor=fill, edgecolor=edge))
        axes.text(-2.0 + 1.7 * i, -0.4, name, va='center', fontsize=8)


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    root = pathlib.Path(sys.argv[1])
    figure, (rooms, datum) = plt.subplots(1, 2, figsize=(12, 11), width_ratios=[1.75, 1], layout='constrained')
    top = draw_rooms(rooms, root)
    draw_datum(datum, top)
    for axes in (rooms, datum):
        axes.axis('off')
    figure.savefig(sys.argv[2], dpi=110, metadata={'Software': None})


if __name__ == '__main__':
    main()
