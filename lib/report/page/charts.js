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
  requestAnimationFrame(() => new Chart(canvas, config));
  return holder;
}

function axis(title, more) {
  return Object.assign({
    type: "linear",
    title: { display: true, text: title, color: colour("faint") },
    grid: { color: colour("line") },
    ticks: { color: colour("faint") },
  }, more);
}

function legend(filter) {
  return { labels: { color: colour("ink"), usePointStyle: true, pointStyle: "line", filter: filter || (() => true) } };
}

function curve(label, points, lineColour, more) {
  return Object.assign({ label, data: points, showLine: true, pointRadius: 0, borderWidth: 2,
    borderColor: lineColour, backgroundColor: lineColour }, more);
}

// Every curve over its own range, 0 to 1: descriptors have units of their own.
function scaledToRange(costs) {
  const known = costs.filter((cost) => cost != null);
  const low = Math.min(...known), high = Math.max(...known);
  return costs.map((cost) => cost == null ? null : high > low ? (cost - low) / (high - low) : 0);
}

function vertical(label, at, lineColour, dash) {
  return curve(label, [{ x: at, y: 0 }, { x: at, y: 1 }], lineColour, { borderDash: dash, borderWidth: 1.5 });
}

// Fig. 7: the truth and its half turn, which a mirror plane cannot tell apart.
function yawChart(record) {
  const names = Object.keys(record.cost);
  const datasets = names.map((name, i) => {
    const scaled = scaledToRange(record.cost[name]);
    return curve(name.replaceAll("_", " "),
      record.yaw_deg.map((x, k) => ({ x, y: scaled[k] })), chartColours()[i % 8], { spanGaps: false });
  });
  if (record.true_yaw_deg != null) {
    const [low, high] = [record.yaw_deg[0], record.yaw_deg[record.yaw_deg.length - 1]];
    [-360, -180, 0, 180, 360].map((turn) => record.true_yaw_deg + turn)
      .filter((x) => x >= low && x <= high)
      .forEach((x, i) => datasets.push(vertical(i === 0 ? "true yaw" : "", x, colour("ink"), [6, 4])));
  }
  if (record.refined_yaw_deg != null) {
    datasets.push(vertical("refined", record.refined_yaw_deg, colour("faint"), [2, 3]));
  }
  return chart("cost over yaw", "height: 250px", { type: "scatter", data: { datasets }, options: {
    scales: { x: axis("yaw, deg"), y: axis("cost, each over its range", { min: 0, max: 1 }) },
    plugins: { legend: legend((item) => item.text !== "") } } });
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

// Top-down map -----------------------------------------------------------------------------------

function rotate([x, y, z, w], v) {
  // v + 2 q x (q x v + w v)
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const q = [x, y, z];
  const inner = cross(q, v).map((part, i) => part + w * v[i]);
  return cross(q, inner).map((part, i) => v[i] + 2 * part);
}

// Two horizontal axes of the world, seen from above the first support plane.
function groundAxes(sequence) {
  const up = sequence.planes.length > 0 ? sequence.planes[0].normal : [0, 0, 1];
  const least = up.map(Math.abs).indexOf(Math.min(...up.map(Math.abs)));
  const helper = [0, 1, 2].map((i) => (i === least ? 1 : 0));
  const dot = (a, b) => a.reduce((sum, part, i) => sum + part * b[i], 0);
  const right = helper.map((part, i) => part - dot(helper, up) * up[i]);
  const size = Math.hypot(...right);
  const x = right.map((part) => part / size);
  const y = [up[1] * x[2] - up[2] * x[1], up[2] * x[0] - up[0] * x[2], up[0] * x[1] - up[1] * x[0]];
  return { x, y, place: (point) => ({ x: dot(point, x), y: dot(point, y) }) };
}

function footprint(landmark, ground) {
  const [a, b] = landmark.half_axes;
  const centre = landmark.pose.slice(0, 3), turn = landmark.pose.slice(3);
  const corner = (u, v) => ground.place(rotate(turn, [u * a, v * b, 0]).map((part, i) => part + centre[i]));
  return {
    outline: [corner(1, 1), corner(-1, 1), corner(-1, -1), corner(1, -1), corner(1, 1)],
    front: [ground.place(centre), corner(1, 0)],
  };
}

// Of two standard deviations.
function uncertaintyEllipse(object, ground) {
  const rows = object.centre_covariance;
  const project = (u, v) => u.reduce((sum, ui, i) => sum + v.reduce((inner, vk, k) => inner + ui * rows[i][k] * vk, 0), 0);
  const xx = project(ground.x, ground.x), xy = project(ground.x, ground.y), yy = project(ground.y, ground.y);
  const l11 = Math.sqrt(Math.max(0, xx)), l21 = l11 > 0 ? xy / l11 : 0;
  const l22 = Math.sqrt(Math.max(0, yy - l21 * l21));
  const centre = ground.place(object.landmark.pose.slice(0, 3));
  return Array.from({ length: 37 }, (_, i) => {
    const c = 2 * Math.cos(i * Math.PI / 18), s = 2 * Math.sin(i * Math.PI / 18);
    return { x: centre.x + l11 * c, y: centre.y + l21 * c + l22 * s };
  });
}

// A metre is as long to the right as upwards: the axis with room to spare shows more.
const kEqualScales = {
  id: "equal_scales",
  afterLayout(chart) {
    const { x, y } = chart.scales;
    const per = [x.width / (x.max - x.min), y.height / (y.max - y.min)];
    const loose = per[0] > per[1] ? x : y;
    const middle = (loose.min + loose.max) / 2;
    const half = (loose === x ? x.width : y.height) / Math.min(...per) / 2;
    if (half - (loose.max - loose.min) / 2 < 1e-6 * half) return;
    loose.options.min = middle - half;
    loose.options.max = middle + half;
    requestAnimationFrame(() => chart.update("none"));
  },
};

function topDownChart(page, variant, segment) {
  const sequence = page.sequences[variant.sequence];
  const ground = groundAxes(sequence);
  const datasets = [];
  const add = (label, points, name, more) => datasets.push(curve(label, points, colour(name), more));
  sequence.objects.forEach((object, i) => {
    if (object.segment !== segment) return;
    if (object.truth) {
      const { outline, front } = footprint(object.truth, ground);
      add("ground truth", outline, "truth", { borderWidth: 1.5 });
      add("", front, "truth", { borderWidth: 1.5 });
    }
    const estimate = variant.objects[i];
    if (!estimate || !estimate.landmark) return;
    const { outline, front } = footprint(estimate.landmark, ground);
    add("estimate", outline, "estimate");
    add("", front, "front", { borderWidth: 3 });
    if (estimate.centre_covariance) {
      add("two standard deviations of the centre", uncertaintyEllipse(estimate, ground), "other",
        { borderWidth: 1.5 });
    }
  });
  const poses = variant.trajectory || sequence.frames.map(({ pose }) => pose);
  const here = poses.filter((_, i) => sequence.frames[i].segment === segment);
  add("camera", here.map((pose) => ground.place(pose.slice(0, 3))), "faint", { borderWidth: 1 });
  const all = datasets.flatMap(({ data }) => data);
  const range = (of) => {
    const values = all.map(of);
    return [Math.min(...values) - 0.3, Math.max(...values) + 0.3];
  };
  const [x1, x2] = range(({ x }) => x), [y1, y2] = range(({ y }) => y);
  const size = `aspect-ratio: ${(x2 - x1) / (y2 - y1)}; max-height: 620px`;
  return chart("the map from above", size, { type: "scatter", data: { datasets }, plugins: [kEqualScales], options: {
    scales: { x: axis("m", { min: x1, max: x2 }), y: axis("m", { min: y1, max: y2 }) },
    plugins: { legend: legend(({ text, datasetIndex }) =>
      text !== "" && datasets.findIndex(({ label }) => label === text) === datasetIndex),
      tooltip: { enabled: false } } } });
}
