// One Draco payload -> plain arrays. SPEC.md, "Draco payload": POSITION in chunk-local metres, NORMAL, material (unique
// id 2) and ridge map (unique id 3). Runs in a worker; owns nothing of Draco's heap when it returns.

export interface DracoModule {
  Decoder: new () => DracoDecoder;
  Mesh: new () => DracoMesh;
  DT_FLOAT32: number;
  DT_UINT8: number;
  TRIANGULAR_MESH: number;
  POSITION: number;
  NORMAL: number;
  HEAPU8: Uint8Array;
  _malloc(bytes: number): number;
  _free(pointer: number): void;
  destroy(object: object): void;
}
interface DracoMesh {
  ptr: number;
  num_points(): number;
  num_faces(): number;
}
interface DracoStatus {
  ok(): boolean;
  error_msg(): string;
}
interface DracoDecoder {
  DecodeArrayToMesh(data: Uint8Array, bytes: number, mesh: DracoMesh): DracoStatus;
  GetAttributeId(mesh: DracoMesh, type: number): number;
  GetAttribute(mesh: DracoMesh, id: number): object;
  GetAttributeByUniqueId(mesh: DracoMesh, id: number): { ptr: number };
  GetAttributeDataArrayForAllPoints(mesh: DracoMesh, attribute: object, type: number, bytes: number, out: number): boolean;
  GetTrianglesUInt32Array(mesh: DracoMesh, bytes: number, out: number): boolean;
}

export interface DecodedMesh {
  positions: Float32Array; // chunk-local metres
  normals: Float32Array;
  materials: Uint8Array;
  ridges: Uint8Array; // 0 (crease) .. 255 (ridge)
  indices: Uint32Array;
}

const kMaterialId = 2;
const kRidgeId = 3;
/// A chunk of 32^3 cells has at most 5 triangles a cell.
const kPointsMax = 33 * 33 * 33 * 3;

function copyOut(draco: DracoModule, bytes: number, fill: (pointer: number) => boolean): ArrayBuffer {
  const pointer = draco._malloc(bytes);
  try {
    if (!fill(pointer)) throw new Error('an attribute has another type than the specification says');
    return draco.HEAPU8.slice(pointer, pointer + bytes).buffer as ArrayBuffer;
  } finally {
    draco._free(pointer);
  }
}

/// Throws on bytes that are not such a mesh.
export function decodeDraco(draco: DracoModule, payload: Uint8Array): DecodedMesh {
  const decoder = new draco.Decoder();
  const mesh = new draco.Mesh();
  try {
    const status = decoder.DecodeArrayToMesh(payload, payload.length, mesh);
    if (!status.ok() || mesh.ptr === 0) throw new Error(status.error_msg());
    const points = mesh.num_points();
    if (points > kPointsMax) throw new Error(`${points} vertices in one chunk`);

    const attribute = (found: object, type: number, bytes: number): ArrayBuffer => {
      if ((found as { ptr: number }).ptr === 0) throw new Error('an attribute is missing');
      return copyOut(draco, bytes, (out) => decoder.GetAttributeDataArrayForAllPoints(mesh, found, type, bytes, out));
    };
    const position = decoder.GetAttribute(mesh, decoder.GetAttributeId(mesh, draco.POSITION));
    const normal = decoder.GetAttribute(mesh, decoder.GetAttributeId(mesh, draco.NORMAL));
    const material = decoder.GetAttributeByUniqueId(mesh, kMaterialId);
    const ridge = decoder.GetAttributeByUniqueId(mesh, kRidgeId);
    const indexBytes = mesh.num_faces() * 12;
    return {
      positions: new Float32Array(attribute(position, draco.DT_FLOAT32, points * 12)),
      normals: new Float32Array(attribute(normal, draco.DT_FLOAT32, points * 12)),
      materials: new Uint8Array(attribute(material, draco.DT_UINT8, points)),
      ridges: new Uint8Array(attribute(ridge, draco.DT_UINT8, points)),
      indices: new Uint32Array(copyOut(draco, indexBytes, (out) => decoder.GetTrianglesUInt32Array(mesh, indexBytes, out))),
    };
  } finally {
    draco.destroy(mesh);
    draco.destroy(decoder);
  }
}
