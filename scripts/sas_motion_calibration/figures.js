// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
// Each function returns {traces, layout} of one plot for the chosen estimator; times in seconds since the first ping.
const OUTLIER = 3; // standard deviations

const colour = (name, theme) => theme.colours[data.order.indexOf(name) % theme.colours.length];
const channelsOf = name => data.channels.map(channel => [channel, data.estimators[name].channels[channel]]).filter(([, c]) => finiteOnly(c.residual).length);
const beyond = v => v !== null && Math.abs(v) > OUTLIER;

/** What an estimator has of an unknown over time; batch has it once and for all. */
function course(name, i) {
  const {trace, x, sigma} = data.estimators[name];
  const unknown = data.unknowns[i];
  if (trace) return {t: trace.t, mean: trace.mean[unknown], sigma: trace.sigma[unknown]};
  return {t: [0, data.duration], mean: [x[i], x[i]], sigma: [sigma[i], sigma[i]]};
}

function convergenceFigure(chosen, theme) {
  const rows = data.unknowns.map((unknown, i) => {
    const {t, mean, sigma} = course(chosen, i);
    const edge = {x: t, mode: 'lines', line: {width: 0}, hoverinfo: 'skip'};
    const band = [{...edge, y: mean.map((m, k) => m - 3 * sigma[k])}, {...edge, y: mean.map((m, k) => m + 3 * sigma[k]), fill: 'tonexty', fillcolor: theme.shade}];
    const lines = [...data.order.filter(name => name !== chosen), chosen].map(name => {
      const line = course(name, i);
      return {name, x: line.t, y: line.mean, mode: 'lines', hovertemplate: `${name} %{x:.0f} s: %{y:.4f}`,
        line: {color: colour(name, theme), width: name === chosen ? 2 : 1, dash: data.estimators[name].trace ? 'solid' : 'dot'}};
    });
    const truth = data.truth ? [{name: 'truth', x: [0, data.duration], y: [data.truth[i], data.truth[i]], mode: 'lines', line: {color: theme.ink, width: 1, dash: '4px,4px'}}] : [];
    const final = mean[mean.length - 1];
    const settled = quantile(sigma.map((s, k) => 3 * s + Math.abs(mean[k] - final)), 0.9);
    return [data.titles[unknown], [...band, ...lines, ...truth], {range: [final - 1.3 * settled, final + 1.3 * settled], uirevision: chosen}];
  });
  return stackedFigure(data, theme, rows, []);
}

function residualsFigure(chosen, theme) {
  const {t} = data.pings;
  const rows = channelsOf(chosen).map(([channel, {residual, outlier}]) => {
    const mark = (name, keep, marker) => ({name, x: pick(t, keep), y: pick(residual, keep), mode: 'markers', marker, hovertemplate: '%{x:.0f} s: %{y:.2f} σ'});
    const traces = [mark('residual', i => !beyond(residual[i]), {color: colour(chosen, theme), size: 4, opacity: 0.55}),
      mark('beyond 3σ', i => beyond(residual[i]), {color: theme.bad, size: 6, symbol: 'x-thin', line: {color: theme.bad, width: 1.5}})];
    if (outlier) traces.push(mark('outlier by its label', i => outlier[i], {color: theme.warn, size: 9, symbol: 'circle-open'}));
    return [`${channel.replace('_', ' ')} [σ]`, traces, {uirevision: chosen}];
  });
  const band = (_, i) => ({type: 'rect', xref: 'paper', x0: 0, x1: 1, yref: `y${i ? i + 1 : ''}`, y0: -OUTLIER, y1: OUTLIER, fillcolor: theme.shade, line: {width: 0}, layer: 'below'});
  return stackedFigure(data, theme, rows, rows.map(band));
}

function noiseFigure(chosen, theme) {
  const traces = channelsOf(chosen).map(([channel, {noise}], i) => ({name: channel.replace('_', ' '), x: data.pings.t,
    y: noise, mode: 'lines', line: {color: theme.colours[i], width: 1.5}, hovertemplate: '%{x:.0f} s: %{y:.2f}'}));
  return {traces, layout: frame(theme, 320, {xaxis: axis(theme, {title: 'time [s]'}), yaxis: axis(theme, {title: 'noise over stated', rangemode: 'tozero'})})};
}

function trackFigure(chosen, theme) {
  const channels = channelsOf(chosen).map(([, channel]) => channel);
  const bad = i => channels.some(c => beyond(c.residual[i]));
  const {east, north} = data.pings;
  const hovertemplate = '%{x:.1f} m east<br>%{y:.1f} m north';
  const traces = [{name: 'vessel', x: east, y: north, mode: 'lines+markers', line: {color: colour(chosen, theme), width: 1}, marker: {size: 3}, hovertemplate},
    {name: 'outlier', x: pick(east, bad), y: pick(north, bad), mode: 'markers', marker: {color: theme.bad, size: 7, symbol: 'x-thin', line: {color: theme.bad, width: 1.5}}, hovertemplate},
    {name: 'transponder', x: [0], y: [0], mode: 'markers', marker: {color: theme.ink, size: 12, symbol: 'star'}, hovertemplate}];
  return {traces, layout: frame(theme, theme.narrow ? 440 : 540, {xaxis: axis(theme, {title: 'east of the transponder [m]'}),
    yaxis: axis(theme, {title: 'north [m]', scaleanchor: 'x', scaleratio: 1})})};
}
