// Pages in a headless Chromium that draws in software; the real viewer among them, against a real talusd.
import { existsSync, mkdirSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';

const root = fileURLToPath(new URL('../../../', import.meta.url));
export const builtViewer = join(root, 'client_sample/web/dist');
const screenshots = join(root, 'tests/e2e/screenshots');
const program = process.env.CHROMIUM ?? '/usr/bin/chromium';

// playwright-core comes with the viewer's own development packages.
const requireFromViewer = createRequire(join(root, 'client_sample/web/package.json'));

const flags = [
  '--no-sandbox',
  '--use-gl=angle',
  '--use-angle=swiftshader',
  '--enable-unsafe-swiftshader',
  '--ignore-gpu-blocklist',
  '--disable-background-networking',
  '--disable-component-update',
  '--disable-sync',
  '--disable-quic',
  '--no-first-run',
];

/// Opens a page. `faults` collects console errors, draw calls that WebGL refused, page errors and failed or refused
/// requests.
export async function openPage(t, url, viewport) {
  if (!existsSync(program)) throw new Error(`${program} is missing: install chromium or set CHROMIUM`);
  const { chromium } = requireFromViewer('playwright-core');
  const browser = await chromium.launch({ executablePath: program, args: flags });
  t.after(() => browser.close());
  const page = await browser.newPage({ viewport });
  const faults = [];
  page.on('console', (message) => {
    const isRefusedByGl = /GL_INVALID|WebGL: INVALID/.test(message.text()); // said as a warning
    const fault = `console: ${message.text()}`;
    if ((message.type() === 'error' || isRefusedByGl) && !faults.includes(fault)) faults.push(fault);
  });
  page.on('pageerror', (error) => faults.push(`page: ${error.message}`));
  page.on('requestfailed', (request) => faults.push(`request: ${request.url()} ${request.failure()?.errorText}`));
  page.on('response', (response) => {
    if (response.status() >= 400) faults.push(`answer: ${response.url()} ${response.status()}`);
  });
  await page.goto(url, { timeout: 120_000 });
  return { page, faults };
}

/// Opens a page of the viewer.
export async function openViewer(t, base, query) {
  if (!existsSync(join(builtViewer, 'index.html'))) throw new Error(`${builtViewer} is missing: npm ci && npm run build in client_sample/web`);
  const { page, faults } = await openPage(t, `${base}/?${query}`, { width: 960, height: 600 });
  return { page, faults, state: () => page.evaluate(() => window.talus?.state() ?? null) };
}

/// Polls until `wanted(state)` holds; the last state is in the message when it does not.
export async function until(viewer, what, wanted, ms) {
  const deadline = Date.now() + ms;
  let last = null;
  while (Date.now() < deadline) {
    last = await viewer.state();
    if (last !== null && wanted(last)) return last;
    await new Promise((resolve) => setTimeout(resolve, 250));
  }
  throw new Error(`not within ${ms} ms: ${what}; the page says ${JSON.stringify(last)}; faults: ${viewer.faults.join('; ')}`);
}

export async function screenshot(viewer, name) {
  mkdirSync(screenshots, { recursive: true });
  await viewer.page.screenshot({ path: join(screenshots, `${name}.png`), timeout: 90_000 });
}
