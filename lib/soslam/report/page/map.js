"use strict";
// The map in three dimensions, drawn by three.js.

const kMapKeys = "arrow keys turn, + and - zoom, n and p lead to the next and the previous object, 0 shows all";

class MapView {
  constructor(page, onpick) {
    this.page = page;
    this.onpick = onpick;
    this.canvas = element("canvas", { id: "map-canvas", role: "application", tabindex: 0,
      "aria-roledescription": "map in three dimensions", "aria-label": "map: " + kMapKeys });
    this.renderer = new THREE.WebGLRenderer({ canvas: this.canvas, antialias: true, alpha: true, preserveDrawingBuffer: true });
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(45, 1, 0.01, 10000);
    this.shows = { truth: true, grid: true, trajectory: true };
    const sun = new THREE.DirectionalLight(0xffffff, 0.7);
    this.camera.add(sun);
    this.scene.add(this.camera, new THREE.AmbientLight(0xffffff, 0.6));
    this.content = new THREE.Group();
    this.frustum = new THREE.Group();
    this.scene.add(this.content, this.frustum);
    this.pickable = [];
    this.picked = null;
    this.watchPicks();
    this.watchKeys();
    new ResizeObserver(() => this.resize()).observe(this.canvas);
  }

  // Every segment has a world of its own: that of the frame is shown.
  show(variant, frameIndex) {
    this.variant = variant;
    this.sequence = this.page.sequences[variant.sequence];
    const { segment } = this.sequence.frames[frameIndex];
    const isNew = this.segment !== segment;
    this.segment = segment;
    this.build();
    this.moveTo(frameIndex);
    if (isNew) this.lookAtAll();
  }

  // To another frame of the segment that is shown.
  moveTo(frameIndex) {
    this.frameIndex = frameIndex;
    this.clear(this.frustum);
    if (this.shows.trajectory) {
      const size = 0.05 * new THREE.Box3().setFromPoints(this.points()).getSize(new THREE.Vector3()).length() + 0.05;
      this.frustum.add(placed(cameraFrustum(this.sequence.frames[frameIndex], size), this.poses()[frameIndex]));
    }
    this.draw();
  }

  build() {
    this.clear(this.content);
    this.pickable = [];
    this.addObjects();
    if (this.shows.grid) this.addGrid();
    if (this.shows.trajectory) this.addTrajectory();
  }

  clear(group) {
    group.traverse((part) => {
      if (part.geometry) part.geometry.dispose();
      if (part.material) part.material.dispose();
    });
    group.remove(...group.children);
  }

  poses() {
    return this.variant.trajectory || this.sequence.frames.map(({ pose }) => pose);
  }

  addObjects() {
    const aligned = this.shows.truth ? this.alignedTruth("objects") : [];
    aligned.forEach(({ landmark }) => this.content.add(bodyMesh(landmark, "truth", 0.18)));
    this.variant.objects.forEach((estimate, i) => {
      const { truth, segment } = this.sequence.objects[i];
      if (segment !== this.segment) return;
      if (this.shows.truth && truth && !this.variant.truth) this.content.add(bodyMesh(truth, "truth", 0.18));
      if (!estimate || !estimate.landmark) return;
      const mesh = bodyMesh(estimate.landmark, "estimate", i === this.picked ? 0.85 : 0.55);
      mesh.userData.object = i;
      this.pickable.push(mesh);
      this.content.add(mesh, frontBackAxis(estimate));
      if (i === this.picked && estimate.centre_covariance) this.content.add(uncertaintyBody(estimate));
    });
  }

  // The truth in the map's own world.
  alignedTruth(list) {
    return ((this.variant.truth || {})[list] || []).filter(({ segment }) => segment === this.segment);
  }

  addGrid() {
    const here = new Set(this.sequence.objects.filter(({ segment }) => segment === this.segment).map(({ plane }) => plane));
    (this.variant.planes || this.sequence.planes).forEach((grid, plane) => {
      if (!here.has(plane)) return;
      for (const [a, b, c, d, e, f] of grid) this.content.add(threeLine([[a, b, c], [d, e, f]], "faint", 0.35));
    });
  }

