# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""What the tests of the front `benchmark` share: a suite, the stand-in for run_campaign, and how to run the one on the other."""
import os
import pathlib
import stat
import subprocess
import sys

import yaml

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCRIPT = ROOT / 'scripts' / 'benchmark'
STUB = pathlib.Path(__file__).resolve().parent / 'stub_campaign.py'
DETERMINISTIC = ('results.jsonl', 'summary.json')
ESTIMATORS = ['kf', 'oracle_kf', 'bayes_reference', 'gated_kf', 'robust_kf', 'mixture_kf']
LAWS = [{'name': 'clean'}, {'name': 'contaminated 0.1, K 10', 'noise': {'law': 'contaminated', 'epsilon': 0.1, 'K': 10}},
        {'name': 'contaminated 0.2, K 20', 'noise': {'law': 'contaminated', 'epsilon': 0.2, 'K': 20}}, {'name': 'bursts', 'noise': {'law': 'burst'}}]
SUITE = {'name': 'sample', 'runs': 12, 'first_seed': 5, 'campaigns': [
    {'name': 'towfish', 'system': 'towfish', 'estimators': ESTIMATORS, 'laws': LAWS},
    {'name': 'cv', 'system': 'constant_velocity', 'estimators': ['kf', 'robust_kf'], 'laws': LAWS[:3]}]}


def write_suite(folder, **changes):
    """The suite as a file."""
    path = pathlib.Path(folder) / 'suite.yaml'
    path.write_text(yaml.safe_dump({**SUITE, **changes}))
    return path


def worker(folder):
    """The stand-in as an executable."""
    path = pathlib.Path(folder) / 'run_campaign'
    path.write_text(f'#!/bin/sh\nexec "{sys.executable}" "{STUB}" "$@"\n')
    path.chmod(stat.S_IRWXU)
    return path


def command(folder, *arguments):
    """The command line of the front on the stand-in; the suite is made unless it is there."""
    suite = pathlib.Path(folder) / 'suite.yaml'
    if not suite.exists():
        write_suite(folder)
    return [sys.executable, str(SCRIPT), str(suite), '--worker', str(worker(folder)), *map(str, arguments)]


def environment(**extra):
    """The environment of the front."""
    return {**os.environ, 'PYTHONDONTWRITEBYTECODE': '1', **{key: str(value) for key, value in extra.items()}}


def benchmark(folder, out, *arguments, report=False, **extra):
    """Runs the front; the output folder is below `folder`."""
    options = ['-o', pathlib.Path(folder) / out, '--jobs', 2, *([] if report else ['--no-report']), *arguments]
    return subprocess.run(command(folder, *options), stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True, check=False, timeout=120,
                          env=environment(**extra))


def succeed(folder, out, *arguments, **extra):
    """The standard output of a front that must succeed without complaint."""
    done = benchmark(folder, out, *arguments, **extra)
    assert done.returncode == 0 and not done.stderr, done.stderr
    return done.stdout


def outputs(folder, out):
    """The bytes of what must not depend on how it was computed."""
    return {name: (pathlib.Path(folder) / out / name).read_bytes() for name in DETERMINISTIC}


def refused(done, *words):
    """Asserts an error of one plain line with these words."""
    assert done.returncode == 1, (done.returncode, done.stderr)
    assert done.stderr.count('\n') == 1 and 'Traceback' not in done.stderr, done.stderr
    assert all(word in done.stderr for word in words), done.stderr
