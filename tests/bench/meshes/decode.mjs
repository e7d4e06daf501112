// Times what the browser does with a payload: decoding by the WebAssembly modules that come with three.js, in one thread.
//
//   build/bench/bin/talus_mesh_bench FOLDER && node tests/bench/meshes/decode.mjs FOLDER
//
// Draco is decoded by the viewer's own source. Times are CPU time, after a warm-up round.
import { readdirSync, readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';

const web = join(import.meta.dirname ?? new URL('.', import.meta.url).pathname, '../../../client_sample/web');
const require = createRequire(join(web, 'package.json'));
const { buildSync } = require('esbuild');

/// A module of the viewer, as JavaScript.
async function viewerModule(path) {
  const built = buildSync({ entryPoints: [join(web, 'src', path)], bundle: true, format: 'esm', write: false });
  return import(`data:text/javascript;base64,${Buffer.from(built.outputFiles[0].contents).toString('base64')}`);
}

const libs = join(web, 'node_modules/three/examples/jsm/libs');
/// The wrapper is a script, not a module: it leaves a name behind.
const wrapper = readFileSync(join(libs, 'draco/gltf/draco_wasm_wrapper.js'), 'utf8');
const createDraco = new Function('require', '__dirname', '__filename', `${wrapper}; return DracoDecoderModule;`)(require, libs, '');
const draco = await createDraco({ wasmBinary: readFileSync(join(libs, 'draco/gltf/draco_decoder.wasm')) });
const { MeshoptDecoder } = await import(pathToFileURL(join(libs, 'meshopt_decoder.module.js')));
await MeshoptDecoder.ready;
const { decompress } = require('fzstd');
const { decodeDraco } = await viewerModule('world/draco_mesh.ts');
const { packMesh } = await viewerModule('world/packed_mesh.ts');
const { decodeMesh } = await viewerModule('world/lattice_mesh.ts');

const kHeaderBytes = 24;
const kStepM = 1 / 64; // LOD 0

/// The payload as it would be without its zstd frame.
function unpacked(payload) {
  const content = decompress(payload.subarray(kHeaderBytes));
  const out = new Uint8Array(kHeaderBytes + content.length);
  out.set(payload.subarray(0, kHeaderBytes));
  out.set(content, kHeaderBytes);
  return out;
}

const decoders = {
  draco: (payload) => packMesh(decodeDraco(draco, payload), kStepM),
  mesh: (payload) => decodeMesh(MeshoptDecoder, payload, kStepM),
  'mesh+zstd': (payload) => decodeMesh(MeshoptDecoder, unpacked(payload), kStepM),
};

const folder = process.argv[2];
const kRounds = 12;
console.log('us to decode and pack for the GPU'.padStart(67));
for (const number of readdirSync(folder).sort((a, b) => a - b)) {
  const [kind, name] = readFileSync(join(folder, number, 'carrier'), 'utf8').split('\n');
  const payloads = readdirSync(join(folder, number))
    .filter((file) => file.endsWith('.bin'))
    .map((file) => new Uint8Array(readFileSync(join(folder, number, file))));
  let best = Infinity;
  try {
    for (let round = 0; round <= kRounds; round += 1) {
      const began = process.cpuUsage();
      for (const payload of payloads) decoders[kind](payload);
      const spent = process.cpuUsage(began);
      if (round > 0) best = Math.min(best, (spent.user + spent.system) / payloads.length);
    }
    console.log(`  ${name.padEnd(52)} ${best.toFixed(0).padStart(12)}`);
  } catch (error) {
    console.log(`  ${name.padEnd(52)} ${error}`);
  }
}
