# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""The picture of a focused image."""
import json
import pathlib
import subprocess
import sys

import numpy as np
from matplotlib import colormaps
from matplotlib import image as pictures

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "plot_image.py"


def plot(*arguments):
    return subprocess.run([sys.executable, SCRIPT, *map(str, arguments)], text=True, capture_output=True, check=False)


def write(folder, pixels, rows):
    np.save(folder / "image.npy", pixels.astype(np.complex64))
    axes = {"origin": [0, 0, 0], "range_axis": [0, 1, 0], "along_axis": [1, 0, 0], "range_step": 0.1, "along_step": 0.1, "rows": rows, "columns": 60}
    (folder / "image.json").write_text(json.dumps(axes), encoding="utf-8")


def brightest(path):
    """Where the picture has the colour of the peak, as shares of its height from above and of its width; the colour bar is on the right."""
    colours = pictures.imread(path)[:, :, :3]
    at_peak = np.abs(colours - colormaps["inferno"](1.0)[:3]).max(axis=2) < 0.02
    at_peak[:, int(0.85 * at_peak.shape[1]):] = False
    rows, columns = np.nonzero(at_peak)
    return rows.mean() / at_peak.shape[0], columns.mean() / at_peak.shape[1]


def test_a_point_far_away_and_late_on_the_track_is_drawn_up_and_to_the_right(tmp_path):
    pixels = np.full((40, 60), 1e-3, dtype=complex)
    pixels[35:38, 50:53] = 1j
    write(tmp_path, pixels, 40)
    result = plot(tmp_path / "image.npy")
    assert result.returncode == 0, result.stderr
    row, column = brightest(tmp_path / "image.png")
    assert row < 0.4 and column > 0.6
    assert sorted(path.name for path in tmp_path.iterdir()) == ["image.json", "image.npy", "image.png"]


def test_axes_that_do_not_fit_are_an_error_and_no_picture(tmp_path):
    write(tmp_path, np.ones((40, 60)), 41)
    result = plot(tmp_path / "image.npy")
    assert result.returncode == 1 and "(41, 60)" in result.stderr and result.stderr.count("\n") == 1
    assert not (tmp_path / "image.png").exists()


def test_a_floor_above_the_peak_is_refused(tmp_path):
    result = plot(tmp_path / "image.npy", "--floor", 3)
    assert result.returncode == 2 and "--floor is 3.0" in result.stderr
