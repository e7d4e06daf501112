// The chunks and strips on the GPU: one mesh and one draw call each, one material for all. They are placed relative to
// the camera every frame, in doubles, so that a world 10^9 m wide does not shake.

import * as THREE from 'three';
import type { ChunkKey, WorldShape } from '../protocol/chunk_key';
import { edgeOf } from '../protocol/chunk_key';
import { type PackedMesh, kStepsPerCell } from '../world/packed_mesh';
import type { PlacedSurface } from '../world/surface_index';
import { Fades } from './fades';
import type { SharedUniforms } from './shared_uniforms';
import { kAtmosphere, kHeader } from './shared_uniforms';
import fadeShader from './shaders/fade.glsl?raw';
import seamShader from './shaders/seam.frag?raw';
import shadowShader from './shaders/shadow.glsl?raw';
import fragmentShader from './shaders/terrain.frag?raw';
import vertexShader from './shaders/terrain.vert?raw';
import { strataTable } from './tables';

const kPaletteSize = 32; // of the shaders' array: seven covers, then rocks

/// A chunk that can be drawn and stood on, or the strip of one of its faces.
export class ChunkMesh implements PlacedSurface {
  readonly object: THREE.Mesh;
  readonly cornerX: number;
  readonly cornerY: number;
  readonly cornerZ: number;
  readonly stepM: number;
  readonly cells: number;
  readonly positions: Int16Array;
  readonly indices: Uint16Array | Uint32Array;

  constructor(
    readonly key: ChunkKey,
    shape: WorldShape,
    packed: PackedMesh,
    readonly isStrip: boolean,
  ) {
    const edge = edgeOf(shape, key.lod);
    this.cornerX = key.x * edge;
    this.cornerY = key.y * edge;
    this.cornerZ = key.z * edge;
    this.cells = shape.cells;
    // A strip lies on the lattice of the finer chunks it closes to.
    this.stepM = edge / shape.cells / kStepsPerCell / (isStrip ? 2 : 1);
    this.positions = packed.positions;
    this.indices = packed.indices;

    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(packed.positions, 4));
    geometry.setAttribute('normal', new THREE.BufferAttribute(packed.normals, 4, true));
    geometry.setIndex(new THREE.BufferAttribute(packed.indices, 1));
    const low = new THREE.Vector3(...packed.low);
    const high = new THREE.Vector3(...packed.high);
    geometry.boundingSphere = new THREE.Box3(low, high).getBoundingSphere(new THREE.Sphere());
    this.object = new THREE.Mesh(geometry);
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
  /// Triangles as lines, and strips in a colour of their own.
  private wire = false;
  private seams = false;
  private readonly fading: THREE.RawShaderMaterial;
  private readonly fades: Fades<ChunkMesh>;
  private readonly seamMaterial: THREE.RawShaderMaterial;
  private readonly placed = new Set<ChunkMesh>(); // shown or leaving
  private readonly disposals = new Set<ChunkMesh>(); // when they have left

  constructor(shared: SharedUniforms, shadow: Record<string, THREE.IUniform>) {
    const uniforms = {
      ...shared,
      ...shadow,
      uStrataThick: { value: strataTable(20261122, 60) },
      uStrataThin: { value: strataTable(4711, 34) },
      uPalette: { value: Array.from({ length: kPaletteSize }, () => new THREE.Color(0.4, 0.4, 0.4)) },
    };
    const ground = (defines: Record<string, number>): THREE.RawShaderMaterial =>
      new THREE.RawShaderMaterial({
        glslVersion: THREE.GLSL3,
        vertexShader,
        fragmentShader: kHeader + kAtmosphere + shadowShader + fadeShader + fragmentShader,
        uniforms: { ...uniforms }, // their values are shared
        defines,
      });
    this.material = ground({});
    this.fading = ground({ FADING: 1 });
    this.fades = new Fades(this.fading);
    this.seamMaterial = new THREE.RawShaderMaterial({
      glslVersion: THREE.GLSL3,
      vertexShader,
      fragmentShader: seamShader,
      uniforms: { ...shared },
      wireframe: true, // most strips are thinner than a pixel
    });
    this.scene.matrixWorldAutoUpdate = false;
  }

  get overlay(): { wire: boolean; seams: boolean } {
    return { wire: this.wire, seams: this.seams };
  }

  setOverlay(wire: boolean, seams: boolean): void {
    this.wire = wire;
    this.seams = seams;
    this.material.wireframe = wire;
    this.fading.wireframe = wire;
    for (const chunk of this.placed) if (!this.fades.has(chunk)) this.dress(chunk);
  }

  /// Colours of the world's materials, `#rrggbb` or 0xRRGGBB, in the order of their indices.
  setPalette(colours: (string | number)[]): void {
    const palette = this.material.uniforms['uPalette']!.value as THREE.Color[];
    colours.slice(0, kPaletteSize).forEach((colour, i) => palette[i]!.set(colour));
  }

  show(chunk: ChunkMesh): void {
    this.placed.add(chunk);
    this.scene.add(chunk.object);
    this.edition += 1;
    this.fades.begin(chunk, false, () => this.dress(chunk));
  }

  hide(chunk: ChunkMesh): void {
    this.edition += 1;
    this.fades.begin(chunk, true, () => {
      this.placed.delete(chunk);
      this.scene.remove(chunk.object);
      this.edition += 1;
      if (this.disposals.delete(chunk)) chunk.dispose();
    });
  }

  /// A hidden chunk is not shown again; what is still leaving goes when it has left.
  dispose(chunk: ChunkMesh): void {
    if (this.fades.isLeaving(chunk)) this.disposals.add(chunk);
    else chunk.dispose();
  }

  /// Once a frame, before it is drawn.
  update(x: number, y: number, z: number, now_ms: number): void {
    this.fades.advance(now_ms);
    for (const chunk of this.placed) chunk.placeRelativeTo(x, y, z);
  }

  private dress(chunk: ChunkMesh): void {
    chunk.object.material = this.seams && chunk.isStrip ? this.seamMaterial : this.material;
  }

  /// Chunks and strips in the scene that are there to stay.
  get shown(): number {
    let count = 0;
    for (const chunk of this.placed) if (!this.fades.isLeaving(chunk) && chunk.object.parent === this.scene) count += 1;
    return count;
  }

  get triangles(): number {
    let sum = 0;
    for (const chunk of this.placed) if (!this.fades.isLeaving(chunk)) sum += chunk.indices.length / 3;
    return sum;
  }
}
