# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""What `focus` makes of known errors, of a simulated survey, and of bad input."""
import json
import math

import numpy as np
import pytest
import rosbag
import rospy
import toolbox
from matplotlib import image as pictures
from nav_msgs.msg import Odometry

WAVELENGTH, RANGE, ALTITUDE, SPEED, APERTURE = 0.015, 30, 10, 1, 4  # m, m, m, m/s, s
GROUND = math.sqrt(RANGE ** 2 - ALTITUDE ** 2)
# A narrow band and small elements: the image of a point is a sinc both ways.
SETTINGS = {"sonar": {"bandwidth": 4000, "pulse_length": 0.003, "element": 0.02, "receivers": 5, "spacing": 0.02, "ping_rate": 20.5, "speed": SPEED, "near_range": 28,
                      "far_range": 32},
            "aperture": {"start": 1, "duration": APERTURE}, "image": {"margin": 6}}


def odometry(seconds, x, y, yaw=0.0):
    message = Odometry()
    message.header.stamp = rospy.Time.from_sec(1000 + seconds)
    message.header.frame_id, message.child_frame_id = "map", "base_link"
    message.pose.pose.position.x, message.pose.pose.position.y = x, y
    message.pose.pose.orientation.z, message.pose.pose.orientation.w = math.sin(yaw / 2), math.cos(yaw / 2)
    return message


def write_bag(path, trajectories, duration=7):
    """A bag of trajectories {topic: function of time that gives a message or None}, 50 of them a second."""
    with rosbag.Bag(str(path), "w") as bag:
        for i in range(50 * duration + 1):
            for topic, at in trajectories.items():
                message = at(i / 50)
                if message is not None:
                    bag.write(topic, message, message.header.stamp)
    return path


def straight(t):
    return odometry(t, SPEED * t, 0)


def swaying(slant, cycles):
    """A sway that is a slant error of this amplitude [m] and as many cycles over the aperture, half a ping longer than the window on both sides."""
    return lambda t: odometry(t, SPEED * t, slant * RANGE / GROUND * math.sin(2 * math.pi * cycles * (t - 1 - APERTURE / 2) / (APERTURE + 0.05)))


@pytest.fixture(scope="module")
def sailed(tmp_path_factory):
    """A straight track and estimates of it with known errors."""
    trajectories = {"truth/odometry": straight, "sixteenth/odometry": swaying(WAVELENGTH / 16, 3), "eighth/odometry": swaying(WAVELENGTH / 8, 3),
                    "moved/odometry": lambda t: odometry(t, SPEED * t + 3, -2 + 0.02 * t, yaw=0.02),
                    "broken/pose": lambda t: None if 2 < t < 3.5 else straight(t)}
    return write_bag(tmp_path_factory.mktemp("sailed") / "sailed.bag", trajectories)


@pytest.fixture(scope="module")
def config(tmp_path_factory):
    return toolbox.write_yaml(tmp_path_factory.mktemp("config") / "focus.yaml", SETTINGS)


@pytest.fixture(scope="module")
def focused(sailed, config, tmp_path_factory):
    """(folder, what the tool printed)"""
    folder = tmp_path_factory.mktemp("focused") / "out"
    return folder, toolbox.succeed("focus", sailed, "-o", folder, "--config", config, "--autofocus", "--no-figures")


def measures(folder, name=None):
    summary = json.loads((folder / "focus.json").read_text(encoding="utf-8"))
    return summary["trajectories"][name] if name else summary


