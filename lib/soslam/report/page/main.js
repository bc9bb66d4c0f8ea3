"use strict";

function contents(sections) {
  return element("nav", {}, sections.map((part) =>
    element("a", { href: `#${part.id}` }, part.querySelector("h2").textContent)));
}

// Adds to the page's tables what needs scripts.
function showDataset(page) {
  const detailed = page.detailed.map((index) => page.variants[index]);
  const added = (id) => document.getElementById(id);
  if (detailed.length > 0) {
    (added("numbers") || added("remarks")).after(mapSection(page, detailed), framesSection(page, detailed));
    showEvidenceInObjects(added("objects"), page, detailed);
    const figures = figuresSection(page, detailed);
    if (figures) added("objects").after(figures);
    const maps = detailed.filter(({ solver }) => solver);
    if (maps.length > 0) added("stages").append(convergenceChart(maps));
  }
  document.querySelector("main > section").before(contents([...document.querySelectorAll("main > section")]));
}

showDataset(JSON.parse(document.getElementById("data").textContent));
