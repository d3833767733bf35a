# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""calibrate_usbl, plan_track and calibration_report.py: the whole chain from a scenario to a page, and what the user is told of bad input."""
import copy
import json
import math
import xml.etree.ElementTree

import pytest
import rosbag
import toolbox
import yaml
from browser import open_browser, severe, wait_until

CALIBRATION = toolbox.SCENARIOS / "usbl_calibration.yaml"
ANGLES, LEVER_ARM = [2, -2, 3], [0.5, 0.8, 1.0]
NOT_TRUSTED = 3

def scenario(path, name, **changes):
    """A scenario with other values at its top level."""
    return toolbox.write_yaml(path, {**yaml.safe_load((toolbox.SCENARIOS / f"{name}.yaml").read_text()), **changes})

def calibrate(bag, out, *arguments, status=0):
    """The calibration as YAML, and what the tool printed."""
    done = toolbox.run("calibrate_usbl", bag, "-o", out, *arguments)
    assert done.returncode == status, done.stderr
    return yaml.safe_load(out.read_text()), done.stdout

@pytest.fixture(scope="module")
def bag(tmp_path_factory):
    """The sample scenario, with its outliers."""
    return toolbox.simulate(tmp_path_factory.mktemp("usbl") / "usbl.bag", duration=380, seed=4, scenario=CALIBRATION)

@pytest.fixture(scope="module")
def short(tmp_path_factory):
    """Its first minute and a half."""
    return toolbox.simulate(tmp_path_factory.mktemp("short") / "short.bag", duration=90, scenario=CALIBRATION)

@pytest.fixture(scope="module")
def calibrated(bag, tmp_path_factory):
    """Its calibration: file, YAML, printed text."""
    out = tmp_path_factory.mktemp("calibrated") / "calibration.yaml"
    return (out, *calibrate(bag, out))

def test_simulated_topics(short):
    found = toolbox.topics(short)
    assert {"gnss/fix", "imu/data", "usbl/measurement", "usbl/transponder", "tf_static", "truth/odometry", "truth/label", "truth/usbl_mounting"} == set(found)
    assert found["usbl/transponder"][0].header.frame_id == "1"
    first, label = found["usbl/measurement"][0], found["truth/label"][0]
    assert first.header.stamp == label.header.stamp and label.sensor == "usbl" and len(label.outlier) == 3
    assert first.transponder_id == 1 and first.slant_range_variance == pytest.approx(0.04)
    truth = found["truth/usbl_mounting"][0]
    assert (truth.header.frame_id, truth.child_frame_id) == ("base_link", "usbl_link")
    assert (truth.transform.translation.x, truth.transform.translation.y, truth.transform.translation.z) == pytest.approx((0.8, -0.5, 1.0))  # forward, port, up

def test_the_answer_is_near_the_truth_and_within_four_sigma(calibrated):
    _, document, printed = calibrated
    assert document["trusted"] and document["observable"] and document["agrees_with_batch"] and document["estimator"] == "hvbckf"
    angles = [document["angles_deg"][name] for name in ("pitch", "roll", "heading")]
    for found, true, sigma in zip(angles, ANGLES, document["sigma"]["angles_deg"]):
        assert abs(found - true) < min(4 * sigma, 0.1)
    for found, true, sigma in zip(document["lever_arm"]["starboard_forward_up"], LEVER_ARM, document["sigma"]["lever_arm"]):
        assert abs(found - true) < min(4 * sigma, 0.15)
    assert set(document["estimators"]) == {"ckf", "vbckf", "hckf", "hvbckf", "batch"}
    assert printed.splitlines()[-1] == "observable: every unknown is seen; hvbckf and batch agree"

def test_both_senses_and_the_static_transform_say_the_same(calibrated):
    _, document, _ = calibrated
    starboard, forward, up = document["lever_arm"]["starboard_forward_up"]
    assert document["lever_arm"]["forward_port_up"] == pytest.approx([forward, -starboard, up])
    transform = document["static_transform"]
    assert transform["xyz"] == pytest.approx([forward, -starboard, up], abs=1e-6)
    words = xml.etree.ElementTree.fromstring(transform["launch"]).get("args").split()
    assert words[-2:] == ["base_link", "usbl_link"]
    x, y, z, yaw, pitch, roll = map(float, words[:6])
    assert [x, y, z] == pytest.approx(transform["xyz"], abs=1e-5) and [roll, pitch, yaw] == pytest.approx(transform["rpy"], abs=1e-7)
    origin = xml.etree.ElementTree.fromstring(transform["urdf"])
    assert [float(x) for x in origin.get("rpy").split()] == pytest.approx([roll, pitch, yaw])
    # small angles: heading is clockwise, bow up is a negative pitch of REP-103
    degrees = [x * 57.29578 for x in transform["rpy"]]
    assert degrees == pytest.approx([document["angles_deg"]["roll"], -document["angles_deg"]["pitch"], -document["angles_deg"]["heading"]], abs=0.15)

