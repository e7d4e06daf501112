// nginx and HAProxy in front of a server, each as a proxy that keeps its connections to it; and what lies in between.
import { spawn, spawnSync } from 'node:child_process';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { connect, createServer } from 'node:net';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { freePort } from './server.mjs';

const readyMs = 20_000;

// Bodies are passed on as they come, which is when two readings of a length differ at once; one kept connection, so that
// whatever is left over on it is the next one's.
const nginxConfig = (listen, backend) => `
daemon off;
worker_processes 1;
pid nginx.pid;
error_log stderr crit;
events { worker_connections 256; }
http {
  access_log off;
  client_header_timeout 2s;
  client_body_timeout 2s;
  client_body_temp_path body;
  proxy_temp_path proxy;
  fastcgi_temp_path fastcgi;
  uwsgi_temp_path uwsgi;
  scgi_temp_path scgi;
  upstream talus { server ${backend}; keepalive 1; }
  server {
    listen 127.0.0.1:${listen};
    location / {
      proxy_pass http://talus;
      proxy_http_version 1.1;
      proxy_set_header Connection "";
      proxy_pass_header Server;
      proxy_request_buffering off;
      proxy_next_upstream off;
    }
  }
}
`;

const haproxyConfig = (listen, backend) => `
global
  maxconn 64
  nbthread 1
defaults
  mode http
  option http-keep-alive
  http-reuse always
  retries 0
  timeout connect 5s
  timeout client 2s
  timeout server 5s
  timeout http-request 2s
  timeout http-keep-alive 2s
frontend front
  bind 127.0.0.1:${listen}
  default_backend talus
backend talus
  server one ${backend} pool-max-conn 1
`;

export const proxies = {
  nginx: {
    isThere: () => spawnSync('nginx', ['-v']).status === 0,
    start: (folder, config) => spawn('nginx', ['-e', 'stderr', '-p', folder, '-c', config], { stdio: ['ignore', 'ignore', 'pipe'] }),
    config: nginxConfig,
  },
  haproxy: {
    isThere: () => spawnSync('haproxy', ['-v']).status === 0,
    start: (_, config) => spawn('haproxy', ['-db', '-f', config], { stdio: ['ignore', 'ignore', 'pipe'] }),
    config: haproxyConfig,
  },
};

/// Starts the proxy in front of `backend`: { at }. Ended with the test `t`.
export async function startProxy(t, name, backend) {
  const { start, config } = proxies[name];
  const folder = mkdtempSync(join(tmpdir(), `talus-${name}-`));
  const port = await freePort();
  const file = join(folder, 'config');
  writeFileSync(file, config(port, backend));
  const child = start(folder, file);
  let log = '';
  child.stderr.setEncoding('utf8').on('data', (text) => (log += text));
  const ended = new Promise((done) => child.on('close', done));
  t.after(async () => {
    child.kill('SIGTERM');
    await ended;
    rmSync(folder, { recursive: true, force: true });
  });
  for (const end = Date.now() + readyMs; ; await new Promise((done) => setTimeout(done, 50))) {
    if (child.exitCode !== null) throw new Error(`${name} ended:\n${log}`);
    const isOpen = await new Promise((done) => {
      const probe = connect(port, '127.0.0.1', () => done(true)).on('error', () => done(false));
      probe.on('connect', () => probe.destroy());
    });
    if (isOpen) return { at: `127.0.0.1:${port}` };
    if (Date.now() > end) throw new Error(`${name} did not get ready in ${readyMs} ms:\n${log}`);
  }
}

/// The answers in a stream of bytes, as latin1 text: { status, server, body }. Every one of them has a length or no body;
/// what has no head (an answer of HTTP/0.9) has status 0.
export function answersIn(text) {
  const out = [];
  for (let at = 0; at < text.length; ) {
    const end = text.indexOf('\r\n\r\n', at);
    const status = Number(/^HTTP\/1\.[01] (\d{3})/.exec(text.slice(at, at + 16))?.[1] ?? 0);
    if (end < 0 || status === 0) return [...out, { status: 0, server: '', body: text.slice(at) }];
    const head = text.slice(at, end + 2);
    const field = (name) => new RegExp(`\r\n${name}: *([^\r]*)`, 'i').exec(head)?.[1] ?? '';
    const isOfHead = text.startsWith('HTTP/1.', end + 4) || end + 4 === text.length;
    const length = isOfHead ? 0 : Number(field('content-length') || 0);
    if (status >= 200) out.push({ status, server: field('server'), body: text.slice(end + 4, end + 4 + length) });
    at = end + 4 + length;
  }
  return out;
}

/// Passes everything on to `backend` and keeps what it says: { at, heard }, `heard` a text for each connection.
export async function startTap(t, backend) {
  const [host, port] = backend.split(':');
  const heard = [];
  const sockets = new Set();
  const server = createServer((near) => {
    const far = connect(Number(port), host);
    const which = heard.push('') - 1;
    for (const [from, to] of [[near, far], [far, near]]) {
      sockets.add(from);
      from.on('data', (bytes) => {
        if (from === far) heard[which] += bytes.toString('latin1');
        to.write(bytes);
      });
      from.on('end', () => to.end());
      from.on('error', () => to.destroy());
      from.on('close', () => sockets.delete(from));
    }
  });
  await new Promise((done) => server.listen(0, '127.0.0.1', done));
  t.after(() => {
    for (const socket of sockets) socket.destroy();
    server.close();
  });
  return { at: `127.0.0.1:${server.address().port}`, heard };
}
