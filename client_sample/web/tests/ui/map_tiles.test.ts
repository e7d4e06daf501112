import { afterEach, beforeEach, expect, test, vi } from 'vitest';
import { MapTiles } from '../../src/ui/map_tiles';

interface Question {
  key: string;
  signal: AbortSignal;
  answer: (image: ImageBitmap) => void;
  fail: () => void;
}

const image = { close: () => undefined } as unknown as ImageBitmap;
let questions: Question[];
let tiles: MapTiles;

beforeEach(() => {
  vi.useFakeTimers();
  questions = [];
  tiles = new MapTiles(
    (layer, zoom, x, y, signal) =>
      new Promise((answer, fail) => {
        questions.push({ key: `${layer === 'shaded' ? '' : `${layer}/`}${zoom}/${x}/${y}`, signal, answer, fail: () => fail(new Error('busy')) });
      }),
    () => undefined,
  );
});
afterEach(() => vi.useRealTimers());

const row = (count: number) => Array.from({ length: count }, (_, x) => ({ x, y: 0 }));

test('asks for a few at a time, in the order of need', async () => {
  expect(tiles.want(3, row(20))).toBe(20);
  expect(questions.map((q) => q.key)).toEqual(['3/0/0', '3/1/0', '3/2/0', '3/3/0', '3/4/0', '3/5/0']);
  questions[0]!.answer(image);
  await vi.runAllTimersAsync();
  expect(tiles.find(3, 0, 0)).toBe(image);
  expect(tiles.want(3, row(20))).toBe(19);
  expect(questions.at(-1)!.key).toBe('3/6/0');
});

test('takes back what is no longer wanted', () => {
  tiles.want(3, row(4));
  tiles.want(4, row(2));
  expect(questions.slice(0, 4).every((q) => q.signal.aborted)).toBe(true);
  expect(questions.slice(4).map((q) => q.key)).toEqual(['4/0/0', '4/1/0']);
});

test('a tile that failed is asked for again a while later, not at once', async () => {
  tiles.want(3, row(1));
  questions[0]!.fail();
  await vi.advanceTimersByTimeAsync(10);
  tiles.want(3, row(1));
  expect(questions.length).toBe(1);
  await vi.advanceTimersByTimeAsync(2000);
  tiles.want(3, row(1));
  expect(questions.length).toBe(2);
});

test('keeps a bounded number of tiles, those last used', async () => {
  for (let from = 0; from < 300; from += 6) {
    tiles.want(5, Array.from({ length: 6 }, (_, i) => ({ x: from + i, y: 1 })));
    questions.slice(-6).forEach((q) => q.answer(image));
    await vi.advanceTimersByTimeAsync(1);
    tiles.find(5, 0, 1); // used all the time
  }
  expect(tiles.find(5, 0, 1)).toBe(image);
  expect(tiles.find(5, 1, 1)).toBeNull();
  expect(tiles.find(5, 299, 1)).toBe(image);
});

test('another layer is asked for anew, and the one before is still there', async () => {
  tiles.want(3, row(2));
  questions.forEach((q) => q.answer(image));
  await vi.advanceTimersByTimeAsync(1);
  tiles.layer = 'plates';
  expect(tiles.find(3, 0, 0)).toBeNull();
  expect(tiles.want(3, row(2))).toBe(2);
  expect(questions.slice(2).map((q) => q.key)).toEqual(['plates/3/0/0', 'plates/3/1/0']);
  tiles.layer = 'shaded';
  expect(tiles.want(3, row(2))).toBe(0);
  expect(questions.slice(2).every((q) => q.signal.aborted)).toBe(true);
  expect(tiles.find(3, 1, 0)).toBe(image);
});
