// Requests that say exactly what is sent: node's own client where it will do, bare bytes where it will not.
import { request as httpRequest } from 'node:http';
import { connect } from 'node:net';

const answerMs = 20_000;

/// `at` is "address:port"; the path is sent as it is. Gives { status, headers, body } with the body as bytes.
export function request(at, path, { method = 'GET', headers = {}, body } = {}) {
  const [host, port] = at.split(':');
  return new Promise((resolve, reject) => {
    const sent = httpRequest({ host, port, path, method, headers, agent: false, timeout: answerMs }, (answer) => {
      const parts = [];
      answer.on('data', (part) => parts.push(part));
      answer.on('end', () => resolve({ status: answer.statusCode, headers: answer.headers, body: Buffer.concat(parts) }));
      answer.on('error', reject);
    });
    sent.on('timeout', () => sent.destroy(new Error(`${method} ${path}: no answer in ${answerMs} ms`)));
    sent.on('error', reject);
    sent.end(body);
  });
}

export async function json(at, path, options) {
  const answer = await request(at, path, options);
  return { ...answer, json: JSON.parse(answer.body.toString('utf8')) };
}

/// Sends the parts one after the other and gives all that came back until the peer closed, as latin1 text; `reset` is
/// true when it closed without ceremony. `linger` closes our half once all is sent.
export function speak(at, parts, { pauseMs = 0, ms = answerMs, linger = true } = {}) {
  const [host, port] = at.split(':');
  return new Promise((resolve, reject) => {
    const socket = connect({ host, port: Number(port), noDelay: true });
    let heard = '';
    const timer = setTimeout(() => {
      socket.destroy();
      reject(new Error(`not closed in ${ms} ms; heard so far: ${heard.slice(0, 200)}`));
    }, ms);
    const finish = (reset) => {
      clearTimeout(timer);
      socket.destroy();
      resolve({ heard, reset, status: Number(/^HTTP\/1\.1 (\d{3})/.exec(heard)?.[1] ?? 0) });
    };
    socket.setEncoding('latin1');
    socket.on('data', (text) => (heard += text));
    socket.on('error', () => finish(true));
    socket.on('close', () => finish(false));
    socket.on('connect', async () => {
      for (const part of parts) {
        if (socket.destroyed || !socket.writable) return;
        socket.write(part);
        if (pauseMs > 0) await new Promise((done) => setTimeout(done, pauseMs));
      }
      if (linger && socket.writable) socket.end();
    });
  });
}
