# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""The statistics of the front: what the bootstrap covers, what is paired, what is counted instead of averaged."""
import json
import re
import sys

import campaign_front as front
import jsonschema
import numpy as np
import pytest

sys.path.insert(0, str(front.ROOT / 'scripts'))

from sas_motion_campaign import units  # noqa: E402
from sas_motion_campaign.bootstrap import Resampler, interval  # noqa: E402
from sas_motion_campaign.page.data import chi_square_95  # noqa: E402
from sas_motion_campaign.particles import families  # noqa: E402
from sas_motion_campaign.plan import Plan, contiguous_chunks  # noqa: E402
from sas_motion_campaign.summary import summarise  # noqa: E402
from sas_motion_campaign.table import terminal_table  # noqa: E402

ALL = np.ones(100, dtype=bool)


def plan(runs=100, estimators=('kf', 'a', 'oracle_kf')):
    """A plan of one campaign under two laws."""
    campaign = {'name': 'c', 'system': 'towfish', 'first_task': 0, 'duration': 600.0, 'skip': 20.0, 'estimators': list(estimators),
                'laws': [{'name': 'clean', 'epsilon': 0}, {'name': 'heavy', 'epsilon': 0.1}]}
    return Plan({'schema': 'sas_motion/plan/1', 'suite': 's', 'version': '1', 'config_hash': 'h', 'runs': runs, 'first_seed': 1, 'tasks': 2 * runs, 'campaigns': [campaign]})


def records(the_plan, rmse, **more):
    """Records in which an estimator's position RMSE is rmse(law, estimator, run)."""
    names = the_plan.campaigns[0]['estimators']
    return {key: {'results': {name: {'diverged': False, 'position': {'rmse': rmse(key[1], name, key[2] - 1), 'p95': 1.0, 'max': 2.0}, 'nees': {'full': 1.0}, **more}
                              for name in names}, 'cost': None} for key in the_plan.keys}


def law(summary, name='heavy'):
    """The estimators of one law."""
    return summary['campaigns']['c']['laws'][name]['estimators']


def test_a_calibration_is_compared_by_its_mounting_angles_and_with_ckf():
    # GIVEN a campaign with errors by unknown, as a calibration's
    the_plan = plan(estimators=('ckf', 'hvbckf', 'oracle_ckf'))
    wrong = {'ckf': 3.0, 'hvbckf': 1.2, 'oracle_ckf': 1.0}
    more = {'lever': {'rmse': 0.1, 'p95': 0.1, 'max': 0.1}, 'lever_x': {'rmse': 0.1, 'p95': 0.1, 'max': 0.1}}
    runs = records(the_plan, lambda _, name, run: wrong[name], **more)
    for run in runs.values():
        for result in run['results'].values():
            result['mounting'] = result.pop('position')
    summary = summarise(the_plan, runs, {})
    # THEN the mounting comes first, and ratios are to ckf and its oracle
    assert summary['campaigns']['c']['groups'] == ['mounting', 'lever', 'lever_x']
    found = law(summary)['hvbckf']['ratios']
    assert (found['ckf']['value'], found['oracle_ckf']['value'], found['best']['value']) == pytest.approx((0.4, 1.2, 1.0))
    assert 'RMSE [rad]' in terminal_table(summary, {})


