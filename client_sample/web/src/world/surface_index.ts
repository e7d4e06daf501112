// Where the drawn surface is, for feet and for rays: triangles of decoded chunks, bucketed by column. Pure.

import { kStepsPerCell } from './packed_mesh';

/// A chunk's surface with its place; positions are `corner + steps * stepM`.
export interface PlacedSurface {
  cornerX: number;
  cornerY: number;
  cornerZ: number;
  stepM: number;
  cells: number;
  positions: Int16Array; // PackedMesh
  indices: Uint16Array | Uint32Array;
}

export interface SurfacePoint {
  heightM: number;
  up: number; // y component of the triangle's unit normal
}

interface Buckets {
  first: Uint32Array; // per column, into `triangles`; cells^2 + 1 entries
  triangles: Uint32Array; // first index of each triangle
}

const bucketsOf = new WeakMap<Int16Array, Buckets>();
const kShortsPerVertex = 4;

function columnsOfTriangle(surface: PlacedSurface, steps: Int16Array, at: number, visit: (column: number) => void): void {
  let lowX = 32767;
  let lowZ = 32767;
  let highX = -32768;
  let highZ = -32768;
  for (let k = 0; k < 3; ++k) {
    const v = surface.indices[at + k]! * kShortsPerVertex;
    lowX = Math.min(lowX, steps[v]!);
    highX = Math.max(highX, steps[v]!);
    lowZ = Math.min(lowZ, steps[v + 2]!);
    highZ = Math.max(highZ, steps[v + 2]!);
  }
  const last = surface.cells - 1;
  const column = (step: number): number => Math.max(0, Math.min(last, Math.floor(step / kStepsPerCell)));
  for (let z = column(lowZ); z <= column(highZ); ++z) {
    for (let x = column(lowX); x <= column(highX); ++x) visit(z * surface.cells + x);
  }
}

function buildBuckets(surface: PlacedSurface): Buckets {
  const steps = surface.positions;
  const first = new Uint32Array(surface.cells * surface.cells + 1);
  for (let i = 0; i < surface.indices.length; i += 3) columnsOfTriangle(surface, steps, i, (column) => first[column + 1]!++);
  for (let c = 1; c < first.length; ++c) first[c]! += first[c - 1]!;
  const triangles = new Uint32Array(first[first.length - 1]!);
  const next = first.slice();
  for (let i = 0; i < surface.indices.length; i += 3) {
    columnsOfTriangle(surface, steps, i, (column) => {
      triangles[next[column]!++] = i;
    });
  }
  return { first, triangles };
}

/// The highest point of `surface` above (x, z) that is not above `ceilingM`; null if there is none. World metres.
export function surfaceBelow(surface: PlacedSurface, x: number, z: number, ceilingM: number): SurfacePoint | null {
  let buckets = bucketsOf.get(surface.positions);
  if (!buckets) {
    buckets = buildBuckets(surface);
    bucketsOf.set(surface.positions, buckets);
  }
  const steps = surface.positions;
  const px = (x - surface.cornerX) / surface.stepM;
  const pz = (z - surface.cornerZ) / surface.stepM;
  const cellX = Math.floor(px / kStepsPerCell);
  const cellZ = Math.floor(pz / kStepsPerCell);
  if (cellX < 0 || cellZ < 0 || cellX >= surface.cells || cellZ >= surface.cells) return null;
  const column = cellZ * surface.cells + cellX;
  const ceiling = (ceilingM - surface.cornerY) / surface.stepM;
  let best: { y: number; up: number } | null = null;
  for (let t = buckets.first[column]!; t < buckets.first[column + 1]!; ++t) {
    const hit = heightOnTriangle(steps, surface.indices, buckets.triangles[t]!, px, pz);
    if (hit && hit.y <= ceiling && (best === null || hit.y > best.y)) best = hit;
  }
  return best && { heightM: surface.cornerY + best.y * surface.stepM, up: best.up };
}

