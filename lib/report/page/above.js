"use strict";
// The map from above.

function rotate([x, y, z, w], v) {
  // v + 2 q x (q x v + w v)
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const q = [x, y, z];
  const inner = cross(q, v).map((part, i) => part + w * v[i]);
  return cross(q, inner).map((part, i) => v[i] + 2 * part);
}

// Two horizontal axes of a segment's world.
function groundAxes(sequence, segment) {
  const { up } = sequence.segments[segment];
  const least = up.map(Math.abs).indexOf(Math.min(...up.map(Math.abs)));
  const helper = [0, 1, 2].map((i) => (i === least ? 1 : 0));
  const dot = (a, b) => a.reduce((sum, part, i) => sum + part * b[i], 0);
  const right = helper.map((part, i) => part - dot(helper, up) * up[i]);
  const size = Math.hypot(...right);
  const x = right.map((part) => part / size);
  const y = [up[1] * x[2] - up[2] * x[1], up[2] * x[0] - up[0] * x[2], up[0] * x[1] - up[1] * x[0]];
  return { x, y, place: (point) => ({ x: dot(point, x), y: dot(point, y) }) };
}

// Andrew's monotone chain.
function convexHull(points) {
  const sorted = [...points].sort((p, q) => p.x - q.x || p.y - q.y);
  const turnsLeft = (a, b, c) => (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x) > 0;
  const chain = (ordered) => {
    const kept = [];
    for (const point of ordered) {
      while (kept.length > 1 && !turnsLeft(kept[kept.length - 2], kept[kept.length - 1], point)) kept.pop();
      kept.push(point);
    }
    return kept.slice(0, -1);
  };
  return [...chain(sorted), ...chain(sorted.reverse())];
}

// The footprint of the cuboid around a body in any orientation, and the line from its centre to its front.
function footprint(landmark, ground) {
  const centre = landmark.pose.slice(0, 3), turn = landmark.pose.slice(3);
  const place = (signs) => ground.place(
    rotate(turn, signs.map((sign, i) => sign * landmark.half_axes[i])).map((part, i) => part + centre[i]));
  const corners = [-1, 1].flatMap((u) => [-1, 1].flatMap((v) => [-1, 1].map((w) => place([u, v, w]))));
  const hull = convexHull(corners);
  return { outline: [...hull, hull[0]], centre: place([0, 0, 0]), front: [place([0, 0, 0]), place([1, 0, 0])] };
}

// Two standard deviations of the centre, projected to the ground.
function uncertaintyEllipse(object, ground) {
  const rows = object.centre_covariance;
  const project = (u, v) => u.reduce((sum, ui, i) => sum + v.reduce((inner, vk, k) => inner + ui * rows[i][k] * vk, 0), 0);
  const xx = project(ground.x, ground.x), xy = project(ground.x, ground.y), yy = project(ground.y, ground.y);
  const l11 = Math.sqrt(Math.max(0, xx)), l21 = l11 > 0 ? xy / l11 : 0;
  const l22 = Math.sqrt(Math.max(0, yy - l21 * l21));
  const centre = ground.place(object.landmark.pose.slice(0, 3));
  return Array.from({ length: 37 }, (_, i) => {
    const c = 2 * Math.cos(i * Math.PI / 18), s = 2 * Math.sin(i * Math.PI / 18);
    return { x: centre.x + l11 * c, y: centre.y + l21 * c + l22 * s };
  });
}

// Equal scales on both axes: the axis with more room shows a larger range.
const kEqualScales = {
  id: "equal_scales",
  afterLayout(chart) {
    const { x, y } = chart.scales;
    const per = [x.width / (x.max - x.min), y.height / (y.max - y.min)];
    const loose = per[0] > per[1] ? x : y;
    const middle = (loose.min + loose.max) / 2;
    const half = (loose === x ? x.width : y.height) / Math.min(...per) / 2;
    if (half - (loose.max - loose.min) / 2 < 1e-6 * half) return;
    loose.options.min = middle - half;
    loose.options.max = middle + half;
    requestAnimationFrame(() => { if (chart.canvas) chart.update("none"); });  // unless it is gone by then
  },
};

