// What is held and what is drawn.
//
// A refined place is never a hole: a chunk that is no longer wanted stays drawn until everything that replaces it in
// the current interest area has arrived (air and rock are arrivals too), then all of it changes in one frame. Drawn
// chunks never overlap, and what is drawn is closed: seams.ts. Owner: the main thread; knows neither the network nor
// the GPU.

import type { ChunkFace, StripKey } from '../protocol/chunk_face';
import { type ChunkKey, nameOfKey } from '../protocol/chunk_key';
import { kViewLodMax } from '../protocol/limits';
import { ChunkNode, type HeldStrip, type Swap } from './chunk_node';
import { Seams } from './seams';

export interface DrawTarget<Mesh> {
  show(mesh: Mesh): void;
  hide(mesh: Mesh): void;
  dispose(mesh: Mesh): void;
}

export interface StoreCounts {
  held: number;
  wanted: number;
  ready: number; // of the wanted
  drawn: number; // with a mesh
  strips: number; // drawn
}

export class ChunkStore<Mesh> {
  private readonly nodes = new Map<string, ChunkNode<Mesh>>();
  private readonly wanted = new Set<ChunkNode<Mesh>>();
  private readonly heldNodes = new Set<ChunkNode<Mesh>>();
  private readonly drawnNodes = new Set<ChunkNode<Mesh>>();
  private readonly seams: Seams<Mesh>;
  private stamp = 0;
  private changed = false;
  private missing = 0;

  constructor(private readonly target: DrawTarget<Mesh>) {
    this.seams = new Seams(this.nodes, target);
  }

  /// Replaces the interest area. `leaves` do not overlap.
  want(leaves: ChunkKey[], now_ms: number): void {
    const before = new Set(this.wanted);
    this.wanted.clear();
    for (const key of leaves) {
      const node = this.intern(key);
      if (!node.wanted) node.wantedAt_ms = now_ms;
      node.wanted = true;
      this.wanted.add(node);
      before.delete(node);
    }
    for (const node of before) {
      node.wanted = false;
      this.release(node);
    }
    this.changed = true;
  }

  /// A chunk has come and is being decoded: it counts as held from now on.
  arrived(key: ChunkKey, revision: bigint, faces: number): ChunkNode<Mesh> {
    const node = this.intern(key);
    const old = node.held?.mesh ?? null;
    // A newer revision is drawn in the place of the old one only when it is ready.
    node.held = { revision, ready: false, mesh: old, faces };
    node.left = false;
    this.heldNodes.add(node);
    return node;
  }

  /// The decoded chunk; `mesh` is null for air and rock. Ignored, and disposed of, if it has been overtaken.
  ready(node: ChunkNode<Mesh>, revision: bigint, mesh: Mesh | null): void {
    const held = node.held;
    if (held === null || held.revision !== revision) {
      if (mesh !== null) this.target.dispose(mesh);
      return;
    }
    if (node.drawn && held.mesh !== null) this.target.hide(held.mesh);
    if (held.mesh !== null) this.target.dispose(held.mesh);
    held.mesh = mesh;
    held.ready = true;
    if (node.drawn && mesh !== null) this.target.show(mesh);
    this.changed = true;
  }

  /// A chunk that could not be decoded is as if it had never come.
  failed(node: ChunkNode<Mesh>, revision: bigint): void {
    if (node.held?.revision === revision) this.drop(node);
  }

  /// A strip has come; null if nobody knows its chunk any more. It is ready by `stripReady`.
  stripArrived({ key, face }: StripKey): HeldStrip<Mesh> | null {
    const node = this.nodes.get(nameOfKey(key));
    if (node === undefined) return null;
    const known = node.strips[face];
    if (known) return known;
    const strip: HeldStrip<Mesh> = { ready: false, mesh: null, shown: false };
    node.strips[face] = strip;
    return strip;
  }

  /// The decoded strip of a chunk; `mesh` is null for one without triangles, or that cannot be had.
  stripReady({ key, face }: StripKey, mesh: Mesh | null): void {
    const strip = this.nodes.get(nameOfKey(key))?.strips[face];
    if (strip === undefined || strip.ready) {
      if (mesh !== null) this.target.dispose(mesh);
      return;
    }
    strip.ready = true;
    strip.mesh = mesh;
    this.changed = true;
  }

  leave(keys: ChunkKey[]): void {
    for (const key of keys) {
      const node = this.nodes.get(nameOfKey(key));
      if (node?.held) node.left = true;
    }
    this.changed = true;
  }

  /// After a new session: the server knows of nothing outside the interest area.
  leaveUnwanted(): void {
    for (const node of this.heldNodes) node.left ||= !node.wanted;
    this.changed = true;
  }

  clear(): void {
    for (const node of [...this.heldNodes]) this.drop(node);
    this.want([], 0);
  }

  /// Decides what is drawn. Once a frame; does nothing if nothing has changed.
  resolve(): void {
    if (!this.changed) return;
    this.markMissing();
    const swaps = this.swapsThatCould();
    this.seams.holdBack(this.drawnNodes, swaps);
    for (const node of [...this.drawnNodes]) if (!node.next) this.undraw(node);
    for (const swap of swaps) {
      for (const node of swap.fresh) if (node.next) this.draw(node);
      for (const node of [...swap.old, ...swap.fresh]) node.swap = null;
    }
    this.seams.show(this.drawnNodes);
    for (const node of [...this.heldNodes]) {
      if (node.left && !node.wanted && !node.drawn) this.drop(node);
    }
    this.changed = false;
  }

