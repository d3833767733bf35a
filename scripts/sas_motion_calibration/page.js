// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
// Draws the plots, and redraws them for another estimator, another colour scheme, or paper.
const data = JSON.parse(document.getElementById('data').textContent);
const chooser = document.getElementById('estimator');
const figures = {convergence: convergenceFigure, residuals: residualsFigure, noise: noiseFigure, track: trackFigure};

function drawOne(name, theme) {
  const {traces, layout} = figures[name](chooser.value, theme);
  if ('print' in document.documentElement.dataset) layout.width = PAPER_WIDTH;
  return Plotly.react(`plot-${name}`, traces, layout, {responsive: true, displaylogo: false, displayModeBar: theme.coarse || theme.narrow ? false : 'hover'});
}

function draw() {
  document.getElementById('chosen').textContent = chooser.value;
  const theme = currentTheme();
  return Promise.all(Object.keys(figures).map(name => drawOne(name, theme))).then(() => { document.documentElement.dataset.drawn = chooser.value; });
}

startDrawing([chooser], draw);
