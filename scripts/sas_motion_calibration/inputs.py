# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""Reading calibration.json."""
import json

from sas_motion_report import ReportError

SCHEMA = 'sas_motion/calibration/1'
REMEDY = 'run calibrate_usbl on the bag again'


def read_calibration(path):
    """Returns the checked content of calibration.json."""
    try:
        with open(path, encoding='utf-8') as file:
            tree = json.load(file)
    except OSError as error:
        raise ReportError(f'{path} cannot be read ({error.strerror}); {REMEDY}') from None
    except ValueError:
        raise ReportError(f'{path} is not valid JSON, perhaps cut short; give the .json beside the calibration, or {REMEDY}') from None
    schema = tree.get('schema') if isinstance(tree, dict) else None
    if schema != SCHEMA:
        raise ReportError(f'{path} has schema {schema!r} instead of {SCHEMA!r}; {REMEDY} with tools of one version')
    return tree
