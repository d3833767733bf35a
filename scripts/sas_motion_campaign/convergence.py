# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""In how many runs an estimator came near the truth to stay, and after how long."""
import math

from sas_motion_report.inputs import dig

from .bootstrap import rounded


def convergence(results, kept):
    """Returns the number of runs, of those that converged, and median and 90 % quantile of the time over all runs; None where nobody watched.

    A run that never converged, or diverged, counts as one that takes for ever: a quantile is null where so many do.
    """
    if not any(result.get('convergence') for result in results):
        return None
    times = [dig(result, 'convergence', 'after') if keep else None for result, keep in zip(results, kept)]
    ranked = sorted(math.inf if time is None else time for time in times)
    return {'runs': len(times), 'converged': sum(time is not None for time in times), 'median': quantile(ranked, 0.5), 'q90': quantile(ranked, 0.9)}


def quantile(ranked, share):
    """Returns the least value that this share of the values does not exceed, or None."""
    return rounded(ranked[math.ceil(share * len(ranked)) - 1])
