// `cmake --install` gives an engine everything it needs: a project of its own finds, builds, links and runs.
import assert from 'node:assert/strict';
import { execFile, execFileSync } from 'node:child_process';
import { cpSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { promisify } from 'node:util';

import { startServer } from '../doors/frame/server.mjs';

const here = fileURLToPath(new URL('.', import.meta.url));
const build = join(here, '../../../build/release');

/// Standard output of a command; what it said is in the error when it fails.
function run(command, ...args) {
  return execFileSync(command, args, { encoding: 'utf8', stdio: 'pipe', timeout: 300_000 });
}

/// The one program in the library's README.
function program_of_the_readme() {
  const text = readFileSync(join(here, '../../../client_sample/library/README.md'), 'utf8');
  const programs = [...text.matchAll(/^```cpp\n(.*?)^```$/gms)];
  assert.equal(programs.length, 1);
  return programs[0][1];
}

test('an engine, and the program in the README, build and run against the installed package alone', { timeout: 600_000 }, async (t) => {
  const folder = mkdtempSync(join(tmpdir(), 'talus-install-'));
  t.after(() => rmSync(folder, { recursive: true }));
  const project = join(folder, 'project');
  cpSync(here, project, { recursive: true });
  writeFileSync(join(project, 'viewer.cpp'), program_of_the_readme());
  const prefix = join(folder, 'prefix');
  run('cmake', '--install', build, '--prefix', prefix);
  run('cmake', '-G', 'Ninja', '-S', project, '-B', join(folder, 'build'), `-DCMAKE_PREFIX_PATH=${prefix}`, '-DCMAKE_BUILD_TYPE=Release');
  run('cmake', '--build', join(folder, 'build'));
  assert.match(run(join(folder, 'build/engine')), /^[1-9]\d* triangles in [1-9]\d* bytes\n$/);

  const server = await startServer();
  t.after(() => server.stop());
  for (const url of [`http://${server.ready.http}`, `tcp://${server.ready.tcp}`]) {
    const { stdout } = await promisify(execFile)(join(folder, 'build/viewer'), [url], { timeout: 120_000 });
    assert.match(stdout, /^[1-9]\d* chunks, [1-9]\d* strips, complete: 1\n$/);
  }
  assert.match(run(join(prefix, 'bin/talusd'), '--version'), /\d+\.\d+\.\d+/);
});