def test_truth_is_a_sinc_both_ways(focused):
    target = measures(focused[0], "truth")["targets"][0]
    for cut in (target["along"], target["range"]):
        assert cut["complete"] and cut["pslr"] == pytest.approx(-13.26, abs=0.25) and cut["islr"] == pytest.approx(-10.1, abs=0.5)
        assert cut["extent"] == pytest.approx(5 * cut["main_lobe"], rel=1e-2)
    assert target["along"]["irw"] == pytest.approx(0.886 * WAVELENGTH * RANGE / (2 * SPEED * APERTURE), rel=0.03)
    assert target["range"]["irw"] == pytest.approx(0.886 * 1500 / (2 * 4000) * RANGE / GROUND, rel=0.03)
    assert target["peak_loss"] == pytest.approx(0, abs=1e-9) and target["peak_error"] < 0.003


# PSLR, ISLR and peak loss of a sine of three cycles, and its RMS in wavelengths
@pytest.mark.parametrize("name, pslr, islr, loss, rms", [("sixteenth", -6.5, -3.0, 1.3, 1 / 16), ("eighth", -0.2, 3.4, 4.7, 1 / 8)])
def test_a_known_sway_gives_the_known_image(focused, name, pslr, islr, loss, rms):
    trajectory = measures(focused[0], name)
    target = trajectory["targets"][0]
    assert target["peak_loss"] == pytest.approx(loss, abs=0.15)
    assert target["along"]["pslr"] == pytest.approx(pslr, abs=0.2) and target["along"]["islr"] == pytest.approx(islr, abs=0.3)
    for measure in ("line_of_sight_wavelengths", "path_wavelengths"):
        assert trajectory["aperture_error"][measure] == pytest.approx(rms / math.sqrt(2), rel=0.06)
    assert trajectory["aperture_error"]["along"] == pytest.approx(0, abs=1e-6)


def test_autofocus_finds_the_sway(focused):
    before = measures(focused[0], "sixteenth")
    after = before["autofocused"]
    assert after["targets"][0]["peak_loss"] < 0.4 and after["targets"][0]["along"]["pslr"] < before["targets"][0]["along"]["pslr"] - 4
    assert (focused[0] / after["image"]).is_file()


def test_mean_and_trend_move_the_image_and_do_not_blur_it(focused):
    moved = measures(focused[0], "moved")
    assert moved["aperture_error"]["line_of_sight"] < 1e-4
    target = moved["targets"][0]
    # to starboard by 2 m less 0.02 x 3 s at the middle; along by 3 m, and the track's turn to port takes the target forward
    assert target["peak_error"] == pytest.approx(math.hypot(3 + 0.02 / SPEED * GROUND, 2 - 0.02 * 3), abs=0.02)
    assert target["peak_loss"] < 0.05 and target["along"]["pslr"] == pytest.approx(-13.26, abs=0.25)


def test_the_images_have_their_axes_beside(focused):
    folder, table = focused
    summary = measures(folder)
    assert summary["order"] == ["truth", "eighth", "moved", "sixteenth"]
    for name in summary["order"]:
        axes = json.loads((folder / f"{name}.json").read_text(encoding="utf-8"))
        pixels = np.load(folder / f"{name}.npy")
        assert pixels.shape == (axes["rows"], axes["columns"]) and axes["range_axis"] == [0, -1, 0]
        assert any(line.startswith(name) for line in table.splitlines())
    assert summary["window"]["speed"] == pytest.approx(SPEED) and summary["window"]["yaw_deg"] == pytest.approx(0, abs=1e-9)


def test_the_measures_obey_their_schema(focused):
    jsonschema = pytest.importorskip("jsonschema")
    schema = json.loads((toolbox.ROOT / "docs" / "focus.schema.json").read_text(encoding="utf-8"))
    jsonschema.Draft7Validator.check_schema(schema)
    jsonschema.validate(measures(focused[0]), schema)


def test_the_figures_are_drawn(sailed, config, tmp_path):
    toolbox.succeed("focus", sailed, "-o", tmp_path, "--config", config, "--trajectory", "eighth", "--jobs", 2)
    assert {path.name for path in tmp_path.iterdir()} == {f"{name}.{kind}" for name in ("truth", "eighth") for kind in ("npy", "json", "png")} | {"focus.json", "focus.png"}
    assert pictures.imread(tmp_path / "focus.png").std() > 0.05


