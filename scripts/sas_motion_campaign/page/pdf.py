# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""report.pdf: the page as a headless chromium prints it."""
import os
import pathlib
import shutil
import subprocess
import tempfile

from sas_motion_report import ReportError

BROWSERS = ('chromium', 'chromium-browser', 'google-chrome')
TIMEOUT = 120  # [s]


def find_browser():
    """Returns the path of a browser that prints, or None."""
    return next(filter(None, map(shutil.which, BROWSERS)), None)


def write_pdf(browser, page, path):
    """Prints the page."""
    with tempfile.TemporaryDirectory(prefix='benchmark-pdf-') as folder:
        printed = os.path.join(folder, 'report.pdf')
        sandbox = ['--no-sandbox'] if os.geteuid() == 0 else []  # chromium refuses to sandbox root; the page is ours and opens no network
        command = [browser, '--headless=new', '--disable-gpu', *sandbox, f'--user-data-dir={folder}/profile', '--no-pdf-header-footer',
                   '--virtual-time-budget=20000', f'--print-to-pdf={printed}', pathlib.Path(page).resolve().as_uri()]
        try:
            subprocess.run(command, check=False, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, timeout=TIMEOUT)
            shutil.move(printed, f'{path}.tmp')
            os.replace(f'{path}.tmp', path)
        except (OSError, subprocess.TimeoutExpired):
            raise ReportError(f'{browser} could not print {path}; open {page} and print it from there, or leave out --pdf') from None
