# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""The report of a campaign in a real headless browser: every control by mouse and by keyboard, on a desk and on a phone, and on paper."""
import copy
import os
import re
import sys

import campaign_front as front
import pytest
from browser import open_browser, severe, show, wait_until

sys.path.insert(0, str(front.ROOT / 'scripts'))

from sas_motion_campaign.page import sentences as prose  # noqa: E402

PLOTS = ('contamination', 'ranking', 'cost', 'particles', 'nees', 'failures', 'errors', 'effective', 'consistency', 'weights')
OF_PARTICLES = {'particles', 'effective'}


@pytest.fixture(scope='module')
def page(tmp_path_factory):
    """The report of the sample campaign, and its print."""
    folder = tmp_path_factory.mktemp('page')
    said = front.succeed(folder, 'out', '--pdf', report=True)
    assert 'report.html' in said and 'report.pdf' in said
    return folder / 'out' / 'report.html'


@pytest.fixture(scope='module')
def browser(page):
    """One browser for all."""
    started = open_browser(str(page), 1280, 900)
    yield started
    started.quit()


@pytest.fixture
def desktop(browser, page):
    """A desktop browser on the report."""
    show(browser, str(page), 1280, 900)
    return browser


def drawn(browser, *parts):
    """Waits until the plots show this choice."""
    wait_until(browser, f'return document.documentElement.dataset.drawn === "{" / ".join(parts)}"')


def shown(browser):
    """The plots that hold a drawing."""
    script = 'return arguments[0].filter(n => { const p = document.getElementById("plot-" + n); return !p.hidden && p.querySelector("svg.main-svg"); })'
    return set(browser.execute_script(script, list(PLOTS)))


def focused(browser):
    """The id of the element that has the focus."""
    return browser.execute_script('return document.activeElement.id')


def choices(campaign):
    """Every law with the last estimator, every estimator with the last law."""
    laws, names = [law['name'] for law in campaign['laws']], campaign['estimators']
    return [(law, names[-1]) for law in laws] + [(laws[-1], name) for name in names]


def test_every_choice_draws_without_an_error(desktop):
    from selenium.webdriver.support.ui import Select
    for campaign in front.SUITE['campaigns']:
        desktop.find_element('css selector', f'[role=tab][data-campaign={campaign["name"]}]').click()
        for law, estimator in choices(campaign):
            Select(desktop.find_element('id', 'law')).select_by_visible_text(law)
            Select(desktop.find_element('id', 'estimator')).select_by_visible_text(estimator)
            drawn(desktop, campaign['name'], law, estimator)
            weights = {'weights'} if estimator == 'kf' else set()  # kf has none
            failures = set() if (campaign['name'], law) == ('towfish', 'contaminated 0.2, K 20') else {'failures'}
            assert set(PLOTS) - shown(desktop) == weights | failures | OF_PARTICLES
    for summary in desktop.find_elements('css selector', 'summary'):
        if summary.is_displayed():
            summary.click()
    assert severe(desktop) == []


def test_bound_and_reference_are_drawn_in(desktop):
    desktop.find_element('css selector', '[role=tab][data-campaign=towfish]').click()
    wait_until(desktop, 'return document.documentElement.dataset.drawn.startsWith("towfish")')
    names = desktop.execute_script('return document.getElementById("plot-contamination").data.map(t => t.name)')
    assert {'bound', 'bayes_reference', 'kf'} <= set(names)
    bars = desktop.execute_script('return document.getElementById("plot-contamination").data[0].error_y.array')
    assert all(bar > 0 for bar in bars)


def test_the_share_of_outliers_is_the_axis_where_it_tells_the_laws_apart(desktop):
    laws = 'return document.getElementById("plot-contamination").data[0].x'
    assert desktop.execute_script(laws) == [law['name'] for law in front.LAWS]
    desktop.find_element('css selector', '[role=tab][data-campaign=cv]').click()
    wait_until(desktop, 'return document.documentElement.dataset.drawn.startsWith("cv")')
    assert desktop.execute_script(laws) == [0, 10, 20]


