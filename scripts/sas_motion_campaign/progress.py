# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""The progress bar: runs done, time left, and how many times faster than real time."""
import sys
import time

from tqdm import tqdm

FORMAT = '{desc}: {percentage:3.0f}%|{bar}| {n_fmt}/{total_fmt} runs [{elapsed}, {remaining} left{postfix}]'


class Progress:
    """Counts runs; prints nothing where the output is no terminal."""

    def __init__(self, plan, missing):
        self.durations = plan.durations()
        self.begin, self.simulated = time.monotonic(), 0.0
        self.bar = tqdm(total=plan.tasks, initial=plan.tasks - len(missing), desc=plan.suite, bar_format=FORMAT, disable=None, file=sys.stderr, dynamic_ncols=True)

    def advance(self, first, last):
        """Notes that tasks first..last-1 are done."""
        self.simulated += sum(self.durations[first:last])
        elapsed = max(1e-9, time.monotonic() - self.begin)
        self.bar.set_postfix_str(f'{self.simulated / elapsed:.0f} x real time', refresh=False)
        self.bar.update(last - first)

    def close(self):
        """Leaves the bar as it is."""
        self.bar.close()
