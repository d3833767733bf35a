# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""The data of the plots: what the page's script draws."""
import math

from sas_motion_report.figures import CHI_SQUARE_95
from sas_motion_report.inputs import dig, finite

from ..particles import families
from ..units import factor, title

TIMES = ('time', 'weight_time', 'effective_time')


def page_data(summary, costs):
    """Returns the numbers of every campaign."""
    return {'runs': summary['runs'], 'families': families(summary['campaigns']), 'campaigns': {name: campaign_data(campaign, costs.get(name, {}), summary['runs'])
                                                   for name, campaign in summary['campaigns'].items()}}


def campaign_data(campaign, costs, runs):
    """Returns the numbers of one campaign, law by law."""
    group = campaign['groups'][0]
    laws = [{'name': name, 'epsilon': law.get('epsilon'), 'K': law.get('K'), 'bound': dig(law, 'bound', group, 'rmse'),
             'rms': {e: triple(law['estimators'][e]['errors'][group]['rms']) for e in campaign['estimators']},
             'nees': {e: triple(dig(law, 'estimators', e, 'nees', 'full')) for e in campaign['estimators']},
             'diverged': {e: law['estimators'][e]['diverged'] for e in campaign['estimators']},
             'locked_out': {e: law['estimators'][e]['locked_out'] or 0 for e in campaign['estimators']},
             'cost': {e: dig(costs, name, e) for e in campaign['estimators']}} for name, law in campaign['laws'].items()]
    return {'estimators': campaign['estimators'], 'group': group, 'laws': laws, 'skip': campaign['skip'], 'particles': campaign.get('particles'), 'nees_band': nees_band(campaign.get('dimension'), runs)}


def triple(found):
    """Returns [value, low, high], or None."""
    return [found['value'], found['low'], found['high']] if found and finite(found['value']) else None


def nees_band(dimension, runs):
    """Returns the 95 % band of the mean NEES over its degrees as if a run were one sample, the widest it can be; None without the degrees."""
    if not dimension:
        return None
    return [bound / (dimension * runs) for bound in chi_square_95(dimension * runs)]


def chi_square_95(degrees):
    """Returns the 2.5 % and 97.5 % quantiles of chi-square, by Wilson and Hilferty's cube beyond the table."""
    if degrees in CHI_SQUARE_95:
        return list(CHI_SQUARE_95[degrees])
    spread = 2 / (9 * degrees)
    return [degrees * (1 - spread + sign * 1.959964 * math.sqrt(spread)) ** 3 for sign in (-1, 1)]


def trace_data(trace):
    """Returns the series of the first seed: what a list holds to four digits, times to seven, bands in place of degrees."""
    return {campaign: {law: {name: series(columns) for name, columns in (estimators or {}).items()} for law, estimators in laws.items()}
            for campaign, laws in trace.items()}


def series(columns):
    """Returns one estimator's columns and the bands of its NEES and NIS, where their degrees are known."""
    found = {key: [shortened(x, 7 if key in TIMES else 4) for x in column] for key, column in columns.items() if isinstance(column, list) and key != 'others'}
    found['others'] = [{'title': title(other['group']), **{key: [shortened(scaled(x, other['group'])) for x in other[key]] for key in ('error', 'sigma3')}}
                       for other in columns.get('others') or []]
    for kind in ('nees', 'nis'):
        degrees = columns.get(f'{kind}_degrees')
        if isinstance(degrees, int) and degrees > 0:
            found[f'{kind}_band'] = [shortened(bound) for bound in chi_square_95(degrees)]
    return found


def scaled(x, group):
    """Returns an error of a group in its unit."""
    return factor(group) * x if finite(x) else None


def shortened(x, digits=4):
    """Returns a number of so many digits, a flag as it is, None for what is neither."""
    return x if isinstance(x, bool) else float(f'{x:.{digits}g}') if finite(x) else None
