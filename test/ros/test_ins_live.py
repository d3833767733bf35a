# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""ins_gps_dvl.launch plays a bag through the nodelet: what it settles is what reprocess says, to the last bit, and it answers at ping times."""
import math

import pytest
import rospy
import toolbox
from diagnostic_msgs.msg import DiagnosticArray
from live import Listener, listening, statuses
from nav_msgs.msg import Odometry
from ros_session import wait_until
from sas_motion.msg import FilterUpdate
from sas_motion.srv import EnableSensor, GetStateAt
from std_srvs.srv import Trigger
from tf2_msgs.msg import TFMessage

NAME = "robust_kf27"
RATE = 4
SECONDS = 40
# Played faster than it was recorded, topics overtake one another by more than a driver would.
PATIENT = {"system": "ins_gps_dvl", "lag": 8, "frames": {"timeout": 3600}, "datum": [54.35, 10.15, 0]}


class Heard:
    """What the nodelet has said so far."""

    def __init__(self):
        self.odometry, self.settled = Listener(f"{NAME}/odometry", Odometry), Listener(f"{NAME}/settled", Odometry)
        self.updates = Listener(f"{NAME}/update", FilterUpdate)
        self.diagnostics, self.transforms = Listener("/diagnostics", DiagnosticArray), Listener("/tf", TFMessage)
        self.listeners = [self.odometry, self.settled, self.updates, self.diagnostics, self.transforms]

    @property
    def status(self):
        return statuses(self.diagnostics, "ins: estimators")

    def frames(self):
        return {(t.header.frame_id, t.child_frame_id) for message in self.transforms for t in message.transforms}

    def values(self):
        return {pair.key: pair.value for pair in self.status[-1].values}


def call(service, kind, *arguments):
    return rospy.ServiceProxy(f"/ins/{service}", kind)(*arguments)


@pytest.fixture(scope="module")
def bag(tmp_path_factory):
    return toolbox.simulate(tmp_path_factory.mktemp("ins") / "ins.bag", SECONDS, 5, toolbox.SCENARIOS / "ins" / "survey.yaml")


@pytest.fixture(scope="module")
def config(tmp_path_factory):
    return toolbox.write_yaml(tmp_path_factory.mktemp("config") / "patient.yaml", PATIENT)


@pytest.fixture(scope="module")
def offline(bag, config, tmp_path_factory):
    return toolbox.reprocess(bag, tmp_path_factory.mktemp("offline"), [NAME], "--config", config)


@pytest.fixture(scope="module")
def live(session, bag, config):
    """What was heard of a played bag, answers for pings, diagnostics before the data and at their end, and answers of the other services."""
    heard, answers = Heard(), []
    last = max(m.header.stamp for m in toolbox.topics(bag)["imu/data"])
    command = ("roslaunch", "sas_motion", "ins_gps_dvl.launch", f"bag:={bag}", f"rate:={RATE}", f"config:={config}", f"estimators:=[{NAME}]", "start_delay:=0",
               "play_options:=--pause")
    with listening(heard.listeners), session.running_process(*command) as launch:
        wait_until(lambda: heard.status or launch.poll() is not None, "diagnostics")
        assert launch.poll() is None, launch.log.read_text()
        waiting = heard.status[0].message
        wait_until(lambda: all(listener.connected() for listener in heard.listeners), "the tests listen")
        session.play("/player", "/ins", ("gnss/fix", "imu/data", "dvl/twist", "depth/pose", "tf_static"))
        for age in (1, 1, 1, 2, 3):
            count = len(heard.odometry)
            wait_until(lambda count=count: len(heard.odometry) > count + 100, "answers")
            newest = heard.odometry[-1].header.stamp
            for shift in (0, 3_700_000, 10_000_000):
                stamp = rospy.Time(0, newest.to_nsec() - age * 1_000_000_000 + shift)
                answers.append((stamp, call("get_state_at", GetStateAt, stamp, "")))
        wait_until(lambda: heard.settled and heard.settled[-1].header.stamp == last, "the end")
        count = len(heard.status)
        wait_until(lambda: len(heard.status) > count, "diagnostics")
        values = heard.values()
        others = {"nobody": call("enable_sensor", EnableSensor, "sonar", False), "twist": call("enable_sensor", EnableSensor, "twist", False),
                  "unknown": call("get_state_at", GetStateAt, last, "kf"), "old": call("get_state_at", GetStateAt, rospy.Time(1, 0), NAME),
                  "reset": call("reset", Trigger)}
        count = len(heard.status)
        wait_until(lambda: len(heard.status) > count + 1, "diagnostics")
        after = heard.status[-1].message
    return heard, answers, waiting, values, others, after


