// The program `talus` against a running server, and against the same world evaluated on the spot.
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { dirname, join } from 'node:path';
import { after, before, describe, test } from 'node:test';
import { request } from './frame/http.mjs';
import { program, startServer } from './frame/server.mjs';
import { columnPath, meshPath } from './frame/terrain.mjs';

const talusProgram = process.env.TALUS ?? join(dirname(program), 'talus');

function talus(...args) {
  return new Promise((resolve, reject) => {
    const child = spawn(talusProgram, args, { stdio: ['ignore', 'pipe', 'pipe'], timeout: 90_000 });
    let out = '';
    let err = '';
    child.stdout.setEncoding('utf8').on('data', (text) => (out += text));
    child.stderr.setEncoding('utf8').on('data', (text) => (err += text));
    child.on('error', reject);
    child.on('close', (code) => resolve({ code, out, err }));
  });
}

describe('talus', () => {
  let server;
  let at;
  let folder;
  before(async () => {
    server = await startServer();
    at = ['--server', `http://${server.ready.http}`];
    folder = mkdtempSync(join(tmpdir(), 'talus-cli-'));
  });
  after(async () => {
    if (folder) rmSync(folder, { recursive: true, force: true });
    await server?.stop();
  });

  test('gets the bytes that HTTP gives, and makes the same without a server', async () => {
    for (const format of ['drc', 'mesh', 'glb', 'density', 'height']) {
      const mesh = await meshPath(server, format === 'height' ? 'drc' : format);
      const key = /chunks\/(.*)\./.exec(mesh)[1];
      const [lod, x, , z] = key.split('/').map(Number);
      const path = format === 'height' ? columnPath({ name: 'default' }, { lod, x, z }) : mesh;
      const [served, local] = [join(folder, `served.${format}`), join(folder, `local.${format}`)];
      assert.equal((await talus('get', key, '-o', served, ...at)).code, 0);
      assert.equal((await talus('get', key, '-o', local, '--local')).code, 0);
      const bytes = (await request(server.ready.http, path)).body;
      assert.ok(readFileSync(served).equals(bytes), `${format} from the server`);
      assert.ok(readFileSync(local).equals(bytes), `${format} made here`);
    }
  });

  test('writes text meshes with as many faces as it should', async () => {
    const key = /chunks\/(.*)\./.exec(await meshPath(server))[1];
    const file = join(folder, 'chunk.obj');
    assert.equal((await talus('get', key, '-o', file, ...at)).code, 0);
    const text = readFileSync(file, 'utf8');
    const vertices = text.match(/^v /gm).length;
    const corners = [...text.matchAll(/^f (.*)$/gm)].flatMap((face) => face[1].split(' ').map((part) => Number(part.split('/')[0])));
    assert.ok(corners.length >= 3);
    assert.ok(corners.every((corner) => corner >= 1 && corner <= vertices));
  });

  test('says what a world is, as JSON too', async () => {
    const { code, out } = await talus('info', '--json', ...at);
    assert.equal(code, 0);
    assert.equal(JSON.parse(out).name, 'default');
  });

  test('flies until its view is complete, and decodes what it gets', async () => {
    const { code, out, err } = await talus('fly', '--until-complete', '--decode', '--far', '1000', '--seconds', '60', '--json', ...at);
    assert.equal(code, 0, err);
    const summary = JSON.parse(out);
    assert.equal(summary.complete, 1);
    assert.equal(summary.failed, 0);
    assert.equal(summary.chunks, summary.wanted);
    assert.ok(summary.meshes > 50 && summary.triangles > 10_000, out);
  });

  test('flies with ten viewers at once and loses none', async () => {
    const { code, out, err } = await talus('fly', '--viewers', '10', '--speed', '100', '--to', '2000,500,0', '--from', '0,500,0',
      '--far', '500', '--seconds', '4', '--json', ...at);
    assert.ok(code === 0 || code === 5, err);
    const summary = JSON.parse(out);
    assert.equal(summary.failed, 0, err);
    assert.ok(summary.chunks > 100 && summary.leaves > 0, out);
  });

  test('ends with the code that its help promises', async () => {
    assert.equal((await talus('get', '0/0/900/0', '-o', join(folder, 'none.drc'), ...at)).code, 3);
    assert.equal((await talus('get', '0/0/x/0', '-o', join(folder, 'none.drc'), ...at)).code, 2);
    assert.equal((await talus('get', '0/0/0/0', '-o', join(folder, 'none.xyz'), ...at)).code, 2);
    const nobody = await talus('info', '--server', 'http://127.0.0.1:1');
    assert.equal(nobody.code, 1);
    assert.match(nobody.err, /127\.0\.0\.1:1/);
  });
});

test('pregen fills the disk cache, goes on where it was, and a server that starts anew makes nothing of the area', async (t) => {
  const folder = mkdtempSync(join(tmpdir(), 'talus-pregen-'));
  t.after(() => rmSync(folder, { recursive: true, force: true }));
  const serve = () => startServer(['--disk-cache', join(folder, 'cache')]);
  const pregen = (server, ...more) =>
    talus('pregen', '--server', `http://${server.ready.http}`, '--area', '0,0,0.5', '--lod-low', '2', '--lod-high', '4', ...more);
  const progress = join(folder, 'progress');

  const first = await serve();
  try {
    const cut = await pregen(first, '--progress', progress, '--seconds', '0.1');
    assert.equal(cut.code, 5, cut.err);
    assert.match(readFileSync(progress, 'utf8'), /^talus pregen [0-9a-f]{64} 0,0,0\.5 2\.\.4\n\d+\n$/);
    const rest = await pregen(first, '--progress', progress);
    assert.equal(rest.code, 0, rest.err);
    const [, done, all] = rest.out.match(/^(\d+) of (\d+) columns/);
    assert.equal(done, all);
    assert.equal(Number(readFileSync(progress, 'utf8').split('\n')[1]), Number(all));
    const again = await pregen(first, '--progress', progress);
    assert.equal(again.code, 0);
    assert.match(again.out, /, 0 surfaces,/);
    const other = await talus('pregen', '--server', `http://${first.ready.http}`, '--area', '9,9,1', '--progress', progress);
    assert.equal(other.code, 1);
    assert.match(other.err, /something else/);
    const head = readFileSync(progress, 'utf8').split('\n')[0];
    for (const beyond of [`${Number(all) + 1}`, '18446744073709551615']) {
      writeFileSync(progress, `${head}\n${beyond}\n`);
      const refused = await pregen(first, '--progress', progress);
      assert.equal(refused.code, 1, beyond);
      assert.match(refused.err, /something else/);
    }
    writeFileSync(progress, head.padEnd(5000, ' '));
    const large = await pregen(first, '--progress', progress);
    assert.equal(large.code, 1);
    assert.match(large.err, /larger than 4096 bytes/);
  } finally {
    await first.stop();
  }

  const second = await serve();
  try {
    const stored = await pregen(second);
    assert.equal(stored.code, 0, stored.err);
    assert.doesNotMatch(stored.out, /, 0 surfaces,/);
    const metrics = await (await fetch(`http://${second.ready.admin}/metrics`)).text();
    assert.match(metrics, /talus_chunk_requests_total\{outcome="built"\} 0\n/);
  } finally {
    await second.stop();
  }
});
