// Textures that are computed once, at the start: the sky by direction, the noise, the strata. Nothing is downloaded.

import * as THREE from 'three';
import fullScreenVertex from './shaders/full_screen.vert?raw';
import noiseFragment from './shaders/noise_table.frag?raw';
import skyFragment from './shaders/sky_table.frag?raw';

const kNoiseEdge = 512;
const kSkyWidth = 128;
const kSkyHeight = 96;
/// Irradiance of the sun above the air, in the unit of all radiances here.
export const kSunPower = 22;

export function fullScreenMaterial(fragmentShader: string, uniforms: Record<string, THREE.IUniform>): THREE.RawShaderMaterial {
  return new THREE.RawShaderMaterial({
    glslVersion: THREE.GLSL3,
    vertexShader: fullScreenVertex,
    fragmentShader,
    uniforms: { uClipDepth: { value: 0 }, ...uniforms },
    depthTest: false,
    depthWrite: false,
  });
}

/// A triangle that covers the screen, wherever the camera looks.
export function fullScreenMesh(material: THREE.Material): THREE.Mesh {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(9), 3));
  const mesh = new THREE.Mesh(geometry, material);
  mesh.frustumCulled = false;
  return mesh;
}

function renderOnce(renderer: THREE.WebGLRenderer, target: THREE.WebGLRenderTarget, material: THREE.RawShaderMaterial): void {
  const scene = new THREE.Scene();
  scene.add(fullScreenMesh(material));
  renderer.setRenderTarget(target);
  renderer.render(scene, new THREE.OrthographicCamera());
  renderer.setRenderTarget(null);
  material.dispose();
}

export function noiseTable(renderer: THREE.WebGLRenderer): THREE.Texture {
  const target = new THREE.WebGLRenderTarget(kNoiseEdge, kNoiseEdge, {
    depthBuffer: false,
    generateMipmaps: true,
    minFilter: THREE.LinearMipmapLinearFilter,
    wrapS: THREE.RepeatWrapping,
    wrapT: THREE.RepeatWrapping,
    anisotropy: 8,
  });
  renderOnce(renderer, target, fullScreenMaterial(noiseFragment, {}));
  return target.texture;
}

export interface SkyTable {
  texture: THREE.Texture;
  above: THREE.Color; // irradiance / pi on a level plane
  around: THREE.Color; // on an upright one
}

export function skyTable(renderer: THREE.WebGLRenderer, sunDirection: THREE.Vector3): SkyTable {
  const target = new THREE.WebGLRenderTarget(kSkyWidth, kSkyHeight, { depthBuffer: false, type: THREE.HalfFloatType });
  const uniforms = { uSunDirection: { value: sunDirection }, uSunPower: { value: kSunPower } };
  renderOnce(renderer, target, fullScreenMaterial(skyFragment, uniforms));
  const halves = new Uint16Array(kSkyWidth * kSkyHeight * 4);
  renderer.readRenderTargetPixels(target, 0, 0, kSkyWidth, kSkyHeight, halves);
  return { texture: target.texture, ...skyIrradiance(halves) };
}

/// Integrates the table over the upper hemisphere. Row r holds directions of height up = (r / rows)^2, so it spans
/// 2 * (r / rows) / rows of it.
function skyIrradiance(halves: Uint16Array): { above: THREE.Color; around: THREE.Color } {
  const above = [0, 0, 0];
  const around = [0, 0, 0];
  for (let row = 0; row < kSkyHeight; ++row) {
    const root = (row + 0.5) / kSkyHeight;
    const up = root * root;
    const share = (2 * root) / kSkyHeight / kSkyWidth;
    for (let column = 0; column < kSkyWidth; ++column) {
      for (let c = 0; c < 3; ++c) {
        const radiance = THREE.DataUtils.fromHalfFloat(halves[(row * kSkyWidth + column) * 4 + c]!);
        above[c]! += 2 * radiance * up * share;
        around[c]! += (2 / Math.PI) * radiance * Math.sqrt(1 - up * up) * share;
      }
    }
  }
  return { above: new THREE.Color(...(above as [number, number, number])), around: new THREE.Color(...(around as [number, number, number])) };
}

/// What the air leaves of the sun, by the table's own coefficients along a flat path; good above 5 degrees.
export function sunAtGround(sunDirection: THREE.Vector3): THREE.Color {
  const airMass = 1 / (sunDirection.y + 0.02);
  const depth = (rayleigh: number, ozone: number): number => (rayleigh * 8000 + 5.0e-6 * 1.11 * 1200 + ozone * 15_000) * airMass;
  const left = [depth(5.8e-6, 0.65e-6), depth(13.5e-6, 1.88e-6), depth(33.1e-6, 0.085e-6)].map((d) => kSunPower * Math.exp(-d));
  return new THREE.Color(...(left as [number, number, number]));
}

const kStrataTints = [
  [1.3, 1.24, 1.14],
  [0.92, 0.96, 1.0],
  [1.1, 1.01, 0.91],
  [0.6, 0.6, 0.63],
  [1.5, 1.45, 1.36],
  [1.0, 0.89, 0.79],
  [0.78, 0.8, 0.82],
  [1.2, 1.15, 1.08],
] as const;
const kStrataTexels = 1024;

/// Colours of rock beds by height, repeating; `bedTexels` is their mean thickness. 0.5 leaves the rock as it is.
export function strataTable(seed: number, bedTexels: number): THREE.DataTexture {
  const data = new Uint8Array(kStrataTexels * 4);
  let state = seed;
  const random = (): number => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 2 ** 32;
  };
  for (let at = 0; at < kStrataTexels; ) {
    const thickness = Math.max(4, Math.round(-Math.log(1 - random() * 0.97) * bedTexels));
    const tint = kStrataTints[Math.floor(random() * kStrataTints.length)]!;
    const shade = 0.94 + 0.12 * random();
    for (let i = 0; i < thickness && at < kStrataTexels; ++i, ++at) {
      // Beds darken at their foot, where the one below juts out and keeps the sky away.
      const foot = 1 - 0.22 * Math.exp(-i / 3);
      for (let c = 0; c < 3; ++c) data[at * 4 + c] = Math.min(255, tint[c]! * shade * foot * 127.5);
      data[at * 4 + 3] = 255;
    }
  }
  const texture = new THREE.DataTexture(data, kStrataTexels, 1);
  texture.wrapS = THREE.RepeatWrapping;
  texture.magFilter = THREE.LinearFilter;
  texture.minFilter = THREE.LinearMipmapLinearFilter;
  texture.generateMipmaps = true;
  texture.needsUpdate = true;
  return texture;
}
