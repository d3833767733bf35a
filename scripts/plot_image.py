#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""Draws a focused image, IMAGE.npy with its axes in IMAGE.json, as a PNG in dB under its peak, with axes in metres."""
import argparse
import json
import os
import sys

import numpy as np
import matplotlib
matplotlib.use('Agg')
from matplotlib import pyplot  # noqa: E402


class Parser(argparse.ArgumentParser):
    """An argument parser whose errors are one sentence."""

    def error(self, message):
        self.exit(2, f'{self.prog}: {message}; see {self.prog} --help\n')


def parse_arguments(arguments):
    """Returns the parsed command line."""
    parser = Parser(prog='plot_image.py', description=__doc__)
    parser.add_argument('image', metavar='IMAGE.npy')
    parser.add_argument('-o', '--output', metavar='OUT.png', help='default: IMAGE.png')
    parser.add_argument('--floor', type=float, default=-40, metavar='DB', help='what is darker is black [dB under the peak] (default: %(default)s)')
    options = parser.parse_args(arguments)
    if not options.floor < 0:
        parser.error(f'--floor is {options.floor} but must be below 0')
    return options


def read_image(path):
    """Returns the complex pixels and their axes."""
    pixels = np.load(path, allow_pickle=False)
    with open(os.path.splitext(path)[0] + '.json', encoding='utf-8') as stream:
        axes = json.load(stream)
    if pixels.shape != (axes['rows'], axes['columns']):
        raise ValueError(f'it has {pixels.shape} pixels, but its axes say ({axes["rows"]}, {axes["columns"]})')
    return pixels, axes


def decibels(pixels, floor):
    """Power under the peak [dB], cut at the floor."""
    power = np.abs(pixels.astype(np.complex128)) ** 2
    peak = power.max() or 1.0
    return 10 * np.log10(np.maximum(power / peak, 10 ** (floor / 10)))


def extent(axes):
    """Edges of the image along track and in range, from the middle of the first pixel [m]: left, right, bottom, top."""
    along, across = axes['along_step'], axes['range_step']
    return [-along / 2, (axes['columns'] - 0.5) * along, -across / 2, (axes['rows'] - 0.5) * across]


def draw(pixels, axes, floor, output):
    """Writes the picture."""
    figure, plot = pyplot.subplots(figsize=(8, 6), layout='constrained')
    shown = plot.imshow(decibels(pixels, floor), extent=extent(axes), origin='lower', cmap='inferno', vmin=floor, vmax=0, aspect='equal')
    plot.set_xlabel('along track [m]')
    plot.set_ylabel('ground range [m]')
    plot.set_title('from ({:.2f}, {:.2f}, {:.2f}) m'.format(*axes['origin']), fontsize='medium')
    figure.colorbar(shown, label='power under the peak [dB]')
    save(figure, output, dpi=150)


def save(figure, output, dpi):
    """Writes a figure under a temporary name and renames it."""
    temporary = f'{output}.{os.getpid()}.part'
    figure.savefig(temporary, format='png', dpi=dpi)
    os.replace(temporary, output)


def main():
    options = parse_arguments(sys.argv[1:])
    try:
        pixels, axes = read_image(options.image)
        draw(pixels, axes, options.floor, options.output or os.path.splitext(options.image)[0] + '.png')
    except (OSError, ValueError, KeyError) as error:
        sys.exit(f'plot_image.py: {options.image} cannot be drawn: {error}')


if __name__ == '__main__':
    main()
