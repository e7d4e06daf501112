import { describe, expect, test } from 'vitest';
import type { ChunkKey } from '../../src/protocol/chunk_key';
import { interestArea } from '../../src/protocol/interest_area';
import { ChunkStore } from '../../src/world/chunk_store';

interface FakeMesh {
  name: string;
}

class Screen {
  readonly shown = new Set<FakeMesh>();
  disposed = 0;
  readonly store = new ChunkStore<FakeMesh>({
    show: (mesh) => void this.shown.add(mesh),
    hide: (mesh) => void this.shown.delete(mesh),
    dispose: (mesh) => {
      this.disposed += 1;
      expect(this.shown.has(mesh), 'a mesh is hidden before it goes').toBe(false);
    },
  });

  arrive(key: ChunkKey, mesh = true, faces = 0): void {
    const node = this.store.arrived(key, 1n, faces);
    this.store.ready(node, 1n, mesh ? { name: node.name } : null);
  }

  names(): string[] {
    return [...this.shown].map((mesh) => mesh.name).sort();
  }
}

const parent = { lod: 1, x: 0, y: 0, z: 0 };
const children = Array.from({ length: 8 }, (_, i) => ({ lod: 0, x: i & 1, y: (i >> 1) & 1, z: i >> 2 }));

describe('a refined place', () => {
  test('shows the parent until the last child has come, then only the children', () => {
    const screen = new Screen();
    screen.store.want([parent], 0);
    screen.arrive(parent);
    screen.store.resolve();
    expect(screen.names()).toEqual(['1/0/0/0']);
    screen.store.want(children, 1);
    screen.store.leave([parent]);
    for (const child of children.slice(0, 7)) {
      screen.arrive(child, child.x === 0); // some of them air
      screen.store.resolve();
      expect(screen.names()).toEqual(['1/0/0/0']);
    }
    expect(screen.store.complete).toBe(false);
    screen.arrive(children[7]!);
    screen.store.resolve();
    expect(screen.names()).toEqual(['0/0/0/0', '0/0/0/1', '0/0/1/0', '0/0/1/1', '0/1/1/1']);
    expect(screen.store.complete).toBe(true);
    expect(screen.disposed).toBe(1);
  });

  test('goes back to the parent in one step', () => {
    const screen = new Screen();
    screen.store.want(children, 0);
    children.forEach((child) => screen.arrive(child));
    screen.store.resolve();
    screen.store.want([parent], 1);
    screen.store.leave(children);
    screen.store.resolve();
    expect(screen.names().length).toBe(8);
    screen.arrive(parent);
    screen.store.resolve();
    expect(screen.names()).toEqual(['1/0/0/0']);
    expect(screen.store.counts().held).toBe(1);
  });
});

test('a chunk that fails to decode counts as missing and may come again', () => {
  const screen = new Screen();
  screen.store.want([parent], 0);
  const node = screen.store.arrived(parent, 1n, 0);
  screen.store.failed(node, 1n);
  screen.store.resolve();
  expect(screen.store.complete).toBe(false);
  screen.arrive(parent);
  screen.store.resolve();
  expect(screen.store.complete).toBe(true);
});

test('clearing forgets everything that was held', () => {
  const screen = new Screen();
  screen.store.want(children, 0);
  children.forEach((child) => screen.arrive(child));
  screen.store.resolve();
  screen.store.clear();
  expect(screen.shown.size).toBe(0);
  expect(screen.store.counts()).toEqual({ held: 0, wanted: 0, ready: 0, drawn: 0, strips: 0 });
});

/// LOD 0 chunks below the names of `drawn`, each with how often it is covered.
function coverage(drawn: Iterable<{ key: ChunkKey }>): Map<string, number> {
  const out = new Map<string, number>();
  for (const { key } of drawn) {
    const n = 2 ** key.lod;
    for (let x = 0; x < n; ++x) {
      for (let y = 0; y < n; ++y) {
        for (let z = 0; z < n; ++z) {
          const name = `${key.x * n + x}/${key.y * n + y}/${key.z * n + z}`;
          out.set(name, (out.get(name) ?? 0) + 1);
        }
      }
    }
  }
  return out;
}

test('through random flights no place that was drawn and is still wanted is ever a hole or drawn twice', { timeout: 30_000 }, () => {
  const seed = Date.now() & 0xffff;
  let state = seed;
  const random = (): number => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 2 ** 32;
  };
  const shape = { cells: 32, voxelM: 1, heightLowM: -60, heightHighM: 120 };
  const screen = new Screen();
  const { store } = screen;
  let x = 0;
  let before = new Map<string, number>();
  for (let step = 0; step < 40; ++step) {
    x += (random() - 0.3) * 160;
    const view = { position: { x, y: 60, z: random() * 40 }, nearM: 112, farM: 260, lodBias: 0 };
    const leaves = interestArea(view, shape);
    const wanted = coverage(leaves.map((key) => ({ key })));
    store.want(leaves, step);
    store.leaveUnwanted();
    const missing = leaves.filter((key) => !store.find(key)?.held).sort(() => random() - 0.5);
    for (const key of missing.slice(0, Math.floor(missing.length * random() * 1.5))) screen.arrive(key, random() < 0.5);
    store.resolve();
    const now = coverage(store.drawn());
    const twice = [...now].filter(([, times]) => times !== 1);
    expect(twice, `seed ${seed} step ${step}: drawn twice`).toEqual([]);
    const holes = [...before.keys()].filter((place) => wanted.has(place) && !now.has(place));
    expect(holes, `seed ${seed} step ${step}: holes`).toEqual([]);
    before = now;
  }
});
