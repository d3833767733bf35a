# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""The nodelets' services: ~reset, ~set_datum, ~get_state_at, ~solve_batch."""
import math

import pytest
import rospy
import toolbox
from live import PATIENT, measurements, nodelet, quiet, transforms_of
from ros_session import wait_until
from sas_motion.srv import GetStateAt, SetDatum
from std_srvs.srv import Trigger

DATUM = PATIENT["datum"]


@pytest.fixture(scope="module")
def config(tmp_path_factory):
    return toolbox.write_yaml(tmp_path_factory.mktemp("config") / "services.yaml", {**PATIENT, "lag": 10})


def feed_to_the_end(sensors, filters, found, name="kf"):
    """Feeds and waits for the answer to the newest message."""
    last = max(message.header.stamp for _, message in found)
    before = len(filters.odometry[name])
    sensors.feed(found)
    wait_until(lambda: any(m.header.stamp == last for m in filters.odometry[name][before:]), f"the last {name}/odometry")
    quiet(filters.odometry[name])
    return [m for m in filters.odometry[name][before:] if m.header.stamp == last][-1]


@pytest.fixture(scope="module")
def filters(session, sensors, survey, config):
    with nodelet(session, sensors, "FilterNodelet", config, ["kf", "robust_kf"], transforms_of(survey)) as running:
        yield running


@pytest.fixture
def found(survey):
    return measurements(survey, 30)


def test_reset_starts_anew(sensors, filters, found):
    first = feed_to_the_end(sensors, filters, found)
    # WHEN reset
    answer = filters.call("reset", Trigger)
    assert answer.success and answer.message
    # THEN there is no state any more, and the counts begin at nothing
    assert not filters.call("get_state_at", GetStateAt, first.header.stamp, "kf").success
    filters.counts(lambda values: values["fix messages"] == "0")
    # and the same data, though older than what was settled, give the same answer
    assert toolbox.numbers(feed_to_the_end(sensors, filters, found)) == toolbox.numbers(first)
    assert filters.verdicts("kf")[3] == 0


def test_get_state_at(sensors, filters, found):
    filters.call("reset", Trigger)
    newest = feed_to_the_end(sensors, filters, found)
    now = newest.header.stamp
    # the newest stamp gives what was published, once no topic is behind
    wait_until(lambda: toolbox.numbers(filters.call("get_state_at", GetStateAt, now, "kf").odometry) == toolbox.numbers(filters.odometry["kf"][-1]), "the state published")
    newest = filters.odometry["kf"][-1]
    # a sonar's ping time between measurements, and a little ahead, lie near it
    for offset in (-3.3333, 0.05):
        stamp = now + rospy.Duration.from_sec(offset)
        for name in ("", "robust_kf"):
            state = filters.call("get_state_at", GetStateAt, stamp, name)
            assert state.success and state.odometry.header.stamp == stamp == state.current.header.stamp
            assert all(map(math.isfinite, toolbox.numbers(state.odometry)))
        a, b = state.odometry.pose.pose.position, newest.pose.pose.position
        assert math.hypot(a.x - b.x, a.y - b.y) < 2 + 3 * abs(offset)
    assert state.odometry.pose.covariance[0] > 0
    # outside the lag, and of nobody, there is none
    too_old = filters.call("get_state_at", GetStateAt, now - rospy.Duration(25), "kf")
    assert not too_old.success and "lag" in too_old.message
    nobody = filters.call("get_state_at", GetStateAt, now, "kalmann")
    assert not nobody.success and "estimator" in nobody.message


def test_set_datum_moves_the_origin(sensors, filters, found):
    filters.call("reset", Trigger)
    before, fix_before = feed_to_the_end(sensors, filters, found), filters.fixes["kf"][-1]
    # WHEN the origin moves 100 m to the north
    north = 100 / 111_300
    answer = filters.call("set_datum", SetDatum, DATUM[0] + north, DATUM[1], 0)
    assert answer.success, answer.message
    # THEN the datum says so, the same data lie 100 m further south in the map, and at the same place on earth
    wait_until(lambda: filters.datum and abs(filters.datum[-1].latitude - DATUM[0] - north) < 1e-12, "the new datum")
    after, fix_after = feed_to_the_end(sensors, filters, found), None
    wait_until(lambda: filters.fixes["kf"][-1].header.stamp == after.header.stamp, "the last fix")
    fix_after = filters.fixes["kf"][-1]
    assert after.pose.pose.position.y - before.pose.pose.position.y == pytest.approx(-100, abs=0.1)
    assert after.pose.pose.position.x == pytest.approx(before.pose.pose.position.x, abs=0.1)
    assert (fix_after.latitude, fix_after.longitude) == pytest.approx((fix_before.latitude, fix_before.longitude), abs=1e-7)
    assert filters.call("set_datum", SetDatum, *DATUM).success


@pytest.mark.parametrize("latitude, longitude", [(91, 10), (-90.5, 10), (math.nan, 10), (54, math.inf), (54, 3.6e9)])
def test_a_wrong_datum_is_refused(filters, latitude, longitude):
    answer = filters.call("set_datum", SetDatum, latitude, longitude, 0)
    assert not answer.success
    assert "datum" in answer.message and str(latitude) in answer.message
    assert all(abs(datum.latitude) <= 90 and math.isfinite(datum.longitude) for datum in filters.datum)


def test_solve_batch(session, sensors, survey, config, found):
    with nodelet(session, sensors, "SmootherNodelet", config, ["fixed_lag"], transforms_of(survey), batch=True) as smoother:
        # WHEN there are no data THEN there is nothing to solve
        answer = smoother.call("solve_batch", Trigger)
        assert not answer.success and answer.message
        # WHEN there are some THEN all are solved
        sensors.feed(found)
        smoother.counts(lambda values: int(values["imu messages"]) == sum(topic == "imu/data" for topic, _ in found))
        answer = smoother.call("solve_batch", Trigger)
        assert answer.success and "states" in answer.message
        assert int(answer.message.split()[0]) == len({message.header.stamp.to_nsec() for _, message in found})
        # and after a reset there are none again
        smoother.call("reset", Trigger)
        assert not smoother.call("solve_batch", Trigger).success
