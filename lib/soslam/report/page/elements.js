"use strict";
// Making elements, and numbers as people read them.

function element(tag, attributes, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes || {})) {
    if (name.startsWith("on")) made.addEventListener(name.slice(2), value);
    else if (value === true) made.setAttribute(name, "");
    else if (value !== false && value != null) made.setAttribute(name, value);
  }
  made.append(...children.flat().filter((child) => child != null));
  return made;
}

function svgElement(tag, attributes, ...children) {
  const made = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes || {})) made.setAttribute(name, value);
  made.append(...children.flat());
  return made;
}

function number(value, decimals) {
  return value == null || !Number.isFinite(value) ? "–" : value.toFixed(decimals);
}

function colour(name) {
  return getComputedStyle(document.documentElement).getPropertyValue("--" + name).trim();
}

function section(id, title, ...children) {
  return element("section", { id }, element("h2", {}, title), ...children);
}

// Calls onchoice(variant, index) for the first one at once and for every choice.
function variantChooser(variants, onchoice) {
  const choose = (i) => onchoice(variants[i], i);
  const select = element("select", { onchange: () => choose(select.selectedIndex) },
    variants.map(({ name }) => element("option", {}, name)));
  choose(0);
  return element("label", {}, "variant", select);
}

function checkbox(label, key, checked, onchange) {
  const input = element("input", { type: "checkbox", checked, onchange: () => onchange(input.checked) });
  return element("label", {}, input,
    key ? element("span", { class: "key", style: `background: var(--${key})` }) : null, label);
}

// Positions 0 to count - 1: made for none, until setCount says how many there are.
function slider(label, onchange) {
  const input = element("input", { type: "range", min: 0, max: 0, value: 0, "aria-label": label,
    oninput: () => onchange(Number(input.value)) });
  const setCount = (count, at) => {
    input.max = Math.max(0, count - 1);
    input.value = at;
    input.disabled = count < 2;
  };
  return { input, setCount };
}

// rows: arrays of cells, each a text or {text, best}.
function table(header, rows) {
  const cell = (content) => typeof content === "object" && content !== null && !(content instanceof Node)
    ? element("td", { class: content.best ? "best" : null }, content.text)
    : element("td", {}, content);
  return element("div", { class: "scroll" }, element("table", {},
    element("thead", {}, element("tr", {}, header.map((name) => element("th", {}, name)))),
    element("tbody", {}, rows.map((row) => element("tr", {}, row.map(cell))))));
}

function quantityRows(pairs) {
  return element("dl", {}, pairs.flatMap(([name, value]) =>
    [element("dt", {}, name), element("dd", {}, value)]));
}
