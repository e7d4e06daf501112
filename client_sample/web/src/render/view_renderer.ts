// A frame: shadow maps, then terrain and sky into a linear target, then the sea, the air and the tone curve onto the
// screen. The camera stands at the origin and only turns; everything else is placed relative to it.

import * as THREE from 'three';
import { ShadowMaps } from './shadow_maps';
import { type SharedUniforms, kAtmosphere, kHeader, placeInPeriod, sharedUniforms } from './shared_uniforms';
import seaFragment from './shaders/sea.frag?raw';
import skyFragment from './shaders/sky.frag?raw';
import { fullScreenMaterial, fullScreenMesh, noiseTable, skyTable, sunAtGround } from './tables';
import { TerrainLayer } from './terrain_layer';

const kNear = 0.25;
const kFieldOfView = 58; // degrees, vertical
const kExposure = 0.46;

export interface CameraPose {
  x: number; // metres, world
  y: number;
  z: number;
  yaw: number; // radians; 0 looks along -z, grows to the left
  pitch: number; // radians; positive looks up
}

export interface FrameCounts {
  drawCalls: number; // of the whole frame, shadow maps included
  triangles: number;
}

export class ViewRenderer {
  readonly terrain: TerrainLayer;
  readonly counts: FrameCounts = { drawCalls: 0, triangles: 0 };
  private readonly renderer: THREE.WebGLRenderer;
  private readonly camera: THREE.PerspectiveCamera;
  private readonly shared: SharedUniforms = sharedUniforms();
  private readonly shadows: ShadowMaps;
  private readonly skyScene = new THREE.Scene();
  private readonly seaScene = new THREE.Scene();
  private readonly seaUniforms: Record<string, THREE.IUniform>;
  private target: THREE.WebGLRenderTarget;
  private readonly reversed: boolean;

  /// Throws if the browser has no WebGL 2.
  constructor(canvas: HTMLCanvasElement, sunAzimuth: number, sunHeight: number, private readonly samples: number) {
    this.renderer = new THREE.WebGLRenderer({ canvas, depth: false, reversedDepthBuffer: true, powerPreference: 'high-performance' });
    this.renderer.autoClear = false;
    this.renderer.info.autoReset = false;
    this.renderer.outputColorSpace = THREE.LinearSRGBColorSpace; // sea.frag ends in display light itself
    this.reversed = this.renderer.capabilities.reversedDepthBuffer;
    this.camera = new THREE.PerspectiveCamera(kFieldOfView, 1, this.reversed ? kNear : 8 * kNear, 90_000);
    (this.camera as unknown as { _reversedDepth: boolean })._reversedDepth = this.reversed;
    this.camera.rotation.order = 'YXZ';

    this.shared.uNoise.value = noiseTable(this.renderer);
    this.setSun(sunAzimuth, sunHeight);
    this.shadows = new ShadowMaps(this.renderer, this.shared.uSunDirection.value, this.reversed);
    this.terrain = new TerrainLayer(this.shared, this.shadows.uniforms);
    this.target = this.createTarget(1, 1);
    this.skyScene.add(fullScreenMesh(this.skyMaterial()));
    this.seaUniforms = {
      uScene: { value: null },
      uDepth: { value: null },
      uDepthLine: { value: new THREE.Vector2() },
      uDepthReversed: { value: this.reversed ? 1 : 0 },
      uExposure: { value: kExposure },
    };
    const sea = fullScreenMaterial(kHeader + kAtmosphere + seaFragment, { ...this.shared, ...this.seaUniforms });
    this.seaScene.add(fullScreenMesh(sea));
  }

  /// Before the first frame.
  turnShadowsOff(): void {
    this.shadows.turnOff();
  }

  setFar(far: number): void {
    this.shared.uFar.value = far;
  }

  resize(width: number, height: number, pixelRatio: number): void {
    this.renderer.setPixelRatio(pixelRatio);
    this.renderer.setSize(width, height, false);
    const size = this.renderer.getDrawingBufferSize(new THREE.Vector2());
    this.target.dispose();
    this.target.depthTexture?.dispose();
    this.target = this.createTarget(size.x, size.y);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
  }

  draw(pose: CameraPose, now_ms: number): void {
    const { renderer, terrain } = this;
    renderer.info.reset();
    this.aim(pose, now_ms);
    terrain.update(pose.x, pose.y, pose.z, now_ms);
    this.shadows.update(terrain, pose.x, pose.y, pose.z, now_ms);
    renderer.setRenderTarget(this.target);
    renderer.clear();
    renderer.render(terrain.scene, this.camera);
    renderer.render(this.skyScene, this.camera);
    renderer.setRenderTarget(null);
    renderer.render(this.seaScene, this.camera);
    this.counts.drawCalls = renderer.info.render.calls;
    this.counts.triangles = renderer.info.render.triangles;
  }

  /// Direction of the ray through a point of the screen, both 0..1 from the lower left; of the last frame.
  rayThrough(right: number, up: number): THREE.Vector3 {
    const { uTanHalf, uCameraAxes } = this.shared;
    const ray = new THREE.Vector3((2 * right - 1) * uTanHalf.value.x, (2 * up - 1) * uTanHalf.value.y, -1);
    return ray.applyMatrix3(uCameraAxes.value).normalize();
  }

  private aim(pose: CameraPose, now_ms: number): void {
    const { camera, shared } = this;
    camera.rotation.set(pose.pitch, pose.yaw, 0);
    camera.updateMatrixWorld();
    shared.uEyeHeight.value = Math.abs(pose.y) < 0.05 ? 0.05 : pose.y;
    shared.uCameraPlace.value.set(placeInPeriod(pose.x), pose.y, placeInPeriod(pose.z));
    shared.uCameraAxes.value.setFromMatrix4(camera.matrixWorld);
    const tan = Math.tan((kFieldOfView * Math.PI) / 360);
    shared.uTanHalf.value.set(tan * camera.aspect, tan);
    shared.uTime.value = (now_ms / 1000) % 10_000;
    const projection = camera.projectionMatrix.elements;
    (this.seaUniforms['uDepthLine']!.value as THREE.Vector2).set(projection[10]!, projection[14]!);
    this.seaUniforms['uScene']!.value = this.target.texture;
    this.seaUniforms['uDepth']!.value = this.target.depthTexture;
  }

  private setSun(azimuth: number, height: number): void {
    const direction = this.shared.uSunDirection.value;
    direction.set(Math.sin(azimuth) * Math.cos(height), Math.sin(height), -Math.cos(azimuth) * Math.cos(height));
    const sky = skyTable(this.renderer, direction);
    this.shared.uSky.value = sky.texture;
    this.shared.uSkyAbove.value.copy(sky.above);
    this.shared.uSkyAround.value.copy(sky.around);
    this.shared.uSunIrradiance.value.copy(sunAtGround(direction));
  }

  private skyMaterial(): THREE.RawShaderMaterial {
    const material = fullScreenMaterial(kHeader + kAtmosphere + skyFragment, {
      ...this.shared,
      uCloudShift: { value: new THREE.Vector2(0.37, 1.61) },
    });
    // At the far plane, behind all terrain: only what is still empty is shaded.
    material.uniforms['uClipDepth']!.value = this.reversed ? 0 : 1;
    material.depthTest = true;
    material.depthFunc = THREE.LessEqualDepth;
    return material;
  }

  private createTarget(width: number, height: number): THREE.WebGLRenderTarget {
    const depthTexture = new THREE.DepthTexture(width, height, THREE.FloatType);
    return new THREE.WebGLRenderTarget(width, height, { type: THREE.HalfFloatType, samples: this.samples, depthTexture });
  }
}
