# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""evaluate.py and its report: the page in a real headless browser, the table, and what the user is told when it fails."""
import copy
import json
import math
import os
import random
import re
import stat
import subprocess
import sys

import pytest
from browser import open_browser, severe, wait_until

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
SCRIPT = os.path.join(ROOT, 'scripts', 'evaluate.py')
sys.path.insert(0, os.path.join(ROOT, 'scripts'))

from sas_motion_report.columns import number, percent  # noqa: E402
from sas_motion_report.headline import headline  # noqa: E402
from sas_motion_report.table import terminal_table  # noqa: E402

ERRORS = {'kf': 1.31, 'robust_kf': 0.32, 'batch': 0.19}  # position RMSE [m]


def band(mean, degrees, **extra):
    """A NEES or NIS entry."""
    return {'mean': mean, 'degrees': degrees, 'lower': 0.93 * degrees, 'upper': 1.08 * degrees, 'inside': 0.94, **extra}


def tally(labelled, flagged, hits):
    """An outlier entry."""
    return {'labelled': labelled, 'flagged': flagged, 'hits': hits, 'precision': hits / flagged if flagged else None, 'recall': hits / labelled}


def estimator_metrics(name):
    """Hand-made metrics of one estimator; the smoother `batch` has no NIS."""
    rmse = ERRORS[name]
    spread = {'rmse': rmse, 'p95': 2 * rmse, 'max': 3.3 * rmse}
    slight = {key: value / 20 for key, value in spread.items()}
    counts = tally(60, 0 if name == 'kf' else 62, 0 if name == 'kf' else 56)
    nis = {} if name == 'batch' else {'position': band(2.02, 2, count=600), 'heading': band(0.8, 1, count=6000), 'speed': band(1.3, 1, count=3000)}
    return {'samples': 6000, 'diverged': False, 'position': spread, 'heading_deg': spread, 'speed': slight, 'current': slight, 'drift_percent': rmse / 12,
            'aperture': {'time': 2.1, 'wavelength': 0.01, 'windows': 280, 'across': rmse / 400, 'along': rmse / 300, 'across_wavelengths': rmse / 4},
            'nees': {'position': band(7.3 if name == 'kf' else 2.01, 2), 'heading': band(1.0, 1), 'speed': band(0.5, 1), 'current': band(1.01, 1)},
            'nis': nis, 'outliers': {'position': counts, 'heading': counts, 'speed': counts, 'all': tally(180, 3 * counts['flagged'], 3 * counts['hits'])},
            'outages': [{'begin': 300.0, 'duration': 60.0, 'distance': 120.0, 'error_end': 3 * rmse, 'drift_percent': 2.5 * rmse}],
            'verdicts': {'accepted': 9000, 'down_weighted': 120, 'rejected': 66, 'stale': 0, 'invalid': 1},
            'cost': {'seconds': 0.2 / rmse, 'microseconds_per_update': 3.1 / rmse, 'times_real_time': 3000 * rmse}}


def sample_metrics():
    """Hand-made metrics.json of three estimators."""
    return {'schema': 'sas_motion/metrics/1', 'bag': 'lawnmower.bag', 'truth': 'truth/odometry', 'duration': 600.0, 'distance': 1200.0, 'skipped': 20.0,
            'estimators': {name: estimator_metrics(name) for name in ERRORS}}


def truth_at(t):
    """North and east [m] on two legs joined by a half circle."""
    if t < 250:
        return 2.0 * t, 0.0
    if t < 350:
        angle = math.pi * (t - 250) / 100
        return 500 + 64 * math.sin(angle), 64 * (1 - math.cos(angle))
    return 500 - 2.0 * (t - 350), 128.0


def track(times, sigma, rng):
    """A series of positions with Gaussian errors."""
    north, east = zip(*((n + rng.gauss(0, sigma), e + rng.gauss(0, sigma)) for n, e in map(truth_at, times)))
    return {'t': list(times), 'north': list(north), 'east': list(east)}


