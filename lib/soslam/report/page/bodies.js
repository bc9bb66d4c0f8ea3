"use strict";
// Meshes and lines of the map in three dimensions, for three.js, in the world's own frame.

// A body whose support function is || ( ||(a n1, b n2)||_p, c n3 ) ||_r, landmark.p = [p, r], is the
// unit ball of such a norm with the exponents of 1/p + 1/q = 1, scaled by its half axes. Points of a
// cube are moved onto it: first in their horizontal section, then between axis and rim.
function bodyGeometry(landmark) {
  const [a, b, c] = landmark.half_axes;
  if (Math.max(...landmark.p) <= 1.001) return new THREE.BoxBufferGeometry(2 * a, 2 * b, 2 * c);
  const norm = (x, y, p) => {
    const [small, large] = [Math.abs(x), Math.abs(y)].sort((one, other) => one - other);
    const q = p / (p - 1);
    return p <= 1.001 || large === 0 ? large : large * Math.pow(1 + Math.pow(small / large, q), 1 / q);
  };
  const geometry = new THREE.BoxBufferGeometry(2, 2, 2, 14, 14, 14);
  const positions = geometry.attributes.position;
  for (let i = 0; i < positions.count; ++i) {
    const [x, y, z] = [positions.getX(i), positions.getY(i), positions.getZ(i)];
    const rim = Math.max(Math.abs(x), Math.abs(y));
    const size = norm(rim, z, landmark.p[1]);
    const section = rim === 0 ? 0 : rim / norm(x, y, landmark.p[0]) / size;
    positions.setXYZ(i, a * x * section, b * y * section, c * z / size);
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

// The axis through front and back, with the head of an arrow at the front if that is known.
function frontBackAxis({ landmark, front }) {
  const [a] = landmark.half_axes;
  const material = new THREE.MeshBasicMaterial(
    { color: colour("front"), depthTest: false, transparent: true });  // shows inside the body as well
  const axis = new THREE.Mesh(new THREE.BoxBufferGeometry(2.7 * a, 0.05 * a, 0.05 * a), material);
  if (front && front.is_known) {
    const head = new THREE.Mesh(new THREE.ConeBufferGeometry(0.15 * a, 0.4 * a), material);
    head.rotation.z = -Math.PI / 2;  // cones point along y
    head.position.x = 1.5 * a;
    axis.add(head);
  }
  axis.traverse((part) => { part.renderOrder = 1; });
  return placed(axis, landmark.pose);
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
