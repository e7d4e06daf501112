// What is held and what is drawn.
//
// A refined place is never a hole: a chunk that is no longer wanted stays drawn until everything that replaces it in
// the current interest area has arrived (air and rock are arrivals too), then all of it changes in one frame. Drawn
// chunks never overlap. Owner: the main thread; knows neither the network nor the GPU.

import { type ChunkKey, nameOfKey } from '../protocol/chunk_key';
import { kViewLodMax } from '../protocol/limits';

export interface ChunkNode<Mesh> {
  readonly key: ChunkKey;
  readonly name: string;
  readonly parent: ChunkNode<Mesh> | null; // null at the coarsest LOD
  wanted: boolean; // a leaf of the current interest area
  wantedAt_ms: number;
  held: { revision: bigint; ready: boolean; mesh: Mesh | null } | null; // mesh: null for air and rock
  left: boolean; // the server has stopped counting it as held
  drawn: boolean;
  blocked: number; // stamp of the last pass that found a wanted chunk missing here or below
  dependants: number; // children in the map
}

export interface DrawTarget<Mesh> {
  show(node: ChunkNode<Mesh>, mesh: Mesh): void;
  hide(node: ChunkNode<Mesh>, mesh: Mesh): void;
  dispose(mesh: Mesh): void;
}

export interface StoreCounts {
  held: number;
  wanted: number;
  ready: number; // of the wanted
  drawn: number; // with a mesh
}

export class ChunkStore<Mesh> {
  private readonly nodes = new Map<string, ChunkNode<Mesh>>();
  private readonly wanted = new Set<ChunkNode<Mesh>>();
  private readonly heldNodes = new Set<ChunkNode<Mesh>>();
  private readonly drawnNodes = new Set<ChunkNode<Mesh>>();
  private stamp = 0;
  private changed = false;
  private missing = 0;

  constructor(private readonly target: DrawTarget<Mesh>) {}

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
  arrived(key: ChunkKey, revision: bigint): ChunkNode<Mesh> {
    const node = this.intern(key);
    const old = node.held?.mesh ?? null;
    // A newer revision is drawn in the place of the old one only when it is ready.
    node.held = { revision, ready: false, mesh: old };
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
    if (node.drawn && held.mesh !== null) this.target.hide(node, held.mesh);
    if (held.mesh !== null) this.target.dispose(held.mesh);
    held.mesh = mesh;
    held.ready = true;
    if (node.drawn && mesh !== null) this.target.show(node, mesh);
    this.changed = true;
  }

  /// A chunk that could not be decoded is as if it had never come.
  failed(node: ChunkNode<Mesh>, revision: bigint): void {
    if (node.held?.revision === revision) this.drop(node);
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
    for (const node of [...this.drawnNodes]) {
      if (!node.wanted && !this.mustStay(node)) this.undraw(node);
    }
    for (const node of this.wanted) {
      if (!node.drawn && node.held?.ready && !this.isCovered(node)) this.draw(node);
    }
    for (const node of [...this.heldNodes]) {
      if (node.left && !node.wanted && !node.drawn) this.drop(node);
    }
    this.changed = false;
  }

  counts(): StoreCounts {
    let drawn = 0;
    for (const node of this.drawnNodes) if (node.held?.mesh) drawn += 1;
    return { held: this.heldNodes.size, wanted: this.wanted.size, ready: this.wanted.size - this.missing, drawn };
  }

  /// Whether every wanted chunk is there. Meaningful after resolve().
  get complete(): boolean {
    return !this.changed && this.missing === 0;
  }

  held(): Iterable<ChunkNode<Mesh>> {
    return this.heldNodes;
  }

  drawn(): Iterable<ChunkNode<Mesh>> {
    return this.drawnNodes;
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

  /// Whether some of what replaces this unwanted chunk, below it or above it, has not arrived.
  private mustStay(node: ChunkNode<Mesh>): boolean {
    if (node.blocked === this.stamp) return true;
    for (let at = node.parent; at !== null; at = at.parent) {
      if (at.wanted) return !at.held?.ready;
    }
    return false;
  }

  private isCovered(node: ChunkNode<Mesh>): boolean {
    for (let at = node.parent; at !== null; at = at.parent) {
      if (at.drawn) return true;
    }
    return false;
  }

  private draw(node: ChunkNode<Mesh>): void {
    node.drawn = true;
    this.drawnNodes.add(node);
    if (node.held?.mesh) this.target.show(node, node.held.mesh);
  }

  private undraw(node: ChunkNode<Mesh>): void {
    node.drawn = false;
    this.drawnNodes.delete(node);
    if (node.held?.mesh) this.target.hide(node, node.held.mesh);
  }

  private drop(node: ChunkNode<Mesh>): void {
    if (node.drawn) this.undraw(node);
    if (node.held?.mesh) this.target.dispose(node.held.mesh);
    node.held = null;
    node.left = false;
    this.heldNodes.delete(node);
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
    const node: ChunkNode<Mesh> = {
      key: { lod, x, y, z },
      name,
      parent,
      wanted: false,
      wantedAt_ms: 0,
      held: null,
      left: false,
      drawn: false,
      blocked: 0,
      dependants: 0,
    };
    this.nodes.set(name, node);
    return node;
  }

  /// Forgets a node, and its ancestors, once nothing depends on it.
  private release(node: ChunkNode<Mesh> | null): void {
    for (let at = node; at !== null && !at.wanted && at.held === null && at.dependants === 0; at = at.parent) {
      this.nodes.delete(at.name);
      if (at.parent) at.parent.dependants -= 1;
    }
  }
}
