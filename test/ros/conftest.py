# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""The tests' ROS master, and the bag that they play."""
import pathlib
import sys

import pytest
import rospy

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "test" / "python"), str(ROOT / "scripts")]

import toolbox  # noqa: E402
from live import Sensors  # noqa: E402
from ros_session import Session  # noqa: E402


@pytest.fixture(scope="session")
def session(tmp_path_factory):
    opened = Session(tmp_path_factory.mktemp("ros"))
    rospy.init_node("tests", disable_signals=True, disable_rostime=True)
    yield opened
    opened.close()


@pytest.fixture(scope="session")
def sensors(session):
    """Publishers of the sensors' topics."""
    return Sensors(session)


@pytest.fixture(scope="session")
def survey(tmp_path_factory):
    """A simulated bag of 90 s with outliers."""
    return toolbox.simulate(tmp_path_factory.mktemp("survey") / "survey.bag")
