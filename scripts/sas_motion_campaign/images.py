# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""What campaigns of system imaging say of images: measures over all apertures of a law, and what an aperture error costs."""
import math

import numpy as np

from .bootstrap import rounded

ERROR = 'path_wavelengths'
EDGES = [0] + [2.0 ** -n for n in range(9, 2, -1)] + [math.inf]  # of aperture errors [wavelengths]
COSTS = ('pslr_along', 'islr_along', 'peak_loss')  # that an aperture error has


def image(results):
    """Returns {measure: its median and 90 % quantile of its size over the windows of all runs}, and how many windows had a peak to measure."""
    windows = windows_of(results)
    names = sorted({name for window in windows for name in window if name != 'start'})
    return {'windows': len(windows), 'measured': sum(window.get('peak_loss') is not None for window in windows),
            'measures': {name: spread([window.get(name) for window in windows]) for name in names}}


def windows_of(results):
    """Returns the windows of all runs."""
    return [window for result in results for window in result.get('windows') or []]


def spread(values):
    """Returns median and 90 % quantile of the size of what is known."""
    known = np.array([value for value in values if value is not None], dtype=float)
    if not known.size:
        return {'median': None, 'q90': None}
    return {'median': rounded(np.median(known)), 'q90': rounded(np.quantile(np.abs(known), 0.9))}


def by_aperture_error(runs):
    """Returns what the windows of all estimators and laws lose, by their aperture error: a list of classes, empty where there are no images."""
    windows = [window for results in runs.values() for window in windows_of(results) if window.get(ERROR) is not None]
    classes = []
    for low, high in zip(EDGES, EDGES[1:]):
        inside = [window for window in windows if low <= window[ERROR] < high]
        if inside:
            classes.append({'above': low, 'below': None if math.isinf(high) else high, 'windows': len(inside),
                            'measures': {name: spread([window.get(name) for window in inside]) for name in COSTS}})
    return classes


# title, unit, measure; a cell is the median and the 90 % quantile of the size
COLUMNS = (('aperture error', 'λ', ERROR), ('PSLR', 'dB', 'pslr_along'), ('ISLR', 'dB', 'islr_along'), ('width', '×', 'irw_along'), ('loss', 'dB', 'peak_loss'),
           ('autofocused PSLR', 'dB', 'autofocus_pslr_along'), ('ISLR', 'dB', 'autofocus_islr_along'), ('loss', 'dB', 'autofocus_peak_loss'),
           ('compensated PSLR', 'dB', 'compensated_pslr_along'), ('loss', 'dB', 'compensated_peak_loss'),
           ('range PSLR', 'dB', 'pslr_range'), ('ISLR', 'dB', 'islr_range'), ('moved', 'm', 'peak_error'))
DIGITS = {'λ': 3, 'm': 2, 'dB': 1, '×': 2}
CAPTION = ('Images along each estimate less the error-free one, along track unless said: median / 90 % quantile of the size, over all apertures. Aperture error: RMS of the '
           'paths. Autofocused: after phase gradient autofocus. Compensated: by the line-of-sight formula on a straight track.')
COSTS_CAPTION = 'What an aperture error costs: images of all estimators and laws, along track less the error-free one: median / 90 % quantile of the size.'


def pair(found, unit):
    """Returns a cell: median / quantile."""
    digits = DIGITS[unit]
    return '-' if not found or found['median'] is None else ' / '.join(f'{round(found[key], digits) + 0:.{digits}f}' for key in ('median', 'q90'))  # + 0: no -0.0


def image_rows(law, estimators):
    """Returns the titles and a row an estimator; empty where none has images."""
    seen = [name for name in estimators if 'image' in law['estimators'][name]]
    found = {name: law['estimators'][name]['image'] for name in seen}
    titles = ['estimator', 'images', *(f'{title} [{unit}]' for title, unit, _ in COLUMNS)]
    rows = [[name, f'{found[name]["measured"]} of {found[name]["windows"]}', *(pair(found[name]['measures'].get(measure), unit) for _, unit, measure in COLUMNS)] for name in seen]
    return [titles, *rows] if rows else []


def cost_rows(campaign):
    """Returns the titles and a row a class of aperture errors; empty without images."""
    classes = campaign.get('by_aperture_error') or []
    titles = ['aperture error', 'images', 'PSLR [dB]', 'ISLR [dB]', 'loss [dB]']
    rows = [[below(found), str(found['windows']), *(pair(found['measures'][name], 'dB') for name in COSTS)] for found in classes]
    return [titles, *rows] if rows else []


def below(found):
    """Returns a class in words."""
    return f'below λ/{1 / found["below"]:.0f}' if found['below'] else f'above λ/{1 / found["above"]:.0f}'
