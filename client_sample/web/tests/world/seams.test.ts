import { describe, expect, test } from 'vitest';
import { type ChunkFace, type StripKey, kChunkFaces, neighbourOf, oppositeFace, parentOf } from '../../src/protocol/chunk_face';
import { type ChunkKey, nameOfKey } from '../../src/protocol/chunk_key';
import { interestArea } from '../../src/protocol/interest_area';
import { kViewLodMax } from '../../src/protocol/limits';
import { ChunkStore } from '../../src/world/chunk_store';

interface FakeMesh {
  name: string;
}

function stripName({ key, face }: StripKey): string {
  return `${nameOfKey(key)}/${face}`;
}

class Screen {
  readonly shown = new Set<string>();
  private readonly meshes = new Set<FakeMesh>();
  readonly store = new ChunkStore<FakeMesh>({
    show: (mesh) => {
      this.meshes.add(mesh);
      this.shown.add(mesh.name);
    },
    hide: (mesh) => {
      this.meshes.delete(mesh);
      this.shown.delete(mesh.name);
    },
    dispose: (mesh) => expect(this.meshes.has(mesh), 'a mesh is hidden before it goes').toBe(false),
  });

  arrive(key: ChunkKey, faces: number): void {
    const node = this.store.arrived(key, 0n, faces);
    this.store.ready(node, 0n, { name: nameOfKey(key) });
  }

  arriveStrip(strip: StripKey): void {
    if (this.store.stripArrived(strip) !== null) this.store.stripReady(strip, { name: stripName(strip) });
  }

  resolve(): string[] {
    this.store.resolve();
    return [...this.shown].sort();
  }
}

/// Two places of LOD 1 side by side along x; `west` meets `east` in its px face.
const west = { lod: 1, x: 0, y: 0, z: 0 };
const east = { lod: 1, x: 1, y: 0, z: 0 };
const childrenOf = (key: ChunkKey): ChunkKey[] =>
  Array.from({ length: 8 }, (_, i) => ({ lod: key.lod - 1, x: 2 * key.x + (i & 1), y: 2 * key.y + ((i >> 1) & 1), z: 2 * key.z + (i >> 2) }));
const allFaces = 0x3f;
const names = (keys: ChunkKey[]): string[] => keys.map(nameOfKey);

describe('a coarse chunk beside finer ones', () => {
  test('is drawn with its strip, and a refinement waits for the strip', () => {
    const screen = new Screen();
    screen.store.want([west, east], 0);
    screen.arrive(west, allFaces);
    screen.arrive(east, allFaces);
    expect(screen.resolve()).toEqual(names([west, east]));
    screen.store.want([west, ...childrenOf(east)], 1);
    screen.store.leave([east]);
    childrenOf(east).forEach((child) => screen.arrive(child, allFaces));
    expect(screen.resolve(), 'there would be a gap').toEqual(names([west, east]));
    expect(screen.store.complete).toBe(false);
    expect(screen.store.strayStrips, 'the view names it: the server sends it').toEqual([]);
    screen.arriveStrip({ key: west, face: 0 });
    expect(screen.resolve()).toEqual([...names(childrenOf(east)), nameOfKey(west), stripName({ key: west, face: 0 })].sort());
    expect(screen.store.complete).toBe(true);
  });

  test('needs no strip where no finer surface reaches the face', () => {
    const screen = new Screen();
    screen.store.want([west, ...childrenOf(east)], 0);
    screen.arrive(west, allFaces);
    childrenOf(east).forEach((child) => screen.arrive(child, child.x === 2 ? allFaces & ~2 : allFaces));
    expect(screen.resolve().length).toBe(9);
  });

  test('loses the strip when its neighbour is as coarse, and gets it back without asking', () => {
    const screen = new Screen();
    const strip = { key: west, face: 0 as ChunkFace };
    screen.store.want([west, ...childrenOf(east)], 0);
    screen.arrive(west, allFaces);
    screen.arriveStrip(strip);
    childrenOf(east).forEach((child) => screen.arrive(child, allFaces));
    expect(screen.resolve()).toContain(stripName(strip));
    screen.store.want([west, east], 1);
    screen.arrive(east, allFaces);
    expect(screen.resolve()).toEqual(names([west, east]));
    screen.store.want([west, ...childrenOf(east)], 2);
    expect(screen.resolve()).toContain(stripName(strip));
  });

  test('that is refined later keeps its neighbour coarse until then, or until the stray strip is there', () => {
    const screen = new Screen();
    screen.store.want([west, east], 0);
    screen.arrive(west, allFaces);
    screen.arrive(east, allFaces);
    screen.resolve();
    screen.store.want([...childrenOf(west), ...childrenOf(east)], 1);
    childrenOf(east).forEach((child) => screen.arrive(child, allFaces));
    expect(screen.resolve()).toEqual(names([west, east]));
    const stray = { key: west, face: 0 as ChunkFace };
    expect(screen.store.strayStrips).toEqual([stray]);
    screen.arriveStrip(stray);
    expect(screen.resolve()).toEqual([...names(childrenOf(east)), nameOfKey(west), stripName(stray)].sort());
    expect(screen.store.strayStrips).toEqual([]);
    childrenOf(west).forEach((child) => screen.arrive(child, allFaces));
    expect(screen.resolve()).toEqual(names([...childrenOf(west), ...childrenOf(east)]).sort());
  });
});

