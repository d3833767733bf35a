#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""Scores the estimates in a bag against its truth: prints a table, writes metrics.json, series.json and report.html."""
import argparse
import os
import subprocess
import sys

sys.path.insert(0, os.path.dirname(os.path.realpath(__file__)))

from sas_motion_report import ReportError  # noqa: E402
from sas_motion_report.files import find_tool, make_folder, write_atomically  # noqa: E402
from sas_motion_report.images import read_focus  # noqa: E402
from sas_motion_report.inputs import read_metrics, read_series  # noqa: E402
from sas_motion_report.report import render  # noqa: E402
from sas_motion_report.table import terminal_table  # noqa: E402


class Parser(argparse.ArgumentParser):
    """An argument parser whose errors are one sentence."""

    def error(self, message):
        self.exit(2, f'{self.prog}: {message}; see {self.prog} --help\n')


def parse_arguments(arguments):
    """Returns the parsed command line."""
    parser = Parser(prog='evaluate.py', description=__doc__,
                    epilog='The exit status is 0 when the report was written, 1 when it could not be, 2 for a wrong command line.')
    parser.add_argument('bag', metavar='OUT.bag', nargs='?', help='bag with estimates and truth')
    parser.add_argument('-o', '--output', metavar='DIR', help='folder of the report (default: OUT_report beside the bag)')
    parser.add_argument('--from', dest='source', metavar='DIR', help='score nothing; render the metrics.json and series.json of DIR')
    parser.add_argument('--focus', metavar='DIR', help='put what focus wrote into DIR into the report: its table and, where it is drawn, its figure')
    parser.add_argument('--tool', metavar='FILE', help='the sas_motion_metrics to run, should it not be found')
    options = parser.parse_args(arguments)
    if (options.bag is None) == (options.source is None):
        parser.error('give either a bag or --from DIR')
    return options


def default_folder(bag):
    """Returns the report folder of a bag: its path without `.bag`, with `_report`."""
    return (bag[:-len('.bag')] if bag.endswith('.bag') else bag) + '_report'


def run_metrics(bag, folder, tool):
    """Runs the metrics tool, which explains its own failures on stderr."""
    if not os.path.isfile(bag):
        raise ReportError(f'there is no bag {bag}; give the path of a bag that holds estimates and truth')
    command = [tool or find_tool('sas_motion_metrics'), bag, '-o', folder]  # it makes the folder once it has read the bag
    try:
        status = subprocess.run(command, check=False).returncode
    except OSError as error:
        raise ReportError(f'{command[0]} cannot be run ({error.strerror}); build the package or name the tool with --tool') from None
    if status < 0:
        raise ReportError(f'sas_motion_metrics was stopped by signal {-status} while it read {bag}; run it by itself to see why')
    if status > 0:
        raise SystemExit(1)


def evaluate(options):
    """Scores the bag, prints the table and writes the report."""
    source = options.source or options.output or default_folder(options.bag)
    folder = options.output or source
    focus = read_focus(options.focus) if options.focus else None
    if options.bag:
        run_metrics(options.bag, folder, options.tool)
    metrics = read_metrics(os.path.join(source, 'metrics.json'))
    print(terminal_table(metrics))
    series = read_series(os.path.join(source, 'series.json'))
    make_folder(folder)
    path = os.path.join(folder, 'report.html')
    write_atomically(path, render(metrics, series, focus))
    print(f'report: {path}')


def main(arguments=None):
    """Runs the command and returns its exit status."""
    options = parse_arguments(arguments)
    try:
        evaluate(options)
        sys.stdout.flush()
    except ReportError as error:
        print(f'evaluate.py: {error}', file=sys.stderr)
        return 1
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 1
    except KeyboardInterrupt:
        return 130
    return 0


if __name__ == '__main__':
    sys.exit(main())
