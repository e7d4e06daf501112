// A talusd of its own for a test: started on free loopback ports, known by its ready line, always stopped.
import { spawn } from 'node:child_process';
import { existsSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { createServer } from 'node:net';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { createInterface } from 'node:readline';
import { fileURLToPath } from 'node:url';

const root = fileURLToPath(new URL('../../../../', import.meta.url));
export const program = process.env.TALUSD ?? join(root, 'build/release/bin/talusd');

const readyMs = 20_000;
const stopMs = 20_000;
const freePorts = ['--listen', '127.0.0.1:0', '--tcp-listen', '127.0.0.1:0', '--admin-listen', '127.0.0.1:0'];

/// One that was free a moment ago, for programs that cannot take 0 and tell.
export async function freePort() {
  const server = createServer();
  await new Promise((done) => server.listen(0, '127.0.0.1', done));
  const { port } = server.address();
  await new Promise((done) => server.close(done));
  return port;
}

function launch(args) {
  if (!existsSync(program)) throw new Error(`${program} is missing: build it with cmake --build --preset release`);
  const child = spawn(program, args, { stdio: ['ignore', 'pipe', 'pipe'] });
  const log = { out: '', err: '' };
  child.stderr.setEncoding('utf8').on('data', (text) => (log.err += text));
  const ended = new Promise((resolve) => child.on('close', (code, signal) => resolve({ code, signal })));
  // A test that dies must not leave a server behind.
  const reap = () => child.kill('SIGKILL');
  process.on('exit', reap);
  void ended.then(() => process.off('exit', reap));
  return { child, log, ended };
}

function within(ms, promise, what) {
  let timer;
  const late = new Promise((_, reject) => {
    timer = setTimeout(() => reject(new Error(`${what} took longer than ${ms} ms`)), ms);
  });
  return Promise.race([promise, late]).finally(() => clearTimeout(timer));
}

/// Runs talusd to its end, as a faulty configuration should: { code, signal, out, err }.
export async function runToEnd(args, { ms = 10_000 } = {}) {
  const { child, log, ended } = launch(args);
  child.stdout.setEncoding('utf8').on('data', (text) => (log.out += text));
  try {
    return { ...(await within(ms, ended, `talusd ${args.join(' ')}`)), ...log };
  } finally {
    child.kill('SIGKILL');
  }
}

/// Starts talusd and waits for its ready line. `ready` is that line's object; `stop` sends a signal and gives the end.
/// Its pool does not stand back for the browsers and compilers beside it, for which tests would wait, unless told to.
export async function startServer(args = [], { ports = freePorts, poolNice = 0 } = {}) {
  const { child, log, ended } = launch([...ports, '--pool-nice', String(poolNice), ...args]);
  const lines = createInterface({ input: child.stdout });
  const first = new Promise((resolve, reject) => {
    lines.once('line', resolve);
    void ended.then(({ code, signal }) => reject(new Error(`talusd ended before it was ready (${code ?? signal}):\n${log.err}`)));
  });
  try {
    const line = await within(readyMs, first, 'the ready line');
    lines.on('line', (text) => (log.out += `${text}\n`));
    return {
      line,
      ready: JSON.parse(line),
      pid: child.pid,
      log,
      ended,
      stop: async (signal = 'SIGTERM') => {
        child.kill(signal);
        return within(stopMs, ended, `the end after ${signal}`).catch((late) => {
          child.kill('SIGKILL');
          throw late;
        });
      },
    };
  } catch (fault) {
    child.kill('SIGKILL');
    throw fault;
  }
}

/// A file that lives until the test `t` ends.
export function temporaryFile(t, name, text) {
  const folder = mkdtempSync(join(tmpdir(), 'talus-doors-'));
  t.after(() => rmSync(folder, { recursive: true, force: true }));
  const path = join(folder, name);
  writeFileSync(path, text);
  return path;
}
