// The fixed doors of a server with the built-in world: ready line, health, worlds, manifest, methods, CORS, metrics.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { after, before, describe, test } from 'node:test';
import { json, request } from './frame/http.mjs';
import { startServer } from './frame/server.mjs';
import { manifestOf, meshPath } from './frame/terrain.mjs';

describe('a server with the built-in world', () => {
  let server;
  let http;
  before(async () => {
    server = await startServer();
    http = server.ready.http;
  });
  after(() => server?.stop());

  test('says in one line of JSON where its doors are', () => {
    const { ready, http: h, tcp, admin, worlds } = server.ready;
    assert.equal(ready, true);
    for (const door of [h, tcp, admin]) assert.match(door, /^127\.0\.0\.1:[1-9]\d*$/);
    assert.equal(new Set([h, tcp, admin]).size, 3);
    assert.deepEqual(worlds, ['default']);
  });

  test('is healthy and ready', async () => {
    for (const path of ['/healthz', '/readyz']) {
      const answer = await request(http, path);
      assert.equal(answer.status, 200, path);
      assert.equal(answer.body.toString().trim(), 'ok', path);
    }
  });

  test('lists its worlds with their hashes', async () => {
    const answer = await json(http, '/v1/worlds');
    assert.equal(answer.status, 200);
    assert.match(answer.headers['content-type'], /^application\/json/);
    const list = Array.isArray(answer.json) ? answer.json : answer.json.worlds;
    assert.equal(list.length, 1);
    assert.equal(list[0].name, 'default');
    assert.match(list[0].world_hash, /^[0-9a-f]{64}$/);
  });

  test('describes a world completely', async () => {
    const manifest = await manifestOf(server);
    assert.equal(manifest.name, 'default');
    assert.match(manifest.world_hash, /^[0-9a-f]{64}$/);
    assert.equal(manifest.chunk_cells, 32);
    assert.ok(manifest.voxel_m > 0);
    assert.ok(manifest.lod_max >= 8);
    assert.equal(manifest.chunk_limit, 2 ** 30 - 1);
    assert.ok(Number.isInteger(manifest.generator_version));
    assert.ok('seed' in manifest && 'sea_level_m' in manifest && 'limits' in manifest);
    const [low, high] = manifest.height_range_m;
    assert.ok(low < high);
    assert.ok(manifest.formats.includes('drc') && manifest.formats.includes('glb'), String(manifest.formats));
    assert.ok(manifest.materials.length >= 5);
    for (const material of manifest.materials) {
      assert.deepEqual(Object.keys(material).sort(), ['colour', 'erodibility', 'name']);
    }
    assert.ok(Object.keys(manifest.parameters).length > 5);
  });

  test('answers 404 with an error body for worlds and routes it does not have', async () => {
    const paths = ['/v1/worlds/atlantis', '/v1/worlds/atlantis/chunks/0/0/0/0.drc', '/v1/nothing', '/v2/worlds'];
    for (const path of paths) {
      const answer = await json(http, path);
      assert.equal(answer.status, 404, path);
      assert.equal(typeof answer.json.error, 'string', path);
      assert.equal(typeof answer.json.message, 'string', path);
    }
  });

  test('answers 405 with Allow for a known route and the wrong method', async () => {
    for (const path of ['/healthz', '/v1/worlds', '/v1/worlds/default', await meshPath(server)]) {
      for (const method of ['POST', 'PUT', 'DELETE', 'PATCH']) {
        const answer = await request(http, path, { method });
        assert.equal(answer.status, 405, `${method} ${path}`);
        assert.match(answer.headers.allow ?? '', /GET/, `${method} ${path}`);
      }
    }
  });

  test('answers HEAD as GET, without the body', async () => {
    for (const path of ['/healthz', '/v1/worlds', '/v1/worlds/default', await meshPath(server)]) {
      const get = await request(http, path);
      const head = await request(http, path, { method: 'HEAD' });
      assert.equal(head.status, get.status, path);
      assert.equal(head.headers['content-length'], get.headers['content-length'], path);
      assert.equal(head.headers.etag, get.headers.etag, path);
      assert.equal(head.body.length, 0, path);
    }
  });

  test('lets pages of any origin read', async () => {
    const answer = await request(http, '/v1/worlds', { headers: { Origin: 'https://example.org' } });
    assert.equal(answer.headers['access-control-allow-origin'], '*');
  });

  test('answers a preflight', async () => {
    const answer = await request(http, '/v1/worlds', {
      method: 'OPTIONS',
      headers: { Origin: 'https://example.org', 'Access-Control-Request-Method': 'GET' },
    });
    assert.ok(answer.status === 200 || answer.status === 204, String(answer.status));
    assert.match(answer.headers['access-control-allow-methods'] ?? '', /GET/);
  });

  test('says what a ray meets, or null', async () => {
    const down = await json(http, '/v1/worlds/default/ray?from=100,2000,-50&dir=0,-3,0');
    assert.equal(down.status, 200);
    const { position, normal, material, distance_m: distance } = down.json;
    const { json: points } = await json(http, '/v1/worlds/default/points?xz=100,-50');
    assert.ok(Math.abs(position[1] - points.points[0].height_m) < 3, 'the ground of the points route, but for what is carved');
    assert.ok(Math.abs(position[1] + distance - 2000) < 1e-3);
    assert.ok(Math.abs(Math.hypot(...normal) - 1) < 1e-3);
    assert.equal(typeof material, 'string');
    const up = await json(http, '/v1/worlds/default/ray?from=100,2000,-50&dir=0,1,0');
    assert.deepEqual([up.status, up.json], [200, null]);
    assert.equal((await json(http, '/v1/worlds/default/ray?from=0,0,0&dir=0,0,0')).status, 400);
  });

  test('answers every address that the README shows', async () => {
    const text = readFileSync(new URL('../../../README.md', import.meta.url), 'utf8');
    const shown = [...text.matchAll(/^curl .*?"?\$base([^" ]*)"? +#/gm)].map((match) => `/v1/worlds/default${match[1]}`);
    assert.ok(shown.length >= 10, `${shown.length} addresses`);
    for (const path of shown) assert.equal((await request(http, path)).status, 200, path);
  });

  test('answers points with every field, and refuses what is not a list of points', async () => {
    const answer = await json(http, '/v1/worlds/default/points?xz=0,0;1000.5,-2000');
    assert.equal(answer.status, 200);
    assert.equal(answer.json.points.length, 2);
    assert.equal(answer.json.points[1].x, 1000.5);
    for (const field of ['x', 'z', 'height_m', 'slope', 'material', 'layer', 'layer_set', 'plate', 'plate_kind', 'fault', 'fault_m', 'ridge', 'district']) {
      assert.ok(field in answer.json.points[0], field);
    }
    const many = Array.from({ length: 1001 }, (_, i) => `${i},0`).join(';');
    for (const query of ['', '?xz=', '?xz=1', '?xz=1,2,3', '?xz=a,b', '?xz=nan,0', '?xz=inf,0', '?xz=1e300,0', `?xz=${many}`]) {
      const refused = await json(http, `/v1/worlds/default/points${query}`);
      assert.equal(refused.status, 400, query.slice(0, 40));
      assert.equal(typeof refused.json.message, 'string');
    }
  });

  test('finds a dry place to stand', async () => {
    const { status, json: place } = await json(http, '/v1/worlds/default/spawn?near=0,0');
    assert.equal(status, 200);
    assert.ok(JSON.stringify(place).length > 10);
  });

  test('shows metrics and health on the admin door alone', async () => {
    const metrics = await request(server.ready.admin, '/metrics');
    assert.equal(metrics.status, 200);
    assert.match(metrics.headers['content-type'], /^text\/plain/);
    assert.match(metrics.body.toString(), /^# TYPE talus_/m);
    assert.equal((await request(http, '/metrics')).status, 404);
  });
});
