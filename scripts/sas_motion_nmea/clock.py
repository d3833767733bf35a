# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""The time of each sentence: by its line's arrival time, or by the log's own RMC or ZDA."""
from __future__ import annotations

import bisect
import calendar
import datetime
import re
import statistics
from typing import NamedTuple, Optional

from sas_motion_nmea.readings import Clock, Fix
from sas_motion_nmea.sentences import SECOND

DAY = 86400 * SECOND  # [ns]
LONGEST_GAP = 30 * SECOND  # a longer one must hold as many lines as usual, else the logger was off [ns]
ARRIVAL = re.compile(r"(\d{4})-(\d\d)-(\d\d)[T ](\d\d):(\d\d):(\d\d)(?:\.(\d+))?(?:Z|([+-])(\d\d):?(\d\d))?[\s,;]")


class Reading(NamedTuple):
    time: int  # UTC since 1970 [ns]
    name: str  # of the sentence
    value: object  # Fix, Clock, Heading or Speed
    epoch: Optional[int] = None  # of a fix: the receiver's own UTC [ns]


def arrival_time(line: str) -> Optional[int]:
    """The ISO time a line starts with [ns], None where it does not."""
    found = ARRIVAL.match(line)
    if not found:
        return None
    try:
        moment = datetime.datetime(*(int(found[i]) for i in range(1, 7)))
    except ValueError:
        return None
    seconds = calendar.timegm(moment.timetuple())
    if found[8]:
        seconds -= (1 if found[8] == "+" else -1) * (int(found[9]) * 3600 + int(found[10]) * 60)
    return seconds * SECOND + int((found[7] or "").ljust(9, "0")[:9])


def midnight(date: datetime.date) -> int:
    """The start of a day, UTC [ns]."""
    return calendar.timegm(date.timetuple()) * SECOND


def nearest(time_of_day: int, reference: int) -> int:
    """The time on the day that brings it nearest the reference [ns]."""
    return time_of_day + round((reference - time_of_day) / DAY) * DAY


def anchors(lines: list, date: Optional[datetime.date]) -> list:
    """(line, time) of one kind of sentence: dated RMC, else ZDA, else, from a given date on, any fix with a time."""
    fixes = [(i, value) for i, _, value in lines if isinstance(value, Fix) and value.valid and value.time_of_day is not None]
    dated = [(i, fix) for i, fix in fixes if fix.date]
    dated = dated or [(i, value) for i, _, value in lines if isinstance(value, Clock)]
    if dated:
        return longest_rise([(i, midnight(value.date) + value.time_of_day) for i, value in dated])
    if date is None or not fixes:
        return []
    times = [midnight(date) + fixes[0][1].time_of_day]
    for _, fix in fixes[1:]:
        times.append(nearest(fix.time_of_day, times[-1]))
    return longest_rise([(i, time) for (i, _), time in zip(fixes, times)])


def longest_rise(points: list) -> list:
    """The longest run of points whose times rise strictly: repeated and false times fall out."""
    tails, last, before = [], [], [None] * len(points)
    for i, (_, time) in enumerate(points):
        k = bisect.bisect_left(tails, time)
        if tails[k:k + 1] == [time]:
            continue  # the first of equal times was the freshest
        before[i] = last[k - 1] if k else None
        tails[k:k + 1], last[k:k + 1] = [time], [i]
    chain, i = [], last[-1] if last else None
    while i is not None:
        chain.append(points[i])
        i = before[i]
    return chain[::-1]


def line_time(line: int, points: list, per_line: float) -> Optional[int]:
    """The time of a line between its neighbours among the points, by its place in the file; None in a gap."""
    k = bisect.bisect_left(points, (line,))
    if k < len(points) and points[k][0] == line:
        return points[k][1]
    if 0 < k < len(points):
        (i0, t0), (i1, t1) = points[k - 1], points[k]
        is_gap = t1 - t0 > LONGEST_GAP and t1 - t0 > 4 * per_line * (i1 - i0)
        return None if is_gap else t0 + (t1 - t0) * (line - i0) // (i1 - i0)
    end, time = points[0] if k == 0 else points[-1]
    offset = round(per_line * (line - end))
    return time + offset if 0 < abs(offset) <= LONGEST_GAP else None


def by_own_clock(lines: list, date: Optional[datetime.date]) -> tuple:
    """(readings, how many had no time, names of the sentences that gave it) of a log without arrival times.

    Takes (line, name, value). A fix is stamped with its receiver's own UTC; what lies between two times is spread by place in the file.
    A fix whose own UTC is far from its place in the file has no time.
    """
    points = anchors(lines, date)
    steps = [(t1 - t0) / (i1 - i0) for (i0, t0), (i1, t1) in zip(points, points[1:])]
    per_line = statistics.median(steps) if steps else 0.0
    timed = []
    for line, name, value in lines if points else []:
        time = line_time(line, points, per_line)
        epoch = own_epoch(value, time)
        if time is not None and (epoch is None or abs(epoch - time) <= LONGEST_GAP):
            timed.append(Reading(time if epoch is None else epoch, name, value, epoch))
    at = {line for line, _ in points}
    clocks = {name for line, name, value in lines if line in at and isinstance(value, (Fix, Clock))}
    return timed, len(lines) - len(timed), clocks


def by_arrival(lines: list) -> tuple:
    """As by_own_clock, of a log whose lines start with their arrival: takes (time, name, value)."""
    timed = [Reading(time, name, value, own_epoch(value, time)) for time, name, value in lines if time is not None]
    return timed, len(lines) - len(timed), set()


def own_epoch(value: object, time: Optional[int]) -> Optional[int]:
    """The receiver's own UTC of a fix, on the day nearest a time [ns]."""
    if time is None or not isinstance(value, Fix) or value.time_of_day is None:
        return None
    return nearest(value.time_of_day, time)
