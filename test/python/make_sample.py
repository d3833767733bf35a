# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""Makes test/data/sample.nmea, a synthetic yacht's log with known faults: python3 make_sample.py > ../data/sample.nmea"""
import functools
import math
import operator

START = 10 * 3600  # UTC on 2021-06-05 [s]
DURATION = 240  # [s]
HEADING_TRUE, VARIATION = 62.0, 2.0  # [deg]
SPEED_KNOTS = 5.0
JUMP_AT, JUMP_METRES = 120, 300.0  # one fix [s], north [m]
NO_FIX = range(150, 155)  # RMC says V [s]
REPEATED_AT = (60, 61)  # the GPS repeats the second 59 [s]
BAD_CHECKSUM_AT = 30  # HDG [s]
LATITUDE, LONGITUDE = 54.8, 9.6  # start [deg]


def sentence(body):
    """A body with its $ and checksum."""
    return f"${body}*{functools.reduce(operator.xor, body.encode(), 0):02X}"


def place(second):
    """NMEA's four fields of the position at a second."""
    north = SPEED_KNOTS * 1852 / 3600 * second * math.cos(math.radians(HEADING_TRUE))
    east = SPEED_KNOTS * 1852 / 3600 * second * math.sin(math.radians(HEADING_TRUE))
    latitude = LATITUDE + (north + (JUMP_METRES if second == JUMP_AT else 0)) / 111195
    longitude = LONGITUDE + east / 111195 / math.cos(math.radians(LATITUDE))
    return f"{dddmm(latitude, 2)},N,{dddmm(longitude, 3)},E"


def dddmm(degrees, width):
    """Degrees as dddmm.mmmm."""
    ten_thousandths = round(degrees * 600000)
    return f"{ten_thousandths // 600000:0{width}d}{ten_thousandths % 600000 / 10000:07.4f}"


def clock(second):
    """hhmmss at a second of the log."""
    return f"{(START + second) // 3600:02d}{(START + second) // 60 % 60:02d}{(START + second) % 60:02d}"


def cycle(second):
    """The sentences of one second."""
    gps = 59 if second in REPEATED_AT else second
    heading = f"{HEADING_TRUE - VARIATION:05.1f}"
    hdg = sentence(f"IIHDG,{heading},,,,")
    return [
        sentence(f"IIRMC,{clock(gps)},V,,,,,,,050621,,,N") if second in NO_FIX else
        sentence(f"IIRMC,{clock(gps)},A,{place(gps)},05.0,062,050621,,,A"),
        *([sentence(f"IIGGA,{clock(gps)},{place(gps)},1,09,0.8,3.0,M,42.0,M,,")] if second % 2 == 0 and second not in NO_FIX else []),
        hdg[:-2] + "00" if second == BAD_CHECKSUM_AT else hdg,
        sentence(f"IIVHW,,,{heading},M,{SPEED_KNOTS:04.1f},N,,"),
        sentence("IIDPT,018.5,-1.0,"),
    ]


def sample():
    """The whole log."""
    return "".join(line + "\n" for second in range(DURATION) for line in cycle(second))


if __name__ == "__main__":
    print(sample(), end="")
