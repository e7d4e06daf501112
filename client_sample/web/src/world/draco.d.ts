// As much of Draco's WebAssembly decoder as the viewer calls. The file comes with three.js.
declare module 'three/examples/jsm/libs/draco/gltf/draco_wasm_wrapper.js' {
  import type { DracoModule } from './draco_mesh';
  const create: (options: { wasmBinary: ArrayBuffer }) => Promise<DracoModule>;
  export default create;
}