def updates(times, labels, robust, rng):
    """Weights and NIS of one sensor."""
    weights = [0.02 if bad and robust else min(1.0, rng.uniform(0.8, 1.3)) for bad in labels]
    return {'t': list(times), 'weight': weights if robust else [1.0] * len(weights), 'nis': [rng.expovariate(0.5) * (40 if bad else 1) for bad in labels]}


def estimator_series(name, fixes, rng):
    """The series of one estimator."""
    times, sigma = range(0, 600), ERRORS[name] / 1.4
    series = track(times, sigma, rng)
    for key, scale in (('north', 1), ('east', 1), ('heading_deg', 0.3)):
        series[f'error_{key}'] = [rng.gauss(0, scale * sigma) + (50 if t < 3 else 0) for t in times]
        series[f'sigma_{key}'] = [scale * sigma * (0.5 if name == 'kf' else 1.0)] * len(times)
    labels = [rng.random() < 0.05 for _ in range(2000)]
    others = [0.3 * i for i in range(2000)]
    series['updates'] = {'position': updates(fixes['t'], fixes['outlier'], name != 'kf', rng)}
    if name != 'batch':
        series['updates'].update({sensor: updates(others, labels, name != 'kf', rng) for sensor in ('heading', 'speed')})
    return series


def sample_series():
    """Hand-made series.json, seeded."""
    rng = random.Random(7)
    times = [t for t in range(600) if not 300 <= t < 360]
    fixes = track(times, 1.0, rng)
    fixes['outlier'] = [int(rng.random() < 0.1) for _ in times]
    for i, bad in enumerate(fixes['outlier']):
        fixes['north'][i] += bad * rng.gauss(0, 30)
        fixes['east'][i] += bad * rng.gauss(0, 30)
    return {'truth': track(range(600), 0.0, rng), 'fixes': fixes, 'estimators': {name: estimator_series(name, fixes, rng) for name in ERRORS}}


def write_sample(folder, metrics=None, series=None):
    """Writes both files and returns the folder."""
    for name, tree in (('metrics.json', metrics or sample_metrics()), ('series.json', series or sample_series())):
        with open(os.path.join(str(folder), name), 'w', encoding='utf-8') as file:
            json.dump(tree, file)
    return str(folder)


