// The log is JSON, one object a line, and a request's lines are found by its id.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { request } from './frame/http.mjs';
import { startServer } from './frame/server.mjs';
import { frame, opcode, openWebSocket } from './frame/websocket.mjs';

const lines = (server) => server.log.err.trim().split('\n').map((line) => JSON.parse(line));

test('every line is an object, and names the request that it is about', async () => {
  const server = await startServer(['--log-level', 'debug']);
  try {
    const { http } = server.ready;
    const given = await request(http, '/v1/worlds', { headers: { 'X-Request-Id': 'trace-00/1' } });
    assert.equal(given.headers['x-request-id'], 'trace-00/1');
    const made = await request(http, '/v1/nothing', { headers: { 'X-Request-Id': 'not "sane"' } });
    assert.match(made.headers['x-request-id'], /^[0-9a-f]{16}$/);

    const socket = await openWebSocket(http, '/v1/worlds/default/stream', { headers: { 'X-Request-Id': 'stream-1' } });
    socket.send(frame(opcode.binary, Buffer.alloc(64)));
    await socket.closed;
    socket.destroy();
    await server.stop();

    const of = (id) => lines(server).filter(({ request: name }) => name === id);
    const [worlds] = of('trace-00/1');
    assert.deepEqual([worlds.event, worlds.path, worlds.status], ['request', '/v1/worlds', 200]);
    assert.equal(worlds.body_bytes, given.body.length);
    const [nothing] = of(made.headers['x-request-id']);
    assert.deepEqual([nothing.event, nothing.path, nothing.status], ['request', '/v1/nothing', 404]);
    const [ended] = of('stream-1');
    assert.deepEqual([ended.event, ended.reason], ['session ended by the server', 'malformed']);
    for (const line of lines(server)) {
      assert.match(line.time, /^\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{3}Z$/);
      assert.ok(['debug', 'info', 'warning', 'error'].includes(line.level), line.level);
    }
  } finally {
    await server.stop().catch(() => {});
  }
});
