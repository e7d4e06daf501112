// `cmake --install` gives an engine everything it needs: a project of its own finds, builds, links and runs.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { test } from 'node:test';
import { fileURLToPath } from 'node:url';

const here = fileURLToPath(new URL('.', import.meta.url));
const build = join(here, '../../../build/release');

/// Standard output of a command; what it said is in the error when it fails.
function run(command, ...args) {
  return execFileSync(command, args, { encoding: 'utf8', stdio: 'pipe', timeout: 300_000 });
}

test('an engine builds and runs against the installed package alone', { timeout: 600_000 }, (t) => {
  const folder = mkdtempSync(join(tmpdir(), 'talus-install-'));
  t.after(() => rmSync(folder, { recursive: true }));
  const prefix = join(folder, 'prefix');
  run('cmake', '--install', build, '--prefix', prefix);
  run('cmake', '-G', 'Ninja', '-S', here, '-B', join(folder, 'build'), `-DCMAKE_PREFIX_PATH=${prefix}`, '-DCMAKE_BUILD_TYPE=Release');
  run('cmake', '--build', join(folder, 'build'));
  assert.match(run(join(folder, 'build/engine')), /^[1-9]\d* triangles in [1-9]\d* bytes\n$/);
  assert.match(run(join(prefix, 'bin/talusd'), '--version'), /\d+\.\d+\.\d+/);
});
