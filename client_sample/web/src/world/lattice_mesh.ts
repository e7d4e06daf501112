// One mesh payload -> what the GPU takes. SPEC.md, "Mesh payload". meshoptimizer's decoder checks its own streams;
// everything else is checked here, before anything is allocated. Pure; runs in a worker.

import { kServerMessageBytesMax } from '../protocol/limits';
import { type PackedMesh, kStepsPerCell } from './packed_mesh';

/// As much of meshoptimizer's decoder as the viewer calls; it comes with three.js. Both throw on malformed streams.
export interface MeshoptModule {
  decodeVertexBuffer(target: Uint8Array, count: number, size: number, source: Uint8Array): void;
  decodeIndexBuffer(target: Uint8Array, count: number, size: number, source: Uint8Array): void;
}

const kHeaderBytes = 24;
const kVertexBytes = 8;
/// A chunk has at most 32 cells along an edge, a strip twice as many. (And steps of 64 cells fit the GPU's int16.)
const kCellsMax = 64;
/// A chunk of 32^3 cells has at most 5 triangles a cell.
const kTrianglesMax = 5 * 32 ** 3;

function requireThat(holds: boolean, what: string): asserts holds {
  if (!holds) throw new Error(`not a mesh: ${what}`);
}

/// Whether a payload says it is of this format.
export function isMesh(payload: Uint8Array): boolean {
  return payload.length >= 4 && payload[0] === 0x74 && payload[1] === 0x6c && payload[2] === 0x73 && payload[3] === 0x6d;
}

/// Throws on bytes that are no mesh on a lattice whose step is `stepM` metres: drawn at another, it would be of the wrong
/// size.
export function decodeMesh(meshopt: MeshoptModule, payload: Uint8Array, stepM: number): PackedMesh {
  requireThat(payload.length >= kHeaderBytes && payload.length <= kServerMessageBytesMax, `${payload.length} bytes`);
  const head = new DataView(payload.buffer, payload.byteOffset, payload.byteLength);
  requireThat(isMesh(payload), 'the first bytes are those of something else');
  requireThat(head.getUint8(4) === 1, `version ${head.getUint8(4)}`);
  const cells = head.getUint8(5);
  requireThat(cells >= 1 && cells <= kCellsMax && head.getUint16(6, true) === 0, `${cells} cells`);
  const said = head.getFloat32(8, true);
  requireThat(said === stepM, `its step is ${said} m, that of its place ${stepM} m`); // powers of two: exact as floats
  const count = head.getUint32(12, true);
  const triangles = head.getUint32(16, true);
  const indexBytes = head.getUint32(20, true);
  requireThat(triangles >= 1 && triangles <= kTrianglesMax, `${triangles} triangles`);
  requireThat(count >= 1 && count <= 3 * triangles, `${count} vertices`);
  requireThat(indexBytes <= payload.length - kHeaderBytes, 'its indices are cut');

  const indices = count > 65_535 ? new Uint32Array(3 * triangles) : new Uint16Array(3 * triangles);
  const vertices = new Uint8Array(count * kVertexBytes);
  const indexEnd = kHeaderBytes + indexBytes;
  meshopt.decodeIndexBuffer(
    new Uint8Array(indices.buffer), 3 * triangles, indices.BYTES_PER_ELEMENT, payload.subarray(kHeaderBytes, indexEnd));
  meshopt.decodeVertexBuffer(vertices, count, kVertexBytes, payload.subarray(indexEnd));
  let last = 0;
  for (let i = 0; i < indices.length; ++i) last = Math.max(last, indices[i]!);
  requireThat(last < count, `vertex ${last} of ${count}`);
  return { ...unpackVertices(vertices, count, cells), indices };
}

function unpackVertices(vertices: Uint8Array, count: number, cells: number): Omit<PackedMesh, 'indices'> {
  const positions = new Int16Array(count * 4);
  const normals = new Int8Array(count * 4);
  const signed = new Int8Array(vertices.buffer);
  const low: [number, number, number] = [32767, 32767, 32767];
  const high: [number, number, number] = [-1, -1, -1];
  let edgeMax = 0;
  for (let v = 0; v < count; ++v) {
    const from = v * kVertexBytes;
    const to = v * 4;
    const edge = vertices[from + 3]!;
    edgeMax = Math.max(edgeMax, edge);
    for (let axis = 0; axis < 3; ++axis) positions[to + axis] = vertices[from + axis]! * kStepsPerCell;
    positions[to + (edge >> 6)]! += edge & (kStepsPerCell - 1);
    for (let axis = 0; axis < 3; ++axis) {
      const step = positions[to + axis]!;
      if (step < low[axis]!) low[axis] = step;
      if (step > high[axis]!) high[axis] = step;
    }
    positions[to + 3] = vertices[from + 6]!;

    // Octahedral around +y, in 127ths.
    let x = signed[from + 4]! / 127;
    let z = signed[from + 5]! / 127;
    const y = 1 - Math.abs(x) - Math.abs(z);
    if (y < 0) {
      const folded = x < 0 ? Math.abs(z) - 1 : 1 - Math.abs(z);
      z = z < 0 ? Math.abs(x) - 1 : 1 - Math.abs(x);
      x = folded;
    }
    const scale = 127 / Math.sqrt(x * x + y * y + z * z);
    normals[to] = Math.round(x * scale);
    normals[to + 1] = Math.round(y * scale);
    normals[to + 2] = Math.round(z * scale);
    normals[to + 3] = Math.round((vertices[from + 7]! / 255) * 254 - 127);
  }
  requireThat(edgeMax >> 6 < 3, 'an edge along no axis');
  requireThat(Math.max(...high) <= cells * kStepsPerCell, 'a vertex is outside its chunk');
  return { positions, normals, low, high };
}