def evaluate(*arguments, **environment):
    """Runs evaluate.py."""
    return subprocess.run([sys.executable, SCRIPT, *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          universal_newlines=True, check=False, env={**os.environ, 'PYTHONDONTWRITEBYTECODE': '1', **environment})


def fake_tool(folder, body):
    """Writes a stand-in for sas_motion_metrics."""
    path = os.path.join(str(folder), 'tool')
    with open(path, 'w', encoding='utf-8') as file:
        file.write('#!/bin/sh\n' + body)
    os.chmod(path, stat.S_IRWXU)
    return path


@pytest.fixture(scope='module')
def page(tmp_path_factory):
    """The rendered sample report."""
    folder = write_sample(tmp_path_factory.mktemp('report'))
    done = evaluate('--from', folder)
    assert done.returncode == 0, done.stderr
    return os.path.join(folder, 'report.html')


@pytest.fixture(scope='module')
def desktop(page):
    """A desktop browser on the sample report."""
    browser = open_browser(page, 1280, 900)
    yield browser
    browser.quit()


def test_sample_obeys_schema():
    jsonschema = pytest.importorskip('jsonschema')
    with open(os.path.join(ROOT, 'docs', 'metrics.schema.json'), encoding='utf-8') as file:
        schema = json.load(file)
    jsonschema.Draft7Validator.check_schema(schema)
    jsonschema.validate(sample_metrics(), schema)
    broken = sample_metrics()
    broken['estimators']['kf']['position'].pop('rmse')
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(broken, schema)


def test_page_draws_without_errors(desktop):
    rows = [cell.text for cell in desktop.find_elements('css selector', '#results tbody th')]
    assert rows == ['batch', 'robust_kf', 'kf']
    for name in ('track', 'errors', 'weights', 'nis', 'cost'):
        assert desktop.find_elements('css selector', f'#plot-{name} svg.main-svg'), name
    assert severe(desktop) == []


def test_keyboard_changes_the_plots(desktop):
    from selenium.webdriver.common.keys import Keys
    chooser = desktop.find_element('id', 'estimator')
    before = desktop.execute_script('return document.getElementById("plot-errors").data[2].y[100]')
    chooser.send_keys(Keys.ARROW_DOWN)
    wait_until(desktop, 'return document.documentElement.dataset.drawn === "robust_kf"')
    assert desktop.execute_script('return document.getElementById("plot-errors").data[2].y[100]') != before
    assert desktop.execute_script('return document.activeElement.id') == 'estimator'
    for _ in ('kf', 'back to robust_kf', 'back to batch'):
        chooser.send_keys(Keys.ARROW_DOWN if _ == 'kf' else Keys.ARROW_UP)
    wait_until(desktop, 'return document.documentElement.dataset.drawn === "batch"')
    assert severe(desktop) == []


def test_rejected_fixes_are_told_apart(desktop):
    names = desktop.execute_script('return document.getElementById("plot-track").data.map(t => t.name)')
    assert {'truth', 'kf', 'robust_kf', 'batch', 'GNSS fix', 'fix set aside'} <= set(names)
    span = desktop.execute_script('const l = document.getElementById("plot-track")._fullLayout;'
                                  'return ["xaxis", "yaxis"].map(k => l[k]._length / (l[k].range[1] - l[k].range[0]))')
    assert span[0] == pytest.approx(span[1], rel=1e-3)  # one scale on both axes


def test_phone_has_no_overflow(page):
    browser = open_browser(page, 390, 844)
    try:
        assert browser.execute_script('return document.documentElement.scrollWidth') <= 390
        assert severe(browser) == []
    finally:
        browser.quit()


def test_page_needs_no_network(page, desktop):
    with open(page, encoding='utf-8') as file:
        text = file.read()
    assert not re.search(r'''(?:src|href)\s*=\s*["']?(?:https?:)?//''', text)
    assert desktop.execute_script('return performance.getEntriesByType("resource").filter(e => /^(http|ws)/.test(e.name)).length') == 0
    assert os.path.getsize(page) < 6e6


def test_names_are_escaped(tmp_path):
    metrics, series = sample_metrics(), sample_series()
    metrics['estimators']['<b>x</script>'] = metrics['estimators'].pop('kf')
    series['estimators']['<b>x</script>'] = series['estimators'].pop('kf')
    assert evaluate('--from', write_sample(tmp_path, metrics, series)).returncode == 0
    with open(os.path.join(str(tmp_path), 'report.html'), encoding='utf-8') as file:
        assert '<b>x' not in file.read()


def test_sparse_metrics_render_and_draw(tmp_path):
    metrics = {**sample_metrics(), 'estimators': {'kf': {'samples': 3, 'diverged': False, 'cost': None}, 'ekf': {'samples': 0, 'diverged': True}}}
    folder = write_sample(tmp_path, metrics, {'estimators': {'kf': {'t': [0, 1, 2], 'north': [0, 1, None], 'east': [0, 0, 1]}}})
    done = evaluate('--from', folder)
    assert done.returncode == 0, done.stderr
    assert 'diverged' in done.stdout
    browser = open_browser(os.path.join(folder, 'report.html'), 1280, 900)
    try:
        assert severe(browser) == []
    finally:
        browser.quit()


def test_table_fits_120_columns():
    lines = terminal_table(sample_metrics()).split('\n')
    assert max(map(len, lines)) <= 120
    kf = next(line for line in lines if line.startswith('kf')).split()
    assert kf[1:4] == ['1.31', '2.62', '4.32'] and '7.30!' in kf
    wide = copy.deepcopy(sample_metrics())
    wide['estimators']['a_name_that_is_much_too_long_for_it'] = wide['estimators']['kf']
    assert max(map(len, terminal_table(wide).split('\n'))) <= 120


def test_headline_compares():
    text = ' '.join(headline(sample_metrics()))
    assert 'robust_kf is 4.1 times closer to truth than kf' in text
    assert 'the smoother batch is 1.7 times closer to truth than robust_kf' in text
    assert 'for kf (errors 1.9σ in RMS) it is too small' in text
    assert 'caught 93 % of the 180 labelled outliers' in text and 'kf sets nothing aside' in text


def test_numbers():
    assert [number(x) for x in (None, float('nan'), 0, 0.01234, 1.234, 123.4, 12345.6)] == ['–', '–', '0', '0.0123', '1.23', '123', '12346']
    assert [percent(x) for x in (None, 0, 0.5, 0.996, 1)] == ['–', '0', '50', '99.6', '100']


def check_sentence(done, *words):
    """An error is one line on stderr with these words, status 1, no traceback."""
    assert done.returncode == 1
    assert done.stderr.count('\n') == 1 and 'Traceback' not in done.stderr, done.stderr
    assert all(word in done.stderr for word in words), done.stderr


def sample_focus(folder, figure=True):
    """What focus would have written: an error-free image, and one that is less sharp."""
    def image(loss):
        cut = {'irw': 0.062, 'pslr': -20.7 + loss, 'islr': -20.3, 'main_lobe': 0.2, 'extent': 1.0, 'complete': True}
        return {'image': 'x.npy', 'entropy': 5.0, 'whole_image_islr': -9.0, 'targets': [{'complete': True, 'range': cut, 'along': cut, 'peak_loss': loss, 'peak_error': 0.1}]}
    def trajectory(loss):
        errors = {f'{name}{unit}': 0.01 * loss for name in ('line_of_sight', 'along', 'path') for unit in ('', '_wavelengths')}
        return {**image(loss), 'topic': 'x/odometry', 'aperture_error': errors, 'image_shift': [0, 0, 0]}
    window = {'start': 20.0, 'duration': 5.0, 'speed': 2.0, 'length': 10.0, 'ping_rate': 5.0, 'pings': 26, 'origin_map': [0, 0, 0], 'yaw_deg': 0.0}
    focus = {'schema': 'sas_motion/focus/1', 'bag': 'x.bag', 'window': window, 'wavelength': 0.015, 'targets': [{'range': 66.7, 'place': [0, -66, 0]}],
             'order': ['truth', '<i>ins'], 'trajectories': {'truth': trajectory(0), '<i>ins': {**trajectory(12.5), 'autofocused': image(3.25)}}}
    folder.mkdir()
    (folder / 'focus.json').write_text(json.dumps(focus))
    if figure:
        from matplotlib import pyplot
        pyplot.figure(figsize=(14, 8)).savefig(str(folder / 'focus.png'))
    return folder


def test_images_stand_in_the_report(tmp_path):
    # GIVEN a bag's metrics and what focus made of it
    focus = sample_focus(tmp_path / 'images')
    done = evaluate('--from', write_sample(tmp_path), '--focus', focus)
    assert done.returncode == 0, done.stderr
    browser = open_browser(os.path.join(str(tmp_path), 'report.html'), 390, 844)
    try:
        # THEN the table has every trajectory with its measures, and the figure is shown, no wider than a phone
        rows = [[cell.text for cell in row.find_elements('css selector', 'th, td')] for row in browser.find_elements('css selector', '#images tbody tr')]
        assert [row[0] for row in rows] == ['error-free', '<i>ins', '– autofocused']
        assert rows[1][3] == '-8.20' and rows[1][8] == '12.5' and rows[2][8] == '3.25' and rows[2][1] == '–'
        shown = browser.execute_script('const i = document.querySelector("#section-images img"); return [i.naturalWidth, i.clientWidth]')
        assert shown[0] > 1000 and 0 < shown[1] <= 390
        assert browser.execute_script('return document.documentElement.scrollWidth') <= 390 and severe(browser) == []
    finally:
        browser.quit()


def test_images_need_no_figure_but_measures(tmp_path):
    folder = write_sample(tmp_path)
    assert evaluate('--from', folder, '--focus', sample_focus(tmp_path / 'images', figure=False)).returncode == 0
    assert '<img' not in (tmp_path / 'report.html').read_text()
    check_sentence(evaluate('--from', folder, '--focus', tmp_path), 'focus.json')
    (tmp_path / 'images' / 'focus.json').write_text('{"schema": "other"}')
    check_sentence(evaluate('--from', folder, '--focus', tmp_path / 'images'), 'focus.json', 'run focus')


def test_missing_bag(tmp_path):
    check_sentence(evaluate(tmp_path / 'none.bag'), 'none.bag', 'give the path')
    assert os.listdir(str(tmp_path)) == []


def test_wrong_command_line():
    done = evaluate()
    assert done.returncode == 2 and done.stderr.count('\n') == 1
    assert evaluate('--help').returncode == 0


@pytest.mark.parametrize('text', ['', '{"schema": "sas_mot', '[]', '{"schema": "other"}', '{"schema": "sas_motion/metrics/1"}',
                                  '{"schema": "sas_motion/metrics/1", "estimators": {}}', '{"schema": "sas_motion/metrics/1", "estimators": {"kf": 3}}',
                                  '{"schema": "sas_motion/metrics/1", "estimators": {"kf": {"position": {"rmse": "x"}}}}'])
def test_broken_metrics_keep_the_old_report(tmp_path, text):
    folder = write_sample(tmp_path)
    (tmp_path / 'metrics.json').write_text(text)
    (tmp_path / 'report.html').write_text('good')
    check_sentence(evaluate('--from', folder), 'metrics.json', 'evaluate.py')
    assert (tmp_path / 'report.html').read_text() == 'good'
    assert sorted(os.listdir(folder)) == ['metrics.json', 'report.html', 'series.json']


@pytest.mark.parametrize('text', ['{', '{"estimators": []}', '{"estimators": {"kf": {"t": [1, 2], "north": [1]}}}', '{"estimators": {"kf": {"t": ["a"]}}, "truth": 3}'])
def test_broken_series(tmp_path, text):
    folder = write_sample(tmp_path)
    (tmp_path / 'series.json').write_text(text)
    check_sentence(evaluate('--from', folder), 'series.json')


def test_runs_the_tool(tmp_path):
    sample = tmp_path / 'sample'
    sample.mkdir()
    write_sample(sample)
    bag = tmp_path / 'run.bag'
    bag.write_text('')
    done = evaluate(bag, '--tool', fake_tool(tmp_path, f'[ "$2" = -o ] && mkdir "$3" && cp "{sample}"/*.json "$3"\n'))
    assert done.returncode == 0, done.stderr
    assert 'robust_kf' in done.stdout and os.path.isfile(str(tmp_path / 'run_report' / 'report.html'))


def test_tool_fails(tmp_path):
    bag = tmp_path / 'run.bag'
    bag.write_text('')
    check_sentence(evaluate(bag, '--tool', fake_tool(tmp_path, 'echo "run.bag has no truth; record truth/odometry" >&2; exit 1\n')), 'no truth')
    check_sentence(evaluate(bag, '--tool', fake_tool(tmp_path, 'kill -SEGV $$\n')), 'signal 11')
    check_sentence(evaluate(bag, '--tool', tmp_path / 'absent'), 'absent')
