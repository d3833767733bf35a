# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""FastSAR's exact backprojection on one core. Its speed of propagation is that of light: frequencies are scaled by light over sound, so that ranges stay.

It takes phase histories, samples of the spectrum referred to one range, and upsamples them by zeros in their gap. Its ExactFormer, in float about tile centres,
has a regular grid and transmitter and receiver in one place; its backproject(), in double, any points.
"""
import fastsar
import numpy as np
from fastsar.exact import C as LIGHT

UPSAMPLING = 8  # its default


def phase_history(problem):
    """The lines' spectra in ascending frequency, referred to the range of the middle sample; that range; the lowest frequency and the step, both scaled."""
    count = problem.lines.shape[1]
    reference_delay = problem.first_delay + count / 2 / problem.sample_rate
    offsets = (np.arange(count) - count // 2) * problem.sample_rate / count
    turns = np.outer(np.ones(len(problem.lines)), offsets * (reference_delay - problem.first_delay) + problem.carrier * reference_delay)
    spectra = np.fft.fftshift(np.fft.fft(problem.lines, axis=1), axes=1) / count * np.exp(2j * np.pi * turns)
    scale = LIGHT / problem.sound_speed
    return spectra.astype(np.complex64), reference_delay * problem.sound_speed / 2, scale * (problem.carrier + offsets[0]), scale * problem.sample_rate / count


def formers(problem):
    """By name, what makes the image. Geometry and compiled kernels are made ready here, so that a call takes the time of the image alone."""
    history, reference, lowest, step = phase_history(problem)
    references = np.full(len(history), reference)
    rows, columns = problem.points.shape[:2]
    first, along, across = problem.points[0, 0], problem.points[0, 1] - problem.points[0, 0], problem.points[1, 0] - problem.points[0, 0]
    spacing_across, spacing_along = np.linalg.norm(across), np.linalg.norm(along)
    result = {}
    for interpolation, factor in (('linear', UPSAMPLING), ('linear', 2 * UPSAMPLING), ('cubic', UPSAMPLING)):  # cubic is its default
        former = fastsar.ExactFormer(problem.places, lowest, step, history.shape[1], rows, columns, spacing_across, spacing_along, across / spacing_across,
                                     along / spacing_along, backend='cpu', window=False, interp=interpolation, upsample=factor, ref=references,
                                     center=first + rows / 2 * across + columns / 2 * along)
        result[f'{interpolation}, {factor} x'] = lambda former=former: former(history)
    result[f'double, linear, {UPSAMPLING} x'] = lambda: fastsar.backproject(history, problem.places, lowest, step, problem.points, ref=references, backend='cpu',
                                                                upsample=UPSAMPLING, window=False)
    return result
