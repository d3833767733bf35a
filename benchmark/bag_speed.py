#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""Wall time and peak memory of reprocess beside a bare pass. usage: bag_speed.py TOOLS_DIR SCENARIO OUT_DIR SECONDS"""
import os
import statistics
import subprocess
import sys
import time


def run(command):
    """Seconds and peak memory [MiB] of a command."""
    begin = time.perf_counter()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    if status != 0:
        sys.exit(f'bag_speed: {command[0]} failed')
    return time.perf_counter() - begin, usage.ru_maxrss / 1024


def measure(tools, scenario, out, seconds):
    bag = f'{out}/length_{seconds:g}.bag'
    subprocess.run([f'{tools}/simulate', scenario, '-o', bag, '--duration', str(seconds)], check=True)
    bare, ours, memory = [], [], 0
    for _ in range(3):
        bare.append(run([f'{tools}/read_bag', bag])[0])
        elapsed, memory = run([f'{tools}/reprocess', bag, '-o', f'{out}/reprocessed', '--estimators', 'kf,robust_kf'])
        ours.append(elapsed)
    ratio = statistics.median(o / b for o, b in zip(ours, bare))
    print(f'{seconds:>10g}{os.path.getsize(bag) / 1e6:>10.1f}{statistics.median(bare):>10.2f}{statistics.median(ours):>14.2f}{ratio:>8.2f}{memory:>14.1f}')


def main():
    tools, scenario, out, seconds = sys.argv[1:4] + [float(sys.argv[4])]
    print(f'{"data [s]":>10}{"bag [MB]":>10}{"bare [s]":>10}{"reprocess [s]":>14}{"ratio":>8}{"memory [MiB]":>14}')
    for length in (seconds / 10, seconds):
        measure(tools, scenario, out, length)


if __name__ == '__main__':
    main()