def test_settled_estimates_equal_reprocess_to_the_last_bit(live, offline):
    expected = toolbox.estimates(offline, f"{NAME}/odometry")
    settled = toolbox.by_stamp(live[0].settled)
    assert len(expected) > 1900 and set(settled) == set(expected)
    assert [stamp for stamp in expected if settled[stamp] != expected[stamp]] == []


def test_the_audit_equals_reprocess(live, offline):
    def audit(updates):
        return sorted((u.header.stamp.to_nsec(), u.sensor, u.verdict, u.innovation, u.weights, u.nis, u.reason) for u in updates)
    assert audit(live[0].updates) == audit(toolbox.topics(offline)[f"{NAME}/update"])


def test_the_present_is_near_what_settles(live):
    heard = live[0]
    settled = {m.header.stamp: m.pose.pose.position for m in heard.settled}
    off = [math.dist((m.pose.pose.position.x, m.pose.pose.position.y), (settled[m.header.stamp].x, settled[m.header.stamp].y))
           for m in heard.odometry if m.header.stamp in settled]
    assert len(off) > 1000 and sorted(off)[len(off) // 2] < 0.05 and max(off) < 5
    assert heard.frames() == {("map", "odom"), ("odom", "base_link")}


def test_it_answers_at_ping_times(live, offline):
    expected = toolbox.topics(offline)[f"{NAME}/odometry"]
    by_stamp = toolbox.by_stamp(expected)
    assert len(live[1]) == 15
    for stamp, answer in live[1]:
        assert answer.success, answer.message
        odometry = answer.odometry
        assert odometry.header.stamp == stamp
        if stamp.to_nsec() in by_stamp:
            assert toolbox.numbers(odometry) == by_stamp[stamp.to_nsec()]
        before = max((m for m in expected if m.header.stamp <= stamp), key=lambda m: m.header.stamp)
        after = min((m for m in expected if m.header.stamp > stamp), key=lambda m: m.header.stamp)
        for axis in "xyz":
            between = sorted(getattr(m.pose.pose.position, axis) for m in (before, after))  # a fix that moves the answer may lie between
            assert between[0] - 0.02 <= getattr(odometry.pose.pose.position, axis) <= between[1] + 0.02
        assert all(odometry.pose.covariance[7 * i] > 0 for i in range(6))


def test_diagnostics_tell_the_start_the_sensors_and_the_unit(live, bag):
    _, _, waiting, values, _, after = live
    assert "no data yet" in waiting or "the INS has not started" in waiting
    sent = {topic: len(found) for topic, found in toolbox.topics(bag).items()}
    for sensor, topic in (("fix", "gnss/fix"), ("imu", "imu/data"), ("twist", "dvl/twist"), ("depth", "depth/pose")):
        assert int(values[f"{sensor} messages"]) == sent[topic] and values[f"{sensor} lost"] == values[f"{sensor} of unknown frame"] == "0"
    assert values["start"] == "started" and float(values["imu rate [1/s]"]) == pytest.approx(100, rel=1e-3)
    assert 0 < float(values["callback to publication p50 [ms]"]) <= float(values["callback to publication p99 [ms]"])
    assert "has not started" in after and "twist is disabled" in after


def test_services_refuse_what_makes_no_sense(live):
    others = live[4]
    assert not others["nobody"].success and "fix, imu, twist, depth" in others["nobody"].message
    assert others["twist"].success and others["reset"].success
    assert not others["unknown"].success and others["unknown"].message == "no such estimator"
    assert not others["old"].success and "older than the lag" in others["old"].message
