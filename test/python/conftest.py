# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""Bags that several tests read."""
import pytest
import toolbox


@pytest.fixture(scope="session")
def simulated(tmp_path_factory):
    """A simulated bag of 90 s with outliers."""
    return toolbox.simulate(tmp_path_factory.mktemp("simulated") / "survey.bag")


@pytest.fixture(scope="session")
def reprocessed(simulated, tmp_path_factory):
    """The same bag with kf, robust_kf and batch."""
    return toolbox.reprocess(simulated, tmp_path_factory.mktemp("reprocessed"), ["kf", "robust_kf", "batch"])
