// Chunks over HTTP: bytes, kinds, caching, the table of malformed coordinates, and equal bytes whatever the threads.
import assert from 'node:assert/strict';
import { createHash } from 'node:crypto';
import { after, before, describe, test } from 'node:test';
import gltf from 'gltf-validator';
import { request } from './frame/http.mjs';
import { startServer } from './frame/server.mjs';
import { chunkPath, columnPath, manifestOf, meshPath, seamPath, surfaceKeys } from './frame/terrain.mjs';

const limit = 2 ** 30 - 1;
const places = [[40, 40], [-2500, 1800], [30_000, -70_000], [-1, -1], [1_000_000_000, -1_000_000_000]];

describe('chunks', () => {
  let server;
  let http;
  let manifest;
  before(async () => {
    server = await startServer(['--threads', '2']);
    http = server.ready.http;
    manifest = await manifestOf(server);
  });
  after(() => server?.stop());

  test('with a surface are Draco meshes that any cache may keep for ever', async () => {
    let meshes = 0;
    for (const lod of [0, 1, 4, 8]) {
      for (const key of await surfaceKeys(http, manifest, lod, places)) {
        const answer = await request(http, chunkPath(manifest, key, 'drc'));
        assert.ok(answer.status === 200 || answer.status === 204, `${JSON.stringify(key)}: ${answer.status}`);
        assert.match(answer.headers.etag, /^"[^"]+"$/);
        assert.equal(answer.headers['cache-control'], 'public, max-age=31536000, immutable');
        if (answer.status === 204) continue;
        meshes += 1;
        assert.equal(answer.body.subarray(0, 5).toString(), 'DRACO');
        assert.equal(Number(answer.headers['content-length']), answer.body.length);
        assert.equal(answer.headers['content-encoding'], undefined);
      }
    }
    assert.ok(meshes >= 10, `${meshes} meshes`);
  });

  test('without a surface are 204 and say whether they are air or rock', async () => {
    const [low, high] = manifest.height_range_m;
    const edge = manifest.chunk_cells * manifest.voxel_m;
    const above = await request(http, chunkPath(manifest, { lod: 0, x: 0, y: Math.ceil(high / edge) + 1, z: 0 }, 'drc'));
    const below = await request(http, chunkPath(manifest, { lod: 0, x: 0, y: Math.floor(low / edge) - 2, z: 0 }, 'drc'));
    for (const [answer, kind] of [[above, 'air'], [below, 'rock']]) {
      assert.equal(answer.status, 204);
      assert.equal(answer.headers['talus-chunk'], kind);
      assert.equal(answer.body.length, 0);
    }
  });

  test('have seam strips for their six faces, 204 where there is none, never one at LOD 0', async () => {
    let strips = 0;
    for (const lod of [0, 1, 4]) {
      for (const key of await surfaceKeys(http, manifest, lod, places)) {
        for (const face of ['px', 'nx', 'py', 'ny', 'pz', 'nz']) {
          const answer = await request(http, seamPath(manifest, key, face));
          assert.ok(answer.status === (lod === 0 ? 204 : 200) || answer.status === 204, `${answer.status}`);
          assert.match(answer.headers.etag, /\.seam2"$/);
          assert.equal(answer.headers['cache-control'], 'public, max-age=31536000, immutable');
          if (answer.status === 204) continue;
          strips += 1;
          assert.equal(answer.body.subarray(0, 5).toString(), 'DRACO');
          const again = await request(http, seamPath(manifest, key, face), { headers: { 'If-None-Match': answer.headers.etag } });
          assert.equal(again.status, 304);
        }
      }
    }
    assert.ok(strips >= 10, `${strips} strips`);
    const [finest] = await surfaceKeys(http, manifest, 0, places);
    const inMesh = await request(http, seamPath(manifest, finest, 'px').replace(/\.drc$/, '.mesh'));
    assert.equal(inMesh.status, 204, 'nothing is finer than LOD 0, in any format');
    assert.match(inMesh.headers.etag, /\.meshseam1"$/);
    const unknown = await request(http, seamPath(manifest, { lod: 1, x: 0, y: 0, z: 0 }, 'up'));
    assert.equal(unknown.status, 400);
    assert.equal(JSON.parse(unknown.body.toString()).error, 'bad_face');
  });

  test('are valid glTF: no error and no warning on a hundred that chance picks', async (t) => {
    const seed = Number(process.env.TALUS_SEED ?? 20261128);
    t.diagnostic(`seed ${seed}`);
    let state = seed;
    const chance = () => {
      state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
      return state / 2 ** 32;
    };
    let assets = 0;
    for (let lod = 0; assets < 100; lod = (lod + 1) % 13) {
      const reach = chance() < 0.5 ? 50_000 : 1e9;
      const [x, z] = [0, 1].map(() => Math.round((2 * chance() - 1) * reach));
      const [key] = await surfaceKeys(http, manifest, lod, [[x, z]]);
      const answer = await request(http, `${chunkPath(manifest, key, 'glb')}?origin=${x},0,${z}`);
      if (answer.status === 204) continue;
      assert.equal(answer.status, 200);
      assert.equal(answer.headers['content-type'], 'model/gltf-binary');
      const { issues, info } = await gltf.validateBytes(new Uint8Array(answer.body), { maxIssues: 20 });
      assert.deepEqual([issues.numErrors, issues.numWarnings], [0, 0], JSON.stringify([key, issues.messages]));
      assert.ok(info.totalTriangleCount > 0);
      assets += 1;
    }
  });

  test('are density tiles and height tiles too', async () => {
    for (const lod of [0, 3, 9]) {
      const height = await request(http, columnPath(manifest, { lod, x: 1, z: -2 }));
      assert.equal(height.status, 200);
      assert.equal(height.body.subarray(0, 4).toString(), 'tlsh');
      for (const key of await surfaceKeys(http, manifest, lod, places)) {
        const [mesh, density] = await Promise.all(['drc', 'density'].map((format) => request(http, chunkPath(manifest, key, format))));
        assert.equal(density.status, mesh.status, 'there is a density where there is a mesh');
        assert.equal(density.headers['talus-chunk'], mesh.headers['talus-chunk']);
        if (density.status === 200) assert.equal(density.body.subarray(0, 4).toString(), 'tlsd');
      }
    }
  });

  test('answer 304 to their own ETag, and 200 to another', async () => {
    for (const format of ['drc', 'mesh', 'glb', 'density', 'height']) {
      const path = format === 'height' ? columnPath(manifest, { lod: 2, x: 1, z: -1 }) : await meshPath(server, format);
      const first = await request(http, path);
      const etag = first.headers.etag;
      for (const match of [etag, `"other", ${etag}`, `W/${etag}`, '*']) {
        const again = await request(http, path, { headers: { 'If-None-Match': match } });
        assert.equal(again.status, 304, `${format} ${match}`);
        assert.equal(again.body.length, 0);
        assert.equal(again.headers.etag, etag);
      }
      const whole = await request(http, `${path}?rev=0`, { headers: { 'If-None-Match': '"other"' } });
      assert.equal(whole.status, 200);
      assert.equal(whole.headers['cache-control'], 'public, max-age=31536000, immutable');
      assert.equal(whole.headers['access-control-allow-origin'], '*');
      const head = await request(http, path, { method: 'HEAD' });
      assert.equal(head.headers['content-length'], String(whole.body.length));
      assert.equal(head.body.length, 0);
    }
    const drc = await request(http, await meshPath(server, 'drc'));
    const glb = await request(http, await meshPath(server, 'glb'));
    assert.notEqual(drc.headers.etag, glb.headers.etag);
  });

  test('know their ETag without being made', async () => {
    const [key] = await surfaceKeys(http, manifest, 0, [[123_456, 654_321]]);
    const path = chunkPath(manifest, key, 'drc');
    const etag = (await request(http, await meshPath(server))).headers.etag;
    const unseen = await request(http, path, { headers: { 'If-None-Match': etag } });
    assert.equal(unseen.status, 304, 'the ETag names world, revision and format, not the chunk');
  });

  test('refuse malformed and far coordinates by name', async () => {
    const bad = ['', '+1', '01', '-0', '-', '1.0', '1e3', '0x1', ' 1', '1 ', '%20', '%201', '%EF%BC%91', '%00', 'NaN', 'nan', 'inf',
      '1e300', String(2 ** 30), String(-(2 ** 30)), String(2 ** 31), String(-(2 ** 31)), String(2 ** 53), '9'.repeat(400), '..', "'"];
    for (const value of bad.filter((text) => !/[ ]/.test(text))) {
      for (const [field, path] of [['x', `0/${value}/0/0`], ['y', `0/0/${value}/0`], ['z', `0/0/0/${value}`], ['lod', `${value}/0/0/0`]]) {
        const whole = `/v1/worlds/default/chunks/${path}.drc`;
        const answer = await request(http, whole);
        assert.equal(answer.status, 400, whole);
        const body = JSON.parse(answer.body.toString());
        assert.equal(typeof body.error, 'string', whole);
        assert.match(body.message, new RegExp(`\\b${field}\\b`), `${whole}: ${body.message}`);
      }
    }
    for (const lod of ['-1', String(manifest.lod_max + 1), '13', '255', '256']) {
      assert.equal((await request(http, `/v1/worlds/default/chunks/${lod}/0/0/0.drc`)).status, 400, `lod ${lod}`);
    }
  });

  test('exist at the very limit of coordinates', async () => {
    for (const lod of [0, manifest.lod_max]) {
      for (const [x, z] of [[limit, -limit], [-limit, limit]]) {
        const answer = await request(http, chunkPath(manifest, { lod, x, y: 0, z }, 'drc'));
        assert.ok(answer.status === 200 || answer.status === 204, `lod ${lod}: ${answer.status}`);
      }
    }
  });

  test('refuse faces, tiles, subtrees and places that there are not by name', async () => {
    const table = [
      ['seams/1/0/0/0/up.drc', 400, 'bad_face'],
      ['seams/13/0/0/0/px.drc', 400, 'bad_lod'],
      ['chunks/0/0/0/0.glb?origin=1e300,0,0', 400, 'bad_origin'],
      ['3dtiles/tileset.json?origin=0,1e12', 400, 'bad_origin'],
      ['3dtiles/tileset.json?origin=0,0&km=65', 400, 'bad_km'],
      ['3dtiles/tileset.json?lat=91&lon=0', 400, 'bad_lat'],
      ['3dtiles/13/0/0/0/0/0.glb', 400, 'bad_lod'],
      ['3dtiles/world/5/-1/0.subtree', 400, 'bad_tile'],
      ['3dtiles/world/5/32/0.subtree', 404, 'unknown_subtree'],
      ['3dtiles/world/4/0/0.subtree', 404, 'unknown_subtree'],
      ['3dtiles/6/0/0/7/0/0.glb', 404, 'unknown_tile'],
    ];
    for (const [path, status, error] of table) {
      const answer = await request(http, `/v1/worlds/default/${path}`);
      assert.deepEqual([answer.status, JSON.parse(answer.body.toString()).error], [status, error], path);
    }
  });

  test('refuse formats they do not have, and bad queries', async () => {
    const path = await meshPath(server, 'drc');
    for (const format of ['obj', 'DRC', 'drc2', '', 'drc.glb']) {
      const answer = await request(http, path.replace(/drc$/, format));
      assert.ok(answer.status === 400, `${format}: ${answer.status}`);
    }
    const glb = await meshPath(server, 'glb');
    for (const query of ['origin=', 'origin=1,2', 'origin=a,b,c', 'origin=nan,0,0', 'origin=1e999,0,0']) {
      assert.equal((await request(http, `${glb}?${query}`)).status, 400, query);
    }
  });
});

describe('the bytes of chunks', () => {
  test('are equal for 1, 2 and 8 threads, in any order', async () => {
    const digests = [];
    for (const [threads, reversed] of [['1', false], ['2', true], ['8', false]]) {
      const server = await startServer(['--threads', threads]);
      try {
        const manifest = await manifestOf(server);
        const keys = [];
        for (const lod of [0, 2, 5]) keys.push(...(await surfaceKeys(server.ready.http, manifest, lod, places)));
        if (reversed) keys.reverse();
        const paths = keys.flatMap((key) => [chunkPath(manifest, key, 'drc'), chunkPath(manifest, key, 'glb')]);
        const answers = await Promise.all(
          paths.map(async (path) => {
            const { status, body } = await request(server.ready.http, path);
            return `${path} ${status} ${createHash('sha256').update(body).digest('hex')}`;
          }),
        );
        digests.push(answers.sort().join('\n'));
      } finally {
        await server.stop();
      }
    }
    assert.equal(digests[1], digests[0]);
    assert.equal(digests[2], digests[0]);
  });
});
