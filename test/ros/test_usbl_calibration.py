# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""usbl_calibration.launch plays a bag through the calibration nodelet: it converges, says so, and saves what calibrate_usbl says of the bag."""
import math
import re

import pytest
import rospy
import toolbox
import yaml
from diagnostic_msgs.msg import DiagnosticArray
from live import Listener, listening, statuses
from ros_session import wait_until
from sas_motion.msg import UsblCalibration
from std_srvs.srv import Trigger

RATE = 25
SECONDS = 300
BLIND = toolbox.SCENARIOS / "usbl_centred_circle.yaml"
SEEING = toolbox.SCENARIOS / "usbl_outliers.yaml"


def call(name):
    service = f"/usbl_calibration/{name}"
    rospy.wait_for_service(service, 120)
    return rospy.ServiceProxy(service, Trigger)()


def played(session, scenario, folder):
    """What was heard of a simulated bag, the answer to ~save, what it wrote, and the bag."""
    bag = toolbox.simulate(folder / "run.bag", SECONDS, 3, scenario)
    last = max(message.header.stamp for _, message, _ in toolbox.messages(bag, "usbl/measurement"))
    output = folder / "live.yaml"
    calibrations, diagnostics = Listener("hvbckf/calibration", UsblCalibration), Listener("/diagnostics", DiagnosticArray)
    command = ("roslaunch", "sas_motion", "usbl_calibration.launch", f"bag:={bag}", f"rate:={RATE}", f"output:={output}", "start_delay:=0",
               "play_options:=--pause", "tolerance_deg:=0.3", "tolerance:=0.3")

    def newest():
        return statuses(diagnostics, "usbl_calibration: calibration")[-1:]
    with listening([calibrations, diagnostics]), session.running_process(*command) as launch:
        wait_until(lambda: (calibrations.connected() and newest()) or launch.poll() is not None, "the tests listen")
        assert launch.poll() is None, launch.log.read_text()
        session.play("/player", "/usbl_calibration", [topic for topic in toolbox.topics(bag) if not topic.startswith("truth/")])
        wait_until(lambda: calibrations and (last - calibrations[-1].header.stamp).to_sec() < 1.5, "the last ping")
        count = len(diagnostics)
        wait_until(lambda: len(diagnostics) > count + 1 and not re.search("starting|no ping", newest()[0].message), "diagnostics")
        answer = call("save")
        status = newest()[0]
    return calibrations, status, answer, output, bag


@pytest.fixture(scope="module")
def seeing(session, tmp_path_factory):
    return played(session, SEEING, tmp_path_factory.mktemp("seeing"))


def test_it_waits_for_its_first_minute_and_then_converges(seeing):
    calibrations = seeing[0]
    assert not calibrations[0].started and not calibrations[0].within_tolerance
    assert len(calibrations) > 0.9 * SECONDS, seeing[1].values
    end = calibrations[-1]
    assert end.started and end.observable and end.within_tolerance, end.verdict
    sigma = [math.sqrt(end.covariance[7 * i]) for i in range(6)]
    truth = [math.radians(2), math.radians(-2), math.radians(3), 0.5, 0.8, 1.0]
    assert max(abs(a - b) / s for a, b, s in zip(end.correction, truth, sigma)) < 4
    assert end.transform.translation.x == pytest.approx(end.correction[4]) and end.transform.translation.y == pytest.approx(-end.correction[3])


def test_it_says_that_it_is_good_enough(seeing):
    status = seeing[1]
    assert status.level == 0 and "within the tolerance" in status.message
    assert {"mounting_z [deg]", "lever_y [m]"} <= {pair.key for pair in status.values}


def test_it_saves_what_calibrate_usbl_says_of_the_bag(seeing, tmp_path):
    answer, output, bag = seeing[2:]
    assert answer.success, answer.message
    live = yaml.safe_load(output.read_text())
    toolbox.succeed("calibrate_usbl", bag, "-o", tmp_path / "offline.yaml", "--estimators", "hvbckf,batch")
    offline = yaml.safe_load((tmp_path / "offline.yaml").read_text())
    assert live["trusted"] and live["static_transform"]["child"] == offline["static_transform"]["child"]
    if live["pings"] == offline["pings"]:  # the last ping waits for a pose after it, which only the end of a bag replaces
        assert live["correction"] == offline["correction"]
    assert offline["pings"] - live["pings"] <= 2
    sigma = offline["sigma"]
    for key, spread in (("angles_deg", sigma["angles_deg"]), ("lever_arm", sigma["lever_arm"])):
        assert max(abs(a - b) / s for a, b, s in zip(live["correction"][key], offline["correction"][key], spread)) < 0.2


def test_a_centred_circle_gets_no_confidence(session, tmp_path):
    calibrations, status, answer, output, _ = played(session, BLIND, tmp_path)
    assert not calibrations[-1].observable and not calibrations[-1].within_tolerance
    assert status.level == 1 and "not observable" in status.message
    assert not answer.success and "not observable" in answer.message
    written = yaml.safe_load(output.read_text())
    assert written["trusted"] is False and "static_transform" not in written