test('strips go with their chunk', () => {
  const screen = new Screen();
  screen.store.want([west, ...childrenOf(east)], 0);
  screen.arrive(west, allFaces);
  screen.arriveStrip({ key: west, face: 0 });
  childrenOf(east).forEach((child) => screen.arrive(child, allFaces));
  screen.resolve();
  expect(screen.store.heldStrips()).toEqual([{ key: west, face: 0 }]);
  screen.store.want([], 1);
  screen.store.leaveUnwanted();
  expect(screen.resolve()).toEqual([]);
  expect(screen.store.heldStrips()).toEqual([]);
  expect(screen.store.stripArrived({ key: west, face: 0 }), 'nobody knows the chunk').toBeNull();
});

/// What a server does (server/world/viewer): sends wanted chunks, and strips between a wanted chunk and a finer one that
/// has been sent and reaches it; and those that are wanted by name.
class Server {
  private readonly sent = new Map<string, { key: ChunkKey; faces: number }>();
  private readonly strips = new Set<string>();
  private target = new Map<string, ChunkKey>();

  constructor(private readonly facesOf: (key: ChunkKey) => number) {}

  view(screen: Screen, leaves: ChunkKey[]): void {
    this.target = new Map(leaves.map((key) => [nameOfKey(key), key]));
    screen.store.want(leaves, 0);
    const left = [...this.sent.values()].filter(({ key }) => !this.target.has(nameOfKey(key))).map(({ key }) => key);
    screen.store.leave(left);
    for (const key of left) this.sent.delete(nameOfKey(key));
    for (const name of [...this.strips]) if (!this.target.has(name.slice(0, name.lastIndexOf('/')))) this.strips.delete(name);
  }

  missing(): ChunkKey[] {
    return [...this.target.values()].filter((key) => !this.sent.has(nameOfKey(key)));
  }

  send(screen: Screen, key: ChunkKey): void {
    const faces = this.facesOf(key);
    this.sent.set(nameOfKey(key), { key, faces });
    screen.arrive(key, faces);
  }

  missingStrips(): StripKey[] {
    const out = new Map<string, StripKey>();
    for (const { key, faces } of this.sent.values()) {
      for (const face of kChunkFaces) {
        const strip = { key: parentOf(neighbourOf(key, face)), face: oppositeFace(face) };
        const name = stripName(strip);
        if ((faces & (1 << face)) !== 0 && this.target.has(nameOfKey(strip.key)) && !this.strips.has(name)) out.set(name, strip);
      }
    }
    return [...out.values()];
  }

  sendStrip(screen: Screen, strip: StripKey): void {
    if (this.target.has(nameOfKey(strip.key))) this.strips.add(stripName(strip));
    screen.arriveStrip(strip);
  }
}

/// Drawn chunks with a gap beside them: coarser by more than one LOD across a reached face, or without the strip shown.
function gaps(screen: Screen): string[] {
  const drawn = new Map([...screen.store.drawn()].map((node) => [node.name, node]));
  const out: string[] = [];
  for (const node of drawn.values()) {
    for (const face of kChunkFaces) {
      if (((node.held?.faces ?? 0) & (1 << face)) === 0) continue;
      for (let across = neighbourOf(node.key, face); across.lod <= kViewLodMax; across = parentOf(across)) {
        const name = nameOfKey(across);
        if (!drawn.has(name)) continue;
        const strip = stripName({ key: across, face: oppositeFace(face) });
        const steps = across.lod - node.key.lod;
        if (steps > 1 || (steps === 1 && !screen.shown.has(strip))) out.push(`${node.name} beside ${name}`);
        break;
      }
    }
  }
  return out;
}

test('through random flights what is drawn never has a gap, and everything is drawn in the end', { timeout: 60_000 }, () => {
  const seed = Date.now() & 0xffff;
  let state = seed;
  const random = (): number => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 2 ** 32;
  };
  const hash = (text: string): number => [...text].reduce((h, c) => Math.imul(h ^ c.charCodeAt(0), 16777619) >>> 0, 2166136261 ^ seed);
  const facesOf = (key: ChunkKey): number => (hash(nameOfKey(key)) >>> 7) & (hash(`${nameOfKey(key)}!`) >>> 9) & 0x3f;
  const shape = { cells: 32, voxelM: 1, heightLowM: -60, heightHighM: 120 };
  const screen = new Screen();
  const server = new Server(facesOf);
  let x = 0;
  let waited = 0;
  for (let step = 0; step < 60; ++step) {
    const jumps = random() < 0.08;
    x += jumps ? 700 * random() : random() * 60;
    server.view(screen, interestArea({ position: { x, y: 60, z: random() * 30 }, nearM: 112, farM: 260, lodBias: 0 }, shape));
    for (const key of server.missing()) if (random() < 0.6) server.send(screen, key);
    for (const strip of server.missingStrips()) if (random() < 0.6) server.sendStrip(screen, strip);
    for (const strip of screen.store.strayStrips) if (random() < 0.6) server.sendStrip(screen, strip);
    screen.store.resolve();
    expect(gaps(screen), `seed ${seed} step ${step}`).toEqual([]);
    waited += screen.store.strayStrips.length;
  }
  for (const key of server.missing()) server.send(screen, key);
  for (const strip of server.missingStrips()) server.sendStrip(screen, strip);
  screen.store.resolve();
  expect(gaps(screen), `seed ${seed} at the end`).toEqual([]);
  expect(screen.store.complete, `seed ${seed}: everything wanted is drawn`).toBe(true);
  expect(screen.store.counts().strips, 'strips were needed').toBeGreaterThan(10);
  expect(waited, 'some met for a moment that no view has side by side').toBeGreaterThan(0);
});
