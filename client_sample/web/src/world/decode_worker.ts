// A worker of the decode pool: Draco bytes in, a packed mesh out, both by transfer.

import createDraco from 'three/examples/jsm/libs/draco/gltf/draco_wasm_wrapper.js';
import wasmUrl from 'three/examples/jsm/libs/draco/gltf/draco_decoder.wasm?url';
import { type DracoModule, decodeDraco } from './draco_mesh';
import { type PackedMesh, packMesh } from './packed_mesh';

export interface DecodeJob {
  id: number;
  payload: Uint8Array<ArrayBuffer>;
  stepM: number; // metres a step of its lattice
}
export type DecodeAnswer = { id: number; mesh: PackedMesh } | { id: number; fault: string };

const draco: Promise<DracoModule> = fetch(wasmUrl)
  .then((response) => response.arrayBuffer())
  .then((wasmBinary) => createDraco({ wasmBinary }));

async function answer(job: DecodeJob): Promise<DecodeAnswer> {
  try {
    return { id: job.id, mesh: packMesh(decodeDraco(await draco, job.payload), job.stepM) };
  } catch (error) {
    return { id: job.id, fault: error instanceof Error ? error.message : String(error) };
  }
}

self.onmessage = async (event: MessageEvent<DecodeJob>) => {
  const done = await answer(event.data);
  const transfer = 'mesh' in done ? [done.mesh.positions.buffer, done.mesh.normals.buffer, done.mesh.indices.buffer] : [];
  (self as unknown as Worker).postMessage(done, transfer);
};
