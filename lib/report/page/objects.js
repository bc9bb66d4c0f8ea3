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
    rows.push(["sigma of yaw, deg", number(estimate.sigma_yaw_deg, 2)]);
  }
  if (object.truth) rows.push(["true half axes, m", triple(object.truth.half_axes, 2)]);
  if (metrics) {
    rows.push(["IoU", number(metrics.iou, 3)], ["Rot, deg", number(metrics.rotation_deg, 2)],
      ["yaw error, deg", number(metrics.yaw_error_deg, 2)], ["centre error, m", number(metrics.centre_m, 3)]);
  }
  return [element("strong", {}, `${object.label} ${object.id}`), quantityRows(rows),
    element("a", { href: "#evidence", onclick: () => page.showEvidence(variant, index) }, "its observations")];
}

function evidence(page, variant, index) {
  const sequence = page.sequences[variant.sequence];
  const object = sequence.objects[index];
  const seen = sequence.detections.map((detection, i) => ({ detection, i }))
    .filter(({ detection }) => detection.object === index && page.images[sequence.frames[detection.frame].id]);
  const kViews = 8;
  const views = seen.filter((_, i) => i % Math.ceil(seen.length / kViews) === 0);
  const curves = variant.curves.filter(({ detection }) => sequence.detections[detection].object === index);
  return [
    element("h3", {}, `${object.label} ${object.id}, ${variant.name}: ${views.length} of its ${seen.length} observations with an image`),
    element("div", { class: "grid" }, views.map(({ detection, i }) => {
      const frame = sequence.frames[detection.frame];
      return element("figure", {}, detectionView(page, variant, i, [], `${object.label} in frame ${frame.id}`),
        element("figcaption", {}, `frame ${frame.id}`));
    })),
    element("div", { class: "wide" }, curves.map((record) => element("figure", {}, yawChart(record),
      element("figcaption", {}, `cost over yaw, frame ${sequence.frames[sequence.detections[record.detection].frame].id}`)))),
  ];
}

function objectsSection(page, variants) {
  const rowsHolder = element("div"), evidenceHolder = element("div", { id: "evidence" });
  page.showEvidence = (variant, index) => {
    evidenceHolder.replaceChildren(...evidence(page, variant, index));
    rowsHolder.querySelectorAll("tr[data-object]").forEach((row) =>
      row.classList.toggle("chosen", Number(row.dataset.object) === index));
  };
  const draw = (variant) => {
    const { objects } = page.sequences[variant.sequence];
    const order = objects.map((_, i) => i)
      .map((i) => ({ i, metrics: metricsOfObject(page, variant, i), estimate: variant.objects[i] }))
      .filter(({ metrics, estimate }) => metrics || (estimate && estimate.landmark))
      .sort((one, other) => (one.metrics ? one.metrics.iou : 2) - (other.metrics ? other.metrics.iou : 2));
    const rows = order.map(({ i, metrics, estimate }) => [
      `${objects[i].label} ${objects[i].id}`,
      String(metrics ? metrics.observations : estimate.observations),
      number(metrics && metrics.iou, 3), number(metrics && metrics.centre_m, 3),
      number(metrics && metrics.rotation_deg, 2), number(metrics && metrics.yaw_error_deg, 2),
      number(estimate && estimate.sigma_yaw_deg, 2), (estimate && estimate.failure) || ""]);
    rowsHolder.replaceChildren(table(
      ["object", "observations", "IoU", "centre error m", "Rot deg", "yaw error deg", "yaw sigma deg", "no landmark"],
      rows, (k) => ({ "data-object": order[k].i, tabindex: 0,
        onclick: () => page.showEvidence(variant, order[k].i) })));
    if (order.length > 0) page.showEvidence(variant, order[0].i);
  };
  return section("objects", "Objects", element("p", {}, "Worst first. Choose one to see what it was estimated from."),
    element("div", { class: "bar" }, chooser("variant", variants.map(({ name }) => name), 0, (i) => draw(variants[i]))),
    rowsHolder, evidenceHolder);
}
