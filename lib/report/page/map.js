"use strict";
// The map in three dimensions, drawn by three.js in the world's own frame.

// A body whose support function is ||(a n1, b n2, c n3)||_p is the unit ball of the norm with the
// exponent q, 1/p + 1/q = 1, scaled by its half axes.
function bodyGeometry(landmark) {
  const [a, b, c] = landmark.half_axes;
  if (landmark.p <= 1.001) return new THREE.BoxBufferGeometry(2 * a, 2 * b, 2 * c);
  const q = landmark.p / (landmark.p - 1);
  const geometry = new THREE.BoxBufferGeometry(2, 2, 2, 14, 14, 14);
  const positions = geometry.attributes.position;
  for (let i = 0; i < positions.count; ++i) {
    const d = [positions.getX(i), positions.getY(i), positions.getZ(i)];
    const size = Math.hypot(...d);
    const norm = Math.pow(d.reduce((sum, part) => sum + Math.pow(Math.abs(part) / size, q), 0), 1 / q);
    positions.setXYZ(i, a * d[0] / size / norm, b * d[1] / size / norm, c * d[2] / size / norm);
  }
  geometry.computeVertexNormals();
  return geometry;
}

function placed(object, pose) {
  object.position.set(pose[0], pose[1], pose[2]);
  object.quaternion.set(pose[3], pose[4], pose[5], pose[6]);
  return object;
}

function threeLine(points, name, opacity) {
  const geometry = new THREE.BufferGeometry()
    .setFromPoints(points.map(([x, y, z]) => new THREE.Vector3(x, y, z)));
  return new THREE.Line(geometry, lineMaterial(name, opacity));
}

function lineMaterial(name, opacity) {
  return new THREE.LineBasicMaterial(
    { color: colour(name), transparent: opacity < 1, opacity: opacity || 1 });
}

function bodyMesh(landmark, name, opacity) {
  const geometry = bodyGeometry(landmark);
  const mesh = new THREE.Mesh(geometry, new THREE.MeshLambertMaterial(
    { color: colour(name), transparent: true, opacity, depthWrite: opacity > 0.4 }));
  const [a, b, c] = landmark.half_axes;
  const box = new THREE.EdgesGeometry(new THREE.BoxBufferGeometry(2 * a, 2 * b, 2 * c));
  mesh.add(new THREE.LineSegments(box, lineMaterial(name, 1)));
  return placed(mesh, landmark.pose);
}

function frontArrow(landmark) {
  const [a] = landmark.half_axes;
  const arrow = new THREE.ArrowHelper(new THREE.Vector3(1, 0, 0), new THREE.Vector3(), 1.35 * a,
    colour("front"), 0.3 * a, 0.2 * a);
  for (const part of arrow.children) {  // drawn last: it shows inside the body as well
    Object.assign(part.material, { depthTest: false, transparent: true });
    part.renderOrder = 1;
  }
  return placed(new THREE.Group().add(arrow), landmark.pose);
}

// Three standard deviations of the centre: x = L u of the unit sphere, L L^T the covariance.
function uncertaintyBody(object) {
  const m = object.centre_covariance;
  const l = [[0, 0, 0], [0, 0, 0], [0, 0, 0]];
  for (let i = 0; i < 3; ++i) {
    for (let k = 0; k <= i; ++k) {
      let rest = m[i][k];
      for (let n = 0; n < k; ++n) rest -= l[i][n] * l[k][n];
      l[i][k] = i === k ? Math.sqrt(Math.max(rest, 0)) : l[k][k] > 0 ? rest / l[k][k] : 0;
    }
  }
  const mesh = new THREE.Mesh(new THREE.SphereBufferGeometry(3, 24, 16),
    new THREE.MeshLambertMaterial({ color: colour("other"), transparent: true, opacity: 0.45, depthTest: false }));
  const [x, y, z] = object.landmark.pose;
  mesh.matrixAutoUpdate = false;
  mesh.matrix.set(l[0][0], 0, 0, x, l[1][0], l[1][1], 0, y, l[2][0], l[2][1], l[2][2], z, 0, 0, 0, 1);
  return mesh;
}

