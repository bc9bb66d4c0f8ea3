"use strict";
// One frame's image with what was detected and estimated in it. Pixels: (0, 0) is the centre of the
// top-left one, so that the image begins at -0.5.

// Object URLs by frame: the browser then decodes an image once for all of its views.
const imageUrls = {};
function imageUrl(page, frameId) {
  const source = page.images[frameId];
  if (!source) return null;
  if (!imageUrls[frameId]) {
    const bytes = Uint8Array.from(atob(source.split(",")[1]), (letter) => letter.charCodeAt(0));
    imageUrls[frameId] = URL.createObjectURL(new Blob([bytes], { type: "image/jpeg" }));
  }
  return imageUrls[frameId];
}

function polygon(pixels, name, attributes) {
  return svgElement("polygon", Object.assign(
    { points: pixels.join(" "), fill: "none", stroke: `var(--${name})`, "stroke-width": 2 }, attributes));
}

function line(pixels, name, attributes) {
  const [x1, y1, x2, y2] = pixels;
  return svgElement("line", Object.assign(
    { x1, y1, x2, y2, stroke: `var(--${name})`, "stroke-width": 1.5 }, attributes));
}

function boxOutline([x1, y1, x2, y2], name) {
  return polygon([x1, y1, x2, y1, x2, y2, x1, y2], name, { "stroke-dasharray": "5 3", "stroke-width": 1.5 });
}

// The box around pixels, as OutlineBox has it of the outline.
function boundsOf(pixels) {
  const xs = pixels.filter((_, i) => i % 2 === 0);
  const ys = pixels.filter((_, i) => i % 2 === 1);
  return [Math.min(...xs), Math.min(...ys), Math.max(...xs), Math.max(...ys)];
}

// The head of an arrow along a line, in proportion to its length.
function arrowHead([x1, y1, x2, y2], name, title) {
  const [dx, dy] = [(x2 - x1) / 10, (y2 - y1) / 10];
  const head = polygon([x2 + dx, y2 + dy, x2 - dx - dy, y2 - dy + dx, x2 - dx + dy, y2 - dy - dx], name,
    { fill: `var(--${name})` });
  head.append(svgElement("title", {}, title));
  return head;
}

// Outline and axes: the thick one leads through front and back, to the front where there is a head.
function estimateShapes(shown, name) {
  if (!shown || shown.outline.length === 0) return [];
  const shapes = [polygon(shown.outline, name, { "fill": `var(--${name})`, "fill-opacity": 0.12 })];
  if (shown.axes) {
    shapes.push(line(shown.axes[0], "front", { "stroke-width": 3.5, "stroke-linecap": "round" }));
    if (shown.front !== undefined) {
      shapes.push(arrowHead(shown.axes[0], "front", `front, probability ${number(shown.front, 2)}`));
    }
    for (const axis of shown.axes.slice(1)) shapes.push(line(axis, name, { "stroke-width": 1.5 }));
  }
  return shapes;
}

// Sparse points of a detection: the fuller, the more probably of the object.
function pointShapes(points, radius) {
  const shapes = [];
  for (let i = 0; points && i < points.length; i += 3) {
    shapes.push(svgElement("circle", { cx: points[i], cy: points[i + 1], r: radius, fill: "var(--point)",
      "fill-opacity": points[i + 2] / 100, stroke: "var(--point)", "stroke-width": radius / 3 }));
  }
  return shapes;
}

// crop: [x1, y1, x2, y2] px or null for all of it.
function imageView(page, frame, crop, shapes, label) {
  const [x1, y1, x2, y2] = crop || [-0.5, -0.5, frame.width - 0.5, frame.height - 0.5];
  const view = svgElement("svg",
    { class: "view on-image", viewBox: `${x1} ${y1} ${x2 - x1} ${y2 - y1}`, role: "img", "aria-label": label });
  view.style.aspectRatio = `${x2 - x1} / ${y2 - y1}`;
  const url = imageUrl(page, frame.id);
  if (url) {
    view.append(svgElement("image", { href: url, x: -0.5, y: -0.5, width: frame.width, height: frame.height,
      preserveAspectRatio: "none" }));
  }
  view.append(svgElement("g", { class: "shapes" }, shapes));
  return view;
}

function cropAround(boxes, frame, margin) {
  const x1 = Math.min(...boxes.map((box) => box[0])), y1 = Math.min(...boxes.map((box) => box[1]));
  const x2 = Math.max(...boxes.map((box) => box[2])), y2 = Math.max(...boxes.map((box) => box[3]));
  const wanted = (1 + 2 * margin) * Math.max(x2 - x1, (y2 - y1) * 4 / 3);
  const width = Math.min(wanted, frame.width, frame.height * 4 / 3);
  const height = width * 3 / 4;
  const clamp = (value, size, whole) =>
    Math.min(Math.max(value, -0.5), Math.max(-0.5, whole - 0.5 - size));
  const left = clamp((x1 + x2 - width) / 2, width, frame.width);
  const top = clamp((y1 + y2 - height) / 2, height, frame.height);
  return [left, top, left + width, top + height];
}

// A detection, cut out, with one variant's estimate and, unless other shapes are to be shown, with
// its box and the truth.
function detectionView(page, variant, index, label, otherShapes) {
  const sequence = page.sequences[variant.sequence];
  const detection = sequence.detections[index];
  const frame = sequence.frames[detection.frame];
  const crop = cropAround([detection.box], frame, 0.25);
  const shapes = otherShapes ? otherShapes(crop[2] - crop[0]) : [boxOutline(detection.box, "detection")];
  if (!otherShapes && detection.truth && detection.truth.outline.length > 0) {
    shapes.push(polygon(detection.truth.outline, "truth"));
  }
  if (!otherShapes && variant.points) shapes.push(...pointShapes(variant.points[index], (crop[2] - crop[0]) / 100));
  return imageView(page, frame, crop, [...estimateShapes(variant.outlines[index], "estimate"), ...shapes], label);
}
