#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""Our bootstrap filter's answers beside those of Stone Soup's on the same readings, and beside the exact ones where a grid has them.

usage: compare_particles.py TOOLS RUNS PARTICLES...    TOOLS: folder of particle_answers
Runs in an environment with peers/requirements.txt. Exit status 1 where answers part.

Two particle filters agree only up to what they draw. z is the difference of two averages over RUNS seeds, of the means or of the variances after a reading,
in its standard error; z^2, averaged over readings and states, is 1 for filters that are alike. How far above 1 it comes by chance, when readings hang together
and errors are far from Gaussian, is told by shuffling the runs between the filters: the answers part where z^2 is above all but one in 1000 shuffles. Against
the exact answer signs are shuffled instead; a filter of few particles is biased, so that 10,000 are asked to agree. `misled` is ours, told 20 % more noise of
the process than there is, beside Stone Soup's: at the most particles it has to be found out.
"""
import json
import pathlib
import subprocess
import sys
import time

import numpy as np
from peers import growth, stonesoup_particles

SHUFFLES = 4000
BY_CHANCE = 1e-3
UNBIASED = 10_000  # particles


def z_square(offsets, errors):
    return np.mean(offsets ** 2 / errors)


def apart(a, b, rng):
    """z^2 of two filters' answers (runs, numbers), and what it exceeds by chance in one of 1000."""
    pooled, runs = np.concatenate([a, b]), len(a)

    def measured(order):
        one, other = pooled[order[:runs]], pooled[order[runs:]]
        return z_square(one.mean(0) - other.mean(0), (one.var(0, ddof=1) + other.var(0, ddof=1)) / runs)
    return measured(np.arange(2 * runs)), np.quantile([measured(rng.permutation(2 * runs)) for _ in range(SHUFFLES)], 1 - BY_CHANCE)


def off(a, exact, rng):
    """The same of a filter's answers and the exact ones."""
    errors = a - exact

    def measured(signs):
        signed = signs[:, np.newaxis] * errors
        return z_square(signed.mean(0), signed.var(0, ddof=1) / len(a))
    return measured(np.ones(len(a))), np.quantile([measured(rng.choice([-1, 1], len(a))) for _ in range(SHUFFLES)], 1 - BY_CHANCE)


def flat(answers):
    """(runs, readings, states) as (runs, numbers)."""
    return np.reshape(answers, (len(answers), -1))


def peers_answers(case, particles, runs):
    """Means and variances of Stone Soup's runs, and its nanoseconds a step."""
    run = stonesoup_particles.runner(case, particles)
    run(0)
    begin = time.process_time()
    found = [run(seed) for seed in range(1, runs + 1)]
    nanoseconds = (time.process_time() - begin) / (runs * len(case['readings'])) * 1e9
    return {'means': [means for means, _ in found], 'variances': [variances for _, variances in found]}, nanoseconds


def checks(case, ours, misled, theirs, last):
    """What is compared, z^2, what it exceeds by chance, and whether that is as it should be."""
    rng = np.random.default_rng(1)
    exact = dict(zip(('means', 'variances'), growth.exact(case))) if case['name'] == 'growth' else {}
    for what in ('means', 'variances'):
        us, them = flat(ours[what]), flat(theirs[what])
        found, bound = apart(us, them, rng)
        yield f'{what}, ours and theirs', found, bound, found <= bound
        found, bound = apart(flat(misled[what]), them, rng)
        yield f'{what}, misled and theirs', found, bound, found > bound or not last
        for name, answers in (('ours', us), ('theirs', them)) if exact else ():
            found, bound = off(answers, np.ravel(exact[what]), rng)
            yield f'{what}, {name} and exact', found, bound, found <= bound or ours['particles'] < UNBIASED


def compare(case, runs):
    """Prints what is found with each number of particles; how many checks failed."""
    missed = 0
    most = max(answers['particles'] for answers in case['answers'])
    for ours, misled in zip(case['answers'], case['misled']):
        particles, own = ours['particles'], ours['ns_per_step']
        theirs, nanoseconds = peers_answers(case, particles, runs)
        print(f'{case["name"]}, {particles} particles: ours {own / 1e3:.1f} us a step, theirs {nanoseconds / 1e3:.0f} us, {nanoseconds / own:.1f} times as long')
        for what, found, bound, well in checks(case, ours, misled, theirs, particles == most):
            missed += not well
            print(f'    {what:<30}z^2 {found:>8.2f}, by chance up to {bound:>5.2f}{"" if well else "  MISSED"}', flush=True)
    return missed


def main():
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    tool, runs, particles = pathlib.Path(sys.argv[1]) / 'particle_answers', int(sys.argv[2]), sys.argv[3:]
    cases = json.loads(subprocess.run([tool, str(runs), *particles], check=True, capture_output=True, text=True).stdout)
    sys.exit(1 if sum([compare(case, runs) for case in cases]) else 0)


if __name__ == '__main__':
    main()
