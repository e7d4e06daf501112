// What every shader reads: one object, so that a value set once is set everywhere.

import * as THREE from 'three';
import atmosphere from './shaders/atmosphere.glsl?raw';

/// Every texture tile divides it, so the camera's place may be taken modulo this without a visible seam. Metres.
export const kPlacePeriod = 16_384;

export const kHeader = 'precision highp float;\nprecision highp int;\nprecision highp sampler2DShadow;\n';
export const kAtmosphere = atmosphere;

export function sharedUniforms() {
  return {
    uSky: { value: null as THREE.Texture | null },
    uNoise: { value: null as THREE.Texture | null },
    uSunDirection: { value: new THREE.Vector3() },
    uSunIrradiance: { value: new THREE.Color() },
    uSkyAbove: { value: new THREE.Color() },
    uSkyAround: { value: new THREE.Color() },
    uFar: { value: 12_000 },
    uEyeHeight: { value: 0 },
    uCameraPlace: { value: new THREE.Vector3() },
    uCameraAxes: { value: new THREE.Matrix3() },
    uTanHalf: { value: new THREE.Vector2() },
    uTime: { value: 0 },
  };
}
export type SharedUniforms = ReturnType<typeof sharedUniforms>;

/// `metres` modulo the period, in doubles: what is left is small enough for the GPU's floats.
export function placeInPeriod(metres: number): number {
  return metres - Math.floor(metres / kPlacePeriod) * kPlacePeriod;
}
