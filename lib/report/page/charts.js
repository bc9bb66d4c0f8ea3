"use strict";
// Plots, made by Chart.js.

function chartColours() {
  return ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#8c6d31", "#7f7f7f"];
}

function chart(label, size, config) {
  const canvas = element("canvas", { role: "img", "aria-label": label });
  const holder = element("div", { class: "chart", style: size }, canvas);
  config.options = Object.assign({ animation: false, responsive: true, maintainAspectRatio: false }, config.options);
  // A chart takes the size of its holder, which has one once it is in the page.
  requestAnimationFrame(() => { if (canvas.isConnected) new Chart(canvas, config); });
  return holder;
}

function axis(title, more) {
  return Object.assign({
    type: "linear",
    title: { display: true, text: title, color: colour("faint") },
    grid: { color: colour("line") },
    ticks: { color: colour("faint"), includeBounds: false },
  }, more);
}

function legend(filter) {
  return { labels: { color: colour("ink"), usePointStyle: true, pointStyle: "line", filter: filter || (() => true) } };
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
