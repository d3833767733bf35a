# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""Talking to run_campaign, the C++ program that simulates, filters and scores."""
import json
import os
import subprocess

from sas_motion_report import ReportError

from .plan import Plan


class Worker:
    """One suite's run_campaign: its command lines and its checked answers."""

    def __init__(self, program, suite, runs=None):
        # absolute, for a Dask worker that shares our files but not our folder
        self.program, self.suite = os.path.abspath(program), os.path.abspath(suite)
        self.options = [] if runs is None else ['--runs', str(runs)]

    def plan(self):
        """Returns the plan."""
        return Plan(self.ask(*self.options, '--plan'))

    def bounds(self):
        """Returns the Cramér-Rao bounds by campaign and law."""
        return self.ask(*self.options, '--bounds')

    def trace(self):
        """Returns the first seed's series by campaign, law and estimator."""
        return self.ask('--trace')

    def command(self, chunk, jobs):
        """Returns the command line that computes the tasks of a chunk."""
        return [self.program, self.suite, *self.options, '--tasks', f'{chunk[0]}:{chunk[1]}', '--jobs', str(jobs)]

    def ask(self, *arguments):
        """Returns the JSON object that run_campaign prints."""
        try:
            done = subprocess.run([self.program, self.suite, *arguments], check=False, stdin=subprocess.DEVNULL,
                                  stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True)
        except OSError as error:
            raise ReportError(cannot_run(self.program, error)) from None
        if done.returncode != 0:
            raise ReportError(failure(done.returncode, done.stderr, ' '.join(arguments)))
        return parse(done.stdout, ' '.join(arguments))


def cannot_run(program, error):
    """Returns the sentence for a program that does not start."""
    return f'{program} cannot be run ({error.strerror}); build the package or name the program with --worker'


def failure(status, complaint, arguments):
    """Returns the sentence for a run_campaign that failed: its own last line, where it left one."""
    if status < 0:
        return f'run_campaign {arguments} was stopped by signal {-status}; what is done is kept, so start again to go on'
    lines = [line for line in complaint.splitlines() if line.strip()]
    if lines and lines[-1].startswith('run_campaign: '):
        return lines[-1][len('run_campaign: '):]
    return lines[-1] if lines else f'run_campaign {arguments} failed with status {status} and did not say why; run it by itself'


def parse(text, arguments):
    """Returns the JSON of an answer; what JSON has no number for becomes None."""
    try:
        return json.loads(text, parse_constant=lambda _: None)
    except ValueError:
        raise ReportError(f'run_campaign {arguments} printed no JSON but {text[:60]!r}; build run_campaign and benchmark from the same source') from None


def read_record(plan, line, task):
    """Returns the checked record of one task from the line that run_campaign printed for it."""
    record = parse(line, f'--tasks {task}')
    campaign, law, seed = plan.keys[task]
    expected = {'task': task, 'campaign': campaign, 'law': law, 'seed': seed, 'config_hash': plan.config_hash, 'version': plan.version}
    found = {key: record.get(key) for key in expected} if isinstance(record, dict) else None
    if found != expected or not isinstance(record.get('results'), dict):
        raise ReportError(f'run_campaign answered {found} where {expected} belongs; every machine needs the same build and suite')
    return {'campaign': campaign, 'law': law, 'seed': seed, 'results': record['results'], 'cost': record.get('cost')}
