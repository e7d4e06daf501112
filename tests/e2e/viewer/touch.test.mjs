// Fingers steer and look, a billion metres from the origin as well as at it.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { startServer } from '../doors/frame/server.mjs';
import { builtViewer, openViewer, screenshot, until } from './browser.mjs';

const completeMs = 200_000; // drawn in software on a shared machine
const place = { x: 1_000_000_000, z: -1_000_000_000 };

test('fingers fly and turn, a billion metres away', { timeout: 400_000 }, async (t) => {
  const server = await startServer(['--viewer', builtViewer]);
  t.after(() => server.stop('SIGKILL'));
  const base = `http://${server.ready.http}`;
  const { x, y, z } = await (await fetch(`${base}/v1/worlds/default/spawn?near=${place.x},${place.z}`)).json();
  const viewer = await openViewer(t, base, `ratio=0.25&samples=0&shadows=0&far=600&at=${x},${y + 60},${z}&yaw=0&pitch=-15`);
  const start = await until(viewer, 'the view is complete', (state) => state.complete, completeMs);

  const { page } = viewer;
  const cdp = await page.context().newCDPSession(page);
  const finger = (type, atX, atY) =>
    cdp.send('Input.dispatchTouchEvent', { type, touchPoints: type === 'touchEnd' ? [] : [{ x: atX, y: atY }] });

  await finger('touchStart', 120, 480);
  await finger('touchMove', 120, 400);
  const flown = await until(viewer, 'a finger on the left flies ahead', (s) => s.at[2] < start.at[2] - 5, 60_000);
  await finger('touchEnd');
  assert.ok(Math.abs(flown.at[0] - start.at[0]) < 5, `straight ahead: ${flown.at}`);

  await finger('touchStart', 700, 300);
  await finger('touchMove', 500, 300);
  await until(viewer, 'a finger on the right turns', (s) => Math.abs(s.yaw - start.yaw) > 0.2, 60_000);
  await finger('touchEnd');

  await until(viewer, 'the view is complete again', (state) => state.complete, completeMs);
  await screenshot(viewer, 'a_billion_metres_away');
  assert.deepEqual(viewer.faults, []);
});
