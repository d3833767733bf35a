# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""Running nodelets are told what to do: ~set_state, ~enable_sensor, dynamic_reconfigure. Each counts from the next measurement on."""
import math

import dynamic_reconfigure.client
import pytest
import rospy
import toolbox
from live import PATIENT, measurements, nodelet, quiet, transforms_of
from ros_session import wait_until
from sas_motion.srv import EnableSensor, GetStateAt, SetState
from std_srvs.srv import Trigger

SIGMAS = [0.1, 0.1, 0.01, 0.01, 0.01, 0.01]
FAR = [5000.0, -3000.0, 0.1, 0.2, 1.0, 2.0]  # x, y, current x, current y, yaw, speed


@pytest.fixture(scope="module")
def config(tmp_path_factory):
    return toolbox.write_yaml(tmp_path_factory.mktemp("config") / "control.yaml", {**PATIENT, "lag": 10, "estimators": {"gated_kf": {"probability": 0.95}}})


@pytest.fixture(scope="module")
def running(session, sensors, survey, config):
    with nodelet(session, sensors, "FilterNodelet", config, ["kf", "robust_kf", "gated_kf"], transforms_of(survey)) as filters:
        yield filters


@pytest.fixture
def filters(running):
    running.call("reset", Trigger)
    return running


@pytest.fixture(scope="module")
def survey_messages(survey):
    return measurements(survey, 60)


def until(found, seconds):
    """The messages before and after so many seconds."""
    begin = found[0][1].header.stamp
    early = [pair for pair in found if (pair[1].header.stamp - begin).to_sec() < seconds]
    return early, found[len(early):]


def feed(sensors, filters, found, name="kf"):
    """Feeds and waits for the answer to the newest message; what was answered since."""
    before, last = len(filters.odometry[name]), max(message.header.stamp for _, message in found)
    sensors.feed(found)
    wait_until(lambda: any(m.header.stamp == last for m in filters.odometry[name][before:]), f"the last {name}/odometry")
    quiet(filters.odometry[name])
    return filters.odometry[name][before:]


def test_set_state(sensors, filters, survey_messages):
    early, late = until(survey_messages, 30)
    now = feed(sensors, filters, early)[-1].header.stamp
    # WHEN the state is set two seconds ago, for one estimator
    stamp = now - rospy.Duration(2)
    answer = filters.call("set_state", SetState, stamp, "kf", FAR, SIGMAS)
    assert answer.success, answer.message
    # THEN it is the state there, with its covariance, in the axes of the map
    state = filters.call("get_state_at", GetStateAt, stamp, "kf")
    pose, current = state.odometry.pose, state.current.twist.twist.linear
    assert (pose.pose.position.x, pose.pose.position.y, current.x, current.y) == pytest.approx(FAR[:4], abs=1e-9)
    assert 2 * math.atan2(pose.pose.orientation.z, pose.pose.orientation.w) == pytest.approx(FAR[4])
    speed = FAR[5] + FAR[2] * math.cos(FAR[4]) + FAR[3] * math.sin(FAR[4])  # over ground
    assert state.odometry.twist.twist.linear.x == pytest.approx(speed)
    assert (pose.covariance[0], pose.covariance[7], pose.covariance[35]) == pytest.approx((0.01, 0.01, 1e-4))
    # and what came since is fused on top of it
    on_top = filters.call("get_state_at", GetStateAt, now, "kf").odometry.pose
    assert on_top.covariance[0] > 0 and math.hypot(on_top.pose.position.x - FAR[0], on_top.pose.position.y - FAR[1]) < 500
    # and the other one is as it was, and measurements pull the one back
    other = filters.call("get_state_at", GetStateAt, now, "robust_kf").odometry.pose.pose.position
    assert math.hypot(other.x - FAR[0], other.y - FAR[1]) > 3000
    end = feed(sensors, filters, late)[-1].pose.pose.position
    wait_until(lambda: filters.odometry["robust_kf"][-1].header.stamp == late[-1][1].header.stamp, "robust_kf's end")
    other = filters.odometry["robust_kf"][-1].pose.pose.position
    assert math.hypot(end.x - other.x, end.y - other.y) < 2000


@pytest.mark.parametrize("change, said", [({"covariance": [1.0] * 5}, "5 numbers"), ({"covariance": [0.0] * 6}, "positive definite"), ({"covariance": [-1.0] * 6}, "positive definite"), ({"covariance": [-1.0] * 36}, "positive definite"),
                                          ({"state": [math.nan] * 6}, "finite"), ({"estimator": "kalmann"}, "no such estimator"), ({"age": 25}, "older than the lag"),
                                          ({"age": -3600}, "far from")])
def test_a_wrong_state_is_refused(change, said, sensors, filters, survey_messages):
    newest = feed(sensors, filters, until(survey_messages, 30)[0])[-1]
    stamp = newest.header.stamp - rospy.Duration(change.get("age", 0))
    answer = filters.call("set_state", SetState, stamp, change.get("estimator", "kf"), change.get("state", FAR), change.get("covariance", SIGMAS))
    assert not answer.success and said in answer.message
    assert toolbox.numbers(filters.call("get_state_at", GetStateAt, newest.header.stamp, "kf").odometry) == toolbox.numbers(newest)


