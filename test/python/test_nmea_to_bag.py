# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""nmea_to_bag: sentences, their times, what the bag holds, and what happens when something is wrong."""
import datetime
import math
import os
import pathlib
import resource
import subprocess
import sys

import pytest

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
TOOL = ROOT / "scripts" / "nmea_to_bag"
SAMPLE = ROOT / "test" / "data" / "sample.nmea"
REAL = pathlib.Path(os.environ.get("SAS_MOTION_DATA", ROOT.parent / "shared" / "data"))
sys.path[:0] = [str(ROOT / "scripts"), str(HERE)]

rosbag = pytest.importorskip("rosbag")

import make_sample  # noqa: E402
from make_sample import sentence  # noqa: E402
from sas_motion_nmea import clock, messages, selection  # noqa: E402
from sas_motion_nmea.readings import Fix, Heading, readings  # noqa: E402
from sas_motion_nmea.sentences import SECOND, BadChecksum, split  # noqa: E402

KNOT = 0.514444


def run(*arguments, **options):
    """The tool in a process of its own."""
    environment = {**os.environ, "PYTHONDONTWRITEBYTECODE": "1", **options.pop("env", {})}
    return subprocess.run([sys.executable, TOOL, *map(str, arguments)], text=True, capture_output=True,
                          env=environment, check=False, **options)


def topics(path):
    """Messages by topic; record times must equal the stamps."""
    found = {}
    with rosbag.Bag(str(path)) as bag:
        for topic, message, time in bag.read_messages():
            found.setdefault(topic, []).append(message)
            assert topic == "/tf_static" or message.header.stamp == time
    return found


def convert(folder, log, *arguments):
    """(topics, stdout) of a log: a path, or the text of one."""
    if isinstance(log, str):
        text, log = log, folder / "log.nmea"
        log.write_text(text)
    done = run(log, "-o", folder / "out.bag", *arguments)
    assert done.returncode == 0, done.stderr
    return topics(folder / "out.bag"), done.stdout


def seconds(messages_of_topic):
    return [m.header.stamp.to_sec() for m in messages_of_topic]


def heading_of(imu):
    """Clockwise from north [deg], by REP-103."""
    yaw = 2 * math.atan2(imu.orientation.z, imu.orientation.w)
    return math.degrees(math.pi / 2 - yaw) % 360


def read(body):
    return readings(split(sentence(body)))


@pytest.fixture(scope="module")
def sample(tmp_path_factory):
    return convert(tmp_path_factory.mktemp("sample"), SAMPLE, "--variation", "2")


# ---- sentences

def test_the_sample_is_what_its_function_makes():
    assert SAMPLE.read_text() == make_sample.sample()


def test_a_wrong_checksum_is_refused_and_a_right_one_is_not():
    assert split("$HEHDT,218.53,T*12").name == "HEHDT"
    with pytest.raises(BadChecksum):
        split("$HEHDT,218.54,T*12")


@pytest.mark.parametrize("line", ["", "noise", "$", "$IIMW3,T*", "$HEHDT,218.53,T*1", "$*00"])
def test_a_line_without_a_sentence_is_no_crash(line):
    with pytest.raises(ValueError):
        split(line)


@pytest.mark.parametrize("body", ["IIRMC,100000,A,5448.0,N", "IIRMC,100000,A,5460.0,N,00936.0,E,5,62,050621,,,A",
                                  "IIRMC,250000,A,5448.0,N,00936.0,E,5,62,050621,,,A", "IIHDG,361,,,,", "IIVHW,,,060,M,nan,N,,",
                                  "IIRMC,100000,A,5448.0,,00936.0,E,5,62,050621,,,A", "GPZDA,000000,32,08,2014,,"])
def test_a_field_that_is_no_value_is_refused(body):
    with pytest.raises(ValueError):
        read(body)


def test_positions_have_their_signs():
    fix, = read("GPGGA,000000.70,2200.112071,S,01756.360200,W,1,10,0.9,1.04,M,4.5,M,,")
    assert (fix.latitude, fix.longitude) == pytest.approx((-22.00186785, -17.93933667), abs=1e-8)
    assert fix.altitude == pytest.approx(5.54) and fix.time_of_day == 700_000_000 and fix.valid


def test_knots_become_metres_per_second():
    assert read("IIVHW,,,249,M,03.5,N,,")[1].through_water == pytest.approx(3.5 * KNOT, rel=1e-5)
    assert read("IIVHW,,,249,M,,,36.0,K")[1].through_water == pytest.approx(10.0)
    assert read("VDVBW,-1.5,0.2,A,,,V")[0].through_water == pytest.approx(-1.5 * KNOT, rel=1e-5)
    assert read("VDVBW,1.5,0.2,V,,,V") == []


