# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""The results as plain text for a terminal."""
from sas_motion_report.inputs import dig

from . import errors, particles
from .images import CAPTION, COSTS_CAPTION, cost_rows, image_rows

HEADER = ('estimator', 'RMSE', '95 %', 'median', 'R', '/kf', '/oracle', '/reference', '/ckf', '/oracle', '/bound', '95 %', 'aperture [mm]', 'NEES/n', 'diverged', 'us/update')

LARGE = 1e7  # no longer written out
UNITS = {'position': ' [m]', 'mounting': ' [rad]'}


def terminal_table(summary, costs):
    """Returns a table a law, the laws of all campaigns one after another."""
    lines = []
    for name, campaign in summary['campaigns'].items():
        last = summary['first_seed'] + summary['runs'] - 1
        lines += [f'{summary["suite"]}, {name} ({campaign["system"]}): {summary["runs"]} runs of {campaign["duration"]:g} s, '
                  f'first {campaign["skip"]:g} s not scored, seeds {summary["first_seed"]} to {last}', '']
        for law, found in campaign['laws'].items():
            rows = [header(campaign)] + [row(campaign, estimator, found['estimators'][estimator], dig(costs, name, law, estimator)) for estimator in campaign['estimators']]
            lines += [law, *aligned(rows), '']
        lines += error_tables(campaign, dig(costs, name)) + image_tables(campaign)
    lines += particle_tables(summary['campaigns'], costs)
    return '\n'.join(lines + [LEGEND, errors.CAPTION])


def error_tables(campaign, costs):
    """Returns the tables of all groups of errors, a law each; empty where there is one group alone."""
    lines = []
    for law, found in campaign['laws'].items():
        rows = errors.error_rows(campaign, found, dig(costs, law))
        lines += [f'{law}: errors', *aligned(rows), ''] if rows else []
    return lines


def particle_tables(campaigns, costs):
    """Returns the tables over the number of particles; empty where no campaigns differ in it alone."""
    lines = []
    for family in particles.families(campaigns):
        for law in campaigns[family[0]]['laws']:
            lines += [f'{family[0]} to {family[-1]}, {law}: {particles.CAPTION}', '', *aligned(particles.particle_rows(campaigns, family, law, costs)), '']
    return lines


def image_tables(campaign):
    """Returns the tables of images, a law each, and of what an aperture error costs; empty without images."""
    lines = []
    for law, found in campaign['laws'].items():
        rows = image_rows(found, campaign['estimators'])
        lines += [f'{law}: images', *aligned(rows), ''] if rows else []
    costs = cost_rows(campaign)
    return lines + [CAPTION, '', *aligned(costs), COSTS_CAPTION, ''] if costs else lines


LEGEND = ('RMSE: RMS over the runs, of the first group of errors (position, mounting angles); R: over the same estimator under the first law; /reference: bayes_reference;\n'
          '/bound: posterior Cramér-Rao bound; 95 %: bootstrap over the runs, of the column to its left; NEES/n: expected 1. Diverged runs are counted only.')


def header(campaign):
    """Returns the titles, with the unit where it is known."""
    unit = UNITS.get(campaign['groups'][0], '')
    return tuple(title + unit if title in ('RMSE', 'median') else title for title in HEADER)


def row(campaign, name, found, cost):
    """Returns the cells of one estimator."""
    error, ratios = found['errors'][campaign['groups'][0]], found['ratios']
    ratio = [fixed(dig(ratios, key, 'value'), 3) for key in ('clean', 'kf', 'oracle_kf', 'bayes_reference', 'ckf', 'oracle_ckf', 'bound')]
    aperture = dig(found, 'aperture_across', 'value')
    return (name, fixed(dig(error, 'rms', 'value'), 4), span(error.get('rms'), 4), fixed(dig(error, 'median', 'value'), 4), *ratio, span(ratios.get('bound'), 3),
            fixed(None if aperture is None else 1e3 * aperture, 2), fixed(dig(found, 'nees', 'full', 'value'), 2), str(found['diverged']), fixed(cost, 2))


def fixed(x, digits):
    """Returns a number with so many decimals, a very large one by its exponent."""
    return '-' if x is None else f'{x:.{digits}f}' if abs(x) < LARGE else f'{x:.1e}'


def span(found, digits):
    """Returns an interval as low..high."""
    return '-' if found is None or found.get('low') is None else f'{found["low"]:.{digits}f}..{found["high"]:.{digits}f}'


def aligned(rows):
    """Returns the rows as lines: the name to the left, numbers to the right; a column that nobody fills is left out."""
    shown = [i for i in range(len(rows[0])) if any(row[i] != '-' for row in rows[1:])]
    widths = {i: max(len(row[i]) for row in rows) for i in shown}
    return ['  '.join(row[i].ljust(widths[i]) if i == 0 else row[i].rjust(widths[i]) for i in shown).rstrip() for row in rows]
