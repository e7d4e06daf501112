// More than one server can do: cold work is refused with a time to come back, and what is cheap still works.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readdirSync } from 'node:fs';
import { connect } from 'node:net';
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

/// What a connection that says nothing is told within `ms`; '' for nothing.
function toldAtOnce(at, ms) {
  return new Promise((resolve) => {
    const [host, port] = at.split(':');
    let text = '';
    const socket = connect({ host, port: Number(port) });
    socket.setEncoding('utf8').on('data', (more) => (text += more)).on('error', () => {});
    setTimeout(() => resolve({ text, socket }), ms);
  });
}

test('a server without descriptors tells those who come, counts each once, and takes others in again', async () => {
  const server = await startServer(['--connections-per-address', '200', '--silent-s', '60']);
  const limit = (count) => execFileSync('prlimit', ['--pid', String(server.pid), `--nofile=${count}:`]);
  try {
    const used = new Set(readdirSync(`/proc/${server.pid}/fd`).map(Number));
    let free = 0;
    while (used.has(free)) ++free;
    limit(free + 8);
    const told = await Promise.all(Array.from({ length: 24 }, () => toldAtOnce(server.ready.http, 2000)));
    const refused = told.filter(({ text }) => text.startsWith('HTTP/1.1 503 ')).length;
    for (const { socket } of told) socket.destroy();
    assert.ok(refused >= 12 && refused < 24, `${refused} of 24 were refused`);
    limit(1024);
    assert.equal((await request(server.ready.http, '/healthz')).status, 200);
    const text = String((await request(server.ready.admin, '/metrics')).body);
    const counted = Number(text.match(/^talus_connections_refused_total\{limit="descriptors"\} (\d+)$/m)[1]);
    assert.equal(counted, refused);
  } finally {
    await server.stop();
  }
});
