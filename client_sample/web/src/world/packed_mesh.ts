// A decoded chunk as the GPU takes it: 12 bytes a vertex instead of 26, skirts included. Pure; runs in a worker.
//
// Positions are whole lattice steps (64 to a cell: protocol's lattice), so int16 holds them exactly and the model
// matrix scales them back to metres.
//
// Where neighbours differ by one LOD their surfaces meet at a chunk face along two different curves, and light shines
// through between them. Every border edge therefore carries a skirt: a ribbon in the plane of the face, pointing into
// the rock, with the border's own normals, so that whatever shows through is shaded like the surface beside it.

import type { DecodedMesh } from './draco_mesh';

export const kStepsPerCell = 64;
/// Skirt depth in cells: sections of neighbouring LODs seldom differ by more than one cell of the coarser.
const kSkirtCells = 1.6;

export interface PackedMesh {
  positions: Int16Array<ArrayBuffer>; // four a vertex: x, y, z in steps, material
  normals: Int8Array<ArrayBuffer>; // four a vertex: unit normal * 127, ridge map -127 (crease) .. 127 (ridge)
  indices: Uint16Array<ArrayBuffer> | Uint32Array<ArrayBuffer>;
  surfaceIndices: number; // of `indices`, before the skirts
  low: [number, number, number]; // steps, of the surface and its skirts
  high: [number, number, number];
}

export interface Lattice {
  stepM: number; // metres per step
  edgeSteps: number; // steps per chunk edge
}

interface Border {
  from: number; // vertex, in the order of its triangle
  to: number;
  axis: 0 | 1 | 2; // the face's normal
}

/// The chunk face that both positions lie on, as its axis; -1 if there is none.
function commonFace(steps: Int16Array, a: number, b: number, edge: number): number {
  for (let axis = 0; axis < 3; ++axis) {
    const at = steps[a * 3 + axis]!;
    if ((at === 0 || at === edge) && steps[b * 3 + axis] === at) return axis;
  }
  return -1;
}

function findBorders(steps: Int16Array, indices: Uint32Array, edge: number): Border[] {
  const vertices = steps.length / 3;
  const once = new Map<number, { from: number; to: number }>();
  for (let i = 0; i < indices.length; i += 3) {
    for (let k = 0; k < 3; ++k) {
      const from = indices[i + k]!;
      const to = indices[i + ((k + 1) % 3)]!;
      if (commonFace(steps, from, to, edge) < 0) continue;
      const name = from < to ? from * vertices + to : to * vertices + from;
      if (!once.delete(name)) once.set(name, { from, to });
    }
  }
  return [...once.values()].map(({ from, to }) => ({ from, to, axis: commonFace(steps, from, to, edge) as 0 | 1 | 2 }));
}

class VertexWriter {
  readonly positions: Int16Array<ArrayBuffer>;
  readonly normals: Int8Array<ArrayBuffer>;
  readonly low: [number, number, number] = [32767, 32767, 32767];
  readonly high: [number, number, number] = [-32768, -32768, -32768];
  count = 0;

  constructor(
    private readonly mesh: DecodedMesh,
    capacity: number,
  ) {
    this.positions = new Int16Array(capacity * 4);
    this.normals = new Int8Array(capacity * 4);
  }

  /// Appends vertex `source` of the mesh at (x, y, z), in steps.
  push(source: number, x: number, y: number, z: number): number {
    const index = this.count++;
    const at = [x, y, z];
    for (let axis = 0; axis < 3; ++axis) {
      const step = Math.max(-32768, Math.min(32767, at[axis]!));
      this.positions[index * 4 + axis] = step;
      if (step < this.low[axis]!) this.low[axis] = step;
      if (step > this.high[axis]!) this.high[axis] = step;
      this.normals[index * 4 + axis] = Math.round(this.mesh.normals[source * 3 + axis]! * 127);
    }
    this.positions[index * 4 + 3] = this.mesh.materials[source]!;
    this.normals[index * 4 + 3] = Math.round((this.mesh.ridges[source]! / 255) * 254 - 127);
    return index;
  }
}

/// Where the skirt of a border vertex ends: `depth` steps into the rock, inside the plane of its face.
function skirtEnd(mesh: DecodedMesh, steps: Int16Array, vertex: number, axis: number, depth: number): [number, number, number] {
  const inward: [number, number, number] = [0, 0, 0];
  let length = 0;
  for (let i = 0; i < 3; ++i) {
    inward[i] = i === axis ? 0 : -mesh.normals[vertex * 3 + i]!;
    length += inward[i]! * inward[i]!;
  }
  length = Math.sqrt(length);
  if (length < 0.05) {
    // The surface lies in the face itself: straight down, or for floors and ceilings straight through.
    inward[1] = axis === 1 ? -mesh.normals[vertex * 3 + 1]! : -1;
    length = 1;
  }
  return [0, 1, 2].map((i) => Math.round(steps[vertex * 3 + i]! + (inward[i]! / length) * depth)) as [number, number, number];
}

export function packMesh(mesh: DecodedMesh, lattice: Lattice): PackedMesh {
  const surfaceVertices = mesh.materials.length;
  const steps = new Int16Array(surfaceVertices * 3);
  for (let i = 0; i < steps.length; ++i) steps[i] = Math.round(mesh.positions[i]! / lattice.stepM);

  const borders = findBorders(steps, mesh.indices, lattice.edgeSteps);
  const writer = new VertexWriter(mesh, surfaceVertices + borders.length * 2);
  for (let v = 0; v < surfaceVertices; ++v) writer.push(v, steps[v * 3]!, steps[v * 3 + 1]!, steps[v * 3 + 2]!);

  const ends = new Map<number, number>();
  const endOf = (vertex: number, axis: number): number => {
    const name = vertex * 3 + axis;
    let end = ends.get(name);
    if (end === undefined) {
      end = writer.push(vertex, ...skirtEnd(mesh, steps, vertex, axis, kSkirtCells * kStepsPerCell));
      ends.set(name, end);
    }
    return end;
  };
  const skirt: number[] = [];
  for (const { from, to, axis } of borders) {
    const a = endOf(from, axis);
    const b = endOf(to, axis);
    skirt.push(to, from, a, to, a, b);
  }

  const count = mesh.indices.length + skirt.length;
  const indices = writer.count > 65_535 ? new Uint32Array(count) : new Uint16Array(count);
  indices.set(mesh.indices);
  indices.set(skirt, mesh.indices.length);
  return {
    positions: writer.positions.slice(0, writer.count * 4),
    normals: writer.normals.slice(0, writer.count * 4),
    indices,
    surfaceIndices: mesh.indices.length,
    low: writer.low,
    high: writer.high,
  };
}
