// How the program begins and ends: help, faulty arguments and files, addresses in use, draining.
import assert from 'node:assert/strict';
import { createServer } from 'node:net';
import { describe, test } from 'node:test';
import { request } from './frame/http.mjs';
import { runToEnd, startServer, temporaryFile } from './frame/server.mjs';
import { openWebSocket } from './frame/websocket.mjs';

const anywhere = ['--listen', '127.0.0.1:0', '--tcp-listen', '127.0.0.1:0', '--admin-listen', '127.0.0.1:0'];

describe('talusd', () => {
  test('explains itself', async () => {
    const { code, out } = await runToEnd(['--help']);
    assert.equal(code, 0);
    for (const option of ['--world', '--listen', '--tcp-listen', '--admin-listen', '--threads', '--cache-mib', '--viewer']) {
      assert.ok(out.includes(option), option);
    }
  });

  const arguments_ = [
    ['--no-such-option'],
    ['--threads', '-1'],
    ['--threads', 'many'],
    ['--cache-mib', '-5'],
    ['--listen', 'nowhere'],
    ['--listen', '127.0.0.1:99999'],
    ['--listen', '127.0.0.1'],
    ['--world', '/no/such/world.toml'],
    ['--config', '/no/such/config.toml'],
  ];
  for (const bad of arguments_) {
    test(`refuses ${bad.join(' ')} and names it`, async () => {
      const { code, err, out } = await runToEnd([...(bad[0] === '--listen' ? [] : anywhere), ...bad]);
      assert.notEqual(code, 0);
      assert.notEqual(code, null, 'it crashed');
      const named = bad[1]?.startsWith('/') ? bad[1] : bad[0].replace(/^--/, '');
      assert.ok((err + out).includes(named), `${named} is not named in:\n${err}${out}`);
      assert.ok(!out.includes('"ready"'));
    });
  }

  test('names an address in use and what to do', async () => {
    const holder = createServer().listen(0, '127.0.0.1');
    await new Promise((resolve) => holder.once('listening', resolve));
    try {
      const address = `127.0.0.1:${holder.address().port}`;
      const { code, err } = await runToEnd([...anywhere, '--listen', address].slice(2));
      assert.notEqual(code, 0);
      assert.ok(err.includes(address), err);
      assert.match(err, /in use/i);
    } finally {
      holder.close();
    }
  });

  for (const signal of ['SIGTERM', 'SIGINT']) {
    test(`drains on ${signal}: open streams hear 1001 and it ends with 0`, async () => {
      const server = await startServer();
      const socket = await openWebSocket(server.ready.http, '/v1/worlds/default/stream');
      assert.equal((await request(server.ready.http, '/readyz')).status, 200);
      const ended = server.stop(signal);
      assert.equal(await socket.closed, 1001);
      socket.destroy();
      const { code, signal: killed } = await ended;
      assert.equal(killed, null);
      assert.equal(code, 0, server.log.err);
    });
  }

  test('ends with 0 when nobody is connected, and writes nothing but the ready line to standard output', async () => {
    const server = await startServer();
    const { code } = await server.stop();
    assert.equal(code, 0, server.log.err);
    assert.equal(server.log.out, '');
  });
});

describe('a file of settings', () => {
  test('that talusd prints is one that it accepts', async (t) => {
    const { code, out } = await runToEnd(['--print-config']);
    assert.equal(code, 0);
    const checked = await runToEnd(['--check-config', '--config', temporaryFile(t, 'talusd.toml', out)]);
    assert.equal(checked.code, 0, checked.err);
  });

  test('is refused with file, line, key, range and the nearest key', async (t) => {
    const path = temporaryFile(t, 'talusd.toml', 'threads = 2\ncache_mb = 5\nbody_bytes = -1\nidle_s = "long"\n');
    const { code, err } = await runToEnd([...anywhere, '--config', path]);
    assert.notEqual(code, 0);
    assert.notEqual(code, null, 'it crashed');
    assert.match(err, /talusd\.toml:2: .*cache_mb.*cache_mib/);
    assert.match(err, /talusd\.toml:3: .*body_bytes.*\d+ ?\.\. ?\d+/);
    assert.match(err, /talusd\.toml:4: .*idle_s/);
  });
});

describe('a world file', () => {
  const start = async (t, text) => {
    const path = temporaryFile(t, 'alps.toml', text);
    return { path, ...(await runToEnd([...anywhere, '--world', path])) };
  };

  test('names the world it makes', async (t) => {
    const path = temporaryFile(t, 'alps.toml', 'name = "alps"\nseed = 7\n');
    const server = await startServer(['--world', path]);
    try {
      assert.deepEqual(server.ready.worlds, ['alps']);
      const manifest = JSON.parse((await request(server.ready.http, '/v1/worlds/alps')).body.toString());
      assert.equal(String(manifest.seed), '7');
    } finally {
      await server.stop();
    }
  });

  const faults = {
    'that is not TOML': ['name = "alps"\nseed = = 3\n', /alps\.toml:2\b/],
    'with an unknown key, and the nearest known one': ['name = "alps"\nsead = 3\n', /alps\.toml:2: .*sead[^]*seed/],
    'with the wrong type': ['name = "alps"\nseed = "seven"\n', /alps\.toml:2: .*seed/],
    'with a name that no URL could hold': ['name = "Les Alpes"\n', /alps\.toml:1: .*name/],
  };
  for (const [what, [text, expected]] of Object.entries(faults)) {
    test(`${what} is refused with file, line and key`, async (t) => {
      const { code, err } = await start(t, text);
      assert.notEqual(code, 0);
      assert.notEqual(code, null, 'it crashed');
      assert.match(err, expected);
    });
  }

  test('with values out of range is refused with every fault and the allowed range', async (t) => {
    const { code, err } = await start(t, 'name = "alps"\n[erosion]\nstrength_no_such = 1\noctaves = 1000000000\n');
    assert.notEqual(code, 0);
    assert.match(err, /alps\.toml:3: /);
    assert.match(err, /alps\.toml:4: .*erosion\.octaves.*0 ?\.\. ?10/);
  });

  test('of two megabytes is refused', async (t) => {
    const { code } = await start(t, `# ${'x'.repeat(2 * 1024 * 1024)}\n`);
    assert.notEqual(code, 0);
    assert.notEqual(code, null, 'it crashed');
  });
});
