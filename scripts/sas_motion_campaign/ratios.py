# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""Ratios of RMS errors, paired by seed over the runs in which neither estimator diverged."""
import numpy as np

from .bootstrap import interval, rounded

AGAINST = ('kf', 'oracle_kf', 'bayes_reference', 'ckf', 'oracle_ckf')


def informed(name):
    """Returns whether an estimator is an oracle: it gets the outliers' labels, or their law."""
    return name.startswith('oracle') or name == 'bayes_reference'


def ratios(law, clean, names, rmse, keep, resampler):
    """Returns {estimator: {clean, kf, ..., best: {value, low, high}}} of one law; a ratio that has no meaning is left out."""
    best = least(law, names, rmse, keep)
    pairs = {(name, 'clean'): ((law, name), (clean, name)) for name in names}
    pairs.update({(name, other): ((law, name), (law, other)) for name in names for other in AGAINST if other in names})
    if best:
        pairs.update({(name, 'best'): ((law, name), (law, best)) for name in names})
    columns = {}
    for pair, (above, below) in pairs.items():
        kept = keep[above] & keep[below]
        if kept.any():
            columns[pair, 0], columns[pair, 1] = (rmse[above] ** 2, kept), (rmse[below] ** 2, kept)
    means = resampler.means(columns)
    found = {name: {} for name in names}
    for pair in pairs:
        if (pair, 0) in means:
            found[pair[0]][pair[1]] = quotient(means[pair, 0], means[pair, 1])
    return found


def quotient(above, below):
    """Returns the interval of the root of a quotient of mean squares."""
    with np.errstate(invalid='ignore', divide='ignore'):
        return interval(np.sqrt(above[0] / below[0]), np.sqrt(above[1] / below[1]))


def least(law, names, rmse, keep):
    """Returns the estimator with the least RMS error among those that are no oracles and lost no run, or else fewest."""
    tried = [(int(np.sum(~keep[law, name])), np.sqrt(np.mean(rmse[law, name][keep[law, name]] ** 2)), name)
             for name in names if not informed(name) and keep[law, name].any()]
    return min(tried)[2] if tried else None


def to_bound(rms, bound):
    """Returns the interval of an RMS error over its Cramér-Rao bound, or None without one."""
    if not bound or rms is None:
        return None
    return {key: None if value is None else rounded(value / bound) for key, value in rms.items()}
