# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""What the runs cost: measured, so never the same twice, and therefore in a file of its own."""
import json
import os
import statistics

SCHEMA = 'sas_motion/costs/1'


def render_costs(plan, records):
    """Returns costs.json: microseconds an update, the median and each run's, by campaign, law and estimator."""
    campaigns = {}
    for campaign in plan.campaigns:
        laws = campaigns[campaign['name']] = {}
        for law in campaign['laws']:
            runs = [records[campaign['name'], law['name'], seed]['cost'] or {} for seed in plan.seeds()]
            laws[law['name']] = {name: spread([run.get(name) for run in runs]) for name in campaign['estimators']}
    return json.dumps({'schema': SCHEMA, 'unit': 'us/update', 'first_seed': plan.first_seed, 'campaigns': campaigns}) + '\n'


def spread(values):
    """Returns the median and the values, rounded to what a clock can tell."""
    values = [None if v is None else round(v, 4) for v in values]
    known = [v for v in values if v is not None]
    return {'median': statistics.median(known) if known else None, 'runs': values}


def costs_by_key(path):
    """Returns {(campaign, law, seed): {estimator: cost}} of an earlier costs.json; empty where there is none to use."""
    try:
        with open(path, encoding='utf-8') as file:
            tree = json.load(file)
        found = {}
        for campaign, laws in tree['campaigns'].items():
            for law, estimators in laws.items():
                for name, cost in estimators.items():
                    for run, value in enumerate(cost['runs']):
                        found.setdefault((campaign, law, tree['first_seed'] + run), {})[name] = value
        return found
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        return {}


def medians(path):
    """Returns {campaign: {law: {estimator: microseconds an update}}}; empty where there is no costs.json."""
    if not os.path.exists(path):
        return {}
    with open(path, encoding='utf-8') as file:
        tree = json.load(file)
    return {campaign: {law: {name: cost['median'] for name, cost in estimators.items()} for law, estimators in laws.items()}
            for campaign, laws in tree['campaigns'].items()}