def test_outliers_are_found_where_the_simulator_put_them(calibrated, bag):
    _, document, _ = calibrated
    labels = [any(label.outlier) for label in toolbox.topics(bag)["truth/label"]]
    assert len(document["outliers_by_minute"]) == 7
    assert 0.6 * sum(labels) < sum(document["outliers_by_minute"]) < 1.2 * sum(labels)

def with_transform(bag, path, parent, child, turn):
    """The bag with one more static transform: a lever arm and, as (x, y, z, w), a rotation."""
    with rosbag.Bag(str(path), "w") as out:
        for topic, message, time in toolbox.messages(bag):
            if topic == "tf_static":
                extra = copy.deepcopy(message.transforms[0])
                extra.header.frame_id, extra.child_frame_id = parent, child
                extra.transform.translation.x, extra.transform.translation.y, extra.transform.translation.z = 0.6, -0.4, 1.3
                extra.transform.rotation.x, extra.transform.rotation.y, extra.transform.rotation.z, extra.transform.rotation.w = turn
                message.transforms.append(extra)
            out.write(("/" if topic == "tf_static" else "") + topic, message, time)
    return path

def test_a_nominal_mounting_is_corrected_to_the_same_whole(calibrated, bag, tmp_path):
    _, plain, _ = calibrated
    nominal = with_transform(bag, tmp_path / "nominal.bag", "base_link", "usbl_link", (0, 0, -0.01, 0.99995))
    document, _ = calibrate(nominal, tmp_path / "c.yaml")
    assert document["nominal"] and document["trusted"]
    for name, value in plain["angles_deg"].items():
        assert document["angles_deg"][name] == pytest.approx(value, abs=0.01)
    assert document["lever_arm"]["starboard_forward_up"] == pytest.approx(plain["lever_arm"]["starboard_forward_up"], abs=0.01)
    assert abs(document["correction"]["lever_arm"][2]) < 0.5

def test_a_sound_speed_is_estimated_by_batch(bag, tmp_path):
    config = toolbox.write_yaml(tmp_path / "usbl.yaml", {"estimate": {"range_scale": True}})
    document, printed = calibrate(bag, tmp_path / "c.yaml", "--config", config, "--estimators", "hvbckf")
    batch = document["estimators"]["batch"]
    assert document["estimator"] == "batch" and document["observability"]["unknowns"][-1] == "range_scale" and "range_scale [-]" in printed
    assert abs(batch["range_scale"]) < 4 * batch["range_scale_sigma"] < 0.002


def test_the_doubt_of_a_transponders_depth_is_that_of_the_vertical_lever_arm(bag, tmp_path):
    sure, _ = calibrate(bag, tmp_path / "sure.yaml")
    config = toolbox.write_yaml(tmp_path / "usbl.yaml", {"estimate": {"transponder": True}})
    document, _ = calibrate(bag, tmp_path / "c.yaml", "--config", config)
    assert document["estimator"] == "batch"
    batch = document["estimators"]["batch"]
    assert batch["lever_arm_sigma"][2] > 3 * sure["estimators"]["batch"]["lever_arm_sigma"][2]
    assert 0.9 * batch["transponder_sigma"][2] < batch["lever_arm_sigma"][2] < 0.12  # 0.1 m is what the survey claims
    assert all(abs(value) < 4 * sigma for value, sigma in zip(batch["transponder"], batch["transponder_sigma"]))

def test_a_centred_circle_is_refused_confidence(tmp_path):
    circle = toolbox.simulate(tmp_path / "circle.bag", duration=400, scenario=toolbox.SCENARIOS / "usbl_centred_circle.yaml")
    document, printed = calibrate(circle, tmp_path / "c.yaml", status=NOT_TRUSTED)
    assert not document["observable"] and not document["trusted"] and "static_transform" not in document
    assert printed.splitlines()[-1].startswith("not observable: ") and "fore-and-aft lever arm" in printed.splitlines()[-1]
    for found, true, sigma in zip(document["lever_arm"]["starboard_forward_up"], LEVER_ARM, document["sigma"]["lever_arm"]):
        assert abs(found - true) < 3 * sigma

