// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
// Plots over all runs. Each function takes a view {campaign, family, law, estimator, traces, trace, theme} and returns {traces, layout}.
const REFERENCE = 'bayes_reference';
const SYMBOLS = ['circle', 'square', 'diamond', 'triangle-up', 'x'];
const EXPONENTS = [-6, -5, -4, -3, -2, -1, 0, 1, 2, 3, 4, 5];

/** The look of an estimator: a colour, and another symbol when the colours begin again. */
function look(view, name) {
  const i = view.campaign.estimators.indexOf(name);
  const n = view.theme.colours.length;
  return {color: name === REFERENCE ? view.theme.ink : view.theme.colours[i % n], symbol: SYMBOLS[Math.floor(i / n) % SYMBOLS.length]};
}

const bars = triples => ({type: 'data', symmetric: false, thickness: 1.2, width: 3,
  array: triples.map(t => t && t[2] !== null ? t[2] - t[0] : 0), arrayminus: triples.map(t => t && t[1] !== null ? t[0] - t[1] : 0)});
const values = triples => triples.map(t => t ? t[0] : null);
const logRange = list => [Math.log10(Math.min(...list)) - 0.12, Math.log10(Math.max(...list)) + 0.12];
const known = list => list.filter(v => Number.isFinite(v) && v > 0);
const UNITS = {position: ' [m]', mounting: ' [rad]'};
const unit = group => `${group} RMS error${UNITS[group] || ''}`;

/** Ticks of a logarithmic axis that spans so many decades. */
function ticks(decades) {
  const steps = decades > 2.5 ? [1] : decades > 0.9 ? [1, 2, 5] : decades > 0.4 ? [1, 1.5, 2, 3, 4, 5, 7] : [1, 1.1, 1.2, 1.3, 1.4, 1.6, 1.8, 2, 2.2, 2.5, 3, 3.5, 4, 4.5, 5, 6, 7, 8, 9];
  const all = steps.flatMap(step => EXPONENTS.map(p => Number((step * 10 ** p).toPrecision(3))));
  return {tickvals: all, ticktext: all.map(String)};
}

function logAxis(theme, title, list, margin = 0) {
  if (!known(list).length) return axis(theme, {title, type: 'log'});
  const [low, high] = logRange(known(list));
  return axis(theme, {title, type: 'log', range: [low - margin, high + margin], ...ticks(high - low + 2 * margin)});
}

/** Where the laws stand: by their share of outliers when that tells them apart, or else side by side. */
function lawPlaces(laws) {
  const shares = laws.map(law => law.epsilon);
  const numeric = laws.length > 2 && shares.every(Number.isFinite) && new Set(shares).size === shares.length;
  return numeric ? {x: shares.map(s => 100 * s), title: 'outliers [%]', numeric} : {x: laws.map(law => law.name), title: '', numeric};
}

function contaminationFigure(view) {
  const {campaign, theme} = view;
  const places = lawPlaces(campaign.laws);
  const traces = campaign.estimators.map(name => {
    const triples = campaign.laws.map(law => law.rms[name]);
    const {color, symbol} = look(view, name);
    const thick = name === view.estimator || name === REFERENCE;
    return {name, x: places.x, y: values(triples), error_y: {...bars(triples), color}, mode: 'lines+markers', line: {color, width: thick ? 3 : 1.3},
      marker: {color, symbol, size: thick ? 8 : 6}, hovertemplate: '%{x}: %{y:.4g}'};
  });
  const bound = campaign.laws.map(law => law.bound);
  if (known(bound).length)
    traces.push({name: 'bound', x: places.x, y: bound, mode: 'lines+markers', line: {color: theme.soft, width: 2, dash: 'dash'}, marker: {color: theme.soft, size: 5},
      hovertemplate: '%{x}: %{y:.4g}'});
  const all = traces.flatMap(trace => trace.y);
  return {traces, layout: frame(theme, theme.narrow ? 520 : 480, {
    xaxis: axis(theme, {title: places.title, ...(places.numeric ? {} : {type: 'category', tickangle: theme.narrow ? -60 : -25})}),
    yaxis: logAxis(theme, unit(campaign.group), all), legend: {orientation: 'h', x: 0, y: 1.02, yanchor: 'bottom'}})};
}

/** Names down the side, the best on top, one dot with its interval each; `extra` holds further shapes. */
function dotFigure(view, triples, axisOf, shapes) {
  const {campaign, theme} = view;
  const names = campaign.estimators.filter(name => triples[name]).sort((a, b) => triples[b][0] - triples[a][0]);
  const list = names.map(name => triples[name]);
  const colours = names.map(name => look(view, name).color);
  const trace = {x: values(list), y: names, error_x: {...bars(list), color: theme.soft}, mode: 'markers',
    marker: {color: colours, symbol: names.map(name => look(view, name).symbol), size: names.map(name => name === view.estimator ? 13 : 9)}, hovertemplate: '%{y}: %{x:.4g}<extra></extra>'};
  return {traces: names.length ? [trace] : [], layout: frame(theme, 100 + 30 * names.length, {showlegend: false, shapes,
    xaxis: axisOf(list.flat()), yaxis: axis(theme, {title: '', type: 'category', ticklabelposition: 'outside'})})};
}

