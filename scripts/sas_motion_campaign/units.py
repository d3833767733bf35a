# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""What groups of errors are called and measured in where people read them; in the files they are in SI units."""
import math

PER_RADIAN = 180 / math.pi
UNITS = {'position': 'm', 'height': 'm', 'outage': 'm', 'velocity': 'm/s', 'speed': 'm/s', 'current': 'm/s', 'tilt': 'deg', 'heading': 'deg', 'drift_percent': '%',
         'mounting': 'deg', 'lever': 'm'}
NAMES = {'drift_percent': 'drift', 'outage': 'end of outage'}
ORDER = ('position', 'mounting', 'drift_percent', 'outage', 'height', 'velocity', 'tilt', 'heading', 'speed', 'current', 'lever')


def unit(group):
    """Returns the unit of a group; a single unknown has that of its kind, lever_x that of lever. None where it is not known."""
    return UNITS.get(group) or UNITS.get(group.split('_')[0])


def title(group):
    """Returns the name of a group with its unit."""
    return f'{NAMES.get(group, group)} [{unit(group)}]' if unit(group) else group


def factor(group):
    """Returns what an error in SI units is multiplied by."""
    return PER_RADIAN if unit(group) == 'deg' else 1


def ordered(groups):
    """Returns the groups as a reader looks for them: position, velocity, attitude, the rest behind."""
    return sorted(groups, key=lambda group: (ORDER.index(group) if group in ORDER else len(ORDER), group))
