# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""compare.launch plays a bag through both nodelets: what they settle is what reprocess says of the same bag, to the last bit."""
import re

import pytest
import toolbox
from live import PATIENT
from ros_session import run_to_end

FILTERS = ["kf", "robust_kf", "mixture_kf"]
LIVE = [*FILTERS, "fixed_lag"]
RATE = 10  # much faster, and rosbag record, which keeps 100 messages of a topic, may lose some on a busy machine


@pytest.fixture(scope="module")
def config(tmp_path_factory):
    return toolbox.write_yaml(tmp_path_factory.mktemp("config") / "patient.yaml", PATIENT)


def compared(session, survey, recording, *arguments):
    """What compare.launch prints while it makes a recording."""
    process = session.start("roslaunch", "sas_motion", "compare.launch", f"bag:={survey}", f"output:={recording}", *arguments)
    run_to_end(process, 120)
    printed = process.log.read_text()
    assert recording.is_file(), printed[-3000:]
    return printed


@pytest.fixture(scope="module")
def launch(session, survey, config, tmp_path_factory):
    """The recording of a launch, and what the launch printed."""
    recording = tmp_path_factory.mktemp("live") / "live.bag"
    return recording, compared(session, survey, recording, f"rate:={RATE}", f"config:={config}")


@pytest.fixture(scope="module")
def recording(launch):
    return launch[0]


@pytest.fixture(scope="module")
def offline(survey, config, tmp_path_factory):
    return toolbox.reprocess(survey, tmp_path_factory.mktemp("offline"), [*LIVE, "batch"], "--config", config)


@pytest.fixture(scope="module")
def diagnostics(recording):
    """The last diagnostics of each nodelet, with those that came before the end."""
    found = {}
    for message in toolbox.topics(recording)["diagnostics"]:
        for status in message.status:
            found[status.name] = (status, {pair.key: pair.value for pair in status.values})
    return found


@pytest.mark.parametrize("name", LIVE)
def test_settled_estimates_equal_reprocess_to_the_last_bit(name, recording, offline):
    expected = toolbox.estimates(offline, f"{name}/odometry")
    settled = toolbox.estimates(recording, f"{name}/settled")
    assert len(expected) > 1400 and set(settled) == set(expected)
    assert [stamp for stamp in expected if settled[stamp] != expected[stamp]] == []


@pytest.mark.parametrize("name", LIVE)
def test_the_audit_equals_reprocess(name, recording, offline):
    def audit(bag):
        return sorted((u.header.stamp.to_nsec(), u.sensor, u.verdict, u.innovation, u.weights, u.nis, u.iterations, u.reason)
                      for u in toolbox.topics(bag)[f"{name}/update"])
    assert len(audit(offline)) > 1400 and audit(recording) == audit(offline)


def test_the_batch_solved_on_request_equals_reprocess(recording, offline):
    expected = toolbox.estimates(offline, "batch/odometry")
    solved = toolbox.estimates(recording, "batch/settled")
    assert len(expected) > 1400 and set(solved) == set(expected)
    assert max(abs(a - b) for stamp in expected for a, b in zip(solved[stamp], expected[stamp])) < 1e-9


def test_no_message_was_lost(survey, launch, diagnostics):
    sent = {topic: len(found) for topic, found in toolbox.topics(survey).items()}
    assert set(diagnostics) == {"filters: estimators", "smoother: estimators"}
    for _, values in diagnostics.values():
        for sensor, topic in (("fix", "gnss/fix"), ("imu", "imu/data"), ("twist", "dvl/twist")):
            assert int(values[f"{sensor} messages"]) == sent[topic]
            assert values[f"{sensor} lost"] == values[f"{sensor} of unknown frame"] == "0"
    assert re.search(r"solve_batch: \d+ states in", launch[1])


def test_diagnostics_tell_latency_and_verdicts(diagnostics, offline):
    for status, values in diagnostics.values():
        assert status.level == 0, status
        assert 0 < float(values["callback to publication p50 [ms]"]) <= float(values["callback to publication p99 [ms]"])
    _, values = diagnostics["filters: estimators"]
    for name in FILTERS:
        counts = [int(n) for n in values[f"{name} accepted, down-weighted, rejected, stale, invalid"].split(",")]
        expected = [0] * 5
        for update in toolbox.topics(offline)[f"{name}/update"]:
            expected[update.verdict] += 1
        assert counts == expected


def test_the_present_answer_reaches_the_end_of_the_data(recording, offline):
    for name in LIVE:
        present, settled = (toolbox.estimates(recording, f"{name}/{leaf}") for leaf in ("odometry", "settled"))
        assert max(present) == max(settled) and len(present) > 500, name


def test_the_recording_can_be_scored(recording, tmp_path):
    table = toolbox.succeed("evaluate.py", recording, "-o", tmp_path)
    assert all(name in table for name in [*LIVE, "batch"])


def test_as_shipped_at_20_times_real_time(session, survey, tmp_path):
    recording = tmp_path / "live.bag"
    compared(session, survey, recording)  # settings and rate as they come
    offline = toolbox.reprocess(survey, tmp_path, LIVE, "--config", toolbox.ROOT / "config" / "towfish.yaml")
    for name in LIVE:
        expected, settled = toolbox.estimates(offline, f"{name}/odometry"), toolbox.estimates(recording, f"{name}/settled")
        assert len(settled) > 0.9 * len(expected), name  # the recorder may lose some at this speed
        assert [stamp for stamp in settled if settled[stamp] != expected[stamp]] == [], name
        assert not any(u.verdict == u.STALE for u in toolbox.topics(recording)[f"{name}/update"]), name
