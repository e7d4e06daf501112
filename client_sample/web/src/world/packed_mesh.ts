// A decoded chunk or strip as the GPU takes it: 12 bytes a vertex instead of 26. Pure; runs in a worker.
//
// Positions are whole lattice steps (64 to a cell: protocol's lattice), so int16 holds them exactly and the model
// matrix scales them back to metres.

import type { DecodedMesh } from './draco_mesh';

export const kStepsPerCell = 64;

export interface PackedMesh {
  positions: Int16Array<ArrayBuffer>; // four a vertex: x, y, z in steps, material
  normals: Int8Array<ArrayBuffer>; // four a vertex: unit normal * 127, ridge map -127 (crease) .. 127 (ridge)
  indices: Uint16Array<ArrayBuffer> | Uint32Array<ArrayBuffer>;
  low: [number, number, number]; // steps
  high: [number, number, number];
}

export function packMesh(mesh: DecodedMesh, stepM: number): PackedMesh {
  const count = mesh.materials.length;
  const positions = new Int16Array(count * 4);
  const normals = new Int8Array(count * 4);
  const low: [number, number, number] = [32767, 32767, 32767];
  const high: [number, number, number] = [-32768, -32768, -32768];
  for (let v = 0; v < count; ++v) {
    for (let axis = 0; axis < 3; ++axis) {
      const step = Math.round(mesh.positions[v * 3 + axis]! / stepM);
      positions[v * 4 + axis] = step;
      low[axis] = Math.min(low[axis]!, step);
      high[axis] = Math.max(high[axis]!, step);
      normals[v * 4 + axis] = Math.round(mesh.normals[v * 3 + axis]! * 127);
    }
    positions[v * 4 + 3] = mesh.materials[v]!;
    normals[v * 4 + 3] = Math.round((mesh.ridges[v]! / 255) * 254 - 127);
  }
  const indices = count > 65_535 ? mesh.indices.slice() : new Uint16Array(mesh.indices);
  return { positions, normals, indices: indices as PackedMesh['indices'], low, high };
}
