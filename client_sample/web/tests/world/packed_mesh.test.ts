import { expect, test } from 'vitest';
import type { DecodedMesh } from '../../src/world/draco_mesh';
import { kStepsPerCell, packMesh } from '../../src/world/packed_mesh';
import { type PlacedSurface, surfaceAlong, surfaceBelow } from '../../src/world/surface_index';

const kCells = 4;

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
  const packed = packMesh(sheet(), 1 / kStepsPerCell);
  return { cornerX: corner, cornerY: -8, cornerZ: -corner, stepM: 1 / kStepsPerCell, cells: kCells, ...packed };
}

test('vertices keep their lattice steps, material and ridge map', () => {
  const packed = packMesh(sheet(), 1 / kStepsPerCell);
  expect([...packed.positions.slice(0, 8)]).toEqual([0, 64, 0, 3, 64, 80, 0, 3]);
  expect(packed.normals[3]).toBe(-127);
  expect(packed.normals[7]).toBe(127);
  expect(packed.indices).toEqual(new Uint16Array(sheet().indices));
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
