// The geometry of the overview map: which ground a piece of screen shows, and which tiles that needs. Pure.
// x grows to the right with x, y downwards with z; positions are doubles, metres.

import type { MapScheme } from '../protocol/server_info';

export interface MapFrame {
  x: number; // metres at the middle
  z: number;
  scale: number; // metres per pixel of the page
  width: number; // pixels of the page
  height: number;
}

export interface TilePlace {
  x: number;
  y: number;
  left: number; // pixels of the page
  top: number;
  size: number;
}

/// A page's pixel shows at least a quarter of a voxel's pixel, at most two of the coarsest zoom's.
const kCloser = 0.25;
const kFurther = 2;

export function toScreen(frame: MapFrame, x: number, z: number): [number, number] {
  return [(x - frame.x) / frame.scale + frame.width / 2, (z - frame.z) / frame.scale + frame.height / 2];
}

export function toWorld(frame: MapFrame, left: number, top: number): [number, number] {
  return [frame.x + (left - frame.width / 2) * frame.scale, frame.z + (top - frame.height / 2) * frame.scale];
}

export function panned(frame: MapFrame, dx: number, dy: number): MapFrame {
  return { ...frame, x: frame.x - dx * frame.scale, z: frame.z - dy * frame.scale };
}

/// Closer by `factor`; what lies under (left, top) stays there.
export function zoomed(frame: MapFrame, scheme: MapScheme, factor: number, left: number, top: number): MapFrame {
  const finest = (scheme.pixelM / 2 ** scheme.zoomMax) * kCloser;
  const scale = Math.max(finest, Math.min(scheme.pixelM * kFurther, frame.scale / factor));
  const [x, z] = toWorld(frame, left, top);
  return { ...frame, scale, x: x - (left - frame.width / 2) * scale, z: z - (top - frame.height / 2) * scale };
}

/// The zoom whose pixels are nearest in size to the screen's own, of which there are `ratio` to one of the page.
export function zoomOf(frame: MapFrame, scheme: MapScheme, ratio: number): number {
  const zoom = Math.round(Math.log2((scheme.pixelM * ratio) / frame.scale));
  return Math.max(0, Math.min(scheme.zoomMax, zoom));
}

/// The tiles of `zoom` that the frame shows, the nearest to its middle first.
export function tilesOf(frame: MapFrame, scheme: MapScheme, zoom: number): TilePlace[] {
  const edgeM = (scheme.pixelM / 2 ** zoom) * scheme.tilePixels;
  const limit = scheme.tileLimit[zoom] ?? 0;
  const [x0, z0] = toWorld(frame, 0, 0);
  const [x1, z1] = toWorld(frame, frame.width, frame.height);
  const first = (metres: number): number => Math.max(-limit, Math.floor(metres / edgeM));
  const last = (metres: number): number => Math.min(limit - 1, Math.ceil(metres / edgeM) - 1);
  const out: TilePlace[] = [];
  for (let y = first(z0); y <= last(z1); ++y) {
    for (let x = first(x0); x <= last(x1); ++x) {
      const [left, top] = toScreen(frame, x * edgeM, y * edgeM);
      out.push({ x, y, left, top, size: edgeM / frame.scale });
    }
  }
  const away = (t: TilePlace): number => Math.hypot(t.left + t.size / 2 - frame.width / 2, t.top + t.size / 2 - frame.height / 2);
  return out.sort((a, b) => away(a) - away(b));
}

/// The largest of 1, 2, 5 times a power of ten that is at most `metres`.
export function roundLength(metres: number): number {
  const power = 10 ** Math.floor(Math.log10(metres));
  return [5, 2, 1].map((factor) => factor * power).find((length) => length <= metres) ?? power;
}
