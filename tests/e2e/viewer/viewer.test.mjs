// From a server's start to a picture: the view completes, it shows land, it follows a flight, it survives the server.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { startServer } from '../doors/frame/server.mjs';
import { builtViewer, openViewer, screenshot, until } from './browser.mjs';

const completeMs = 150_000; // drawn in software on a shared machine
const look = 'ratio=0.5&samples=0&far=6000';

function start(http = '127.0.0.1:0') {
  const ports = ['--listen', http, '--tcp-listen', '127.0.0.1:0', '--admin-listen', '127.0.0.1:0'];
  return startServer(['--viewer', builtViewer], { ports });
}

/// Mean and spread of brightness over a square in the middle of the canvas as it is shown, 0..255.
async function middleOfScreen(page) {
  const shot = (await page.screenshot({ timeout: 90_000 })).toString('base64');
  return page.evaluate(async (png) => {
    const image = new Image();
    image.src = `data:image/png;base64,${png}`;
    await image.decode();
    const edge = 160;
    const canvas = new OffscreenCanvas(edge, edge);
    const context = canvas.getContext('2d');
    context.drawImage(image, (image.width - edge) / 2, (image.height - edge) / 2, edge, edge, 0, 0, edge, edge);
    const { data } = context.getImageData(0, 0, edge, edge);
    let sum = 0;
    let squares = 0;
    for (let i = 0; i < data.length; i += 4) {
      const light = (data[i] + data[i + 1] + data[i + 2]) / 3;
      sum += light;
      squares += light * light;
    }
    const mean = sum / (edge * edge);
    return { mean, spread: Math.sqrt(squares / (edge * edge) - mean * mean) };
  }, shot);
}

/// Stands the camera above the ground near (x, z), looking down at it.
async function lookAtGround(viewer, x, z) {
  await viewer.page.evaluate(([atX, atZ]) => window.talus.flyTo(atX, 2600, atZ, 180, -50), [x, z]);
  await until(viewer, `the view above ${x}, ${z} is complete`, (state) => state.complete, completeMs);
  const ground = await viewer.page.evaluate(([atX, atZ]) => window.talus.ground(atX, atZ), [x, z]);
  assert.ok(ground !== null, 'there is ground below');
  await viewer.page.evaluate(([atX, y, atZ]) => window.talus.flyTo(atX, y, atZ, 180, -30), [x, Math.max(ground, 0) + 120, z]);
  await until(viewer, 'the view from 120 m is complete', (state) => state.complete, completeMs);
}

test('the viewer shows land, follows a flight of 2 km and survives its server', { timeout: 600_000 }, async (t) => {
  const server = await start();
  t.after(() => server.stop('SIGKILL'));
  const { http } = server.ready;
  const viewer = await openViewer(t, `http://${http}`, look);

  await t.test('the first view completes without a failed request or a console error', async () => {
    const state = await until(viewer, 'the first view is complete', (s) => s.connected && s.complete, completeMs);
    t.diagnostic(`first view: ${JSON.stringify(state)}`);
    assert.equal(state.chunks.ready, state.chunks.wanted);
    assert.ok(state.bytes > 0);
    await screenshot(viewer, 'start');
    assert.deepEqual(viewer.faults, []);
    assert.deepEqual(state.faults, []);
  });

  await t.test('the middle of the screen is terrain', async () => {
    await lookAtGround(viewer, 0, 0);
    const hit = await viewer.page.evaluate(() => window.talus.pick(0.5, 0.5));
    assert.ok(hit !== null && hit.distanceM < 6000, `a ray through the middle meets ${JSON.stringify(hit)}`);
    const middle = await middleOfScreen(viewer.page);
    t.diagnostic(`middle of the screen: ${JSON.stringify(middle)}`);
    assert.ok(middle.mean > 12 && middle.mean < 245, `neither black nor white: ${JSON.stringify(middle)}`);
    assert.ok(middle.spread > 2, `not one flat colour: ${JSON.stringify(middle)}`);
    await screenshot(viewer, 'terrain');
  });

  await t.test('a flight of 2 km ends in a complete view, and few chunks stay behind', async () => {
    const [x, y, z] = (await viewer.state()).at;
    await viewer.page.evaluate(([atX, atY, atZ]) => window.talus.flyAlong(atX, atY, atZ, 20), [x, y + 500, z - 2000]); // inland
    const state = await until(viewer, 'the view at the end of the flight is complete', (s) => s.complete, completeMs);
    assert.ok(Math.abs(state.at[2] - (z - 2000)) < 1, `flew to ${state.at}`);
    await new Promise((resolve) => setTimeout(resolve, 1500));
    const rested = await viewer.state();
    assert.equal(rested.chunks.held, rested.chunks.wanted, 'what was left behind is gone');
    await screenshot(viewer, 'after_2_km');
    assert.deepEqual(viewer.faults, []);
    assert.deepEqual(rested.faults, []);
  });

  await t.test('walking stands on the ground', async () => {
    const [x, , z] = (await viewer.state()).at;
    const ground = await viewer.page.evaluate(([atX, atZ]) => window.talus.ground(atX, atZ), [x, z]);
    await viewer.page.evaluate(([atX, y, atZ]) => window.talus.flyTo(atX, y, atZ, 200, 2), [x, ground + 3, z]);
    await until(viewer, 'the view from the ground is complete', (state) => state.complete, completeMs);
    await viewer.page.evaluate(() => window.talus.walk(true));
    const eyes = Math.max(ground + 1.75, 0.35);
    await until(viewer, `the eyes come to rest at ${eyes}`, (state) => Math.abs(state.at[1] - eyes) < 0.2, 60_000);
    await screenshot(viewer, 'walking');
    await viewer.page.evaluate(() => window.talus.walk(false));
  });

  await t.test('a lost server is said, and a returned one is resumed with what is held', async () => {
    const before = await until(viewer, 'the view is at rest', (state) => state.complete, completeMs);
    await server.stop('SIGKILL');
    await until(viewer, 'the viewer knows that the server is gone', (s) => !s.connected, 30_000);
    await viewer.page.getByText('Connection lost').waitFor({ timeout: 30_000 });
    await screenshot(viewer, 'connection_lost');
    const held = (await viewer.state()).chunks.drawn;
    assert.equal(held, before.chunks.drawn, 'what was seen stays');

    const again = await start(http);
    t.after(() => again.stop('SIGKILL'));
    const state = await until(viewer, 'the view is complete again', (s) => s.connected && s.complete, completeMs);
    assert.ok(state.bytes - before.bytes < 64 * 1024, `resuming cost ${state.bytes - before.bytes} bytes: chunks were sent twice`);
    await viewer.page.getByText('Connection lost').waitFor({ state: 'hidden', timeout: 30_000 });
  });
});

