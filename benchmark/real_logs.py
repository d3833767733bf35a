#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""Real ship's logs: GNSS withheld for 5 minutes at a time, and 100 m jumps injected for 15 s, scored against the GNSS itself.

usage: real_logs.py TOOLS_DIR DATA_DIR OUT_DIR; DATA_DIR holds yachts/ and ship_nbp1406/ (see docs/results.md).
"""
import glob
import json
import os
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
ESTIMATORS = ['kf', 'robust_kf', 'student_t_kf', 'mixture_kf', 'rts']
# name, files, configuration, variation [deg], starts of the withheld stretches [s], starts of the injected jumps [s]
LOGS = [
    ('ship', ['ship_nbp1406/NBP1406_seap*', 'ship_nbp1406/NBP1406_gyr1*', 'ship_nbp1406/NBP1406_adcp*'], 'towfish', None, [300], [150]),
    ('yacht_2013', ['yachts/*2013*'], 'yacht', 1, [600, 1200, 1800, 3000, 3600], [1000, 2400, 4200]),
    ('yacht_2014', ['yachts/*20140620*'], 'yacht', 1, [600, 1500, 2400, 3300], [1200, 2100, 3000]),
    ('yacht_2008', ['yachts/*2008*'], 'yacht', 1, [2100, 2700, 3300, 5100], [1000, 1800, 4000]),
]


def run(*command):
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)


def scored(tools, out, name, logs, config, options):
    """Metrics of one log, converted with these options."""
    bag = f'{out}/{name}.bag'
    run('/usr/bin/python3', f'{ROOT}/scripts/nmea_to_bag', *logs, '-o', bag, *options)
    run(f'{tools}/reprocess', bag, '-o', f'{out}/reprocessed', '--estimators', ','.join(ESTIMATORS), '--config', f'{ROOT}/config/{config}.yaml')
    run(f'{tools}/sas_motion_metrics', f'{out}/reprocessed/{name}.bag', '-o', f'{out}/{name}', '--skip', '100')
    with open(f'{out}/{name}/metrics.json', encoding='utf-8') as file:
        return json.load(file)['estimators']


def report(name, plain, withheld, jumped):
    print(f'\n{name}: withheld GNSS, error after 5 min [m] (share of distance); RMSE with injected jumps, and without [m]')
    for estimator in ESTIMATORS:
        gaps = ', '.join(f"{o['error_end']:.0f} ({o['drift_percent']:.1f} %)" for o in withheld[estimator]['outages'])
        print(f"  {estimator:<14}{gaps:<70}{jumped[estimator]['position']['rmse']:>8.2f}{plain[estimator]['position']['rmse']:>8.2f}")


def main():
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    tools, data, out = sys.argv[1:]
    os.makedirs(out, exist_ok=True)
    for name, patterns, config, variation, gaps, jumps in LOGS:
        logs = [f for pattern in patterns for f in sorted(glob.glob(f'{data}/{pattern}'))]
        if len(logs) < len(patterns):
            print(f'{name}: not in {data}')
            continue
        base = [] if variation is None else ['--variation', str(variation)]
        plain = scored(tools, out, name + '_plain', logs, config, base)
        withheld = scored(tools, out, name + '_withheld', logs, config, base + [w for g in gaps for w in ('--withhold', f'{g}:300')])
        jumped = scored(tools, out, name + '_jumped', logs, config, base + [w for j in jumps for w in ('--jump', f'{j}:15:100')])
        report(name, plain, withheld, jumped)


if __name__ == '__main__':
    main()