def test_images_have_medians_quantiles_and_what_an_aperture_error_costs():
    # GIVEN apertures of imaging campaigns: an estimator whose loss grows with its error from run to run, another without images
    the_plan = plan(runs=10, estimators=('kf27', 'gnss_alone'))
    runs = records(the_plan, lambda *_: 1.0)
    for (_, _, seed), run in runs.items():
        error = 0.004 * seed
        run['results']['kf27']['windows'] = [{'start': 120, 'path_wavelengths': error, 'pslr_along': -100 * error, 'islr_along': 0.75 + 10 * error,
                                               'pslr_range': 0.0, 'islr_range': 0.0, 'peak_loss': 10 * error}]
        run['results']['gnss_alone']['windows'] = [{'start': 120, 'path_wavelengths': 3.0, 'pslr_along': None}]
    summary = summarise(the_plan, runs, {})
    # THEN they are summed up, signs only in the median, and the classes part by error
    image = law(summary)['kf27']['image']
    assert image['measured'] == image['windows'] == 10
    assert (image['sharp'], image['autofocus_sharp']) == (0.6, 0.0)  # ISLR at most 1 dB worse
    assert image['measures']['pslr_along'] == {'median': pytest.approx(-2.2), 'q90': pytest.approx(np.quantile(0.4 * np.arange(1, 11), 0.9))}
    assert law(summary)['gnss_alone']['image']['measured'] == 0 and law(summary)['gnss_alone']['image']['measures']['pslr_along']['median'] is None
    classes = summary['campaigns']['c']['by_aperture_error']
    assert [(found['below'], found['windows']) for found in classes] == [(1 / 128, 2), (1 / 64, 4), (1 / 32, 8), (1 / 16, 6), (None, 20)]
    assert classes[0]['measures']['peak_loss']['median'] == pytest.approx(0.04)
    text = terminal_table(summary, {})
    assert '-2.2 / 3.6' in text and 'below λ/32' in text and '0 of 10' in text
    jsonschema.validate(summary, json.loads((front.ROOT / 'docs' / 'summary.schema.json').read_text(encoding='utf-8')))


def converging(runs, times, the_plan):
    """Lets the estimator `a` converge at these times, a run each; None where it never does."""
    for (_, _, seed), run in runs.items():
        run['results']['a']['convergence'] = {'after': times[seed - 1]}
    return law(summarise(the_plan, runs, {}))


def test_runs_that_never_converged_are_counted_and_take_for_ever():
    # GIVEN ten runs: three never converge, the others after 10 to 70 s; and one of those diverges
    the_plan, times = plan(runs=10), [None, 10, 20, None, 30, 40, 50, None, 60, 70]
    found = converging(records(the_plan, lambda *_: 1.0), times, the_plan)
    assert found['a']['convergence'] == {'runs': 10, 'converged': 7, 'median': 50, 'q90': None} and 'convergence' not in found['kf']
    lost = records(the_plan, lambda *_: 1.0)
    lost['c', 'heavy', 2]['results']['a']['diverged'] = True
    assert converging(lost, times, the_plan)['a']['convergence'] == {'runs': 10, 'converged': 6, 'median': 60, 'q90': None}


def particle_campaign(particles):
    """A summary's campaign of runs with so many particles, whose errors fall with their root; heading 0.1 rad, way lost 2 %."""
    the_plan = plan(runs=4, estimators=('a', 'kf'))
    the_plan.campaigns[0]['particles'] = particles
    groups = {group: {'rmse': x, 'p95': x, 'max': x} for group, x in (('heading', 0.1), ('drift_percent', 2.0))}
    runs = records(the_plan, lambda *_: 30 / np.sqrt(particles), **groups, aperture_across=0.003, aperture_wavelengths=0.2)
    for (_, _, seed), run in runs.items():
        run['results']['a'].update(effective_size=0.6 * particles, convergence={'after': 5 if seed > 1 else None})
    return summarise(the_plan, runs, {'c': {'heavy': {'heading': {'rmse': 0.05}}}})


def test_the_table_of_errors_has_units_convergence_and_particles():
    lines = terminal_table(particle_campaign(100), {'c': {'heavy': {'a': 17.5}}}).splitlines()
    begin = lines.index('heavy: errors')
    assert re.split(r'  +', lines[begin + 1]) == ['estimator', 'position [m]', 'drift [%]', 'heading [deg]', 'aperture [mm]', 'aperture [λ]', 'NEES/n', 'converged', 'after [s]',
                                                  'particles [%]', 'us/update']
    assert re.split(r'  +', lines[begin + 2]) == ['a', '3.00', '2.00', '5.73', '3.00', '0.200', '1.00', '3 of 4', '5 / –', '60.0', '17.5']
    assert lines[begin + 3].split()[0] == 'kf' and lines[begin + 4].split()[:4] == ['bound', '-', '-', '2.86']


