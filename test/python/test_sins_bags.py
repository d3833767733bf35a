# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""SINS and DVL with large attitude errors on bags: particle filters find the heading, are scored, and say what is wrong with a bag."""
import json
import math

import pytest
import rosbag
import toolbox

SCENARIO = toolbox.SCENARIOS / "sins_dvl" / "large_angle.yaml"
CONFIG = toolbox.ROOT / "config" / "sins_dvl.yaml"
NAMES = ["pf", "upf", "ss_srupf", "ss_srukf", "ukf", "steady_ss_srupf"]
SECONDS = 60
FEW = {"system": "sins_dvl", "particles": {"number": 100}}


@pytest.fixture(scope="module")
def tow(tmp_path_factory):
    return toolbox.simulate(tmp_path_factory.mktemp("sins") / "sins.bag", SECONDS, 3, SCENARIO)


@pytest.fixture(scope="module")
def few(tmp_path_factory):
    return toolbox.write_yaml(tmp_path_factory.mktemp("config") / "few.yaml", FEW)


@pytest.fixture(scope="module")
def reprocessed(tow, few, tmp_path_factory):
    return toolbox.reprocess(tow, tmp_path_factory.mktemp("out"), NAMES, "--config", few)


@pytest.fixture(scope="module")
def report(reprocessed, tmp_path_factory):
    folder = tmp_path_factory.mktemp("report")
    text = toolbox.succeed("evaluate.py", reprocessed, "-o", folder)
    return text, (folder / "report.html").read_text(), json.loads((folder / "metrics.json").read_text())["estimators"]


def changed(bag, path, change):
    """A bag with each message as `change(topic, message)` gives it back, or left out."""
    with rosbag.Bag(str(path), "w") as out:
        for topic, message, time in toolbox.messages(bag):
            kept = change(topic.lstrip("/"), message)
            if kept is not None:
                out.write(topic, kept, time)
    return path


def heading_off(a, b):
    """The angle between two orientations about the vertical [deg]."""
    def yaw(q):
        return math.atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z))
    return abs(math.degrees(math.remainder(yaw(a) - yaw(b), 2 * math.pi)))


def test_a_simulated_bag_starts_with_a_fix_and_a_velocity(tow):
    topics = toolbox.topics(tow)
    counts = {topic: len(topics[topic]) for topic in ("gnss/fix", "gnss/velocity", "imu/data", "dvl/twist", "depth/pose")}
    assert counts == {"gnss/fix": 1, "gnss/velocity": 1, "imu/data": 100 * SECONDS + 1, "dvl/twist": SECONDS, "depth/pose": SECONDS}
    imu, truth = topics["imu/data"][0], topics["truth/odometry"][0]
    assert heading_off(imu.orientation, truth.pose.pose.orientation) == pytest.approx(5, abs=0.2)
    assert math.degrees(math.sqrt(imu.orientation_covariance[8])) == pytest.approx(5)
    assert topics["dvl/twist"][0].twist.covariance[0] == pytest.approx(0.006 ** 2) and topics["dvl/twist"][0].twist.covariance[14] == pytest.approx(0.018 ** 2)


def test_the_heading_is_found(reprocessed):
    topics = toolbox.topics(reprocessed)
    truth = {m.header.stamp.to_nsec(): m.pose.pose.orientation for m in topics["truth/odometry"]}

    def off(answer):  # truth may come between the answers
        stamp = answer.header.stamp.to_nsec()
        return heading_off(answer.pose.pose.orientation, truth.get(stamp) or truth[stamp + 10_000_000])
    for name in ("upf", "ss_srupf", "steady_ss_srupf"):
        first, last = topics[f"{name}/odometry"][0], topics[f"{name}/odometry"][-1]
        assert off(first) > 4 and off(last) < 2
    last = topics["ss_srupf/odometry"][-1]
    assert all(last.pose.covariance[7 * i] > 0 for i in range(6)) and all(last.twist.covariance[7 * i] > 0 for i in range(3))


def test_the_audit_tells_innovation_and_effective_particles(reprocessed):
    updates = toolbox.topics(reprocessed)["ss_srupf/update"]
    assert [m.sensor for m in updates[:4]] == ["dvl", "depth"] * 2  # the fix only starts it
    dvl = [m for m in updates if m.sensor == "dvl"]
    assert len(dvl) == SECONDS and all(m.verdict == m.ACCEPTED and 1 <= m.effective_size <= 100 for m in dvl)
    assert len(dvl[0].innovation) == 3 and len(dvl[0].innovation_covariance) == 9 and dvl[0].nis > 0


