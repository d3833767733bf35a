#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""Our backprojection beside NumPy's and FastSAR's: the same lines, pixels and phase, on one core.

usage: compare_backprojection.py TOOLS [LINES ROWS COLUMNS REPEATS]    TOOLS: folder of backprojection_answers
Runs in an environment with peers/requirements_imaging.txt; where FastSAR is not installed it says so, measures the rest and has exit status 2. Exit
status 1 where an image is further from double than its bound.

Rates are 10^6 lines times pixels a second of CPU time, the best of the repeats, all with upsampling of the lines. The exact image is NumPy's image of the middle
of the grid from lines upsampled 64 times, where linear reading errs by less than -85 dB. FastSAR compiles itself for this machine; FFBP_CPU_FLAGS="-O3
-march=x86-64-v3" makes it do so for AVX2.
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

os.environ['OMP_NUM_THREADS'] = '1'  # before NumPy and FastSAR are loaded
import numpy as np  # noqa: E402
from peers import numpy_backprojection  # noqa: E402

try:
    from peers import fastsar_peer
except ImportError as why:
    fastsar_peer = None
    print(f'FastSAR is NOT measured: {why}')

EXACT = -60  # of our image [dB]
AGREE = -50  # of the peers' images and of what they differ from ours [dB]: linear reading of lines upsampled 8 times without more errs by that
EXACT_UPSAMPLING = 64
NUMPY_UPSAMPLING = 8


class Problem:
    """Lines heard from places, and the points of the grid; lines are padded to a power of two, so that every peer upsamples by a whole number."""

    def __init__(self, folder, description):
        self.carrier, self.sound_speed = description['carrier'], description['sound_speed']
        self.sample_rate, self.first_delay = description['sample_rate'], description['first_delay']
        self.places = np.array(description['places'])
        heard = np.fromfile(folder / 'lines.c64', np.complex64).reshape(len(self.places), description['samples'])
        self.lines = np.pad(heard, ((0, 0), (0, (1 << (heard.shape[1] - 1).bit_length()) - heard.shape[1])))
        self.points = grid_points(folder / 'image.json')


def grid_points(path):
    axes = json.loads(path.read_text())
    rows, columns = np.arange(axes['rows'])[:, None, None], np.arange(axes['columns'])[None, :, None]
    return axes['origin'] + rows * axes['range_step'] * np.array(axes['range_axis']) + columns * axes['along_step'] * np.array(axes['along_axis'])


def decibels(image, reference):
    """Energy of the difference over that of the reference [dB]."""
    return 10 * np.log10(np.sum(np.abs(image - reference) ** 2) / np.sum(np.abs(reference) ** 2))


def timed(problem, make, repeats):
    """The image and the rate."""
    fastest = np.inf
    for _ in range(repeats):
        begin = time.process_time()
        image = make()
        fastest = min(fastest, time.process_time() - begin)
    return image, 1e-6 * len(problem.lines) * image.size / fastest


def peers(problem, repeats):
    """Names, images and rates."""
    yield f'NumPy, double, linear, {NUMPY_UPSAMPLING} x', *timed(problem, lambda: numpy_backprojection.image(problem, problem.points, NUMPY_UPSAMPLING), 1)
    for name, form in fastsar_peer.formers(problem).items() if fastsar_peer else ():
        yield f'FastSAR {name}', *timed(problem, form, repeats if 'double' not in name else 1)


def main():
    if len(sys.argv) not in (2, 6):
        sys.exit(__doc__)
    lines, rows, columns, repeats = (int(a) for a in (sys.argv[2:] or ['256', '1024', '512', '5']))
    os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    with tempfile.TemporaryDirectory() as folder:
        tool = [str(pathlib.Path(sys.argv[1]) / 'backprojection_answers'), folder, *map(str, (lines, rows, columns, repeats))]
        description = json.loads(subprocess.run(tool, check=True, capture_output=True, text=True).stdout)
        folder = pathlib.Path(folder)
        problem, ours, reference = Problem(folder, description), np.load(folder / 'image.npy'), np.load(folder / 'reference.npy')
    middle = tuple(slice((whole - part) // 2, (whole + part) // 2) for whole, part in zip(ours.shape, reference.shape))
    exact = numpy_backprojection.image(problem, problem.points[middle], EXACT_UPSAMPLING)

    best = max(description['rates'].values())
    missed = 0

    def row(name, rate, image, bound):
        nonlocal missed
        error, from_ours = decibels(image[middle] if image.shape == ours.shape else image, exact), decibels(image, ours) if bound == AGREE else None
        agrees = error <= bound and (from_ours is None or from_ours <= AGREE)
        missed += not agrees
        speed = f'{rate:>16.0f}{best / rate:>15.2f}' if rate else 31 * ' '
        print(f'{name:<30}{speed}{f"{from_ours:.1f}" if from_ours else "":>15}{error:>18.1f}{"" if agrees else "  MISSED"}', flush=True)

    print(f'{lines} lines, {rows} x {columns} pixels')
    print(f'{"program":<30}{"M a CPU second":>16}{"ours / theirs":>15}{"from ours [dB]":>15}{"from double [dB]":>18}')
    for name, rate in sorted(description['rates'].items(), key=lambda item: -item[1]):
        row(f'sas_motion, {name}', rate, ours, EXACT)
    row('sas_motion, double', None, reference, EXACT)
    for name, image, rate in peers(problem, repeats):
        row(name, rate, image, AGREE)
    sys.exit(1 if missed else 0 if fastsar_peer else 2)


if __name__ == '__main__':
    main()
