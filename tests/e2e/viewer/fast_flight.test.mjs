// A flight at 300 m/s through sea cliffs, by the real viewer: what has been seen once is never lost, what is drawn is one
// closed surface at every moment that is looked at, nothing fails. With payloads in either format.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { startServer } from '../doors/frame/server.mjs';
import { builtViewer, openViewer, screenshot, until } from './browser.mjs';

const completeMs = 150_000; // drawn in software on a shared machine
const speed = 300; // metres a second
const leg_s = 2.5;
/// A flight has as many legs, there and back, as it takes to see so many frames, but not more than so many.
const framesWanted = 8;
const legsMax = 6;
/// Off a headland with stacks, caves and an arch: past them and through its cliffs, along the way one looks, and back.
const from = { at: [4914, 30, 39847], yaw: -16, pitch: 2 };
const radians = (from.yaw * Math.PI) / 180;
const to = [from.at[0] - Math.sin(radians) * speed * leg_s, 40, from.at[2] - Math.cos(radians) * speed * leg_s];

/// Runs in the page: flies, and looks at each frame whether ground that was drawn above a column still is, and every
/// fifth of a second whether what is drawn is closed.
async function flyAndLook([ends, leg_s, framesWanted, legsMax]) {
  const { talus } = window;
  const seen = { legs: 0, frames: 0, columns: 0, late: 0, lost: [], looks: 0, edges: 0, open: [], strips: 0, chunks: 0, mismatches: 0, };
  const known = new Set(); // columns above which there was ground, and which have not been left behind
  const lookForHoles = () => {
    const { areaFrom, chunks, shown } = talus.state();
    seen.frames += 1;
    seen.chunks = Math.max(seen.chunks, chunks.drawn);
    seen.strips = Math.max(seen.strips, chunks.strips);
    if (shown !== chunks.drawn + chunks.strips) seen.mismatches += 1;
    // Columns of two grids of the world, a third of a metre off the planes between chunks, around the place that the
    // interest area of 1000 m was reckoned from: a slow frame may have taken the eye out of it.
    const inReach = new Set();
    for (const [step, reach] of [[48, 250], [160, 800]]) {
      const [firstX, firstZ] = [areaFrom[0], areaFrom[2]].map((middle) => Math.ceil((middle - reach) / step) * step);
      for (let x = firstX; x <= areaFrom[0] + reach; x += step) {
        for (let z = firstZ; z <= areaFrom[2] + reach; z += step) {
          if (Math.hypot(x - areaFrom[0], z - areaFrom[2]) < reach) inReach.add(`${x + 0.37} ${z + 0.29}`);
        }
      }
    }
    for (const column of inReach) {
      seen.columns += 1;
      if (talus.ground(...column.split(' ').map(Number)) !== null) known.add(column);
      else if (known.has(column)) seen.lost.push(`${column} at frame ${seen.frames}`);
      else seen.late += 1;
    }
    for (const column of known) if (!inReach.has(column)) known.delete(column);
  };
  const lookForGaps = () => {
    const { edges, open } = talus.openEdges();
    seen.looks += 1;
    seen.edges += edges;
    if (open.length > 0) seen.open.push(`${open.length} at frame ${seen.frames}, the first at ${open[0]}`);
  };
  let flying = true;
  let lastGaps_ms = 0;
  const frame = (now_ms) => {
    if (!flying) return;
    lookForHoles();
    if (now_ms - lastGaps_ms > 200) {
      lastGaps_ms = now_ms;
      lookForGaps();
    }
    requestAnimationFrame(frame);
  };
  requestAnimationFrame(frame);
  while (seen.legs < legsMax && (seen.legs % 2 === 1 || seen.frames < framesWanted)) {
    await talus.flyAlong(...ends[seen.legs % 2], leg_s);
    seen.legs += 1;
  }
  flying = false;
  seen.lost.length = Math.min(seen.lost.length, 5);
  return seen;
}

test('a fast flight through cliffs shows no hole and no gap', { timeout: 600_000 }, async (t) => {
  const server = await startServer(['--viewer', builtViewer]);
  t.after(() => server.stop('SIGKILL'));
  for (const format of ['drc', 'mesh']) {
    await t.test(`with payloads in ${format}`, async (t) => {
      const query = `ratio=0.25&samples=0&shadows=0&far=1000&hud=0&format=${format}&at=${from.at}&yaw=${from.yaw}&pitch=${from.pitch}`;
      const viewer = await openViewer(t, `http://${server.ready.http}`, query);
      const start = await until(viewer, 'the first view is complete', (s) => s.connected && s.complete, completeMs);
      assert.equal(start.format, format);
      const seen = await viewer.page.evaluate(flyAndLook, [[to, from.at], leg_s, framesWanted, legsMax]);
      t.diagnostic(JSON.stringify(seen));
      assert.deepEqual(seen.lost, [], 'ground that was drawn above a column goes only when it is replaced');
      assert.deepEqual(seen.open, [], 'chunks and strips are one surface');
      assert.equal(seen.mismatches, 0, 'what is decided to be drawn is in the scene, and nothing else');
      assert.ok(seen.frames >= 4 && seen.looks >= 4 && seen.edges > 10_000 && seen.strips > 10, 'something was looked at');
      assert.ok(seen.late < 0.5 * seen.columns, `ground under ${seen.columns - seen.late} of ${seen.columns} columns`);

      const end = await until(viewer, 'the view at the end is complete', (s) => s.complete, completeMs);
      assert.deepEqual(await viewer.page.evaluate(() => window.talus.openEdges().open), []);
      assert.equal(end.chunks.ready, end.chunks.wanted);
      await screenshot(viewer, `fast_flight_${format}_end`);
      assert.deepEqual(viewer.faults, []);
      assert.deepEqual(end.faults, []);
    });
  }
});
