# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""Backprojection as one would write it with NumPy: double, line by line over all pixels, linear between upsampled samples."""
import numpy as np


def upsampled(line, factor):
    """The line on a grid finer by this factor, by zeros in the gap of its spectrum, which lies at half the sampling rate."""
    middle = len(line) // 2
    spectrum = np.fft.fft(line)
    fine = np.zeros(factor * len(line), complex)
    fine[:middle], fine[-middle:] = spectrum[:middle], spectrum[middle:]
    return factor * np.fft.ifft(fine)


def image(problem, points, factor):
    """The image at points (rows, columns, 3), by lines upsampled by this factor."""
    total = np.zeros(points.shape[:2], complex)
    for line, place in zip(problem.lines, problem.places):
        fine = upsampled(line, factor)
        length = 2 * np.sqrt(((points - place) ** 2).sum(axis=2))
        position = (length / problem.sound_speed - problem.first_delay) * problem.sample_rate * factor
        at = position.astype(int)
        weight = position - at
        total += ((1 - weight) * fine[at] + weight * fine[at + 1]) * np.exp(2j * np.pi * problem.carrier / problem.sound_speed * length)
    return total