def test_threads_do_not_matter(focused, sailed, config, tmp_path):
    toolbox.succeed("focus", sailed, "-o", tmp_path, "--config", config, "--trajectory", "/eighth/odometry", "--jobs", 3, "--no-figures")
    assert (tmp_path / "eighth.npy").read_bytes() == (focused[0] / "eighth.npy").read_bytes()


def test_a_smoother_focuses_better_than_a_filter(tmp_path):
    bag = toolbox.simulate(tmp_path / "survey.bag", duration=40, scenario=toolbox.SCENARIOS / "survey.yaml")
    bag = toolbox.reprocess(bag, tmp_path / "reprocessed", ["kf", "rts"])
    toolbox.succeed("focus", bag, "-o", tmp_path / "out", "--no-figures", "--jobs", 2)
    truth, kf, rts = (measures(tmp_path / "out", name) for name in ("truth", "kf", "rts"))
    assert truth["targets"][0]["along"]["pslr"] < -16  # the beam tapers the aperture
    assert truth["targets"][0]["range"]["pslr"] == pytest.approx(-13.3, abs=0.2)
    assert rts["aperture_error"]["path"] < 0.3 * kf["aperture_error"]["path"]
    assert rts["targets"][0]["peak_loss"] < kf["targets"][0]["peak_loss"] - 1
    assert truth["entropy"] < rts["entropy"] < kf["entropy"]


def test_truth_is_brought_into_the_frame_of_the_estimates(tmp_path):
    """The estimates' origin is the first fix, truth's that of the scenario: a metre or so that is no error."""
    bag = toolbox.simulate(tmp_path / "survey.bag", duration=30, scenario=toolbox.SCENARIOS / "survey.yaml")
    bag = toolbox.reprocess(bag, tmp_path / "reprocessed", ["rts"])
    toolbox.succeed("focus", bag, "-o", tmp_path / "out", "--no-figures")
    window = measures(tmp_path / "out")["window"]
    truth = toolbox.topics(bag)["truth/odometry"]
    times = [m.header.stamp.to_sec() - truth[0].header.stamp.to_sec() for m in truth]
    middle = window["start"] + (window["pings"] - 1) / 2 / window["ping_rate"]
    at = [np.interp(middle, times, [getattr(m.pose.pose.position, axis) for m in truth]) for axis in "xy"]
    datum = toolbox.topics(bag)["datum"][0]
    metres = np.array([(datum.longitude - 10.15) * math.cos(math.radians(54.35)), datum.latitude - 54.35]) * 111.3e3
    assert np.hypot(*metres) > 0.3
    assert np.array(window["origin_map"][:2]) + metres == pytest.approx(np.array(at), abs=0.05)


def test_two_targets_to_port_are_both_measured(sailed, tmp_path):
    config = toolbox.write_yaml(tmp_path / "focus.yaml", {**SETTINGS, "side": "port", "targets": [{"range": 29.5, "along": -0.8}, {"range": 30.5, "along": 0.8}]})
    toolbox.succeed("focus", sailed, "-o", tmp_path / "out", "--config", config, "--trajectory", "sixteenth", "--no-figures")
    places = [target["place"] for target in measures(tmp_path / "out")["targets"]]
    assert [place[0] for place in places] == [-0.8, 0.8] and places[0][1] == pytest.approx(math.sqrt(29.5 ** 2 - ALTITUDE ** 2))
    for truth, swayed in zip(measures(tmp_path / "out", "truth")["targets"], measures(tmp_path / "out", "sixteenth")["targets"]):
        assert truth["peak_error"] < 0.02 and truth["peak_loss"] == 0
        assert swayed["peak_error"] < 0.05 and swayed["peak_loss"] == pytest.approx(1.3, abs=0.5)


