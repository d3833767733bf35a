# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""Wrong input to the tools: status 1, one plain sentence that names the culprit, nothing left behind, an older good output untouched."""
import pytest
import rosbag
import toolbox

ALL = ["simulate", "reprocess", "sas_motion_metrics", "benchmark", "nmea_to_bag", "evaluate.py", "calibrate_usbl", "calibration_report.py", "focus"]


def suite(campaign=None, **changes):
    """A suite of one campaign of one run, with changes to the suite and to its campaign."""
    survey = {"name": "survey", "system": "towfish", "scenario": str(toolbox.OUTLIERS), "estimators": ["kf"], "skip": 5, "laws": [{"name": "as it is"}]}
    return {"name": "small", "runs": 1, "campaigns": [{**survey, **(campaign or {})}], **changes}


@pytest.mark.parametrize("tool", ALL)
def test_help(tool):
    done = toolbox.run(tool, "--help")
    assert done.returncode == 0 and "-o" in done.stdout and not done.stderr


@pytest.mark.parametrize("tool", ALL)
@pytest.mark.parametrize("arguments", [["--no-such-flag"], [], ["in", "-o"]], ids=["unknown flag", "nothing", "flag without value"])
def test_wrong_usage(tool, arguments):
    done = toolbox.run(tool, *arguments)
    assert done.returncode == 2 and done.stderr


def refuse(tool, arguments, output, *culprits):
    """Runs a tool that must fail: first where there is no output yet, then where there is an older one."""
    output.mkdir()
    for older in ({}, {"survey.bag": b"older", "metrics.json": b"older", "summary.json": b"older"}):
        for name, content in older.items():
            (output / name).write_bytes(content)
        done = toolbox.run(tool, *arguments)
        assert done.returncode == 1, f"status {done.returncode}: {done.stderr}"
        assert len(done.stderr.splitlines()) == 1 and done.stderr.endswith("\n"), done.stderr
        assert ": " in done.stderr and "terminate" not in done.stderr
        for culprit in culprits:
            assert culprit in done.stderr
        assert toolbox.snapshot(output) == older


# ---- bags

def filtered(source, path, keep, copies=()):
    """A bag with some of another's topics; positions also under other names."""
    with rosbag.Bag(str(path), "w") as out:
        for topic, message, time in toolbox.messages(source):
            for name in ([topic] if topic in keep else []) + (list(copies) if topic == "gnss/fix" else []):
                out.write(name, message, time)


