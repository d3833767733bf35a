# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""NMEA 0183 sentences: the split of a line, its checksum, and the values of its fields."""
from __future__ import annotations

import datetime
import functools
import math
import operator
import re
from typing import NamedTuple, Optional

KNOT = 1852.0 / 3600.0  # [m/s]
SECOND = 1_000_000_000  # [ns]
LINE = re.compile(r"[$!]([^$!*]*)(?:\*([0-9A-Fa-f]{2}))?\s*$")
ADDRESS = re.compile(r"P[A-Z0-9]{2,}|[A-Z0-9]{5}")
TIME = re.compile(r"(\d\d)(\d\d)(\d\d)(?:\.(\d*))?")
DATE = re.compile(r"(\d\d)(\d\d)(\d\d)")


class BadChecksum(ValueError):
    """The checksum does not fit the sentence."""


class Sentence(NamedTuple):
    name: str  # as the summary shows it: IIRMC, or PUHAW,UVH
    kind: str  # RMC, HDT, ...; the whole address of a proprietary sentence
    fields: list
    has_checksum: bool


def split(line: str) -> Sentence:
    """The last sentence on a line. Raises BadChecksum, or ValueError where there is no sentence."""
    found = LINE.search(line)
    if not found:
        raise ValueError("no sentence")
    body, checksum = found.groups()
    if checksum and functools.reduce(operator.xor, body.encode("utf-8"), 0) != int(checksum, 16):
        raise BadChecksum(line)
    address, *fields = body.split(",")
    if not ADDRESS.fullmatch(address):
        raise ValueError("no address")
    if address == "PUHAW" and fields[:1] == ["UVH"]:
        return Sentence("PUHAW,UVH", "UVH", fields[1:], bool(checksum))
    kind = address if address[0] == "P" else address[2:]
    return Sentence(address, kind, fields, bool(checksum))


def number(text: str) -> Optional[float]:
    """A plain decimal number, None where the field is empty."""
    if text == "":
        return None
    if not re.fullmatch(r"[+-]?\d*\.?\d+|[+-]?\d+\.", text):
        raise ValueError(f"{text!r} is no number")
    return float(text)


def one_of(text: str, choices: str) -> str:
    """The text, when it is one letter of the choices."""
    if len(text) != 1 or text not in choices:
        raise ValueError(f"{text!r} is none of {choices}")
    return text


def read_time_of_day(text: str) -> Optional[int]:
    """hhmmss.sss to ns since midnight, None where empty."""
    if text == "":
        return None
    found = TIME.fullmatch(text)
    if not found or int(found[1]) > 23 or int(found[2]) > 59 or int(found[3]) > 60:
        raise ValueError(f"{text!r} is no time")
    seconds = int(found[1]) * 3600 + int(found[2]) * 60 + int(found[3])
    return seconds * SECOND + int((found[4] or "").ljust(9, "0")[:9])


def read_date(text: str) -> Optional[datetime.date]:
    """ddmmyy to a date, None where empty; years 80 to 99 are of the last century."""
    if text == "":
        return None
    found = DATE.fullmatch(text)
    if not found:
        raise ValueError(f"{text!r} is no date")
    year = int(found[3])
    return datetime.date(year + (1900 if year >= 80 else 2000), int(found[2]), int(found[1]))


def angle(text: str, hemisphere: str, letters: str, limit: float) -> float:
    """dddmm.mmm and its hemisphere to degrees; NaN where empty."""
    value = number(text)
    if value is None:
        return math.nan
    degrees, minutes = divmod(value, 100.0)
    if value < 0 or minutes >= 60 or degrees + minutes / 60 > limit:
        raise ValueError(f"{text!r} is no angle")
    return (degrees + minutes / 60) * (1 if one_of(hemisphere, letters) == letters[0] else -1)


def read_position(fields: list) -> tuple:
    """Four fields to latitude and longitude [deg]."""
    return angle(fields[0], fields[1], "NS", 90.0), angle(fields[2], fields[3], "EW", 180.0)


def east_positive(value: str, direction: str) -> Optional[float]:
    """A variation or deviation and its side to degrees, east positive."""
    degrees = number(value)
    return None if degrees is None else degrees * (1 if one_of(direction, "EW") == "E" else -1)
