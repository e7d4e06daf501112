// `window.talus`: what end-to-end tests and the curious may ask and do from the console.

import type { ViewRenderer } from '../render/view_renderer';
import type { Viewer } from './viewer';

export interface TestDoor {
  state(): Record<string, unknown>;
  flyTo(x: number, y: number, z: number, yawDegrees?: number, pitchDegrees?: number): void;
  flyAlong(x: number, y: number, z: number, seconds: number): Promise<void>;
  walk(on: boolean): void;
  overlay(wire: boolean, seams: boolean): void;
  /// What is drawn at a point of the screen, both 0..1 from the lower left; null for sky and sea.
  pick(right: number, up: number): { distanceM: number; name: string } | null;
  ground(x: number, z: number): number | null;
  /// Edges on faces of what is drawn at this moment, and the places, in metres, of those that do not close.
  openEdges(): { edges: number; open: [number, number, number][] };
  /// Whether the map is open, how many tiles of its view have not come (null: it has not been drawn), and its layer.
  map(): { open: boolean; missing: number | null; layer: string };
}

export function testDoor(viewer: Viewer, renderer: ViewRenderer): TestDoor {
  const { body, stream } = viewer;
  const radians = (degrees: number): number => (degrees * Math.PI) / 180;
  return {
    state: () => ({
      connected: viewer.connection.phase === 'open',
      phase: viewer.connection.phase,
      complete: stream.complete,
      format: stream.connection.format,
      chunks: stream.store.counts(),
      faults: [...viewer.faults],
      bytes: stream.connection.bytesReceived,
      drawCalls: renderer.counts.drawCalls,
      triangles: renderer.counts.triangles,
      terrainTriangles: renderer.terrain.triangles,
      shown: renderer.terrain.shown,
      frame_ms: viewer.frame_ms,
      at: [body.x, body.y, body.z],
      yaw: body.yaw,
      areaFrom: stream.areaFrom && [stream.areaFrom.x, stream.areaFrom.y, stream.areaFrom.z],
      walking: body.walking,
    }),
    flyTo: (x, y, z, yawDegrees, pitchDegrees) =>
      viewer.goTo([x, y, z], yawDegrees === undefined ? body.yaw : radians(yawDegrees), pitchDegrees === undefined ? body.pitch : radians(pitchDegrees)),
    flyAlong: (x, y, z, seconds) => viewer.flyAlong([x, y, z], seconds),
    walk: (on) => {
      if (body.walking !== on) viewer.toggleWalk();
    },
    overlay: (wire, seams) => renderer.terrain.setOverlay(wire, seams),
    pick: (right, up) => stream.pick(body, renderer.rayThrough(right, up)),
    openEdges: () => stream.openEdges(),
    map: () => ({
      open: viewer.map?.isOpen ?? false,
      missing: Number.isFinite(viewer.map?.missing) ? viewer.map!.missing : null,
      layer: viewer.map?.layer ?? '',
    }),
    ground: (x, z) => viewer.ground(x, z, Infinity)?.heightM ?? null,
  };
}
