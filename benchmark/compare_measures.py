#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""Our measures of a point target beside perseo-quality's on the same chips.

usage: compare_measures.py TOOLS [CHIP...]    TOOLS: folder of point_target_answers; CHIP: unweighted, Hamming, quadratic, focused; all of them without a word
Runs in an environment with peers/requirements_imaging.txt; where perseo-quality is not installed it says so, prints our measures and has exit status 2.
Exit status 1 where PSLR, or ISLR over the same side lobes, differ by more than 0.05 dB, or a width by more than 0.5 %. perseo-quality's own ISLR ends the
side lobes at 10 widths, not at 10 times half the main lobe: its column is printed beside, and has no bound.
"""
import json
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

SAME_RATIO = 0.05  # [dB]
SAME_WIDTH = 0.005  # perseo-quality's is at half the power, ours at 10^-0.3 of it, which makes 0.1 to 0.2 %
DIRECTIONS = (('range', 'range_step'), ('along', 'along_step'))

try:
    from peers import perseo_peer
except ImportError as why:
    perseo_peer = None
    print(f'NOT COMPARED with perseo-quality: {why}')


def row(name, ours, theirs, step):
    """Prints one cut; whether both agree."""
    pairs = [(ours['irw'], theirs and theirs.irw * step), (ours['pslr'], theirs and theirs.pslr), (ours['islr'], theirs and theirs.islr_same_extent),
             (ours['extent'], theirs and 10 * theirs.irw * step)]
    agree = ours['complete'] and (theirs is None or abs(pairs[0][1] / pairs[0][0] - 1) <= SAME_WIDTH and all(abs(a - b) <= SAME_RATIO for a, b in pairs[1:3]))
    text = [f'{value:>10.{digits}f}' if value is not None else 10 * ' ' for pair, digits in zip(pairs, (5, 3, 3, 3)) for value in pair]
    own = f'{theirs.islr:>10.3f}' if theirs else 10 * ' '
    print(f'{name:<20}{"".join(text[:6])}{own}{"".join(text[6:])}{"" if agree else "  MISSED"}', flush=True)
    return agree


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    print(f'{"":<20}{"IRW [m]":>20}{"PSLR [dB]":>20}{"ISLR [dB]":>20}{"own ends":>10}{"ends at [m]":>20}')
    print(f'{"chip, cut":<20}' + 3 * f'{"ours":>10}{"theirs":>10}' + f'{"theirs":>10}{"ours":>10}{"theirs":>10}')
    agreed = True
    with tempfile.TemporaryDirectory() as folder:
        tool = [str(pathlib.Path(sys.argv[1]) / 'point_target_answers'), folder]
        for chip in json.loads(subprocess.run(tool, check=True, capture_output=True, text=True).stdout):
            if sys.argv[2:] and chip['name'] not in sys.argv[2:]:
                continue
            stem = pathlib.Path(folder) / chip['name']
            pixels, axes = np.load(f'{stem}.npy'), json.loads(stem.with_suffix('.json').read_text())
            halves = [chip[direction]['extent'] / 10 / axes[step] for direction, step in DIRECTIONS]
            cuts = perseo_peer.measures(pixels.astype(complex), halves) if perseo_peer else (None, None)
            for (direction, step), theirs in zip(DIRECTIONS, cuts):
                agreed &= row(f'{chip["name"]}, {direction}', chip[direction], theirs, axes[step])
    sys.exit(1 if not agreed else 0 if perseo_peer else 2)


if __name__ == '__main__':
    main()
