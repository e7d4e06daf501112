// What a client reads out of 3D Tiles and glTF binary, by the specifications alone.

/// Explicit tiles below `tile`, each with its parent.
export function* describedTiles(tile) {
  for (const child of tile.children ?? []) {
    yield { parent: tile, tile: child };
    yield* describedTiles(child);
  }
}

/// One quarter of a box that is subdivided as a quadtree: halves of x and y, all of z.
export function childBox(box, x, y) {
  const out = [...box];
  out[0] += (x - 0.5) * box[3];
  out[1] += (y - 0.5) * box[7];
  out[3] /= 2;
  out[7] /= 2;
  return out;
}

/// A subtree binary: its JSON and its buffer.
export function readSubtree(bytes) {
  if (bytes.readUInt32LE(0) !== 0x74627573 || bytes.readUInt32LE(4) !== 1) throw new Error('not a subtree of version 1');
  const jsonBytes = Number(bytes.readBigUInt64LE(8));
  const binaryBytes = Number(bytes.readBigUInt64LE(16));
  if (jsonBytes % 8 !== 0 || binaryBytes % 8 !== 0 || bytes.length !== 24 + jsonBytes + binaryBytes) throw new Error('a subtree of another length');
  return { json: JSON.parse(bytes.subarray(24, 24 + jsonBytes).toString()), buffer: bytes.subarray(24 + jsonBytes) };
}

/// Bit `index` of an availability of a subtree.
export function isSet(subtree, availability, index) {
  if (availability.constant !== undefined) return availability.constant === 1;
  const view = subtree.json.bufferViews[availability.bitstream];
  if (index >= 8 * view.byteLength) throw new Error(`bit ${index} of ${view.byteLength} bytes`);
  return ((subtree.buffer[view.byteOffset + (index >> 3)] >> (index & 7)) & 1) === 1;
}

/// Every vertex of a glTF binary whose meshes are Draco, where its node puts it.
export function* glbPositions(decoder, draco3d, glb) {
  const jsonBytes = glb.readUInt32LE(12);
  const json = JSON.parse(glb.subarray(20, 20 + jsonBytes).toString());
  const binary = glb.subarray(20 + jsonBytes + 8);
  for (const node of json.nodes ?? []) {
    for (const primitive of json.meshes[node.mesh].primitives) {
      const { bufferView, attributes } = primitive.extensions.KHR_draco_mesh_compression;
      const { byteOffset, byteLength } = json.bufferViews[bufferView];
      const positions = decodedPositions(decoder, binary.subarray(byteOffset, byteOffset + byteLength), attributes.POSITION);
      const accessor = json.accessors[primitive.attributes.POSITION];
      if (accessor.count * 3 !== positions.length) throw new Error(`${positions.length / 3} vertices of ${accessor.count}`);
      const [x, y, z] = node.translation;
      for (let i = 0; i < positions.length; i += 3) yield [positions[i] + x, positions[i + 1] + y, positions[i + 2] + z];
    }
  }
}

function decodedPositions(module, bytes, attribute) {
  const buffer = new module.DecoderBuffer();
  const decoder = new module.Decoder();
  const mesh = new module.Mesh();
  const array = new module.DracoFloat32Array();
  try {
    buffer.Init(new Int8Array(bytes), bytes.length);
    if (!decoder.DecodeBufferToMesh(buffer, mesh).ok()) throw new Error('not a Draco mesh');
    decoder.GetAttributeFloatForAllPoints(mesh, decoder.GetAttributeByUniqueId(mesh, attribute), array);
    return Float32Array.from({ length: array.size() }, (_, i) => array.GetValue(i));
  } finally {
    for (const made of [array, mesh, decoder, buffer]) module.destroy(made);
  }
}
