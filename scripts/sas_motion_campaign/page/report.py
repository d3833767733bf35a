# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""report.html of a campaign: one file that opens without a network."""
import os
from html import escape
from string import Template

from sas_motion_report import ReportError
from sas_motion_report.assets import asset, data_text, packed, page
from sas_motion_report.columns import quantity
from sas_motion_report.files import write_atomically
from sas_motion_report.report import figure, section

from .data import page_data, trace_data
from .sentences import sentences
from .tables import campaign_tables, particle_tables

HERE = os.path.dirname(os.path.abspath(__file__))
OVER_LAWS = [
    ('contamination', 'Accuracy against contamination', 'RMS error with 95 % intervals; dashed: the Cramér-Rao bound; black: bayes_reference. Laws with the same share of '
     'outliers, or without one, stand side by side.'),
    ('ranking', 'Ranking', 'RMS error under the chosen law with 95 % intervals, the best on top; dashed: the bound.'),
    ('cost', 'Accuracy against cost', 'Under the chosen law. Lower left is better: less computing, less error.'),
    ('particles', 'Particles against accuracy and cost', 'Under the chosen law, campaigns that differ in the number of particles alone: RMS error with 95 % intervals, and computing.'),
    ('nees', 'NEES over its degrees', 'Under the chosen law, 1 expected, with 95 % intervals. Right of the band the stated uncertainty is too small, left of it too large.'),
    ('failures', 'Divergences and lock-outs', 'Runs that failed under the chosen law.')]
OF_A_RUN = [
    ('errors', 'Errors of a run', 'Errors of the chosen estimator, first seed, and 3σ of its covariance; the others thin beside it. The frame is that of the scored time.'),
    ('effective', 'Effective particles of a run', 'Effective sample size of the chosen estimator; dotted: half the particles, below which it resamples.'),
    ('consistency', 'NEES and NIS of a run', 'Of a consistent filter 95 % lie in the band.'),
    ('weights', 'Weights against labels', 'The weight that the estimator gave each measurement; crosses are the outliers by their labels.')]


def write_report(path, summary, costs, trace):
    """Writes the page."""
    write_atomically(path, render(summary, costs, trace))


def render(summary, costs, trace):
    """Returns the page as text."""
    try:
        data = page_data(summary, costs)
        panels = [panel(name, campaign, costs.get(name, {}), i, particle_tables(summary['campaigns'], costs, name, f'c{i}'))
                  for i, (name, campaign) in enumerate(summary['campaigns'].items())]
        parts = {'suite': escape(summary['suite']), 'facts': escape(facts(summary)), 'panels': ''.join(panels),
                 'tabs': ''.join(tab(name, i) for i, name in enumerate(summary['campaigns'])),
                 'over_laws': plots(OVER_LAWS), 'of_a_run': plots(OF_A_RUN), 'traces': packed(data_text(trace_data(trace)))}
        body = Template(asset('body.html', HERE)).substitute(parts)
        script = asset('plotting.js') + ''.join(asset(name, HERE) for name in ('law_plots.js', 'run_plots.js', 'tabs.js', 'page.js'))
        return page(f'{parts["suite"]}: estimators against what is possible', body, data, asset('style.css') + asset('campaign.css', HERE), script)
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise ReportError(f'report.html cannot be written: what run_campaign printed lacks or mistypes {error}; build it and benchmark from the same source') from None


def facts(summary):
    """Returns what was run."""
    last = summary['first_seed'] + summary['runs'] - 1
    return f'{summary["runs"]} runs a law, seeds {summary["first_seed"]} to {last}; version {summary["version"]}, configuration {summary["config_hash"]}'


def tab(name, i):
    """Returns the tab of a campaign."""
    chosen = 'true' if i == 0 else 'false'
    return (f'<button type="button" role="tab" id="tab-{i}" aria-controls="panel-{i}" aria-selected="{chosen}" tabindex="{0 if i == 0 else -1}" '
            f'data-campaign="{escape(name)}">{escape(name)}</button>')


def panel(name, campaign, costs, i, further):
    """Returns sentences and tables of a campaign, `further` tables behind; all panels show on paper and without JavaScript."""
    about = f'{campaign["system"]}, {quantity(campaign["duration"])} s a run, the first {quantity(campaign["skip"])} s not scored'
    chief, *others = map(escape, sentences(campaign, costs))
    points = ''.join(f'<li>{sentence}</li>' for sentence in others)
    return (f'<section class="panel" role="tabpanel" id="panel-{i}" aria-labelledby="tab-{i}"><h2>{escape(name)}</h2><p class="facts">{escape(about)}</p>'
            f'<p class="lead">{chief}</p><ul class="points">{points}</ul>{campaign_tables(campaign, costs, f"c{i}")}{further}</section>')


def plots(figures):
    """Returns the places of plots."""
    return ''.join(section(f'section-{name}', title, figure(name, caption)) for name, title, caption in figures)
