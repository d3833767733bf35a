// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
// Plots of one run: the first seed under the chosen law, as the chosen estimator saw it. view.trace is missing where nothing was recorded.
const has = (view, key) => view.trace && finiteOnly(view.trace[key] || []).length > 0;
const last = list => list.length ? list[list.length - 1] : 0;

function errorsFigure(view) {
  if (!has(view, 'error')) return {traces: [], layout: {}};
  const {trace, theme} = view;
  const bound = trace.sigma3 || [];
  const reach = 1.25 * Math.max(quantile(trace.error.map(v => v === null ? NaN : Math.abs(v)), 0.995) || 0, quantile(bound, 0.9) || 0);
  const edge = {x: trace.time, mode: 'lines', line: {width: 0}, hoverinfo: 'skip'};
  const band = bound.length ? [{...edge, y: bound.map(b => b === null ? null : -b)}, {...edge, y: bound, fill: 'tonexty', fillcolor: theme.shade}] : [];
  const line = {name: view.estimator, x: trace.time, y: trace.error, mode: 'lines', line: {color: look(view, view.estimator).color, width: 1.3}, hovertemplate: '%{x:.1f} s: %{y:.4g}'};
  const range = reach > 0 ? [-reach, reach] : undefined;
  return stackedFigure({duration: last(trace.time)}, theme, [[`error${UNITS[view.campaign.group] || ''}`, [...band, line], {range, uirevision: view.key}]], []);
}

function consistencyFigure(view) {
  const {trace, theme} = view;
  const kinds = ['nees', 'nis'].filter(kind => has(view, kind));
  const rows = kinds.map(kind => {
    const y = trace[kind];
    const x = [trace.time, trace.weight_time].find(t => t && t.length === y.length) || y.map((_, i) => i * last(trace.time) / Math.max(1, y.length - 1));
    const top = Math.max(30, ...finiteOnly(y));
    const points = {name: view.estimator, x, y, mode: 'markers', marker: {color: look(view, view.estimator).color, size: 4, opacity: 0.6}, hovertemplate: '%{x:.1f} s: %{y:.3g}'};
    return [kind.toUpperCase(), [points], {type: 'log', range: [-2, Math.log10(top) + 0.3], tickvals: [0.01, 1, 100, 1e4, 1e6], ticktext: ['0.01', '1', '100', '10⁴', '10⁶'], uirevision: view.key}];
  });
  const bands = kinds.flatMap((kind, i) => trace[`${kind}_band`] ? [{type: 'rect', xref: 'paper', x0: 0, x1: 1, yref: `y${i ? i + 1 : ''}`,
    y0: trace[`${kind}_band`][0], y1: trace[`${kind}_band`][1], fillcolor: theme.shade, line: {width: 0}, layer: 'below'}] : []);
  return kinds.length ? stackedFigure({duration: last(trace.time)}, theme, rows, bands) : {traces: [], layout: {}};
}

function weightsFigure(view) {
  if (!has(view, 'weight')) return {traces: [], layout: {}};
  const {trace, theme} = view;
  const labels = trace.outlier || [];
  const mark = (bad, color, symbol) => ({x: pick(trace.weight_time, i => !!labels[i] === bad), y: pick(trace.weight, i => !!labels[i] === bad), mode: 'markers',
    name: bad ? 'outlier' : 'good', marker: {color, symbol, size: bad ? 7 : 4, opacity: bad ? 0.9 : 0.55, line: {color, width: bad ? 1.5 : 0}}, hovertemplate: '%{x:.1f} s: %{y:.3g}'});
  const half = {type: 'line', xref: 'paper', x0: 0, x1: 1, y0: 0.5, y1: 0.5, line: {color: theme.soft, width: 1, dash: 'dot'}};
  const rows = [['weight', [mark(false, look(view, view.estimator).color, 'circle'), mark(true, theme.bad, 'x-thin')], {tickvals: [0, 0.5, 1], rangemode: 'tozero'}]];
  return stackedFigure({duration: last(trace.weight_time)}, theme, rows, [half]);
}
