# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""A stand-in for run_campaign that makes its numbers up, the same ones for the same seed, so that the front is tested without the filters.

STUB_DELAY: seconds a task takes. STUB_DIE: a file; the first process to finish a task while it is absent creates it and kills itself.
STUB_FAIL: a task that fails with a plain line.
"""
import argparse
import hashlib
import json
import math
import os
import random
import signal
import sys
import time

import yaml

HARM = {'kf': 1.0, 'oracle_kf': 0.02, 'bayes_reference': 0.025, 'gated_kf': 0.3, 'robust_kf': 0.12, 'student_t_kf': 0.1, 'mixture_kf': 0.035}  # share of the outliers felt
COST = {'kf': 0.6, 'bayes_reference': 40.0, 'mixture_kf': 0.9}
GROUPS = {'towfish': {'position': 0.2, 'heading': 0.004, 'speed': 0.02, 'current': 0.03}, 'constant_velocity': {'position': 1.1, 'velocity': 0.4},
          'sins_dvl': {'position': 2.0, 'velocity': 0.05, 'heading': 0.01, 'drift_percent': 0.6}}
DEGREES = {'towfish': 6, 'constant_velocity': 4, 'sins_dvl': 19}


def read(path, runs):
    """The suite and its plan."""
    try:
        with open(path, encoding='utf-8') as file:
            suite = yaml.safe_load(file)
    except OSError as error:
        sys.exit(f'run_campaign: {path}: {error.strerror}; check the path')
    runs = runs or suite.get('runs', 3)
    digest = hashlib.sha256(json.dumps({k: v for k, v in suite.items() if k != 'runs'}, sort_keys=True).encode()).hexdigest()[:16]
    campaigns, task = [], 0
    for campaign in suite['campaigns']:
        laws = [{'name': law['name'], 'description': law.get('description', law['name']), **strength(law)} for law in campaign['laws']]
        campaigns.append({'name': campaign['name'], 'system': campaign['system'], 'first_task': task, 'duration': 600.0, 'skip': campaign.get('skip', 20.0),
                          'dimension': DEGREES[campaign['system']], 'particles': campaign.get('particles'), 'estimators': campaign['estimators'], 'laws': laws})
        task += len(laws) * runs
    return {'schema': 'sas_motion/plan/1', 'suite': suite['name'], 'version': '0.1.0', 'config_hash': digest, 'runs': runs,
            'first_seed': suite.get('first_seed', 1), 'tasks': task, 'campaigns': campaigns}


def strength(law):
    """Contamination and scale of a law; one that has none says null."""
    noise = law.get('noise', {'law': 'gaussian'})
    if noise['law'] == 'gaussian':
        return {'epsilon': 0, 'K': 1}
    return {'epsilon': noise.get('epsilon'), 'K': noise.get('K')}


def level(law):
    """Variance that the outliers add, over the clean variance."""
    return (0.2 if law['epsilon'] is None else law['epsilon']) * (law['K'] or 10) ** 2 / 10


def scaled(campaign, law, name):
    """How many times its clean error an estimator makes."""
    clean = 1.0 if name in ('kf', 'oracle_kf', 'bayes_reference') else 1.02
    return clean * math.sqrt(1 + HARM.get(name, 0.2) ** 2 * level(law))


def run(plan, task):
    """The line of one task."""
    campaign = [c for c in plan['campaigns'] if c['first_task'] <= task][-1]
    law_index, index = divmod(task - campaign['first_task'], plan['runs'])
    law, seed = campaign['laws'][law_index], plan['first_seed'] + index
    weather = random.Random(f'{campaign["name"]} {seed}').gauss(0, 0.1)  # what all estimators of a run share
    results = {name: score(campaign, law, seed, name, weather) for name in campaign['estimators']}
    cost = {name: COST.get(name, 1.1) * (1 + 0.1 * random.random()) for name in campaign['estimators']}
    return {'task': task, 'campaign': campaign['name'], 'law': law['name'], 'seed': seed, 'config_hash': plan['config_hash'], 'version': plan['version'],
            'results': results, 'cost': cost}


def score(campaign, law, seed, name, weather):
    """The results of one estimator in one run."""
    rng = random.Random(f'{campaign["name"]} {law["name"]} {seed} {name}')
    factor = scaled(campaign, law, name) * math.exp(weather + rng.gauss(0, 0.03))
    lost = name == 'gated_kf' and law['K'] == 20 and seed % 4 == 0
    result = {'diverged': False, 'samples': 5800, 'nees': {}, 'locked_out': lost, 'aperture_across': 0.001 * factor,
              'precision': 0.95 if law['epsilon'] else None, 'recall': 0.7 if law['epsilon'] else None}
    for group, clean in GROUPS[campaign['system']].items():
        rmse = clean * factor * (80 if lost else 1)
        result[group] = {'rmse': None if lost and seed % 8 == 0 else rmse, 'p95': 1.9 * rmse, 'max': 3.2 * rmse}
        result['nees'][group] = factor ** 2 if name == 'kf' else 1 + rng.gauss(0, 0.05)
    result['nees']['full'] = result['nees']['position']
    result['nis'] = {'position': result['nees']['position']}
    if campaign['particles']:
        result.update(effective_size=0.6 * campaign['particles'], convergence={'after': 12.0 + seed if seed % 4 else None})
    return result


def answer(plan, first, last):
    """Prints the lines of the tasks."""
    for task in range(first, last):
        time.sleep(float(os.environ.get('STUB_DELAY', 0)))
        if os.environ.get('STUB_FAIL') == str(task):
            sys.exit(f'run_campaign: task {task}: the covariance is not positive definite')
        print(json.dumps(run(plan, task)), flush=True)
        marker = os.environ.get('STUB_DIE')
        if marker and not os.path.exists(marker):
            open(marker, 'w').close()
            os.kill(os.getpid(), signal.SIGKILL)


def bound(campaign, law):
    """Made-up bounds: none for a law without a density."""
    if law['epsilon'] is None:
        return None
    loose = 1.0 if law['epsilon'] == 0 else 0.97
    return {group: {'rmse': loose * clean * scaled(campaign, law, 'oracle_kf')} for group, clean in GROUPS[campaign['system']].items()}


def trace(campaign, law, name):
    """A made-up run."""
    rng = random.Random(f'trace {campaign["name"]} {law["name"]} {name}')
    times, n = [2.0 * i for i in range(300)], DEGREES[campaign['system']]
    sigma = 0.2 * scaled(campaign, law, name)
    outlier = [rng.random() < (law['epsilon'] or 0) for _ in times]
    tree = {'time': times, 'error': [rng.gauss(0, sigma) for _ in times], 'sigma3': [3 * sigma] * 300, 'nees_degrees': n, 'nis_degrees': 2,
            'nees': [rng.gammavariate(n / 2, 2) for _ in times], 'nis': [rng.expovariate(0.5) for _ in times]}
    tree['others'] = [{'group': group, 'error': [rng.gauss(0, clean) for _ in times], 'sigma3': [3 * clean] * 300}
                      for group, clean in GROUPS[campaign['system']].items() if group in ('velocity', 'heading')]
    if campaign['particles']:
        for other in tree['others']:
            other['sigma3'] = [sigma3 if i % 5 == 4 else None for i, sigma3 in enumerate(other['sigma3'])]  # stated at readings alone
        tree.update(effective_time=times, effective_size=[campaign['particles'] * rng.uniform(0.4, 1) for _ in times])
    if name != 'kf':
        tree.update(weight_time=times, weight=[rng.uniform(0, 0.3) if bad else min(1.0, rng.uniform(0.8, 1.2)) for bad in outlier], outlier=outlier)
    return tree


def by_law(plan, make):
    """{campaign: {law: make(campaign, law)}}"""
    return {c['name']: {law['name']: make(c, law) for law in c['laws']} for c in plan['campaigns']}


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('suite')
    parser.add_argument('--runs', type=int)
    parser.add_argument('--tasks')
    parser.add_argument('--jobs', type=int)
    for flag in ('--plan', '--bounds', '--trace'):
        parser.add_argument(flag, action='store_true')
    options = parser.parse_args()
    plan = read(options.suite, options.runs)
    if options.tasks:
        answer(plan, *map(int, options.tasks.split(':')))
    elif options.plan:
        print(json.dumps(plan))
    elif options.bounds:
        print(json.dumps(by_law(plan, bound)))
    else:
        print(json.dumps(by_law(plan, lambda c, law: {name: trace(c, law, name) for name in c['estimators']})))


if __name__ == '__main__':
    main()
