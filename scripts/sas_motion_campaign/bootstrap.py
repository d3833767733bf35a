# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""95 % intervals by the bootstrap over runs: seeded, the same resamples for every estimator and law, so that ratios are paired."""
import numpy as np

RESAMPLES = 2000
SEED = 20260101
LEVEL = 0.95
DIGITS = 9  # of what is written: more than sampling leaves, fewer than the order of summation moves


class Resampler:
    """Draws runs with replacement, once; means over the draws are then one matrix product."""

    def __init__(self, runs):
        self.rng = np.random.default_rng(SEED)
        self.runs = runs
        self.counts = np.empty((RESAMPLES, runs))
        for row in range(RESAMPLES):
            self.counts[row] = np.bincount(self.rng.integers(0, runs, runs), minlength=runs)

    def means(self, columns):
        """Returns {name: (mean, its replicates)} of {name: (values, keep)}: the mean over the runs that `keep` marks."""
        if not columns:
            return {}
        names = list(columns)
        keep = np.column_stack([columns[name][1] for name in names]).astype(float)
        values = np.where(keep > 0, np.column_stack([columns[name][0] for name in names]), 0.0)
        with np.errstate(invalid='ignore', divide='ignore'):
            point = values.sum(axis=0) / keep.sum(axis=0)
            masks, mask_of = np.unique(keep, axis=1, return_inverse=True)  # nearly all columns keep the same runs
            replicates = (self.counts @ values) / (self.counts @ masks)[:, mask_of.ravel()]
        return {name: (point[i], replicates[:, i]) for i, name in enumerate(names)}

    def median(self, values):
        """Returns (median, its replicates) of the values.

        A resample's k-th smallest of n is the value whose rank is the k-th smallest of n uniform draws, which is beta-distributed;
        so the ranks are drawn and no resample is sorted.
        """
        n = len(values)
        if n == 0:
            return np.nan, np.full(RESAMPLES, np.nan)
        k = (n + 1) // 2
        rng = np.random.default_rng(SEED)
        lower = rng.beta(k, n - k + 1, RESAMPLES)
        upper = lower if n % 2 else lower + (1 - lower) * rng.beta(1, n - k, RESAMPLES)
        ranked = np.sort(values)
        pick = [ranked[np.minimum(n - 1, (n * u).astype(int))] for u in (lower, upper)]
        return np.median(values), 0.5 * (pick[0] + pick[1])


def interval(point, replicates=None):
    """Returns {value, low, high}: the bootstrap's percentiles; no interval from a single run."""
    if replicates is None or not np.all(np.isfinite(point)):
        return {'value': rounded(point), 'low': None, 'high': None}
    finite = replicates[np.isfinite(replicates)]
    if finite.size < RESAMPLES // 2 or np.ptp(finite) == 0:
        return {'value': rounded(point), 'low': None, 'high': None}
    low, high = np.quantile(finite, [(1 - LEVEL) / 2, (1 + LEVEL) / 2])
    return {'value': rounded(point), 'low': rounded(low), 'high': rounded(high)}


def rounded(x):
    """Returns a float of DIGITS digits, or None for what is not finite."""
    return float(f'{x:.{DIGITS}g}') if np.isfinite(x) else None