  counts(): StoreCounts {
    let drawn = 0;
    for (const node of this.drawnNodes) if (node.held?.mesh) drawn += 1;
    const [held, wanted] = [this.heldNodes.size, this.wanted.size];
    return { held, wanted, ready: wanted - this.missing, drawn, strips: this.seams.shownCount };
  }

  /// Whether every wanted chunk is there and drawn. Meaningful after resolve().
  get complete(): boolean {
    return !this.changed && this.missing === 0 && this.drawnNodes.size === this.wanted.size;
  }

  /// Strips without which something that has arrived cannot be drawn, and that no interest area names.
  get strayStrips(): readonly StripKey[] {
    return this.seams.stray;
  }

  held(): Iterable<ChunkNode<Mesh>> {
    return this.heldNodes;
  }

  heldStrips(): StripKey[] {
    const out: StripKey[] = [];
    for (const node of this.nodes.values()) {
      node.strips.forEach((strip, face) => {
        if (strip) out.push({ key: node.key, face: face as ChunkFace });
      });
    }
    return out;
  }

  drawn(): Iterable<ChunkNode<Mesh>> {
    return this.drawnNodes;
  }

  /// The meshes of what is drawn: of chunks, then of strips.
  *shown(): Iterable<Mesh> {
    for (const node of this.drawnNodes) if (node.held?.mesh) yield node.held.mesh;
    for (const strip of this.seams.shownStrips()) if (strip.mesh) yield strip.mesh;
  }

  find(key: ChunkKey): ChunkNode<Mesh> | undefined {
    return this.nodes.get(nameOfKey(key));
  }

  private markMissing(): void {
    this.stamp += 1;
    this.missing = 0;
    for (const node of this.wanted) {
      if (node.held?.ready) continue;
      this.missing += 1;
      let at: ChunkNode<Mesh> | null = node;
      while (at !== null && at.blocked !== this.stamp) {
        at.blocked = this.stamp;
        at = at.parent;
      }
    }
  }

  /// Every change of one place whose chunks have all arrived, as if it were made; what nothing replaces goes anyway.
  private swapsThatCould(): Swap<Mesh>[] {
    const swaps: Swap<Mesh>[] = [];
    const swapFor = (node: ChunkNode<Mesh>): Swap<Mesh> => {
      if (node.swap === null) {
        node.swap = { old: [], fresh: [], on: true };
        swaps.push(node.swap);
      }
      return node.swap;
    };
    const goes = (node: ChunkNode<Mesh>, swap: Swap<Mesh>): void => {
      if (!node.next) return;
      node.next = false;
      node.swap = swap;
      swap.old.push(node);
    };
    for (const node of this.wanted) {
      if (node.drawn || !node.held?.ready) continue;
      const above = nearest(node.parent, (each) => each.drawn);
      if (above !== null && above.blocked === this.stamp) continue;
      const swap = swapFor(above ?? node);
      if (above !== null) goes(above, swap);
      node.next = true;
      node.swap = swap;
      swap.fresh.push(node);
    }
    for (const node of this.drawnNodes) {
      if (node.wanted || node.swap !== null) continue;
      const above = nearest(node.parent, (each) => each.wanted);
      if (above === null) node.next = node.blocked === this.stamp;
      else if (above.held?.ready && above.swap !== null) goes(node, above.swap);
    }
    return swaps;
  }

  private draw(node: ChunkNode<Mesh>): void {
    node.drawn = true;
    this.drawnNodes.add(node);
    if (node.held?.mesh) this.target.show(node.held.mesh);
  }

  private undraw(node: ChunkNode<Mesh>): void {
    node.drawn = false;
    node.next = false;
    this.drawnNodes.delete(node);
    if (node.held?.mesh) this.target.hide(node.held.mesh);
  }

  private drop(node: ChunkNode<Mesh>): void {
    if (node.drawn) this.undraw(node);
    if (node.held?.mesh) this.target.dispose(node.held.mesh);
    node.held = null;
    node.left = false;
    this.heldNodes.delete(node);
    this.seams.forget(node);
    this.changed = true;
    this.release(node);
  }

  private intern(key: ChunkKey): ChunkNode<Mesh> {
    const name = nameOfKey(key);
    const found = this.nodes.get(name);
    if (found) return found;
    const { lod, x, y, z } = key;
    const parent = lod < kViewLodMax ? this.intern({ lod: lod + 1, x: x >> 1, y: y >> 1, z: z >> 1 }) : null;
    if (parent) parent.dependants += 1;
    const node = new ChunkNode<Mesh>({ lod, x, y, z }, parent);
    this.nodes.set(name, node);
    return node;
  }

  /// Forgets a node, and its ancestors, once nothing depends on it.
  private release(node: ChunkNode<Mesh> | null): void {
    for (let at = node; at !== null && !at.wanted && at.held === null && at.dependants === 0; at = at.parent) {
      this.seams.forget(at);
      this.nodes.delete(at.name);
      if (at.parent) at.parent.dependants -= 1;
    }
  }
}

function nearest<Mesh>(node: ChunkNode<Mesh> | null, is: (node: ChunkNode<Mesh>) => boolean): ChunkNode<Mesh> | null {
  for (let at = node; at !== null; at = at.parent) if (is(at)) return at;
  return null;
}
