# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""sins_dvl.launch plays a bag through the nodelet: its particle filter settles what reprocess says, to the last bit, and starts from a heading that is off."""
import pytest
import rospy
import toolbox
from diagnostic_msgs.msg import DiagnosticArray
from live import Listener, listening, statuses
from nav_msgs.msg import Odometry
from ros_session import wait_until
from sas_motion.msg import FilterUpdate
from sas_motion.srv import GetStateAt

NAME = "ss_srupf"
SECONDS = 25
PATIENT = {"system": "sins_dvl", "lag": 8, "frames": {"timeout": 3600}, "datum": [60, 120, 0], "particles": {"number": 60}}


@pytest.fixture(scope="module")
def bag(tmp_path_factory):
    return toolbox.simulate(tmp_path_factory.mktemp("sins") / "sins.bag", SECONDS, 5, toolbox.SCENARIOS / "sins_dvl" / "large_angle.yaml")


@pytest.fixture(scope="module")
def config(tmp_path_factory):
    return toolbox.write_yaml(tmp_path_factory.mktemp("config") / "patient.yaml", PATIENT)


@pytest.fixture(scope="module")
def offline(bag, config, tmp_path_factory):
    return toolbox.topics(toolbox.reprocess(bag, tmp_path_factory.mktemp("offline"), [NAME], "--config", config))


@pytest.fixture(scope="module")
def live(session, bag, config, offline):
    """What was heard of a played bag until all had settled: settled answers, updates, diagnostics, and the answer for a ping between two stamps."""
    settled, now = Listener(f"{NAME}/settled", Odometry), Listener(f"{NAME}/odometry", Odometry)
    updates, diagnostics = Listener(f"{NAME}/update", FilterUpdate), Listener("/diagnostics", DiagnosticArray)
    listeners = [settled, now, updates, diagnostics]
    command = ("roslaunch", "sas_motion", "sins_dvl.launch", f"bag:={bag}", "rate:=2", f"config:={config}", f"estimators:=[{NAME}]", "start_delay:=0",
               "play_options:=--pause")
    with listening(listeners), session.running_process(*command) as launch:
        wait_until(lambda: all(listener.connected() for listener in listeners) or launch.poll() is not None, "the tests listen")
        assert launch.poll() is None, launch.log.read_text()
        session.play("/player", "/ins", ("gnss/fix", "gnss/velocity", "imu/data", "dvl/twist", "depth/pose", "tf_static"))
        wait_until(lambda: len(now) > 200, "answers")
        stamp = rospy.Time(0, now[-1].header.stamp.to_nsec() - 27_000_000)
        answer = rospy.ServiceProxy("/ins/get_state_at", GetStateAt)(stamp, NAME)
        wait_until(lambda: len(updates) == len(offline[f"{NAME}/update"]), "the last update")
        wait_until(lambda: len(settled) == len(offline[f"{NAME}/odometry"]), "the last answer")
        count = len(diagnostics)
        wait_until(lambda: len(diagnostics) > count + 1, "diagnostics of the end")
    return settled, updates, {pair.key: pair.value for pair in statuses(diagnostics, "ins: estimators")[-1].values}, answer, stamp


def test_live_and_offline_agree_to_the_last_bit(live, offline):
    settled, updates = live[0], live[1]
    expected = toolbox.by_stamp(offline[f"{NAME}/odometry"])
    assert len(settled) == len(expected)
    assert all(toolbox.numbers(m) == expected[m.header.stamp.to_nsec()] for m in settled)

    def audit(messages):
        return sorted((m.header.stamp.to_nsec(), m.sensor, m.verdict, m.nis, m.effective_size) for m in messages)
    assert audit(updates) == audit(offline[f"{NAME}/update"])


def test_it_answers_between_stamps(live):
    answer, stamp = live[3], live[4]
    assert answer.success, answer.message
    assert answer.odometry.header.stamp == stamp and answer.odometry.pose.covariance[35] > 0


def test_a_fix_that_only_starts_it_may_fall_silent(live):
    values = live[2]
    assert 1 <= float(values[f"{NAME} effective particles"]) <= 60
    assert values["start"] == "started" and values["fix messages"] == values["velocity messages"] == "1"
