# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""The HTML report: one file that opens without a network."""
from html import escape
from string import Template

from . import ReportError, tables
from .assets import asset, page
from .columns import quantity
from .figures import figure_data
from .headline import headline
from .images import images

FIGURES = [
    ('track', 'Track', 'Truth, every estimator, the GNSS fixes, and what the chosen estimator made of them. Far outliers may lie beyond the edge; double-click to see all.'),
    ('errors', 'Errors', 'Estimate minus truth, and ±3σ of the stated covariance. Shaded: not scored, or without a position fix.'),
    ('weights', 'Weights', 'The weight that the estimator gave each measurement; below one half it counts as set aside.'),
    ('nis', 'Normalised innovations squared', 'Of a consistent filter 95 % lie in the band.'),
]

PARTICLES = 'The effective number of particles, 1 / Σw², before any resampling: how many share the weight.'


def render(metrics, series, focus=None):
    """Returns the page as text; `focus` is what read_focus() returns."""
    try:
        data = figure_data(metrics, series)
        parts = {**texts(metrics), **sections(metrics, data, focus)}
        script = asset('plotting.js') + asset('figures.js') + asset('page.js')
        return page(f'{parts["bag"]}: motion estimates against truth', Template(asset('body.html')).substitute(parts), data, asset('style.css'), script)
    except (KeyError, TypeError, ValueError, AttributeError, IndexError) as error:
        raise ReportError(f'metrics.json, series.json or focus.json has not the form of its schema in docs ({error}); run evaluate.py, or focus, on the bag again') from None


def texts(metrics):
    """Returns title, facts and headline."""
    facts = [f'{quantity(metrics.get("duration"))} s', f'{quantity(metrics.get("distance"))} m', f'truth: {metrics.get("truth", "unknown")}',
             f'the first {quantity(metrics.get("skipped"), "0")} s are not scored']
    first, *others = headline(metrics)
    more = ''.join(f'<li>{escape(sentence)}</li>' for sentence in others)
    return {'bag': escape(str(metrics.get('bag', 'bag'))), 'facts': escape(', '.join(facts)), 'lead': escape(first), 'more': f'<ul>{more}</ul>' if more else ''}


def sections(metrics, data, focus):
    """Returns the tables and plots of the page."""
    after = [('particles', 'Particles', figure('particles', PARTICLES) if data['particles'] else ''),
             ('consistency', 'Consistency', tables.consistency(metrics)),
             ('measurements', 'Outliers and verdicts', tables.outliers(metrics) + tables.verdicts(metrics)),
             ('cost', 'Cost against accuracy', figure('cost', 'Lower left is better: less computing, less error.') if data['cost'] else ''),
             ('outages', 'Outages', tables.outages(metrics)),
             ('images', 'Images', images(*focus) if focus else '')]
    return {'results': tables.results(metrics), 'choices': ''.join(f'<option>{escape(name)}</option>' for name in data['order']),
            'plots': ''.join(section(f'section-{name}', title, figure(name, caption)) for name, title, caption in FIGURES),
            'after': ''.join(section(f'section-{name}', title, body) for name, title, body in after if body)}


def figure(name, caption):
    """Returns a plot's place in the page."""
    return f'<figure><div class="plot" id="plot-{name}"></div><figcaption>{caption}<span id="note-{name}"></span></figcaption></figure>'


def section(name, title, body):
    """Returns a titled part of the page."""
    return f'<section id="{name}"><h2>{title}</h2>{body}</section>'
