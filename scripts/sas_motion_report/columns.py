# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""The columns of the results table, shared by the terminal and the page."""
import math
from collections import namedtuple

from .inputs import dig, finite, ranked

# title, unit, where the value is, factor to the unit, whether the least value is the best
Column = namedtuple('Column', 'title unit path factor least_is_best')

RMSE = [
    Column('position', 'm', ('position', 'rmse'), 1, True),
    Column('p95', 'm', ('position', 'p95'), 1, True),
    Column('max', 'm', ('position', 'max'), 1, True),
    Column('heading', 'deg', ('heading_deg', 'rmse'), 1, True),
]
CURRENT = Column('current', 'm/s', ('current', 'rmse'), 1, True)
DRIFT = Column('drift', '%', ('drift_percent',), 1, True)
CONSISTENCY = [
    Column('NEES', 'pos', ('nees', 'position', 'mean'), 1, False),
    Column('NIS', 'pos', ('nis', 'position', 'mean'), 1, False),
]
OUTLIERS = [
    Column('precision', '%', ('outliers', 'all', 'precision'), 100, False),
    Column('recall', '%', ('outliers', 'all', 'recall'), 100, False),
]
COST = Column('cost', 'us/update', ('cost', 'microseconds_per_update'), 1, True)

# of estimators in six degrees of freedom
MOTION = [
    Column('height', 'm', ('height', 'rmse'), 1, True),
    Column('velocity', 'm/s', ('velocity', 'rmse'), 1, True),
    Column('tilt', 'deg', ('tilt_deg', 'rmse'), 1, True),
]
ALIGNMENT = [
    Column('aligned', 's', ('alignment', 'after'), 1, True),
    Column('particles', 'eff.', ('effective_particles',), 1, False),
]
NIS_GPS = Column('NIS', 'gps', ('nis', 'gps', 'mean'), 1, False)

TERMINAL = [*RMSE, CURRENT, DRIFT, Column('aperture', 'm', ('aperture', 'across'), 1, True), *CONSISTENCY, *OUTLIERS, COST]
PAGE = [
    *RMSE, *MOTION, *ALIGNMENT, Column('speed', 'm/s', ('speed', 'rmse'), 1, True), CURRENT, DRIFT,
    Column('aperture, across', 'mm', ('aperture', 'across'), 1e3, True), Column('along', 'mm', ('aperture', 'along'), 1e3, True),
    Column('across', 'λ', ('aperture', 'across_wavelengths'), 1, True), COST._replace(unit='µs/update'),
]


def terminal_columns(metrics):
    """Returns the columns of the terminal's table: in six degrees of freedom others are of interest than of a towfish."""
    if not any(value(e, c) is not None for _, e in ranked(metrics) for c in MOTION):
        return TERMINAL
    rest = [NIS_GPS if c.title == 'NIS' else c for c in TERMINAL if c not in RMSE and c != CURRENT]
    alignment = [c for c in ALIGNMENT if any(value(e, c) is not None for _, e in ranked(metrics))]
    return [*RMSE, *MOTION, *alignment, *rest]


def value(estimator, column):
    """Returns the value of a column in its unit, or None."""
    raw = dig(estimator, *column.path)
    return raw * column.factor if finite(raw) else None


def text(estimator, column, missing):
    """Returns the value of a column as it is shown; a heading that never came right says so."""
    never = column.path == ('alignment', 'after') and dig(estimator, 'alignment', 'within_deg') is not None
    return number(value(estimator, column), 'never' if never else missing)


def best(metrics, column):
    """Returns the least value among the estimators that did not diverge, or None when there is nothing to compare."""
    values = [value(e, column) for _, e in ranked(metrics) if not e.get('diverged')]
    values = [v for v in values if v is not None]
    return min(values) if column.least_is_best and len(values) > 1 else None


def outside(band):
    """Returns +1 when a mean lies above its band (over-confident), -1 below (cautious), 0 inside, None when unknown."""
    mean, lower, upper = (dig(band, key) for key in ('mean', 'lower', 'upper'))
    if not all(finite(v) for v in (mean, lower, upper)):
        return None
    return (mean > upper) - (mean < lower)


def number(x, missing='–'):
    """Returns a number with three significant digits."""
    if not finite(x):
        return missing
    if x == 0:
        return '0'
    exponent = math.floor(math.log10(abs(x)))
    if not -5 <= exponent <= 6:
        return f'{x:.2e}'
    return f'{x:.{min(6, max(0, 2 - exponent))}f}'


def quantity(x, missing='–'):
    """Returns a number without the zeros that a chosen value does not need: 20, 2.1, 1204."""
    return f'{x:.4g}' if finite(x) and abs(x) < 1e4 else number(x, missing)


def percent(fraction, missing='–'):
    """Returns a fraction as percent, 0.5 short of 100 is still shown as less."""
    if not finite(fraction):
        return missing
    return f'{100 * fraction:.0f}' if 0.005 <= fraction <= 0.99 or fraction in (0, 1) else f'{100 * fraction:.1f}'
