// A place of the octree as the viewer knows it, with what is held there. Owner: ChunkStore.

import { type ChunkFace, kChunkFaces, neighbourOf, oppositeFace } from '../protocol/chunk_face';
import { type ChunkKey, nameOfKey } from '../protocol/chunk_key';
import { kViewLodMax } from '../protocol/limits';

export interface HeldStrip<Mesh> {
  ready: boolean;
  mesh: Mesh | null; // null: without triangles
  shown: boolean;
}

/// What one place changes from and to in one frame: a coarse chunk for its finer ones, those for it, or nothing for one.
export interface Swap<Mesh> {
  old: ChunkNode<Mesh>[];
  fresh: ChunkNode<Mesh>[];
  on: boolean;
}

/// A face that the surface reaches, and names of what may be drawn across it: the chunk of the same LOD, then its
/// ancestors, finer first.
interface Outlook {
  face: ChunkFace; // of the coarser chunk across
  names: string[];
}

export class ChunkNode<Mesh> {
  readonly name: string;
  wanted = false; // a leaf of the current interest area
  wantedAt_ms = 0;
  held: { revision: bigint; ready: boolean; mesh: Mesh | null; faces: number } | null = null; // mesh: null for air and rock
  strips: (HeldStrip<Mesh> | undefined)[] = [];
  left = false; // the server has stopped counting it as held
  drawn = false;
  next = false; // drawn after the frame that is being decided
  swap: Swap<Mesh> | null = null;
  blocked = 0; // stamp of the last pass that found a wanted chunk missing here or below
  dependants = 0; // children in the map
  private outlookFaces = -1;
  private outlooks: Outlook[] = [];

  constructor(
    readonly key: ChunkKey,
    readonly parent: ChunkNode<Mesh> | null, // null at the coarsest LOD
  ) {
    this.name = nameOfKey(key);
  }

  /// Towards the faces that the surface reaches and that lie on the parent's own. Behind the others are siblings, drawn
  /// whenever this is.
  outlook(): Outlook[] {
    const faces = this.held !== null && (this.held.ready || this.held.mesh !== null) ? this.held.faces : 0;
    if (faces !== this.outlookFaces) {
      this.outlookFaces = faces;
      this.outlooks = kChunkFaces.filter((face) => (faces & (1 << face)) !== 0 && this.isOuter(face)).map((face) => this.look(face));
    }
    return this.outlooks;
  }

  private isOuter(face: ChunkFace): boolean {
    const at = face < 2 ? this.key.x : face < 4 ? this.key.y : this.key.z;
    return (at & 1) === (face % 2 === 0 ? 1 : 0);
  }

  private look(face: ChunkFace): Outlook {
    const names: string[] = [];
    let { lod, x, y, z } = neighbourOf(this.key, face);
    for (; lod <= kViewLodMax; lod += 1, x >>= 1, y >>= 1, z >>= 1) names.push(nameOfKey({ lod, x, y, z }));
    return { face: oppositeFace(face), names };
  }
}
