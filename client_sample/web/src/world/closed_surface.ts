// Whether what is drawn is one closed surface: each edge of a triangle on a face of its chunk is walked as often one way
// as the other, but for edges beside a place that is not drawn. The proof of tests/property/watertight_test.cpp, on
// what the GPU was given. Pure; some 0.1 s for a view of 2 km: for tests and the console, not for every frame.

import { type ChunkKey, nameOfKey } from '../protocol/chunk_key';
import { kViewLodMax } from '../protocol/limits';
import { kStepsPerCell } from './packed_mesh';

/// A drawn chunk or strip; positions as in PackedMesh.
export interface DrawnSurface {
  key: ChunkKey;
  isStrip: boolean;
  cells: number; // of a chunk's edge
  positions: Int16Array;
  indices: Uint16Array | Uint32Array;
}

type Place = [number, number, number]; // in steps of LOD 0's lattice: whole, and exact within 2^53 at any LOD

const kShortsPerVertex = 4;
/// More vertices than a view has; numbers of two of them, put together, are exact in a double.
const kVerticesMax = 2 ** 26;

export class ClosedSurface {
  private readonly places = new Set<string>();
  private readonly vertices: Place[] = [];
  private readonly vertexAt = new Map<number, Map<number, Map<number, number>>>();
  private readonly ways = new Map<number, number>(); // of edges that are not walked as often one way as the other
  private edges = 0;

  constructor(private readonly cells: number) {}

  /// A drawn place, with or without a surface.
  addPlace(key: ChunkKey): void {
    this.places.add(nameOfKey(key));
  }

  addSurface({ key, isStrip, cells, positions, indices }: DrawnSurface): void {
    const lod = isStrip ? key.lod - 1 : key.lod;
    const edge = cells * kStepsPerCell * (isStrip ? 2 : 1);
    const scale = 2 ** lod;
    const corner = [key.x, key.y, key.z].map((at) => at * edge * scale);
    for (let i = 0; i < indices.length; ++i) {
      const from = indices[i]! * kShortsPerVertex;
      const to = indices[i - (i % 3) + ((i + 1) % 3)]! * kShortsPerVertex;
      let isOnFace = false;
      for (let axis = 0; axis < 3; ++axis) {
        const at = positions[from + axis]!;
        isOnFace ||= (at === 0 || at === edge) && positions[to + axis] === at;
      }
      if (!isOnFace) continue;
      const vertex = (v: number): number =>
        this.intern(corner[0]! + positions[v]! * scale, corner[1]! + positions[v + 1]! * scale, corner[2]! + positions[v + 2]! * scale);
      this.walk(vertex(from), vertex(to));
    }
  }

  /// Edges looked at, and the middles in metres of those that are open.
  result(voxelM: number): { edges: number; open: Place[] } {
    const open: Place[] = [];
    for (const edge of this.ways.keys()) {
      const a = this.vertices[Math.floor(edge / kVerticesMax)]!;
      const b = this.vertices[edge % kVerticesMax]!;
      const doubled: Place = [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
      if (!this.isOnHull(doubled)) open.push(doubled.map((at) => (at / 2 / kStepsPerCell) * voxelM) as Place);
    }
    return { edges: this.edges, open };
  }

  private walk(from: number, to: number): void {
    if (from === to) return;
    this.edges += 1;
    const edge = Math.min(from, to) * kVerticesMax + Math.max(from, to);
    const ways = (this.ways.get(edge) ?? 0) + (from < to ? 1 : -1);
    if (ways === 0) this.ways.delete(edge);
    else this.ways.set(edge, ways);
  }

  private intern(x: number, y: number, z: number): number {
    let ofX = this.vertexAt.get(x);
    if (!ofX) this.vertexAt.set(x, (ofX = new Map()));
    let ofZ = ofX.get(z);
    if (!ofZ) ofX.set(z, (ofZ = new Map()));
    const known = ofZ.get(y);
    if (known !== undefined) return known;
    ofZ.set(y, this.vertices.length);
    this.vertices.push([x, y, z]);
    return this.vertices.length - 1;
  }

  /// Looks half a step into all eight directions from the middle of an edge.
  private isOnHull(doubled: Place): boolean {
    for (let i = 0; i < 8; ++i) {
      const side = doubled.map((at, axis) => at + ((i >> axis) % 2 === 0 ? 1 : -1)) as Place;
      if (!this.isDrawn(side)) return true;
    }
    return false;
  }

  private isDrawn(doubled: Place): boolean {
    for (let lod = 0; lod <= kViewLodMax; ++lod) {
      const edge = 2 * this.cells * kStepsPerCell * 2 ** lod;
      const [x, y, z] = doubled.map((at) => Math.floor(at / edge)) as Place;
      if (this.places.has(nameOfKey({ lod, x, y, z }))) return true;
    }
    return false;
  }
}
