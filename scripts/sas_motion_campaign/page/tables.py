# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""The tables of the page, one set a campaign."""
from html import escape

from sas_motion_report.columns import number
from sas_motion_report.inputs import dig, finite
from sas_motion_report.tables import table

from .. import errors, particles
from ..images import CAPTION, COSTS_CAPTION, cost_rows, image_rows
from .reference import NAMES, contenders, ranked, reference

RATIOS = (('clean', 'R'), ('kf', '/ kf'), ('oracle_kf', '/ oracle_kf'), ('bayes_reference', '/ bayes_reference'), ('ckf', '/ ckf'), ('oracle_ckf', '/ oracle_ckf'), ('bound', '/ bound'))


def campaign_tables(campaign, costs, name):
    """Returns the tables of one campaign; `name` makes their ids unique."""
    return overview(campaign, name) + images(campaign, name) + failures(campaign, name) + details(campaign, costs, name)


def particle_tables(campaigns, costs, name, identity):
    """Returns the tables over the number of particles of the family that a campaign belongs to; empty where it has none."""
    family = next((family for family in particles.families(campaigns) if name in family), None)
    return ''.join(plain(f'{escape(law)}: {particles.CAPTION}', particles.particle_rows(campaigns, family, law, costs), f'{identity}-particles-{i}')
                   for i, law in enumerate(campaigns[name]['laws'])) if family else ''


def plain(caption, rows, name):
    """Returns a table of cells as they are, the titles first; empty without rows."""
    return table(caption, map(escape, rows[0]), [[escape(cell) for cell in row] for row in rows[1:]], name) if rows else ''


def images(campaign, name):
    """Returns the tables of images, a law each, and of what an aperture error costs; empty without images."""
    tables = [(f'{escape(law)}: {CAPTION}', image_rows(found, campaign['estimators'])) for law, found in campaign['laws'].items()] + [(COSTS_CAPTION, cost_rows(campaign))]
    return ''.join(plain(caption, rows, f'{name}-images-{i}') for i, (caption, rows) in enumerate(tables))


def overview(campaign, name):
    """Returns the table of ratios to the reference: estimators by laws, the best contender of a law marked."""
    key = reference(campaign)
    best = {law: next((n for n in ranked(campaign, tree) if n in contenders(campaign)), None) for law, tree in campaign['laws'].items()}
    rows = [[escape(estimator)] + [with_interval(dig(tree, 'estimators', estimator, 'ratios', key), 'best' if best[law] == estimator else '', 2)
                                   for law, tree in campaign['laws'].items()] for estimator in campaign['estimators']]
    caption = f'RMS error over that of {NAMES[key]}, with 95 % intervals. <span class="best">Best</span> estimator, oracles excluded, in bold.'
    return table(caption, ['estimator'] + [escape(law) for law in campaign['laws']], rows, f'{name}-overview')


def with_interval(found, kind, digits):
    """Returns a cell: the value and its interval."""
    if not found or not finite(found['value']):
        return '–'
    low, high = found['low'], found['high']
    more = f' <small>{low:.{digits}f} to {high:.{digits}f}</small>' if finite(low) and finite(high) else ''
    return f'{found["value"]:.{digits}f}{more}', kind


def failures(campaign, name):
    """Returns the table of diverged and locked-out runs, or a sentence where there are none."""
    rows = []
    for estimator in campaign['estimators']:
        trees = [tree['estimators'][estimator] for tree in campaign['laws'].values()]
        if any(tree['diverged'] or tree['locked_out'] for tree in trees):
            rows.append([escape(estimator)] + [lost(tree) for tree in trees])
    if not rows:
        return '<p class="note">No run diverged and none locked out.</p>'
    caption = ('Failed runs, of all: diverged (error over 50 times the clean median, or not finite; left out of every mean) '
               'and locked out (a position wrong by more than five of its own standard deviations for more than five epochs; '
               'of a calibration, an unknown at the end).')
    return table(caption, ['estimator'] + [escape(law) for law in campaign['laws']], rows, f'{name}-failures')


def lost(tree):
    """Returns the cell of failed runs."""
    parts = [f'{tree[key]} {word}' for key, word in (('diverged', 'diverged'), ('locked_out', 'locked out')) if tree[key]]
    return (f'{", ".join(parts)} <small>of {tree["runs"]}</small>', 'bad') if parts else '0'


def details(campaign, costs, name):
    """Returns the ranking and all errors of every law, folded up."""
    return ''.join(f'<details><summary>Ranking and errors under {escape(law)}{note(law, tree)}</summary>{ranking(campaign, tree, dig(costs, law), f"{name}-ranking-{i}")}'
                   f'{plain(errors.CAPTION, errors.error_rows(campaign, tree, dig(costs, law)), f"{name}-errors-{i}")}</details>'
                   for i, (law, tree) in enumerate(campaign['laws'].items()))


def note(law, tree):
    """Returns a law's description, where it has more than the name."""
    return f' <small>{escape(tree["description"])}</small>' if tree.get('description') not in (None, '', law) else ''


def ranking(campaign, law, costs, name):
    """Returns the table of one law, the best first; estimators whose interval reaches that of the best are marked."""
    group = campaign['groups'][0]
    ratios = [(key, title) for key, title in RATIOS if any(dig(law, 'estimators', n, 'ratios', key) for n in campaign['estimators'])]
    header = ['estimator', f'{escape(group)} RMS', 'median', *(title for _, title in ratios), 'aperture<br><small>mm</small>', 'NEES/n', 'failed', 'µs/update']
    rows = [ranking_row(law['estimators'][n], n, group, ratios, dig(costs, n)) for n in ranked(campaign, law)]
    caption = f'Least {escape(group)} error first; intervals of 95 %. =: not told from the best by its interval.'
    return table(caption, header, rows, name)


def ranking_row(found, name, group, ratios, cost):
    """Returns the cells of one estimator."""
    best, aperture, nees = found['ratios'].get('best'), dig(found, 'aperture_across', 'value'), dig(found, 'nees', 'full', 'value')
    tied = best and finite(best['low']) and best['low'] <= 1 <= best['high']
    cells = [with_interval(found['errors'][group][key], '', 3) for key in ('rms', 'median')]
    cells += [with_interval(found['ratios'].get(key), '', 3) for key, _ in ratios]
    failed = found['diverged'] + (found['locked_out'] or 0)
    return [escape(name) + (' =' if tied else '')] + cells + [number(1e3 * aperture) if finite(aperture) else '–', number(nees),
                                                              (str(failed), 'bad') if failed else '0', number(cost)]
