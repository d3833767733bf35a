#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""Draws README's picture from a comparison's series.json. usage: plot_picture.py COMPARE_DIR OUT.png"""
import json
import sys

import matplotlib
matplotlib.use('Agg')
import matplotlib.pyplot as plt
import numpy as np

STYLE = {'kf': ('#999999', 'Kalman filter'), 'mixture_kf': ('#0a66c2', 'robust filter (mixture_kf)'), 'fixed_lag': ('#1a9850', 'factor-graph smoother, 10 s lag'),
         'batch': ('#d95f02', 'factor-graph smoother, whole bag')}


def main():
    with open(sys.argv[1] + '/series.json', encoding='utf-8') as file:
        series = json.load(file)
    figure, (track, error) = plt.subplots(1, 2, figsize=(11, 4.4), width_ratios=[1, 1.5], layout='constrained')
    fixes = {k: np.array(v, dtype=float) for k, v in series['fixes'].items()}
    bad = fixes['outlier'] > 0
    track.plot(fixes['east'][~bad], fixes['north'][~bad], '.', ms=2, color='#bbbbbb', label='fixes')
    track.plot(fixes['east'][bad], fixes['north'][bad], 'x', ms=4, color='#d62728', label='outliers among them')
    track.plot(series['truth']['east'], series['truth']['north'], 'k', lw=0.8, label='truth')
    for name, (color, label) in STYLE.items():
        if name not in series['estimators']:
            continue
        s = series['estimators'][name]
        size = np.hypot(s['error_north'], s['error_east'])
        error.semilogy(s['t'], size, color=color, lw=0.9, label=f'{label}: {np.sqrt(np.mean(size ** 2)):.2f} m RMS')
        if name in ('kf', 'mixture_kf'):
            track.plot(s['east'], s['north'], color=color, lw=0.8)
    track.set(xlabel='east [m]', ylabel='north [m]', aspect='equal')
    error.set(xlabel='time [s]', ylabel='horizontal error [m]', ylim=(0.01, 30))
    for axes in (track, error):
        axes.legend(fontsize=7, loc='upper right')
        axes.grid(alpha=0.3)
    figure.savefig(sys.argv[2], dpi=110)


if __name__ == '__main__':
    main()
