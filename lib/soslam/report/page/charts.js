"use strict";
// Plots, made by Chart.js.

function chartColours() {
  return ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#8c6d31", "#7f7f7f"];
}

// The numbers of curves over one axis, as a table for screen readers.
function numbersOfCurves(xTitle, curves) {
  const short = (value) => String(Number(value.toPrecision(5)));
  const xs = [...new Set(curves.flatMap(({ data }) => data.map(({ x }) => x)))].sort((one, other) => one - other);
  const values = curves.map(({ data }) => new Map(data.map(({ x, y }) => [x, short(y)])));
  return table([xTitle, ...curves.map(({ label }) => label)],
    xs.map((x) => [short(x), ...values.map((ys) => ys.get(x) || "–")]));
}

// Arrow keys lead along a curve and to the next one; the point is marked and said.
function walkByKeys(canvas, said) {
  const at = { datasetIndex: 0, index: 0 };
  const wrapped = (i, count) => (i + count) % count;
  canvas.addEventListener("keydown", (event) => {
    const step = { ArrowRight: [0, 1], ArrowLeft: [0, -1], ArrowDown: [1, 0], ArrowUp: [-1, 0] }[event.key];
    const shown = Chart.getChart(canvas);
    if (!step || !shown) return;
    event.preventDefault();
    at.datasetIndex = wrapped(at.datasetIndex + step[0], shown.data.datasets.length);
    const { label, data } = shown.data.datasets[at.datasetIndex];
    at.index = wrapped(Math.min(at.index, data.length - 1) + step[1], data.length);
    shown.setActiveElements([at]);
    shown.tooltip.setActiveElements([at], { x: 0, y: 0 });
    shown.update("none");
    said.textContent = `${label}: ${number(data[at.index].x, 2)}, ${number(data[at.index].y, 2)}`;
  });
}

// A chart, what the keyboard leads to in it, and its numbers as a table.
function chart(label, size, config) {
  const canvas = element("canvas", { role: "application", tabindex: 0, "aria-roledescription": "chart",
    "aria-label": `${label}; arrow keys lead along the curves, the table below has the numbers` });
  const said = element("output", { class: "faint" });
  config.options = Object.assign({ animation: false, responsive: true, maintainAspectRatio: false }, config.options);
  // A chart takes the size of its holder, which has one once it is in the page.
  requestAnimationFrame(() => { if (canvas.isConnected) new Chart(canvas, config); });
  walkByKeys(canvas, said);
  return element("div", {}, element("div", { class: "chart", style: size }, canvas), said,
    element("details", {}, element("summary", {}, "the numbers of this chart"),
      numbersOfCurves(config.options.scales.x.title.text, config.data.datasets)));
}

function axis(title, more) {
  return Object.assign({
    type: "linear",
    title: { display: true, text: title, color: colour("faint") },
    grid: { color: colour("line") },
    ticks: { color: colour("faint"), includeBounds: false },
  }, more);
}

function legend() {
  return { labels: { color: colour("ink"), usePointStyle: true, pointStyle: "line" } };
}

function curve(label, points, lineColour, more) {
  return Object.assign({ label, data: points, showLine: true, pointRadius: 0, borderWidth: 2,
    borderColor: lineColour, backgroundColor: lineColour }, more);
}

function convergenceChart(variants) {
  const datasets = variants.map(({ name, solver }, i) => {
    const costs = solver.cost_per_iteration;
    return curve(name, costs.map((y, x) => ({ x, y })), chartColours()[i % 8]);
  });
  return chart("cost per iteration", "height: 320px", { type: "scatter", data: { datasets }, options: {
    scales: { x: axis("iteration"), y: axis("cost", { type: "logarithmic" }) },
    plugins: { legend: legend() } } });
}

// Fig. 7 over all observations: the share whose lowest cost is at most so far from the true yaw.
function yawErrorChart(descriptors) {
  const datasets = Object.entries(descriptors).map(([name, { within }], i) =>
    curve(name.replaceAll("_", " "), within.map((share, k) => ({ x: k * 90 / (within.length - 1), y: 100 * share })),
      chartColours()[i % 8]));
  datasets.push(curve("by chance", [{ x: 0, y: 0 }, { x: 90, y: 100 }], colour("faint"), { borderDash: [4, 4], borderWidth: 1.5 }));
  return chart("share of observations over yaw error", "height: 300px", { type: "scatter", data: { datasets }, options: {
    scales: { x: axis("yaw error of the lowest cost, °", { min: 0, max: 90 }), y: axis("observations within, %", { min: 0, max: 100 }) },
    plugins: { legend: legend() } } });
}
