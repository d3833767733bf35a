# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""What the tests of the tools and of the nodelets share: running a tool, simulating a bag, reading odometry back."""
import collections
import functools
import os
import pathlib
import subprocess

import rosbag
import yaml

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCENARIOS = ROOT / "config" / "scenarios"
OUTLIERS = SCENARIOS / "survey_outliers_10.yaml"
ENVIRONMENT = {**os.environ, "PYTHONDONTWRITEBYTECODE": "1"}


def tools():
    """Folder of the built tools."""
    found = subprocess.run(["catkin_find", "--first-only", "--libexec", "sas_motion"], text=True, capture_output=True, check=False)
    folder = pathlib.Path(found.stdout.strip() or "/nowhere")
    assert (folder / "reprocess").is_file(), "sas_motion's tools are not found; build the package and source devel/setup.bash"
    return folder


TOOLS = tools()


def run(tool, *arguments, **options):
    """A tool in a process of its own."""
    return subprocess.run([TOOLS / tool, *map(str, arguments)], text=True, capture_output=True, env=ENVIRONMENT, check=False, timeout=600, **options)


def succeed(tool, *arguments):
    """Standard output of a tool that must succeed."""
    done = run(tool, *arguments)
    assert done.returncode == 0, f"{tool} {arguments}: status {done.returncode}: {done.stderr}"
    return done.stdout


def simulate(path, duration=90, seed=1, scenario=OUTLIERS):
    """A simulated bag; 90 s with one measurement in ten an outlier unless told otherwise."""
    succeed("simulate", scenario, "-o", path, "--duration", duration, "--seed", seed)
    return path


def reprocess(bag, folder, estimators, *arguments):
    """The reprocessed bag."""
    succeed("reprocess", bag, "-o", folder, "--estimators", ",".join(estimators), *arguments)
    return pathlib.Path(folder) / pathlib.Path(bag).name


def write_yaml(path, settings):
    """A configuration file."""
    path.write_text(yaml.safe_dump(settings))
    return path


def messages(bag, *wanted):
    """(topic without leading slash, message, record time) in the bag's order."""
    with rosbag.Bag(str(bag)) as source:
        for topic, message, time in source.read_messages():
            if not wanted or topic.lstrip("/") in wanted:
                yield topic.lstrip("/"), message, time


def numbers(odometry):
    """All that an odometry message estimates."""
    pose, twist = odometry.pose.pose, odometry.twist.twist
    return (*(getattr(pose.position, axis) for axis in "xyz"), *(getattr(pose.orientation, axis) for axis in "xyzw"),
            *(getattr(part, axis) for part in (twist.linear, twist.angular) for axis in "xyz"), *odometry.pose.covariance, *odometry.twist.covariance)


def by_stamp(odometry):
    """The last answer for each stamp [ns]."""
    return {m.header.stamp.to_nsec(): numbers(m) for m in odometry}


@functools.lru_cache(maxsize=8)
def _topics(bag, _modified):
    found = collections.defaultdict(list)
    for topic, message, _ in messages(bag):
        found[topic].append(message)
    return found


def topics(bag):
    """Messages by topic."""
    return _topics(str(bag), os.stat(bag).st_mtime_ns)


def estimates(bag, topic):
    """The last answer for each stamp [ns] of an odometry topic in a bag."""
    return by_stamp(topics(bag)[topic])


def snapshot(folder):
    """Every file below a folder, with its bytes."""
    return {str(p.relative_to(folder)): p.read_bytes() for p in sorted(pathlib.Path(folder).rglob("*")) if p.is_file()}