test('the map fills with tiles, and a click on it travels there', { timeout: 400_000 }, async (t) => {
  const server = await start();
  t.after(() => server.stop('SIGKILL'));
  const viewer = await openViewer(t, `http://${server.ready.http}`, 'ratio=0.3&samples=0&far=800');
  await until(viewer, 'the first view is complete', (s) => s.connected && s.complete, completeMs);
  const { page } = viewer;
  await page.locator('#under').waitFor({ timeout: completeMs });
  assert.match(await page.locator('#under').innerText(), /\d m · .+ away/, 'what lies under the pointer is said');

  await page.keyboard.press('m');
  const mapIs = async (what, wanted) => {
    const deadline = Date.now() + completeMs;
    while (!wanted(await page.evaluate(() => window.talus.map()))) {
      if (Date.now() > deadline) throw new Error(`not in time: ${what}`);
      await new Promise((resolve) => setTimeout(resolve, 250));
    }
  };
  await mapIs('every tile has come', (map) => map.open && map.missing === 0);
  await screenshot(viewer, 'map');
  const middle = await middleOfScreen(page);
  assert.ok(middle.spread > 4, `the map shows something: ${JSON.stringify(middle)}`);

  await page.locator('#map-layer').selectOption('plates');
  await mapIs('every tile of the plates has come', (map) => map.layer === 'plates' && map.missing === 0);
  await page.keyboard.press('l');
  await mapIs('the key goes on to the faults', (map) => map.layer === 'faults' && map.missing === 0);
  await page.locator('#map-layer').selectOption('shaded');

  await page.locator('#map-closer').click();
  await mapIs('every tile of the closer view has come', (map) => map.missing === 0);
  const [x, , z] = (await viewer.state()).at;
  await page.locator('#map-canvas').click({ position: { x: 300, y: 200 } });
  const state = await until(viewer, 'the visitor has travelled', (s) => Math.hypot(s.at[0] - x, s.at[2] - z) > 1000, 60_000);
  assert.ok(state.at[0] < x && state.at[2] < z, `to the north-west: ${state.at}`);
  assert.deepEqual(await page.evaluate(() => window.talus.map().open), false);
  assert.deepEqual(viewer.faults.filter((fault) => !fault.includes('ERR_ABORTED')), []);
});

test('without a server to answer, the page says so and what to do', { timeout: 120_000 }, async (t) => {
  const server = await start();
  t.after(() => server.stop('SIGKILL'));
  const viewer = await openViewer(t, `http://${server.ready.http}`, `${look}&world=no-such-world`);
  await viewer.page.getByText('The server does not answer').waitFor({ timeout: 60_000 });
  await viewer.page.getByText('talusd').first().waitFor({ timeout: 10_000 });
});
