// SPDX-License-Identifier: Apache-2.0
// Normals of a triangle mesh that has none: smooth where it bends gently, crisp at edges.
//
// A corner's normal is the sum of the normals of the triangles at its vertex that lean less than
// the crease angle from the corner's own triangle, weighted by area.

const CREASE = Math.cos((38 * Math.PI) / 180);

/** Twice the area times the unit normal of each triangle. */
function faceNormals(vertices, triangles) {
  const normals = new Float32Array(triangles.length);
  for (let t = 0; t < triangles.length; t += 3) {
    const [a, b, c] = [3 * triangles[t], 3 * triangles[t + 1], 3 * triangles[t + 2]];
    const ux = vertices[b] - vertices[a];
    const uy = vertices[b + 1] - vertices[a + 1];
    const uz = vertices[b + 2] - vertices[a + 2];
    const vx = vertices[c] - vertices[a];
    const vy = vertices[c + 1] - vertices[a + 1];
    const vz = vertices[c + 2] - vertices[a + 2];
    normals[t] = uy * vz - uz * vy;
    normals[t + 1] = uz * vx - ux * vz;
    normals[t + 2] = ux * vy - uy * vx;
  }
  return normals;
}

/** Vertices at the same place get the same number. */
function weld(vertices) {
  const seen = new Map();
  const place = new Uint32Array(vertices.length / 3);
  for (let v = 0; v < place.length; ++v) {
    const key = `${vertices[3 * v]},${vertices[3 * v + 1]},${vertices[3 * v + 2]}`;
    const first = seen.get(key);
    if (first === undefined) seen.set(key, v);
    place[v] = first ?? v;
  }
  return place;
}

/** The corners that meet at each place: corners[start[p] … start[p + 1]). */
function cornersByPlace(triangles, place) {
  const start = new Uint32Array(place.length + 1);
  for (const v of triangles) ++start[place[v] + 1];
  for (let p = 0; p < place.length; ++p) start[p + 1] += start[p];
  const next = start.slice();
  const corners = new Uint32Array(triangles.length);
  for (let c = 0; c < triangles.length; ++c) corners[next[place[triangles[c]]]++] = c;
  return { start, corners };
}

/**
 * Vertices, normals and triangles for drawing. A vertex at an edge becomes several; `sources` says
 * which one each came from, and `of` which triangle.
 */
export function withNormals(vertices, triangles) {
  const faces = faceNormals(vertices, triangles);
  const lengths = new Float32Array(triangles.length / 3);
  for (let t = 0; t < lengths.length; ++t)
    lengths[t] = Math.hypot(faces[3 * t], faces[3 * t + 1], faces[3 * t + 2]) || 1e-30;
  const place = weld(vertices);
  const { start, corners } = cornersByPlace(triangles, place);

  const position = new Float32Array(3 * triangles.length);
  const normal = new Float32Array(3 * triangles.length);
  for (let c = 0; c < triangles.length; ++c) {
    const v = triangles[c];
    const own = Math.floor(c / 3);
    let [x, y, z] = [0, 0, 0];
    for (let k = start[place[v]]; k < start[place[v] + 1]; ++k) {
      const t = Math.floor(corners[k] / 3);
      const cosine =
        (faces[3 * t] * faces[3 * own] +
          faces[3 * t + 1] * faces[3 * own + 1] +
          faces[3 * t + 2] * faces[3 * own + 2]) /
        (lengths[t] * lengths[own]);
      if (cosine < CREASE && t !== own) continue;
      x += faces[3 * t];
      y += faces[3 * t + 1];
      z += faces[3 * t + 2];
    }
    const length = Math.hypot(x, y, z) || 1;
    position.set([vertices[3 * v], vertices[3 * v + 1], vertices[3 * v + 2]], 3 * c);
    normal.set([x / length, y / length, z / length], 3 * c);
  }
  return { position, normal };
}
