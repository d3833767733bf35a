#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""Instructions of the filters' and smoothers' updates, counted by callgrind: repeatable whatever else the machine does."""
import argparse
import os
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[1]
SUITE = """
name: instructions
runs: 1
campaigns:
  - {{name: towfish, system: towfish, scenario: {scenarios}/zhu2007_short.yaml, estimators: [kf, gated_kf, robust_kf, student_t_kf, mckf, mixture_kf, bank_kf, rts],
     laws: [{{name: outliers, noise: {{law: contaminated, epsilon: 0.2, K: 20}}}}]}}
  - {{name: ins, system: ins_gps_dvl, scenario: {scenarios}/ins/survey.yaml, duration: 20, skip: 5, estimators: [{ins}], laws: [{{name: clean}}]}}
"""
UPDATE = re.compile(r"sas_motion::(?:\w+::)*(\w*(?:KalmanFilter|smoothRts)\w*(?:<\d+>)?)(?:::(update<\d+>|predict))?\(")


def counts(tools, names):
    """Instructions a call, by function."""
    with tempfile.TemporaryDirectory() as folder:
        suite, profile = pathlib.Path(folder) / "suite.yaml", pathlib.Path(folder) / "profile"
        suite.write_text(SUITE.format(scenarios=ROOT / "config" / "scenarios", ins=names), encoding="utf-8")
        subprocess.run(["valgrind", "--tool=callgrind", f"--callgrind-out-file={profile}", pathlib.Path(tools) / "run_campaign", suite, "--tasks", "0:2", "-j", "1"],
                       check=True, capture_output=True, env={key: value for key, value in os.environ.items() if key != "LD_LIBRARY_PATH"})
        return inclusive(profile)


def inclusive(profile):
    """Inclusive instructions over calls of each update and prediction in a callgrind profile."""
    names, cost, calls = {}, {}, {}
    callee = None
    for line in profile.read_text(encoding="utf-8").splitlines():
        if line.startswith("cfn=") or line.startswith("fn="):
            number, _, name = line.split("=", 1)[1].partition(" ")
            if name:
                names[number] = name
            callee = number if line.startswith("cfn=") else None
        elif line.startswith("calls=") and callee:
            calls[callee] = calls.get(callee, 0) + int(line[6:].split()[0])
        elif callee and re.match(r"[+\-*\d]", line):
            cost[callee] = cost.get(callee, 0) + int(line.split()[-1])
            callee = None
    found = {}
    for number, name in names.items():
        match = UPDATE.search(name)
        if match and number in calls:
            key = "::".join(part for part in match.groups() if part)
            total, count = found.get(key, (0, 0))
            found[key] = (total + cost[number], count + calls[number])
    return {key: total / count for key, (total, count) in sorted(found.items())}


def main():
    """See above."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("tools", help="folder with run_campaign")
    parser.add_argument("other_tools", nargs="?", help="a second such folder, of which the ratio to the first is printed too")
    args = parser.parse_args()
    tables = []
    for tools in filter(None, (args.tools, args.other_tools)):
        if not (pathlib.Path(tools) / "run_campaign").is_file():
            parser.error(f"{tools}: there is no run_campaign in this folder")
        for names in ("kf27, robust_kf27", "ckf27, robust_ckf27"):  # as they were called before
            try:
                tables.append(counts(tools, names))
                break
            except subprocess.CalledProcessError as error:
                failure = error.stderr
        else:
            sys.exit(failure.decode())
    for key in tables[0]:
        row = [table.get(key, float("nan")) for table in tables]
        ratio = f"{100 * row[1] / row[0] - 100:+.2f} %" if len(row) == 2 else ""
        print(f"{key:<45}" + "".join(f"{value:>14.1f}" for value in row) + f"{ratio:>12}")


if __name__ == "__main__":
    main()
