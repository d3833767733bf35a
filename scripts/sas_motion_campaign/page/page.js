// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
// Draws the plots, and redraws them for another campaign, law, estimator, colour scheme, or paper.
const data = JSON.parse(document.getElementById('data').textContent);
const lawChooser = document.getElementById('law');
const estimatorChooser = document.getElementById('estimator');
const figures = {contamination: contaminationFigure, ranking: rankingFigure, cost: costFigure, particles: particlesFigure, nees: neesFigure, failures: failuresFigure,
  errors: errorsFigure, effective: effectiveFigure, consistency: consistencyFigure, weights: weightsFigure};
let traces = {};
let drawing = 0;

function currentView() {
  const name = chosenTab().dataset.campaign;
  const campaign = data.campaigns[name];
  const law = campaign.laws.find(l => l.name === lawChooser.value) || campaign.laws[0];
  const estimator = estimatorChooser.value;
  const seen = (traces[name] || {})[law.name] || {};
  const family = (data.families.find(names => names.includes(name)) || []).map(member => data.campaigns[member]);
  return {campaign, family, law, estimator, traces: seen, trace: seen[estimator], theme: currentTheme(), key: [name, law.name, estimator].join(' / ')};
}

/** Offers the laws and estimators of the chosen campaign, and keeps the choice where it exists there too. */
function offerChoices() {
  const campaign = data.campaigns[chosenTab().dataset.campaign];
  const harmful = campaign.laws.length > 1 ? campaign.laws[1].name : campaign.laws[0].name;
  const offer = (chooser, names, otherwise) => {
    const before = chooser.value;
    chooser.replaceChildren(...names.map(name => new Option(name)));
    chooser.value = names.includes(before) ? before : otherwise;
  };
  offer(lawChooser, campaign.laws.map(law => law.name), harmful);
  offer(estimatorChooser, campaign.estimators, campaign.estimators[campaign.estimators.length - 1]);
}

function drawOne(name, view) {
  const place = document.getElementById(`plot-${name}`);
  const {traces: lines, layout} = figures[name](view);
  const empty = !lines.length;
  place.hidden = empty;
  document.getElementById(`note-${name}`).textContent = empty ? ' None here.' : '';
  if (empty) return null;
  if ('print' in document.documentElement.dataset) layout.width = PAPER_WIDTH;
  return Plotly.react(place, lines, layout, {responsive: true, displaylogo: false, displayModeBar: view.theme.coarse || view.theme.narrow ? false : 'hover'});
}

function draw() {
  const view = currentView();
  const mine = ++drawing;
  document.getElementById('chosen').textContent = view.key;
  return Promise.all(Object.keys(figures).map(name => drawOne(name, view)))
    .then(() => { if (mine === drawing) document.documentElement.dataset.drawn = view.key; });
}

async function prepare() {
  traces = JSON.parse(await unpack('traces'));
  offerChoices();
  chooseTab(tabs[0], () => {});
  addEventListener('beforeprint', () => document.querySelectorAll('details').forEach(part => { part.open = true; }));
}

if (tabs.length) {
  listenToTabs(() => { offerChoices(); draw(); });
  startDrawing([lawChooser, estimatorChooser], draw, prepare);
}