function heightOnTriangle(
  steps: Int16Array,
  indices: Uint16Array | Uint32Array,
  at: number,
  x: number,
  z: number,
): { y: number; up: number } | null {
  const a = indices[at]! * kShortsPerVertex;
  const b = indices[at + 1]! * kShortsPerVertex;
  const c = indices[at + 2]! * kShortsPerVertex;
  const ux = steps[b]! - steps[a]!;
  const uy = steps[b + 1]! - steps[a + 1]!;
  const uz = steps[b + 2]! - steps[a + 2]!;
  const vx = steps[c]! - steps[a]!;
  const vy = steps[c + 1]! - steps[a + 1]!;
  const vz = steps[c + 2]! - steps[a + 2]!;
  const area = ux * vz - uz * vx; // minus the y component of the normal
  if (area === 0) return null;
  const dx = x - steps[a]!;
  const dz = z - steps[a + 2]!;
  const s = (dx * vz - dz * vx) / area;
  const t = (ux * dz - uz * dx) / area;
  const slack = 1e-6; // a foot on an edge belongs to both of its triangles
  if (s < -slack || t < -slack || s + t > 1 + slack) return null;
  const nx = uy * vz - uz * vy;
  const nz = ux * vy - uy * vx;
  return { y: steps[a + 1]! + s * uy + t * vy, up: -area / Math.hypot(nx, area, nz) };
}

/// Distance in metres along a ray (unit direction) to the surface; Infinity without a hit. Front faces and back faces.
export function surfaceAlong(
  surface: PlacedSurface,
  from: readonly [number, number, number],
  towards: readonly [number, number, number],
): number {
  const edge = surface.cells * kStepsPerCell;
  const scale = 1 / surface.stepM;
  const o = [(from[0] - surface.cornerX) * scale, (from[1] - surface.cornerY) * scale, (from[2] - surface.cornerZ) * scale];
  let enter = 0;
  let exit = Infinity;
  for (let axis = 0; axis < 3; ++axis) {
    const inverse = 1 / towards[axis]!;
    const t0 = (0 - o[axis]!) * inverse;
    const t1 = (edge - o[axis]!) * inverse;
    if (Number.isNaN(t0) || Number.isNaN(t1)) continue;
    enter = Math.max(enter, Math.min(t0, t1));
    exit = Math.min(exit, Math.max(t0, t1));
  }
  if (enter > exit) return Infinity;
  const steps = surface.positions;
  let nearest = Infinity;
  for (let i = 0; i < surface.indices.length; i += 3) {
    nearest = Math.min(nearest, rayTriangle(steps, surface.indices, i, o as [number, number, number], towards));
  }
  return nearest * surface.stepM;
}

/// Möller and Trumbore, "Fast, minimum storage ray/triangle intersection" (1997); both faces.
function rayTriangle(
  steps: Int16Array,
  indices: Uint16Array | Uint32Array,
  at: number,
  o: readonly [number, number, number],
  d: readonly [number, number, number],
): number {
  const a = indices[at]! * kShortsPerVertex;
  const b = indices[at + 1]! * kShortsPerVertex;
  const c = indices[at + 2]! * kShortsPerVertex;
  const ux = steps[b]! - steps[a]!;
  const uy = steps[b + 1]! - steps[a + 1]!;
  const uz = steps[b + 2]! - steps[a + 2]!;
  const vx = steps[c]! - steps[a]!;
  const vy = steps[c + 1]! - steps[a + 1]!;
  const vz = steps[c + 2]! - steps[a + 2]!;
  const px = d[1] * vz - d[2] * vy;
  const py = d[2] * vx - d[0] * vz;
  const pz = d[0] * vy - d[1] * vx;
  const determinant = ux * px + uy * py + uz * pz;
  if (Math.abs(determinant) < 1e-12) return Infinity;
  const tx = o[0] - steps[a]!;
  const ty = o[1] - steps[a + 1]!;
  const tz = o[2] - steps[a + 2]!;
  const u = (tx * px + ty * py + tz * pz) / determinant;
  if (u < 0 || u > 1) return Infinity;
  const qx = ty * uz - tz * uy;
  const qy = tz * ux - tx * uz;
  const qz = tx * uy - ty * ux;
  const v = (d[0] * qx + d[1] * qy + d[2] * qz) / determinant;
  if (v < 0 || u + v > 1) return Infinity;
  const t = (vx * qx + vy * qy + vz * qz) / determinant;
  return t > 0 ? t : Infinity;
}
