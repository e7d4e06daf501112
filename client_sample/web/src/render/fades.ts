// A change of what is drawn, softened: what comes and what goes share the pixels for a moment, by one pattern.
//
// Every pixel belongs wholly to what goes or to what comes, and all changes take equally long: so each pixel shows one of
// the sets that were drawn one after the other, whole, and as each of those is closed no gap opens. The pattern is
// Jorge Jimenez', "Next Generation Post Processing in Call of Duty: Advanced Warfare", 2014 (interleaved gradient noise).
// Owner: TerrainLayer.

import * as THREE from 'three';

const kFade_ms = 320;

export interface Fading {
  readonly object: THREE.Mesh;
}

interface Fade {
  leaving: boolean;
  progress: number; // 0 .. 1
  start_ms: number | null; // of the first frame that shows it
  done: () => void;
}

export class Fades<Part extends Fading> {
  private readonly fades = new Map<Part, Fade>();

  /// `fading` reads uFade: how far the fade is, and whether its part leaves.
  constructor(private readonly fading: THREE.RawShaderMaterial) {
    fading.uniforms['uFade'] = { value: new THREE.Vector2() };
  }

  /// `done` is called when the fade has ended; not if another takes its place.
  begin(part: Part, leaving: boolean, done: () => void): void {
    const fade: Fade = { leaving, progress: 0, start_ms: null, done };
    this.fades.set(part, fade);
    part.object.material = this.fading;
    part.object.onBeforeRender = (_renderer, _scene, _camera, _geometry, material) => {
      if (material !== this.fading) return;
      (this.fading.uniforms['uFade']!.value as THREE.Vector2).set(fade.progress, leaving ? 1 : 0);
      this.fading.uniformsNeedUpdate = true;
    };
  }

  isLeaving(part: Part): boolean {
    return this.fades.get(part)?.leaving ?? false;
  }

  has(part: Part): boolean {
    return this.fades.has(part);
  }

  /// Once a frame.
  advance(now_ms: number): void {
    for (const [part, fade] of [...this.fades]) {
      fade.start_ms ??= now_ms;
      fade.progress = Math.min(1, (now_ms - fade.start_ms) / kFade_ms);
      if (fade.progress < 1) continue;
      this.fades.delete(part);
      part.object.onBeforeRender = () => undefined;
      fade.done();
    }
  }
}
