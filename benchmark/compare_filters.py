#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""Times filterpy's Kalman filter on the same case and prints it beside the C++ filters. usage: compare_filters.py filters.json"""
import json
import sys
import timeit

import numpy as np


def filterpy_step():
    """Nanoseconds of one predict and update of six states and four rows."""
    from filterpy.kalman import KalmanFilter
    kf = KalmanFilter(dim_x=6, dim_z=4)
    kf.F = np.eye(6)
    kf.F[0, 2] = kf.F[1, 3] = 0.1
    kf.H = np.zeros((4, 6))
    kf.H[[0, 1, 2, 3], [0, 1, 4, 5]] = 1
    kf.Q, kf.R, kf.P = np.eye(6) * 1e-4, np.diag([1, 1, 7.6e-5, 2.5e-3]), np.eye(6) * 0.05
    z = np.array([[0.6], [0.4], [0.004], [0.03]])

    def step():  # like ours, the model is evaluated at each step
        heading, speed, dt = kf.x[4, 0], kf.x[5, 0], 0.1
        c, s = np.cos(heading), np.sin(heading)
        kf.F[0, 4], kf.F[1, 4], kf.F[0, 5], kf.F[1, 5] = -speed * dt * s, speed * dt * c, dt * c, dt * s
        kf.predict()
        kf.update(z)
    return min(timeit.repeat(step, number=2000, repeat=5)) / 2000 * 1e9


def main():
    with open(sys.argv[1], encoding='utf-8') as file:
        times = {b['run_name']: b['real_time'] for b in json.load(file)['benchmarks'] if b.get('aggregate_name') == 'median'}
    try:
        times['filterpy'] = filterpy_step()
    except ImportError:
        print('filterpy is not installed: not compared')
    print(f'{"filter":<22}{"ns":>10}{"of kf":>10}{"of bare":>10}')
    for name, time in times.items():
        print(f'{name:<22}{time:>10.0f}{time / times["kf"]:>10.2f}{time / times["bare_eigen"]:>10.2f}')


if __name__ == '__main__':
    main()
