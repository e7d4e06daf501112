import { expect, test } from 'vitest';
import { type MapFrame, panned, roundLength, tilesOf, toScreen, toWorld, zoomed, zoomOf } from '../../src/ui/map_frame';

const scheme = { tilePixels: 256, zoomMax: 11, pixelM: 2048, tileLimit: Array.from({ length: 12 }, (_, zoom) => 2 ** (16 + zoom)), layers: ['shaded'] };
const frame: MapFrame = { x: 1e9 + 0.5, z: -350, scale: 12.5, width: 900, height: 500 };

test('a place on the screen and back', () => {
  const [left, top] = toScreen(frame, 1e9 + 1000, 200);
  const [x, z] = toWorld(frame, left, top);
  expect(x).toBeCloseTo(1e9 + 1000, 5);
  expect(z).toBeCloseTo(200, 6);
  expect(toScreen(frame, frame.x, frame.z)).toEqual([450, 250]);
});

test('dragging to the right shows what lies to the left', () => {
  expect(panned(frame, 100, 0).x).toBe(frame.x - 1250);
  expect(panned(frame, 0, -40).z).toBe(frame.z + 500);
});

test('zooming keeps what lies under the pointer', () => {
  for (const factor of [1.25, 0.4, 3]) {
    const before = toWorld(frame, 123, 456);
    const after = toWorld(zoomed(frame, scheme, factor, 123, 456), 123, 456);
    expect(after[0]).toBeCloseTo(before[0], 5);
    expect(after[1]).toBeCloseTo(before[1], 5);
  }
});

test('zooming ends at both ends', () => {
  expect(zoomed(frame, scheme, 1e9, 0, 0).scale).toBe(0.25);
  expect(zoomed(frame, scheme, 1e-9, 0, 0).scale).toBe(4096);
});

test('the zoom has pixels near the size of the screen', () => {
  expect(zoomOf({ ...frame, scale: 2048 }, scheme, 1)).toBe(0);
  expect(zoomOf({ ...frame, scale: 1 }, scheme, 1)).toBe(11);
  expect(zoomOf({ ...frame, scale: 1 }, scheme, 2)).toBe(11);
  expect(zoomOf({ ...frame, scale: 16 }, scheme, 2)).toBe(8);
  expect(zoomOf({ ...frame, scale: 1e6 }, scheme, 1)).toBe(0);
});

test('tiles cover the frame without gaps, the middle first', () => {
  const zoom = zoomOf(frame, scheme, 1);
  const tiles = tilesOf(frame, scheme, zoom);
  const covers = (left: number, top: number): boolean =>
    tiles.some((t) => left >= t.left - 1e-6 && left <= t.left + t.size + 1e-6 && top >= t.top - 1e-6 && top <= t.top + t.size + 1e-6);
  for (const [left, top] of [[0, 0], [899, 0], [0, 499], [899, 499], [450, 250]] as const) expect(covers(left, top)).toBe(true);
  expect(tiles.length).toBeLessThan(40);
  const first = tiles[0]!;
  expect(first.left <= 450 && first.left + first.size >= 450).toBe(true);
  expect(new Set(tiles.map((t) => `${t.x}/${t.y}`)).size).toBe(tiles.length);
});

test('there are no tiles beyond the edge of the world', () => {
  const edge = 2 ** 16 * 2048 * 256;
  for (const t of tilesOf({ ...frame, x: edge, scale: 2048 }, scheme, 0)) expect(t.x).toBeLessThan(2 ** 16);
  expect(tilesOf({ ...frame, x: 3 * edge, scale: 2048 }, scheme, 0)).toEqual([]);
});

test.each([[1999, 1000], [2000, 2000], [7, 5], [0.3, 0.2]])('a bar of at most %d m is %d m long', (most, length) => {
  expect(roundLength(most)).toBeCloseTo(length, 9);
});
