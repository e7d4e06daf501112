// Map tiles: pictures at every zoom, caching, the table of malformed coordinates, equal bytes whatever the threads.
import assert from 'node:assert/strict';
import { createHash } from 'node:crypto';
import { after, before, describe, test } from 'node:test';
import { inflateSync } from 'node:zlib';
import { request } from './frame/http.mjs';
import { startServer } from './frame/server.mjs';
import { manifestOf } from './frame/terrain.mjs';

const tilePath = (zoom, x, y) => `/v1/worlds/default/map/${zoom}/${x}/${y}.png`;

/// Rows of RGB of a PNG without interlacing.
function pixelsOf(png) {
  assert.equal(png.subarray(1, 4).toString(), 'PNG');
  const width = png.readUInt32BE(16);
  const height = png.readUInt32BE(20);
  assert.deepEqual([...png.subarray(24, 29)], [8, 2, 0, 0, 0], 'eight bits of RGB');
  const parts = [];
  for (let at = 8; at < png.length; at += 12 + png.readUInt32BE(at)) {
    if (png.subarray(at + 4, at + 8).toString() === 'IDAT') parts.push(png.subarray(at + 8, at + 8 + png.readUInt32BE(at)));
  }
  assert.equal(inflateSync(Buffer.concat(parts)).length, height * (1 + 3 * width));
  return { width, height };
}

describe('map tiles', () => {
  let server;
  let http;
  let map;
  before(async () => {
    server = await startServer(['--threads', '2']);
    http = server.ready.http;
    map = (await manifestOf(server)).map;
  });
  after(() => server?.stop());

  test('are described in the manifest', () => {
    assert.equal(map.tile_pixels, 256);
    assert.equal(map.pixel_m, 2 ** map.zoom_max);
    assert.equal(map.tile_limit.length, map.zoom_max + 1);
  });

  test('are pictures at every zoom that any cache may keep for ever', async () => {
    const seen = new Set();
    for (let zoom = 0; zoom <= map.zoom_max; zoom += 1) {
      const answer = await request(http, tilePath(zoom, -1, 0));
      assert.equal(answer.status, 200);
      assert.equal(answer.headers['content-type'], 'image/png');
      assert.equal(answer.headers['cache-control'], 'public, max-age=31536000, immutable');
      assert.match(answer.headers.etag, /^"[^"]+map1"$/);
      assert.deepEqual(pixelsOf(answer.body), { width: 256, height: 256 });
      seen.add(createHash('sha256').update(answer.body).digest('hex'));
    }
    assert.equal(seen.size, map.zoom_max + 1);
  });

  test('show every layer of the manifest, each another picture with another ETag', async () => {
    const pictures = new Set();
    const etags = new Set();
    for (const layer of map.layers) {
      const answer = await request(http, `${tilePath(5, 0, 0)}?layer=${layer}`);
      assert.equal(answer.status, 200, layer);
      assert.deepEqual(pixelsOf(answer.body), { width: 256, height: 256 });
      pictures.add(createHash('sha256').update(answer.body).digest('hex'));
      etags.add(answer.headers.etag);
      const again = await request(http, `${tilePath(5, 0, 0)}?layer=${layer}`, { headers: { 'If-None-Match': answer.headers.etag } });
      assert.equal(again.status, 304, layer);
      const remembered = await request(http, `${tilePath(5, 0, 0)}?layer=${layer}`);
      assert.equal(remembered.headers.etag, answer.headers.etag, `${layer}, from memory`);
    }
    assert.ok(map.layers.includes('plates') && map.layers.includes('districts'));
    assert.equal(pictures.size, map.layers.length);
    assert.equal(etags.size, map.layers.length);
    const plain = await request(http, tilePath(5, 0, 0));
    assert.ok(etags.has(plain.headers.etag), 'no layer is the shaded one');
    const bad = await request(http, `${tilePath(5, 0, 0)}?layer=snow`);
    assert.equal(bad.status, 400);
    assert.equal(JSON.parse(bad.body.toString()).error, 'bad_layer');
  });

  test('answer 304 to their ETag without being drawn, and HEAD without a body', async () => {
    const { headers } = await request(http, tilePath(3, 0, 0));
    const unseen = await request(http, tilePath(3, 77, -12), { headers: { 'If-None-Match': headers.etag } });
    assert.equal(unseen.status, 304);
    assert.equal(unseen.headers.etag, headers.etag);
    const head = await request(http, tilePath(3, 0, 0), { method: 'HEAD' });
    assert.equal(head.status, 200);
    assert.equal(head.body.length, 0);
  });

  test('refuse malformed and far coordinates by name', async () => {
    const bad = ['+1', '01', '-0', '1.0', '1e3', '%20', 'nan', String(2 ** 31), '9'.repeat(400), '..'];
    for (const value of bad) {
      for (const [field, zoom, x, y] of [['zoom', value, 0, 0], ['x', 4, value, 0], ['y', 4, 0, value]]) {
        const answer = await request(http, tilePath(zoom, x, y));
        assert.equal(answer.status, 400, `${field} ${value}`);
        assert.match(JSON.parse(answer.body.toString()).message, new RegExp(`\\b${field}\\b`));
      }
    }
    for (let zoom = 0; zoom <= map.zoom_max; zoom += 1) {
      const limit = map.tile_limit[zoom];
      assert.equal((await request(http, tilePath(zoom, limit, 0))).status, 400);
      assert.equal((await request(http, tilePath(zoom, 0, -limit - 1))).status, 400);
      if (zoom % 5 === 0) assert.equal((await request(http, tilePath(zoom, limit - 1, -limit))).status, 200);
    }
    for (const path of ['map', 'map/', 'map/0/0', 'map/0/0/0', 'map/0/0/0.jpg', 'map/0/0/0/0.png']) {
      assert.equal((await request(http, `/v1/worlds/default/${path}`)).status, 400, path);
    }
  });

  test('have the same bytes for any number of threads', async () => {
    const one = await startServer(['--threads', '1']);
    try {
      for (const [zoom, x, y] of [[2, 0, 0], [8, -3, 4], [11, 40, -7]]) {
        const a = await request(http, tilePath(zoom, x, y));
        const b = await request(one.ready.http, tilePath(zoom, x, y));
        assert.deepEqual(a.body, b.body);
      }
    } finally {
      await one.stop();
    }
  });
});
