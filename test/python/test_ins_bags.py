# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""The 27-state system on bags: what is simulated is reprocessed, scored and focused; what is wrong with a bag is said."""
import json
import math

import pytest
import rosbag
import toolbox

SURVEY = toolbox.SCENARIOS / "ins" / "survey.yaml"
CONFIG = toolbox.ROOT / "config" / "ins_gps_dvl.yaml"
SENSORS = ("gnss/fix", "imu/data", "dvl/twist", "depth/pose")


@pytest.fixture(scope="module")
def survey(tmp_path_factory):
    return toolbox.simulate(tmp_path_factory.mktemp("ins") / "ins.bag", duration=150, scenario=SURVEY)


@pytest.fixture(scope="module")
def reprocessed(survey, tmp_path_factory):
    names = ["kf27", "robust_kf27", "steady_robust_kf27", "ins", "gnss_alone", "dvl"]
    return toolbox.reprocess(survey, tmp_path_factory.mktemp("out"), names, "--config", CONFIG)


@pytest.fixture(scope="module")
def metrics(reprocessed, tmp_path_factory):
    folder = tmp_path_factory.mktemp("report")
    toolbox.succeed("evaluate.py", reprocessed, "-o", folder)
    page = (folder / "report.html").read_text()
    assert all(name in page for name in ("steady_robust_kf27", "NEES tilt", "NIS dvl", "error_up"))
    return json.loads((folder / "metrics.json").read_text())["estimators"]


def changed(survey, path, change):
    """A bag with each message as `change(topic, message, seconds)` gives it back, or left out."""
    with rosbag.Bag(str(path), "w") as out:
        begin = None
        for topic, message, time in toolbox.messages(survey):
            begin = begin or time
            kept = change(topic.lstrip("/"), message, (time - begin).to_sec())
            if kept is not None:
                out.write(topic, kept, time)
    return path


def manifest_of(bag, folder, *arguments, config=CONFIG):
    toolbox.reprocess(bag, folder, ["robust_kf27"], "--config", config, *arguments)
    return json.loads((folder / "manifest.json").read_text())["bags"][bag.name]


def test_a_simulated_bag_has_sensors_and_truth(survey):
    topics = toolbox.topics(survey)
    assert {topic: len(topics[topic]) for topic in SENSORS} == {"gnss/fix": 150, "imu/data": 15000, "dvl/twist": 750, "depth/pose": 150}
    assert len(topics["truth/odometry"]) == len(topics["truth/fix"]) == 7501 and len(topics["truth/label"]) == 1050
    frames = {T.child_frame_id: T.transform for T in topics["tf_static"][0].transforms}
    assert set(frames) == {"imu_link", "gnss_link", "dvl_link", "depth_link"}
    assert frames["dvl_link"].rotation.z == pytest.approx(math.sin(math.pi / 8))
    gnss = frames["gnss_link"].translation  # forward, port, up, from starboard 0.4, forward -1.2, up 3.5
    assert (gnss.x, gnss.y, gnss.z) == pytest.approx((-1.2, -0.4, 3.5))


def test_gravity_and_speed_have_the_signs_of_rep_103(survey):
    topics = toolbox.topics(survey)
    up = [m.linear_acceleration.z for m in topics["imu/data"]]
    assert sum(up) / len(up) == pytest.approx(9.81, abs=0.05)
    forward = [m.twist.twist.linear.x for m in topics["truth/odometry"]]
    assert sum(forward) / len(forward) == pytest.approx(2, abs=0.1)


def test_estimates_come_at_the_output_rate_with_all_there_is(reprocessed):
    topics = toolbox.topics(reprocessed)
    stamps = [m.header.stamp.to_sec() for m in topics["kf27/odometry"]]
    assert max(b - a for a, b in zip(stamps, stamps[1:])) < 0.0201 and len(stamps) == 7451  # from the fix at one second on
    last = topics["kf27/odometry"][-1]
    truth = topics["truth/odometry"][-1]
    assert last.twist.twist.angular.z == pytest.approx(truth.twist.twist.angular.z, abs=1e-3)
    assert last.twist.twist.linear.x == pytest.approx(truth.twist.twist.linear.x, abs=0.1)
    assert all(last.pose.covariance[7 * i] > 0 for i in range(6)) and last.pose.covariance[35] < math.radians(0.2) ** 2
    assert all(last.pose.covariance[6 * i + j] == pytest.approx(last.pose.covariance[6 * j + i], abs=1e-15) for i in range(6) for j in range(6))
    assert len(topics["kf27/fix"]) == len(stamps) and len(topics["gnss_alone/odometry"]) == 150
    assert topics["gnss_alone/odometry"][-1].pose.covariance[21] == 1e6 and topics["ins/odometry"][-1].pose.covariance[0] == 0
    sensors = {m.sensor for m in topics["kf27/update"]}
    assert sensors == {"gps", "dvl", "depth"}
    accepted = [m for m in topics["kf27/update"] if m.sensor == "gps" and m.verdict == m.ACCEPTED]
    assert len(accepted[0].innovation) == 3 and len(accepted[0].innovation_covariance) == 9 and accepted[0].innovation_covariance[0] > 0