def test_a_block_throws_a_shadow(sailed, tmp_path):
    sonar = {**SETTINGS["sonar"], "bandwidth": 20000, "near_range": 29, "far_range": 31.5}
    speckle = {"density": 300, "block": {"along": 0, "range": 0.5, "size": [1, 0.3, 0.5]}}
    config = toolbox.write_yaml(tmp_path / "focus.yaml", {**SETTINGS, "sonar": sonar, "speckle": speckle, "image": {"margin": 1.6, "range_step": 0.02}})
    toolbox.succeed("focus", sailed, "-o", tmp_path / "out", "--config", config, "--trajectory", "truth", "--no-figures", "--jobs", 2)
    power = np.abs(np.load(tmp_path / "out" / "truth.npy")) ** 2
    axes = json.loads((tmp_path / "out" / "truth.json").read_text(encoding="utf-8"))
    outwards = -axes["origin"][1] + np.arange(axes["rows"]) * axes["range_step"] - GROUND
    along = axes["origin"][0] + np.arange(axes["columns"]) * axes["along_step"]
    behind = (outwards > 0.85) & (outwards < 1.3)
    shadow, beside = power[np.ix_(behind, np.abs(along) < 0.2)].mean(), power[np.ix_(behind, (along > 0.8) & (along < 1.4))].mean()
    assert shadow < 0.1 * beside


def test_a_folder_without_results_cannot_be_drawn(tmp_path):
    done = toolbox.run("plot_focus.py", tmp_path)
    assert done.returncode == 1 and len(done.stderr.splitlines()) == 1 and str(tmp_path) in done.stderr


# ---- bad input

BAD = {"no truth": ({}, [], ["truth/odometry"]),
       "no such trajectory": ({}, ["--trajectory", "kalman"], ["kalman", "eighth/odometry"]),
       "gap": ({}, ["--trajectory", "broken/pose"], ["broken/pose", "2.000 s to 3.500 s", "aperture.start"]),
       "outside": ({"aperture": {"start": 6, "duration": 4}}, [], ["aperture.start is 6", "7 s long"]),
       "too long": ({"aperture": {"duration": 20}}, [], ["20.0", "aperture.duration"]),
       "undersampled": ({"sonar": {**SETTINGS["sonar"], "receivers": 4, "speed": 0.5}}, [], ["ping_rate is 20.5", "at least 25"]),
       "memory": ({"speckle": {"density": 900000}, "memory_limit": 1e8}, [], ["MB", "speckle.density", "memory_limit"]),
       "small image": ({"image": {"margin": 2}}, [], ["image.margin is 2", "at least"]),
       "too many pixels": ({"image": {"margin": 6, "range_step": 1e-8}}, [], ["image.range_step", "at most 1000000"]),
       "unknown key": ({"apertur": 1}, [], ["focus.yaml", "apertur"])}


@pytest.mark.parametrize("kind", BAD)
def test_bad_input_is_one_sentence_and_leaves_nothing(kind, sailed, tmp_path):
    changes, arguments, culprits = BAD[kind]
    bag = sailed if kind != "no truth" else write_bag(tmp_path / "bare.bag", {"kf/odometry": straight}, 1)
    done = toolbox.run("focus", bag, "-o", tmp_path / "out", "--config", toolbox.write_yaml(tmp_path / "focus.yaml", {**SETTINGS, **changes}), *arguments)
    assert done.returncode == 1 and len(done.stderr.splitlines()) == 1 and done.stderr.startswith("focus: ")
    for culprit in culprits:
        assert culprit in done.stderr
    assert not (tmp_path / "out").exists()


def test_usage():
    assert toolbox.run("focus", "--help").returncode == 0
    for arguments in ([], ["in.bag"], ["in.bag", "-o", "out", "--no-such-flag"], ["in.bag", "-o", "out", "--jobs", "0"]):
        assert toolbox.run("focus", *arguments).returncode == 2