  addTrajectory() {
    const { frames } = this.sequence;
    const isHere = (_, i) => frames[i].segment === this.segment;
    this.content.add(threeLine(this.poses().filter(isHere).map((pose) => pose.slice(0, 3)), "detection", 1));
    const truth = this.variant.truth ? this.alignedTruth("trajectory").map(({ pose }) => pose) :
      frames.map(({ true_pose }) => true_pose).filter(isHere);
    if (this.shows.truth && truth.every((pose) => pose)) {
      this.content.add(threeLine(truth.map((pose) => pose.slice(0, 3)), "truth", 0.8));
    }
  }

  // Cameras and the corners of objects.
  points() {
    const points = this.sequence.frames.filter(({ segment }) => segment === this.segment)
      .map(({ pose }) => new THREE.Vector3(...pose.slice(0, 3)));
    this.sequence.objects.forEach(({ truth, segment }, i) => {
      const landmark = (!this.variant.truth && truth) || (this.variant.objects[i] && this.variant.objects[i].landmark);
      if (segment !== this.segment || !landmark) return;
      const turn = new THREE.Quaternion(...landmark.pose.slice(3));
      for (let corner = 0; corner < 8; ++corner) {
        const signed = landmark.half_axes.map((half, k) => (corner >> k & 1 ? half : -half));
        points.push(new THREE.Vector3(...signed).applyQuaternion(turn).add(new THREE.Vector3(...landmark.pose.slice(0, 3))));
      }
    });
    return points;
  }

  // From behind the first camera and above, as near as shows everything.
  lookAtAll() {
    this.camera.up.set(...this.sequence.segments[this.segment].up);
    const points = this.points();
    const first = points[0].clone();
    const centre = new THREE.Box3().setFromPoints(points).getCenter(new THREE.Vector3());
    const back = first.sub(centre).projectOnPlane(this.camera.up).normalize().addScaledVector(this.camera.up, 0.7).normalize();
    this.camera.position.copy(centre).addScaledVector(back, this.distanceToSee(points, centre, back));
    if (this.controls) this.controls.dispose();
    this.controls = new THREE.OrbitControls(this.camera, this.canvas);
    this.controls.enableKeys = false;  // these would be those of the whole page
    this.controls.target.copy(centre);
    this.controls.update();
    this.controls.addEventListener("start", () => { this.isTurned = true; });
    this.controls.addEventListener("change", () => this.draw());
    this.isTurned = false;
    this.draw();
  }

