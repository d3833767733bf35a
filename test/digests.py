#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""Digests of what the tools answer, field by field: shows that a change of the code's structure changed no figure.

usage: digests.py record OUT.json [--only PART...]          with the devel space sourced
       digests.py compare BEFORE.json AFTER.json [--renamed OLD=NEW...]    OLD: a regular expression; exit status 1 where something differs

Parts: suites (results and bounds of three seeds), bags (what simulate writes, what reprocess answers with every estimator, what sas_motion_metrics scores,
what focus measures) and calibration. Times, versions and hashes of configurations are left out.
"""
import argparse
import collections
import hashlib
import json
import math
import os
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[1]
SUITES = {"smoke": 3, "eight_laws": 3, "asynchronous": 3, "ins": 3, "imaging": 3, "sins_dvl": 3, "usbl": 3}
LEFT_OUT = {"version", "config_hash", "cost", "source", "bag", "config", "input", "identity", "seq"}
TOWFISH = ["kf", "gated_kf", "robust_kf", "student_t_kf", "mckf", "mixture_kf", "bank_kf", "robust_kf_cauchy", "rts", "batch", "gnc", "fixed_lag"]
INS = ["ins", "gnss_alone", "dvl", "kf27", "gnss_kf27", "dvl_kf27", "open_loop_kf27", "robust_kf27", "gnss_robust_kf27", "dvl_robust_kf27",
       "steady_kf27", "steady_robust_kf27", "batch", "fixed_lag"]
SINS = ["pf", "upf", "ss_srupf", "robust_ss_srupf", "steady_ss_srupf", "ss_srupf_optimal", "ss_srupf_literal", "ss_srukf", "ukf", "kf27", "robust_kf27",
        "batch", "fixed_lag"]
FOCUSED = ["robust_kf27", "steady_robust_kf27", "batch"]
SIMULATED = {  # name: scenario, seconds, configuration, estimators
    "towfish": ("survey_outliers_20.yaml", 120, None, TOWFISH),
    "ins": ("ins/survey.yaml", 120, "ins_gps_dvl.yaml", INS),
    "sins": ("sins_dvl/large_angle.yaml", 60, "sins_dvl.yaml", SINS),
    "usbl": ("usbl_outliers.yaml", 100, None, None),
}


def run(tool, *arguments):
    """Standard output of a tool that must succeed."""
    found = subprocess.run(["catkin_find", "--first-only", "--libexec", "sas_motion"], text=True, capture_output=True, check=True)
    return subprocess.run([pathlib.Path(found.stdout.strip()) / tool, *map(str, arguments)], text=True, stdout=subprocess.PIPE, check=True).stdout


def fields(value, path=""):
    """(path, leaf) of everything in nested dictionaries and lists, but for what names a time or a version."""
    if isinstance(value, dict):
        for key in sorted(value):
            if key not in LEFT_OUT:
                yield from fields(value[key], f"{path}.{key}" if path else key)
    elif isinstance(value, list):
        for item in value:
            yield from fields(item, path + "[]")
    else:
        yield path, value


class Digests:
    """A hash and a count for each field of what is added, in the order in which it comes."""

    def __init__(self):
        self.hashes = collections.defaultdict(hashlib.sha256)
        self.counts = collections.Counter()
        self.sums = collections.Counter()

    def add(self, prefix, value):
        """All fields of a value."""
        for path, leaf in fields(value, prefix):
            self.hashes[path].update((repr(leaf) + "\n").encode())
            self.counts[path] += 1
            if isinstance(leaf, (int, float)) and math.isfinite(leaf):
                self.sums[path] += leaf

    def result(self):
        """By path: digest, number of values and their sum, which shows how far apart two digests are."""
        return {path: [h.hexdigest()[:16], self.counts[path], self.sums[path]] for path, h in sorted(self.hashes.items())}


def plain(message):
    """A message as nested dictionaries."""
    if hasattr(message, "__slots__"):
        return {name: plain(getattr(message, name)) for name in message.__slots__ if name not in ("seq",)}
    if hasattr(message, "secs"):
        return message.to_nsec()
    if isinstance(message, bytes):
        return list(message)
    return [plain(item) for item in message] if isinstance(message, (list, tuple)) else message


def numbered(message):
    """The same with every element of a short list a field of its own, so that a covariance shows which of its numbers changed."""
    return {str(i): numbered(item) for i, item in enumerate(message)} if isinstance(message, list) and len(message) <= 40 else (
        {key: numbered(item) for key, item in message.items()} if isinstance(message, dict) else message)


def record_suites(digests):
    """Results and bounds of each suite."""
    for suite, runs in SUITES.items():
        file = ROOT / "config" / "suites" / f"{suite}.yaml"
        if not file.exists():
            continue
        plan = json.loads(run("run_campaign", file, "--runs", runs, "--plan"))
        print(f"digests: suite {suite}, {plan['tasks']} runs", file=sys.stderr, flush=True)
        for line in run("run_campaign", file, "--runs", runs, "--tasks", f"0:{plan['tasks']}").splitlines():
            task = json.loads(line)
            digests.add(f"suite {suite}/{task['campaign']}/{task['law']}", task["results"])
        digests.add(f"bounds {suite}", json.loads(run("run_campaign", file, "--runs", runs, "--bounds")))
        if suite == "smoke":
            digests.add(f"trace {suite}", json.loads(run("run_campaign", file, "--runs", runs, "--trace")))


def add_bag(digests, name, bag, wanted=lambda topic: True):
    """Messages of a bag, by topic and field."""
    import rosbag  # pylint: disable=import-outside-toplevel
    with rosbag.Bag(str(bag)) as source:
        for topic, message, time in source.read_messages():
            bare = topic.lstrip("/")
            if wanted(bare):
                digests.add(f"{name}/{bare}", {**numbered(plain(message)), "recorded": time.to_nsec()})


def reprocessed(digests, name, bag, config, estimators, folder):
    """Answers of reprocess, its TUM files, its manifest, and the scores where there is truth."""
    settings = ["--config", ROOT / "config" / config] if config else []
    run("reprocess", bag, "-o", folder, "--estimators", ",".join(estimators), *settings)
    out = folder / bag.name
    add_bag(digests, name, out, lambda topic: topic.split("/")[0] in estimators or topic == "datum")
    digests.add(f"{name}/manifest", json.loads((folder / "manifest.json").read_text()))
    for tum in sorted(folder.glob("*.tum")):
        digests.add(f"{name}/tum/{tum.name.split('.')[-2]}", tum.read_text())
    return out


def record_bags(digests, folder):
    """Sample bags and a simulated one of each system."""
    for bag in ("survey.bag", "survey_outliers_20.bag", "usbl_calibration.bag"):
        print(f"digests: {bag}", file=sys.stderr, flush=True)
        out = reprocessed(digests, bag, ROOT / "bags" / bag, None, TOWFISH, folder / bag)
        if bag != "usbl_calibration.bag":
            run("sas_motion_metrics", out, "-o", folder / bag / "scores")
            digests.add(f"{bag}/metrics", json.loads((folder / bag / "scores" / "metrics.json").read_text())["estimators"])
    for name, (scenario, seconds, config, estimators) in SIMULATED.items():
        print(f"digests: simulated {name}", file=sys.stderr, flush=True)
        bag = folder / f"{name}.bag"
        run("simulate", ROOT / "config" / "scenarios" / scenario, "-o", bag, "--seed", 5, "--duration", seconds)
        add_bag(digests, f"simulated {name}", bag)
        if not estimators:
            continue
        out = reprocessed(digests, f"reprocessed {name}", bag, config, estimators, folder / name)
        run("sas_motion_metrics", out, "-o", folder / name / "scores")
        digests.add(f"reprocessed {name}/metrics", json.loads((folder / name / "scores" / "metrics.json").read_text())["estimators"])
        if name == "ins":
            run("focus", out, "-o", folder / name / "images", "--trajectory", *FOCUSED)
            digests.add(f"focus {name}", json.loads((folder / name / "images" / "focus.json").read_text()))


def record_calibration(digests, folder):
    """The calibration of the sample bag: the document and its trace."""
    print("digests: calibrate_usbl", file=sys.stderr, flush=True)
    import yaml  # pylint: disable=import-outside-toplevel
    run("calibrate_usbl", ROOT / "bags" / "usbl_calibration.bag", "-o", folder / "calibration.yaml")
    digests.add("calibration", yaml.safe_load((folder / "calibration.yaml").read_text()))
    digests.add("calibration trace", json.loads((folder / "calibration.json").read_text()))


def record(out, only):
    """Writes the digests of this build."""
    digests = Digests()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        if "bags" in only:
            record_bags(digests, folder)
        if "calibration" in only:
            record_calibration(digests, folder)
        if "suites" in only:
            record_suites(digests)
    pathlib.Path(out).write_text(json.dumps(digests.result(), indent=0) + "\n", encoding="utf-8")
    print(f"digests: {len(digests.counts)} fields, {sum(digests.counts.values())} values")


def renamed(path, names):
    """A field's path with estimators, or other parts of it, by their new names."""
    for old, new in names:
        path = re.sub(old, new, path)
    return path


