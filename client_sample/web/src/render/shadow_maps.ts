// Three shadow maps around the camera, fine to coarse. The sun does not move, so a map stays good until the camera
// has left its middle or other chunks are drawn; at most one is drawn anew in a frame.

import * as THREE from 'three';
import depthFragment from './shaders/depth.frag?raw';
import depthVertex from './shaders/depth.vert?raw';
import type { TerrainLayer } from './terrain_layer';

const kEdge = 2048;
/// Half the width of each map, metres.
const kReach = [220, 1600, 13_000] as const;
/// Not drawn anew more often than this while chunks stream in.
const kEvery_ms = [350, 700, 1500] as const;
/// How far towards the sun a mountain may stand and still throw its shadow into a map.
const kTowardsSun = 14_000;

interface ShadowMap {
  target: THREE.WebGLRenderTarget;
  camera: THREE.OrthographicCamera;
  reach: number;
  every_ms: number;
  centre: { x: number; y: number; z: number } | null; // world
  edition: number; // of the terrain when it was drawn
  drawnAt_ms: number;
}

export class ShadowMaps {
  readonly uniforms: Record<string, THREE.IUniform>;
  drawCalls = 0;
  private isOn = true;
  private readonly maps: ShadowMap[];
  private readonly material = new THREE.RawShaderMaterial({
    glslVersion: THREE.GLSL3,
    vertexShader: depthVertex,
    fragmentShader: depthFragment,
    side: THREE.DoubleSide,
  });

  constructor(
    private readonly renderer: THREE.WebGLRenderer,
    private readonly sunDirection: THREE.Vector3,
    private readonly reversed: boolean,
  ) {
    this.maps = kReach.map((reach, i) => this.createMap(reach, kEvery_ms[i]!));
    this.uniforms = {
      uShadow0: { value: this.maps[0]!.target.depthTexture },
      uShadow1: { value: this.maps[1]!.target.depthTexture },
      uShadow2: { value: this.maps[2]!.target.depthTexture },
      uShadowPlace: { value: this.maps.map(() => new THREE.Matrix4().makeScale(0, 0, 0)) },
      uShadowTexel: { value: new THREE.Vector3(...kReach.map((reach) => (2 * reach) / kEdge)) },
      uShadowReversed: { value: reversed ? 1 : 0 },
    };
    this.clear();
  }

  /// The sun reaches everywhere: for machines that draw without a GPU, which spend half of a frame here. Before the first
  /// frame.
  turnOff(): void {
    this.isOn = false;
  }

  /// Until a map has been drawn: without depths in them the terrain's shader would be given no shadow textures, and
  /// WebGL would refuse to draw.
  private clear(): void {
    for (const { target } of this.maps) {
      this.renderer.setRenderTarget(target);
      this.renderer.clear();
    }
    this.renderer.setRenderTarget(null);
  }

  /// Draws at most one map. `x, y, z`: the camera, world metres; chunks are placed relative to it.
  update(terrain: TerrainLayer, x: number, y: number, z: number, now_ms: number): void {
    this.drawCalls = 0;
    if (!this.isOn) return;
    let worst: ShadowMap | null = null;
    for (const map of this.maps) {
      if (map.centre === null || this.isStale(map, terrain, x, y, z, now_ms)) {
        if (worst === null || map.drawnAt_ms < worst.drawnAt_ms) worst = map;
      }
    }
    if (worst !== null) this.draw(worst, terrain, x, y, z, now_ms);
    this.maps.forEach((map, i) => {
      if (map.centre !== null) this.place(map, x, y, z, (this.uniforms['uShadowPlace']!.value as THREE.Matrix4[])[i]!);
    });
  }

  private isStale(map: ShadowMap, terrain: TerrainLayer, x: number, y: number, z: number, now_ms: number): boolean {
    const { centre, reach, edition, every_ms, drawnAt_ms } = map;
    if (now_ms - drawnAt_ms < every_ms && centre !== null) return false;
    const away = centre === null ? Infinity : Math.hypot(x - centre.x, y - centre.y, z - centre.z);
    return away > 0.25 * reach || edition !== terrain.edition;
  }

  private createMap(reach: number, every_ms: number): ShadowMap {
    const depthTexture = new THREE.DepthTexture(kEdge, kEdge, THREE.FloatType);
    depthTexture.compareFunction = this.reversed ? THREE.GreaterEqualCompare : THREE.LessEqualCompare;
    depthTexture.magFilter = THREE.LinearFilter;
    depthTexture.minFilter = THREE.LinearFilter;
    const target = new THREE.WebGLRenderTarget(kEdge, kEdge, { depthTexture, format: THREE.RedFormat });
    const camera = new THREE.OrthographicCamera(-reach, reach, reach, -reach, 0, kTowardsSun + 3 * reach);
    // Said before the first frame, so that it is culled with the projection it is drawn with.
    (camera as unknown as { _reversedDepth: boolean })._reversedDepth = this.reversed;
    camera.updateProjectionMatrix();
    camera.matrixAutoUpdate = false;
    camera.matrixWorldAutoUpdate = false;
    return { target, camera, reach, every_ms, centre: null, edition: -1, drawnAt_ms: -Infinity };
  }

  private aim(map: ShadowMap, x: number, y: number, z: number): void {
    const centre = map.centre!;
    const at = new THREE.Vector3(centre.x - x, centre.y - y, centre.z - z);
    const eye = at.clone().addScaledVector(this.sunDirection, kTowardsSun);
    const { camera } = map;
    camera.matrixWorld.lookAt(eye, at, new THREE.Vector3(0, 1, 0)).setPosition(eye);
    camera.matrixWorldInverse.copy(camera.matrixWorld).invert();
  }

  private draw(map: ShadowMap, terrain: TerrainLayer, x: number, y: number, z: number, now_ms: number): void {
    map.centre = { x, y, z };
    map.edition = terrain.edition;
    map.drawnAt_ms = now_ms;
    this.aim(map, x, y, z);
    const before = this.renderer.info.render.calls;
    terrain.scene.overrideMaterial = this.material;
    this.renderer.setRenderTarget(map.target);
    this.renderer.clear();
    this.renderer.render(terrain.scene, map.camera);
    this.renderer.setRenderTarget(null);
    terrain.scene.overrideMaterial = null;
    this.drawCalls = this.renderer.info.render.calls - before;
  }

  /// Camera-relative metres -> the map's square and depth, both 0..1, depth 0 towards the sun.
  private place(map: ShadowMap, x: number, y: number, z: number, out: THREE.Matrix4): void {
    this.aim(map, x, y, z);
    const { reach, camera } = map;
    const scale = 0.5 / reach;
    const depth = 1 / camera.far;
    out.set(scale, 0, 0, 0.5, 0, scale, 0, 0.5, 0, 0, -depth, 0, 0, 0, 0, 1).multiply(camera.matrixWorldInverse);
  }
}