def test_the_adcp_velocity_is_projected_on_the_heading():
    heading, speed = readings(split("$PUHAW,UVH,-5.0,0.0,240.0"))
    assert heading == Heading(240.0, True)
    assert speed.through_water == pytest.approx(5.0 * math.cos(math.radians(30)) * KNOT, rel=1e-5)


def test_vhw_prefers_its_true_heading():
    assert read("IIVHW,251.0,T,249.0,M,3.5,N,,")[0] == Heading(251.0, True)
    assert read("IIVHW,,T,249.0,M,3.5,N,,")[0] == Heading(249.0, False)


# ---- time

@pytest.mark.parametrize("text, expected", [("1970-01-01T00:00:01.5Z x", 1_500_000_000), ("1970-01-01T01:00:00+01:00 x", 0),
                                            ("1970-01-02 00:00:00,x", 86400 * SECOND), ("$GPRMC", None),
                                            ("1970-13-01T00:00:00Z x", None)])
def test_arrival_times(text, expected):
    assert clock.arrival_time(text) == expected


def test_repeated_and_false_times_are_no_anchors():
    assert clock.longest_rise([(0, 10), (5, 11), (9, 11), (12, 99), (15, 12), (20, 3), (22, 13)]) == [(0, 10), (5, 11), (15, 12), (22, 13)]


def test_sentences_between_two_times_are_spread_and_rise(sample):
    for topic in ("gnss/fix", "imu/data", "dvl/twist", "truth/fix"):
        times = seconds(sample[0][topic])
        assert all(b > a for a, b in zip(times, times[1:]))
    steps = [b - a for a, b in zip(seconds(sample[0]["dvl/twist"]), seconds(sample[0]["dvl/twist"])[1:])]
    assert 0.5 < min(steps) and max(steps) < 1.6


def test_a_log_with_the_logger_switched_off_does_not_spread_over_the_hole(tmp_path):
    cycles = [make_sample.cycle(s) for s in (*range(20), *range(200, 220))]
    found, _ = convert(tmp_path, "\n".join(line for c in cycles for line in c))
    times = [t - seconds(found["gnss/fix"])[0] for t in seconds(found["dvl/twist"])]
    assert not [t for t in times if 21 < t < 199]


def test_midnight_is_passed(tmp_path):
    lines = [sentence(f"GPGGA,{t},5448.0,N,00936.0,E,1,9,1.0,0,M,0,M,,") for t in ("235958", "235959", "000000", "000001")]
    found, _ = convert(tmp_path, "\n".join(lines), "--date", "2020-02-29")
    start = datetime.datetime(2020, 2, 29, 23, 59, 58, tzinfo=datetime.timezone.utc).timestamp()
    assert seconds(found["gnss/fix"]) == [start, start + 1, start + 2, start + 3]


def test_logs_with_arrival_times_are_merged(tmp_path):
    gyro, gps = tmp_path / "gyro", tmp_path / "gps"
    gyro.write_text("".join(f"2014-08-01T00:00:0{i}.200000Z $HEHDT,10.0,T\n" for i in range(5)))
    gps.write_text("".join(f"2014-08-01T00:00:0{i}.700000Z $GPGLL,2200.0,S,01756.0,W\n" for i in range(5)))
    found = convert(tmp_path, gyro, gps)[0]
    assert seconds(found["imu/data"])[0] == pytest.approx(1406851200.2, abs=1e-6)
    assert [round(b - a, 6) for a, b in zip(seconds(found["imu/data"]), seconds(found["gnss/fix"]))] == [0.5] * 5


# ---- choice among sources

def test_one_fix_an_epoch(tmp_path):
    found, _ = convert(tmp_path, "\n".join(
        line for s in range(10) for line in (sentence(f"GPRMC,10000{s},A,5448.0,N,00936.0,E,5,62,050621,,,A"),
                                             sentence(f"GPGLL,5448.0,N,00936.0,E,10000{s},A,A"),
                                             sentence(f"GPGGA,10000{s},5448.0,N,00936.0,E,1,9,2.0,0,M,0,M,,"))))
    assert len(found["gnss/fix"]) == 10
    assert {m.position_covariance[0] for m in found["gnss/fix"]} == {25.0}


def test_headings_come_from_one_source(tmp_path):
    text = "\n".join(line for s in range(10) for line in (
        sentence(f"GPRMC,10000{s},A,5448.0,N,00936.0,E,5,62,050621,,,A"), sentence("IIVHW,,,90,M,3,N,,"),
        sentence("IIHDG,91,,,2,W"), sentence("HEHDT,92,T")))
    found, _ = convert(tmp_path, text)
    assert {round(heading_of(m), 6) for m in found["imu/data"]} == {92.0}
    found, _ = convert(tmp_path, text, "--heading-source", "HDG")
    assert {round(heading_of(m), 6) for m in found["imu/data"]} == {89.0}