def compare(before, after, names):
    """Prints every field that differs; returns the exit status."""
    old = {renamed(path, names): value for path, value in json.loads(pathlib.Path(before).read_text()).items()}
    new = json.loads(pathlib.Path(after).read_text())
    differing = [path for path in sorted(old.keys() | new.keys()) if old.get(path, [None])[0] != new.get(path, [None])[0]]
    for path in differing:
        print(f"{path}: {old.get(path, 'was not there')} -> {new.get(path, 'is gone')}")
    print(f"{len(old.keys() & new.keys()) - sum(p in old and p in new for p in differing)} fields equal, {len(differing)} differ")
    return 1 if differing else 0


def main():
    """See above."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    one = commands.add_parser("record")
    one.add_argument("out")
    one.add_argument("--only", nargs="+", choices=("suites", "bags", "calibration"), default=("suites", "bags", "calibration"))
    two = commands.add_parser("compare")
    two.add_argument("before")
    two.add_argument("after")
    two.add_argument("--renamed", nargs="*", default=[], metavar="OLD=NEW")
    options = parser.parse_args()
    if options.command == "record":
        os.environ.setdefault("PYTHONDONTWRITEBYTECODE", "1")
        return record(options.out, options.only)
    return sys.exit(compare(options.before, options.after, [pair.split("=", 1) for pair in options.renamed]))


if __name__ == "__main__":
    main()
