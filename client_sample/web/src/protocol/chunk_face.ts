// The six faces of a chunk and what lies across them: the viewer's half of core/grid/chunk_face.hpp. Pure.

import type { ChunkKey } from './chunk_key';

/// 0 px, 1 nx, 2 py, 3 ny, 4 pz, 5 nz: the direction one leaves the chunk in; also the bit of Chunk.faces.
export type ChunkFace = 0 | 1 | 2 | 3 | 4 | 5;
export const kChunkFaces: readonly ChunkFace[] = [0, 1, 2, 3, 4, 5];

/// One face of one chunk: what a seam strip belongs to.
export interface StripKey {
  key: ChunkKey;
  face: ChunkFace;
}

export function oppositeFace(face: ChunkFace): ChunkFace {
  return (face ^ 1) as ChunkFace;
}

/// The chunk of the same LOD across `face`.
export function neighbourOf({ lod, x, y, z }: ChunkKey, face: ChunkFace): ChunkKey {
  const step = face % 2 === 0 ? 1 : -1;
  return { lod, x: face < 2 ? x + step : x, y: face === 2 || face === 3 ? y + step : y, z: face > 3 ? z + step : z };
}

export function parentOf({ lod, x, y, z }: ChunkKey): ChunkKey {
  return { lod: lod + 1, x: x >> 1, y: y >> 1, z: z >> 1 };
}
