// What deploy/monitoring says about the metrics is true: the real Prometheus loads the rules, scrapes a real server and
// finds a series for every expression of the dashboard.
import assert from 'node:assert/strict';
import { spawn, spawnSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { test } from 'node:test';
import { fileURLToPath } from 'node:url';

import { json, request } from './frame/http.mjs';
import { freePort, startServer } from './frame/server.mjs';
import { meshPath } from './frame/terrain.mjs';

const folder = fileURLToPath(new URL('../../../deploy/monitoring/', import.meta.url));
const prometheus = process.env.PROMETHEUS ?? 'prometheus';
const isInstalled = spawnSync(prometheus, ['--version']).status === 0;
const readyMs = 120_000;

const dashboard = JSON.parse(readFileSync(join(folder, 'grafana.json'), 'utf8'));
const drawn = dashboard.panels.flatMap((panel) => (panel.targets ?? []).map(({ expr }) => ({ title: panel.title, expr })));

/// What Grafana fills in.
const filled = (expr) => expr.replaceAll('$__rate_interval', '1m').replaceAll('$instance', '.+');

/// Calls `look` until it gives something, for a bounded time.
async function eventually(look, what) {
  const end = Date.now() + readyMs;
  for (let last; ; await new Promise((done) => setTimeout(done, 500))) {
    try {
      const found = await look();
      if (found) return found;
    } catch (fault) {
      last = fault;
    }
    if (Date.now() > end) throw new Error(`${what}: not in ${readyMs} ms${last ? ` (${last.message})` : ''}`);
  }
}

/// Family names, and each `family label value`, of a text in Prometheus' format.
function named(metrics) {
  const names = new Set();
  for (const [, name, labels] of metrics.matchAll(/^(\w+)(?:\{(.*)\})? \S+$/gm)) {
    names.add(name);
    for (const [, label, value] of (labels ?? '').matchAll(/(\w+)="([^"]*)"/g)) names.add(`${name} ${label} ${value}`);
  }
  return names;
}

/// What an expression takes for granted: metrics, and values of their labels.
function assumed(expr) {
  const out = [];
  for (const [, name, labels] of expr.matchAll(/\b((?:talus|process)_\w+)(?:\{([^}]*)\})?/g)) {
    out.push(name);
    for (const [, label, values] of (labels ?? '').matchAll(/(\w+)=~?"([^"]*)"/g)) {
      if (label !== 'instance' && label !== 'job') for (const value of values.split('|')) out.push(`${name} ${label} ${value}`);
    }
  }
  return out;
}

async function startPrometheus(t, target) {
  const data = mkdtempSync(join(tmpdir(), 'talus-prometheus-'));
  const config = join(data, 'prometheus.yml');
  const text = readFileSync(join(folder, 'prometheus.yml'), 'utf8');
  writeFileSync(
    config,
    text
      .replaceAll('15s', '1s')
      .replace('127.0.0.1:9090', target)
      .replace('- alerts.yml', `- ${join(folder, 'alerts.yml')}`),
  );
  const at = `127.0.0.1:${await freePort()}`;
  const child = spawn(prometheus, [`--config.file=${config}`, `--storage.tsdb.path=${join(data, 'data')}`, `--web.listen-address=${at}`], {
    stdio: ['ignore', 'ignore', 'pipe'],
  });
  let log = '';
  child.stderr.setEncoding('utf8').on('data', (part) => (log += part));
  const ended = new Promise((done) => child.on('close', done));
  t.after(async () => {
    child.kill('SIGKILL');
    await ended;
    rmSync(data, { recursive: true, force: true });
  });
  await eventually(async () => {
    assert.equal(child.exitCode, null, `prometheus ended:\n${log}`);
    return (await request(at, '/-/ready')).status === 200;
  }, 'prometheus');
  return at;
}

test('dashboard and alerts name nothing that the server does not tell', async (t) => {
  const disk = mkdtempSync(join(tmpdir(), 'talus-monitoring-'));
  t.after(() => rmSync(disk, { recursive: true, force: true }));
  const server = await startServer(['--disk-cache', disk, '--threads', '1']);
  t.after(() => server.stop());
  const names = named((await request(server.ready.admin, '/metrics')).body.toString());
  const rules = readFileSync(join(folder, 'alerts.yml'), 'utf8');
  const said = rules.split('\n').filter((line) => !/summary:/.test(line)).join('\n');
  for (const expr of [said, ...drawn.map((one) => one.expr)]) {
    for (const name of assumed(expr)) assert.ok(names.has(name), `${name} is not in /metrics, but in: ${expr.slice(0, 200)}`);
  }
});

test('prometheus loads the rules and finds a series for every expression', { skip: !isInstalled && 'prometheus is not installed' }, async (t) => {
  const disk = mkdtempSync(join(tmpdir(), 'talus-monitoring-'));
  t.after(() => rmSync(disk, { recursive: true, force: true }));
  const server = await startServer(['--disk-cache', disk, '--threads', '1']);
  t.after(() => server.stop());
  await request(server.ready.http, await meshPath(server));
  const at = await startPrometheus(t, server.ready.admin);

  const ask = async (expr) => {
    const { json: answer } = await json(at, `/api/v1/query?query=${encodeURIComponent(filled(expr))}`);
    assert.equal(answer.status, 'success', `${expr}: ${answer.error}`);
    return answer.data.result;
  };
  await eventually(async () => (await ask('count_over_time(talus_ready[1m])'))[0]?.value[1] >= 2, 'two scrapes');
  for (const { title, expr } of drawn) {
    assert.notEqual((await ask(expr)).length, 0, `the panel "${title}" has no series for ${filled(expr)}`);
  }

  const rules = await eventually(async () => {
    const { json: answer } = await json(at, '/api/v1/rules');
    const all = answer.data.groups.flatMap((group) => group.rules);
    return all.length > 0 && all.every((rule) => rule.health !== 'unknown') && all;
  }, 'the rules');
  for (const rule of rules) {
    assert.equal(rule.health, 'ok', `${rule.name}: ${rule.lastError}`);
    assert.equal(rule.state, 'inactive', `${rule.name} fires at a server that is well`);
  }
  await server.stop();
  await eventually(async () => {
    const { json: answer } = await json(at, '/api/v1/rules');
    return answer.data.groups.flatMap((group) => group.rules).find((rule) => rule.name === 'TalusDown').state === 'pending';
  }, 'the alert of a server that is gone');
});
