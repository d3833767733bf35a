# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""What takes long holds up nothing live: the batch solution, a long queue of settled answers, a wrong clock."""
import copy
import threading
import time

import pytest
import rospy
import toolbox
from live import PATIENT, measurements, nodelet, transforms_of
from ros_session import wait_until
from sas_motion.srv import GetStateAt
from std_srvs.srv import Trigger


@pytest.fixture(scope="module")
def config(tmp_path_factory):
    return toolbox.write_yaml(tmp_path_factory.mktemp("config") / "responsive.yaml", {**PATIENT, "estimators": {"fixed_lag": {"reorder": 2}}})


@pytest.fixture(scope="module")
def long_survey(tmp_path_factory):
    return toolbox.simulate(tmp_path_factory.mktemp("long") / "long.bag", duration=240)


def test_live_answers_go_on_while_the_batch_is_solved_and_published(session, sensors, long_survey, config):
    found = measurements(long_survey)
    begin = found[0][1].header.stamp
    early = [pair for pair in found if (pair[1].header.stamp - begin).to_sec() < 200]
    with nodelet(session, sensors, "SmootherNodelet", config, ["kf"], transforms_of(long_survey), batch=True) as smoother:
        sensors.feed(early)
        smoother.counts(lambda values: int(values["imu messages"]) == sum(topic == "imu/data" for topic, _ in early))
        # WHEN some thousand states are solved and published, which takes seconds
        answer = []
        solving = threading.Thread(target=lambda: answer.append(smoother.call("solve_batch", Trigger)))
        solving.start()
        begin, slowest, count = time.monotonic(), 0, 0
        for topic, message in found[len(early):]:
            if not solving.is_alive():
                break
            # THEN each measurement is answered at once
            sensors.publishers[topic].publish(message)
            start = time.monotonic()
            wait_until(lambda m=message: smoother.odometry["kf"][-1].header.stamp >= m.header.stamp, "an answer")
            slowest, count = max(slowest, time.monotonic() - start), count + 1
        took = time.monotonic() - begin
        solving.join()
    assert count > 10 and slowest < max(1, took / 4)  # behind the batch, one of them would wait for most of that time
    states = int(answer[0].message.split()[0])
    # and it is of all data until then, and perhaps of the first of the others
    assert answer[0].success and 0 <= states - len({message.header.stamp.to_nsec() for _, message in early}) <= count


def test_requests_are_answered_while_what_is_settled_is_published(session, sensors, long_survey, tmp_path):
    settings = toolbox.write_yaml(tmp_path / "long.yaml", {**PATIENT, "lag": 200})
    found = measurements(long_survey)
    last, expected = max(message.header.stamp for _, message in found), len({message.header.stamp.to_nsec() for _, message in found})
    with nodelet(session, sensors, "FilterNodelet", settings, ["kf"], transforms_of(long_survey), idle_timeout=0.5) as filters:
        # GIVEN 200 s of answers that are settled by a pause
        sensors.feed(found)
        wait_until(lambda: any(m.header.stamp == last for m in filters.odometry["kf"]), "the last answer")
        before = len(filters.settled["kf"])
        wait_until(lambda: len(filters.settled["kf"]) > before + 20, "the first of them")
        # WHEN they are published, a few at a time THEN a request is answered before the last of them
        assert filters.call("get_state_at", GetStateAt, found[-1][1].header.stamp, "kf").success
        assert len(filters.settled["kf"]) < expected
        # and none is lost
        wait_until(lambda: len(filters.settled["kf"]) == expected, "all of them")


@pytest.mark.parametrize("jump", [3600, -3600, 315_000_000, -315_000_000])
def test_a_clock_that_is_set_live(jump, session, sensors, survey, config, tmp_path):
    settings = toolbox.write_yaml(tmp_path / "clock.yaml", {"datum": PATIENT["datum"]})
    found = measurements(survey, 40)
    begin = found[0][1].header.stamp
    shifted = []
    for topic, message in found:
        message = copy.deepcopy(message)
        if (message.header.stamp - begin).to_sec() > 25:
            message.header.stamp += rospy.Duration(jump)
        shifted.append((topic, message))
    # and single wrong stamps before
    for place in (100, 200):
        wrong = copy.deepcopy(found[place])
        wrong[1].header.stamp += rospy.Duration(50_000_000)
        shifted.insert(place, wrong)
    with nodelet(session, sensors, "FilterNodelet", settings, ["kf", "mixture_kf"], transforms_of(survey)) as filters:
        for topic, message in shifted:  # slowly: topics must not overtake each other by more than the lag
            sensors.publishers[topic].publish(message)
            time.sleep(0.004)
        last = shifted[-1][1].header.stamp
        for name in ("kf", "mixture_kf"):
            wait_until(lambda name=name: filters.odometry[name][-1].header.stamp == last, f"the end of {name}")
            after = [m for m in filters.odometry[name] if abs((m.header.stamp - last).to_sec()) < 20 and (m.header.stamp - begin).to_sec() - jump > 25]
            # THEN answers in the new time come within five seconds of data
            assert (after[0].header.stamp - begin).to_sec() - jump < 30, name
            assert len({m.header.stamp for m in after}) > 100, name
        _, status = filters.counts(lambda values: int(values["imu messages"]) == sum(topic == "imu/data" for topic, _ in shifted))
        assert "silent" not in status.message
