#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""Wall time, CPU time and peak memory of reprocess beside a bare pass by rosbag::View, in turns; ratios are of medians.
usage: bag_speed.py TOOLS_DIR SCENARIO OUT_DIR SECONDS"""
import os
import shutil
import statistics
import subprocess
import sys
import time

RUNS = 7


def run(command):
    """Seconds, CPU seconds and peak memory [MiB] of a command."""
    begin = time.perf_counter()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    if status != 0:
        sys.exit(f'bag_speed: {command[0]} failed')
    return time.perf_counter() - begin, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024


def measure(tools, scenario, out, seconds):
    bag, reprocessed = f'{out}/length_{seconds:g}.bag', f'{out}/reprocessed'
    subprocess.run([f'{tools}/simulate', scenario, '-o', bag, '--duration', str(seconds)], check=True)
    commands = {'bare': [f'{tools}/read_bag', bag], 'reader': [f'{tools}/read_bag', bag, 'BagReader'],
                'reprocess': [f'{tools}/reprocess', bag, '-o', reprocessed, '--estimators', 'kf,robust_kf']}
    runs = {name: [] for name in commands}
    for _ in range(RUNS):
        shutil.rmtree(reprocessed, ignore_errors=True)  # deleting an older result is not a part of making one
        for name, command in commands.items():
            runs[name].append(run(command))
    (bare, bare_cpu, _), (reader, _, _), (wall, cpu, memory) = ([statistics.median(column) for column in zip(*runs[name])] for name in commands)
    print(f'{seconds:>10g}{os.path.getsize(bag) / 1e6:>10.1f}{bare:>10.3f}{reader:>12.3f}{wall:>15.3f}{wall / bare:>8.2f}{cpu / bare_cpu:>11.2f}{memory:>14.1f}', flush=True)


def main():
    tools, scenario, out, seconds = sys.argv[1:4] + [float(sys.argv[4])]
    print(f'{"data [s]":>10}{"bag [MB]":>10}{"bare [s]":>10}{"reader [s]":>12}{"reprocess [s]":>15}{"ratio":>8}{"CPU ratio":>11}{"memory [MiB]":>14}')
    for length in (seconds / 10, seconds):
        measure(tools, scenario, out, length)


if __name__ == '__main__':
    main()