def test_the_report_tells_alignment_particles_and_cost(report):
    text, page, metrics = report
    assert "aligned" in text and "particles" in text
    assert "section-particles" in page and "effective number" in page
    m = metrics["ss_srupf"]
    assert m["alignment"]["within_deg"] == 2 and 0 <= m["alignment"]["after"] < SECONDS
    assert 1 <= m["effective_particles"] <= 100 and m["cost"]["times_real_time"] > 1
    assert set(m["nis"]) >= {"dvl", "depth"} and set(m["nees"]) >= {"position", "velocity", "heading", "tilt"}


def test_output_depends_on_the_input_alone_and_not_on_threads(tow, reprocessed, tmp_path):
    threads = toolbox.write_yaml(tmp_path / "a.yaml", {**FEW, "particles": {"number": 100, "threads": 2}})
    again = toolbox.reprocess(tow, tmp_path / "out", NAMES, "--config", threads)
    assert again.read_bytes() == reprocessed.read_bytes()


def test_without_a_velocity_of_gnss_the_dvls_starts_it(tow, few, tmp_path):
    bag = changed(tow, tmp_path / "sins.bag", lambda topic, message: None if topic == "gnss/velocity" else message)
    done = toolbox.run("reprocess", bag, "-o", tmp_path / "out", "--estimators", "ss_srukf", "--config", few)
    assert done.returncode == 1 and "dvl/twist" in done.stderr and "never started" in done.stderr  # its one fix comes before the first velocity
    with rosbag.Bag(str(tmp_path / "later.bag"), "w") as out:
        for topic, message, time in toolbox.messages(bag):
            if topic == "gnss/fix":
                continue
            out.write(topic, message, time)
            if topic == "truth/fix" and message.header.stamp.nsecs == 20_000_000:
                message.header.frame_id = "gnss_link"
                message.header.stamp.nsecs += 5_000_000
                message.position_covariance_type, message.position_covariance = 2, [0.01, 0, 0, 0, 0.01, 0, 0, 0, 1]
                out.write("gnss/fix", message, time)
    later = toolbox.reprocess(tmp_path / "later.bag", tmp_path / "out", ["ss_srukf"], "--config", few)
    found = toolbox.topics(later)["ss_srukf/odometry"]
    assert len(found) > 2900 and found[0].twist.covariance[0] > 0.5  # as unsure as the heading makes it


@pytest.mark.parametrize("lacks", ["imu/data", "dvl/twist", "depth/pose", "gnss/fix"])
def test_a_missing_topic_is_named(lacks, tow, few, tmp_path):
    bag = changed(tow, tmp_path / "sins.bag", lambda topic, message: None if topic == lacks else message)
    done = toolbox.run("reprocess", bag, "-o", tmp_path / "out", "--estimators", "ss_srukf", "--config", few)
    assert done.returncode == 1 and lacks in done.stderr and len(done.stderr.splitlines()) == 1
    assert toolbox.snapshot(tmp_path / "out") == {}


@pytest.mark.parametrize("settings, culprit", [({"particles": {"number": 0}}, "particles.number is 0"), ({"gps": {"markov": [1, 1, 1]}}, "gps.markov"),
                                               ({"start": {"heading_deg": 100}}, "start.heading_deg is 100")])
def test_a_wrong_configuration_is_refused(settings, culprit, tow, tmp_path):
    file = toolbox.write_yaml(tmp_path / "a.yaml", {"system": "sins_dvl", **settings})
    done = toolbox.run("reprocess", tow, "-o", tmp_path / "out", "--estimators", "ss_srupf", "--config", file)
    assert done.returncode == 1 and culprit in done.stderr


def test_one_particle_does(tow, tmp_path):
    one = toolbox.write_yaml(tmp_path / "a.yaml", {"system": "sins_dvl", "particles": {"number": 1}})
    out = toolbox.topics(toolbox.reprocess(tow, tmp_path / "out", ["ss_srupf", "ss_srukf", "pf"], "--config", one))
    assert [m.pose.pose for m in out["ss_srupf/odometry"]] == [m.pose.pose for m in out["ss_srukf/odometry"]]  # a mixture of one is its filter
    assert len(out["pf/odometry"]) == len(out["ss_srukf/odometry"])


def test_unknown_estimators_are_refused(tow, few, tmp_path):
    done = toolbox.run("reprocess", tow, "-o", tmp_path / "out", "--estimators", "kf", "--config", few)
    assert done.returncode == 1 and "'kf' is no estimator of this system" in done.stderr and "ss_srupf" in done.stderr


def test_nobody_asks_a_towfish_when_it_was_aligned(simulated, tmp_path):
    towfish = toolbox.reprocess(simulated, tmp_path / "out", ["kf"])
    assert "aligned" not in toolbox.succeed("evaluate.py", towfish, "-o", tmp_path / "report")
    assert "aligned" not in (tmp_path / "report" / "report.html").read_text().split("<script")[0]
