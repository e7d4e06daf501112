#!/usr/bin/env node
// Figures of the whole service, each as one command; server and clients share this machine, so times hold for it only.
//   node tests/bench/service.mjs viewers [N,N,...] [SECONDS]   viewers in flight: latencies, memory, chunks per CPU second
//   node tests/bench/service.mjs scanner [SECONDS] [MIB]       an ordinary client without and with a scanner beside it, over
//                                                              a memory cache so small that the scanner fills it
//   node tests/bench/service.mjs join [RUNS]                   to walkable ground over 4 Mbit/s (a network namespace: root)
// Needs build/release/bin/talusd and talus (cmake --build --preset release).
import { execFile, execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { promisify } from 'node:util';

import { startServer } from '../e2e/doors/frame/server.mjs';

const root = fileURLToPath(new URL('../../', import.meta.url));
const talus = process.env.TALUS ?? join(root, 'build/release/bin/talus');
const ticks_per_s = 100; // of /proc: USER_HZ on every Linux

/// As whoever starts it has it.
const asUsers = { poolNice: 5 };

const ms = (seconds) => (seconds === undefined ? '-' : (seconds * 1e3).toFixed(seconds < 0.1 ? 2 : 0));

/// Resident and peak memory in MiB, and CPU seconds used so far, of a process.
function usage(pid) {
  const status = readFileSync(`/proc/${pid}/status`, 'utf8');
  const mib = (field) => Number(status.match(new RegExp(`^${field}:\\s+(\\d+)`, 'm'))[1]) / 1024;
  const stat = readFileSync(`/proc/${pid}/stat`, 'utf8').split(') ')[1].split(' ');
  return { rss_mib: mib('VmRSS'), peak_mib: mib('VmHWM'), cpu_s: (Number(stat[11]) + Number(stat[12])) / ticks_per_s };
}

/// `talus load` against `server`; its report, whatever it found.
async function load(server, args) {
  const run = promisify(execFile)(talus, ['load', '--json', '--server', `http://${server.ready.http}`, '--tcp', `tcp://${server.ready.tcp}`,
    '--metrics', `http://${server.ready.admin}`, ...args], { maxBuffer: 1 << 24 });
  const { stdout } = await run.catch((failed) => (failed.stdout ? failed : Promise.reject(failed)));
  return JSON.parse(stdout);
}

const outcome = (report, name) => report.server.counters[`talus_chunk_requests_total{outcome="${name}"}`] ?? 0;

async function viewers(counts = '1,10,50,100,250,500', seconds = '30') {
  console.log('viewers  first byte cold p50/p99 ms  cached p50/p99 ms  view complete p50/p99 s  chunks/s  built/s per core  server CPU  RSS MiB  faults');
  for (const count of counts.split(',')) {
    const server = await startServer(['--connections-per-address', '12000', '--log-level', 'warning'], asUsers);
    try {
      const before = usage(server.pid);
      const report = await load(server, [join(root, 'client_sample/load/scenarios/flyers.toml'), '--fly', count, '--seconds', seconds]);
      const after = usage(server.pid);
      const { fly, fetch } = report.kinds;
      const cpu_s = after.cpu_s - before.cpu_s;
      console.log(`${count.padStart(7)}  ${ms(fetch.first_byte?.p50_s)} / ${ms(fetch.first_byte?.p99_s)}`.padEnd(36) +
        `${ms(fetch.first_byte_again?.p50_s)} / ${ms(fetch.first_byte_again?.p99_s)}`.padEnd(19) +
        `${fly.complete?.p50_s.toFixed(2) ?? '-'} / ${fly.complete?.p99_s.toFixed(2) ?? '-'} (${fly.complete?.count ?? 0})`.padEnd(25) +
        `${report.chunks_per_s.toFixed(0)}`.padEnd(10) + `${(outcome(report, 'built') / cpu_s).toFixed(0)}`.padEnd(18) +
        `${(cpu_s / report.seconds).toFixed(2)}`.padEnd(12) + `${after.rss_mib.toFixed(0)}`.padEnd(9) + report.faults);
      for (const fault of report.first_faults) console.log(`  fault: ${fault}`);
    } finally {
      await server.stop();
    }
  }
}

/// Of the chunks asked for over HTTP, the part that was there: the ordinary client's hit ratio, in percent. The scanner and
/// the viewers of the scenario stream.
function hitRatio(report) {
  const from = (where) => report.server.counters[`talus_http_chunks_total{from="${where}"}`] ?? 0;
  return (100 * from('memory')) / (from('memory') + from('pool'));
}

async function scanner(seconds = '40', mib = '16') {
  const scenario = join(root, 'client_sample/load/scenarios/scanner.toml');
  console.log('scanners  hit ratio %  cached p50/p99 ms (requests)  first p50/p99 ms  chunks built, scanned; faults');
  const server = await startServer(['--log-level', 'warning', '--cache-mib', mib], asUsers);
  const ratios = [];
  const slowest = [];
  try {
    // The same place, so that every run but the first finds what is left of the hot set in the cache.
    for (const scanners of ['0', '0', '1', '0', '1']) {
      const report = await load(server, [scenario, '--scan', scanners, '--seconds', seconds]);
      const { first_byte: first, first_byte_again: again } = report.kinds.fetch;
      ratios.push(hitRatio(report));
      slowest.push(again?.p99_s);
      console.log(`${scanners.padStart(8)}  ${ratios.at(-1).toFixed(2).padStart(11)}  ${ms(again?.p50_s)} / ${ms(again?.p99_s)} (${again?.count})  ` +
        `first ${ms(first?.p50_s)} / ${ms(first?.p99_s)}  built ${outcome(report, 'built')}  scanned ${report.kinds.scan?.chunks ?? 0}  faults ${report.faults}`);
    }
    const [, ...measured] = ratios;
    const mean = (from) => (measured[from] + measured[from + 2]) / 2;
    console.log(`hit ratio ${mean(0).toFixed(2)} % without, ${mean(1).toFixed(2)} % with a scanner: falls by ${(mean(0) - mean(1)).toFixed(2)} points (goal 5)`);
    console.log(`cached p99, with to without: ${(slowest[2] / slowest[1]).toFixed(2)} and ${(slowest[4] / slowest[3]).toFixed(2)} (goal 2)`);
  } finally {
    await server.stop();
  }
}

/// A link of 4 Mbit/s and 20 ms between this namespace and one called `name`; `undo` removes both.
function shapedLink(name) {
  const run = (line) => execFileSync('sh', ['-c', line], { stdio: 'pipe' });
  run(`ip netns add ${name}`);
  const undo = () => run(`ip netns del ${name}; ip link del ${name}0 2>/dev/null || true`);
  try {
    run(`ip link add ${name}0 type veth peer name ${name}1 netns ${name}`);
    run(`ip addr add 10.213.0.1/30 dev ${name}0 && ip link set ${name}0 up`);
    run(`ip netns exec ${name} sh -c 'ip addr add 10.213.0.2/30 dev ${name}1 && ip link set ${name}1 up && ip link set lo up'`);
    run(`tc qdisc add dev ${name}0 root tbf rate 4mbit burst 16kb latency 400ms`);
    return undo;
  } catch (fault) {
    undo();
    throw fault;
  }
}

async function joining(runs = '5') {
  const name = `talus${process.pid % 10000}`;
  const undo = shapedLink(name);
  try {
    const server = await startServer(['--log-level', 'warning'], { ...asUsers, ports: ['--listen', '10.213.0.1:0', '--tcp-listen', 'off', '--admin-listen', '127.0.0.1:0'] });
    try {
      for (let i = 0; i < Number(runs); ++i) {
        const { stdout } = await promisify(execFile)('ip', ['netns', 'exec', name, talus, 'load', '--walk', '1', '--seconds', '12', '--json',
          '--server', `http://${server.ready.http}`], { maxBuffer: 1 << 24 }).catch((failed) => (failed.stdout ? failed : Promise.reject(failed)));
        const { walk } = JSON.parse(stdout).kinds;
        console.log(`${i === 0 ? 'cold' : 'warm'}: welcome ${ms(walk.welcome?.max_s)} ms, first chunk ${ms(walk.first_chunk?.max_s)} ms, ` +
          `walkable ground ${ms(walk.ground?.max_s)} ms, complete view ${ms(walk.complete?.max_s)} ms, ${walk.bytes} bytes`);
      }
    } finally {
      await server.stop();
    }
  } finally {
    undo();
  }
}

const commands = { viewers, scanner, join: joining };
const [command, ...rest] = process.argv.slice(2);
if (!(command in commands)) {
  console.error('usage: node tests/bench/service.mjs viewers|scanner|join [...]');
  process.exit(2);
}
await commands[command](...rest);
