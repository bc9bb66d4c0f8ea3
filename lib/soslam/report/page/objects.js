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
  const list = (values, decimals) => values.map((value) => number(value, decimals)).join(", ");
  const rows = [["variant", variant.name], ["observations", String(estimate.observations)]];
  if (estimate.landmark) {
    rows.push(["centre, m", list(estimate.landmark.pose.slice(0, 3), 2)]);
    rows.push(["half axes, m", list(estimate.landmark.half_axes, 2)]);
    rows.push(["shape exponents", list(estimate.landmark.p, 2)]);
  } else {
    rows.push(["no landmark", estimate.failure]);
  }
  if (object.labels !== object.label) rows.push(["label", object.labels]);
  if (estimate.sigma_centre) {
    rows.push(["sigma of centre, m", list(estimate.sigma_centre, 3)]);
    rows.push(["sigma of half axes, %", list(estimate.sigma_log_half_axes.map((value) => 100 * value), 1)]);
    rows.push(["sigma of yaw, °", number(estimate.sigma_yaw_deg, 2)]);
  }
  if (estimate.quarter_turn !== undefined) rows.push(["probability that depth and width are exchanged", number(estimate.quarter_turn, 2)]);
  if (estimate.front) rows.push(["probability of its front", number(estimate.front.probability, 2)]);
  if (estimate.points) {
    rows.push(["points", `${estimate.points.count}, of which ${number(estimate.points.of_object, 0)} are of it`]);
  }
  if (object.truth) rows.push(["true half axes, m", list(object.truth.half_axes, 2)]);
  if (metrics && page.has_true_objects) {
    rows.push(["IoU", number(metrics.iou, 3)], ["Rot, °", number(metrics.rotation_deg, 2)],
      ["yaw error, °", number(metrics.yaw_error_deg, 2)], ["centre error, m", number(metrics.centre_m, 3)]);
    if (metrics.front_deg !== undefined) rows.push(["front error, °", number(metrics.front_deg, 2)]);
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

// Shows the table of one variant at a time; each row leads to the object's observations.
function showEvidenceInObjects(holder, page, variants) {
  const tables = [...holder.querySelectorAll("details")].map((details) => {
    details.remove();
    return details.querySelector(".scroll");
  });
  const shown = element("div", { class: "long", tabindex: 0 }), evidenceHolder = element("div", { id: "evidence" });
  page.showEvidence = (variant, index) => {
    evidenceHolder.replaceChildren(...evidence(page, variant, index));
    shown.querySelectorAll("tr[data-index]").forEach((row) =>
      row.classList.toggle("chosen", Number(row.dataset.index) === index));
  };
  variants.forEach((variant, i) => tables[i].querySelectorAll("tr[data-index]").forEach((row) => {
    const [name] = row.cells;
    name.replaceChildren(element("button", { class: "link",
      onclick: () => page.showEvidence(variant, Number(row.dataset.index)) }, name.textContent));
  }));
  const draw = (variant, rows) => {
    shown.replaceChildren(rows);
    evidenceHolder.replaceChildren();
    const seen = new Set(page.sequences[variant.sequence].detections.map(({ object }) => object));
    const first = [...rows.querySelectorAll("tr[data-index]")].find((row) => seen.has(Number(row.dataset.index)));
    if (first) page.showEvidence(variant, Number(first.dataset.index));
  };
  const choose = variantChooser(variants, (variant, i) => draw(variant, tables[i]));
  holder.append(element("p", {}, "Choose an object to see what it was estimated from."),
    element("div", { class: "bar" }, choose), shown, evidenceHolder);
}
