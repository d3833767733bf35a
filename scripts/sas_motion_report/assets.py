# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""What a page carries within itself: its style, its scripts, plotly.js, its data."""
import base64
import gzip
import json
import os
from string import Template

from . import ReportError


def asset(name, folder=os.path.dirname(os.path.abspath(__file__))):
    """Returns the text of a file beside this one, or of another folder."""
    with open(os.path.join(folder, name), encoding='utf-8') as file:
        return file.read()


def page(title, body, data, style, script):
    """Returns the page of a report: what is shown, and the data, style and script that it carries beside plotly.js."""
    return Template(asset('frame.html')).substitute(title=title, body=body, data=data_text(data), style=style, script=script, plotly=packed_plotly())


def data_text(data):
    """Returns data as JSON that can stand in a script element."""
    return json.dumps(data, allow_nan=False, separators=(',', ':')).replace('<', '\\u003c')


def packed(text):
    """Returns a text compressed as base64; the page unpacks it."""
    return base64.b64encode(gzip.compress(text.encode('utf-8'), 9, mtime=0)).decode('ascii')


def packed_plotly():
    """Returns plotly.js, packed to a quarter of its 9 MB."""
    try:
        from plotly.offline import get_plotlyjs
        source = get_plotlyjs()
    except (ImportError, OSError):
        raise ReportError('plotly is not installed, so report.html cannot be written; run scripts/setup.sh or install python3-plotly') from None
    return packed(source)