function cameraFrustum(frame, size) {
  const w = 0.5 * size, h = 0.5 * size * frame.height / frame.width;
  const corners = [[-w, -h], [w, -h], [w, h], [-w, h]].map(([x, y]) => [x, y, 0.7 * size]);
  const group = new THREE.Group();
  corners.forEach((corner, i) => {
    group.add(threeLine([[0, 0, 0], corner], "detection", 1));
    group.add(threeLine([corner, corners[(i + 1) % 4]], "detection", 1));
  });
  return group;
}

class MapView {
  constructor(page, onpick) {
    this.page = page;
    this.onpick = onpick;
    this.canvas = element("canvas", { id: "map-canvas", "aria-label": "map in three dimensions" });
    this.renderer = new THREE.WebGLRenderer({ canvas: this.canvas, antialias: true, alpha: true, preserveDrawingBuffer: true });
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(45, 1, 0.01, 1000);
    this.shows = { truth: true, grid: true, trajectory: true };
    const sun = new THREE.DirectionalLight(0xffffff, 0.7);
    this.camera.add(sun);
    this.scene.add(this.camera, new THREE.AmbientLight(0xffffff, 0.6));
    this.content = new THREE.Group();
    this.scene.add(this.content);
    this.pickable = [];
    this.watchPicks();
    new ResizeObserver(() => this.resize()).observe(this.canvas);
  }

  // Every segment has a world of its own: that of the frame is shown.
  show(variant, frameIndex) {
    this.variant = variant;
    this.frameIndex = frameIndex;
    this.sequence = this.page.sequences[variant.sequence];
    const isNew = this.segment !== this.sequence.frames[frameIndex].segment;
    this.segment = this.sequence.frames[frameIndex].segment;
    this.scene.remove(this.content);
    this.content.traverse((part) => {
      if (part.geometry) part.geometry.dispose();
      if (part.material) part.material.dispose();
    });
    this.content = new THREE.Group();
    this.pickable = [];
    this.addObjects();
    if (this.shows.grid) this.addGrid();
    if (this.shows.trajectory) this.addTrajectory();
    this.scene.add(this.content);
    if (isNew) this.lookAtAll();
    this.draw();
  }

  addObjects() {
    this.variant.objects.forEach((estimate, i) => {
      const { truth, segment } = this.sequence.objects[i];
      if (segment !== this.segment) return;
      if (this.shows.truth && truth) this.content.add(bodyMesh(truth, "truth", 0.18));
      if (!estimate || !estimate.landmark) return;
      const mesh = bodyMesh(estimate.landmark, "estimate", i === this.picked ? 0.85 : 0.55);
      mesh.userData.object = i;
      this.pickable.push(mesh);
      this.content.add(mesh, frontArrow(estimate.landmark));
      if (i === this.picked && estimate.centre_covariance) this.content.add(uncertaintyBody(estimate));
    });
  }

  addGrid() {
    const here = new Set(this.sequence.objects.filter(({ segment }) => segment === this.segment).map(({ plane }) => plane));
    for (const plane of this.sequence.planes.filter(({ id }) => here.has(id))) {
      for (const [a, b, c, d, e, f] of plane.grid) {
        this.content.add(threeLine([[a, b, c], [d, e, f]], "faint", 0.35));
      }
    }
  }

  addTrajectory() {
    const { frames } = this.sequence;
    const poses = this.variant.trajectory || frames.map(({ pose }) => pose);
    const isHere = (_, i) => frames[i].segment === this.segment;
    this.content.add(threeLine(poses.filter(isHere).map((pose) => pose.slice(0, 3)), "detection", 1));
    const truth = frames.map(({ true_pose }) => true_pose).filter(isHere);
    if (this.shows.truth && truth.every((pose) => pose)) {
      this.content.add(threeLine(truth.map((pose) => pose.slice(0, 3)), "truth", 0.8));
    }
    const pose = poses[this.frameIndex];
    if (pose) this.content.add(placed(cameraFrustum(frames[this.frameIndex], 0.06 * this.extent() + 0.1), pose));
  }

  extent() {
    return this.bounds().getSize(new THREE.Vector3()).length() || 1;
  }

