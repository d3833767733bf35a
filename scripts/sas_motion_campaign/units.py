# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""What groups of errors are called and measured in where people read them; in the files they are in SI units."""
import math

PER_RADIAN = 180 / math.pi
# in the order in which a reader looks for them
UNITS = {'position': 'm', 'mounting': 'deg', 'drift_percent': '%', 'outage': 'm', 'height': 'm', 'velocity': 'm/s', 'tilt': 'deg', 'heading': 'deg', 'speed': 'm/s',
         'current': 'm/s', 'lever': 'm'}
NAMES = {'drift_percent': 'drift', 'outage': 'end of outage'}
ORDER = list(UNITS)


def kind(group):
    """Returns what a group is one of: a single unknown, lever_x, is one of its vector, lever."""
    return group if group in UNITS else group.split('_')[0]


def unit(group):
    """Returns the unit of a group; None where it is not known."""
    return UNITS.get(kind(group))


def title(group):
    """Returns the name of a group with its unit."""
    return f'{NAMES.get(group, group)} [{unit(group)}]' if unit(group) else group


def factor(group):
    """Returns what an error in SI units is multiplied by."""
    return PER_RADIAN if unit(group) == 'deg' else 1


def ordered(groups):
    """Returns the groups as a reader looks for them: position, velocity, attitude, the rest behind."""
    return sorted(groups, key=lambda group: (ORDER.index(kind(group)) if kind(group) in ORDER else len(ORDER), group))
