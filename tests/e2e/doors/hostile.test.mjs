// Bytes no client should send. Whatever comes, the answer is a 4xx or a closed connection, and the server goes on.
import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';
import { request, speak } from './frame/http.mjs';
import { startServer } from './frame/server.mjs';
import { frame, opcode, openWebSocket } from './frame/websocket.mjs';

const stream = '/v1/worlds/default/stream';

describe('a server under bad input', () => {
  let server;
  let http;
  before(async () => {
    server = await startServer();
    http = server.ready.http;
  });
  after(() => server?.stop());

  const stillWell = async () => assert.equal((await request(http, '/healthz')).status, 200);

  test('answers a request that arrives one byte at a time', async () => {
    const text = 'GET /healthz HTTP/1.1\r\nHost: a\r\nConnection: close\r\n\r\n';
    const { status } = await speak(http, [...text], { pauseMs: 2, linger: false });
    assert.equal(status, 200);
  });

  test('answers pipelined requests in order', async () => {
    const one = (path, last) => `GET ${path} HTTP/1.1\r\nHost: a\r\n${last ? 'Connection: close\r\n' : ''}\r\n`;
    const { heard } = await speak(http, [one('/healthz') + one('/v1/nothing') + one('/v1/worlds', true)], { linger: false });
    assert.deepEqual(heard.match(/HTTP\/1\.1 \d{3}/g), ['HTTP/1.1 200', 'HTTP/1.1 404', 'HTTP/1.1 200']);
  });

  const requests = {
    'no request at all': ['\r\n\r\n\r\n\r\n', [0, 400]],
    'noise': [Buffer.from(Array.from({ length: 512 }, (_, i) => (i * 37) & 255)).toString('latin1'), [0, 400]],
    'no Host': ['GET /healthz HTTP/1.1\r\n\r\n', [400]],
    'two Hosts': ['GET /healthz HTTP/1.1\r\nHost: a\r\nHost: b\r\n\r\n', [400]],
    'a space before the colon': ['GET /healthz HTTP/1.1\r\nHost : a\r\n\r\n', [400]],
    'HTTP/2.0 in a request line': ['GET /healthz HTTP/2.0\r\nHost: a\r\n\r\n', [400, 505]],
    'HTTP/0.9': ['GET /healthz\r\n\r\n', [0, 400, 505]],
    'two lengths': ['GET /healthz HTTP/1.1\r\nHost: a\r\nContent-Length: 1\r\nContent-Length: 2\r\n\r\nab', [400]],
    'a length and chunks': ['GET /healthz HTTP/1.1\r\nHost: a\r\nContent-Length: 5\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n', [400]],
    'a negative length': ['GET /healthz HTTP/1.1\r\nHost: a\r\nContent-Length: -1\r\n\r\n', [400]],
    'a length beyond 2^64': ['GET /healthz HTTP/1.1\r\nHost: a\r\nContent-Length: 99999999999999999999999\r\n\r\n', [400, 413]],
    'a body of gigabytes, announced': ['POST /v1/worlds HTTP/1.1\r\nHost: a\r\nContent-Length: 9999999999\r\n\r\n', [405, 413]],
    'a request line without end': [`GET /${'a'.repeat(20_000)}`, [414]],
    'a path of 20 KiB': [`GET /${'a'.repeat(20_480)} HTTP/1.1\r\nHost: a\r\n\r\n`, [414]],
    'a header of 64 KiB': [`GET / HTTP/1.1\r\nHost: a\r\nX: ${'a'.repeat(65_536)}\r\n\r\n`, [431]],
    '200 headers': [`GET / HTTP/1.1\r\nHost: a\r\n${'X: y\r\n'.repeat(200)}\r\n`, [431]],
    'a NUL in a header': ['GET /healthz HTTP/1.1\r\nHost: a\r\nX: a\0b\r\n\r\n', [400]],
    'a broken escape': ['GET /v1/worlds/%zz HTTP/1.1\r\nHost: a\r\nConnection: close\r\n\r\n', [400, 404]],
    'a path out of the viewer': ['GET /../../../../etc/passwd HTTP/1.1\r\nHost: a\r\nConnection: close\r\n\r\n', [400, 404]],
    'an escaped path out of the viewer': ['GET /%2e%2e/%2e%2e/etc/passwd HTTP/1.1\r\nHost: a\r\nConnection: close\r\n\r\n', [400, 404]],
    'an unknown method': ['BREW / HTTP/1.1\r\nHost: a\r\n\r\n', [400, 405, 501]],
  };
  for (const [name, [bytes, allowed]] of Object.entries(requests)) {
    test(`survives ${name}`, async () => {
      const { status, heard } = await speak(http, [Buffer.from(bytes, 'latin1')]);
      assert.ok(allowed.includes(status), `status ${status}, one of ${allowed} expected; heard ${heard.slice(0, 120)}`);
      assert.doesNotMatch(heard, /root:/);
      await stillWell();
    });
  }

  test('refuses upgrades that are not WebSocket 13', async () => {
    for (const headers of [{ 'Sec-WebSocket-Version': '8' }, { 'Sec-WebSocket-Key': '' }, { 'Sec-WebSocket-Key': 'short' }]) {
      const answer = await openWebSocket(http, stream, { headers });
      assert.ok([400, 426].includes(answer.refused), JSON.stringify(headers));
    }
    assert.equal((await openWebSocket(http, '/v1/worlds/atlantis/stream')).refused, 404);
    assert.ok([400, 426].includes((await request(http, stream)).status));
  });

  const frames = {
    'an unmasked frame': [frame(opcode.binary, Buffer.from('x'), { masked: false }), [1002, 1006]],
    'reserved bits': [frame(opcode.binary, Buffer.from('x'), { reserved: 4 }), [1002, 1006]],
    'an unknown opcode': [frame(11, Buffer.from('x')), [1002, 1006]],
    'a long ping': [frame(opcode.ping, Buffer.alloc(126)), [1002, 1006]],
    'a fragmented ping': [frame(opcode.ping, Buffer.from('x'), { fin: false }), [1002, 1006]],
    'a frame of 2^40 bytes, announced': [frame(opcode.binary, Buffer.alloc(16), { length: 2 ** 40 }), [1002, 1009, 1006]],
    'a message over 64 KiB': [frame(opcode.binary, Buffer.alloc(70_000)), [1009, 1006]],
    'a text message': [frame(opcode.text, Buffer.from('hello')), [1003, 1002, 1007, 1008, 1000]],
    'an empty message': [frame(opcode.binary), [1002, 1003, 1007, 1008, 1000]],
    'a message of zeros': [frame(opcode.binary, Buffer.alloc(64)), [1002, 1003, 1007, 1008, 1000]],
    'a message of ones': [frame(opcode.binary, Buffer.alloc(64, 255)), [1002, 1003, 1007, 1008, 1000]],
  };
  for (const [name, [bytes, codes]] of Object.entries(frames)) {
    test(`closes a stream that sends ${name}`, async () => {
      const socket = await openWebSocket(http, stream);
      assert.equal(socket.refused, undefined);
      socket.send(bytes);
      const late = new Promise((resolve) => setTimeout(resolve, 10_000, 'never').unref());
      const code = await Promise.race([socket.closed, late]);
      socket.destroy();
      assert.ok(codes.includes(code), `closed with ${code}, one of ${codes} expected`);
      await stillWell();
    });
  }

  test('closes a TCP peer that announces a message beyond the limit or sends noise', async () => {
    const huge = Buffer.from([0xff, 0xff, 0xff, 0x7f, 0, 0, 0, 0]);
    const noise = Buffer.concat([Buffer.from([16, 0, 0, 0]), Buffer.alloc(16, 0xa5)]);
    for (const bytes of [huge, noise, Buffer.alloc(4)]) {
      await speak(server.ready.tcp, [bytes], { linger: false, ms: 15_000 });
      await stillWell();
    }
  });
});
