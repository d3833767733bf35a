# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""summary.json: what the runs of a campaign say, with 95 % intervals."""
import numpy as np

from sas_motion_report.inputs import dig

from .bootstrap import LEVEL, RESAMPLES, SEED, Resampler, interval
from .convergence import convergence
from .failures import clean_medians, kept_runs, lockouts
from .images import by_aperture_error, image
from .ratios import ratios, to_bound

SCHEMA = 'sas_motion/benchmark/2'
FIRST = ('position', 'mounting')  # the group that ratios and divergence are about
OTHER = ('nees', 'nis', 'convergence')  # objects that are no group of errors
MEANS = ('aperture_across', 'aperture_wavelengths', 'effective_size', 'precision', 'recall')


def summarise(plan, records, bounds):
    """Returns the summary as a tree."""
    resampler = Resampler(plan.runs)
    campaigns = {c['name']: summarise_campaign(plan, c, records, dig(bounds, c['name']) or {}, resampler) for c in plan.campaigns}
    return {'schema': SCHEMA, 'suite': plan.suite, 'version': plan.version, 'config_hash': plan.config_hash, 'runs': plan.runs,
            'first_seed': plan.first_seed, 'bootstrap': {'resamples': RESAMPLES, 'seed': SEED, 'level': LEVEL}, 'campaigns': campaigns}


def summarise_campaign(plan, campaign, records, bounds, resampler):
    """Returns the summary of one campaign: its facts, then law by law."""
    names, laws = campaign['estimators'], [law['name'] for law in campaign['laws']]
    runs = {(law, name): [records[campaign['name'], law, seed]['results'].get(name) or {} for seed in plan.seeds()] for law in laws for name in names}
    groups = error_groups(runs)
    rmse = {key: column(found, groups[0], 'rmse') for key, found in runs.items()}
    medians = clean_medians(rmse, laws[0], names)
    keep = {key: kept_runs(runs[key], rmse[key], medians[key[1]]) for key in runs}
    head = {key: campaign.get(key) for key in ('system', 'duration', 'skip', 'dimension', 'particles')}
    tree = {**head, 'groups': groups, 'estimators': names, 'laws': {}}
    for law in campaign['laws']:
        bound = bounds.get(law['name'])
        found = statistics_of_law(law['name'], names, groups, runs, keep, resampler)
        compared = ratios(law['name'], laws[0], names, rmse, keep, resampler)
        for name in names:
            estimator = found[name]
            estimator['ratios'] = compared[name]
            for group in groups:
                estimator['errors'][group]['to_bound'] = to_bound(estimator['errors'][group]['rms'], dig(bound, group, 'rmse'))
            estimator['ratios']['bound'] = estimator['errors'][groups[0]]['to_bound']
            settled = convergence(runs[law['name'], name], keep[law['name'], name])
            if settled:
                estimator['convergence'] = settled
            if any('windows' in result for result in runs[law['name'], name]):
                estimator['image'] = image(runs[law['name'], name])
        facts = {key: law.get(key) for key in ('description', 'epsilon', 'K')}
        tree['laws'][law['name']] = {**facts, 'bound': bound, 'estimators': found}
    table = by_aperture_error(runs)
    return {**tree, 'by_aperture_error': table} if table else tree


def error_groups(runs):
    """Returns the groups of errors that the runs have, the one of FIRST first: ratios and divergence are about it."""
    found = {key for results in runs.values() for result in results for key, value in result.items() if key not in OTHER and isinstance(value, dict)}
    return sorted(found, key=lambda group: (group not in FIRST, group)) or ['position']


def column(results, *path):
    """Returns an array of one number a run, NaN where it has none."""
    values = (dig(result, *path) for result in results)
    return np.array([np.nan if v is None else v for v in values], dtype=float)


def statistics_of_law(law, names, groups, runs, keep, resampler):
    """Returns {estimator: its errors, consistency and failures} of one law."""
    columns, medians, tree = {}, {}, {}
    for name in names:
        results, kept = runs[law, name], keep[law, name]
        for group in groups:
            values = column(results, group, 'rmse')
            put(columns, (name, 'errors', group, 'rms'), values ** 2, kept)
            put(columns, (name, 'errors', group, 'p95'), column(results, group, 'p95'), kept)
            medians[name, 'errors', group, 'median'] = resampler.median(values[kept & np.isfinite(values)])
        for kind in ('nees', 'nis'):
            for key in sorted({key for result in results for key in result.get(kind) or {}}):
                put(columns, (name, kind, key), column(results, kind, key), kept)
        for key in MEANS:
            put(columns, (name, key), column(results, key), kept)
    means = {path: root(mean) if path[-1] == 'rms' else mean for path, mean in resampler.means(columns).items()}
    for name in names:
        kept = keep[law, name]
        tree[name] = {'runs': len(kept), 'diverged': int(np.sum(~kept)), 'locked_out': lockouts(runs[law, name]),
                      'errors': {group: {'max': largest(column(runs[law, name], group, 'max'), kept), 'rms': interval(np.nan), 'p95': interval(np.nan)}
                                 for group in groups}, 'nees': {}, 'nis': {}}
    for path, (point, replicates) in sorted({**means, **medians}.items()):
        place = tree
        for key in path[:-1]:
            place = place[key]
        place[path[-1]] = interval(point, replicates)
    return tree


def put(columns, path, values, kept):
    """Notes a column whose mean is wanted, unless no run has it."""
    kept = kept & np.isfinite(values)
    if kept.any():
        columns[path] = (values, kept)


def root(mean):
    """Returns the root of a mean square and of its replicates."""
    return np.sqrt(mean[0]), np.sqrt(mean[1])


def largest(values, kept):
    """Returns the largest value of the kept runs, or None."""
    values = values[kept & np.isfinite(values)]
    return interval(values.max())['value'] if values.size else None
