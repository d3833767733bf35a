# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""Campaigns that are alike but for the number of particles: what more of them are worth and cost."""
from sas_motion_report.inputs import dig

from .errors import cells, filled, FURTHER
from .units import ordered, title

CAPTION = 'by the number of particles, campaigns that are alike in all else'
ALIKE = ('system', 'duration', 'skip', 'dimension', 'estimators', 'groups')


def families(campaigns):
    """Returns the names of such campaigns, a list each of two and more, the fewest particles first."""
    found = {}
    for name, campaign in campaigns.items():
        if campaign.get('particles'):
            laws = [(law, tree['description']) for law, tree in campaign['laws'].items()]
            found.setdefault(repr([campaign[key] for key in ALIKE] + laws), {}).setdefault(campaign['particles'], name)
    return [[names[count] for count in sorted(names)] for names in found.values() if len(names) > 1]


def particle_rows(campaigns, family, law, costs):
    """Returns the titles and a row an estimator that has particles, and number of them."""
    first = campaigns[family[0]]
    groups = ordered(first['groups'])
    rows = [[estimator, str(campaigns[name]['particles']),
             *cells(campaigns[name], groups, campaigns[name]['laws'][law]['estimators'][estimator], dig(costs, name, law, estimator))]
            for estimator in first['estimators'] if 'effective_size' in first['laws'][law]['estimators'][estimator] for name in family]
    return filled([['estimator', 'of particles', *map(title, groups), *FURTHER], *rows])
