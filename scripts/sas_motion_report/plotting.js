// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
// What every plot shares: the unpacked plotly.js, the page's colours, axes, frames, and rows over one time axis.
const PAPER_WIDTH = 660; // A4 within its margins [px]

/** The text of an element that holds it gzipped as base64. */
function unpack(id) {
  const packed = Uint8Array.from(atob(document.getElementById(id).textContent.trim()), c => c.charCodeAt(0));
  return new Response(new Blob([packed]).stream().pipeThrough(new DecompressionStream('gzip'))).text();
}

async function unpackPlotly() {
  const script = document.createElement('script');
  script.textContent = await unpack('plotly');
  document.head.append(script);
}

function currentTheme() {
  const style = getComputedStyle(document.documentElement);
  const read = name => style.getPropertyValue(`--${name}`).trim();
  return {ink: read('ink'), soft: read('soft'), rule: read('rule'), bad: read('bad'), warn: read('warn'), shade: read('shade'),
    colours: [0, 1, 2, 3, 4, 5, 6, 7].map(i => read(`c${i}`)), font: 'system-ui, "Segoe UI", "DejaVu Sans", sans-serif',
    narrow: document.documentElement.clientWidth < 640, coarse: matchMedia('(pointer: coarse)').matches};
}

const pick = (list, keep) => (list || []).filter((_, i) => keep(i));
const finiteOnly = list => list.filter(Number.isFinite);

function quantile(list, q) {
  const sorted = finiteOnly(list).sort((a, b) => a - b);
  return sorted.length ? sorted[Math.floor(q * (sorted.length - 1))] : NaN;
}

function axis(theme, extra) {
  const title = {text: extra.title, font: {size: 13}, standoff: 8};
  return {color: theme.soft, gridcolor: theme.rule, zerolinecolor: theme.rule, linecolor: theme.soft, automargin: true, ...extra, title};
}

function frame(theme, height, extra) {
  return {height, font: {family: theme.font, size: 13, color: theme.ink}, paper_bgcolor: 'rgba(0,0,0,0)', plot_bgcolor: 'rgba(0,0,0,0)',
    margin: {l: 52, r: 14, t: theme.narrow ? 12 : 34, b: 44}, legend: {orientation: 'h', x: 0, y: 1.02, yanchor: 'bottom'}, uirevision: 'keep',
    dragmode: theme.coarse ? false : 'zoom', hoverlabel: {namelength: -1},
    modebar: {bgcolor: 'rgba(0,0,0,0)', color: theme.soft, activecolor: theme.ink}, ...extra};
}

/** Rows of plots over one time axis; `rows` holds [title, traces, layout of the row's axis]. */
function stackedFigure(data, theme, rows, shapes) {
  const layout = frame(theme, 90 + rows.length * (theme.narrow ? 150 : 170), {shapes, showlegend: false});
  layout.xaxis = axis(theme, {title: 'time [s]', anchor: `y${rows.length > 1 ? rows.length : ''}`, range: data.duration ? [0, data.duration] : undefined});
  const gap = 0.1 / rows.length;
  const height = (1 - gap * (rows.length - 1)) / rows.length;
  rows.forEach(([title, , look], i) => {
    const bottom = Math.max(0, 1 - (i + 1) * height - i * gap);
    layout[`yaxis${i ? i + 1 : ''}`] = axis(theme, {title, domain: [bottom, bottom + height], ...look});
  });
  return {traces: rows.flatMap(([, traces], i) => traces.map(trace => ({...trace, xaxis: 'x', yaxis: `y${i ? i + 1 : ''}`}))), layout};
}

/** What a page says in place of plots that it cannot draw. */
function tellProblem(error) {
  const problem = document.getElementById('problem');
  problem.textContent = `The plots cannot be drawn in this browser (${error.message}); the tables are complete.`;
  problem.hidden = false;
}

/** Draws for paper, whose width is fixed, or for the screen again. */
function drawForPaper(paper, draw) {
  document.documentElement.toggleAttribute('data-print', paper);
  draw().then(() => paper || document.querySelectorAll('.plot.js-plotly-plot').forEach(place => place.hidden || Plotly.Plots.resize(place)));
}

/** Draws for the first time, and then when a chooser, the colours, the width or the paper changes; `prepare` comes before the first time. */
async function startDrawing(choosers, draw, prepare = async () => {}) {
  try {
    await unpackPlotly();
    await prepare();
    await draw();
  } catch (error) {
    return tellProblem(error);
  }
  choosers.forEach(chooser => chooser.addEventListener('change', draw));
  ['(prefers-color-scheme: dark)', '(max-width: 639px)'].forEach(query => matchMedia(query).addEventListener('change', draw));
  addEventListener('beforeprint', () => drawForPaper(true, draw));
  addEventListener('afterprint', () => drawForPaper(false, draw));
}
