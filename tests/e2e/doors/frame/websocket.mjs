// A WebSocket client small enough to misbehave on purpose: every frame is built by hand.
import { createHash, randomBytes } from 'node:crypto';
import { request } from 'node:http';

export const opcode = { text: 1, binary: 2, close: 8, ping: 9, pong: 10 };

/// One client frame, masked unless told otherwise. `length` lies about the payload's length.
export function frame(kind, payload = Buffer.alloc(0), { masked = true, fin = true, reserved = 0, length } = {}) {
  const size = length ?? payload.length;
  const head = [(fin ? 0x80 : 0) | (reserved << 4) | kind];
  const mask = masked ? 0x80 : 0;
  if (size < 126) head.push(mask | size);
  else if (size < 65536) head.push(mask | 126, size >> 8, size & 255);
  else {
    const long = Buffer.alloc(8);
    long.writeBigUInt64BE(BigInt(size));
    head.push(mask | 127, ...long);
  }
  if (!masked) return Buffer.concat([Buffer.from(head), payload]);
  const key = randomBytes(4);
  const hidden = Buffer.from(payload.map((byte, i) => byte ^ key[i & 3]));
  return Buffer.concat([Buffer.from(head), key, hidden]);
}

/// Opens a WebSocket and gives { send(bytes), next(), closed, destroy() }: `next` is the next whole server frame
/// { opcode, payload } or null at the end; `closed` resolves to the close code (1005 without one, 1006 without a frame).
export function openWebSocket(at, path, { headers = {}, ms = 15_000 } = {}) {
  const [host, port] = at.split(':');
  const key = randomBytes(16).toString('base64');
  return new Promise((resolve, reject) => {
    const asked = request({
      host,
      port,
      path,
      agent: false,
      timeout: ms,
      headers: {
        Connection: 'Upgrade',
        Upgrade: 'websocket',
        'Sec-WebSocket-Version': '13',
        'Sec-WebSocket-Key': key,
        ...headers,
      },
    });
    asked.on('timeout', () => asked.destroy(new Error('no upgrade')));
    asked.on('error', reject);
    asked.on('response', (answer) => {
      answer.resume();
      resolve({ refused: answer.statusCode, headers: answer.headers });
    });
    asked.on('upgrade', (answer, socket, head) => {
      const proof = createHash('sha1').update(`${key}258EAFA5-E914-47DA-95CA-C5AB0DC85B11`).digest('base64');
      if (answer.headers['sec-websocket-accept'] !== proof) return reject(new Error('wrong Sec-WebSocket-Accept'));
      resolve(conversation(socket, head));
    });
    asked.end();
  });
}

function conversation(socket, head) {
  let pending = head;
  let over = false;
  let code = 1006;
  const frames = [];
  const waiting = [];
  let closed;
  const whenClosed = new Promise((resolve) => (closed = resolve));

  const take = () => {
    while (pending.length >= 2) {
      const short = pending[1] & 0x7f;
      const extra = short === 127 ? 8 : short === 126 ? 2 : 0;
      if (pending.length < 2 + extra) return;
      const size = extra === 8 ? Number(pending.readBigUInt64BE(2)) : extra === 2 ? pending.readUInt16BE(2) : short;
      if (pending.length < 2 + extra + size) return;
      const got = { opcode: pending[0] & 15, payload: pending.subarray(2 + extra, 2 + extra + size) };
      pending = pending.subarray(2 + extra + size);
      if (got.opcode === opcode.close) code = got.payload.length >= 2 ? got.payload.readUInt16BE(0) : 1005;
      if (waiting.length > 0) waiting.shift()(got);
      else frames.push(got);
    }
  };
  const end = () => {
    if (over) return;
    over = true;
    for (const resolve of waiting.splice(0)) resolve(null);
    closed(code);
  };
  socket.setNoDelay(true);
  socket.on('data', (part) => {
    pending = Buffer.concat([pending, part]);
    take();
  });
  socket.on('error', end);
  socket.on('end', () => socket.end());
  socket.on('close', end);
  take();
  return {
    send: (bytes) => socket.write(bytes),
    next: () =>
      frames.length > 0
        ? Promise.resolve(frames.shift())
        : over
          ? Promise.resolve(null)
          : new Promise((resolve) => waiting.push(resolve)),
    closed: whenClosed,
    destroy: () => socket.destroy(),
  };
}
