"use strict";
// Numbers of all variants.

const kQuantities = [
  { title: "IoU", of: (m) => m.summary.iou_mean, decimals: 3, higher: true },
  { title: "IoU, first view", of: (m) => m.first_observation && m.first_observation.iou_mean, decimals: 3, higher: true },
  { title: "Rot deg", of: (m) => m.summary.rotation_deg_mean, decimals: 2 },
  { title: "yaw error deg", of: (m) => m.summary.yaw_error_deg_mean, decimals: 2 },
  { title: "ATE m", of: (m) => m.trajectory && m.trajectory.ate_rmse_m, decimals: 4 },
  { title: "held-out IoU", of: (m) => m.held_out && m.held_out.iou_mean, decimals: 3, higher: true },
];

function bestOf(values, higher) {
  const known = values.filter((value) => value != null);
  return known.length === 0 ? null : higher ? Math.max(...known) : Math.min(...known);
}

// Columns that no variant has a value for are left out.
function metricsTable(variants) {
  const columns = kQuantities
    .map((quantity) => ({ ...quantity, values: variants.map(({ metrics }) => quantity.of(metrics)) }))
    .filter(({ values }) => values.some((value) => value != null));
  const rows = variants.map(({ name, metrics }, i) => [
    name, String(metrics.summary.objects), String(metrics.summary.observations),
    ...columns.map(({ values, decimals, higher }) => ({
      text: number(values[i], decimals),
      best: values[i] != null && values[i] === bestOf(values, higher),
    }))]);
  return table(["variant", "objects", "observations", ...columns.map(({ title }) => title)], rows);
}

function metricsSection(page) {
  const kinds = [["map", "Maps: all frames, landmarks and poses together"],
    ["views", "One landmark from all frames, poses as given"],
    ["frames", "Single frames: mean over the observations of each object"]];
  return section("numbers", "Numbers", ...kinds.flatMap(([kind, title]) => {
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
    table(["", "objects", "IoU", "Rot deg", "yaw error deg"], page.differences.map((pair) => {
      const cell = (difference, decimals) => ({ text: interval(difference, decimals),
        best: difference.low != null && difference.low * difference.high > 0 });
      return [`${pair.with} – ${pair.without}`, String(pair.objects), cell(pair.iou, 3),
        cell(pair.rotation_deg, 2), cell(pair.yaw_error_deg, 2)];
    })));
}
