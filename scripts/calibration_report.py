#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""Draws the calibration.json that calibrate_usbl wrote: convergence, residuals, noise, track, in one HTML page."""
import argparse
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.realpath(__file__)))

from sas_motion_calibration.inputs import read_calibration  # noqa: E402
from sas_motion_calibration.report import render  # noqa: E402
from sas_motion_report import ReportError  # noqa: E402
from sas_motion_report.files import write_atomically  # noqa: E402


class Parser(argparse.ArgumentParser):
    """An argument parser whose errors are one sentence."""

    def error(self, message):
        self.exit(2, f'{self.prog}: {message}; see {self.prog} --help\n')


def main(arguments=None):
    """Runs the command and returns its exit status."""
    parser = Parser(prog='calibration_report.py', description=__doc__,
                    epilog='The exit status is 0 when the page was written, 1 when it could not be, 2 for a wrong command line.')
    parser.add_argument('calibration', metavar='CALIBRATION.json', help='what calibrate_usbl wrote beside its YAML')
    parser.add_argument('-o', '--output', metavar='HTML', default='report.html', help='page to write (default: report.html)')
    options = parser.parse_args(arguments)
    try:
        write_atomically(options.output, render(read_calibration(options.calibration)))
        print(f'report: {options.output}')
    except ReportError as error:
        print(f'calibration_report.py: {error}', file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 130
    return 0


if __name__ == '__main__':
    sys.exit(main())