def test_a_straight_line_on_one_side_is_refused_confidence(tmp_path):
    line = scenario(tmp_path / "line.yaml", "usbl_calibration", duration=70, waves={"pitch_deg": 0, "roll_deg": 0},
                    track={"kind": "waypoints", "waypoints": [{"at": [200, 100]}, {"at": [200, 400]}]})
    document, _ = calibrate(toolbox.simulate(tmp_path / "line.bag", duration=70, scenario=line), tmp_path / "c.yaml", status=NOT_TRUSTED)
    assert not document["observable"]

# ---- bad input

def changed(bag, path, change):
    """The bag with every message as `change` leaves it; it returns False for those that go."""
    with rosbag.Bag(str(path), "w") as out:
        for topic, message, time in toolbox.messages(bag):
            if change(topic, message) is not False:
                out.write(("/" if topic == "tf_static" else "") + topic, message, time)
    return path

def without(name):
    """Drops a topic."""
    return lambda topic, message: topic != name

def set_on(name, **values):
    """Sets fields of a topic's messages."""
    def change(topic, message):
        for key, value in values.items() if topic == name else ():
            setattr(message, key, value)
    return change

def renamed_transponder(topic, message):
    """A transponder that has no number."""
    if topic == "usbl/transponder":
        message.header.frame_id = "beacon"

def late_fixes(topic, message):
    """No fix before the last ping."""
    return topic != "gnss/fix" or message.header.stamp.to_sec() > 1_600_000_089

BAD = {"no measurement": (without("usbl/measurement"), ["usbl/measurement"]), "no fix": (without("gnss/fix"), ["gnss/fix"]),
       "no attitude topic": (without("imu/data"), ["imu/data"]), "no transponder": (without("usbl/transponder"), ["usbl/transponder"]),
       "unnamed transponder": (renamed_transponder, ["usbl/transponder", "frame_id"]), "other transponder": (set_on("usbl/measurement", transponder_id=5), ["transponder"]),
       "no orientation": (set_on("imu/data", orientation_covariance=[-1] + [0] * 8), ["orientation"]),
       "pings before the first fix": (late_fixes, ["usable", "before the first GNSS fix"]), "no transforms": (without("tf_static"), ["transform", "gnss_link"]),
       "no variances": (set_on("usbl/measurement", slant_range_variance=0, direction_variance=float("nan")), ["readings.range_sigma"]),
       "empty": (lambda topic, message: False, ["usbl/measurement"])}

@pytest.mark.parametrize("name", BAD)
def test_bad_bags(name, short, tmp_path):
    change, words = BAD[name]
    out = tmp_path / "calibration.yaml"
    out.write_text("older")
    done = toolbox.run("calibrate_usbl", changed(short, tmp_path / "bad.bag", change), "-o", out)
    assert done.returncode == 1 and len(done.stderr.splitlines()) == 1, done.stderr
    assert "bad.bag" in done.stderr and all(word in done.stderr for word in words), done.stderr
    assert out.read_text() == "older" and not (tmp_path / "calibration.json").exists()

def test_variances_that_messages_lack_can_be_given(short, tmp_path):
    bare = changed(short, tmp_path / "bare.bag", set_on("usbl/measurement", slant_range_variance=0, direction_variance=0))
    config = toolbox.write_yaml(tmp_path / "usbl.yaml", {"readings": {"range_sigma": 0.2, "direction_sigma_deg": 0.2}})
    done = toolbox.run("calibrate_usbl", bare, "-o", tmp_path / "c.yaml", "--config", config)
    assert done.returncode in (0, NOT_TRUSTED) and "89 pings" in done.stdout

def test_ranges_alone_are_refused_confidence(short, tmp_path):
    document, _ = calibrate(changed(short, tmp_path / "ranges.bag", set_on("usbl/measurement", direction_variance=-1)), tmp_path / "c.yaml", status=NOT_TRUSTED)
    assert not document["observable"] and "mounting angle" in document["verdict"]

@pytest.mark.parametrize("arguments, status, word", [(["--estimators", "kf"], 2, "estimators"), (["--mode", "bearings"], 2, "mode"), (["--fast"], 2, "fast"),
                                                     (["-o", "calibration.json"], 1, "calibration.json"), (["--config", "no.yaml"], 1, "no.yaml")])
def test_wrong_usage(arguments, status, word, short, tmp_path):
    done = toolbox.run("calibrate_usbl", short, *arguments, cwd=tmp_path)
    assert done.returncode == status and word in done.stderr and not list(tmp_path.iterdir())

def test_an_unknown_key_is_named(short, tmp_path):
    config = toolbox.write_yaml(tmp_path / "usbl.yaml", {"frames": {"sonar": "x"}})
    done = toolbox.run("calibrate_usbl", short, "-o", tmp_path / "c.yaml", "--config", config)
    assert done.returncode == 1 and "frames.sonar is no known key" in done.stderr