def test_scores_tell_fusion_from_single_sensors(metrics):
    for name in ("kf27", "robust_kf27"):
        m = metrics[name]
        assert m["position"]["rmse"] < metrics["gnss_alone"]["position"]["rmse"] and m["position"]["rmse"] < 4
        assert m["height"]["rmse"] < 0.2 and m["velocity"]["rmse"] < 0.03 and m["tilt_deg"]["rmse"] < 0.03 and m["heading_deg"]["rmse"] < 0.3
        assert set(m["nees"]) >= {"position", "heading", "height", "velocity", "tilt"}
        assert set(m["nis"]) == {"gps", "dvl", "depth"} and m["nis"]["gps"]["degrees"] == 3 and m["nis"]["dvl"]["mean"] == pytest.approx(3, rel=0.2)
    assert metrics["ins"]["position"]["rmse"] > 5 * metrics["kf27"]["position"]["rmse"]
    assert metrics["ins"]["nees"] == {} and "tilt_deg" in metrics["ins"]
    assert "heading_deg" not in metrics["gnss_alone"] and "velocity" not in metrics["gnss_alone"]
    assert metrics["steady_robust_kf27"]["aperture"]["across"] < metrics["robust_kf27"]["aperture"]["across"]


def test_output_depends_on_the_input_alone(survey, reprocessed, tmp_path):
    again = toolbox.reprocess(survey, tmp_path, ["kf27", "robust_kf27", "steady_robust_kf27", "ins", "gnss_alone", "dvl"], "--config", CONFIG)
    assert again.read_bytes() == reprocessed.read_bytes()


def test_an_output_can_be_reprocessed_again(reprocessed, tmp_path):
    names = ["kf27", "robust_kf27", "steady_robust_kf27", "ins", "gnss_alone", "dvl"]
    again = toolbox.reprocess(reprocessed, tmp_path, names, "--config", CONFIG)
    assert toolbox.estimates(again, "kf27/odometry") == toolbox.estimates(reprocessed, "kf27/odometry")
    assert len(toolbox.topics(again)["dvl/twist"]) == 750


@pytest.mark.parametrize("lacks", SENSORS)
def test_a_missing_topic_is_named(lacks, survey, tmp_path):
    bag = changed(survey, tmp_path / "ins.bag", lambda topic, message, _: None if topic == lacks else message)
    done = toolbox.run("reprocess", bag, "-o", tmp_path / "out", "--estimators", "kf27", "--config", CONFIG)
    assert done.returncode == 1 and lacks in done.stderr and len(done.stderr.splitlines()) == 1
    assert toolbox.snapshot(tmp_path / "out") == {}
    if lacks in ("dvl/twist", "depth/pose"):
        section = "dvl" if lacks == "dvl/twist" else "depth"
        config = toolbox.write_yaml(tmp_path / "a.yaml", {"system": "ins_gps_dvl", section: {"enabled": False}})
        assert manifest_of(bag, tmp_path / "without", config=config)["results"]["robust_kf27"]["estimates"] > 6000


def test_an_old_name_is_answered_with_the_new_one(survey, tmp_path):
    done = toolbox.run("reprocess", survey, "-o", tmp_path, "--estimators", "ckf27,gps", "--config", CONFIG)
    assert done.returncode == 0 and "'ckf27' is now called kf27" in done.stderr and "'gps' is now called gnss_alone" in done.stderr
    assert {"kf27/odometry", "gnss_alone/odometry"} < set(toolbox.topics(tmp_path / survey.name))


def test_a_towfish_bag_is_refused(simulated, tmp_path):
    done = toolbox.run("reprocess", simulated, "-o", tmp_path / "out", "--estimators", "kf27", "--config", CONFIG)
    assert done.returncode == 1 and "depth/pose" in done.stderr
    config = toolbox.write_yaml(tmp_path / "a.yaml", {"system": "ins_gps_dvl", "depth": {"enabled": False}})
    done = toolbox.run("reprocess", simulated, "-o", tmp_path / "out", "--estimators", "kf27", "--config", config)
    assert done.returncode == 1 and "imu/data has no message with rates and specific forces" in done.stderr


