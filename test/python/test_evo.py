# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""Our TUM files and our RMSE, checked by other people's code: evo. scripts/run_tests.sh installs it and sets EVO_APE."""
import json
import os
import re
import subprocess

import pytest
import toolbox


@pytest.fixture(scope="module")
def evo_ape():
    path = os.environ.get("EVO_APE", str(toolbox.ROOT / ".venv" / "bin" / "evo_ape"))
    assert os.access(path, os.X_OK), f"there is no evo_ape at {path}; run scripts/run_tests.sh, which installs it"
    return path


@pytest.fixture(scope="module")
def scored(reprocessed, tmp_path_factory):
    """Folder with metrics.json and the TUM files."""
    folder = tmp_path_factory.mktemp("scored")
    toolbox.succeed("sas_motion_metrics", reprocessed, "-o", folder)
    return folder


@pytest.mark.parametrize("name", ["kf", "robust_kf", "batch"])
def test_evo_finds_our_position_rmse(evo_ape, scored, name, tmp_path):
    # GIVEN the scored trajectory of an estimator and truth at the same stamps
    # WHEN evo compares them without aligning them, in a clean environment (ROS's Python path is not evo's)
    environment = {key: value for key, value in os.environ.items() if key not in ("PYTHONPATH", "PYTHONHOME")}
    done = subprocess.run([evo_ape, "tum", str(scored / f"{name}.truth.tum"), str(scored / f"{name}.tum")], text=True, capture_output=True,
                          env={**environment, "HOME": str(tmp_path), "MPLBACKEND": "Agg"}, check=False, timeout=120)
    assert done.returncode == 0, done.stderr
    # THEN its RMSE is the one in metrics.json, as far as it prints digits
    rmse = float(re.search(r"rmse\s+([0-9.]+)", done.stdout).group(1))
    expected = json.loads((scored / "metrics.json").read_text())["estimators"][name]["position"]["rmse"]
    assert expected > 0.01
    assert rmse == pytest.approx(expected, abs=1e-6)