@pytest.mark.parametrize("hdg, rmc, option, expected", [("3,E", ",", None, 103), ("3,W", "5,E", 7, 97), (",", "5,W", 7, 95), (",", ",", 7, 107),
                                                        (",", ",", None, 100)])
def test_magnetic_becomes_true_by_the_nearest_variation(tmp_path, hdg, rmc, option, expected):
    lines = [line for s in range(3) for line in (sentence(f"GPRMC,10000{s},A,5448.0,N,00936.0,E,5,62,050621,{rmc},A"), sentence(f"IIHDG,100,,,{hdg}"))]
    found, out = convert(tmp_path, "\n".join(lines), *([] if option is None else ["--variation", option]))
    assert heading_of(found["imu/data"][-1]) == pytest.approx(expected)
    assert ("give --variation" in out) == (expected == 100)


# ---- messages

@pytest.mark.parametrize("degrees, yaw", [(0, math.pi / 2), (90, 0), (180, -math.pi / 2), (45, math.pi / 4), (359, math.pi / 2 + math.radians(1))])
def test_a_heading_becomes_an_enu_yaw(degrees, yaw):
    message = messages.imu(clock.Reading(0, "HEHDT", Heading(degrees, True)), math.radians(2))
    assert (message.orientation.z, message.orientation.w) == pytest.approx((math.sin(yaw / 2), math.cos(yaw / 2)))
    assert (message.orientation.x, message.orientation.y) == (0, 0)
    assert message.orientation_covariance[8] == pytest.approx(math.radians(2) ** 2) and message.orientation_covariance[0] == 0.01
    assert message.angular_velocity_covariance[0] == message.linear_acceleration_covariance[0] == -1


def test_covariance_of_a_fix_is_hdop_with_a_floor_or_unknown():
    def message(hdop):
        return messages.nav_sat_fix(clock.Reading(0, "GPGGA", Fix(0, None, 1.0, 2.0, True, hdop=hdop)))
    assert message(2.0).position_covariance[0] == 25.0 and message(2.0).position_covariance_type == 1
    assert message(0.1).position_covariance[4] == 1.0
    assert message(None).position_covariance_type == 0 and not any(message(None).position_covariance)


def test_the_sample_has_what_was_put_in(sample):
    found, out = sample
    fixes = found["gnss/fix"]
    assert [m.status.status for m in fixes].count(-1) == 5
    assert len(fixes) == make_sample.DURATION - len(make_sample.REPEATED_AT)
    assert len(found["imu/data"]) == make_sample.DURATION - 1
    assert {round(heading_of(m), 6) for m in found["imu/data"]} == {make_sample.HEADING_TRUE}
    assert {round(m.twist.twist.linear.x, 5) for m in found["dvl/twist"]} == {round(5 * 1852 / 3600, 5)}
    assert len(found["truth/fix"]) == len(fixes) - 5
    for line in ("bad checksums:                  1", "implied speed above 50 m/s:     2", "IIDPT 240"):
        assert line in out


def test_frames_sequence_and_the_latched_transforms(sample, tmp_path):
    found, _ = sample
    for topic, frame in (("gnss/fix", "gnss_link"), ("imu/data", "imu_link"), ("dvl/twist", "dvl_link")):
        assert {m.header.frame_id for m in found[topic]} == {frame}
        assert [m.header.seq for m in found[topic]] == list(range(len(found[topic])))
    assert [t.child_frame_id for t in found["/tf_static"][0].transforms] == ["gnss_link", "imu_link", "dvl_link"]
    convert(tmp_path, SAMPLE)
    with rosbag.Bag(str(tmp_path / "out.bag")) as bag:
        assert [c.header["latching"] for c in bag._get_connections(["/tf_static"])] in (["1"], [b"1"])


# ---- withholding and jumps

def test_withheld_fixes_are_left_out_and_the_reference_keeps_them(sample, tmp_path):
    found, out = convert(tmp_path, SAMPLE, "--variation", "2", "--withhold", "20:30", "--withhold", "200:10")
    start = seconds(sample[0]["gnss/fix"])[0]
    times = [t - start for t in seconds(found["gnss/fix"])]
    assert not [t for t in times if 20 <= t < 50 or 200 <= t < 210] and 50 in times and 19 in times
    assert str(found["truth/fix"]) == str(sample[0]["truth/fix"])  # as text: NaN is not itself
    assert "fixes withheld:                 40" in out