def test_set_state_before_any_data_needs_a_stamp(sensors, filters, survey_messages):
    answer = filters.call("set_state", SetState, rospy.Time(), "", FAR, SIGMAS)
    assert not answer.success and "give a stamp" in answer.message
    # with one it replaces the start
    assert filters.call("set_state", SetState, survey_messages[0][1].header.stamp - rospy.Duration(1), "", FAR, SIGMAS).success
    first = feed(sensors, filters, until(survey_messages, 0.5)[0])[0]
    assert math.hypot(first.pose.pose.position.x - FAR[0], first.pose.pose.position.y - FAR[1]) < 100


def test_enable_sensor(sensors, filters, survey_messages):
    early, late = until(survey_messages, 30)
    feed(sensors, filters, early)
    assert filters.call("enable_sensor", EnableSensor, "fix", False).success
    # WHEN there are no more fixes THEN the position's doubt grows, and the diagnostics say why
    answers = feed(sensors, filters, late)
    assert answers[-1].pose.covariance[0] > 4 * answers[0].pose.covariance[0]
    ignored = sum(topic == "gnss/fix" for topic, _ in late)
    _, status = filters.counts(lambda values: values["fix while disabled"] == str(ignored))
    assert status.level == status.WARN and "fix is disabled" in status.message
    # it stays so through a reset
    filters.call("reset", Trigger)
    sensors.feed(early[:100])
    filters.counts(lambda values: values["imu messages"] != "0" and values["fix while disabled"] == values["fix messages"] != "0")
    # WHEN it is enabled again THEN fixes count from the next one on
    assert filters.call("enable_sensor", EnableSensor, "fix", True).success
    assert feed(sensors, filters, late)[-1].pose.covariance[0] < 2 * answers[0].pose.covariance[0]
    unknown = filters.call("enable_sensor", EnableSensor, "gps", True)
    assert not unknown.success and "fix, imu, twist" in unknown.message


def test_reconfigure_a_loss(sensors, filters, survey_messages):
    client = dynamic_reconfigure.client.Client(f"/{filters.name}", timeout=10)
    assert client.get_configuration()["gated_kf_probability"] == 0.95  # as the file says
    early, late = until(survey_messages, 30)
    usual = [toolbox.numbers(m) for m in feed(sensors, filters, early + late, "robust_kf")]
    end = late[-1][1].header.stamp
    wait_until(lambda: any(u.header.stamp == end for u in filters.updates["robust_kf"]), "the last update")
    filters.call("reset", Trigger)
    heard = len(filters.updates["robust_kf"])
    # WHEN the loss changes on the way
    feed(sensors, filters, early, "robust_kf")
    changed = client.update_configuration({"robust_kf_loss": "l2"})
    assert changed["robust_kf_loss"] == "l2"
    feed(sensors, filters, late, "robust_kf")
    # THEN robust_kf is the plain filter for what comes, and was not before
    change = max(message.header.stamp for _, message in early)
    wait_until(lambda: any(u.header.stamp == end for u in filters.updates["robust_kf"][heard:]), "the last update")
    updates = {u.header.stamp: u for u in filters.updates["robust_kf"][heard:] if u.sensor == "position"}
    weights = {old: min(w for stamp, u in updates.items() for w in u.weights if (stamp <= change) == old) for old in (True, False)}
    assert weights[True] < 0.9 and weights[False] == 1
    # another loss comes with its customary tuning; a tuning can be set with it; nonsense is not taken
    assert client.update_configuration({"robust_kf_loss": "cauchy"})["robust_kf_tuning"] == pytest.approx(2.3849, abs=1e-3)
    assert client.update_configuration({"robust_kf_loss": "huber", "robust_kf_tuning": 1.345})["robust_kf_tuning"] == 1.345
    client.close()
    # and with what it began, it answers as it began
    filters.call("reset", Trigger)
    assert [toolbox.numbers(m) for m in feed(sensors, filters, early + late, "robust_kf")][-1] == usual[-1]


def test_reconfigure_a_gate(sensors, filters, survey_messages):
    client = dynamic_reconfigure.client.Client(f"/{filters.name}", timeout=10)
    early, late = until(survey_messages, 30)
    heard = len(filters.updates["gated_kf"])
    feed(sensors, filters, early, "gated_kf")
    client.update_configuration({"gated_kf_probability": 0.999999})
    client.close()
    feed(sensors, filters, late, "gated_kf")
    end = late[-1][1].header.stamp
    wait_until(lambda: any(u.header.stamp == end for u in filters.updates["gated_kf"][heard:]), "the end")
    change = max(message.header.stamp for _, message in early)
    rejected = [u for u in filters.updates["gated_kf"][heard:] if u.verdict == u.REJECTED]
    smallest = {old: min(u.nis for u in rejected if (u.header.stamp <= change) == old) for old in (True, False)}
    assert smallest[True] < 8 < 20 < smallest[False]  # chi-squared, one and two rows
