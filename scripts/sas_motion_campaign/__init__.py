# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""Campaigns of simulated runs: scheduling, resuming, statistics and their report. The C++ run_campaign computes the runs."""