def test_a_jump_moves_the_fixes_north_by_its_metres_and_not_the_reference(sample, tmp_path):
    found, out = convert(tmp_path, SAMPLE, "--variation", "2", "--jump", "70:5:100")
    start = seconds(sample[0]["gnss/fix"])[0]
    for moved, plain in zip(found["gnss/fix"], sample[0]["gnss/fix"]):
        if moved.status.status < 0:
            continue
        expected = 100.0 if 70 <= plain.header.stamp.to_sec() - start < 75 else 0.0
        assert math.radians(moved.latitude - plain.latitude) * selection.EARTH_RADIUS == pytest.approx(expected, abs=1e-3)
        assert moved.longitude == plain.longitude
    assert str(found["truth/fix"]) == str(sample[0]["truth/fix"])  # as text: NaN is not itself
    assert "fixes displaced:                5" in out


# ---- bytes, errors, atomicity

def test_the_same_logs_give_the_same_bytes(tmp_path):
    for name, seed in (("a.bag", "1"), ("b.bag", "2")):
        assert run(SAMPLE, "-o", tmp_path / name, env={"PYTHONHASHSEED": seed}).returncode == 0
    assert (tmp_path / "a.bag").read_bytes() == (tmp_path / "b.bag").read_bytes()


@pytest.mark.parametrize("text, word", [("nothing here\n", "no NMEA"), (sentence("HEHDT,10.0,T") + "\n", "--date"), ("", "no NMEA"),
                                        (sentence("IIDPT,10.0,0") + "\n", "no position")])
def test_a_log_that_cannot_serve_is_named_in_one_sentence(tmp_path, text, word):
    log = tmp_path / "bad.log"
    log.write_text(text)
    done = run(log, "-o", tmp_path / "out.bag")
    assert done.returncode == 1 and str(log) in done.stderr and word in done.stderr
    assert len(done.stderr.splitlines()) == 1 and "Traceback" not in done.stderr
    assert os.listdir(tmp_path) == ["bad.log"]


def test_other_failures_are_plain_too(tmp_path):
    missing, nowhere = tmp_path / "missing.log", tmp_path / "no" / "out.bag"
    cases = [((missing, "-o", tmp_path / "o.bag"), str(missing)), ((SAMPLE, "-o", nowhere), str(nowhere)), ((SAMPLE, "-o", tmp_path), str(tmp_path)),
             ((SAMPLE, "-o", SAMPLE), str(SAMPLE)), ((SAMPLE, "-o", tmp_path / "o.bag", "--heading-source", "HDT"), "HDT"),
             ((SAMPLE, "-o", tmp_path / "o.bag", "--withhold", "9999:10"), "--withhold")]
    for arguments, word in cases:
        done = run(*arguments)
        assert done.returncode == 1 and word in done.stderr and len(done.stderr.splitlines()) == 1, arguments
    assert os.listdir(tmp_path) == []


@pytest.mark.parametrize("arguments", [["--withhold", "10"], ["--withhold", "5:-1"], ["--jump", "1:2"], ["--variation", "nan"], ["--date", "1.2.3"],
                                       ["--speed-sigma", "0"], ["--unknown"]])
def test_wrong_usage_exits_2(tmp_path, arguments):
    assert run(SAMPLE, "-o", tmp_path / "out.bag", *arguments).returncode == 2


def test_a_full_disk_leaves_the_old_bag_as_it_was(tmp_path):
    (tmp_path / "out.bag").write_bytes(b"an old good bag")
    done = run(SAMPLE, "-o", tmp_path / "out.bag", preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (50_000, 50_000)))
    assert done.returncode == 1 and "out.bag" in done.stderr and "Traceback" not in done.stderr
    assert (tmp_path / "out.bag").read_bytes() == b"an old good bag" and os.listdir(tmp_path) == ["out.bag"]


# ---- real logs, where they are

@pytest.mark.skipif(not (REAL / "yachts").is_dir(), reason="the real logs are not here")
def test_a_real_yacht(tmp_path):
    for log in sorted((REAL / "yachts").glob("Irene*")):
        found, out = convert(tmp_path, log, "--variation", "1")
        assert len(found["truth/fix"]) > 1000
        speeds = [m.twist.twist.linear.x for m in found["dvl/twist"]]
        assert 0 <= min(speeds) and max(speeds) < 15 and len(speeds) > 1000
        times = seconds(found["gnss/fix"])
        assert all(b > a for a, b in zip(times, times[1:])) and times[-1] - times[0] < 3 * 3600, out


@pytest.mark.skipif(not (REAL / "ship_nbp1406").is_dir(), reason="the real logs are not here")
def test_a_real_ship(tmp_path):
    ship = REAL / "ship_nbp1406"
    logs = [ship / f"NBP1406_{name}-2014-08-01" for name in ("seap", "gyr1", "adcp")]
    found, _ = convert(tmp_path, logs[0], *logs[1:])
    assert (len(found["gnss/fix"]), len(found["imu/data"]), len(found["dvl/twist"])) == (715, 5000, 5000)
    assert all(210 < heading_of(m) < 230 for m in found["imu/data"])
    assert all(3 < m.twist.twist.linear.x < 6 for m in found["dvl/twist"])
