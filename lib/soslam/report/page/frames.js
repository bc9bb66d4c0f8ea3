"use strict";
// All frames that are shown, one at a time.

function shapesInFrame(page, variant, frameIndex, shown) {
  const sequence = page.sequences[variant.sequence];
  const grid = variant.grids ? variant.grids[frameIndex] : sequence.frames[frameIndex].grid;
  const shapes = shown.grid ? grid.map((pixels) => line(pixels, "grid", { "stroke-width": 1, "stroke-opacity": 0.55 })) : [];
  sequence.detections.forEach((detection, i) => {
    if (detection.frame !== frameIndex) return;
    if (shown.detection) shapes.push(boxOutline(detection.box, "detection"));
    if (shown.truth && detection.truth && detection.truth.outline.length > 0) {
      shapes.push(polygon(detection.truth.outline, "truth"));
    }
    const estimate = variant.outlines[i];
    if (shown.estimate) shapes.push(...estimateShapes(estimate, "estimate"));
    if (shown.box && estimate && estimate.outline.length > 0) {
      shapes.push(boxOutline(boundsOf(estimate.outline), "estimate"));
    }
    if (shown.points && variant.points) {
      shapes.push(...pointShapes(variant.points[i], sequence.frames[frameIndex].width / 250));
    }
  });
  return shapes;
}

function framesSection(page, variants) {
  const holder = element("div"), caption = element("span", { class: "faint" });
  const shown = { estimate: true, box: false, truth: true, detection: true, grid: true, points: true };
  const havePoints = variants.some(({ points }) => points);
  const detections = page.sequences[variants[0].sequence].detections;
  let variant = variants[0];
  const framesOf = () => page.sequences[variant.sequence].frames
    .map((frame, index) => ({ frame, index })).filter(({ frame }) => frame.shown);
  // One in which there is something to see.
  let at = Math.max(0, framesOf().findIndex(({ index }) => detections.some(({ frame }) => frame === index)));
  const draw = () => {
    const frames = framesOf();
    if (frames.length === 0) return;
    const { frame, index } = frames[at];
    const begin = page.sequences[variant.sequence].frames.find(({ segment }) => segment === frame.segment);
    const seconds = frame.timestamp - begin.timestamp;
    caption.textContent = `frame ${frame.id}, ${at + 1} of ${frames.length}, ${seconds.toFixed(2)} s`;
    const view = imageView(page, frame, null, shapesInFrame(page, variant, index, shown), `frame ${frame.id}`);
    view.style.maxWidth = `${78 * frame.width / frame.height}vh`;  // so that it is seen with its slider
    holder.replaceChildren(view);
  };
  const { input, setCount } = slider("frame", (i) => { at = i; draw(); });
  const choose = variantChooser(variants, (chosen) => {
    variant = chosen;
    at = Math.max(0, Math.min(at, framesOf().length - 1));
    setCount(framesOf().length, at);
    draw();
  });
  const toggle = (label, name, key) =>
    checkbox(label, key, shown[name], (on) => { shown[name] = on; draw(); });
  const note = Object.keys(page.images).length === 0
    ? element("p", { class: "faint" }, "There were no images of this dataset where the page was made.") : null;
  return section("frames", "Frames",
    element("p", {}, "Detections are dashed, the thick axis of an estimate leads through its front and back, with an arrow head at the front where that is known. " +
      (page.has_true_objects ? "Estimates over several frames are seen from the estimated camera, the ground truth from the true one."
        : "Estimates over several frames are seen from the estimated camera.") +
      (havePoints ? " Dots are sparse points that may be of an object: the fuller, the more probably they are of it, and not of what is behind it or in front." : "")), note,
    element("div", { class: "bar on-image" }, choose, toggle("estimate", "estimate", "estimate"), toggle("its box", "box", "estimate"),
      page.has_true_objects ? toggle("ground truth", "truth", "truth") : null, toggle("detection", "detection", "detection"),
      toggle("support planes", "grid", "grid"), havePoints ? toggle("points", "points", "point") : null),
    element("div", { class: "bar" }, input, caption), holder);
}
