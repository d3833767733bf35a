// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
// Each function returns {traces, layout} of one plot for the chosen estimator; times in seconds, lengths in metres.
const SENSORS = ['position', 'heading', 'speed', 'gps', 'dvl', 'depth'];
const ERRORS = [['north', 'north [m]'], ['east', 'east [m]'], ['up', 'up [m]'], ['heading_deg', 'heading [°]']];

const colour = (data, theme, name) => theme.colours[data.order.indexOf(name) % theme.colours.length];

function trackFigure(data, chosen, theme) {
  const line = (name, s, look) => ({name, x: s.east, y: s.north, mode: 'lines', line: look, hovertemplate: '%{x:.2f} m east<br>%{y:.2f} m north'});
  const fates = data.estimators[chosen].fates;
  const points = (name, fate, marker) => ({name, x: pick(data.fixes.east, i => fates[i] === fate), y: pick(data.fixes.north, i => fates[i] === fate),
    mode: 'markers', marker, hovertemplate: '%{x:.2f} m east<br>%{y:.2f} m north'});
  const chosenLast = [...data.order.filter(name => name !== chosen), chosen];
  const tracks = chosenLast.map(name => line(name, data.estimators[name], {color: colour(data, theme, name), width: name === chosen ? 2.5 : 1.2}));
  const traces = [
    points('GNSS fix', 0, {color: theme.soft, size: 4, opacity: 0.5}),
    ...tracks, line('truth', data.truth, {color: theme.ink, width: 1.5, dash: '4px,4px'}),
    points('outlier kept', 2, {color: theme.warn, size: 9, symbol: 'diamond-open', line: {width: 2}}),
    points('fix set aside', 1, {color: theme.bad, size: 8, symbol: 'x-thin', line: {width: 2, color: theme.bad}}),
  ].filter(trace => trace.x && trace.x.length);
  const view = trackView(data);
  return {traces, layout: frame(theme, theme.narrow ? 460 : 560, {
    xaxis: axis(theme, {title: 'east [m]', range: view.east}),
    yaxis: axis(theme, {title: 'north [m]', range: view.north, scaleanchor: 'x', scaleratio: 1})})};
}

/** The span of truth, or of the estimators that did not diverge, with a margin: far outliers must not shrink the track. */
function trackView(data) {
  const sane = data.order.filter(name => !data.diverged.includes(name)).map(name => data.estimators[name]);
  const sources = (data.truth.east || []).length ? [data.truth] : sane;
  const bounds = ['east', 'north'].map(key => {
    const all = sources.flatMap(s => finiteOnly(s[key] || []));
    return all.reduce(([low, high], v) => [Math.min(low, v), Math.max(high, v)], [Infinity, -Infinity]);
  });
  const margin = 0.1 * Math.max(...bounds.map(([low, high]) => high - low)) + 1;
  const [east, north] = bounds.map(([low, high]) => Number.isFinite(low) ? [low - margin, high + margin] : undefined);
  return {east, north};
}

function timeShades(data, theme) {
  const spans = data.skipped > 0 ? [[0, data.skipped], ...data.outages] : data.outages;
  return spans.map(([x0, x1]) => ({type: 'rect', xref: 'x', yref: 'paper', x0, x1, y0: 0, y1: 1, fillcolor: theme.shade, line: {width: 0}, layer: 'below'}));
}

function errorFigure(data, chosen, theme) {
  const series = data.estimators[chosen];
  const rows = ERRORS.filter(([key]) => (series[`error_${key}`] || []).length).map(([key, title]) => {
    const error = series[`error_${key}`];
    const bound = (series[`sigma_${key}`] || []).map(s => s === null ? null : 3 * s);
    const scored = (_, i) => series.t[i] >= data.skipped;
    const reach = 1.25 * Math.max(quantile(error.filter(scored).map(v => v === null ? NaN : Math.abs(v)), 0.995) || 0, quantile(bound.filter(scored), 0.9) || 0);
    const edge = {x: series.t, mode: 'lines', line: {width: 0}, hoverinfo: 'skip'};
    const band = bound.length ? [{...edge, y: bound.map(b => b === null ? null : -b)}, {...edge, y: bound, fill: 'tonexty', fillcolor: theme.shade}] : [];
    const line = {name: chosen, x: series.t, y: error, mode: 'lines', line: {color: colour(data, theme, chosen), width: 1.3}, hovertemplate: '%{x:.1f} s: %{y:.4g}'};
    return [title, [...band, line], {uirevision: chosen, range: reach > 0 ? [-reach, reach] : undefined}];
  });
  return stackedFigure(data, theme, rows, timeShades(data, theme));
}

