# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""The univariate growth model of benchmark/particle_cases.hpp, written a second time, and its exact filter on a grid."""
import numpy as np

REACH, STEP = 40.0, 0.04  # of the grid; the sharpest likelihood is 0.25 wide


def moved(x, k):
    return x / 2 + 25 * x / (1 + x ** 2) + 8 * np.cos(1.2 * k)


def seen(x):
    return x ** 2 / 20


def density(offset, variance):
    return np.exp(-offset ** 2 / (2 * variance))


def exact(case):
    """Means and variances after each reading, by Bayes' rule on a grid."""
    (process,), (sensor,), (start,) = case['Q'], case['R'], case['start']['covariance']
    x = np.arange(-REACH, REACH + STEP / 2, STEP)
    p = density(x - case['start']['mean'][0], start)
    means, variances = [], []
    for k, (z,) in enumerate(case['readings'], 1):
        p = density(x[:, np.newaxis] - moved(x, k), process) @ p
        p *= density(z - seen(x), sensor)
        p /= p.sum()
        means.append([p @ x])
        variances.append([p @ (x - means[-1][0]) ** 2])
    return np.array(means), np.array(variances)
