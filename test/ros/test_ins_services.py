# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""What a fusion of INS, GNSS and DVL does on request: the same as the towfish's nodelets, where it makes sense."""
import math

import pytest
import rospy
import toolbox
from dynamic_reconfigure.client import Client
from live import Listener, listening, statuses
from diagnostic_msgs.msg import DiagnosticArray
from nav_msgs.msg import Odometry
from ros_session import wait_until
from sas_motion.msg import FilterUpdate
from sas_motion.srv import SetDatum, SetState
from sensor_msgs.msg import NavSatFix
from std_srvs.srv import Trigger

FILTER, SMOOTHER = "robust_kf27", "fixed_lag"
RATE = 4
SECONDS = 60
AWAY = 400.0  # that the state is set to the east of where the body is [m]
SIGMAS = [0.5, 0.5, 0.1, 0.1, 0.01, 0.1]
OTHER_DATUM = (54.36, 10.15, 0.0)
PATIENT = {"system": "ins_gps_dvl", "lag": 8, "frames": {"timeout": 3600}, "datum": [54.35, 10.15, 0]}


def call(service, kind, *arguments):
    return rospy.ServiceProxy(f"/ins/{service}", kind)(*arguments)


def yaw_of(odometry):
    q = odometry.pose.pose.orientation
    return math.atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z))


@pytest.fixture(scope="module")
def live(session, sensors, tmp_path_factory):
    """Answers of all services while a bag plays, and what was heard around them."""
    folder = tmp_path_factory.mktemp("ins_services")
    bag = toolbox.simulate(folder / "ins.bag", SECONDS, 6, toolbox.SCENARIOS / "ins" / "survey.yaml")
    config = toolbox.write_yaml(folder / "patient.yaml", PATIENT)
    last = max(m.header.stamp for m in toolbox.topics(bag)["imu/data"])
    filtered, smoothed = Listener(f"{FILTER}/odometry", Odometry), Listener(f"{SMOOTHER}/odometry", Odometry)
    batch, audits = Listener("batch/settled", Odometry), Listener("batch/update", FilterUpdate)
    settled, datums, diagnostics = Listener(f"{FILTER}/settled", Odometry), Listener("datum", NavSatFix), Listener("/diagnostics", DiagnosticArray)
    heard = [filtered, smoothed, batch, audits, settled, datums, diagnostics]
    command = ("roslaunch", "sas_motion", "ins_gps_dvl.launch", f"bag:={bag}", f"rate:={RATE}", f"config:={config}", f"estimators:=[{FILTER}, {SMOOTHER}]",
               "batch:=true", "start_delay:=0", "play_options:=--pause")
    answers = {}
    with listening(heard), session.running_process(*command) as launch:
        wait_until(lambda: statuses(diagnostics, "ins: estimators") or launch.poll() is not None, "diagnostics")
        assert launch.poll() is None, launch.log.read_text()
        wait_until(lambda: all(listener.connected() for listener in heard), "the tests listen")
        answers["too early"] = call("set_state", SetState, rospy.Time(), FILTER, [0] * 6, SIGMAS)
        session.play("/player", "/ins", ("gnss/fix", "imu/data", "dvl/twist", "depth/pose", "tf_static"))
        wait_until(lambda: len(filtered) > 800, "answers")
        before = filtered[-1]
        place = before.pose.pose.position
        answers["set"] = call("set_state", SetState, rospy.Time(), FILTER, [place.x + AWAY, place.y, 0, 0, yaw_of(before), 2], SIGMAS)
        count = len(filtered)
        wait_until(lambda: len(filtered) > count + 5, "an answer after the state was set")
        answers["before"], answers["after"] = before, filtered[-1]
        answers["unknown"] = call("set_state", SetState, rospy.Time(), "kalmann", [0] * 6, SIGMAS)
        answers["loss"] = Client("/ins", timeout=60).update_configuration({"robust_kf_loss": "cauchy", "fixed_lag_loss": "tukey"})
        wait_until(lambda: settled and settled[-1].header.stamp == last, "the end")
        answers["batch"] = call("solve_batch", Trigger)
        answers["batch again"] = call("solve_batch", Trigger)
        count = len(datums)
        answers["datum"] = call("set_datum", SetDatum, *OTHER_DATUM)
        wait_until(lambda: len(datums) > count, "the new datum")
        answers["no datum"] = call("set_datum", SetDatum, 123.0, 0.0, 0.0)
    return answers, {"filtered": filtered, "smoothed": smoothed, "batch": batch, "audits": audits, "datums": datums, "settled": settled}, bag


def test_a_state_that_is_set_moves_the_answer_and_fixes_bring_it_back(live):
    answers, heard, _ = live
    assert not answers["too early"].success and answers["too early"].message
    assert answers["set"].success, answers["set"].message
    assert not answers["unknown"].success and answers["unknown"].message == "no such estimator"
    moved = answers["after"].pose.pose.position.x - answers["before"].pose.pose.position.x
    assert moved == pytest.approx(AWAY, abs=60)
    assert answers["after"].pose.pose.position.z == pytest.approx(answers["before"].pose.pose.position.z, abs=2)  # height stays its own
    settled = {m.header.stamp.to_nsec() for m in heard["settled"]}
    assert len(settled) == len(heard["settled"])  # no stamp settles twice


def test_the_sliding_window_has_a_present_answer(live):
    _, heard, bag = live
    smoothed = list(heard["smoothed"])
    truth = {m.header.stamp.to_nsec(): m.pose.pose.position for m in toolbox.topics(bag)["truth/odometry"]}
    off = sorted(math.dist((m.pose.pose.position.x, m.pose.pose.position.y), (truth[m.header.stamp.to_nsec()].x, truth[m.header.stamp.to_nsec()].y))
                 for m in smoothed if m.header.stamp.to_nsec() in truth)
    assert len(off) > 1000 and off[len(off) // 2] < 5 and off[-1] < 15


def test_other_losses_are_taken_while_it_runs(live):
    assert live[0]["loss"]["robust_kf_loss"] == "cauchy" and live[0]["loss"]["robust_kf_tuning"] == pytest.approx(2.385, abs=0.01)


def test_the_whole_run_is_solved_on_request(live):
    answers, heard, _ = live
    assert answers["batch"].success, answers["batch"].message
    assert len(heard["batch"]) > 2500 and len(heard["audits"]) > 300
    assert not answers["batch again"].success


def test_a_new_datum_is_published_and_starts_nothing_anew(live):
    answers, heard, _ = live
    assert answers["datum"].success and answers["datum"].message == "datum set"
    assert (heard["datums"][-1].latitude, heard["datums"][-1].longitude) == OTHER_DATUM[:2]
    assert not answers["no datum"].success and answers["no datum"].message