def test_without_bottom_lock_throughout_it_starts_at_rest_and_says_so(survey, tmp_path):
    def unlocked(topic, message, seconds):
        if topic == "dvl/twist":
            kind = int(seconds * 5) % 3
            if kind == 0:
                message.twist.twist.linear.x = math.nan
            else:
                message.twist.covariance = [(-1 if kind == 1 else 1e6) if i % 7 == 0 else 0 for i in range(36)]
        return message
    entry = manifest_of(changed(survey, tmp_path / "ins.bag", unlocked), tmp_path / "out")
    assert entry["sensors"]["twist"]["unusable"] == 750
    assert any("dvl/twist" in remark for remark in entry["remarks"])
    assert 6900 < entry["results"]["robust_kf27"]["estimates"] < 7000  # after ten seconds


def test_no_fix_and_no_orientation_are_named(survey, tmp_path):
    def fixless(topic, message, _):
        if topic == "gnss/fix":
            message.status.status = -1
        return message

    def blind(topic, message, _):
        if topic == "imu/data":
            message.orientation_covariance = [-1] + [0] * 8
        return message
    for change, culprit in ((fixless, "gnss/fix"), (blind, "orientation")):
        bag = changed(survey, tmp_path / "ins.bag", change)
        done = toolbox.run("reprocess", bag, "-o", tmp_path / "out", "--estimators", "kf27", "--config", CONFIG)
        assert done.returncode == 1 and "never started" in done.stderr and culprit in done.stderr, done.stderr
        assert toolbox.snapshot(tmp_path / "out") == {}


def test_a_gap_and_a_wrong_rate_are_remarked(survey, tmp_path):
    gap = changed(survey, tmp_path / "ins.bag", lambda topic, message, seconds: None if topic == "imu/data" and 60 < seconds < 62 else message)
    remarks = manifest_of(gap, tmp_path / "gap")["remarks"]
    assert any("1 gaps" in remark and "longest of 2" in remark for remark in remarks)
    config = toolbox.write_yaml(tmp_path / "a.yaml", {"system": "ins_gps_dvl", "imu": {"rate": 200}})
    remarks = manifest_of(survey, tmp_path / "rate", config=config)["remarks"]
    assert any("100 times a second but imu.rate is 200" in remark for remark in remarks)


def test_readings_that_are_not_finite_are_left_out(survey, tmp_path):
    def broken(topic, message, seconds):
        if topic == "imu/data" and message.header.seq % 100 == 50:
            message.linear_acceleration.y = math.inf
        if topic == "gnss/fix" and message.header.seq % 10 == 5:
            message.latitude = math.nan
        return message
    entry = manifest_of(changed(survey, tmp_path / "ins.bag", broken), tmp_path / "out")
    assert entry["sensors"]["imu"]["unusable"] == 150 and entry["sensors"]["fix"]["unusable"] == 15
    assert entry["results"]["robust_kf27"]["estimates"] > 7000


@pytest.mark.parametrize("settings, culprit", [({"gps": {"whyte": 1}}, "gps.whyte"), ({"output_rate": 0}, "output_rate is 0 but must be at least 0.001"),
                                               ({"gps": {"lever_arm": [0, 0, 0]}}, "gps.lever_arm"), ({"system": "balloon"}, "balloon")])
def test_a_wrong_configuration_is_refused(settings, culprit, survey, tmp_path):
    file = toolbox.write_yaml(tmp_path / "a.yaml", {"system": "ins_gps_dvl", **settings})
    done = toolbox.run("reprocess", survey, "-o", tmp_path / "out", "--estimators", "kf27", "--config", file)
    assert done.returncode == 1 and culprit in done.stderr


def test_unknown_estimators_are_refused(survey, tmp_path):
    done = toolbox.run("reprocess", survey, "-o", tmp_path / "out", "--estimators", "kf", "--config", CONFIG)
    assert done.returncode == 1 and "'kf' is no estimator of this system" in done.stderr


def test_focus_images_its_trajectories(reprocessed, tmp_path):
    toolbox.succeed("focus", reprocessed, "-o", tmp_path, "--trajectory", "steady_robust_kf27", "--trajectory", "robust_kf27", "--no-figures")
    found = json.loads((tmp_path / "focus.json").read_text())["trajectories"]
    assert set(found) == {"truth", "steady_robust_kf27", "robust_kf27"}
