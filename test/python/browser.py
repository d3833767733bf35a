# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""A real headless browser for the tests of the reports."""
import pytest


def open_browser(path, width, height):
    """A headless chromium of a given viewport that has drawn the page."""
    webdriver = pytest.importorskip('selenium.webdriver')
    options = webdriver.ChromeOptions()
    for flag in ('--headless=new', '--no-sandbox', '--disable-gpu', '--hide-scrollbars'):
        options.add_argument(flag)
    options.set_capability('goog:loggingPrefs', {'browser': 'ALL'})
    browser = webdriver.Chrome(options=options)
    show(browser, path, width, height)
    return browser


def show(browser, path, width, height):
    """Opens the page in a viewport of this size and waits until it is drawn."""
    browser.execute_cdp_cmd('Emulation.setDeviceMetricsOverride', {'width': width, 'height': height, 'deviceScaleFactor': 1, 'mobile': width < 500})
    browser.get('file://' + path)
    wait_until(browser, 'return document.documentElement.dataset.drawn !== undefined')


def wait_until(browser, condition):
    """Waits up to 60 s for a JavaScript condition."""
    from selenium.webdriver.support.ui import WebDriverWait
    WebDriverWait(browser, 60, 0.05).until(lambda b: b.execute_script(condition))


def severe(browser):
    """The browser's errors."""
    return [entry['message'] for entry in browser.get_log('browser') if entry['level'] == 'SEVERE']