def test_a_scenario_of_an_unknown_system(tmp_path):
    done = toolbox.run("simulate", toolbox.write_yaml(tmp_path / "s.yaml", {"system": "radar"}), "-o", tmp_path / "s.bag")
    assert done.returncode == 1 and "system is 'radar'" in done.stderr and not (tmp_path / "s.bag").exists()

# ---- plan_track

def test_plan_track_tells_a_figure_eight_from_a_centred_circle(tmp_path):
    eight = toolbox.run("plan_track", toolbox.SCENARIOS / "usbl_figure_eight.yaml")
    circle = toolbox.run("plan_track", toolbox.SCENARIOS / "usbl_centred_circle.yaml")
    assert eight.returncode == 0 and eight.stdout.splitlines()[-1] == "observable: every unknown is seen"
    assert circle.returncode == NOT_TRUSTED and "not observable" in circle.stdout
    bound = {line.split()[0]: float(line.split()[-1]) for line in eight.stdout.splitlines() if line.startswith(("mounting", "lever"))}
    assert bound["mounting_x"] == pytest.approx(0.0105, rel=0.05) and bound["lever_y"] == pytest.approx(0.0134, rel=0.05)

@pytest.mark.parametrize("text, word", [("", "empty"), ("x,y\n1,2\n", "east,north"), ("east,north\n1,2\n3\n", "line 3"), ("east,north\n1,2\n1,2\n", "1 different points"),
                                        ("latitude,longitude\n95,2\n3,4\n", "line 2")])
def test_bad_waypoints(text, word, tmp_path):
    track = tmp_path / "track.csv"
    track.write_text(text)
    done = toolbox.run("plan_track", toolbox.SCENARIOS / "usbl_lines.yaml", "--track", track)
    assert done.returncode == 1 and "track.csv" in done.stderr and word in done.stderr

def test_waypoints_in_metres_and_degrees_are_the_same_track(tmp_path):
    metres, degrees = tmp_path / "m.csv", tmp_path / "d.csv"
    metres.write_text("east, north\n-300, 200\n-100, 200\n-150, 300\n")
    latitude = math.radians(32.1459)
    shape = 1 - 6.69437999e-3 * math.sin(latitude) ** 2
    metres_a_degree = [math.radians(1) * radius for radius in (6378137 * (1 - 6.69437999e-3) / shape ** 1.5 + 32, (6378137 / shape ** 0.5 + 32) * math.cos(latitude))]
    degrees.write_text("latitude,longitude\n" + "".join(f"{32.1459 + north / metres_a_degree[0]:.9f},{118.7718 + east / metres_a_degree[1]:.9f}\n"
                                                      for east, north in ((-300, 200), (-100, 200), (-150, 300))))
    bounds = [toolbox.succeed("plan_track", toolbox.SCENARIOS / "usbl_lines.yaml", "--duration", 200, "--track", track) for track in (metres, degrees)]
    found = [[float(line.split()[-1]) for line in text.splitlines()[3:9]] for text in bounds]
    assert found[0] == pytest.approx(found[1], rel=0.01)

# ---- the report

def test_report_draws_and_answers(calibrated, tmp_path):
    out, document, _ = calibrated
    page = tmp_path / "report.html"
    toolbox.succeed("calibration_report.py", out.with_suffix(".json"), "-o", page)
    browser = open_browser(str(page), 1100, 900)
    try:
        assert severe(browser) == []
        assert browser.execute_script("return [...document.querySelectorAll('.plot .main-svg')].length") >= 4
        assert document["conclusion"][1:] in browser.find_element("css selector", ".lead").text
        browser.execute_script("const c = document.getElementById('estimator'); c.value = 'batch'; c.dispatchEvent(new Event('change'));")
        wait_until(browser, "return document.documentElement.dataset.drawn === 'batch'")
        assert severe(browser) == []
        wide = browser.execute_script("return document.documentElement.scrollWidth - document.documentElement.clientWidth")
        assert wide == 0
    finally:
        browser.quit()

@pytest.mark.parametrize("content, word", [("{", "valid JSON"), (json.dumps({"schema": "other"}), "schema"), (json.dumps({"schema": "sas_motion/calibration/1"}), "lacks")])
def test_report_of_a_bad_file(content, word, tmp_path):
    source = tmp_path / "c.json"
    source.write_text(content)
    done = toolbox.run("calibration_report.py", source, "-o", tmp_path / "r.html")
    assert done.returncode == 1 and len(done.stderr.splitlines()) == 1 and word in done.stderr and not (tmp_path / "r.html").exists()
