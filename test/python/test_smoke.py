# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""Simulate, reprocess, score, benchmark: the tools as their users chain them."""
import json

import jsonschema
import pytest
import toolbox
import yaml

SUITE = toolbox.ROOT / "config" / "suites" / "accuracy.yaml"


def test_metrics_of_a_real_bag_fit_their_schema(reprocessed, tmp_path):
    # WHEN a reprocessed bag is scored
    toolbox.succeed("sas_motion_metrics", reprocessed, "-o", tmp_path)
    metrics = json.loads((tmp_path / "metrics.json").read_text())
    # THEN metrics.json has its documented form, and an answer for every estimator
    schema = json.loads((toolbox.ROOT / "docs" / "metrics.schema.json").read_text())
    jsonschema.Draft7Validator.check_schema(schema)
    jsonschema.validate(metrics, schema)
    assert set(metrics["estimators"]) == {"kf", "robust_kf", "batch"}
    for name, scores in metrics["estimators"].items():
        assert scores["samples"] > 1000 and not scores["diverged"], name
        assert scores["cost"]["seconds"] > 0, name


def test_ten_percent_outliers_hurt_kf_more_than_robust_kf_and_batch(reprocessed, tmp_path):
    toolbox.succeed("sas_motion_metrics", reprocessed, "-o", tmp_path)
    rmse = {name: e["position"]["rmse"] for name, e in json.loads((tmp_path / "metrics.json").read_text())["estimators"].items()}
    assert rmse["batch"] < rmse["robust_kf"] < rmse["kf"]


def test_evaluate_writes_the_report_of_a_real_bag(reprocessed, tmp_path):
    table = toolbox.succeed("evaluate.py", reprocessed, "-o", tmp_path)
    assert all(name in table for name in ("kf", "robust_kf", "batch"))
    assert "<html" in (tmp_path / "report.html").read_text()[:500]


def test_the_accuracy_suite_has_all_its_rows(tmp_path):
    # WHEN the suite of the published table runs with one seed a law
    table = toolbox.succeed("benchmark", SUITE, "--runs", 1, "-o", tmp_path)
    # THEN every estimator has a row under every law, printed and in the files, and there is a report
    summary = json.loads((tmp_path / "summary.json").read_text())
    results = [json.loads(line) for line in (tmp_path / "results.jsonl").read_text().splitlines()]
    lines = table.splitlines()
    for campaign in yaml.safe_load(SUITE.read_text())["campaigns"]:
        laws = [law["name"] for law in campaign["laws"]]
        assert [r["law"] for r in results if r["campaign"] == campaign["name"]] == laws
        found = summary["campaigns"][campaign["name"]]["laws"]
        assert list(found) == laws
        begin = next(i for i, line in enumerate(lines) if line.startswith(f"accuracy, {campaign['name']} "))
        for law in laws:
            rows = lines[lines.index(law, begin) + 2:][:len(campaign["estimators"])]
            assert [row.split()[0] for row in rows] == campaign["estimators"]
            assert set(found[law]["estimators"]) == set(campaign["estimators"])
    assert "<html" in (tmp_path / "report.html").read_text()[:500]


def test_the_shipped_configuration_is_the_default(simulated, tmp_path):
    # WHEN a bag is reprocessed with config/towfish.yaml and with nothing
    names = ["kf", "gated_kf", "robust_kf", "student_t_kf", "mckf", "mixture_kf", "rts", "batch", "gnc", "fixed_lag"]
    built_in = toolbox.reprocess(simulated, tmp_path / "built_in", names)
    shipped = toolbox.reprocess(simulated, tmp_path / "shipped", names, "--config", toolbox.ROOT / "config" / "towfish.yaml")
    # THEN all estimates are the same to the last bit
    assert built_in.read_bytes() == shipped.read_bytes()


@pytest.mark.parametrize("scenario", sorted(toolbox.SCENARIOS.glob("*.yaml")), ids=lambda path: path.stem)
def test_every_shipped_scenario_simulates_and_reprocesses(scenario, tmp_path):
    bag = toolbox.simulate(tmp_path / "a.bag", duration=30, scenario=scenario)
    config = toolbox.ROOT / "config" / scenario.name  # of instruments that are not the default ones
    settings = ["--config", config] if config.exists() else []
    found = toolbox.estimates(toolbox.reprocess(bag, tmp_path / "out", ["robust_kf"], *settings), "robust_kf/odometry")
    assert len(found) > 30
