// A worker of the decode pool: a payload in either format in, a packed mesh out, both by transfer.

import createDraco from 'three/examples/jsm/libs/draco/gltf/draco_wasm_wrapper.js';
import wasmUrl from 'three/examples/jsm/libs/draco/gltf/draco_decoder.wasm?url';
import { MeshoptDecoder } from 'three/examples/jsm/libs/meshopt_decoder.module.js';
import { type DracoModule, decodeDraco } from './draco_mesh';
import { decodeMesh, isMesh } from './lattice_mesh';
import { type PackedMesh, packMesh } from './packed_mesh';

export interface DecodeJob {
  id: number;
  payload: Uint8Array<ArrayBuffer>;
  stepM: number; // metres a step of its lattice
}
export type DecodeAnswer = { id: number; mesh: PackedMesh } | { id: number; fault: string };

/// Loaded when the first Draco payload comes: 300 kB that a stream of meshes does not need.
let draco: Promise<DracoModule> | undefined;
function loadDraco(): Promise<DracoModule> {
  draco ??= fetch(wasmUrl)
    .then((response) => response.arrayBuffer())
    .then((wasmBinary) => createDraco({ wasmBinary }));
  return draco;
}

async function decode(payload: Uint8Array, stepM: number): Promise<PackedMesh> {
  if (!isMesh(payload)) return packMesh(decodeDraco(await loadDraco(), payload), stepM);
  await MeshoptDecoder.ready;
  return decodeMesh(MeshoptDecoder, payload, stepM);
}

async function answer(job: DecodeJob): Promise<DecodeAnswer> {
  try {
    return { id: job.id, mesh: await decode(job.payload, job.stepM) };
  } catch (error) {
    return { id: job.id, fault: error instanceof Error ? error.message : String(error) };
  }
}

self.onmessage = async (event: MessageEvent<DecodeJob>) => {
  const done = await answer(event.data);
  const transfer = 'mesh' in done ? [done.mesh.positions.buffer, done.mesh.normals.buffer, done.mesh.indices.buffer] : [];
  (self as unknown as Worker).postMessage(done, transfer);
};
