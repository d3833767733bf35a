# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""The tables of the page."""
from html import escape

from .columns import ALIGNMENT, PAGE, best, number, outside, percent, quantity, text, value
from .inputs import SENSORS, dig, ranked

STATES = ('position', 'height', 'velocity', 'heading', 'tilt', 'speed', 'current')
CONSISTENCY = ('Means against their χ² bands. Above: the stated uncertainty is too small; below: too large. The bands suppose independent samples; '
               'errors that last, as those of position do, leave them sooner.')
VERDICTS = ('accepted', 'down_weighted', 'rejected', 'stale', 'invalid')


def table(caption, header, rows, name):
    """Returns an HTML table that scrolls by itself where the screen is narrow; the first cell of a row names it."""
    head = ''.join(f'<th scope="col">{title}</th>' for title in header)
    body = ''.join('<tr><th scope="row">' + row[0] + '</th>' + ''.join(map(cell, row[1:])) + '</tr>' for row in rows)
    return (f'<p class="note" id="{name}-note">{caption}</p><div class="scroll" tabindex="0" role="region" aria-labelledby="{name}-note">'
            f'<table id="{name}" aria-describedby="{name}-note"><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table></div>')


def cell(content):
    """Returns a table cell; a pair is (text, class)."""
    shown, kind = content if isinstance(content, tuple) else (content, '')
    return f'<td class="{kind}">{shown}</td>' if kind else f'<td>{shown}</td>'


def results(metrics):
    """Returns the table of all estimators, the best of each column marked."""
    columns = [c for c in PAGE if any(value(e, c) is not None for _, e in ranked(metrics))]
    header = ['estimator'] + [f'{c.title}<br><small>{c.unit}</small>' for c in columns]
    rows = [[escape(name)] + results_row(metrics, e, columns) for name, e in ranked(metrics)]
    alignment = ' aligned: when the heading came within 2° for good; particles: effective number, the median;' if set(columns) & set(ALIGNMENT) else ''
    caption = f'RMSE; 95th percentile and largest of the position error; drift: error at the end over distance;{alignment} <span class="best">best</span> in bold.'
    return table(caption, header, rows, 'results')


def results_row(metrics, estimator, columns):
    """Returns the cells of one estimator."""
    if estimator.get('diverged'):
        return [('diverged', 'bad')] + ['–'] * (len(columns) - 1)
    shown = [(text(estimator, c, '–'), value(estimator, c), c) for c in columns]
    return [(cell_text, 'best') if v is not None and v == best(metrics, c) else cell_text for cell_text, v, c in shown]


def consistency(metrics):
    """Returns the table of NEES and NIS means beside their bands."""
    rows = []
    for name, e in ranked(metrics):
        bands = [('NEES', g, dig(e, 'nees', g)) for g in STATES] + [('NIS', g, dig(e, 'nis', g)) for g in SENSORS]
        rows += [[escape(name), f'{kind} {group}'] + band_cells(band) for kind, group, band in bands if band]
    header = ['estimator', 'of', 'mean', 'expected', '95 % band', 'inside, %', 'reading']
    return table(CONSISTENCY, header, rows, 'consistency') if rows else ''


def band_cells(band):
    """Returns mean, degrees, band, fraction inside and what it means."""
    reading = {None: '–', 0: 'consistent', 1: ('▲ over-confident', 'bad'), -1: ('▼ cautious', 'warn')}[outside(band)]
    mean = number(band.get('mean'))
    span = f'{number(band.get("lower"))} to {number(band.get("upper"))}'
    return [(mean, reading[1]) if isinstance(reading, tuple) else mean, number(band.get('degrees')).split('.')[0], span, percent(band.get('inside')), reading]


def outliers(metrics):
    """Returns the table of labelled and flagged measurements, sensor by sensor."""
    rows = []
    for name, e in ranked(metrics):
        tallies = [(group, dig(e, 'outliers', group)) for group in (*SENSORS, 'all')]
        rows += [[escape(name), group, *(str(t.get(k, '–')) for k in ('labelled', 'flagged', 'hits')), percent(t.get('precision')), percent(t.get('recall'))]
                 for group, t in tallies if t]
    header = ['estimator', 'sensor', 'labelled', 'set aside', 'of these outliers', 'precision, %', 'recall, %']
    return table('A measurement is set aside when it is rejected or its weight is below one half.', header, rows, 'outliers') if rows else ''


def verdicts(metrics):
    """Returns the table of what became of the measurements."""
    rows = [[escape(name)] + [str(dig(e, 'verdicts', k) if dig(e, 'verdicts', k) is not None else '–') for k in VERDICTS]
            for name, e in ranked(metrics) if e.get('verdicts')]
    return table('What became of the measurements, counted.', ['estimator'] + [k.replace('_', '-') for k in VERDICTS], rows, 'verdicts') if rows else ''


def outages(metrics):
    """Returns the table of position outages, earliest first."""
    found = sorted((o.get('begin') or 0, i, name, o) for i, (name, e) in enumerate(ranked(metrics)) for o in e.get('outages') or [])
    keys = ('begin', 'duration', 'distance', 'error_end', 'drift_percent')
    rows = [[escape(name)] + [(quantity if key in keys[:2] else number)(o.get(key)) for key in keys] for _, _, name, o in found]
    header = ['estimator', 'begin<br><small>s</small>', 'duration<br><small>s</small>', 'distance<br><small>m</small>',
              'error at the end<br><small>m</small>', 'drift<br><small>%</small>']
    return table('Spans without a position fix.', header, rows, 'outages') if rows else ''
