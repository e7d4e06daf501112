// Where chunks are: the viewer's half of core/grid/chunk_key.hpp. Pure.

export interface ChunkKey {
  readonly lod: number; // 0 (finest) .. kLodMax
  readonly x: number; // whole chunks of that LOD
  readonly y: number;
  readonly z: number;
}

export interface Vec3 {
  x: number;
  y: number;
  z: number;
}

/// What of a world the place and size of its chunks depend on.
export interface WorldShape {
  cells: number; // per chunk edge
  voxelM: number; // metres per LOD 0 cell, a power of two
  heightLowM: number; // no surface lies outside these heights
  heightHighM: number;
}

/// One text per key, for maps and URLs: `lod/x/y/z`.
export function nameOfKey(key: ChunkKey): string {
  return `${key.lod}/${key.x}/${key.y}/${key.z}`;
}

/// Metres along one edge of a chunk. Exact: voxelM is a power of two.
export function edgeOf(shape: WorldShape, lod: number): number {
  return shape.cells * 2 ** lod * shape.voxelM;
}
