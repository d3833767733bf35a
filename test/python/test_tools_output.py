# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""What the tools write: the same bytes from the same input, and nothing broken where the disk is full."""
import json
import os
import resource
import shutil

import pytest
import toolbox
from test_tools import suite


def without_cost(folder):
    """A folder's files but for the measured times."""
    return {name: content for name, content in toolbox.snapshot(folder).items() if not name.endswith((".cost.json", "costs.json"))}


# ---- the same input gives the same bytes

def test_simulate_depends_on_its_seed_alone(tmp_path):
    bags = [toolbox.simulate(tmp_path / f"{i}.bag", 20, seed).read_bytes() for i, seed in enumerate((7, 7, 8))]
    assert bags[0] == bags[1] and bags[0] != bags[2]


def test_reprocess_twice_gives_the_same_bytes(simulated, tmp_path):
    names = ["kf", "mixture_kf", "rts", "batch", "fixed_lag"]
    first, second = (toolbox.reprocess(simulated, tmp_path / out, names).parent for out in ("first", "second"))
    assert without_cost(first) == without_cost(second)
    assert set(without_cost(first)) == {"survey.bag", "manifest.json", *(f"survey.{name}.tum" for name in names)}


def test_reprocess_of_a_reprocessed_bag_gives_the_same_estimates(simulated, reprocessed, tmp_path):
    again = toolbox.reprocess(reprocessed, tmp_path, ["kf"])
    assert toolbox.estimates(again, "kf/odometry") == toolbox.estimates(reprocessed, "kf/odometry")


def test_jobs_change_no_byte_of_reprocess(simulated, tmp_path):
    other = toolbox.simulate(tmp_path / "other.bag", 60, 2)
    for jobs in (1, 2):
        toolbox.succeed("reprocess", simulated, other, "-o", tmp_path / str(jobs), "--estimators", "kf,robust_kf", "--jobs", jobs)
    assert without_cost(tmp_path / "1") == without_cost(tmp_path / "2")
    assert set(json.loads((tmp_path / "1" / "manifest.json").read_text())["bags"]) == {"survey.bag", "other.bag"}


def test_jobs_change_no_byte_of_benchmark(tmp_path):
    scenario = toolbox.yaml.safe_load(toolbox.OUTLIERS.read_text())
    short = toolbox.write_yaml(tmp_path / "short.yaml", {**scenario, "duration": 30})
    small = toolbox.write_yaml(tmp_path / "suite.yaml", suite({"scenario": short.name, "estimators": ["kf", "robust_kf", "batch"]}, runs=3, first_seed=5))
    for jobs in (1, 2):
        toolbox.succeed("benchmark", small, "-o", tmp_path / str(jobs), "--jobs", jobs, "--no-report")
    assert without_cost(tmp_path / "1") == without_cost(tmp_path / "2")
    assert set(toolbox.snapshot(tmp_path / "1")) == {"results.jsonl", "summary.json", "costs.json"}


def test_resume_skips_what_is_done_and_nothing_else(simulated, tmp_path):
    out = toolbox.reprocess(simulated, tmp_path / "out", ["kf"])
    before = out.stat().st_mtime_ns
    toolbox.reprocess(simulated, tmp_path / "out", ["kf"], "--resume")
    assert out.stat().st_mtime_ns == before
    toolbox.reprocess(simulated, tmp_path / "out", ["robust_kf"], "--resume")
    assert out.stat().st_mtime_ns != before


def test_reprocess_does_not_write_over_its_input(simulated, tmp_path):
    bag = tmp_path / "survey.bag"
    shutil.copy(simulated, bag)
    for folder in (tmp_path, tmp_path / "sub" / ".."):
        (tmp_path / "sub").mkdir(exist_ok=True)
        done = toolbox.run("reprocess", bag, "-o", folder)
        assert done.returncode == 1 and str(bag) in done.stderr and len(done.stderr.splitlines()) == 1
    assert toolbox.snapshot(tmp_path) == {"survey.bag": simulated.read_bytes()}


def test_reprocess_refuses_two_bags_of_one_name(simulated, tmp_path):
    (tmp_path / "survey.bag").write_bytes(simulated.read_bytes())
    done = toolbox.run("reprocess", simulated, tmp_path / "survey.bag", "-o", tmp_path / "out")
    assert done.returncode == 1 and str(tmp_path / "survey.bag") in done.stderr
    assert not (tmp_path / "out").exists()


# ---- the disk is full

def file_size_limit(size):
    """Makes the child's writes beyond a size fail, as on a full disk; the default action of SIGXFSZ would end it."""
    return lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))


def writers(simulated, reprocessed, out):
    """Arguments of each tool that writes into the folder `out`, and what it writes first."""
    return {"simulate": [toolbox.OUTLIERS, "-o", out / "survey.bag", "--duration", 60], "reprocess": [simulated, "-o", out, "--estimators", "kf,batch"],
            "sas_motion_metrics": [reprocessed, "-o", out], "evaluate.py": [reprocessed, "-o", out],
            "benchmark": [toolbox.ROOT / "config" / "suites" / "accuracy.yaml", "--runs", 1, "-o", out],
            "nmea_to_bag": [toolbox.ROOT / "test" / "data" / "sample.nmea", "-o", out / "survey.bag"]}


@pytest.mark.parametrize("size", [0, 4096])
@pytest.mark.parametrize("tool", ["simulate", "reprocess", "sas_motion_metrics", "evaluate.py", "benchmark", "nmea_to_bag"])
def test_a_full_disk(tool, size, simulated, reprocessed, tmp_path):
    # GIVEN a folder with a good output
    out = tmp_path / "out"
    out.mkdir()
    arguments = writers(simulated, reprocessed, out)[tool]
    toolbox.succeed(tool, *arguments)
    before = toolbox.snapshot(out)
    # WHEN the tool runs again on a disk with room for almost nothing
    done = toolbox.run(tool, *arguments, preexec_fn=file_size_limit(size))
    # THEN it says so in one sentence that names the file, and the good output stands
    assert done.returncode == 1, f"status {done.returncode}: {done.stderr}"
    assert len(done.stderr.splitlines()) == 1 and str(out) in done.stderr, done.stderr
    assert without_cost(out) == {name: content for name, content in before.items() if not name.endswith((".cost.json", "costs.json"))}


def test_a_folder_that_cannot_be_made(simulated, reprocessed, tmp_path):
    (tmp_path / "file").write_text("in the way")
    for tool, arguments in writers(simulated, reprocessed, tmp_path / "file" / "out").items():
        done = toolbox.run(tool, *arguments)
        assert done.returncode == 1 and str(tmp_path / "file") in done.stderr and len(done.stderr.splitlines()) == 1, done.stderr
    assert os.listdir(tmp_path) == ["file"]