def test_the_keyboard_reaches_everything(desktop):
    from selenium.webdriver.common.action_chains import ActionChains
    from selenium.webdriver.common.keys import Keys

    def press(key):
        ActionChains(desktop).send_keys(key).perform()
        return focused(desktop)
    # the first stop is the skip link, visible while it has the focus, and it leads to the results
    press(Keys.TAB)
    assert desktop.execute_script('const a = document.activeElement; return a.className === "skip" && a.getBoundingClientRect().left >= 0')
    assert press(Keys.ENTER) == 'results'
    # then the tabs, one stop of them all; arrows, Home and End move the choice
    assert press(Keys.TAB) == 'tab-0' and press(Keys.ARROW_RIGHT) == 'tab-1'
    wait_until(desktop, 'return document.documentElement.dataset.drawn.startsWith("cv")')
    assert press(Keys.ARROW_RIGHT) == 'tab-0' and press(Keys.END) == 'tab-1' and press(Keys.HOME) == 'tab-0'
    wait_until(desktop, 'return document.documentElement.dataset.drawn.startsWith("towfish")')
    # a folded ranking opens
    for _ in range(20):
        press(Keys.TAB)
        if desktop.execute_script('return document.activeElement.tagName') == 'SUMMARY':
            break
    press(Keys.ENTER)
    assert desktop.execute_script('return document.activeElement.parentElement.open')
    # and both choosers change the plots
    for _ in range(30):
        if press(Keys.TAB) == 'law':
            break
    assert press(Keys.ARROW_DOWN) == 'law'
    drawn(desktop, 'towfish', 'contaminated 0.2, K 20', 'robust_kf')  # which cv has too, so it stayed chosen
    assert press(Keys.TAB) == 'estimator'
    press(Keys.ARROW_UP)
    drawn(desktop, 'towfish', 'contaminated 0.2, K 20', 'gated_kf')
    assert severe(desktop) == []


def test_a_phone_shows_all_without_overflow(browser, page):
    show(browser, str(page), 390, 844)
    for tab in browser.find_elements('css selector', '[role=tab]'):
        tab.click()
        drawn(browser, tab.text, 'contaminated 0.1, K 10', 'mixture_kf' if tab.text == 'towfish' else 'robust_kf')
        browser.execute_script('document.querySelectorAll("details").forEach(part => { part.open = true; })')
        assert browser.execute_script('return document.documentElement.scrollWidth') <= 390
    sizes = browser.execute_script('return [...document.querySelectorAll("select, [role=tab]")].map(e => e.getBoundingClientRect().height)')
    assert min(sizes) >= 40  # a finger's width
    assert severe(browser) == []


def test_roles_and_names(desktop):
    script = '''return [...document.querySelectorAll("[role=tab]")].every(tab => document.getElementById(tab.getAttribute("aria-controls")).getAttribute("role") === "tabpanel")
        && [...document.querySelectorAll("select")].every(s => s.labels.length === 1)
        && [...document.querySelectorAll("[aria-labelledby]")].every(e => document.getElementById(e.getAttribute("aria-labelledby")))
        && new Set([...document.querySelectorAll("main [id]")].map(e => e.id)).size === document.querySelectorAll("main [id]").length'''
    assert desktop.execute_script(script)


def test_paper(page, desktop):
    assert page.with_name('report.pdf').read_bytes().startswith(b'%PDF') and page.with_name('report.pdf').stat().st_size > 50000
    desktop.execute_cdp_cmd('Emulation.setEmulatedMedia', {'media': 'print'})
    try:
        hidden = desktop.execute_script('return [".skip", "nav", "#tabs", "select"].map(s => getComputedStyle(document.querySelector(s)).display)')
        panels = desktop.execute_script('return [...document.querySelectorAll(".panel")].map(p => p.getBoundingClientRect().height > 0)')
    finally:
        desktop.execute_cdp_cmd('Emulation.setEmulatedMedia', {'media': ''})
    assert set(hidden) == {'none'} and panels == [True, True]


def test_the_page_needs_no_network(page, desktop):
    assert not re.search(r'''(?:src|href)\s*=\s*["']?(?:https?:)?//''', page.read_text(encoding='utf-8'))
    assert desktop.execute_script('return performance.getEntriesByType("resource").filter(e => /^(http|ws)/.test(e.name)).length') == 0
    assert os.path.getsize(page) < 8e6


def estimator(ratio, nees=1.0, diverged=0, bound=None):
    """A summary of one estimator under one law, its error `ratio` times the reference's."""
    def exact(x):
        return {'value': x, 'low': 0.99 * x, 'high': 1.01 * x}
    return {'runs': 100, 'diverged': diverged, 'locked_out': None, 'errors': {'position': {'rms': exact(ratio)}}, 'nees': {'full': exact(nees)},
            'ratios': {'bayes_reference': exact(ratio), 'kf': exact(ratio / 2), 'best': exact(1.0), 'bound': exact(bound or ratio)}}


