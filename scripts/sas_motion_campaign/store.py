# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""The results of a folder: results.jsonl and costs.json when complete, results.partial.jsonl while runs are missing."""
import errno
import fcntl
import json
import os

from sas_motion_report import ReportError
from sas_motion_report.files import write_atomically

from .costs import costs_by_key, render_costs

OUTPUTS = ('results.jsonl', 'results.partial.jsonl', 'costs.json', 'summary.json', 'report.html', 'report.pdf')


class Store:
    """Finished runs by (campaign, law, seed): those found in the folder, and those added since."""

    def __init__(self, folder, plan, fresh=False):
        self.folder, self.plan, self.partial = folder, plan, None
        self.records = {}
        self.lock()
        if fresh:
            self.clear()
        self.load('results.jsonl', costs_by_key(self.path('costs.json')))
        self.load('results.partial.jsonl', {})
        self.refuse_fewer_runs()

    def path(self, name):
        """Returns the path of a file of the folder."""
        return os.path.join(self.folder, name)

    def lock(self):
        """Takes the folder for this process alone."""
        try:
            self.held = os.open(self.folder, os.O_RDONLY)  # the folder: a lock on a file that is removed keeps nobody out
            fcntl.flock(self.held, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise ReportError(f'another benchmark is writing to {self.folder}; wait for it or name another folder with -o') from None

    def clear(self):
        """Removes what an earlier campaign left."""
        for name in OUTPUTS:
            if os.path.exists(self.path(name)):
                os.remove(self.path(name))

    def load(self, name, costs):
        """Takes over the runs of a file; a last line without its end was torn by a crash and is left out."""
        if not os.path.exists(self.path(name)):
            return
        with open(self.path(name), encoding='utf-8', errors='replace') as file:
            text = file.read()
        for number, line in enumerate(text[:text.rfind('\n') + 1].splitlines(), 1):
            record = self.check(line, f'{self.path(name)} line {number}')
            key = (record['campaign'], record['law'], record['seed'])
            self.records[key] = {'results': record['results'], 'cost': record.get('cost', costs.get(key))}

    def check(self, line, where):
        """Returns the record of a line, or throws where it is none or of another suite, version or configuration."""
        try:
            record = json.loads(line)
            found = {key: record[key] for key in ('config_hash', 'version', 'campaign', 'law', 'seed', 'results')}
        except (ValueError, KeyError, TypeError):
            raise ReportError(f'{where} is no result of benchmark; name another folder with -o, or begin anew with --fresh') from None
        for key, wanted in (('config_hash', self.plan.config_hash), ('version', self.plan.version)):
            if found[key] != wanted:
                raise ReportError(f'{where} has {key} {found[key]} but this suite has {wanted}: it is not the same campaign; '
                                  'name another folder with -o, or begin anew with --fresh')
        return record

    def refuse_fewer_runs(self):
        """Throws where the folder holds seeds that are not asked for: writing fewer would lose them."""
        known = set(self.plan.keys)
        extra = [key for key in self.records if key not in known]
        if extra:
            raise ReportError(f'{self.folder} holds {len(extra)} runs more than are asked for, such as seed {extra[-1][2]} of {extra[-1][1]}; '
                              'ask for at least as many --runs, name another folder with -o, or begin anew with --fresh')

    def missing(self):
        """Returns the numbers of the tasks still to run, ascending."""
        return [task for task, key in enumerate(self.plan.keys) if key not in self.records]

    def open(self):
        """Opens the partial file for appending, without a torn last line."""
        try:
            self.partial = open(self.path('results.partial.jsonl'), 'ab+', buffering=0)  # what fails to be written must not come again on closing
            self.partial.seek(0)
            self.partial.truncate(self.partial.read().rfind(b'\n') + 1)
        except OSError as error:
            raise ReportError(f'{self.path("results.partial.jsonl")} cannot be written ({error.strerror}); free the disk or name another folder with -o') from None

    def add(self, records):
        """Appends finished runs and makes them last through a crash."""
        for record in records:
            self.records[record['campaign'], record['law'], record['seed']] = {'results': record['results'], 'cost': record['cost']}
        data = ''.join(self.line(record, cost=record['cost']) + '\n' for record in records).encode('utf-8')
        try:
            if self.partial.write(data) < len(data):
                raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
            os.fsync(self.partial.fileno())
        except OSError as error:
            raise ReportError(f'{self.partial.name} cannot be written ({error.strerror}); free the disk and start again to go on') from None

    def line(self, record, **more):
        """Returns the line of one run."""
        head = {'suite': self.plan.suite, 'campaign': record['campaign'], 'law': record['law'], 'seed': record['seed'],
                'config_hash': self.plan.config_hash, 'version': self.plan.version}
        return json.dumps({**head, 'results': record['results'], **more}, ensure_ascii=False)

    def finish(self):
        """Writes results.jsonl in task order and costs.json."""
        lines = (self.line({'campaign': c, 'law': l, 'seed': s, **self.records[c, l, s]}) for c, l, s in self.plan.keys)
        write_atomically(self.path('results.jsonl'), ''.join(line + '\n' for line in lines))
        write_atomically(self.path('costs.json'), render_costs(self.plan, self.records))

    def close(self, finished):
        """Lets go of the partial file; removes it when all is in results.jsonl, or nothing is in it."""
        if finished or self.partial.tell() == 0:
            os.remove(self.partial.name)
        self.partial.close()
        os.close(self.held)
