import { readFileSync, readdirSync } from 'node:fs';
import { MeshoptDecoder } from 'three/examples/jsm/libs/meshopt_decoder.module.js';
import { beforeAll, describe, expect, test } from 'vitest';
import { decodeMesh, isMesh } from '../../src/world/lattice_mesh';

const root = new URL('../../../../', import.meta.url);
const kSpecStepM = 1 / 16;
const kStepM = 1 / 64; // of the corpus
const corpus = new URL('tests/fuzz/corpus/mesh/', root);

/// The bytes of the block of SPEC.md that begins with ```hex NAME.
function specBytes(name: string): Uint8Array {
  const text = readFileSync(new URL('protocol/SPEC.md', root), 'utf8');
  const words = new RegExp(`\`\`\`hex ${name}\\n([^\`]*)\`\`\``).exec(text)?.[1]?.trim().split(/\s+/) ?? [];
  return Uint8Array.from(words, (word) => parseInt(word, 16));
}

function stored(name: string): Uint8Array {
  return new Uint8Array(readFileSync(new URL(name, corpus)));
}

describe('mesh payloads', () => {
  beforeAll(() => MeshoptDecoder.ready);

  test('are what the specification shows', () => {
    const bytes = specBytes('mesh');
    expect(isMesh(bytes)).toBe(true);
    const mesh = decodeMesh(MeshoptDecoder, bytes, kSpecStepM);
    const corners = [...mesh.indices].map((v) => [...mesh.positions.subarray(4 * v, 4 * v + 4)]);
    const first = corners.findIndex((corner) => corner[1] === 70);
    expect([0, 1, 2].map((i) => corners[(first + i) % 3])).toEqual([[0, 70, 0, 7], [0, 90, 64, 8], [64, 80, 0, 7]]);
    const up = mesh.indices[first]!;
    expect([...mesh.normals.subarray(4 * up, 4 * up + 3)]).toEqual([0, 127, 0]);
    expect([mesh.low, mesh.high]).toEqual([[0, 70, 0], [64, 90, 64]]);
  });

  test('of the corpus decode to triangles of unit normals within their chunk', () => {
    for (const name of readdirSync(corpus)) {
      const mesh = decodeMesh(MeshoptDecoder, stored(name), kStepM);
      expect(mesh.indices.length % 3).toBe(0);
      expect(Math.max(...mesh.high)).toBeLessThanOrEqual(16 * 64);
      for (let v = 0; v < mesh.normals.length; v += 4) {
        const length = Math.hypot(mesh.normals[v]!, mesh.normals[v + 1]!, mesh.normals[v + 2]!);
        expect(Math.abs(length - 127)).toBeLessThan(2);
      }
    }
  });

  test('that are cut, long or changed throw or decode to indices of their vertices', () => {
    const whole = stored('surface');
    for (let size = 0; size < whole.length; size += 41) expect(() => decodeMesh(MeshoptDecoder, whole.slice(0, size), kStepM)).toThrow();
    let state = 5;
    let refused = 0;
    for (let round = 0; round < 120; ++round) {
      const bytes = whole.slice();
      for (let i = 0; i < 4; ++i) {
        state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
        bytes[(state >>> 8) % (round % 2 === 0 ? 64 : bytes.length)] = state >>> 24;
      }
      try {
        const mesh = decodeMesh(MeshoptDecoder, bytes, kStepM);
        expect(Math.max(...mesh.indices)).toBeLessThan(mesh.positions.length / 4);
      } catch {
        refused += 1;
      }
    }
    expect(refused).toBeGreaterThan(30);
  }, 60_000);

  test('of another version, of too many triangles or of another kind are refused', () => {
    const changed = (at: number, value: number): Uint8Array => {
      const bytes = stored('surface');
      bytes[at] = value;
      return bytes;
    };
    for (const [at, value] of [[0, 1], [4, 2], [5, 0], [5, 255], [6, 1], [18, 255], [14, 255], [23, 255]] as const) {
      expect(() => decodeMesh(MeshoptDecoder, changed(at, value), kStepM), `${at}`).toThrow(/not a mesh/);
    }
  });

  test('on another lattice than that of their place are refused with both steps', () => {
    for (const stepM of [kStepM / 2, kStepM * 2, 0, NaN]) {
      expect(() => decodeMesh(MeshoptDecoder, stored('surface'), stepM)).toThrow(`not a mesh: its step is 0.015625 m, that of its place ${stepM} m`);
    }
    const bytes = stored('surface');
    bytes[11] = 0x3d; // a step of 1/16 m instead of 1/64 m
    expect(() => decodeMesh(MeshoptDecoder, bytes, kStepM)).toThrow('not a mesh: its step is 0.0625 m, that of its place 0.015625 m');
    expect(() => decodeMesh(MeshoptDecoder, bytes, 1 / 16)).not.toThrow();
  });

  test('of as many cells as a strip of the widest chunks are taken, of one more refused', () => {
    const ofCells = (cells: number): Uint8Array => {
      const bytes = stored('surface');
      bytes[5] = cells;
      return bytes;
    };
    expect(decodeMesh(MeshoptDecoder, ofCells(64), kStepM).indices.length).toBeGreaterThan(0);
    expect(() => decodeMesh(MeshoptDecoder, ofCells(65), kStepM)).toThrow('not a mesh: 65 cells');
    expect(() => decodeMesh(MeshoptDecoder, ofCells(0), kStepM)).toThrow('not a mesh: 0 cells');
  });
});
