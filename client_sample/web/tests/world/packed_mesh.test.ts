import { expect, test } from 'vitest';
import type { DecodedMesh } from '../../src/world/draco_mesh';
import { kStepsPerCell, packMesh } from '../../src/world/packed_mesh';
import { type PlacedSurface, surfaceAlong, surfaceBelow } from '../../src/world/surface_index';

const kCells = 4;
const kEdge = kCells * kStepsPerCell;

/// A gently sloping sheet over a whole chunk of 4^3 cells of one metre: height 1 + x / 4.
function sheet(): DecodedMesh {
  const n = kCells + 1;
  const positions: number[] = [];
  const indices: number[] = [];
  for (let z = 0; z < n; ++z) for (let x = 0; x < n; ++x) positions.push(x, 1 + x / 4, z);
  for (let z = 0; z < kCells; ++z) {
    for (let x = 0; x < kCells; ++x) {
      const a = z * n + x;
      indices.push(a, a + n, a + 1, a + 1, a + n, a + n + 1); // counter-clockwise from above
    }
  }
  const normal = [-0.2425, 0.9701, 0];
  return {
    positions: new Float32Array(positions),
    normals: new Float32Array(Array.from({ length: n * n }, () => normal).flat()),
    materials: new Uint8Array(n * n).fill(3),
    ridges: new Uint8Array(n * n).map((_, i) => (i === 0 ? 0 : 255)),
    indices: new Uint32Array(indices),
  };
}

function placed(corner: number): PlacedSurface {
  const packed = packMesh(sheet(), { stepM: 1 / kStepsPerCell, edgeSteps: kEdge });
  return { cornerX: corner, cornerY: -8, cornerZ: -corner, stepM: 1 / kStepsPerCell, cells: kCells, ...packed };
}

test('vertices keep their lattice steps, material and ridge map', () => {
  const packed = packMesh(sheet(), { stepM: 1 / kStepsPerCell, edgeSteps: kEdge });
  expect([...packed.positions.slice(0, 8)]).toEqual([0, 64, 0, 3, 64, 80, 0, 3]);
  expect(packed.normals[3]).toBe(-127);
  expect(packed.normals[7]).toBe(127);
  expect(packed.indices.slice(0, packed.surfaceIndices)).toEqual(new Uint16Array(sheet().indices));
});

test('every border edge has a skirt in the plane of its face, facing out and leading into the rock', () => {
  const packed = packMesh(sheet(), { stepM: 1 / kStepsPerCell, edgeSteps: kEdge });
  const skirt = [...packed.indices.slice(packed.surfaceIndices)];
  expect(skirt.length).toBe(4 * kCells * 6);
  const at = (v: number): number[] => [...packed.positions.slice(v * 4, v * 4 + 3)];
  for (let i = 0; i < skirt.length; i += 3) {
    const [a, b, c] = [at(skirt[i]!), at(skirt[i + 1]!), at(skirt[i + 2]!)] as [number[], number[], number[]];
    const u = b.map((value, k) => value - a[k]!);
    const v = c.map((value, k) => value - a[k]!);
    const normal = [u[1]! * v[2]! - u[2]! * v[1]!, u[2]! * v[0]! - u[0]! * v[2]!, u[0]! * v[1]! - u[1]! * v[0]!];
    const axis = [0, 2].find((k) => a[k] === b[k] && b[k] === c[k] && (a[k] === 0 || a[k] === kEdge))!;
    expect(axis, 'in a face').toBeDefined();
    expect(Math.sign(normal[axis]!), 'outwards').toBe(a[axis] === 0 ? -1 : 1);
  }
  expect(packed.low[1]).toBeLessThan(0);
});

test.each([0, 1e9])('the ground under a foot is found exactly, corner at %d m', (corner) => {
  const surface = placed(corner);
  expect(surfaceBelow(surface, corner + 2.5, -corner + 1.25, 100)!.heightM).toBeCloseTo(-8 + 1 + 2.5 / 4, 6);
  expect(surfaceBelow(surface, corner + 2.5, -corner + 1.25, 100)!.up).toBeCloseTo(0.9701, 3);
  expect(surfaceBelow(surface, corner + 2.5, -corner + 1.25, -7.5), 'above the ceiling').toBeNull();
  expect(surfaceBelow(surface, corner + 4.5, -corner + 1.25, 100), 'outside').toBeNull();
});

test('a ray meets the surface where it should, and only ahead', () => {
  const surface = placed(0);
  expect(surfaceAlong(surface, [2, 10, 2], [0, -1, 0])).toBeCloseTo(10 - (-8 + 1.5), 6);
  expect(surfaceAlong(surface, [2, 10, 2], [0, 1, 0])).toBe(Infinity);
  expect(surfaceAlong(surface, [20, 10, 2], [0, -1, 0])).toBe(Infinity);
});
