# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""What a sentence tells: fixes, clocks, headings and speeds, in degrees and SI."""
from __future__ import annotations

import datetime
import math
from typing import NamedTuple, Optional

from sas_motion_nmea.sentences import (
    KNOT, Sentence, east_positive, number, one_of, read_date, read_position, read_time_of_day,
)


class Fix(NamedTuple):
    time_of_day: Optional[int]  # the receiver's own UTC [ns]
    date: Optional[datetime.date]
    latitude: float  # [deg], NaN where the sentence has none
    longitude: float  # [deg]
    valid: bool
    altitude: float = math.nan  # above the ellipsoid [m]
    hdop: Optional[float] = None
    variation: Optional[float] = None  # magnetic, east positive [deg]


class Clock(NamedTuple):
    time_of_day: int  # UTC [ns]
    date: datetime.date


class Heading(NamedTuple):
    degrees: float  # clockwise from north [deg]
    is_true: bool
    variation: Optional[float] = None  # east positive [deg]


class Speed(NamedTuple):
    through_water: float  # forward [m/s]


def readings(sentence: Sentence) -> list:
    """What a sentence tells: fixes, headings, speeds, clocks. Raises ValueError where a field is no value."""
    reader = READERS.get(sentence.kind)
    try:
        return reader(sentence.fields) if reader else []
    except IndexError:
        raise ValueError(f"{sentence.name} is cut short") from None


def _heading(text: str, is_true: bool, variation: Optional[float] = None) -> list:
    """A heading in [0, 360] deg, or nothing where the field is empty."""
    degrees = number(text)
    if degrees is None:
        return []
    if not 0 <= degrees <= 360:
        raise ValueError(f"{text!r} is no heading")
    return [Heading(degrees % 360.0, is_true, variation)]


def _rmc(f: list) -> list:
    latitude, longitude = read_position(f[2:6])
    variation = east_positive(f[9], f[10]) if len(f) > 10 else None
    valid = one_of(f[1], "AV") == "A" and math.isfinite(latitude + longitude)
    return [Fix(read_time_of_day(f[0]), read_date(f[8]), latitude, longitude, valid, variation=variation)]


def _gga(f: list) -> list:
    latitude, longitude = read_position(f[1:5])
    above_geoid, geoid = number(f[8]), number(f[10])
    altitude = math.nan if above_geoid is None or geoid is None else above_geoid + geoid
    valid = (number(f[5]) or 0) > 0 and math.isfinite(latitude + longitude)
    return [Fix(read_time_of_day(f[0]), None, latitude, longitude, valid, altitude, number(f[7]))]


def _gll(f: list) -> list:
    latitude, longitude = read_position(f[0:4])
    valid = (len(f) < 6 or one_of(f[5], "AV") == "A") and math.isfinite(latitude + longitude)
    return [Fix(read_time_of_day(f[4]) if len(f) > 4 else None, None, latitude, longitude, valid)]


def _hdg(f: list) -> list:
    deviation = east_positive(f[1], f[2]) or 0.0
    heading = _heading(f[0], False, east_positive(f[3], f[4]))
    return [h._replace(degrees=(h.degrees + deviation) % 360.0) for h in heading]


def _vhw(f: list) -> list:
    knots, km_per_hour = number(f[4]), number(f[6]) if len(f) > 6 else None
    speed = knots * KNOT if knots is not None else None if km_per_hour is None else km_per_hour / 3.6
    heading = _heading(f[0], True) or _heading(f[2], False)
    return heading + ([] if speed is None else [Speed(speed)])


def _vbw(f: list) -> list:
    knots = number(f[0])
    return [] if knots is None or one_of(f[2], "AV") == "V" else [Speed(knots * KNOT)]


def _uvh(f: list) -> list:
    """The ship's velocity through the water, east and north [knots], projected on the heading [deg]."""
    east, north, heading = number(f[0]), number(f[1]), _heading(f[2], True)
    if east is None or north is None or not heading:
        return heading
    angle = math.radians(heading[0].degrees)
    return heading + [Speed((east * math.sin(angle) + north * math.cos(angle)) * KNOT)]


def _zda(f: list) -> list:
    time_of_day = read_time_of_day(f[0])
    if time_of_day is None or "" in f[1:4]:
        return []
    return [Clock(time_of_day, datetime.date(int(f[3]), int(f[2]), int(f[1])))]


READERS = {
    "RMC": _rmc, "GGA": _gga, "GLL": _gll, "ZDA": _zda, "HDG": _hdg, "VHW": _vhw, "VBW": _vbw, "UVH": _uvh,
    "HDT": lambda f: _heading(f[0], True), "HDM": lambda f: _heading(f[0], False),
}
