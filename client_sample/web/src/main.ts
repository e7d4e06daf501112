// Composition: finds a world and a place in it, then hands over to the viewer.

import { chooseWorld, fetchHeights, fetchManifest, fetchSpawn } from './protocol/server_info';
import { ViewRenderer } from './render/view_renderer';
import { bestYaw, looksAround } from './ui/first_look';
import { Hud } from './ui/hud';
import { placeFromQuery } from './ui/place';
import { type TestDoor, testDoor } from './ui/test_door';
import { Viewer } from './ui/viewer';
import './ui/style.css';

declare global {
  interface Window {
    talus?: TestDoor;
  }
}

const kStartHeight = 95; // metres above the spawn
const kLookPitch = -7;
const kRetry_ms = 3000;

const radians = (degrees: number): number => (degrees * Math.PI) / 180;

function createRenderer(canvas: HTMLCanvasElement, hud: Hud, place: ReturnType<typeof placeFromQuery>): ViewRenderer | null {
  try {
    return new ViewRenderer(canvas, radians(place.sunAzimuth), radians(place.sunHeight), place.samples);
  } catch (error) {
    console.warn(error);
    const advice = 'talus draws with WebGL 2. Turn on hardware acceleration in the settings of this browser, update it, or use another.';
    hud.showNotice('This browser cannot draw the world', advice, true);
    return null;
  }
}

async function start(): Promise<void> {
  const place = placeFromQuery(location.search);
  const hud = new Hud(place.hud);
  const canvas = document.getElementById('view') as HTMLCanvasElement;
  const renderer = createRenderer(canvas, hud, place);
  if (renderer === null) return;
  const base = new URL('./', location.href);

  for (;;) {
    try {
      const manifest = await fetchManifest(base, await chooseWorld(base, place.world));
      const spawn = place.at ?? (await fetchSpawn(base, manifest.name, 0, 0));
      const at: [number, number, number] = place.at ?? (spawn ? [spawn[0], spawn[1] + kStartHeight, spawn[2]] : [0, 900, 0]);
      if (Number.isNaN(place.yaw)) {
        const looks = looksAround(at[0], at[2]);
        const heights = await fetchHeights(base, manifest.name, looks.flatMap((look) => look.places));
        place.yaw = bestYaw(looks, heights, place.sunAzimuth);
      }
      if (Number.isNaN(place.pitch)) place.pitch = kLookPitch;
      const stream = new URL(`v1/worlds/${encodeURIComponent(manifest.name)}/stream`, base);
      stream.protocol = base.protocol === 'https:' ? 'wss:' : 'ws:';
      hud.showNotice('', '', false);
      const viewer = new Viewer(canvas, renderer, hud, place, manifest, base, stream.href, at);
      window.talus = testDoor(viewer, renderer);
      viewer.start();
      canvas.focus();
      return;
    } catch (error) {
      const why = error instanceof Error ? error.message : String(error);
      hud.showNotice('The server does not answer', `${why}. Is talusd running at ${base.host}? This page keeps trying.`, false);
      await new Promise((resolve) => setTimeout(resolve, kRetry_ms));
    }
  }
}

void start();
