# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""What estimators are compared with: the best that could be done."""
import math
import statistics

from sas_motion_report.inputs import dig, finite

from ..ratios import informed

REFERENCES = ('bayes_reference', 'bound', 'oracle_kf', 'oracle_ckf', 'best')
NAMES = {'bayes_reference': 'bayes_reference (knows the law)', 'bound': 'the Cramér-Rao bound',
         'oracle_kf': 'oracle_kf (knows the outliers)', 'oracle_ckf': 'oracle_ckf (knows the outliers)',
         'best': 'the best'}


def reference(campaign):
    """Returns the first of REFERENCES that the campaign has."""
    return next(key for key in REFERENCES if key == 'best' or any(ratio(law, name, key) for law, name in pairs(campaign)))


def pairs(campaign):
    """Returns (law, estimator) of a campaign."""
    return [(law, name) for law in campaign['laws'].values() for name in campaign['estimators']]


def ratio(law, name, key):
    """Returns an estimator's RMS error over a reference's, or None."""
    value = dig(law, 'estimators', name, 'ratios', key, 'value')
    return value if finite(value) else None


def ranked(campaign, law):
    """Returns the estimators of a law, the least RMS error first, those that lost more runs behind."""
    def order(name):
        found = law['estimators'][name]
        rms = dig(found, 'errors', campaign['groups'][0], 'rms', 'value')
        return found['diverged'], rms if finite(rms) else math.inf, name
    return sorted(campaign['estimators'], key=order)


def contenders(campaign):
    """Returns the estimators without the oracles; all of them where none is left."""
    return [name for name in campaign['estimators'] if not informed(name)] or campaign['estimators']


def nearest(campaign):
    """Returns [(estimator, laws in which it is the nearest, {law: ratio to the reference})], the most often nearest first."""
    key, names = reference(campaign), contenders(campaign)
    first = [next(name for name in ranked(campaign, law) if name in names) for law in campaign['laws'].values()]
    found = []
    for name in names:
        known = {law: ratio(tree, name, key) for law, tree in campaign['laws'].items()}
        found.append((name, first.count(name), {law: value for law, value in known.items() if value}))
    return sorted(found, key=lambda item: (-item[1], middle(item[2]), item[0]))


def middle(ratios):
    """Returns the median ratio, infinite where there is none."""
    return statistics.median(ratios.values()) if ratios else math.inf
