import { readFileSync, readdirSync } from 'node:fs';
import { describe, expect, test } from 'vitest';
import { decodeDensity, decodeHeight, kNoMaterial } from '../../src/protocol/tiles';
import { specBytes } from './spec';

const root = new URL('../../../../', import.meta.url);
const corpus = new URL('tests/fuzz/corpus/tiles/', root);

function stored(ending: string): Uint8Array[] {
  return readdirSync(corpus)
    .filter((name) => name.endsWith(ending))
    .map((name) => new Uint8Array(readFileSync(new URL(name, corpus))));
}

/// The same numbers on every machine (Numerical Recipes' linear congruence).
function random(seed: number): () => number {
  let state = seed;
  return () => (state = (Math.imul(state, 1664525) + 1013904223) >>> 0);
}

describe('height tiles', () => {
  test('are what the specification shows', () => {
    const tile = decodeHeight(specBytes('height'));
    expect(tile.key).toEqual({ lod: 2, x: -3, y: 0, z: 5 });
    expect(tile.stepM).toBe(1 / 16);
    expect([...tile.heights]).toEqual([100, 103, 110, 98, 101, -200, 97, 100, 106]);
    expect([...tile.ridges]).toEqual([128, 130, 127, 128, 131, 0, 128, 128, 255]);
    expect([...tile.materials]).toEqual([3, 3, 3, 3, 0, 4, 3, 1, 5]);
  });

  test('of the world decode to ground without steps', () => {
    const tiles = stored('.height').map(decodeHeight);
    expect(tiles.length).toBeGreaterThan(0);
    for (const { heights, cells, stepM, key } of tiles) {
      const slopes = [...heights.keys()].filter((at) => at % (cells + 1) > 0).map((at) => Math.abs((heights[at] as number) - (heights[at - 1] as number)));
      expect((Math.max(...slopes) * stepM) / 2 ** key.lod).toBeLessThan(10);
    }
  });
});

describe('density tiles', () => {
  test('are what the specification shows', () => {
    const tile = decodeDensity(specBytes('density'));
    expect(tile.key).toEqual({ lod: 2, x: -3, y: 4, z: 5 });
    expect(tile.stepM).toBe(1 / 64);
    expect([...tile.densities]).toEqual([-300, -290, -310, -301, -40, -30, 5, 200]);
    expect([...tile.materials]).toEqual([7, 7, 8, 7, 3, 3, kNoMaterial, kNoMaterial]);
  });

  test('of the world have a material where there is rock, and only there', () => {
    const tiles = stored('.density').map(decodeDensity);
    expect(tiles.length).toBeGreaterThan(0);
    for (const { densities, materials } of tiles) {
      expect(densities.every((density, at) => (materials[at] !== kNoMaterial) === density < 0)).toBe(true);
    }
  });
});

describe('bytes that are no tile', () => {
  test('are refused when they are cut or longer', () => {
    for (const [decode, name] of [[decodeHeight, 'height'], [decodeDensity, 'density']] as const) {
      const whole = specBytes(name);
      for (let size = 0; size < whole.length; size += 1) expect(() => decode(whole.subarray(0, size)), `${name} ${size}`).toThrow();
      expect(() => decode(Uint8Array.from([...whole, 0]))).toThrow();
    }
  });

  test('never do more than throw an error, whatever is changed in them', () => {
    const next = random(20261124);
    const all = [...stored('.height'), ...stored('.density'), specBytes('height'), specBytes('density')];
    let decoded = 0;
    for (let round = 0; round < 400; round += 1) {
      const bytes = (all[next() % all.length] as Uint8Array).slice();
      for (let changes = 1 + (next() % 3); changes > 0; changes -= 1) bytes[next() % bytes.length] = next() >>> 24;
      try {
        const tile = bytes[3] === 0x68 ? decodeHeight(bytes) : decodeDensity(bytes);
        expect(tile.materials.length).toBe((tile.cells + 1) ** ('heights' in tile ? 2 : 3));
        decoded += 1;
      } catch (fault) {
        expect(fault).toBeInstanceOf(Error);
      }
    }
    expect(decoded).toBeGreaterThan(0);
  }, 60_000);
});
