# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""The data of the plots: rounded, thinned, and small enough to carry in the page."""
from .inputs import SENSORS, dig, finite, ranked

LIMIT = 1500  # markers a trace
# 2.5 % and 97.5 % quantiles of chi-square, by degrees of freedom
CHI_SQUARE_95 = {1: (0.000982, 5.024), 2: (0.0506, 7.378), 3: (0.216, 9.348), 4: (0.484, 11.14), 5: (0.831, 12.83), 6: (1.237, 14.45)}
DEGREES = {'position': 2, 'heading': 1, 'speed': 1, 'gps': 3, 'dvl': 3, 'depth': 1}


def figure_data(metrics, series):
    """Returns the object that the page's script draws."""
    names = [name for name, _ in ranked(metrics)]
    fixes = rounded(series.get('fixes') or {})
    drawn = {name: estimator_data(series['estimators'][name], fixes) for name in names if name in series['estimators']}
    return {'order': list(drawn), 'skipped': metrics.get('skipped') or 0, 'duration': metrics.get('duration'), 'truth': rounded(series.get('truth') or {}),
            'fixes': fixes, 'estimators': drawn, 'bands': bands(metrics), 'particles': any(e.get('effective_particles') for _, e in ranked(metrics)),
            'cost': cost(metrics), 'outages': outage_spans(metrics),
            'diverged': [name for name, e in ranked(metrics) if e.get('diverged')]}


def estimator_data(series, fixes):
    """Returns one estimator's lines, updates, and what it made of each fix."""
    updates = {sensor: rounded(dig(series, 'updates', sensor)) for sensor in SENSORS if dig(series, 'updates', sensor, 't')}
    data = rounded({key: column for key, column in series.items() if isinstance(column, list)})
    data['fates'] = fates(fixes, updates.get('position') or updates.get('gps', {}))
    data['updates'] = {sensor: thinned(columns) for sensor, columns in updates.items()}
    return data


def fates(fixes, updates):
    """Returns for each fix: 0 kept or unknown, 1 set aside (weight below 0.5), 2 an outlier by its label that was kept."""
    weights = dict(zip((round(t, 2) for t in updates.get('t', [])), updates.get('weight', [])))
    labels = fixes.get('outlier') or [None] * len(fixes.get('t', []))
    return [fate(weights.get(round(t, 2)), label) for t, label in zip(fixes.get('t', []), labels)]


def fate(weight, label):
    """Returns what became of one fix."""
    if weight is None:
        return 0
    return 1 if weight < 0.5 else 2 if label else 0


def thinned(columns):
    """Returns the updates with at most about LIMIT of weight 0.5 and more; those below are all kept."""
    weights = columns.get('weight') or [1] * len(columns['t'])
    stride = -(-len(weights) // LIMIT)
    keep = [i for i, w in enumerate(weights) if i % stride == 0 or (w is not None and w < 0.5)]
    return {**{key: [column[i] for i in keep] for key, column in columns.items() if column}, 'stride': stride}


def rounded(columns):
    """Returns the columns with six significant digits, times to 1 ms, what is not finite as None."""
    def shorten(key, x):
        return None if not finite(x) else round(x, 3) if key in ('t', 'north', 'east') else float(f'{x:.6g}')
    return {key: [shorten(key, x) for x in column] for key, column in columns.items()}


def bands(metrics):
    """Returns the 95 % band of one NIS value for each sensor."""
    found = dict(DEGREES)
    for _, e in ranked(metrics):
        found.update({s: dig(e, 'nis', s, 'degrees') for s in SENSORS if dig(e, 'nis', s, 'degrees') in CHI_SQUARE_95})
    return {sensor: CHI_SQUARE_95[degrees] for sensor, degrees in found.items()}


def cost(metrics):
    """Returns [name, microseconds per update, position RMSE in metres] where all are known."""
    points = [[name, dig(e, 'cost', 'microseconds_per_update'), dig(e, 'position', 'rmse')] for name, e in ranked(metrics) if not e.get('diverged')]
    return [p for p in points if finite(p[1]) and finite(p[2]) and p[1] > 0 and p[2] > 0]


def outage_spans(metrics):
    """Returns the [begin, end] of the outages in seconds, each once."""
    spans = {(o['begin'], o['begin'] + o['duration']) for _, e in ranked(metrics) for o in e.get('outages') or []
             if finite(o.get('begin')) and finite(o.get('duration'))}
    return sorted(spans)
