"use strict";
// Cost over yaw, one strip per cost: descriptors have units of their own, so each is drawn over its own range.

const kStrip = { left: 146, width: 300, height: 34, gap: 8, foot: 34 };

// Degrees from the true yaw (or the yaw itself, where the truth is not known), as a circle of the curve's span has it.
function yawFromTruth(record) {
  const yaws = record.yaw_deg;
  const span = Math.round((yaws[yaws.length - 1] - yaws[0]) / 180) * 180 || 180;
  const truth = record.true_yaw_deg == null ? 0 : record.true_yaw_deg;
  const from = (yaw) => ((yaw - truth + span / 2) % span + span) % span - span / 2;
  return { span, from };
}

// Runs of known costs, as points of the strip; gaps are where too few pairs are visible.
function stripLines(points) {
  const lines = [[]];
  points.forEach((point, i) => {
    const follows = i > 0 && point.cost != null && points[i - 1].cost != null;
    if (!follows && lines[lines.length - 1].length > 0) lines.push([]);
    if (point.cost != null) lines[lines.length - 1].push(point);
  });
  return lines.filter((line) => line.length > 0);
}

function textAt(x, y, text, attributes) {
  return svgElement("text", Object.assign({ x, y }, attributes), text);
}

function yawStrip(name, costs, record, top) {
  const { span, from } = yawFromTruth(record);
  const x = (deg) => kStrip.left + kStrip.width * (deg / span + 0.5);
  const points = costs.map((cost, i) => ({ cost, deg: from(record.yaw_deg[i]) })).sort((one, other) => one.deg - other.deg);
  const known = points.filter(({ cost }) => cost != null);
  const parts = [svgElement("rect", { class: "strip", x: kStrip.left, y: top, width: kStrip.width, height: kStrip.height }),
    textAt(kStrip.left - 8, top + kStrip.height / 2 + 4, name.replaceAll("_", " "), { "text-anchor": "end" })];
  if (known.length === 0) return parts;
  const low = Math.min(...known.map(({ cost }) => cost)), high = Math.max(...known.map(({ cost }) => cost));
  const y = (cost) => top + kStrip.height - 4 - (kStrip.height - 8) * (high > low ? (cost - low) / (high - low) : 0);
  for (const run of stripLines(points)) {
    parts.push(svgElement("polyline", { points: run.map(({ deg, cost }) => `${x(deg).toFixed(1)},${y(cost).toFixed(1)}`).join(" ") }));
  }
  const lowest = known.find(({ cost }) => cost === low);
  const error = Math.abs(((lowest.deg + 90) % 180 + 180) % 180 - 90);
  const isKnown = record.true_yaw_deg != null, isGood = isKnown && error <= 10;
  parts.push(svgElement("circle", { class: isGood ? "near" : isKnown ? "far" : "", cx: x(lowest.deg), cy: y(low), r: 4 }));
  if (isKnown) {
    parts.push(textAt(kStrip.left + kStrip.width + 8, top + kStrip.height / 2 + 4, `${number(error, 0)}°`, { class: isGood ? "near" : "" }));
  }
  return parts;
}

// Fig. 7 of one observation. The truth's half turn is the same mirror plane.
function yawStrips(record, label) {
  const names = Object.keys(record.cost);
  const { span, from } = yawFromTruth(record);
  const height = names.length * (kStrip.height + kStrip.gap) + kStrip.foot;
  const foot = height - kStrip.foot;
  const x = (deg) => kStrip.left + kStrip.width * (deg / span + 0.5);
  const upright = (deg, name) => svgElement("line", { class: name, x1: x(deg), x2: x(deg), y1: 0, y2: foot - kStrip.gap });
  const parts = names.flatMap((name, i) => yawStrip(name, record.cost[name], record, i * (kStrip.height + kStrip.gap)));
  if (record.true_yaw_deg != null) {
    [-180, 0, 180].filter((deg) => 2 * Math.abs(deg) <= span).forEach((deg) => parts.push(upright(deg, "truth")));
  }
  if (record.refined_yaw_deg != null) parts.push(upright(from(record.refined_yaw_deg), "refined"));
  for (let deg = -span / 2; deg <= span / 2; deg += span / 4) {
    parts.push(textAt(x(deg), foot + 8, `${deg}°`, { "text-anchor": "middle" }));
  }
  parts.push(textAt(kStrip.left + kStrip.width / 2, foot + 25,
    record.true_yaw_deg == null ? "yaw" : "yaw from the true one", { "text-anchor": "middle" }));
  return svgElement("svg", { class: "strips", viewBox: `0 0 ${kStrip.left + kStrip.width + 44} ${height}`, role: "img", "aria-label": label }, parts);
}
