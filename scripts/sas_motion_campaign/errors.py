# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""What estimators are wrong by, group by group: a row an estimator, with what it takes to converge and to compute."""
from sas_motion_report.columns import number
from sas_motion_report.inputs import dig

from .units import factor, ordered, title

CAPTION = ('Errors: RMS over the runs. Drift: horizontal error at the end over the way. Aperture: within one synthetic aperture, without mean and trend. '
           'Converged: runs that came near the truth to stay; after: median / 90 % quantile over all runs, – where that many never did. '
           'Particles: effective over all, median over a run.')


def error_rows(campaign, law, costs):
    """Returns the titles and a row an estimator, the bound last; a column that nobody fills is left out. Empty for a single group, which stands elsewhere."""
    groups = ordered(campaign['groups'])
    if len(groups) < 2:
        return []
    rows = [[name, *cells(campaign, groups, law['estimators'][name], dig(costs, name))] for name in campaign['estimators']]
    if law['bound']:
        rows.append(['bound', *(value(dig(law['bound'], group, 'rmse'), group) for group in groups), *['-'] * len(FURTHER)])
    return filled([['estimator', *map(title, groups), *FURTHER], *rows])


FURTHER = ('aperture [mm]', 'aperture [λ]', 'NEES/n', 'converged', 'after [s]', 'particles [%]', 'us/update')


def cells(campaign, groups, found, cost):
    """Returns the cells of one estimator."""
    errors = [value(dig(found['errors'], group, 'rms', 'value'), group) for group in groups]
    aperture, wavelengths, size = (dig(found, key, 'value') for key in ('aperture_across', 'aperture_wavelengths', 'effective_size'))
    share = None if size is None or not campaign.get('particles') else 100 * size / campaign['particles']
    return [*errors, number(None if aperture is None else 1e3 * aperture, '-'), number(wavelengths, '-'), number(dig(found, 'nees', 'full', 'value'), '-'),
            *converged(found.get('convergence')), number(share, '-'), number(cost, '-')]


def value(error, group):
    """Returns an error in the group's unit."""
    return number(None if error is None else factor(group) * error, '-')


def converged(found):
    """Returns the cells of how many converged, and after how long."""
    if not found:
        return ['-', '-']
    return [f'{found["converged"]} of {found["runs"]}', ' / '.join('–' if found[key] is None else f'{found[key]:.0f}' for key in ('median', 'q90'))]


def filled(rows):
    """Returns the columns that somebody fills."""
    shown = [i for i in range(len(rows[0])) if any(row[i] != '-' for row in rows[1:])]
    return [[row[i] for i in shown] for row in rows]
