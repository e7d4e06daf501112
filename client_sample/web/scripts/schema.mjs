// Regenerates src/protocol/generated from protocol/schema/talus.fbs, or with --check says whether it is current.
// Needs flatc (Debian: flatbuffers-compiler) on the path, or its place in $FLATC.
import { execFileSync } from 'node:child_process';
import { cpSync, mkdtempSync, readdirSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join, relative } from 'node:path';
import { fileURLToPath } from 'node:url';

const schema = fileURLToPath(new URL('../../../protocol/schema/talus.fbs', import.meta.url));
const committed = fileURLToPath(new URL('../src/protocol/generated', import.meta.url));

function filesBelow(folder) {
  return readdirSync(folder, { withFileTypes: true }).flatMap((entry) =>
    entry.isDirectory() ? filesBelow(join(folder, entry.name)) : [join(folder, entry.name)],
  );
}

function contents(folder) {
  return new Map(filesBelow(folder).map((file) => [relative(folder, file), readFileSync(file, 'utf8')]));
}

const fresh = mkdtempSync(join(tmpdir(), 'talus-schema-'));
try {
  execFileSync(process.env.FLATC ?? 'flatc', ['--ts', '-o', fresh, schema], { stdio: 'inherit' });
  if (process.argv.includes('--check')) {
    const now = contents(fresh);
    const then = contents(committed);
    const stale = [...new Set([...now.keys(), ...then.keys()])].filter((name) => now.get(name) !== then.get(name));
    if (stale.length > 0) {
      console.error(`src/protocol/generated is not what the schema says (run: npm run schema):\n  ${stale.join('\n  ')}`);
      process.exitCode = 1;
    }
  } else {
    rmSync(committed, { recursive: true, force: true });
    cpSync(fresh, committed, { recursive: true });
  }
} finally {
  rmSync(fresh, { recursive: true, force: true });
}
