"use strict";
// Objects: their numbers, and the observations that these come from.

function metricsOfObject(page, variant, objectIndex) {
  const { id } = page.sequences[variant.sequence].objects[objectIndex];
  return variant.metrics.objects.find(({ object }) => object === id);
}

function objectNumbers(page, variant, index) {
  const object = page.sequences[variant.sequence].objects[index];
  const estimate = variant.objects[index];
  const metrics = metricsOfObject(page, variant, index);
  const triple = (values, decimals) => values.map((value) => number(value, decimals)).join(", ");
  const rows = [["variant", variant.name], ["observations", String(estimate.observations)]];
  if (estimate.landmark) {
    rows.push(["centre, m", triple(estimate.landmark.pose.slice(0, 3), 2)]);
    rows.push(["half axes, m", triple(estimate.landmark.half_axes, 2)]);
    rows.push(["shape exponent", number(estimate.landmark.p, 2)]);
  } else {
    rows.push(["no landmark", estimate.failure]);
  }
  if (estimate.sigma_centre) {
    rows.push(["sigma of centre, m", triple(estimate.sigma_centre, 3)]);
    rows.push(["sigma of half axes, %", triple(estimate.sigma_log_half_axes.map((value) => 100 * value), 1)]);
    rows.push(["sigma of yaw, °", number(estimate.sigma_yaw_deg, 2)]);
  }
  if (object.truth) rows.push(["true half axes, m", triple(object.truth.half_axes, 2)]);
  if (metrics) {
    rows.push(["IoU", number(metrics.iou, 3)], ["Rot, °", number(metrics.rotation_deg, 2)],
      ["yaw error, °", number(metrics.yaw_error_deg, 2)], ["centre error, m", number(metrics.centre_m, 3)]);
  }
  return [element("strong", {}, `${object.label} ${object.id}`), quantityRows(rows),
    element("a", { href: "#evidence", onclick: () => page.showEvidence(variant, index) }, "its observations")];
}

function evidence(page, variant, index) {
  const sequence = page.sequences[variant.sequence];
  const object = sequence.objects[index];
  const seen = sequence.detections.map((detection, i) => ({ detection, i })).filter(({ detection }) => detection.object === index);
  const kViews = 8;
  const views = seen.filter((_, i) => i % Math.ceil(seen.length / kViews) === 0);
  const frameOf = (i) => sequence.frames[sequence.detections[i].frame].id;
  const curves = curvesOf(page, variant).filter(({ detection }) => sequence.detections[detection].object === index);
  const title = views.length === 0 ? "none of its observations is in a frame that is shown"
    : `${views.length} of its observations`;
  return [
    element("h3", {}, `${object.label} ${object.id}, ${variant.name}: ${title}`),
    element("div", { class: "grid" }, views.map(({ i }) => element("figure", {},
      detectionView(page, variant, i, `${object.label} in frame ${frameOf(i)}`),
      element("figcaption", {}, `frame ${frameOf(i)}`)))),
    element("div", { class: "wide" }, curves.map((record) => element("figure", {},
      yawStrips(record, "cost over yaw"), element("figcaption", {}, `cost over yaw, frame ${frameOf(record.detection)}`)))),
  ];
}

function failureOf(estimate) {
  return ((estimate && estimate.failure) || "").replaceAll("_", " ");
}

function objectRow(object, { metrics, estimate }, onchoice) {
  return [element("button", { class: "link", onclick: onchoice }, `${object.label} ${object.id}`),
    String(metrics ? metrics.observations : estimate.observations),
    number(metrics && metrics.iou, 3), number(metrics && metrics.centre_m, 3),
    number(metrics && metrics.rotation_deg, 2), number(metrics && metrics.yaw_error_deg, 2),
    number(estimate && estimate.sigma_yaw_deg, 2), failureOf(estimate)];
}

// Objects that were observed: with the lowest IoU first, without one last.
function worstFirst(page, variant) {
  const iou = ({ metrics }) => (metrics && metrics.iou != null ? metrics.iou : 2);
  return page.sequences[variant.sequence].objects
    .map((_, i) => ({ i, metrics: metricsOfObject(page, variant, i), estimate: variant.objects[i] }))
    .filter(({ metrics, estimate }) => (metrics && metrics.observations > 0) || estimate.landmark)
    .sort((one, other) => iou(one) - iou(other));
}

function objectsSection(page, variants) {
  const rowsHolder = element("div"), evidenceHolder = element("div", { id: "evidence" });
  page.showEvidence = (variant, index) => {
    evidenceHolder.replaceChildren(...evidence(page, variant, index));
    rowsHolder.querySelectorAll("tr[data-object]").forEach((row) =>
      row.classList.toggle("chosen", Number(row.dataset.object) === index));
  };
  const draw = (variant) => {
    const { objects, detections } = page.sequences[variant.sequence];
    const order = worstFirst(page, variant);
    const header = ["object", "observations", "IoU", "centre error, m", "Rot, °", "yaw error, °", "yaw sigma, °"];
    if (order.some(({ estimate }) => failureOf(estimate))) header.push("no landmark");
    rowsHolder.replaceChildren(table(header,
      order.map((entry) => objectRow(objects[entry.i], entry, () => page.showEvidence(variant, entry.i)).slice(0, header.length)),
      (k) => ({ "data-object": order[k].i })));
    evidenceHolder.replaceChildren();
    const seen = new Set(detections.map(({ object }) => object));
    const first = order.find(({ i }) => seen.has(i));
    if (first) page.showEvidence(variant, first.i);
  };
  const choose = chooser("variant", variants.map(({ name }) => name), 0, (i) => draw(variants[i]));
  return section("objects", "Objects", element("p", {}, "Worst first. Choose one to see what it was estimated from."),
    element("div", { class: "bar" }, choose), element("div", { class: "long" }, rowsHolder), evidenceHolder);
}
