"use strict";

// What has most to show first: maps, and of each kind what uses most.
function byInterest(variants) {
  const kinds = ["map", "views", "frames"];
  const names = ["OursSTE", "OursST", "OursS", "OursPT", "OursP", "InitSTE", "InitST", "InitS", "InitPT", "InitP"];
  const rank = ({ name, kind }) =>
    100 * kinds.indexOf(kind) + (names.includes(name) ? names.indexOf(name) : names.length);
  return [...variants].sort((one, other) => rank(one) - rank(other));
}

function contents(sections) {
  return element("nav", {}, sections.map((part) =>
    element("a", { href: `#${part.id}` }, part.querySelector("h2").textContent)));
}

function convergenceSection(page) {
  const maps = page.variants.filter(({ solver }) => solver);
  if (maps.length === 0) return null;
  const list = (counts) => Object.entries(counts).map(([name, count]) => `${name} ${count}`).join(", ");
  return section("convergence", "Convergence", convergenceChart(maps),
    element("p", { class: "faint" }, "Where texture and edges join in the cost rises: from there on it is that of a larger problem."),
    table(["variant", "iterations", "converged", "residuals", "left out"], maps.map(({ name, solver }) =>
      [name, String(solver.iterations), solver.converged ? "yes" : "no", list(solver.residuals), list(solver.gated)])));
}

function showDataset(page, holder) {
  const variants = byInterest(page.variants);
  const sequence = page.sequences[0];
  const rejected = Object.entries(sequence.rejected).map(([reason, count]) => `${count} ${reason.replaceAll("_", " ")}`);
  const sections = [metricsSection(page), mapSection(page, variants), framesSection(page, variants),
    objectsSection(page, variants), figuresSection(page), ablationSection(page), convergenceSection(page)].filter(Boolean);
  holder.append(element("h1", {}, page.dataset),
    element("p", { class: "faint" }, `${sequence.frames.length} frames, ${sequence.objects.length} objects, ` +
      `${sequence.detections.length} detections used` + (rejected.length > 0 ? `; not used: ${rejected.join(", ")}` : "")),
    contents(sections), ...sections);
}

function showOverview(data, holder) {
  holder.append(element("h1", {}, "Results"), ...data.datasets.map((dataset) =>
    section(dataset.dataset, dataset.dataset,
      element("p", {}, `${dataset.frames} frames, ${dataset.objects} objects, ${dataset.detections} detections. `,
        element("a", { href: `./${encodeURIComponent(dataset.dataset)}/report.html` }, "Look at it")),
      metricsTable(dataset.variants))));
}