def test_unknowns_stand_behind_their_vector_in_its_unit():
    found = units.ordered(['lever_x', 'heading', 'mounting_y', 'mounting', 'gain', 'lever'])
    assert [units.title(group) for group in found] == ['mounting [deg]', 'mounting_y [deg]', 'heading [deg]', 'lever [m]', 'lever_x [m]', 'gain']
    assert [units.factor(group) for group in ('mounting_y', 'lever_x', 'drift_percent')] == pytest.approx([180 / np.pi, 1, 1])


def test_campaigns_that_differ_in_particles_alone_make_a_table_over_them():
    # GIVEN campaigns with 100 and 900 particles, and one with 400 that is longer
    summary = particle_campaign(900)
    summary['campaigns'] = {'many': summary['campaigns']['c'], 'few': particle_campaign(100)['campaigns']['c'], 'longer': particle_campaign(400)['campaigns']['c']}
    summary['campaigns']['longer']['duration'] = 700.0
    assert families(summary['campaigns']) == [['few', 'many']]
    lines = terminal_table(summary, {}).splitlines()
    begin = next(i for i, line in enumerate(lines) if line.startswith('few to many, heavy'))
    assert [line.split()[:3] for line in lines[begin + 3:begin + 6]] == [['a', '100', '3.00'], ['a', '900', '1.00'], []]  # kf has no particles
    jsonschema.validate(summary, json.loads((front.ROOT / 'docs' / 'summary.schema.json').read_text(encoding='utf-8')))


def test_the_interval_of_a_mean_is_that_of_the_normal_law():
    values = np.random.default_rng(3).normal(5, 2, 100)
    found = interval(*Resampler(100).means({'x': (values, ALL)})['x'])
    half = 1.96 * values.std() / 10
    assert found['value'] == pytest.approx(values.mean())
    assert [found['low'], found['high']] == pytest.approx([values.mean() - half, values.mean() + half], abs=0.1 * half)


def test_intervals_cover_the_truth_in_19_of_20_experiments():
    # GIVEN 400 experiments of 60 runs each, one resampler as for the estimators of a law
    rng, resampler = np.random.default_rng(4), Resampler(60)
    samples = rng.normal(0, 1, (400, 60))
    keep = np.ones(60, dtype=bool)
    means = resampler.means({i: (sample, keep) for i, sample in enumerate(samples)})
    # THEN mean and median are covered about as often as promised; 3 sigma of the count is 3.3 %, and the bootstrap of 60 is a little narrow
    for found in ([interval(*means[i]) for i in range(400)], [interval(*resampler.median(sample)) for sample in samples]):
        assert 0.90 < np.mean([f['low'] <= 0 <= f['high'] for f in found]) < 0.985


@pytest.mark.parametrize('n', [2, 3, 20, 61])
def test_the_median_of_resamples_has_the_drawn_law(n):
    # the short cut by beta-distributed ranks against resamples that are sorted
    rng = np.random.default_rng(5)
    values = rng.lognormal(0, 1, n)
    direct = np.median(values[rng.integers(0, n, (20000, n))], axis=1)
    median, replicates = Resampler(n).median(values)
    assert median == np.median(values)
    assert np.quantile(replicates, [0.1, 0.5, 0.9]) == pytest.approx(np.quantile(direct, [0.1, 0.5, 0.9]), rel=0.12)