  bounds() {
    const box = new THREE.Box3();
    for (const { pose, segment } of this.sequence.frames) {
      if (segment === this.segment) box.expandByPoint(new THREE.Vector3(...pose.slice(0, 3)));
    }
    const add = (landmark) => box.expandByPoint(new THREE.Vector3(...landmark.pose.slice(0, 3)));
    this.sequence.objects.forEach(({ truth, segment }, i) => {
      if (segment !== this.segment) return;
      if (truth) add(truth);
      else if (this.variant.objects[i] && this.variant.objects[i].landmark) add(this.variant.objects[i].landmark);
    });
    return box;
  }

  lookAtAll() {
    const up = this.sequence.planes.length > 0 ? this.sequence.planes[0].normal : [0, 0, 1];
    this.camera.up.set(...up);
    const centre = this.bounds().getCenter(new THREE.Vector3());
    const first = new THREE.Vector3(
      ...this.sequence.frames.find(({ segment }) => segment === this.segment).pose.slice(0, 3));
    const back = first.sub(centre).normalize().add(this.camera.up.clone().multiplyScalar(0.8)).normalize();
    this.camera.position.copy(centre).addScaledVector(back, 0.8 * this.extent() + 0.5);
    if (this.controls) this.controls.dispose();
    this.controls = new THREE.OrbitControls(this.camera, this.canvas);
    this.controls.target.copy(centre);
    this.controls.update();
    this.controls.addEventListener("change", () => this.draw());
  }

  watchPicks() {
    let pressed = null;
    this.canvas.addEventListener("pointerdown", (event) => { pressed = [event.clientX, event.clientY]; });
    this.canvas.addEventListener("pointerup", (event) => {
      if (!pressed || Math.hypot(event.clientX - pressed[0], event.clientY - pressed[1]) > 4) return;
      const area = this.canvas.getBoundingClientRect();
      const at = new THREE.Vector2(2 * (event.clientX - area.left) / area.width - 1,
        1 - 2 * (event.clientY - area.top) / area.height);
      const ray = new THREE.Raycaster();
      ray.setFromCamera(at, this.camera);
      const hits = ray.intersectObjects(this.pickable);
      this.pick(hits.length > 0 ? hits[0].object.userData.object : null);
    });
  }

  pick(objectIndex) {
    this.picked = objectIndex;
    this.show(this.variant, this.frameIndex);
    this.onpick(objectIndex);
  }

  resize() {
    const { clientWidth, clientHeight } = this.canvas;
    if (clientWidth === 0 || clientHeight === 0) return;
    this.renderer.setPixelRatio(window.devicePixelRatio);
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.camera.aspect = clientWidth / clientHeight;
    this.camera.updateProjectionMatrix();
    this.draw();
  }

  draw() { this.renderer.render(this.scene, this.camera); }
}

function mapSection(page, variants) {
  const panel = element("div", { class: "panel", id: "picked" });
  const explain = () => panel.replaceChildren(element("p", { class: "faint" },
    "Drag to turn, scroll to zoom. Click an object for its numbers."));
  explain();
  let view;
  try {
    view = new MapView(page, (index) => {
      if (index === null) explain();
      else panel.replaceChildren(...objectNumbers(page, view.variant, index));
    });
  } catch (error) {
    return section("map", "Map", element("p", {}, "This browser has no WebGL, which the map needs."));
  }
  page.map = view;
  let variant = variants[0], frame = 0;
  const above = element("div");
  const draw = () => {
    const { segment } = view;
    view.show(variant, frame);
    if (above.variant !== variant || segment !== view.segment) {
      above.replaceChildren(topDownChart(page, variant, view.segment));
      above.variant = variant;
    }
  };
  const controls = element("div", { class: "bar" },
    chooser("variant", variants.map(({ name }) => name), 0, (i) => {
      variant = variants[i];
      frame = Math.min(frame, page.sequences[variant.sequence].frames.length - 1);
      view.picked = null;
      explain();
      draw();
    }),
    slider("camera", page.sequences[variants[0].sequence].frames.length, 0, (i) => { frame = i; draw(); }),
    checkbox("ground truth", "truth", true, (on) => { view.shows.truth = on; draw(); }),
    checkbox("planes", "faint", true, (on) => { view.shows.grid = on; draw(); }),
    checkbox("camera", "detection", true, (on) => { view.shows.trajectory = on; draw(); }));
  return section("map", "Map", controls, element("div", { class: "map" }, view.canvas, panel),
    element("h3", {}, "From above"), above);
}
