# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""Bad data and bad parameters: the estimates stay finite, everything refused is counted, and what cannot start says why."""
import copy
import math

import pytest
import rosbag
import rospy
import toolbox
from live import PATIENT, measurements, nodelet, transforms_of
from ros_session import run_to_end, wait_until

ESTIMATORS = ["kf", "robust_kf", "mixture_kf"]


@pytest.fixture(scope="module")
def config(tmp_path_factory):
    return toolbox.write_yaml(tmp_path_factory.mktemp("config") / "faults.yaml", {**PATIENT, "lag": 10, "frames": {"timeout": 2}})


def spoilt(found, topic, spoil, every=5):
    """(topic, message): each fifth message of a topic spoilt by a function. And how many are."""
    out, count = [], 0
    for name, message in found:
        if name == topic:
            count += 1
            if count % every == 0:
                message = copy.deepcopy(message)
                spoil(message)
        out.append((name, message))
    return out, count // every


def with_values(path, *values):
    """A function that sets a member of a message: 'twist.covariance' to a list, or 'latitude' to a number."""
    def spoil(message):
        *parents, leaf = path.split(".")
        for parent in parents:
            message = getattr(message, parent)
        setattr(message, leaf, list(values) if len(values) > 1 else values[0])
    return spoil


NAN = math.nan
INVALID, FUSED, NO_READING = "invalid", "fused", "no reading"
FAULTS = {
    "fix not a number": ("gnss/fix", with_values("latitude", NAN), INVALID),
    "fix beyond the pole": ("gnss/fix", with_values("latitude", 95.0), INVALID),
    "no fix": ("gnss/fix", with_values("status.status", -1), NO_READING),
    "fix at 0, 0": ("gnss/fix", lambda m: (with_values("latitude", 0.0)(m), with_values("longitude", 0.0)(m)), INVALID),
    "zero covariance": ("gnss/fix", with_values("position_covariance", *[0.0] * 9), FUSED),
    "negative covariance": ("gnss/fix", with_values("position_covariance", *[-4.0] * 9), FUSED),
    "covariance not a number": ("dvl/twist", with_values("twist.covariance", *[NAN] * 36), FUSED),
    "speed infinite": ("dvl/twist", with_values("twist.twist.linear.x", math.inf), INVALID),
    "no orientation": ("imu/data", with_values("orientation_covariance", -1, *[0.0] * 8), FUSED),
    "zero quaternion": ("imu/data", lambda m: (with_values("orientation.z", 0.0)(m), with_values("orientation.w", 0.0)(m)), INVALID),
    "turn rate not a number": ("imu/data", with_values("angular_velocity.z", NAN), INVALID),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_a_bag_with_a_fault(fault, survey, config, tmp_path):
    # GIVEN a bag with each fifth message of one sensor spoilt
    topic, spoil, outcome = FAULTS[fault]
    found, count = spoilt(measurements(survey, 60), topic, spoil)
    with rosbag.Bag(str(tmp_path / "survey.bag"), "w") as out:
        out.write("/tf_static", transforms_of(survey), found[0][1].header.stamp)
        for name, message in found:
            out.write(name, message, message.header.stamp)
    # WHEN it is reprocessed
    bag = toolbox.reprocess(tmp_path / "survey.bag", tmp_path / "out", ESTIMATORS, "--config", config)
    # THEN everything is finite, and what could not be used is counted
    manifest = toolbox.yaml.safe_load((tmp_path / "out" / "manifest.json").read_text())["bags"]["survey.bag"]
    sensor = {"gnss/fix": "fix", "imu/data": "imu", "dvl/twist": "twist"}[topic]
    assert manifest["sensors"][sensor]["unusable"] == (count if outcome == NO_READING else 0)
    for name in ESTIMATORS:
        estimates = toolbox.estimates(bag, f"{name}/odometry")
        assert len(estimates) > 500 and all(math.isfinite(n) for values in estimates.values() for n in values), name
        assert manifest["results"][name]["invalid"] == (count if outcome == INVALID else 0), name


def test_faults_live(session, sensors, survey, config):
    # GIVEN fixes of all kinds of badness
    found, bad = spoilt(measurements(survey, 60), "gnss/fix", FAULTS["fix not a number"][1], every=5)
    found, none = spoilt(found, "gnss/fix", FAULTS["no fix"][1], every=7)
    both = sum(topic == "gnss/fix" for topic, _ in found) // 35
    with nodelet(session, sensors, "FilterNodelet", config, ESTIMATORS, transforms_of(survey)) as filters:
        sensors.feed(found)
        # THEN all are counted, and the estimates are finite
        values, _ = filters.counts(lambda values: int(values["fix messages"]) == sum(topic == "gnss/fix" for topic, _ in found))
        assert int(values["fix without a reading"]) == none
        for name in ESTIMATORS:
            wait_until(lambda name=name: filters.verdicts(name)[4] == bad - both, f"{bad - both} invalid fixes of {name}")
            assert filters.odometry[name] and all(math.isfinite(n) for m in filters.odometry[name] for n in toolbox.numbers(m))


def test_an_unknown_frame_is_never_fused(session, sensors, survey, config):
    # GIVEN a log whose frame has no transform
    found, count = spoilt(measurements(survey, 30), "dvl/twist", with_values("header.frame_id", "nowhere"), every=1)
    with nodelet(session, sensors, "FilterNodelet", config, ["kf"], transforms_of(survey)) as filters:
        sensors.feed(found)
        # THEN none of it is fused; it is counted, once it has waited for its transform, and reported as an error
        old = sum(topic == "dvl/twist" and (found[-1][1].header.stamp - message.header.stamp).to_sec() > 3 for topic, message in found)
        _, status = filters.counts(lambda values: int(values["twist of unknown frame"]) >= old)
        assert count > 100 and status.level == status.ERROR and "twist" in status.message
        wait_until(lambda: len(filters.updates["kf"]) > 300, "updates")
        assert {update.sensor for update in filters.updates["kf"]} == {"position", "heading"}


def test_a_lost_message_is_counted_and_reported(session, sensors, survey, config):
    with nodelet(session, sensors, "FilterNodelet", config, ["kf"], transforms_of(survey)) as filters:
        found = measurements(survey, 10)
        sensors.feed(found)
        filters.counts(lambda values: values["imu lost"] == values["fix lost"] == "0" and int(values["imu messages"]) > 90)
        # WHEN three fixes go missing on the way
        sensors.publishers["gnss/fix"].impl.seq += 3
        sensors.feed([pair for pair in measurements(survey, 12) if pair not in found])
        # THEN they are counted, and the diagnostics warn
        _, status = filters.counts(lambda values: values["fix lost"] == "3")
        assert status.level >= status.WARN and "3 messages of fix lost" in status.message


def test_a_lost_message_in_a_bag_is_counted(survey, tmp_path):
    with rosbag.Bag(str(tmp_path / "survey.bag"), "w") as out:
        for topic, message, time in toolbox.messages(survey):
            if not (topic == "gnss/fix" and message.header.seq in (30, 31, 50)):
                out.write(topic, message, time)
    printed = toolbox.succeed("reprocess", tmp_path / "survey.bag", "-o", tmp_path / "out", "--estimators", "kf")
    assert "3 lost" in printed


PARAMETERS = {"unknown estimator": ({"estimators": ["kf", "kalmann"]}, "kalmann"), "estimator twice": ({"estimators": ["kf", "kf"]}, "twice"),
              "estimators no list": ({"estimators": "kf"}, "~estimators"), "no such file": ({"config": "/nowhere.yaml"}, "/nowhere.yaml"),
              "unknown key": ("lagg: 3", "lagg"), "out of range": ("lag: -3", "lag is -3")}


@pytest.mark.parametrize("kind", PARAMETERS)
def test_a_wrong_parameter_stops_it_with_one_sentence(kind, session, tmp_path):
    parameters, culprit = PARAMETERS[kind]
    if isinstance(parameters, str):
        (tmp_path / "a.yaml").write_text(parameters)
        parameters = {"config": str(tmp_path / "a.yaml")}
    rospy.set_param("/wrong", parameters)
    process = session.start("rosrun", "nodelet", "nodelet", "standalone", "sas_motion/FilterNodelet", "__name:=wrong")
    assert run_to_end(process) not in (0, None)
    rospy.delete_param("/wrong")
    said = [line for line in process.log.read_text().splitlines() if "FATAL" in line]
    assert len(said) == 1 and culprit in said[0] and "/wrong" in said[0], process.log.read_text()