const vertical = (theme, x, dash) => ({type: 'line', x0: x, x1: x, yref: 'paper', y0: 0, y1: 1, line: {color: theme.soft, width: 1.5, dash}, layer: 'below'});

function rankingFigure(view) {
  const {law, theme} = view;
  const shapes = law.bound ? [vertical(theme, law.bound, 'dash')] : [];
  return dotFigure(view, law.rms, list => logAxis(theme, unit(view.campaign.group), [...list, law.bound]), shapes);
}

function neesFigure(view) {
  const {campaign, law, theme} = view;
  const band = campaign.nees_band;
  const shapes = [vertical(theme, 1, 'dot')];
  if (band) shapes.push({type: 'rect', x0: band[0], x1: band[1], yref: 'paper', y0: 0, y1: 1, fillcolor: theme.shade, line: {width: 0}, layer: 'below'});
  return dotFigure(view, law.nees, list => logAxis(theme, 'NEES over its degrees', [...list, 0.8, 1.25]), shapes);
}

function costFigure(view) {
  const {campaign, law, theme} = view;
  const names = campaign.estimators.filter(name => law.cost[name] > 0 && law.rms[name]);
  const traces = names.map(name => ({name, x: [law.cost[name]], y: [law.rms[name][0]], error_y: {...bars([law.rms[name]]), color: theme.soft}, mode: 'markers',
    marker: {...look(view, name), size: name === view.estimator ? 14 : 10}, hovertemplate: '%{x:.3g} µs an update<br>%{y:.4g}'}));
  const shapes = law.bound ? [{type: 'line', xref: 'paper', x0: 0, x1: 1, y0: law.bound, y1: law.bound, line: {color: theme.soft, width: 1.5, dash: 'dash'}}] : [];
  return {traces, layout: frame(theme, theme.narrow ? 460 : 440, {shapes, showlegend: true,
    xaxis: logAxis(theme, 'computing [µs/update]', names.map(name => law.cost[name]), 0.1),
    yaxis: logAxis(theme, unit(campaign.group), [...names.flatMap(name => law.rms[name]), law.bound])})};
}

/** RMS error and cost over the number of particles, a curve an estimator, of the campaigns that are alike in all else. */
function particlesFigure(view) {
  const {campaign, family, theme} = view;
  const laws = family.map(member => member.laws.find(law => law.name === view.law.name));
  const x = family.map(member => member.particles);
  const lines = campaign.estimators.flatMap(name => {
    const {color, symbol} = look(view, name);
    const style = {name, x, mode: 'lines+markers', line: {color, width: name === view.estimator ? 3 : 1.3}, marker: {color, symbol, size: 8}};
    const triples = laws.map(law => law.rms[name]);
    return [{...style, y: values(triples), error_y: {...bars(triples), color}, legendgroup: name, hovertemplate: '%{x} particles: %{y:.4g}'},
      {...style, y: laws.map(law => law.cost[name]), yaxis: 'y2', legendgroup: name, showlegend: false, hovertemplate: '%{x} particles: %{y:.3g} µs an update'}];
  });
  const errors = laws.flatMap(law => campaign.estimators.flatMap(name => law.rms[name]));
  const costs = laws.flatMap(law => campaign.estimators.map(name => law.cost[name]));
  return {traces: family.length ? lines : [], layout: frame(theme, theme.narrow ? 560 : 620, {xaxis: {...logAxis(theme, 'particles', x, 0.1), anchor: 'y2'},
    yaxis: {...logAxis(theme, unit(campaign.group), errors), domain: [0.48, 1]}, yaxis2: {...logAxis(theme, 'computing [µs/update]', costs), domain: [0, 0.42]}})};
}

function failuresFigure(view) {
  const {campaign, law, theme} = view;
  const names = campaign.estimators.filter(name => law.diverged[name] || law.locked_out[name]);
  const bar = (title, counts, color) => ({name: title, type: 'bar', orientation: 'h', y: names, x: names.map(name => counts[name]), marker: {color}, hovertemplate: `%{y}: %{x} ${title}<extra></extra>`});
  return {traces: names.length ? [bar('diverged', law.diverged, theme.bad), bar('locked out', law.locked_out, theme.warn)] : [],
    layout: frame(theme, 120 + 40 * names.length, {barmode: 'group', xaxis: axis(theme, {title: 'runs', rangemode: 'tozero', tickformat: 'd'}), yaxis: axis(theme, {title: ''})})};
}
