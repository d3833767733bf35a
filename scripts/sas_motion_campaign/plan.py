# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""The plan of a campaign: which task is which run. Tasks are numbered first_task + law * runs + run, campaign by campaign."""
from sas_motion_report import ReportError

SCHEMA = 'sas_motion/plan/1'
NEEDED = {'suite': str, 'version': str, 'config_hash': str, 'runs': int, 'first_seed': int, 'tasks': int, 'campaigns': list}
NEEDED_OF_A_CAMPAIGN = {'name': str, 'system': str, 'first_task': int, 'duration': (int, float), 'skip': (int, float), 'estimators': list, 'laws': list}


class Plan:
    """What run_campaign means to compute."""

    def __init__(self, tree):
        if not isinstance(tree, dict) or tree.get('schema') != SCHEMA:
            raise ReportError(f'run_campaign --plan did not print a plan of schema {SCHEMA}; build run_campaign and benchmark from the same source')
        check(tree, NEEDED, 'the plan')
        for campaign in tree['campaigns']:
            check(campaign, NEEDED_OF_A_CAMPAIGN, 'a campaign of the plan')
        self.tree = tree
        self.suite, self.version, self.config_hash = tree['suite'], tree['version'], tree['config_hash']
        self.runs, self.first_seed, self.tasks, self.campaigns = tree['runs'], tree['first_seed'], tree['tasks'], tree['campaigns']
        self.keys = [(campaign['name'], law['name'], self.first_seed + run)
                     for campaign in self.campaigns for law in campaign['laws'] for run in range(self.runs)]
        if len(self.keys) != self.tasks or len(set(self.keys)) != self.tasks:
            raise ReportError(f'the plan has {self.tasks} tasks but its campaigns, laws and seeds make {len(set(self.keys))}; '
                              'give every campaign and law of the suite a name of its own')

    def seeds(self):
        """Returns the seeds of a law, in order."""
        return range(self.first_seed, self.first_seed + self.runs)

    def durations(self):
        """Returns the simulated seconds of each task."""
        return [campaign['duration'] for campaign in self.campaigns for _ in range(len(campaign['laws']) * self.runs)]


def check(tree, needed, where):
    """Throws unless the object has the needed keys with the needed types."""
    for key, kind in needed.items():
        if not isinstance(tree, dict) or not isinstance(tree.get(key), kind):
            raise ReportError(f'{where} has no usable {key!r}; build run_campaign and benchmark from the same source')


def contiguous_chunks(tasks, size):
    """Returns [(first, last + 1), ...] that cover the ascending task numbers, each of consecutive ones and at most size long."""
    chunks = []
    for task in tasks:
        if chunks and task == chunks[-1][1] and task - chunks[-1][0] < size:
            chunks[-1][1] = task + 1
        else:
            chunks.append([task, task + 1])
    return [tuple(chunk) for chunk in chunks]