function updateTraces(data, chosen, theme, updates, key, isBad) {
  const mark = (bad, color, symbol) => ({name: chosen, x: pick(updates.t, i => isBad(i) === bad), y: pick(updates[key], i => isBad(i) === bad), mode: 'markers',
    marker: {color, size: bad ? 6 : 4, opacity: bad ? 0.9 : 0.55, symbol, line: {color, width: bad ? 1.5 : 0}}, hovertemplate: '%{x:.1f} s: %{y:.3g}'});
  return [mark(false, colour(data, theme, chosen), 'circle'), mark(true, theme.bad, 'x-thin')];
}

const sensorsWith = (data, chosen, key) => SENSORS.filter(s => finiteOnly((data.estimators[chosen].updates[s] || {})[key] || []).length);

function weightFigure(data, chosen, theme) {
  const rows = sensorsWith(data, chosen, 'weight').map(sensor => {
    const updates = data.estimators[chosen].updates[sensor];
    return [sensor, updateTraces(data, chosen, theme, updates, 'weight', i => updates.weight[i] < 0.5), {range: [-0.06, 1.06], tickvals: [0, 0.5, 1]}];
  });
  const half = (_, i) => ({type: 'line', xref: 'paper', x0: 0, x1: 1, yref: `y${i ? i + 1 : ''}`, y0: 0.5, y1: 0.5, line: {color: theme.soft, width: 1, dash: 'dot'}});
  return stackedFigure(data, theme, rows, rows.map(half));
}

function nisFigure(data, chosen, theme) {
  const sensors = sensorsWith(data, chosen, 'nis');
  const rows = sensors.map(sensor => {
    const updates = data.estimators[chosen].updates[sensor];
    const top = Math.max(30, ...finiteOnly(updates.nis));
    return [sensor, updateTraces(data, chosen, theme, updates, 'nis', i => updates.nis[i] > data.bands[sensor][1]),
      {type: 'log', range: [-3, Math.log10(top) + 0.3], tickvals: [0.01, 1, 100, 1e4, 1e6], ticktext: ['0.01', '1', '100', '10⁴', '10⁶'], uirevision: chosen}];
  });
  const band = (sensor, i) => ({type: 'rect', xref: 'paper', x0: 0, x1: 1, yref: `y${i ? i + 1 : ''}`, y0: data.bands[sensor][0], y1: data.bands[sensor][1],
    fillcolor: theme.shade, line: {width: 0}, layer: 'below'});
  return stackedFigure(data, theme, rows, sensors.map(band));
}

function particleFigure(data, chosen, theme) {
  const {dvl = {}} = data.estimators[chosen].updates;
  const sizes = dvl.effective_size || [];
  if (!sizes.some(size => size > 0)) return {traces: []};
  const line = {name: chosen, x: dvl.t, y: sizes, mode: 'lines', line: {color: colour(data, theme, chosen), width: 1.3}, hovertemplate: '%{x:.1f} s: %{y:.4g}'};
  return stackedFigure(data, theme, [['effective number', [line], {rangemode: 'tozero'}]], timeShades(data, theme));
}

function costFigure(data, chosen, theme) {
  const [names, cost, error] = [0, 1, 2].map(k => data.cost.map(point => point[k]));
  const marker = {size: names.map(n => n === chosen ? 14 : 10), color: names.map(n => colour(data, theme, n))};
  const trace = {x: cost, y: error, text: names, mode: 'markers+text', textposition: names.map((_, i) => i % 2 ? 'bottom center' : 'top center'),
    marker, hovertemplate: '%{text}<br>%{x:.3g} µs an update<br>%{y:.3g} m', name: '', cliponaxis: false};
  const span = list => [Math.log10(Math.min(...list)) - 0.35, Math.log10(Math.max(...list)) + 0.35];
  const log = (title, list) => axis(theme, {title, type: 'log', range: span(list), tickvals: [1, 2, 5].flatMap(m => [-4, -3, -2, -1, 0, 1, 2, 3, 4, 5, 6].map(p => m * 10 ** p))});
  return {traces: [trace], layout: frame(theme, theme.narrow ? 340 : 400, {showlegend: false,
    xaxis: log('computing [µs/update]', cost), yaxis: log('position RMSE [m]', error)})};
}
