# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""What `focus` made of each trajectory: its measures (docs/focus.schema.json) and its figure, for the page."""
import base64
import os
from html import escape

from . import ReportError
from .columns import number
from .inputs import check_object, dig, read_json
from .tables import table

SCHEMA = 'sas_motion/focus/1'
# title, unit, where the value is
COLUMNS = (('aperture error', 'λ', ('aperture_error', 'path_wavelengths')), ('width along', 'm', ('along', 'irw')), ('PSLR', 'dB', ('along', 'pslr')),
           ('ISLR', 'dB', ('along', 'islr')), ('width in range', 'm', ('range', 'irw')), ('PSLR', 'dB', ('range', 'pslr')), ('ISLR', 'dB', ('range', 'islr')),
           ('peak loss', 'dB', ('peak_loss',)), ('moved', 'm', ('peak_error',)), ('entropy', 'nat', ('entropy',)))


def read_focus(folder):
    """Returns the checked content of a folder's focus.json, and the bytes of focus.png or None."""
    path = os.path.join(folder, 'focus.json')
    focus = read_json(path)
    if focus.get('schema') != SCHEMA:
        raise ReportError(f'{path} has schema {focus.get("schema")!r} instead of {SCHEMA!r}; run focus on the bag again')
    check_object(focus, 'trajectories', path)
    try:
        with open(os.path.join(folder, 'focus.png'), 'rb') as file:
            return focus, file.read()
    except FileNotFoundError:
        return focus, None
    except OSError as error:
        raise ReportError(f'{folder}/focus.png cannot be read ({error.strerror})') from None


def images(focus, figure):
    """Returns the table of the first target, and the figure."""
    rows = []
    for name in focus['order']:
        trajectory = focus['trajectories'][name]
        rows.append(row('error-free' if name == 'truth' else name, trajectory, trajectory))
        if 'autofocused' in trajectory:
            rows.append(row('– autofocused', trajectory['autofocused'], {}))
    window = focus['window']
    caption = (f'What a sonar would see with each estimate: a point at {number(focus["targets"][0]["range"])} m, an aperture of {number(window["length"])} m from '
               f'{number(window["start"])} s, λ = {number(1e3 * focus["wavelength"])} mm. Aperture error: RMS of the paths without mean and trend.')
    drawn = f'<figure><img alt="Images beside each other and cuts through their peaks" src="data:image/png;base64,{base64.b64encode(figure).decode()}"></figure>' if figure else ''
    return table(caption, ['trajectory', *(f'{title}<br><small>{unit}</small>' for title, unit, _ in COLUMNS)], rows, 'images') + drawn


def row(name, image, trajectory):
    """Returns the cells of one image; its aperture error is that of the trajectory."""
    values = {**image['targets'][0], 'entropy': image['entropy'], 'aperture_error': trajectory.get('aperture_error')}
    return [escape(name), *(number(dig(values, *path)) for _, _, path in COLUMNS)]
