"use strict";
// The paper's figures from these runs.

function byName(page, name) {
  return page.variants.find((variant) => variant.name === name);
}

// The first observation with an image of each object that all of these variants have an estimate of.
function exampleDetections(page, variants, count) {
  const sequence = page.sequences[variants[0].sequence];
  const taken = new Set();
  const examples = [];
  sequence.detections.forEach((detection, i) => {
    if (taken.has(detection.object) || !page.images[sequence.frames[detection.frame].id]) return;
    if (!variants.every((variant) => variant.outlines[i])) return;
    taken.add(detection.object);
    examples.push(i);
  });
  return examples.slice(0, count);
}

function sameSequence(variants) {
  return variants.filter((variant) => variant && variant.sequence === (variants.find(Boolean) || {}).sequence);
}

function comparison(page, names, count) {
  const variants = sameSequence(names.map((name) => byName(page, name)));
  if (variants.length === 0) return [];
  const sequence = page.sequences[variants[0].sequence];
  return exampleDetections(page, variants, count).map((index) => {
    const detection = sequence.detections[index];
    const object = sequence.objects[detection.object];
    return element("div", {}, element("div", { class: "faint" },
      `${object.label} ${object.id}, frame ${sequence.frames[detection.frame].id}`),
      element("div", { class: "grid" }, variants.map((variant) => element("figure", {},
        detectionView(page, variant, index, [], `${variant.name}, ${object.label}`),
        element("figcaption", {}, variant.name)))));
  });
}

function figure(title, text, content) {
  return content.length === 0 ? [] : [element("h3", {}, title), element("p", {}, text), ...content];
}

// Fig. 5: samples and the pixels that the body's mirror plane takes them to.
function pairFigures(page, variants) {
  return variants.flatMap((variant) => {
    const sequence = page.sequences[variant.sequence];
    const records = firstOfEachObject(page, variant).filter(({ pairs }) => pairs.length > 0).slice(0, 3);
    return records.map((record) => {
      const shapes = record.pairs.flatMap(([x1, y1, x2, y2]) => [
        line([x1, y1, x2, y2], "detection", { "stroke-width": 0.6, "stroke-opacity": 0.5 }),
        svgElement("circle", { cx: x1, cy: y1, r: 1.4, fill: "var(--front)" }),
        svgElement("circle", { cx: x2, cy: y2, r: 1.4, fill: "var(--estimate)" })]);
      const object = sequence.objects[sequence.detections[record.detection].object];
      return element("figure", {}, detectionView(page, variant, record.detection, shapes, "mirrored pairs"),
        element("figcaption", {}, `${variant.name}, ${object.label} ${object.id}: ${record.pairs.length} of ${record.pairs_in_all} pairs`));
    });
  });
}

function firstOfEachObject(page, variant) {
  const { detections, frames } = page.sequences[variant.sequence];
  const taken = new Set();
  return variant.curves.filter((record) => {
    const { object, frame } = detections[record.detection];
    if (taken.has(object) || !page.images[frames[frame].id]) return false;
    taken.add(object);
    return true;
  });
}

function descriptorTable(variant) {
  const rows = Object.entries(variant.descriptors).map(([name, all]) =>
    [name.replaceAll("_", " "), all.observations, all.median_error_deg, all.within_10_deg, all.minima]);
  const errors = bestOf(rows.map((row) => row[2])), shares = bestOf(rows.map((row) => row[3]), true);
  return table(["cost", "observations", "median error of its minimum, deg", "within 10 deg", "local minima"],
    rows.map(([name, observations, error, share, minima]) => [name, String(observations),
      { text: number(error, 1), best: error === errors },
      { text: `${number(100 * share, 0)} %`, best: share === shares }, number(minima, 1)]));
}

function curveFigures(page, variants) {
  return variants.flatMap((variant) => {
    if (variant.curves.length === 0) return [];
    const { detections, objects, frames } = page.sequences[variant.sequence];
    const charts = firstOfEachObject(page, variant).slice(0, 4).map((record) => {
      const { object, frame } = detections[record.detection];
      return element("figure", {}, yawChart(record),
        element("figcaption", {}, `${objects[object].label} ${objects[object].id}, frame ${frames[frame].id}`));
    });
    return [element("h3", {}, variant.name), descriptorTable(variant), element("div", { class: "wide" }, charts)];
  });
}

// One variant for each way in which curves were made: others share them.
function variantsWithCurves(page) {
  return page.variants.filter((variant) => variant.kind === "frames" && variant.curves.length > 0);
}

function figuresSection(page) {
  const curved = variantsWithCurves(page);
  const pairs = pairFigures(page, curved);
  const content = [
    ...figure("Samples and mirrored pairs", "Samples are orange, the pixels that the mirror plane of the estimate takes them to blue (fig. 5 of the paper).",
      pairs.length > 0 ? [element("div", { class: "grid" }, pairs)] : []),
    ...figure("Single-frame initialisation", "The first observations of some objects (fig. 6): detection dashed, ground truth green, estimate blue with its front orange.",
      comparison(page, ["Init1-1", "InitP", "InitS", "InitSTE"], 3)),
    ...figure("Cost over yaw", "Each curve over its own range (fig. 7). A descriptor is good where its lowest minimum is at the true yaw, or half a turn from it, and where it has few others. The tables count all observations: how far the lowest minimum is from the truth, modulo half a turn.",
      curveFigures(page, curved)),
    ...figure("Before and after symmetry", "The same observations before the yaw is refined and after (fig. 8).",
      [...comparison(page, ["InitP", "InitPT"], 3), ...comparison(page, ["InitS", "InitST", "InitSTE"], 3)]),
  ];
  return content.length === 0 ? null : section("figures", "Figures", ...content);
}
