# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""The sentences a reader needs, computed from the summary."""
from sas_motion_report.columns import number
from sas_motion_report.headline import listing
from sas_motion_report.inputs import dig, finite

from .reference import NAMES, contenders, middle, nearest, pairs, ratio, reference

LOOSE = 1.1  # times the bound, where even the best stays above it
TRUSTED = (0.8, 1.25)  # NEES over its degrees within which the stated sigma is right to an eighth


def sentences(campaign, costs):
    """Returns the sentences on one campaign, the chief one first."""
    found = [winner(campaign), runner_up(campaign), beside_kf(campaign), bound(campaign), below_bound(campaign), consistency(campaign),
             failures(campaign, 'diverged', 'Diverged, and only counted'), failures(campaign, 'locked_out', 'Locked out: sure of the wrong place for more than five epochs'),
             unconverged(campaign), cost(campaign, costs)]
    return [sentence for sentence in found if sentence]


def winner(campaign):
    """Names the estimator that is nearest to the reference in the most laws."""
    name, laws, ratios = nearest(campaign)[0]
    text = f'{name} is the most accurate in {laws} of {count(campaign["laws"], "law")}'
    if not ratios or reference(campaign) == 'best':
        return text + '.'
    worst = max(ratios, key=ratios.get)
    return f'{text}: {times(middle(ratios))} the error of {NAMES[reference(campaign)]} in the middle law, {times(ratios[worst])} at worst ({worst}).'


def runner_up(campaign):
    """Names who follows."""
    others = [item for item in nearest(campaign)[1:] if item[2]]
    if not others or reference(campaign) == 'best':
        return None
    name, _, ratios = min(others, key=lambda item: middle(item[2]))
    worst = max(ratios, key=ratios.get)
    return f'Next is {name}: {times(middle(ratios))} in the middle law, {times(ratios[worst])} at worst ({worst}).'


def beside_kf(campaign):
    """Compares the winner with the plain Kalman filter: what it costs on clean data, what it saves elsewhere."""
    name = nearest(campaign)[0][0]
    found = [ratio(law, name, 'kf') for law in campaign['laws'].values()]
    if name == 'kf' or found[0] is None:
        return None
    gains = [1 / value for value in found[1:] if value]
    clean = 100 * (found[0] - 1)
    text = f'Beside kf, {name} is {abs(clean):.1f} % {"worse" if clean >= 0 else "better"} under {next(iter(campaign["laws"]))}'
    return text + (f' and {span(gains)} times closer to truth under the other laws.' if gains else '.')


def bound(campaign):
    """Says where the bound is tight, and where even the best stays well above it."""
    least = {name: min((v for v in (ratio(law, e, 'bound') for e in campaign['estimators']) if v), default=None) for name, law in campaign['laws'].items()}
    known = {name: value for name, value in least.items() if value}
    if not known:
        return None
    loose = [f'{name} ({times(value)})' for name, value in known.items() if value > LOOSE]
    tight = len(known) - len(loose)
    text = f'The bound is reached within {100 * (LOOSE - 1):.0f} % in {tight} of {count(known, "law")}'
    return text + (f'; nobody comes so near under {listing(loose)}, where it is loose or the filters have room.' if loose else '.')


def below_bound(campaign):
    """Names who lies below the bound by more than chance, which no unbiased estimator does."""
    found = [f'{name} under {law} ({dig(tree, "estimators", name, "ratios", "bound", "value"):.3f})' for law, tree in campaign['laws'].items()
             for name in campaign['estimators'] if below(dig(tree, 'estimators', name, 'ratios', 'bound', 'high'))]
    return f'Below the bound by more than chance: {listing(found)}; they know more than the bound supposes, or something is amiss.' if found else None


def below(high):
    """Tells whether an interval ends below one."""
    return finite(high) and high < 1


def consistency(campaign):
    """Returns a sentence about whose stated uncertainty is right in every law."""
    spans = {}
    for law, name in pairs(campaign):
        value = dig(law, 'estimators', name, 'nees', 'full', 'value')
        if finite(value):
            spans.setdefault(name, []).append(value)
    if not spans:
        return None
    right = [name for name, values in spans.items() if min(values) >= TRUSTED[0] and max(values) <= TRUSTED[1]]
    small = [f'{name} (NEES/n up to {number(max(values))})' for name, values in spans.items() if max(values) > TRUSTED[1]]
    parts = ([f'right in every law for {listing(right)}'] if right else []) + ([f'too small in some for {listing(small)}'] if small else [])
    large = [name for name, values in spans.items() if name not in right and max(values) <= TRUSTED[1]]
    parts += [f'too large in some for {listing(large)}'] if large else []
    return f'The stated uncertainty is {"; ".join(parts)}.'


def failures(campaign, key, title):
    """Counts the runs that failed, by estimator."""
    counts = {}
    for law, name in pairs(campaign):
        tree = law['estimators'][name]
        lost, all_of_them = counts.get(name, (0, 0))
        counts[name] = lost + (tree[key] or 0), all_of_them + tree['runs']
    lost = [f'{name} {n} of {all_of_them} runs' for name, (n, all_of_them) in counts.items() if n]
    return f'{title}: {listing(lost)}.' if lost else None


def unconverged(campaign):
    """Counts the runs that never came near the truth to stay, by estimator; None where all did or nobody watched."""
    counts = {}
    for law, name in pairs(campaign):
        found = dig(law, 'estimators', name, 'convergence')
        if found:
            lost, all_of_them = counts.get(name, (0, 0))
            counts[name] = lost + found['runs'] - found['converged'], all_of_them + found['runs']
    lost = [f'{name} {n} of {all_of_them} runs' for name, (n, all_of_them) in counts.items() if n]
    return f'Never near the truth to stay: {listing(lost)}.' if lost else None


def cost(campaign, costs):
    """Compares the winner's cost with the plain filter's, or names the cheapest."""
    means = {}
    for law, name in ((law, name) for law in campaign['laws'] for name in contenders(campaign)):
        if finite(dig(costs, law, name)):
            means.setdefault(name, []).append(dig(costs, law, name))
    name = nearest(campaign)[0][0]
    if name not in means:
        return None
    mean = {other: sum(values) / len(values) for other, values in means.items()}
    beside = f', {mean[name] / mean["kf"]:.1f} times that of kf' if mean.get('kf') and name != 'kf' else ''
    return f'An update of {name} costs {number(mean[name])} µs{beside}.'


def times(value):
    """Returns a ratio as words."""
    return f'{value:.2f} times'


def count(things, noun):
    """Returns '1 law' or '3 laws'."""
    return f'{len(things)} {noun}{"" if len(things) == 1 else "s"}'


def span(values):
    """Returns '1.4' or '1.4 to 3.0'."""
    low, high = f'{min(values):.1f}', f'{max(values):.1f}'
    return low if low == high else f'{low} to {high}'
