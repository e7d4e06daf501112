// The chunks on the GPU: one mesh and one draw call each, one material for all. Chunks are placed relative to the
// camera every frame, in doubles, so that a world 10^9 m wide does not shake.

import * as THREE from 'three';
import type { ChunkKey, WorldShape } from '../protocol/chunk_key';
import { edgeOf } from '../protocol/chunk_key';
import { type PackedMesh, kStepsPerCell } from '../world/packed_mesh';
import type { PlacedSurface } from '../world/surface_index';
import type { SharedUniforms } from './shared_uniforms';
import { kAtmosphere, kHeader } from './shared_uniforms';
import shadowShader from './shaders/shadow.glsl?raw';
import fragmentShader from './shaders/terrain.frag?raw';
import vertexShader from './shaders/terrain.vert?raw';
import { strataTable } from './tables';

const kPaletteSize = 7;

/// A chunk that can be drawn and stood on.
export class ChunkMesh implements PlacedSurface {
  readonly object: THREE.Mesh;
  readonly cornerX: number;
  readonly cornerY: number;
  readonly cornerZ: number;
  readonly stepM: number;
  readonly cells: number;
  readonly positions: Int16Array;
  readonly indices: Uint16Array | Uint32Array;
  readonly surfaceIndices: number;

  constructor(
    readonly key: ChunkKey,
    shape: WorldShape,
    packed: PackedMesh,
    material: THREE.Material,
  ) {
    const edge = edgeOf(shape, key.lod);
    this.cornerX = key.x * edge;
    this.cornerY = key.y * edge;
    this.cornerZ = key.z * edge;
    this.cells = shape.cells;
    this.stepM = edge / shape.cells / kStepsPerCell;
    this.positions = packed.positions;
    this.indices = packed.indices;
    this.surfaceIndices = packed.surfaceIndices;

    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(packed.positions, 4));
    geometry.setAttribute('normal', new THREE.BufferAttribute(packed.normals, 4, true));
    geometry.setIndex(new THREE.BufferAttribute(packed.indices, 1));
    const low = new THREE.Vector3(...packed.low);
    const high = new THREE.Vector3(...packed.high);
    geometry.boundingSphere = new THREE.Box3(low, high).getBoundingSphere(new THREE.Sphere());
    this.object = new THREE.Mesh(geometry, material);
    this.object.matrixAutoUpdate = false;
    this.object.matrixWorldAutoUpdate = false;
  }

  placeRelativeTo(x: number, y: number, z: number): void {
    const s = this.stepM;
    this.object.matrixWorld.set(
      s, 0, 0, this.cornerX - x, //
      0, s, 0, this.cornerY - y,
      0, 0, s, this.cornerZ - z,
      0, 0, 0, 1,
    );
  }

  dispose(): void {
    this.object.geometry.dispose();
  }
}

export class TerrainLayer {
  readonly scene = new THREE.Scene();
  readonly material: THREE.RawShaderMaterial;
  /// Changes whenever the set of shown chunks does.
  edition = 0;
  private readonly shown = new Set<ChunkMesh>();

  constructor(shared: SharedUniforms, shadow: Record<string, THREE.IUniform>) {
    this.material = new THREE.RawShaderMaterial({
      glslVersion: THREE.GLSL3,
      vertexShader,
      fragmentShader: kHeader + kAtmosphere + shadowShader + fragmentShader,
      uniforms: {
        ...shared,
        ...shadow,
        uStrataThick: { value: strataTable(20261122, 60) },
        uStrataThin: { value: strataTable(4711, 34) },
        uPalette: { value: Array.from({ length: kPaletteSize }, () => new THREE.Color(0.4, 0.4, 0.4)) },
      },
    });
    this.scene.matrixWorldAutoUpdate = false;
  }

  /// Colours of the world's materials, `#rrggbb` or 0xRRGGBB, in the order of their indices.
  setPalette(colours: (string | number)[]): void {
    const palette = this.material.uniforms['uPalette']!.value as THREE.Color[];
    colours.slice(0, kPaletteSize).forEach((colour, i) => palette[i]!.set(colour));
  }

  show(chunk: ChunkMesh): void {
    this.shown.add(chunk);
    this.scene.add(chunk.object);
    this.edition += 1;
  }

  hide(chunk: ChunkMesh): void {
    this.shown.delete(chunk);
    this.scene.remove(chunk.object);
    this.edition += 1;
  }

  placeRelativeTo(x: number, y: number, z: number): void {
    for (const chunk of this.shown) chunk.placeRelativeTo(x, y, z);
  }

  get triangles(): number {
    let sum = 0;
    for (const chunk of this.shown) sum += chunk.surfaceIndices / 3;
    return sum;
  }
}
