# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""perseo-quality's analysis of a point target on a chip, rows along range.

Its main lobe ends at the first minima, as ours does. Its width is taken at half the power (ours at 10^-0.3 of it), between samples linearly in dB (ours in
power). Its side lobes reach 5 widths each side of the peak for the PSLR and 10 for the ISLR; ours 10 times half the main lobe for both. The function that
gives the ISLR takes the width as an argument, from which it has the end of the side lobes and nothing else: with half our main lobe for the width, they end
where ours do.
"""
import math
from types import SimpleNamespace

from perseo_quality.core import signal_processing
from perseo_quality.point_targets_analysis.core import irf, pre_processing

OVERSAMPLING = 16  # its default
STRAIGHT = (math.inf, 0.0)  # side lobes along the axes


def measures(chip, half_main_lobes):
    """Widths [pixels], PSLR and ISLR [dB], as range and along track; islr_same_extent where side lobes end at 10 times these half main lobes [pixels]."""
    _, row, column = signal_processing.locate_max_2d_interp(chip)
    fine = pre_processing.target_area_interpolation(chip, (row, column), OVERSAMPLING, chip.shape)
    _, _, *widths = pre_processing.compute_data_resolution_pixel(fine, pre_processing.TargetDataType.COMPLEX, STRAIGHT)
    pslr = irf.compute_pslr_2d(fine, widths, irf.MaskingMethod.PEAK, STRAIGHT)[:2]
    islr = irf.compute_islr_2d(fine, widths, irf.MaskingMethod.PEAK, STRAIGHT)[:2]
    same = irf.compute_islr_2d(fine, [half * OVERSAMPLING for half in half_main_lobes], irf.MaskingMethod.PEAK, STRAIGHT)[:2]
    return [SimpleNamespace(irw=width / OVERSAMPLING, pslr=p, islr=i, islr_same_extent=s) for width, p, i, s in zip(widths, pslr, islr, same)]
