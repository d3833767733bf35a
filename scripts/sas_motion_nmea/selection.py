# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""Which readings become messages: one source of each quantity, one fix an epoch, and the faults asked for."""
from __future__ import annotations

import collections
import math
from typing import NamedTuple, Optional

from sas_motion_nmea.clock import Reading
from sas_motion_nmea.readings import Fix, Heading, Speed
from sas_motion_nmea.sentences import SECOND

POSITION_ORDER = ("GGA", "RMC", "GLL")
HEADING_ORDER = ("HDT", "UVH", "HDG", "HDM", "VHW")
SPEED_ORDER = ("VBW", "UVH", "VHW")
EARTH_RADIUS = 6371008.8  # mean [m]


class Interval(NamedTuple):
    start: float  # after the log's start [s]
    duration: float  # [s]
    metres: float = 0.0  # north [m]

    def holds(self, time: int, log_start: int) -> bool:
        """Whether a time [ns] lies inside."""
        return self.start <= (time - log_start) / SECOND < self.start + self.duration


class Headings(NamedTuple):
    readings: list  # of Heading, all true
    is_magnetic: bool
    unknown_variation: int  # how many were magnetic with no variation known: taken as true


def kind_of(name: str) -> str:
    """RMC of IIRMC, UVH of PUHAW,UVH."""
    return name[-3:]


def choose(readings: list, order: tuple, wanted: Optional[str]) -> Optional[str]:
    """The name of the source to use: the wanted one, else the first kind in order; of several talkers the busiest."""
    counts = collections.Counter(r.name for r in readings)
    names = [n for n in counts if wanted in (None, n, kind_of(n))]
    if wanted and not names:
        raise LookupError(f"{wanted} is not in the logs; they have {', '.join(sorted(counts)) or 'no such sentence'}")
    return min(names, key=lambda n: (order.index(kind_of(n)), -counts[n], n), default=None)


def of_type(readings: list, value_type: type) -> list:
    """The readings that hold a value of a type."""
    return [r for r in readings if isinstance(r.value, value_type)]


def select_fixes(readings: list, wanted: Optional[str]) -> tuple:
    """(source, fixes): one an epoch of one receiver; unless a source was asked for, its other sentences fill holes."""
    fixes = of_type(readings, Fix)
    valid = [r for r in fixes if r.value.valid]
    source = choose(fixes if wanted else valid or fixes, POSITION_ORDER, wanted)
    best = {}
    for index, fix in enumerate(fixes):
        is_filler = not wanted and fix.epoch is not None and source[:-3] == fix.name[:-3]
        if fix.name != source and not is_filler:
            continue
        key = fix.epoch if fix.epoch is not None else ("line", index)
        rank = (not fix.value.valid, POSITION_ORDER.index(kind_of(fix.name)))
        if key not in best or rank < best[key][0]:
            best[key] = (rank, fix)
    return source, strictly_rising([fix for _, fix in best.values()])


def select_headings(readings: list, wanted: Optional[str], default_variation: Optional[float]) -> tuple:
    """(source, Headings), all true: by the sentence's own variation, else RMC's last, else the default [deg]."""
    source = choose(of_type(readings, Heading), HEADING_ORDER, wanted)
    variation, chosen, is_magnetic, unknown = default_variation, [], False, 0
    for reading in readings:
        value = reading.value
        if isinstance(value, Fix) and value.variation is not None:
            variation = value.variation
        if not isinstance(value, Heading) or reading.name != source:
            continue
        if not value.is_true:
            is_magnetic = True
            own = value.variation if value.variation is not None else variation
            unknown += own is None
            value = Heading((value.degrees + (own or 0.0)) % 360.0, True)
        chosen.append(reading._replace(value=value))
    return source, Headings(strictly_rising(chosen), is_magnetic, unknown)


def select_speeds(readings: list, wanted: Optional[str]) -> tuple:
    """(source, speeds)."""
    speeds = of_type(readings, Speed)
    source = choose(speeds, SPEED_ORDER, wanted)
    return source, strictly_rising([r for r in speeds if r.name == source])


def strictly_rising(readings: list) -> list:
    """In time order; of equal times the later is moved on by a microsecond."""
    risen = []
    for reading in sorted(readings, key=lambda r: r.time):
        earliest = risen[-1].time + 1000 if risen else reading.time
        risen.append(reading._replace(time=max(reading.time, earliest)))
    return risen


def displaced(fix: Reading, metres: float) -> Reading:
    """The fix moved north [m]."""
    latitude = fix.value.latitude + math.degrees(metres / EARTH_RADIUS)
    return fix._replace(value=fix.value._replace(latitude=latitude))


def with_faults(fixes: list, withheld: list, jumps: list, log_start: int) -> tuple:
    """(fixes, number withheld, number displaced): the fixes as the filter shall see them."""
    kept = [f for f in fixes if not any(w.holds(f.time, log_start) for w in withheld)]
    shifts = [sum(j.metres for j in jumps if j.holds(f.time, log_start)) for f in kept]
    seen = [displaced(f, shift) if shift else f for f, shift in zip(kept, shifts)]
    return seen, len(fixes) - len(kept), sum(1 for shift in shifts if shift)


def implied_jumps(fixes: list, limit: float) -> int:
    """How many valid fixes lie farther from the one before than a speed [m/s] allows."""
    return sum(distance(a.value, b.value) > limit * (b.time - a.time) / SECOND for a, b in zip(fixes, fixes[1:]))


def distance(a: Fix, b: Fix) -> float:
    """The short way between two places on a sphere [m]."""
    north = math.radians(b.latitude - a.latitude)
    east = math.radians((b.longitude - a.longitude + 180.0) % 360.0 - 180.0) * math.cos(math.radians(a.latitude))
    return EARTH_RADIUS * math.hypot(north, east)
