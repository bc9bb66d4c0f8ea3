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

function convergenceSection(variants) {
  const maps = variants.filter(({ solver }) => solver);
  if (maps.length === 0) return null;
  const list = (counts) => Object.entries(counts).map(([name, count]) => `${name} ${count}`).join(", ");
  return section("convergence", "Convergence", convergenceChart(maps),
    element("p", { class: "faint" }, "Where texture and edges join in the cost rises: from there on it is that of a larger problem."),
    table(["variant", "iterations", "converged", "residuals", "left out"], maps.map(({ name, solver }) =>
      [name, String(solver.iterations), solver.converged ? "yes" : "no", list(solver.residuals), list(solver.gated)])));
}

function counted(count, what) {
  return `${count} ${what}${count === 1 ? "" : "s"}`;
}

function showDataset(page, holder) {
  const detailed = byInterest(page.variants.filter(({ numbers_only }) => !numbers_only));
  const { counts, rejected } = page.sequences[0];
  const shown = page.sequences[0].frames.filter(({ shown }) => shown).length;
  const reasons = Object.entries(rejected).map(([reason, count]) => `${count} ${reason.replaceAll("_", " ")}`);
  const sections = [metricsSection(page),
    ...(detailed.length === 0 ? [] : [mapSection, framesSection, objectsSection, figuresSection].map((make) => make(page, detailed))),
    ablationSection(page), convergenceSection(detailed)].filter(Boolean);
  holder.append(element("h1", {}, page.dataset),
    element("p", { class: "faint" }, counted(counts.frames, "frame") + (shown < counts.frames ? `, ${shown} of them shown, ` : ", ") +
      `${counted(counts.objects, "object")}, ${counted(counts.detections, "detection")} used` + (reasons.length > 0 ? `; not used: ${reasons.join(", ")}` : "")),
    ...remarks(page), contents(sections), ...sections);
}

function showOverview(data, holder) {
  holder.append(element("h1", {}, "Results"), ...data.datasets.map((dataset) => {
    const { counts, variants } = dataset;
    const about = counts == null ? "Nothing of it can be shown."
      : [`${counted(counts.frames, "frame")}, ${counted(counts.objects, "object")}, ${counted(counts.detections, "detection")}. `,
        element("a", { href: `./${dataset.url}/report.html` }, "Map, frames, objects and figures")];
    return section(dataset.url, dataset.dataset, element("p", {}, about), ...remarks(dataset),
      ...(variants.length > 0 ? [metricsTable(variants)] : []));
  }));
}
