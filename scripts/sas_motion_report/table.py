# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""The results as plain text for a terminal of 120 columns."""
from .columns import CONSISTENCY, NIS_GPS, OUTLIERS, best, outside, percent, quantity, terminal_columns, text, value
from .inputs import dig, ranked

NAME_WIDTH = 18


def terminal_table(metrics):
    """Returns the results table: a headline, two header lines, one line an estimator, a legend."""
    columns = terminal_columns(metrics)
    titles = ['estimator'] + [column.title for column in columns]
    units = ['RMSE first'] + [column.unit for column in columns]
    rows = [titles, units] + [text_row(metrics, name, estimator, columns) for name, estimator in ranked(metrics)]
    widths = [max(len(row[i]) for row in rows) for i in range(len(titles))]
    lines = [join(row, widths) for row in rows]
    lines.insert(2, '-' * len(lines[0]))
    return '\n'.join([summary(metrics), ''] + lines + ['', legend(metrics)])


def join(row, widths):
    """Returns the cells aligned: the name to the left, numbers to the right."""
    cells = [row[0].ljust(widths[0])] + [cell.rjust(width) for cell, width in zip(row[1:], widths[1:])]
    return ' '.join(cells).rstrip()


def text_row(metrics, name, estimator, columns):
    """Returns the cells of one estimator."""
    shown = name if len(name) <= NAME_WIDTH else name[:NAME_WIDTH - 1] + '~'
    if estimator.get('diverged'):
        return [shown, 'diverged'] + [''] * (len(columns) - 1)
    return [shown] + [text_cell(metrics, estimator, column) for column in columns]


def text_cell(metrics, estimator, column):
    """Returns one value with the mark of the best (*) or of a mean outside its band (!)."""
    x = value(estimator, column)
    if column in OUTLIERS:
        return percent(dig(estimator, *column.path), '-') + ' '
    is_best = x is not None and x == best(metrics, column)
    is_outside = column in (*CONSISTENCY, NIS_GPS) and outside(dig(estimator, *column.path[:-1]))
    return text(estimator, column, '-') + ('*' if is_best else '!' if is_outside else ' ')


def summary(metrics):
    """Returns what was scored: bag, length, truth."""
    parts = [str(metrics.get('bag', 'bag'))]
    parts += [f'{quantity(metrics.get(key), "?")} {unit}' for key, unit in (('duration', 's'), ('distance', 'm'))]
    return f'{", ".join(parts)}; truth {metrics.get("truth", "unknown")}; first {quantity(metrics.get("skipped"), "0")} s not scored'


def legend(metrics):
    """Returns what the marks and columns mean."""
    times = [dig(e, 'aperture', 'time') for _, e in ranked(metrics)]
    aperture = next((f' ({quantity(t)} s)' for t in times if t), '')
    return ('* best, ! mean outside its 95 % band; position, heading, current: RMSE; NEES, NIS: expected 2 for position, 3 for gps;\n'
            f'aperture: RMS across track within one synthetic aperture{aperture}, mean and trend removed')