def test_a_ratio_is_paired():
    # GIVEN runs that differ widely, in each of which `a` is exactly a tenth worse than kf
    weather = np.random.default_rng(6).lognormal(0, 1, 100)
    found = summarise(plan(), records(plan(), lambda _, name, run: weather[run] * (1.1 if name == 'a' else 1.0)), {})
    # THEN the ratio is sharp where the errors themselves are vague
    ratio = law(found)['a']['ratios']['kf']
    assert ratio['value'] == pytest.approx(1.1) and (ratio['low'] is None or ratio['high'] - ratio['low'] < 1e-6)
    rms = law(found)['a']['errors']['position']['rms']
    assert rms['high'] > 1.2 * rms['low']


def test_diverged_runs_are_counted_and_left_out_of_both_sides():
    # GIVEN an estimator that is lost in 3 runs: far, not finite, and by its own word
    def rmse(name_of_law, name, run):
        lost = name == 'a' and name_of_law == 'heavy' and run in (0, 1)
        return (None if run else 51.0) if lost else 10.0 if run < 3 else 1.0
    given = records(plan(), rmse)
    given['c', 'heavy', 3]['results']['a']['diverged'] = True
    found = law(summarise(plan(), given, {}))
    assert found['a']['diverged'] == 3 and found['kf']['diverged'] == 0
    assert found['a']['errors']['position']['rms']['value'] == pytest.approx(1.0)
    assert found['a']['ratios']['kf']['value'] == pytest.approx(1.0)  # kf's worst runs are left out there too
    assert found['kf']['errors']['position']['rms']['value'] == pytest.approx(np.sqrt((97 + 300) / 100))


def test_nothing_left_is_null_and_no_error():
    given = records(plan(runs=4), lambda name_of_law, name, _: None if name == 'a' else 1.0, locked_out=True)
    found = law(summarise(plan(runs=4), given, {'c': {'heavy': None}}))
    assert found['a']['diverged'] == 4 and found['a']['errors']['position']['rms']['value'] is None
    assert 'kf' not in found['a']['ratios'] and found['kf']['ratios']['bound'] is None and found['kf']['locked_out'] == 4


def test_a_single_run_has_no_interval():
    found = law(summarise(plan(runs=1), records(plan(runs=1), lambda *_: 1.0), {}))
    assert found['kf']['errors']['position']['rms'] == {'value': 1.0, 'low': None, 'high': None}


def test_the_bound_is_the_reference_of_every_group():
    found = law(summarise(plan(), records(plan(), lambda *_: 1.2, heading={'rmse': 0.3, 'p95': 0.4, 'max': 0.5}),
                          {'c': {'heavy': {'position': {'rmse': 1.0}, 'heading': {'rmse': 0.2}}}}))
    assert found['a']['ratios']['bound']['value'] == pytest.approx(1.2)
    assert found['a']['errors']['heading']['to_bound']['value'] == pytest.approx(1.5)


def test_the_best_is_never_one_that_was_told():
    found = law(summarise(plan(), records(plan(), lambda _, name, run: {'kf': 2.0, 'a': 1.5, 'oracle_kf': 1.0}[name]), {}))
    assert [found[name]['ratios']['best']['value'] for name in ('kf', 'a')] == pytest.approx([4 / 3, 1.0])


def test_summary_obeys_its_schema(tmp_path):
    jsonschema = pytest.importorskip('jsonschema')
    front.succeed(tmp_path, 'out')
    schema = json.loads((front.ROOT / 'docs' / 'summary.schema.json').read_text())
    jsonschema.Draft7Validator.check_schema(schema)
    jsonschema.validate(json.loads((tmp_path / 'out' / 'summary.json').read_text()), schema)


def test_chunks_cover_what_is_missing():
    assert contiguous_chunks([0, 1, 2, 5, 6, 9], 2) == [(0, 2), (2, 3), (5, 7), (9, 10)]
    assert contiguous_chunks([], 2) == []


@pytest.mark.parametrize('degrees, expected', [(2, (0.0506, 7.378)), (10, (3.247, 20.483)), (600, (534.02, 669.77))])
def test_chi_square_bands(degrees, expected):
    assert chi_square_95(degrees) == pytest.approx(expected, rel=1e-2)
