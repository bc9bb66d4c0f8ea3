"use strict";
// The paper's figures from these runs.

// The first item of each object; items are of detections of the variant's sequence.
function firstOfEachObject(page, variant, items) {
  const { detections } = page.sequences[variant.sequence];
  const taken = new Set();
  return items.filter(({ detection }) => {
    const { object } = detections[detection];
    return taken.has(object) ? false : taken.add(object);
  });
}

// The first observation of each object that all of these variants have an estimate of.
function exampleDetections(page, variants, count) {
  const known = variants[0].outlines.map((_, detection) => ({ detection }))
    .filter(({ detection }) => variants.every((variant) => variant.outlines[detection]));
  return firstOfEachObject(page, variants[0], known).slice(0, count);
}

function sameSequence(variants) {
  return variants.filter((variant) => variant && variant.sequence === (variants.find(Boolean) || {}).sequence);
}

// Views of the same detections by several variants; empty for fewer than two variants.
function comparison(page, all, names, count) {
  const variants = sameSequence(names.map((name) => all.find((variant) => variant.name === name)));
  if (variants.length < 2) return [];
  const sequence = page.sequences[variants[0].sequence];
  return exampleDetections(page, variants, count).map(({ detection: index }) => {
    const detection = sequence.detections[index];
    const object = sequence.objects[detection.object];
    return element("div", { class: "comparison" }, element("h4", {},
      `${object.label} ${object.id}, frame ${sequence.frames[detection.frame].id}`),
      element("div", { class: "grid" }, variants.map((variant) => element("figure", {},
        detectionView(page, variant, index, `${variant.name}, ${object.label}`),
        element("figcaption", {}, variant.name)))));
  });
}

function figure(title, text, content) {
  return content.length === 0 ? [] : [element("h3", {}, title), element("p", {}, text), ...content];
}

// Each way in which curves were made, with one variant that has them, of single frames if possible:
// what its curves are of is then its estimate.
function waysOfCurves(page) {
  return page.symmetries.map((symmetry, i) => {
    const sharing = page.variants.filter((variant) => variant.symmetry === i && !variant.numbers_only);
    const variant = sharing.find(({ kind }) => kind === "frames") || sharing[0];
    return { ...symmetry, variant, names: sharing.map(({ name }) => name).join(", ") };
  }).filter(({ variant }) => variant);
}

function curvesOf(page, variant) {
  return variant.symmetry == null ? [] : page.symmetries[variant.symmetry].curves;
}

function nameOfRecord(page, variant, record) {
  const { detections, objects, frames } = page.sequences[variant.sequence];
  const { object, frame } = detections[record.detection];
  return `${objects[object].label} ${objects[object].id}, frame ${frames[frame].id}`;
}

// Fig. 5: samples and the pixels that the body's mirror plane takes them to.
function pairShapes(record, width) {
  return record.pairs.flatMap(([x1, y1, x2, y2]) => [
    line([x1, y1, x2, y2], "detection", { "stroke-width": 0.6, "stroke-opacity": 0.6 }),
    svgElement("circle", { cx: x1, cy: y1, r: width / 120, fill: "var(--front)" }),
    svgElement("circle", { cx: x2, cy: y2, r: width / 120, fill: "var(--grid)" })]);
}

function pairFigures(page, ways) {
  return ways.flatMap((way) => {
    const records = firstOfEachObject(page, way.variant, way.curves).filter(({ pairs }) => pairs.length > 0).slice(0, 4);
    if (records.length === 0) return [];
    return [element("div", { class: "comparison" }, element("h4", {}, way.names),
      element("div", { class: "grid" }, records.map((record) => element("figure", {},
        detectionView(page, way.variant, record.detection, "mirrored pairs", (width) => pairShapes(record, width)),
        element("figcaption", {}, `${nameOfRecord(page, way.variant, record)}: ${record.pairs.length} of ${record.pairs_in_all} pairs`)))))];
  });
}

function bestOf(values, higher) {
  const known = values.filter((value) => value != null);
  return known.length === 0 ? null : higher ? Math.max(...known) : Math.min(...known);
}

function descriptorTable(descriptors) {
  const kStepDeg = 5;
  const rows = Object.entries(descriptors).map(([name, all]) => ({ name, ...all, near: all.within[10 / kStepDeg] }));
  const best = (of, higher) => bestOf(rows.map(of), higher);
  const [error, near, nearKnown] = [best((row) => row.median_error_deg), best((row) => row.near, true),
    best((row) => row.near_where_known, true)];
  const share = (value, highest) => ({ text: value == null ? "–" : `${number(100 * value, 0)} %`, best: value === highest });
  return table(["cost", "observations", "median yaw error, °", "within 10°", "known at true yaw", "within 10° where known", "local minima"],
    rows.map((row) => [row.name.replaceAll("_", " "), String(row.observations),
      { text: number(row.median_error_deg, 1), best: row.median_error_deg === error },
      share(row.near, near), share(row.known_at_truth), share(row.near_where_known, nearKnown), number(row.minima, 1)]));
}

function curveFigures(page, ways) {
  return ways.flatMap((way) => {
    const strips = firstOfEachObject(page, way.variant, way.curves).slice(0, 4).map((record) => element("figure", {},
      yawStrips(record, "cost over yaw"), element("figcaption", {}, nameOfRecord(page, way.variant, record))));
    const overall = Object.keys(way.descriptors).length === 0 ? []
      : [descriptorTable(way.descriptors), yawErrorChart(way.descriptors)];
    return [element("h4", {}, way.names), ...overall, element("div", { class: "wide" }, strips)];
  });
}

function figuresSection(page, variants) {
  const ways = waysOfCurves(page);
  const content = [
    ...figure("Samples and mirrored pairs", "Samples are orange, the pixels that the mirror plane of the estimate takes them to white (fig. 5 of the paper).",
      pairFigures(page, ways)),
    ...figure("Single-frame initialisation", "The first observations of some objects (fig. 6): detection dashed, " +
      (page.has_true_objects ? "ground truth green, " : "") + "estimate blue, the axis through its front and back orange.",
      comparison(page, variants, ["Init1-1", "InitP", "InitS", "InitSTE"], 3)),
    ...figure("Cost over yaw", page.has_true_objects ?
      "Which descriptor finds the yaw (fig. 7)? The tables count all observations: how far the lowest cost is from the true yaw, modulo half a turn, " +
      "and whether there is a cost at the true yaw at all: where too few pairs of pixels are visible at once there is none, and no descriptor can win. " +
      "The strips show single observations, each cost over its own range: the dot is its lowest point, green within 10° of the truth, the dashed line the true yaw, the dotted one the yaw that was chosen."
      : "The strips show single observations, each cost over its own range: the dot is its lowest point, the dotted line the yaw that was chosen.",
      curveFigures(page, ways)),
    ...figure("Before and after symmetry", "The same observations before the yaw is refined and after (fig. 8).",
      [...comparison(page, variants, ["InitP", "InitPT"], 3), ...comparison(page, variants, ["InitS", "InitST", "InitSTE"], 3)]),
  ];
  return content.length === 0 ? null : section("figures", "Figures", ...content);
}
