"use strict";
// All frames, one at a time.

function framesSection(page, variants) {
  const holder = element("div");
  const shown = { estimate: true, box: false, truth: true, detection: true, grid: true };
  let variant = variants[0], at = 0;
  const framesOf = () => page.sequences[variant.sequence].frames
    .map((frame, index) => ({ frame, index })).filter(({ frame }) => page.images[frame.id]);
  const caption = element("span", { class: "faint" });

  const draw = () => {
    const frames = framesOf();
    if (frames.length === 0) return;
    at = Math.min(at, frames.length - 1);
    const { frame, index } = frames[at];
    const sequence = page.sequences[variant.sequence];
    const shapes = shown.grid
      ? frame.grid.map((pixels) => line(pixels, "truth", { "stroke-width": 0.8, "stroke-opacity": 0.45 })) : [];
    sequence.detections.forEach((detection, i) => {
      if (detection.frame !== index) return;
      if (shown.detection) shapes.push(boxOutline(detection.box, "detection"));
      if (shown.truth && detection.truth && detection.truth.outline.length > 0) {
        shapes.push(polygon(detection.truth.outline, "truth"));
      }
      const estimate = variant.outlines[i];
      if (shown.estimate) shapes.push(...estimateShapes(estimate, "estimate"));
      if (shown.box && estimate && estimate.outline.length > 0) {
        shapes.push(boxOutline(boundsOf(estimate.outline), "estimate"));
      }
    });
    caption.textContent = `frame ${frame.id}, ${at + 1} of ${frames.length}, ${frame.timestamp.toFixed(2)} s`;
    holder.replaceChildren(imageView(page, frame, null, shapes, `frame ${frame.id}`));
  };
  const toggle = (label, name, key) =>
    checkbox(label, key, shown[name], (on) => { shown[name] = on; draw(); });
  const controls = element("div", { class: "bar" },
    chooser("variant", variants.map(({ name }) => name), 0, (i) => { variant = variants[i]; draw(); }),
    slider("frame", framesOf().length, 0, (i) => { at = i; draw(); }), caption,
    toggle("estimate", "estimate", "estimate"), toggle("its box", "box", "estimate"),
    toggle("ground truth", "truth", "truth"), toggle("detection", "detection", "detection"),
    toggle("support planes", "grid", "truth"));
  const note = Object.keys(page.images).length === 0
    ? element("p", { class: "faint" }, "The images of this dataset were not there when the page was made.") : null;
  return section("frames", "Frames",
    element("p", {}, "Detections are dashed. Thick ends point to the object's front: its mirror plane " +
      "is the one through it. Estimates over several frames are seen from the estimated camera, the ground truth from the true one."),
    controls, note, holder);
}
