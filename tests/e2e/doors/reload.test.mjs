// SIGHUP: what an operator changes in a file takes effect without a restart, and a bad file changes nothing.
import assert from 'node:assert/strict';
import { writeFileSync } from 'node:fs';
import { describe, test } from 'node:test';
import { request } from './frame/http.mjs';
import { startServer, temporaryFile } from './frame/server.mjs';

async function eventually(holds, what) {
  for (let i = 0; i < 300; i += 1) {
    if (await holds()) return;
    await new Promise((resolve) => setTimeout(resolve, 100));
  }
  assert.fail(`${what}: not in 30 s`);
}

describe('SIGHUP', () => {
  test('takes new limits over, refuses a bad file with its reason, names what waits for a restart', async (t) => {
    const path = temporaryFile(t, 'talusd.toml', 'head_fields = 64\n');
    const server = await startServer(['--config', path]);
    t.after(() => server.stop());
    const headers = Object.fromEntries(Array.from({ length: 20 }, (_, i) => [`X-${i}`, 'a']));
    const status = async () => (await request(server.ready.http, '/healthz', { headers })).status;
    assert.equal(await status(), 200);

    writeFileSync(path, 'head_fields = 8\ncache_mib = 77\n');
    process.kill(server.pid, 'SIGHUP');
    await eventually(async () => (await status()) === 431, 'the new limit');
    assert.match(server.log.err, /"event":"settings that wait for a restart".*cache_mib/);

    writeFileSync(path, 'head_fields = 64\nhead_bytes = -1\n');
    process.kill(server.pid, 'SIGHUP');
    await eventually(() => /"event":"settings not reloaded".*talusd\.toml:2: .*head_bytes/.test(server.log.err), 'the refusal');
    assert.equal(await status(), 431, 'the old limit stays');
    const metrics = (await request(server.ready.admin, '/metrics')).body.toString();
    assert.match(metrics, /talus_reloads_total\{outcome="done"\} 1/);
    assert.match(metrics, /talus_reloads_total\{outcome="refused"\} 1/);
  });
});
