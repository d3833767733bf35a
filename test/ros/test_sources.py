# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""Two GNSS receivers, two gyrocompasses, a log and a DVL: each is known by its own name, live and offline."""
import pathlib

import pytest
import toolbox
import yaml
from conftest import ROOT
from geometry_msgs.msg import TwistWithCovarianceStamped
from live import PATIENT, Sensors, measurements, nodelet, quiet, transforms_of
from ros_session import wait_until
from sas_motion.srv import EnableSensor
from sensor_msgs.msg import Imu, NavSatFix

TYPES = {"gnss_bow/fix": NavSatFix, "gnss_aft/fix": NavSatFix, "gyro_1/imu": Imu, "gyro_2/imu": Imu, "log/twist": TwistWithCovarianceStamped,
         "dvl/velocity": TwistWithCovarianceStamped}
ESTIMATORS = ["kf", "robust_kf"]


@pytest.fixture(scope="module")
def bag(tmp_path_factory):
    return toolbox.simulate(tmp_path_factory.mktemp("two") / "two.bag", duration=60, scenario=ROOT / "config" / "scenarios" / "two_of_each.yaml")


@pytest.fixture(scope="module")
def config(tmp_path_factory):
    settings = yaml.safe_load(pathlib.Path(ROOT / "config" / "two_of_each.yaml").read_text(encoding="utf-8"))
    return toolbox.write_yaml(tmp_path_factory.mktemp("config") / "two.yaml", {**settings, **PATIENT})


@pytest.fixture(scope="module")
def expected(bag, config, tmp_path_factory):
    """The answers of reprocess."""
    return toolbox.reprocess(bag, tmp_path_factory.mktemp("offline"), ESTIMATORS, "--config", config)


@pytest.fixture(scope="module")
def both(session):
    """Publishers of all the topics."""
    return Sensors(session, TYPES)


def test_live_and_offline_agree_to_the_last_bit(session, both, bag, config, expected):
    with nodelet(session, both, "FilterNodelet", config, ESTIMATORS, transforms_of(bag)) as filters:
        both.feed(measurements(bag, types=TYPES))
        for name in ESTIMATORS:
            offline = toolbox.estimates(expected, f"{name}/odometry")
            wait_until(lambda name=name, last=max(offline): any(m.header.stamp.to_nsec() == last for m in filters.settled[name]), f"the end of {name}")
            assert toolbox.by_stamp(filters.settled[name]) == offline, name
            assert {m.sensor for m in filters.updates[name]} == {"gnss_bow", "gnss_aft", "gyro_1", "gyro_2", "log", "dvl"}
        values, _ = filters.counts(lambda values: values["gyro_2 messages"] != "0")
        assert values["gnss_bow messages"] == "61"


def test_one_of_two_receivers_is_disabled_by_its_name(session, both, bag, config):
    with nodelet(session, both, "FilterNodelet", config, ["kf"], transforms_of(bag)) as filters:
        assert filters.call("enable_sensor", EnableSensor, "gnss_aft", False).success
        unknown = filters.call("enable_sensor", EnableSensor, "fix", False)
        assert not unknown.success and "gnss_bow, gnss_aft, gyro_1, gyro_2, log, dvl" in unknown.message
        both.feed(measurements(bag, types=TYPES))
        quiet(filters.settled["kf"])
        wait_until(lambda: len(filters.updates["kf"]) > 500, "updates")
        assert {m.sensor for m in filters.updates["kf"]} == {"gnss_bow", "gyro_1", "gyro_2", "log", "dvl"}


def test_a_source_that_never_speaks_is_reported(session, both, bag, config):
    silent = [(topic, message) for topic, message in measurements(bag, types=TYPES) if topic != "log/twist"]
    with nodelet(session, both, "FilterNodelet", config, ["kf"], transforms_of(bag)) as filters:
        both.feed(silent[:1000])
        _, status = filters.counts(lambda values: values["gyro_2 messages"] != "0")
        assert status.level == status.WARN and "log: no message on log/twist has come" in status.message