// Names below their objects, if there is room for them.
function namesOf(named) {
  return {
    id: "names",
    afterDatasetsDraw({ ctx, width, scales: { x, y } }) {
      if (width < 20 * named.length || width < 500) return;
      ctx.save();
      Object.assign(ctx, { font: "11px system-ui, sans-serif", fillStyle: colour("ink"), textAlign: "center",
        strokeStyle: colour("paper"), lineWidth: 3, lineJoin: "round" });
      for (const { name, outline } of named) {
        const at = [x.getPixelForValue((Math.min(...outline.map((p) => p.x)) + Math.max(...outline.map((p) => p.x))) / 2),
          y.getPixelForValue(Math.min(...outline.map((p) => p.y))) + 13];
        ctx.strokeText(name, ...at);
        ctx.fillText(name, ...at);
      }
      ctx.restore();
    },
  };
}

function objectsFromAbove(sequence, variant, segment, ground) {
  const datasets = [], named = [], rows = [];
  sequence.objects.forEach((object, i) => {
    if (object.segment !== segment) return;
    const name = `${object.label} ${object.id}`;
    const add = (label, points, key, more) => datasets.push(curve(label, points, colour(key), { object: name, ...more }));
    const place = (body) => {
      const { x, y } = body ? ground.place(body.pose.slice(0, 3)) : {};
      return [number(x, 2), number(y, 2)];
    };
    const estimate = variant.objects[i];
    const landmark = estimate && estimate.landmark;
    rows.push([name, ...place(landmark), ...place(object.truth)]);
    if (object.truth) {
      const { outline, front } = footprint(object.truth, ground);
      add("ground truth", outline, "truth", { borderWidth: 1.5 });
      add("its true front", front, "truth", { borderWidth: 1.5 });
      if (!landmark) named.push({ name, outline });
    }
    if (!landmark) return;
    const { outline, front } = footprint(landmark, ground);
    named.push({ name, outline });
    add("estimate", outline, "estimate");
    add("its front", front, "front", { borderWidth: 3 });
    if (estimate.centre_covariance) {
      add("two standard deviations of its centre", uncertaintyEllipse(estimate, ground), "other", { borderWidth: 1.5 });
    }
  });
  return { datasets, named, numbers: table(["object", "x, m", "y, m", "true x, m", "true y, m"], rows) };
}

function topDownChart(page, variant, segment) {
  const sequence = page.sequences[variant.sequence];
  const ground = groundAxes(sequence, segment);
  const { datasets, named, numbers } = objectsFromAbove(sequence, variant, segment, ground);
  const poses = variant.trajectory || sequence.frames.map(({ pose }) => pose);
  const here = poses.filter((_, i) => sequence.frames[i].segment === segment);
  datasets.push(curve("camera", here.map((pose) => ground.place(pose.slice(0, 3))), colour("detection")));
  const all = datasets.flatMap(({ data }) => data);
  const range = (of) => {
    const values = all.map(of);
    const [low, high] = [Math.min(...values), Math.max(...values)];
    const margin = 0.2 + 0.03 * (high - low);
    return [low - margin, high + margin];
  };
  const [x1, x2] = range(({ x }) => x), [y1, y2] = range(({ y }) => y);
  const size = `aspect-ratio: ${(x2 - x1) / (y2 - y1)}; min-height: 260px; max-height: 560px`;
  return chart("the map from above", size, { type: "scatter", data: { datasets }, plugins: [kEqualScales, namesOf(named)], options: {
    scales: { x: axis("m", { min: x1, max: x2 }), y: axis("m", { min: y1, max: y2 }) },
    plugins: { legend: legend(({ text, datasetIndex }) =>
      text !== "its true front" && datasets.findIndex(({ label }) => label === text) === datasetIndex),
      tooltip: { enabled: false } } } }, numbers);
}
