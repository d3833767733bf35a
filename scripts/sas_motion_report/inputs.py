# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""Reading metrics.json and series.json (docs/metrics.schema.json describes the former)."""
import json
import math

from . import ReportError

SCHEMA = 'sas_motion/metrics/1'
SENSORS = ('position', 'heading', 'speed', 'gps', 'dvl', 'depth')
REMEDY = 'run evaluate.py on the bag again'


def read_json(path):
    """Returns the object in a JSON file, numbers that are not finite as None."""
    try:
        with open(path, encoding='utf-8') as file:
            tree = json.load(file, parse_constant=lambda _: None)
    except OSError as error:
        raise ReportError(f'{path} cannot be read ({error.strerror}); {REMEDY}') from None
    except ValueError:
        raise ReportError(f'{path} is not valid JSON, perhaps cut short; {REMEDY}') from None
    if not isinstance(tree, dict):
        raise ReportError(f'{path} holds no JSON object; {REMEDY}')
    return tree


def read_metrics(path):
    """Returns the checked content of metrics.json."""
    metrics = read_json(path)
    if metrics.get('schema') != SCHEMA:
        raise ReportError(f'{path} has schema {metrics.get("schema")!r} instead of {SCHEMA!r}; {REMEDY} with tools of one version')
    check_object(metrics, 'estimators', path)
    if not metrics['estimators']:
        raise ReportError(f'{path} scores no estimator; record estimates in the bag and run evaluate.py again')
    for name in metrics['estimators']:
        check_object(metrics['estimators'], name, path)
        check_measures(metrics['estimators'][name], name, path)
    return metrics


def check_measures(tree, where, path):
    """Throws unless every leaf below is a number, a flag, a text or nothing."""
    for key, value in tree.items():
        if isinstance(value, dict):
            check_measures(value, f'{where}.{key}', path)
        elif key == 'outages' and isinstance(value, list) and all(isinstance(outage, dict) for outage in value):
            continue
        elif value is not None and not isinstance(value, (bool, int, float)):
            raise ReportError(f'{path} has {where}.{key} = {value!r} where a number belongs; {REMEDY}')


def read_series(path):
    """Returns the checked content of series.json."""
    series = read_json(path)
    check_object(series, 'estimators', path)
    for part in (series.get('truth'), series.get('fixes'), *series['estimators'].values()):
        check_columns(part or {}, path)
    for estimator in series['estimators'].values():
        for update in (estimator.get('updates') or {}).values():
            check_columns(update, path)
    return series


def check_columns(part, path):
    """Throws unless the lists of a series are as long as its time stamps, or empty."""
    if not isinstance(part, dict):
        raise ReportError(f'{path} holds {type(part).__name__} where a series belongs; {REMEDY}')
    lengths = {len(column) for column in part.values() if isinstance(column, list) and column}
    if len(lengths) > 1:
        raise ReportError(f'{path} has columns of different lengths {sorted(lengths)}; {REMEDY}')


def check_object(tree, key, path):
    """Throws unless tree[key] is a JSON object."""
    if not isinstance(tree.get(key), dict):
        raise ReportError(f'{path} has no object {key!r}; {REMEDY}')


def dig(tree, *keys):
    """Returns tree[k1][k2]..., or None where a key is missing."""
    for key in keys:
        if not isinstance(tree, dict):
            return None
        tree = tree.get(key)
    return tree


def finite(value):
    """Tells whether the value is a number to compute with."""
    return isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)


def ranked(metrics):
    """Returns (name, estimator) pairs, least position RMSE first, the diverged last."""
    def order(pair):
        rmse = dig(pair[1], 'position', 'rmse')
        return bool(pair[1].get('diverged')), rmse if finite(rmse) else math.inf, pair[0]
    return sorted(metrics['estimators'].items(), key=order)
