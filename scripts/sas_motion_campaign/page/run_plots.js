// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
// Plots of one run: the first seed under the chosen law, as the chosen estimator saw it. view.trace is missing where nothing was recorded.
const has = (view, key) => view.trace && finiteOnly(view.trace[key] || []).length > 0;
const last = list => list.length ? list[list.length - 1] : 0;

/** A row of errorsFigure: the chosen estimator's error with its band, the others thin behind it. The frame is that of the scored time. */
function errorRow(view, title, of) {
  const {trace, theme, campaign} = view;
  const {error, sigma3} = of(trace);
  const scored = list => (list || []).filter((v, i) => v !== null && trace.time[i] >= campaign.skip);
  const reach = 1.25 * Math.max(quantile(scored(error).map(Math.abs), 0.995) || 0, quantile(scored(sigma3), 0.9) || 0);
  const signed = error.some(v => v < 0);
  const stated = i => Number.isFinite((sigma3 || [])[i]);  // some estimators state it at readings alone, and a fill does not span gaps
  const upper = pick(sigma3, stated);
  const edge = {x: pick(trace.time, stated), mode: 'lines', line: {width: 0}, hoverinfo: 'skip'};
  const band = upper.length ? [{...edge, y: upper.map(b => signed ? -b : 0)}, {...edge, y: upper, fill: 'tonexty', fillcolor: theme.shade}] : [];
  const line = (name, seen, width, opacity) => ({name, x: view.traces[name].time, y: seen.error, mode: 'lines', opacity, line: {color: look(view, name).color, width},
    hovertemplate: '%{x:.1f} s: %{y:.4g}'});
  const others = campaign.estimators.filter(name => name !== view.estimator && view.traces[name] && of(view.traces[name])).map(name => line(name, of(view.traces[name]), 0.8, 0.5));
  const range = reach > 0 ? [signed ? -reach : 0, reach] : undefined;
  return [title, [...band, ...others, line(view.estimator, of(trace), 1.5, 1)], {range, uirevision: view.key}];
}

function errorsFigure(view) {
  if (!has(view, 'error')) return {traces: [], layout: {}};
  const {trace, theme, campaign} = view;
  const named = title => seen => (seen.others || []).find(other => other.title === title);
  const rows = [errorRow(view, `${campaign.group}${UNITS[campaign.group] || ''}`, seen => seen.error && seen.error.length ? seen : undefined),
    ...(trace.others || []).map(other => errorRow(view, other.title, named(other.title)))];
  return stackedFigure({duration: last(trace.time)}, theme, rows, []);
}

function effectiveFigure(view) {
  if (!has(view, 'effective_size')) return {traces: [], layout: {}};
  const {trace, theme, campaign} = view;
  const line = {name: view.estimator, x: trace.effective_time, y: trace.effective_size, mode: 'lines', line: {color: look(view, view.estimator).color, width: 1.3},
    hovertemplate: '%{x:.1f} s: %{y:.4g}'};
  const half = campaign.particles ? [{type: 'line', xref: 'paper', x0: 0, x1: 1, y0: campaign.particles / 2, y1: campaign.particles / 2,
    line: {color: theme.soft, width: 1.5, dash: 'dot'}}] : [];
  return stackedFigure({duration: last(trace.effective_time)}, theme, [['effective particles', [line], {range: [0, 1.05 * (campaign.particles || Math.max(...trace.effective_size))]}]], half);
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