@pytest.fixture(scope='module')
def particles(tmp_path_factory, browser):
    """The browser on the report of two campaigns that differ in particles alone."""
    folder = tmp_path_factory.mktemp('particles')
    front.write_suite(folder, campaigns=[{'name': f'particles_{count}', 'system': 'sins_dvl', 'particles': count, 'estimators': ['pf', 'ss_srupf'], 'laws': front.LAWS[:2]}
                                         for count in (1000, 50)])
    front.succeed(folder, 'out', report=True)
    show(browser, str(folder / 'out' / 'report.html'), 1280, 900)
    drawn(browser, 'particles_1000', 'contaminated 0.1, K 10', 'ss_srupf')
    return browser


def data_of(browser, name):
    """What a plot draws, its frame, and the titles of its y axes."""
    return browser.execute_script("""const p = document.getElementById("plot-" + arguments[0]);
        return [p.data.map(t => ({name: t.name, x: [...t.x], y: [...t.y], fill: t.fill || null, axis: t.yaxis || 'y'})),
          Object.keys(p.layout).filter(key => key.startsWith('yaxis')).sort().map(key => p.layout[key].title.text), p.layout.shapes]""", name)


def test_a_run_shows_every_error_in_its_unit_with_its_band(particles):
    lines, titles, _ = data_of(particles, 'errors')
    assert titles == ['position [m]', 'velocity [m/s]', 'heading [deg]']
    for axis in ('y', 'y2', 'y3'):
        row = [line for line in lines if line['axis'] == axis]
        assert sum(line['fill'] == 'tonexty' for line in row) == 1 and [line['name'] for line in row if line['name'] in ('pf', 'ss_srupf')] == ['pf', 'ss_srupf']
    band = next(line for line in lines if line['axis'] == 'y3' and line['fill'])
    assert band['y'][0] == pytest.approx(3 * 0.01 * 57.2958, rel=1e-3)  # the stand-in's heading is wrong by 0.01 rad
    assert len(band['y']) == 60 and band['x'][:2] == [8, 18]  # where it is stated, without gaps


def test_effective_particles_stand_beside_half_of_them(particles):
    (line,), _, shapes = data_of(particles, 'effective')
    assert line['name'] == 'ss_srupf' and len(line['y']) == 300 and 400 <= min(line['y']) <= max(line['y']) <= 1000
    assert [shape['y0'] for shape in shapes] == [500]


def test_accuracy_and_cost_are_curves_over_the_particles(particles):
    lines, titles, _ = data_of(particles, 'particles')
    assert titles == ['position RMS error [m]', 'computing [µs/update]']
    assert [(line['name'], line['axis'], line['x']) for line in lines] == [(name, axis, [50, 1000]) for name in ('pf', 'ss_srupf') for axis in ('y', 'y2')]
    assert all(value > 0 for line in lines for value in line['y'])
    assert particles.execute_script('return document.querySelectorAll("#c0-particles-0 tbody tr").length') == 4
    assert severe(particles) == []


def test_the_sentences_say_what_the_numbers_say():
    laws = {law: {'estimators': {'kf': estimator(2.0, 3.0), 'a': estimator(a, diverged=d), 'b': estimator(b), 'bayes_reference': estimator(1.0, bound=loose)}}
            for law, a, b, loose, d in (('clean', 1.02, 1.05, 1.01, 0), ('heavy', 1.04, 1.2, 1.3, 0), ('bursts', 1.3, 1.1, 0.9, 4))}
    campaign = {'groups': ['position'], 'estimators': ['kf', 'a', 'b', 'bayes_reference'], 'laws': laws}
    text = ' '.join(prose.sentences(campaign, {law: {'kf': 0.5, 'a': 1.0} for law in laws}))
    assert 'a is the most accurate in 2 of 3 laws: 1.04 times the error of bayes_reference (knows the law) in the middle law, 1.30 times at worst (bursts)' in text
    assert 'Next is b: 1.10 times in the middle law, 1.20 times at worst (heavy)' in text
    assert 'Below the bound by more than chance: bayes_reference under bursts (0.900)' in text
    assert 'too small in some for kf (NEES/n up to 3.00)' in text
    assert 'Diverged, and only counted: a 4 of 300 runs' in text
    assert 'An update of a costs 1.00 µs, 2.0 times that of kf' in text
    tied = copy.deepcopy(campaign)
    del tied['laws']['heavy'], tied['laws']['bursts']
    assert 'a is the most accurate in 1 of 1 law' in ' '.join(prose.sentences(tied, {}))
