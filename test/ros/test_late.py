# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""Late, shuffled and duplicate messages inside the lag change nothing, live or offline."""
import random

import pytest
import rosbag
import toolbox
from live import PATIENT, TYPES, measurements, nodelet, transforms_of
from ros_session import wait_until

ESTIMATORS = ["kf", "robust_kf", "mixture_kf"]
LATEST = 4  # seconds by which a message may be late


def shuffled(found, seed=3):
    """(topic, message) late by up to LATEST seconds, one in ten twice."""
    draw = random.Random(seed)
    arrivals = []
    for topic, message in found:
        for _ in range(2 if draw.random() < 0.1 else 1):
            arrivals.append((message.header.stamp.to_sec() + draw.uniform(0, LATEST), topic, message))
    return [(topic, message) for _, topic, message in sorted(arrivals, key=lambda arrival: arrival[0])]


@pytest.fixture(scope="module")
def config(tmp_path_factory):
    return toolbox.write_yaml(tmp_path_factory.mktemp("config") / "late.yaml", PATIENT)


@pytest.fixture(scope="module")
def expected(survey, config, tmp_path_factory):
    """What reprocess says of the bag in order: estimates by estimator."""
    bag = toolbox.reprocess(survey, tmp_path_factory.mktemp("sorted"), [*ESTIMATORS, "fixed_lag", "rts"], "--config", config)
    return {name: toolbox.estimates(bag, f"{name}/odometry") for name in [*ESTIMATORS, "fixed_lag", "rts"]}


def shuffled_bag(survey, path):
    """The survey with its messages recorded late, out of order and doubly."""
    with rosbag.Bag(str(path), "w") as out:
        begin = None
        for topic, message, time in toolbox.messages(survey):
            begin = begin or time
            if topic == "tf_static":
                out.write("/tf_static", message, begin)
        for count, (topic, message) in enumerate(shuffled(measurements(survey))):
            out.write(topic, message, begin + type(begin - begin).from_sec(0.01 * count))
    return path


@pytest.mark.parametrize("settings", [PATIENT, {"lag": 5, "datum": PATIENT["datum"], "estimators": {"fixed_lag": {"reorder": 5}}}], ids=["patient", "lag of 5 s"])
def test_reprocess_of_a_shuffled_bag(settings, survey, tmp_path):
    # GIVEN a bag, and the same one with its messages late, out of order and some twice
    config = toolbox.write_yaml(tmp_path / "late.yaml", settings)
    names = [*ESTIMATORS, "fixed_lag", "rts"]
    in_order = toolbox.reprocess(survey, tmp_path / "in_order", names, "--config", config)
    late = toolbox.reprocess(shuffled_bag(survey, tmp_path / "shuffled.bag"), tmp_path / "late", names, "--config", config)
    # THEN the estimates are the same to the last bit
    for name in names:
        assert toolbox.estimates(late, f"{name}/odometry") == toolbox.estimates(in_order, f"{name}/odometry"), name


def test_shuffled_messages_live(session, sensors, survey, config, expected):
    with nodelet(session, sensors, "FilterNodelet", config, ESTIMATORS, transforms_of(survey)) as filters:
        sensors.feed(shuffled(measurements(survey)))
        last = max(expected["kf"])
        for name in ESTIMATORS:
            wait_until(lambda name=name: any(m.header.stamp.to_nsec() == last for m in filters.settled[name]), f"the end of {name}/settled")
            assert toolbox.by_stamp(filters.settled[name]) == expected[name], name
            assert filters.verdicts(name)[3] == 0  # nothing was stale


def test_shuffled_messages_live_to_the_smoother(session, sensors, survey, config, expected):
    with nodelet(session, sensors, "SmootherNodelet", config, ["fixed_lag"], transforms_of(survey)) as smoother:
        sensors.feed(shuffled(measurements(survey)))
        last = max(expected["fixed_lag"])
        wait_until(lambda: any(m.header.stamp.to_nsec() == last for m in smoother.settled["fixed_lag"]), "the end of fixed_lag/settled")
        assert toolbox.by_stamp(smoother.settled["fixed_lag"]) == expected["fixed_lag"]


def test_what_is_older_than_the_lag_is_counted_and_dropped(session, sensors, survey, tmp_path):
    # GIVEN a lag of 5 s and all data but one fix of the 20th second
    config = toolbox.write_yaml(tmp_path / "short.yaml", {"lag": 5, "frames": {"timeout": 3600}})
    found = measurements(survey, 60)
    fixes = [pair for pair in found if pair[0] == "gnss/fix"]
    with nodelet(session, sensors, "FilterNodelet", config, ["kf"], transforms_of(survey)) as filters:
        sensors.feed([pair for pair in found if pair is not fixes[20]])
        last = max(m.header.stamp for _, m in found)
        wait_until(lambda: filters.odometry["kf"] and filters.odometry["kf"][-1].header.stamp == last, "the last odometry")
        # WHEN it comes after the 60th
        sensors.feed([fixes[20]])
        # THEN it is said to be stale
        wait_until(lambda: any(u.verdict == u.STALE and u.header.stamp == fixes[20][1].header.stamp for u in filters.updates["kf"]), "a stale update")
    assert set(TYPES) == {topic for topic, _ in found}
