import { expect, test } from 'vitest';
import type { ChunkKey } from '../../src/protocol/chunk_key';
import { ClosedSurface, type DrawnSurface } from '../../src/world/closed_surface';

const kCells = 1; // so every edge of a sheet but its diagonal lies on a face

function surface(key: ChunkKey, isStrip: boolean, places: [number, number, number][], triangles: number[]): DrawnSurface {
  const positions = new Int16Array(places.flatMap((place) => [...place, 0]));
  return { key, isStrip, cells: kCells, positions, indices: new Uint16Array(triangles) };
}

/// A level sheet over a whole chunk, seen from above counter-clockwise.
function sheet(key: ChunkKey, y: number): DrawnSurface {
  return surface(key, false, [[0, y, 0], [64, y, 0], [0, y, 64], [64, y, 64]], [0, 2, 1, 1, 2, 3]);
}

const coarse: ChunkKey = { lod: 1, x: 0, y: 0, z: 0 };
const fine = [0, 1].flatMap((y) => [0, 1].map((z): ChunkKey => ({ lod: 0, x: 2, y, z })));
/// Between the coarse sheet at 20 steps of LOD 1, which are 40 of LOD 0, and the fine ones at 44.
const strip = surface(coarse, true, [[128, 40, 0], [128, 40, 128], [128, 44, 128], [128, 44, 64], [128, 44, 0]], [0, 1, 2, 0, 2, 3, 0, 3, 4]);

function openEdges(places: ChunkKey[], surfaces: DrawnSurface[]): number {
  const closed = new ClosedSurface(kCells);
  places.forEach((key) => closed.addPlace(key));
  surfaces.forEach((each) => closed.addSurface(each));
  const { edges, open } = closed.result(1);
  expect(edges).toBeGreaterThan(0);
  return open.length;
}

test('a sheet that goes on in the next chunk is closed, one that does not or goes on elsewhere is open', () => {
  const here = { lod: 0, x: -1, y: 0, z: 3 };
  const next = { lod: 0, x: 0, y: 0, z: 3 };
  expect(openEdges([here, next], [sheet(here, 30), sheet(next, 30)])).toBe(0);
  expect(openEdges([here, next], [sheet(here, 30)])).toBe(1);
  expect(openEdges([here], [sheet(here, 30)]), 'what is beyond is not drawn').toBe(0);
  expect(openEdges([here, next], [sheet(here, 30), sheet(next, 31)])).toBe(2);
});

test('a coarse chunk beside finer ones is open without its strip, and closed with it', () => {
  const sheets = [sheet(coarse, 20), sheet(fine[0]!, 44), sheet(fine[1]!, 44)];
  expect(openEdges([coarse, ...fine], sheets)).toBe(3);
  expect(openEdges([coarse, ...fine], [...sheets, strip])).toBe(0);
});

test('a strip without finer chunks beside it is open', () => {
  const next = { lod: 1, x: 1, y: 0, z: 0 };
  expect(openEdges([coarse, next], [sheet(coarse, 20), sheet(next, 20)])).toBe(0);
  expect(openEdges([coarse, next], [sheet(coarse, 20), sheet(next, 20), strip])).toBeGreaterThan(0);
});

test('places of open edges are in metres of the world, wherever that is', () => {
  const far = { lod: 0, x: 15_625_000, y: -1, z: -15_625_000 };
  const closed = new ClosedSurface(kCells);
  closed.addPlace(far);
  closed.addPlace({ ...far, x: far.x + 1 });
  closed.addSurface(sheet(far, 32));
  expect(closed.result(2).open).toEqual([[(far.x + 1) * 2, -1, -31_249_999]]);
});
