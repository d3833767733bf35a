# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""The sentences a reader needs first, computed from the metrics."""
import math

from .columns import number, outside, percent, quantity
from .inputs import dig, finite, ranked


def headline(metrics):
    """Returns the sentences: accuracy, aperture, consistency, rejection, divergence."""
    scored = [(name, e) for name, e in ranked(metrics) if not e.get('diverged')]
    sentences = [accuracy(scored), aperture(scored), consistency(scored), rejection(scored), divergence(metrics)]
    return [sentence for sentence in sentences if sentence]


def accuracy(scored):
    """Compares the best filter with the plain one, and the best smoother with the best filter."""
    errors = {name: e['position']['rmse'] for name, e in scored if finite(dig(e, 'position', 'rmse'))}
    if not errors:
        return 'There is no truth for position, so accuracy is not scored.'
    filters = [name for name, e in scored if name in errors and e.get('nis')]
    smoothers = [name for name in errors if name not in filters]
    if not filters:
        filters, smoothers = smoothers, []
    text = compare(filters[0], plain_filter(filters), errors)
    if smoothers:
        text += f'; the smoother {smoothers[0]} is {closer(errors[filters[0]], errors[smoothers[0]])} {filters[0]} ({number(errors[smoothers[0]])} m)'
    return text + '.'


def plain_filter(filters):
    """Returns what to compare with: the plain Kalman filter, or else the worst."""
    return 'kf' if 'kf' in filters[1:] else filters[-1]


def compare(name, other, errors):
    """Returns how much closer one estimator is than another."""
    if name == other:
        return f'{name} is off by {number(errors[name])} m (position RMSE)'
    return f'{name} is {closer(errors[other], errors[name])} {other} (position RMSE {number(errors[name])} m against {number(errors[other])} m)'


def closer(worse, better):
    """Returns '4.1 times closer to truth than', or its opposite, or equality within 5 %."""
    ratio = worse / better if better > 0 else math.inf
    if 1 / 1.05 < ratio < 1.05:
        return 'as close to truth as'
    return f'{ratio:.1f} times closer to truth than' if ratio > 1 else f'{1 / max(ratio, 1e-9):.1f} times farther from truth than'


def aperture(scored):
    """States the position error that blurs an image."""
    errors = [(e['aperture']['across'], name, e['aperture']) for name, e in scored if finite(dig(e, 'aperture', 'across'))]
    if not errors:
        return None
    across, name, best = min(errors, key=lambda item: item[0])
    wavelengths = f', {number(best["across_wavelengths"])} λ' if finite(best.get('across_wavelengths')) else ''
    return (f'Within one synthetic aperture ({quantity(best.get("time"))} s) {name} strays least: {number(1e3 * across)} mm RMS across track'
            f'{wavelengths}; λ/32, that is 0.031 λ, costs about 0.7 dB of the peak.')


def consistency(scored):
    """States whose position covariance is right, from NEES, or from NIS without truth."""
    groups = {-1: [], 0: [], 1: []}
    for name, e in scored:
        band = dig(e, 'nees', 'position') or dig(e, 'nis', 'position')
        side = outside(band) and (0 if nearly_right(band) else outside(band))
        if side is not None:
            groups[side].append(name if side == 0 else f'{name} ({sigmas(band)})')
    endings = {0: 'agrees with its errors', 1: 'is too small', -1: 'is too large'}
    parts = [f'for {listing(groups[side])} it {endings[side]}' for side in (0, 1, -1) if groups[side]]
    return 'The stated position uncertainty: ' + '; '.join(parts) + '.' if parts else None


def nearly_right(band):
    """Tells whether errors and stated sigma agree within 10 %, which long records reveal but nobody need mind."""
    return bool(band.get('degrees')) and 0.9 <= math.sqrt(max(band['mean'], 0) / band['degrees']) <= 1.1


def sigmas(band):
    """Returns how large the errors are beside the stated sigma."""
    if not band.get('degrees'):
        return f'mean {number(band["mean"])}'
    ratio = math.sqrt(max(band['mean'], 0) / band['degrees'])
    return f'errors {ratio:.1f}σ in RMS' if ratio < 1000 else 'errors more than 1000σ in RMS'


def rejection(scored):
    """States how well outliers were separated from good measurements."""
    tallies = [(name, e['outliers']['all']) for name, e in scored if finite(dig(e, 'outliers', 'all', 'recall'))]
    if not tallies:
        return None
    name, best = max(tallies, key=lambda item: f_score(item[1]))
    idle = [other for other, tally in tallies if not tally.get('flagged')]
    flags = f'; {listing(idle)} set{"s" if len(idle) == 1 else ""} nothing aside' if idle else ''
    if not best.get('flagged'):
        return f'None set aside any of the {best.get("labelled", 0)} labelled outliers.'
    return (f'{name} caught {percent(best["recall"])} % of the {best.get("labelled", 0)} labelled outliers, '
            f'and {percent(best.get("precision"))} % of what it set aside were outliers{flags}.')


def f_score(tally):
    """Returns the harmonic mean of precision and recall."""
    precision, recall = tally.get('precision') or 0, tally.get('recall') or 0
    return 2 * precision * recall / (precision + recall) if precision + recall else 0


def divergence(metrics):
    """Names the estimators that diverged."""
    names = [name for name, e in ranked(metrics) if e.get('diverged')]
    return f'{listing(names)} diverged and {"is" if len(names) == 1 else "are"} not ranked.' if names else None


def listing(names):
    """Returns 'a', 'a and b', or 'a, b and c'."""
    return names[0] if len(names) == 1 else f'{", ".join(names[:-1])} and {names[-1]}'
