#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""Our filters' and smoothers' answers beside those of filterpy, Stone Soup and the Python GTSAM on the same data.

usage: cross_check.py TOOLS [STEPS [NODES]]    TOOLS: folder of filter_answers and smoother_answers; STEPS of the filters, NODES of the smoother
Runs in an environment with peers/requirements.txt. Exit status 1 where a difference is above its bound.

Differences of means and states are in standard deviations, those of covariances relative to the product of the two standard deviations, so that they do
not depend on where the origin or what the units are. Both peers' cubature filters form covariances as E[x x'] - m m', which cancels (distance / sigma)^2
of the digits: their differences grow with the distance from the origin, and a long run would compare rounding. Times are of the processor.
"""
import json
import pathlib
import subprocess
import sys
import time

import numpy as np
from peers import filterpy_peer, gtsam_peer, stonesoup_peer
from peers.models import model_of

FILTERS_AGREE = 1e-9
STATES_AGREE = 1e-6  # [sigma]
COSTS_AGREE = 1e-8   # relative
PEERS = {'filterpy': filterpy_peer.FILTERS, 'Stone Soup': stonesoup_peer.FILTERS}


def run(tool, *arguments):
    return json.loads(subprocess.run([tool, *map(str, arguments)], check=True, capture_output=True, text=True).stdout)


def belief_difference(mean, covariance, ours):
    expected, P = np.array(ours['mean']), np.array(ours['covariance'])
    sigma = np.sqrt(np.diag(P))
    return np.maximum(np.max(np.abs(mean - expected) / sigma), np.max(np.abs(covariance - P) / np.outer(sigma, sigma)))  # lets nan through


def compare_filter(case, ours, make):
    """The largest difference in any belief before or after a reading, and the peer's nanoseconds a step."""
    readings = [np.array(z) for z in case['readings']]
    step = make()
    largest = 0
    for z, prior, posterior in zip(readings, ours['priors'], ours['posteriors']):
        before, P_before, after, P_after = step(z)
        largest = np.maximum(largest, np.maximum(belief_difference(before, P_before, prior), belief_difference(after, P_after, posterior)))
    fastest = np.inf
    for _ in range(3):
        step = make()
        begin = time.process_time()
        for z in readings:
            step(z)
        fastest = min(fastest, (time.process_time() - begin) / len(readings) * 1e9)
    return largest, fastest


def filter_rows(answers):
    for case in answers['cases']:
        model = model_of(case)
        for peer, filters in PEERS.items():
            for name, make in filters.items():
                ours = case['filters'][name]
                difference, nanoseconds = compare_filter(case, ours, lambda make=make: make(case, model, answers['unscented']))
                yield peer, f'{name}, {case["name"]}', difference, FILTERS_AGREE, nanoseconds / ours['ns_per_step'], nanoseconds / 1e3


def smoother_rows(problem):
    states, cost, seconds = gtsam_peer.solve(problem)
    for name in ('rts', 'batch'):
        ours = problem[name]
        if ours['failure']:
            sys.exit(f'cross_check: {name} failed: {ours["failure"]}')
        differences = [np.max(np.abs(gtsam_peer.difference(x, np.array(y))) / sigma) for x, y, sigma in zip(states, ours['states'], ours['sigmas'])]
        yield 'GTSAM (Python)', f'{name}, states', np.max(differences), STATES_AGREE, seconds / ours['seconds'], seconds * 1e6
        yield 'GTSAM (Python)', f'{name}, cost', abs(cost / ours['cost'] - 1), COSTS_AGREE, seconds / ours['seconds'], seconds * 1e6


def main():
    if not 2 <= len(sys.argv) <= 4:
        sys.exit(__doc__)
    tools = pathlib.Path(sys.argv[1])
    steps, nodes = (int(a) for a in (sys.argv[2:] + ['200', '200'][len(sys.argv) - 2:]))
    print(f'{"peer":<16}{"what":<16}{"largest difference":>19}{"bound":>8}{"their time [us]":>17}{"theirs / ours":>15}')
    missed = 0
    for rows in (filter_rows(run(tools / 'filter_answers', steps)), smoother_rows(run(tools / 'smoother_answers', nodes))):
        for peer, what, difference, bound, ratio, microseconds in rows:
            agrees = difference <= bound
            missed += not agrees
            print(f'{peer:<16}{what:<16}{difference:>19.1e}{bound:>8.0e}{microseconds:>17.1f}{ratio:>15.0f}{"" if agrees else "  MISSED"}', flush=True)
    print('evo             position RMSE: test/python/test_evo.py, by make test')
    sys.exit(1 if missed else 0)


if __name__ == '__main__':
    main()
