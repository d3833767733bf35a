#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""Draws what `focus` wrote into a folder: each image, and focus.png, which has them beside each other, error-free first, with cuts through their peaks."""
import json
import math
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.realpath(__file__)))

import numpy as np  # noqa: E402
import plot_image  # noqa: E402
from matplotlib import pyplot  # noqa: E402

COLUMNS = 4  # images in a row
FINE = 8  # samples of a cut for each pixel


def parse_arguments(arguments):
    """Returns the parsed command line."""
    parser = plot_image.Parser(prog='plot_focus.py', description=__doc__)
    parser.add_argument('folder', metavar='OUT_DIR', help='that focus wrote focus.json into')
    parser.add_argument('--floor', type=float, default=-40, metavar='DB', help='what is darker is black [dB under the error-free peak] (default: %(default)s)')
    parser.add_argument('--dpi', type=int, default=110, help='of focus.png, which is 14 inches wide (default: %(default)s)')
    options = parser.parse_args(arguments)
    if not 20 <= options.dpi <= 1000:
        parser.error(f'--dpi is {options.dpi} but must be from 20 to 1000')
    if not options.floor < 0:
        parser.error(f'--floor is {options.floor} but must be below 0')
    return options


class Picture:
    """One focused image with its place in the frame of the aperture."""

    def __init__(self, folder, name, measures, title):
        self.path = os.path.join(folder, measures['image'])
        self.name, self.title = name, title
        self.pixels, self.axes = plot_image.read_image(self.path)
        self.first_along = float(np.dot(self.axes['origin'], self.axes['along_axis']))
        self.first_range = float(np.dot(self.axes['origin'], self.axes['range_axis']))

    def power(self):
        return np.abs(self.pixels.astype(np.complex128)) ** 2

    def extent(self):
        """Edges in the frame of the aperture [m]: left, right, bottom, top."""
        left, right, bottom, top = plot_image.extent(self.axes)
        return [left + self.first_along, right + self.first_along, bottom + self.first_range, top + self.first_range]

    def cut(self, along):
        """(distance from the peak [m], power) through the brightest pixel, along track or in range."""
        row, column = np.unravel_index(np.argmax(self.power()), self.pixels.shape)
        line = self.pixels[row] if along else self.pixels[:, column]
        fine = np.abs(oversampled(line)) ** 2
        step = self.axes['along_step' if along else 'range_step'] / FINE
        return (np.arange(fine.size) - np.argmax(fine)) * step, fine


def oversampled(line):
    """The line with FINE times as many samples. Its spectrum, which may lie anywhere, is first turned to lie about zero."""
    spectrum = np.fft.fft(line.astype(np.complex128))
    n = spectrum.size
    middle = np.angle(np.sum(np.abs(spectrum) ** 2 * np.exp(2j * np.pi * np.arange(n) / n))) * n / (2 * np.pi)
    centred = np.roll(spectrum, n // 2 - round(middle))
    padded = np.zeros(FINE * n, dtype=complex)
    padded[(FINE * n - n) // 2:(FINE * n - n) // 2 + n] = centred
    return np.fft.ifft(np.fft.ifftshift(padded)) * FINE


def read_pictures(folder):
    """Returns the summary and all pictures, error-free first, each trajectory's autofocused one behind its own."""
    with open(os.path.join(folder, 'focus.json'), encoding='utf-8') as stream:
        summary = json.load(stream)
    pictures = []
    for name in summary['order']:
        measures = summary['trajectories'][name]
        title = 'error-free' if name == 'truth' else f'{name}, {measures["aperture_error"]["path_wavelengths"]:.3f} λ'
        pictures.append(Picture(folder, name, measures, title))
        if 'autofocused' in measures:
            pictures.append(Picture(folder, name + ', autofocused', measures['autofocused'], 'autofocused'))
    return summary, pictures


def draw_images(figure, grid, pictures, reference, floor):
    """The images on one scale, that of the error-free peak."""
    for i, picture in enumerate(pictures):
        plot = figure.add_subplot(grid[i // COLUMNS, i % COLUMNS])
        decibels = 10 * np.log10(np.maximum(picture.power() / reference, 10 ** (floor / 10)))
        shown = plot.imshow(decibels, extent=picture.extent(), origin='lower', cmap='inferno', vmin=floor, vmax=0, aspect='equal')
        plot.set_title(picture.title, fontsize='medium')
        plot.tick_params(labelsize='small')
        plot.set_xlabel('along track [m]', fontsize='small')
        if i % COLUMNS == 0:
            plot.set_ylabel('ground range [m]', fontsize='small')
    figure.colorbar(shown, ax=figure.axes, label='power [dB]', shrink=0.8)


def draw_cuts(plots, pictures, reference, floor):
    """All cuts along track and all in range, one colour a trajectory."""
    for plot, along, label in zip(plots, (True, False), ('along track from the peak [m]', 'ground range from the peak [m]')):
        for picture in pictures:
            place, power = picture.cut(along)
            plot.plot(place, 10 * np.log10(np.maximum(power / reference, 1e-12)), linewidth=2 if picture is pictures[0] else 1, label='error-free' if picture is pictures[0] else picture.name)
        half = abs(pictures[0].axes['along_step' if along else 'range_step']) * 64
        plot.set_xlim(-half, half)
        plot.set_ylim(floor, 3)
        plot.set_xlabel(label)
        plot.set_ylabel('power [dB]')
        plot.grid(alpha=0.3)
    plots[0].legend(fontsize='small')


def draw_comparison(summary, pictures, floor, dpi, output):
    """Writes the figure."""
    rows = math.ceil(len(pictures) / COLUMNS)
    figure = pyplot.figure(figsize=(14, 4 * rows + 4), layout='constrained')
    upper, lower = figure.subfigures(2, 1, height_ratios=[rows, 1.1])
    reference = pictures[0].power().max() or 1.0
    draw_images(upper, upper.add_gridspec(rows, min(COLUMNS, len(pictures))), pictures, reference, floor)
    draw_cuts(lower.subplots(1, 2), pictures, reference, floor)
    window = summary['window']
    figure.suptitle('{}: aperture of {:.1f} m from {:.1f} s, λ = {:.4g} m; RMS error of the paths'.format(
        os.path.basename(summary['bag']), window['length'], window['start'], summary['wavelength']), fontsize='medium')
    plot_image.save(figure, output, dpi=dpi)


def main():
    options = parse_arguments(sys.argv[1:])
    try:
        summary, pictures = read_pictures(options.folder)
        for picture in pictures:
            plot_image.draw(picture.pixels, picture.axes, options.floor, os.path.splitext(picture.path)[0] + '.png')
            pyplot.close('all')
        draw_comparison(summary, pictures, options.floor, options.dpi, os.path.join(options.folder, 'focus.png'))
    except (OSError, ValueError, KeyError) as error:
        sys.exit(f'plot_focus.py: {options.folder} cannot be drawn: {error}')


if __name__ == '__main__':
    main()