  // How far back from the centre a camera has all of these points in view.
  distanceToSee(points, centre, back) {
    const right = new THREE.Vector3().crossVectors(this.camera.up, back).normalize();
    const upwards = new THREE.Vector3().crossVectors(back, right);
    const slope = 0.94 * Math.tan(this.camera.fov / 2 * Math.PI / 180);
    return Math.max(0.1, ...points.map((point) => {
      const from = point.clone().sub(centre);
      return from.dot(back) + Math.max(Math.abs(from.dot(right)) / (slope * this.camera.aspect), Math.abs(from.dot(upwards)) / slope);
    }));
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

  watchKeys() {
    const kStep = Math.PI / 36, kZoom = 0.85;
    const actions = {
      ArrowLeft: () => this.turn(-kStep, 0), ArrowRight: () => this.turn(kStep, 0),
      ArrowUp: () => this.turn(0, kStep), ArrowDown: () => this.turn(0, -kStep),
      "+": () => this.turn(0, 0, kZoom), "=": () => this.turn(0, 0, kZoom), "-": () => this.turn(0, 0, 1 / kZoom),
      0: () => this.lookAtAll(), n: () => this.pickNext(1), p: () => this.pickNext(-1),
    };
    this.canvas.addEventListener("keydown", (event) => {
      const action = event.ctrlKey || event.metaKey || event.altKey ? null : actions[event.key];
      if (!action) return;
      event.preventDefault();
      action();
    });
  }

  // Moves the camera about what it looks at: to the side and upwards, in radians, and nearer.
  turn(sideways, upwards, nearer = 1) {
    const { up, position } = this.camera, { target } = this.controls;
    const from = position.clone().sub(target);
    const angle = from.angleTo(up) - upwards;
    if (upwards !== 0 && angle > 0.05 && angle < Math.PI - 0.05) {
      from.applyAxisAngle(new THREE.Vector3().crossVectors(from, up).normalize(), upwards);
    }
    position.copy(target).add(from.applyAxisAngle(up, sideways).multiplyScalar(nearer));
    this.isTurned = true;
    this.controls.update();
  }

  pickNext(step) {
    const objects = this.pickable.map(({ userData }) => userData.object);
    const at = objects.indexOf(this.picked);
    const next = at < 0 ? (step > 0 ? 0 : objects.length - 1) : (at + step + objects.length) % objects.length;
    if (objects.length > 0) this.pick(objects[next]);
  }

  pick(objectIndex) {
    if (objectIndex === this.picked) return;
    this.picked = objectIndex;
    this.build();
    this.draw();
    this.onpick(objectIndex);
  }

  resize() {
    const { clientWidth, clientHeight } = this.canvas;
    if (clientWidth === 0 || clientHeight === 0) return;
    this.renderer.setPixelRatio(window.devicePixelRatio);
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.camera.aspect = clientWidth / clientHeight;
    this.camera.updateProjectionMatrix();
    if (this.isTurned === false) this.lookAtAll();
    this.draw();
  }

  draw() { this.renderer.render(this.scene, this.camera); }
}

// What is not on the map, and how to come to what is on another one.
function mapRemarks(sequence) {
  const unplaced = sequence.objects.filter(({ segment }) => segment == null).length;
  const remarks = [];
  if (sequence.segments.length > 1) {
    remarks.push(`The recording has ${sequence.segments.length} parts, each with a map of its own: the slider leads through all.`);
  }
  if (unplaced > 0) {
    remarks.push(`${unplaced} objects of ${sequence.objects.length} were never detected: it is not known on which of the maps they are.`);
  }
  return remarks.length > 0 ? element("p", { class: "faint" }, remarks.join(" ")) : null;
}

// A map, and beside it what it says of the object that is picked; none without WebGL.
function mapWithPanel(page) {
  const panel = element("div", { class: "panel", id: "picked", "aria-live": "polite" });
  const explain = () => panel.replaceChildren(element("p", { class: "faint" },
    "Drag to turn, scroll to zoom. Click an object for its numbers. The orange line leads through front and back, " +
    `with an arrow head at the front where that is known. By keyboard: ${kMapKeys}.`));
  explain();
  try {
    const view = new MapView(page, (index) => {
      if (index === null) explain();
      else panel.replaceChildren(...objectNumbers(page, view.variant, index));
    });
    return { view, panel, explain };
  } catch (error) {
    return null;
  }
}

function mapSection(page, variants) {
  const made = mapWithPanel(page);
  if (!made) return section("map", "Map in three dimensions", element("p", {}, "This browser has no WebGL, which the map needs."));
  const { view, panel, explain } = made;
  let variant = variants[0], frame = 0;
  const caption = element("span", { class: "faint" });
  const framesOf = () => page.sequences[variant.sequence].frames;
  const say = () => {
    const { id, segment } = framesOf()[frame];
    const { segments } = page.sequences[variant.sequence];
    caption.textContent = `frame ${id}` + (segments.length > 1 ? `, part ${segment + 1} of ${segments.length}` : "");
  };
  const { input, setCount } = slider("camera", (i) => {
    frame = i;
    if (framesOf()[frame].segment === view.segment) view.moveTo(frame);
    else view.show(variant, frame);
    say();
  });
  const choose = variantChooser(variants, (chosen) => {
    variant = chosen;
    frame = Math.min(frame, framesOf().length - 1);
    setCount(framesOf().length, frame);
    view.picked = null;
    explain();
    view.show(variant, frame);
    say();
  });
  const toggle = (label, key, name) =>
    checkbox(label, key, true, (on) => { view.shows[name] = on; view.show(variant, frame); });
  const hasTruth = page.has_true_objects || page.has_true_poses;
  return section("map", "Map in three dimensions",
    element("div", { class: "bar" }, choose, hasTruth ? toggle("ground truth", "truth", "truth") : null, toggle("planes", "faint", "grid"),
      toggle("camera", "detection", "trajectory")),
    element("div", { class: "bar" }, input, caption),
    element("div", { class: "map" }, view.canvas, panel), mapRemarks(page.sequences[variant.sequence]));
}
