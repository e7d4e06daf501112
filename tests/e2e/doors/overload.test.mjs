// More than one server can do: cold work is refused with a time to come back, and what is cheap still works.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { request } from './frame/http.mjs';
import { startServer } from './frame/server.mjs';
import { chunkPath, manifestOf, surfaceKeys } from './frame/terrain.mjs';

test('too much cold work is shed with Retry-After, and health is not', async () => {
  const server = await startServer(['--threads', '1', '--cold-queue', '2', '--connections-per-address', '200']);
  try {
    const http = server.ready.http;
    const manifest = await manifestOf(server);
    const places = Array.from({ length: 120 }, (_, i) => [i * 500, i * -700]);
    const paths = (await surfaceKeys(http, manifest, 0, places)).map((key) => chunkPath(manifest, key, 'drc'));
    const answers = await Promise.all([...paths.map((path) => request(http, path)), request(http, '/healthz')]);
    assert.equal(answers.pop().status, 200);
    const refused = answers.filter(({ status }) => status === 503 || status === 429);
    for (const answer of answers) assert.ok([200, 204, 429, 503].includes(answer.status), String(answer.status));
    for (const answer of refused) assert.match(answer.headers['retry-after'] ?? '', /^\d+$/);
    assert.ok(refused.length > 0, 'nothing was refused');
    assert.ok(refused.length < answers.length, 'nothing was made');
    const later = await request(http, paths[0]);
    assert.ok([200, 204].includes(later.status), 'it did not recover');
  } finally {
    await server.stop();
  }
});

test('connections beyond the limit of an address are refused, and those within it live on', async () => {
  const server = await startServer(['--connections-per-address', '4']);
  try {
    const many = await Promise.allSettled(Array.from({ length: 40 }, () => request(server.ready.http, '/healthz')));
    assert.ok(many.some((one) => one.status === 'fulfilled' && one.value.status === 200));
    for (const one of many) {
      if (one.status === 'fulfilled') assert.ok([200, 429, 503].includes(one.value.status), String(one.value.status));
    }
    await new Promise((resolve) => setTimeout(resolve, 200));
    assert.equal((await request(server.ready.http, '/healthz')).status, 200);
  } finally {
    await server.stop();
  }
});
