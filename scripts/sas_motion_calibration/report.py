# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""The page: sentences, tables and plots of a calibration."""
import os
from html import escape
from string import Template

from sas_motion_report import ReportError
from sas_motion_report.assets import asset, page
from sas_motion_report.report import figure, section

from .inputs import REMEDY

HERE = os.path.dirname(os.path.abspath(__file__))
NAMES = {'mounting_x': 'pitch mounting angle [°]', 'mounting_y': 'roll mounting angle [°]', 'mounting_z': 'heading mounting angle [°]',
         'lever_x': 'lever arm to starboard [m]', 'lever_y': 'lever arm forward [m]', 'lever_z': 'lever arm up [m]'}
TITLES = {'mounting_x': 'pitch [°]', 'mounting_y': 'roll [°]', 'mounting_z': 'heading [°]', 'lever_x': 'starboard [m]', 'lever_y': 'forward [m]', 'lever_z': 'up [m]'}
PLOTS = [
    ('convergence', 'Convergence', 'The chosen estimator with ±3σ, the others thin, batch as a line of dots; dashed: the truth of a simulated bag.'),
    ('residuals', 'Residuals', 'Over the estimated noise, at the final estimate. Crosses lie beyond 3σ; circles are outliers by the label of a simulated bag.'),
    ('noise', 'Estimated noise', 'Standard deviation of good readings over the one that messages state.'),
    ('track', 'Track', 'The vessel at each ping, seen from above, the transponder in the middle. Crosses: pings with a reading beyond 3σ.')]


def render(calibration):
    """Returns the page as text."""
    try:
        drawn = [name for name in calibration['order'] if 'failure' not in calibration['estimators'][name]]
        order = sorted(drawn, key=lambda name: name != calibration['answer'])
        parts = {'bag': escape(calibration['bag']), 'facts': escape(facts(calibration)), 'lead': escape(lead(calibration)), 'trust': '' if calibration['trusted'] else 'bad',
                 'more': ''.join(f'<li>{escape(sentence)}</li>' for sentence in sentences(calibration)), 'results': results(calibration, drawn),
                 'choices': ''.join(f'<option>{escape(name)}</option>' for name in order),
                 'plots': ''.join(section(f'section-{name}', title, figure(name, caption)) for name, title, caption in PLOTS)}
        data = {**calibration, 'order': drawn, 'titles': TITLES, 'duration': calibration['pings']['t'][-1]}
    except (KeyError, TypeError, ValueError, AttributeError, IndexError) as error:
        raise ReportError(f'the calibration lacks or mistypes {error}; {REMEDY}') from None
    script = asset('plotting.js') + asset('figures.js', HERE) + asset('page.js', HERE)
    return page(f'{parts["bag"]}: USBL calibration', Template(asset('body.html', HERE)).substitute(parts), data, asset('style.css'), script)


def facts(calibration):
    """Returns what was used."""
    pings = len(calibration['pings']['t'])
    return f'{calibration["array"]}, {pings} pings of {calibration["measurements"]} measurements, {calibration["mode"].replace("_", " ")}'


def lead(calibration):
    """Returns the chief sentence."""
    conclusion = calibration['conclusion']
    return conclusion[0].upper() + conclusion[1:] + '.'


def sentences(calibration):
    """Returns what else should be known."""
    found = [f'Readings left out {reason}: {number}.' for reason, number in calibration['left_out'].items()]
    found += [f'{name} had locked in and started anew (times: {e["lock_ins"]}).' for name, e in calibration['estimators'].items() if e.get('lock_ins')]
    found += [e['failure'] + '.' for e in calibration['estimators'].values() if 'failure' in e]
    found += [warning[0].upper() + warning[1:] + '.' for warning in calibration['warnings']]
    if calibration['nominal']:
        found.append('All figures are corrections of the nominal mounting that the bag holds.')
    return found


def results(calibration, drawn):
    """Returns the table of all estimators."""
    head = ''.join(f'<th>{escape(name)}{" (the answer)" if name == calibration["answer"] else ""}</th>' for name in drawn)
    truth = calibration.get('truth')
    rows = ''
    for i, unknown in enumerate(calibration['unknowns']):
        cells = ''.join(f'<td>{e["x"][i]:.4f} ± {e["sigma"][i]:.4f}</td>' for e in (calibration['estimators'][name] for name in drawn))
        rows += f'<tr><th>{NAMES[unknown]}</th>{cells}<td>{calibration["bound"][i]:.4f}</td>{f"<td>{truth[i]:.4f}</td>" if truth else ""}</tr>'
    return (f'<div class="scroll"><table><thead><tr><th></th>{head}<th>bound</th>{"<th>truth</th>" if truth else ""}</tr></thead><tbody>{rows}</tbody></table></div>'
            '<p class="note">± one standard deviation; bound: the least that any unbiased estimator can have on this track.</p>')
