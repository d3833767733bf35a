#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""Lengths of files and functions of include/ and src/, at each commit that is named: count, sum, median, 90 %, longest.

Functions are found by their layout, as clang-format leaves it: a head with parentheses, indented by at most 2, to its closing brace.
"""
import argparse
import re
import statistics
import subprocess

HEAD = re.compile(r"^( {0,2})(?! |if|for|while|switch|else|do\b|try|namespace|struct|class|enum|union|extern|//|#|\})\S.*\{( *//.*)?$")


def git(*words):
    """What git prints."""
    return subprocess.run(["git", *words], check=True, capture_output=True, text=True).stdout


def functions(lines):
    """Lines of each function, from the line that opens its body."""
    i = 0
    while i < len(lines):
        head = HEAD.match(lines[i])
        if head and "= {" not in lines[i] and "(" in "".join(lines[max(0, i - 4):i + 1]):
            end = next((j for j in range(i + 1, len(lines)) if lines[j].startswith(head[1] + "}")), len(lines) - 1)
            yield end - i + 1
            i = end
        i += 1


def describe(lengths):
    """Count, sum, median, 90 % and longest."""
    lengths = sorted(lengths)
    return f"{len(lengths):>7}{sum(lengths):>9}{statistics.median(lengths):>8g}{lengths[int(0.9 * len(lengths))]:>7}{lengths[-1]:>9}"


def main():
    """See above."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("commits", nargs="*", default=["HEAD"], help="what to measure (HEAD)")
    print(f"{'commit':<14}{'of':<10}{'count':>7}{'lines':>9}{'median':>8}{'90 %':>7}{'longest':>9}")
    for commit in parser.parse_args().commits:
        names = git("ls-tree", "-r", "--name-only", commit, "include", "src").split()
        texts = [git("show", f"{commit}:{name}").splitlines() for name in names if name.endswith((".hpp", ".cpp"))]
        print(f"{commit[:12]:<14}{'files':<10}{describe(map(len, texts))}")
        print(f"{commit[:12]:<14}{'functions':<10}{describe(length for text in texts for length in functions(text))}")


if __name__ == "__main__":
    main()
