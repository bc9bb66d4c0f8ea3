"use strict";
// Numbers of all variants.

const kQuantities = [
  { title: "IoU", of: (m) => m.summary.iou_mean, decimals: 3, higher: true },
  { title: "Rot, °", of: (m) => m.summary.rotation_deg_mean, decimals: 2 },
  { title: "yaw error, °", of: (m) => m.summary.yaw_error_deg_mean, decimals: 2 },
  { title: "IoU, first view", of: (m) => m.first_observation && m.first_observation.iou_mean, decimals: 3, higher: true },
  { title: "ATE, m", of: (m) => m.trajectory && m.trajectory.ate_rmse_m, decimals: 4 },
  { title: "held-out IoU", of: (m) => m.held_out && m.held_out.iou_mean, decimals: 3, higher: true },
];

function bestOf(values, higher) {
  const known = values.filter((value) => value != null);
  return known.length === 0 ? null : higher ? Math.max(...known) : Math.min(...known);
}

// Columns that no variant has a value for are left out. What reads the same as the best is bold, too.
function metricsTable(variants) {
  const columns = kQuantities
    .map((quantity) => ({ ...quantity, values: variants.map(({ metrics }) => quantity.of(metrics)) }))
    .filter(({ values }) => values.some((value) => value != null));
  const rows = variants.map(({ name, metrics }, i) => [
    name, String(metrics.summary.objects), String(metrics.summary.observations),
    ...columns.map(({ values, decimals, higher }) => ({
      text: number(values[i], decimals),
      best: values[i] != null && number(values[i], decimals) === number(bestOf(values, higher), decimals),
    }))]);
  const made = table(["variant", "objects", "observations", ...columns.map(({ title }) => title)], rows);
  made.classList.add("metrics");
  return made;
}

function metricsSection(page) {
  const kinds = [["map", "Maps: all frames, landmarks and poses together"],
    ["views", "One landmark from all frames, poses as given"],
    ["frames", "Single frames: mean over the observations of each object"]];
  return section("numbers", "Numbers",
    element("p", { class: "faint" }, "Means over objects, the best in bold. IoU: overlap of the cuboids around estimate and truth. " +
      "Rot: the smallest turn that brings the axes of one onto any of the other. Yaw error: modulo half a turn. " +
      "ATE: root mean square error of the camera's positions."), ...kinds.flatMap(([kind, title]) => {
    const variants = page.variants.filter((variant) => variant.kind === kind);
    return variants.length === 0 ? [] : [element("h3", {}, title), metricsTable(variants)];
  }));
}

// Ablations: what one more part changes, paired by object.
function ablationSection(page) {
  if (page.differences.length === 0) return null;
  const signed = (value, decimals) => value == null ? "–" : (value > 0 ? "+" : "") + value.toFixed(decimals);
  const interval = ({ mean, low, high }, decimals) => mean == null ? "–"
    : signed(mean, decimals) + (low == null ? "" : ` (${signed(low, decimals)} to ${signed(high, decimals)})`);
  return section("ablation", "What each part is worth",
    element("p", {}, "Differences between two variants over the same objects: mean and, in brackets, 95 % confidence interval (Student's t). Bold where the interval leaves out zero."),
    table(["", "objects", "IoU", "Rot, °", "yaw error, °"], page.differences.map((pair) => {
      const cell = (difference, decimals) => ({ text: interval(difference, decimals),
        best: difference.low != null && difference.low * difference.high > 0 });
      return [`${pair.with} – ${pair.without}`, String(pair.objects), cell(pair.iou, 3),
        cell(pair.rotation_deg, 2), cell(pair.yaw_error_deg, 2)];
    })));
}

// What was planned and is not there, or is older than the plan: a row for each state.
function unfinishedTable(unfinished) {
  if (unfinished.length === 0) return null;
  const names = new Map();
  for (const { name, state, is_shown } of unfinished) {
    const text = state + (is_shown ? " (shown: the last complete run)" : "");
    names.set(text, [...(names.get(text) || []), name]);
  }
  const made = table(["not complete", "state"], [...names].map(([text, all]) => [all.join(", "), text]));
  made.classList.add("sentences");
  return made;
}

// What is not on the page, and why.
function remarks({ unfinished, notes, problems }) {
  return [unfinishedTable(unfinished), ...[...problems, ...notes].map((text) => element("p", { class: "faint" }, text))]
    .filter(Boolean);
}
