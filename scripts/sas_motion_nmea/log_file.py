# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""One log file: its sentences counted, its readings timed."""
from __future__ import annotations

import collections
import datetime
from typing import Callable, NamedTuple, Optional

from sas_motion_nmea.clock import arrival_time, by_arrival, by_own_clock
from sas_motion_nmea.readings import readings
from sas_motion_nmea.sentences import BadChecksum, split


class Counts(NamedTuple):
    sentences: collections.Counter  # good ones by name
    lines: collections.Counter  # bad_checksum, unparseable, untimed
    clocks: set  # names of the sentences that gave the time

    @staticmethod
    def none() -> Counts:
        return Counts(collections.Counter(), collections.Counter(), set())

    def add(self, other: Counts) -> None:
        self.sentences.update(other.sentences)
        self.lines.update(other.lines)
        self.clocks.update(other.clocks)


class Entry(NamedTuple):
    line: int
    arrival: Optional[int]  # [ns]
    sentence: object
    values: list


def read_log(path: str, date: Optional[datetime.date], progress: Callable) -> tuple:
    """(readings, Counts) of a file; progress gets the bytes of each line. Raises LookupError with the reason."""
    counts = Counts.none()
    entries = without_lost_checksums(read_entries(path, counts, progress), counts)
    counts.sentences.update(e.sentence.name for e in entries)
    if not entries:
        raise LookupError("holds no NMEA 0183 sentence; give a log of lines such as $GPRMC,...")
    timed, untimed, clocks = timed_readings(entries, date)
    counts.lines["untimed"] += untimed
    counts.clocks.update(clocks)
    if not timed and any(e.values for e in entries):
        raise LookupError("holds no time: no RMC with a fix and a date, no ZDA and no arrival times; "
                          "where GGA or GLL carry the time of day, give their date with --date")
    return timed, counts


def read_entries(path: str, counts: Counts, progress: Callable) -> list:
    """Every good sentence of a file with what it tells."""
    entries = []
    with open(path, "rb") as file:
        for index, raw in enumerate(file):
            progress(len(raw))
            text = raw.decode("ascii", "replace").strip()
            try:
                if text:
                    sentence = split(text)
                    entries.append(Entry(index, arrival_time(text), sentence, readings(sentence)))
            except BadChecksum:
                counts.lines["bad_checksum"] += 1
            except ValueError:
                counts.lines["unparseable"] += 1
    return entries


def without_lost_checksums(entries: list, counts: Counts) -> list:
    """Without the sentences that lack the checksum which others of their name have: they are cut short."""
    checked = {e.sentence.name for e in entries if e.sentence.has_checksum}
    kept = [e for e in entries if e.sentence.has_checksum or e.sentence.name not in checked]
    counts.lines["bad_checksum"] += len(entries) - len(kept)
    return kept


def timed_readings(entries: list, date: Optional[datetime.date]) -> tuple:
    """(readings, how many had no time, names of the clocks), by arrival where most lines start with it."""
    if 2 * sum(e.arrival is not None for e in entries) > len(entries):
        return by_arrival([(e.arrival, e.sentence.name, value) for e in entries for value in e.values])
    return by_own_clock([(e.line, e.sentence.name, value) for e in entries for value in e.values], date)
