# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""Runs that failed: counted, not averaged away."""
import numpy as np

DIVERGED = 50  # times the estimator's median on clean data


def clean_medians(rmse, clean, names):
    """Returns {estimator: its median RMSE under the clean law}; infinite where it has none, so that nothing is compared with it."""
    found = {name: rmse[clean, name][np.isfinite(rmse[clean, name])] for name in names}
    return {name: np.median(values) if values.size else np.inf for name, values in found.items()}


def kept_runs(results, rmse, clean_median):
    """Returns a mask of the runs that did not diverge: by their own word, by a number that is none, or by DIVERGED."""
    said = np.array([bool(result.get('diverged')) for result in results])
    with np.errstate(invalid='ignore'):
        return ~said & np.isfinite(rmse) & (rmse <= DIVERGED * clean_median)


def lockouts(results):
    """Returns how many runs were sure of a wrong place, or None where nobody looked."""
    known = [result['locked_out'] for result in results if isinstance(result.get('locked_out'), bool)]
    return sum(known) if known else None