def damage(kind, source, path):
    """Writes a bag of which something is wrong."""
    data = source.read_bytes()
    index = data.index(b"index_pos=") + len(b"index_pos=")
    whole = ("gnss/fix", "imu/data", "dvl/twist", "tf_static")
    if kind == "text":
        path.write_text("This is no bag.\n" * 100)
    elif kind == "empty":
        path.write_bytes(b"")
    elif kind == "cut":
        path.write_bytes(data[:len(data) * 6 // 10])
    elif kind == "unindexed":
        path.write_bytes(data[:index] + bytes(8) + data[index + 8:])
    elif kind == "folder":
        path.mkdir()
    elif kind == "no known topic":
        filtered(source, path, ["truth/label"])
    elif kind == "no positions":
        filtered(source, path, whole[1:])
    elif kind == "no headings":
        filtered(source, path, [whole[0], *whole[2:]])
    elif kind == "ambiguous":
        filtered(source, path, whole[1:], ["port/fix", "starboard/fix"])


BAGS = {"missing": "no such file", "text": "rosbag", "empty": "rosbag", "cut": "rosbag reindex", "unindexed": "rosbag reindex", "folder": "",
        "no known topic": "gnss/fix", "no positions": "gnss/fix", "no headings": "imu/data", "ambiguous": "port/fix, starboard/fix"}


@pytest.mark.parametrize("kind", BAGS)
def test_reprocess_refuses_a_bag(kind, simulated, tmp_path):
    bag = tmp_path / "survey.bag"
    damage(kind, simulated, bag)
    refuse("reprocess", [bag, "-o", tmp_path / "out", "--estimators", "kf"], tmp_path / "out", str(bag), BAGS[kind])


@pytest.mark.parametrize("kind", ["missing", "text", "cut", "unindexed", "no known topic", "whole, but not reprocessed"])
@pytest.mark.parametrize("tool", ["sas_motion_metrics", "evaluate.py"])
def test_scoring_refuses_a_bag(tool, kind, simulated, tmp_path):
    bag = simulated
    if not kind.startswith("whole"):
        bag = tmp_path / "survey.bag"
        damage(kind, simulated, bag)
    refuse(tool, [bag, "-o", tmp_path / "out"], tmp_path / "out", str(bag))


@pytest.mark.parametrize("tool", ["sas_motion_metrics", "evaluate.py"])
def test_a_failed_scoring_leaves_no_folder(tool, simulated, tmp_path):
    done = toolbox.run(tool, simulated, "-o", tmp_path / "a" / "b")
    assert done.returncode == 1 and not list(tmp_path.iterdir())


def test_a_bag_damaged_inside_is_named(simulated, tmp_path):
    data = bytearray(simulated.read_bytes())
    for i in range(len(data) // 3, len(data) // 3 + 2000):
        data[i] ^= 0x5a
    (tmp_path / "survey.bag").write_bytes(data)
    done = toolbox.run("reprocess", tmp_path / "survey.bag", "-o", tmp_path / "out", "--estimators", "kf")
    assert done.returncode == 1 and str(tmp_path / "survey.bag") in done.stderr
    assert toolbox.snapshot(tmp_path / "out") == {}


@pytest.mark.parametrize("content", [None, "no sentences here\n" * 9, ""], ids=["missing", "text", "empty"])
def test_nmea_to_bag_refuses_a_log(content, tmp_path):
    log = tmp_path / "log.nmea"
    if content is not None:
        log.write_text(content)
    refuse("nmea_to_bag", [log, "-o", tmp_path / "out" / "survey.bag"], tmp_path / "out", str(log))


# ---- configurations, scenarios, suites

YAML = {"missing": (None, "check the path"), "not YAML": ("a: [1, {\n", "YAML"), "no mapping": ("hello\n", "mapping")}
CONFIG = {**YAML, "unknown key": ("sensors: {position: {sigmaa: 1}}", "sensors.position.sigmaa"), "out of range": ("lag: -1", "lag is -1 but must be at least 0"),
          "wrong type": ("lag: soon", "lag must be a number"), "no loss": ("estimators: {robust_kf: {loss: hubert}}", "estimators.robust_kf.loss")}
SCENARIO = {**YAML, "unknown key": ("durations: 5", "durations"), "out of range": ("step: 0", "step is 0"),
            "wrong law": ("sensors: {speed: {noise: {law: foo}}}", "sensors.speed.noise.law")}
SUITES = {**YAML, "unknown key": (suite(runz=3), "runz"), "unknown key of a campaign": (suite({"runz": 3}), "runz"), "out of range": (suite(runs=0), "runs is 0"),
          "all skipped": (suite({"skip": 600}), "skip is 600 but must be less than a run"),
          "no campaigns": ({"name": "small"}, "campaigns"), "no system": (suite({"system": "balloon"}), "balloon"),
          "missing scenario": (suite({"scenario": "nowhere.yaml"}), "nowhere.yaml"), "unknown estimator": (suite({"estimators": ["kf", "kalmann"]}), "kalmann")}


def refuse_yaml(tool, arguments, file, case, output):
    text, culprit = case
    if text is not None:
        file.write_text(text if isinstance(text, str) else str(text))
    refuse(tool, arguments, output, culprit, file.name if culprit != "nowhere.yaml" else culprit)


@pytest.mark.parametrize("kind", CONFIG)
def test_reprocess_refuses_a_configuration(kind, simulated, tmp_path):
    file = tmp_path / "a.yaml"
    refuse_yaml("reprocess", [simulated, "-o", tmp_path / "out", "--config", file], file, CONFIG[kind], tmp_path / "out")


@pytest.mark.parametrize("kind", SCENARIO)
def test_simulate_refuses_a_scenario(kind, tmp_path):
    file = tmp_path / "a.yaml"
    refuse_yaml("simulate", [file, "-o", tmp_path / "out" / "survey.bag"], file, SCENARIO[kind], tmp_path / "out")


@pytest.mark.parametrize("kind", SUITES)
def test_benchmark_refuses_a_suite(kind, tmp_path):
    file = tmp_path / "a.yaml"
    refuse_yaml("benchmark", [file, "-o", tmp_path / "out"], file, SUITES[kind], tmp_path / "out")


@pytest.mark.parametrize("names, culprit", [("kf,kalmann", "kalmann"), ("", "''"), ("kf,kf", "twice")])
def test_reprocess_refuses_estimators(names, culprit, simulated, tmp_path):
    refuse("reprocess", [simulated, "-o", tmp_path / "out", "--estimators", names], tmp_path / "out", "--estimators", culprit)


def test_a_bag_that_starts_no_estimator_is_an_error_that_says_why(simulated, tmp_path):
    for text, culprit in (("sensors: {heading: {enabled: false}}", "enabled"), ("sensors: {position: {time_offset: 100}}", "time_offset"),
                          ("sensors: {position: {enabled: false}}", "gnss/fix is disabled"), ("frames: {base: no_such_link}", "without a transform")):
        file = tmp_path / "config.yaml"
        file.write_text(text)
        done = toolbox.run("reprocess", simulated, "-o", tmp_path / "out", "--config", file)
        assert done.returncode == 1 and str(simulated) in done.stderr and culprit in done.stderr, (text, done.stdout, done.stderr)
        assert not list((tmp_path / "out").glob("*.bag"))


def test_an_ins_runs_its_own_estimator_where_none_is_named(tmp_path):
    done = toolbox.run("reprocess", tmp_path / "no.bag", "-o", tmp_path / "out", "--config", toolbox.write_yaml(tmp_path / "a.yaml", {"system": "ins_gps_dvl"}))
    assert done.returncode == 1 and "no.bag" in done.stderr and "estimator" not in done.stderr
