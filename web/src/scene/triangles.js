// SPDX-License-Identifier: GPL-3.0-or-later
// Facets as triangles, for display: the positions are rounded to floats near an origin.
import {ShapeUtils, Vector2} from 'three';

/// Twice the area of a ring times its normal (Newell).
function areaVector(ring) {
  const sum = [0, 0, 0];
  ring.forEach((from, i) => {
    const to = ring[(i + 1) % ring.length];
    sum[0] += (from[1] - to[1]) * (from[2] + to[2]);
    sum[1] += (from[2] - to[2]) * (from[0] + to[0]);
    sum[2] += (from[0] - to[0]) * (from[1] + to[1]);
  });
  return sum;
}

/// A ring in the plane without the axis `dropped`, without repeats of the same point.
function flattened(ring, dropped) {
  const [u, v] = [(dropped + 1) % 3, (dropped + 2) % 3];
  const points = [], corners = [];
  ring.forEach((at, i) => {
    const before = ring[(i + ring.length - 1) % ring.length];
    if (ring.length > 1 && at.every((value, axis) => value === before[axis])) return;
    points.push(new Vector2(at[u], at[v]));
    corners.push(at);
  });
  return {points, corners};
}

/// Subtracts the origin from each position of a ring.
export function moved(ring, origin) {
  return ring.map((at) => at.map((value, axis) => value - origin[axis]));
}

/// The corners of the triangles of a facet, in threes. A facet without area has none.
export function trianglesOf(rings) {
  const outer = rings[0] ?? [];
  if (outer.length < 3) return [];
  const normal = areaVector(outer);
  const sizes = normal.map(Math.abs);
  const dropped = sizes.indexOf(Math.max(...sizes));
  if (sizes[dropped] === 0) return [];
  const flat = rings.filter((ring) => ring.length >= 3).map((ring) => flattened(ring, dropped));
  const corners = flat.flatMap((ring) => ring.corners);
  const [contour, ...holes] = flat.map((ring) => ring.points);
  const triangles = ShapeUtils.triangulateShape(contour, holes).flat();
  return triangles.map((corner) => corners[corner]);
}
