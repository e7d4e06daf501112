// The world in other people's engines: both tilesets open in CesiumJS and in three.js, complete, without a failed tile,
// and what they draw is land.
import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';
import { openPage, screenshot, until } from '../viewer/browser.mjs';
import { startServer } from '../doors/frame/server.mjs';
import { servePages } from './pages.mjs';

const completeMs = 240_000; // drawn in software on a shared machine; seconds where nothing else runs
const place = { x: 11_000, z: -7_000 }; // inside tiles at every level: at the world's middle four of each meet
const aboveM = 300;

/// Shares of the picture: what is not the background, and how much its brightness varies.
async function look(page) {
  const shot = (await page.screenshot({ timeout: 90_000 })).toString('base64');
  return page.evaluate(async (png) => {
    const image = new Image();
    image.src = `data:image/png;base64,${png}`;
    await image.decode();
    const canvas = new OffscreenCanvas(image.width, image.height);
    const context = canvas.getContext('2d');
    context.drawImage(image, 0, 0);
    const { data } = context.getImageData(0, 0, image.width, image.height);
    let land = 0;
    let sum = 0;
    let squares = 0;
    for (let i = 0; i < data.length; i += 4) {
      const [red, green, blue] = data.subarray(i, i + 3);
      if (red > 230 && green < 25 && blue > 230) continue; // the pages' magenta
      const light = (red + green + blue) / 3;
      land += 1;
      sum += light;
      squares += light * light;
    }
    const mean = sum / Math.max(land, 1);
    return { land: land / (data.length / 4), mean, spread: Math.sqrt(Math.max(squares / Math.max(land, 1) - mean * mean, 0)) };
  }, shot);
}

describe('the world as 3D Tiles', () => {
  let server;
  let ground;
  before(async () => {
    server = await startServer();
    const answer = await fetch(`http://${server.ready.http}/v1/worlds/default/points?xz=${place.x},${place.z}`);
    ground = Math.max((await answer.json()).points[0].height_m, 0);
  });
  after(() => server?.stop('SIGKILL'));

  for (const engine of ['cesium', 'three']) {
    // Coarse, since a frame in software is slow: a view of some 40 tiles each.
    for (const [name, tileset, error] of [['a place', `?origin=${place.x},${place.z}&km=2&lat=47&lon=11`, 64], ['the whole world', '', 128]]) {
      // three.js draws in single precision: it takes the frame that has its zero at the place, not on the globe.
      const query = engine === 'three' ? tileset.replace('&lat=47&lon=11', '') : tileset;
      test(`opens in ${engine}: ${name}`, { timeout: 420_000 }, async (t) => {
        const base = await servePages(t);
        const url = `http://${server.ready.http}/v1/worlds/default/3dtiles/tileset.json${query}`;
        const eye = [...(query ? [0, 0] : [place.x, -place.z]), ground + aboveM].join(','); // in the tileset's frame
        const { page, faults } = await openPage(
          t,
          `${base}/${engine}.html?error=${error}&heading=0.6&pitch=-0.6&eye=${eye}&tileset=${encodeURIComponent(url)}`,
          { width: 256, height: 160 },
        );
        // Until the page's script has run, `window.view` is the element of that id.
        const read = () => (typeof window.view === 'function' ? window.view() : null);
        const opened = { page, faults, state: () => page.evaluate(read) };
        const state = await until(opened, 'the view is complete', (view) => view.complete, completeMs);
        const seen = await look(page);
        await screenshot(opened, `${engine}_${name.replaceAll(' ', '_')}`);
        t.diagnostic(`${JSON.stringify(state)} ${JSON.stringify(seen)}`);
        assert.deepEqual(state.faults, []);
        assert.deepEqual(faults, []);
        assert.ok(state.shown >= 4, `${state.shown} tiles are drawn`);
        assert.ok(seen.land > 0.6, `mostly terrain: ${JSON.stringify(seen)}`);
        assert.ok(seen.mean > 12 && seen.mean < 245 && seen.spread > 2, `lit and not flat: ${JSON.stringify(seen)}`);
      });
    }
  }
});
