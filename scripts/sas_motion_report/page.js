// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
// Draws the plots, and redraws them for another estimator, another colour scheme, or paper.
const data = JSON.parse(document.getElementById('data').textContent);
const chooser = document.getElementById('estimator');
const figures = {track: trackFigure, errors: errorFigure, weights: weightFigure, nis: nisFigure, particles: particleFigure, cost: costFigure};

function drawOne(name, theme) {
  const place = document.getElementById(`plot-${name}`);
  const {traces, layout} = figures[name](data, chooser.value, theme);
  const empty = !traces.length;
  place.hidden = empty;
  const note = document.getElementById(`note-${name}`);
  note.textContent = empty ? ` ${chooser.value} has none.` : thinningNote(name);
  if (empty) return null;
  if ('print' in document.documentElement.dataset) layout.width = PAPER_WIDTH;
  return Plotly.react(place, traces, layout, {responsive: true, displaylogo: false, displayModeBar: theme.coarse || theme.narrow ? false : 'hover'});
}

function thinningNote(name) {
  const strides = Object.values(data.estimators[chooser.value].updates).map(u => u.stride);
  const most = Math.max(1, ...strides);
  return ['weights', 'nis'].includes(name) && most > 1 ? ` Drawn are all that were set aside and one in ${most} of the others.` : '';
}

function draw() {
  document.getElementById('chosen').textContent = chooser.value;
  const theme = currentTheme();
  const drawn = Object.keys(figures).filter(name => document.getElementById(`plot-${name}`)).map(name => drawOne(name, theme));
  return Promise.all(drawn).then(() => { document.documentElement.dataset.drawn = chooser.value; });
}

if (data.order.length) startDrawing([chooser], draw);
