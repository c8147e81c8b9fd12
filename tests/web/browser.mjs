// SPDX-License-Identifier: Apache-2.0
// A real browser and reports to open in it, made once for all tests.
import { spawnSync } from 'node:child_process';
import { existsSync, mkdirSync, readFileSync, rmSync } from 'node:fs';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';

const source = process.env.KINFER_SOURCE;
const program = process.env.KINFER_PROGRAM;
export const folder = process.env.KINFER_BROWSER_FOLDER; // screenshots stay there

export function kinfer(...words) {
  const run = spawnSync(program, words, { cwd: folder, encoding: 'utf8' });
  if (run.status === null || run.status > 1) throw new Error(`kinfer ${words.join(' ')}: ${run.stderr}`);
  return run;
}

/** Folders with the results of both verbs. */
export function makeReports() {
  rmSync(folder, { recursive: true, force: true });
  mkdirSync(folder, { recursive: true });
  const robot = join(source, 'examples/robot6');
  kinfer('simulate-poses', '--robot', `${robot}/robot.toml`, '--errors', `${robot}/errors.toml`, '--out', 'poses');
  kinfer('calibrate', '--robot', 'poses/robot.toml', '--data', 'poses/poses.csv', '--out', 'calibrate', '--quiet');
  kinfer('simulate', 'excavator', '--grade', 'noise', '--out', 'drive', '--quiet');
  kinfer('identify', 'drive/imu.csv', '--engine', 'bp', '--individuals', '20', '--generations', '20', '--out', 'identify',
    '--quiet');
}

export const kinds = ['calibrate', 'identify'];
export const reportPath = (kind) => join(folder, kind, 'report.html');
export const evidenceOf = (kind) => JSON.parse(readFileSync(join(folder, kind, 'evidence.json'), 'utf8'));

export async function launch() {
  const { chromium } = await import(pathToFileURL(join(source, 'web/node_modules/playwright-core/index.mjs')).href);
  const executablePath = ['/usr/bin/chromium', '/usr/bin/chromium-browser'].find(existsSync);
  if (!executablePath)
    throw new Error('chromium is not installed: ./dev test installs it; KINFER_SKIP_BROWSER=1 skips these tests');
  return chromium.launch({
    executablePath,
    args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'],
  });
}

/** Opens a report and collects console messages, errors and network requests. */
export async function open(browser, kind, options = {}) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 800 }, ...options });
  const page = await context.newPage();
  page.setDefaultTimeout(120000); // [ms] the machine may do other things at the same time
  const complaints = [];
  page.on('console', (message) => {
    if (message.type() === 'error' || message.type() === 'warning') complaints.push(message.text());
  });
  page.on('pageerror', (error) => complaints.push(String(error)));
  const url = pathToFileURL(reportPath(kind)).href;
  page.on('request', (request) => {
    if (request.url() !== url && !request.url().startsWith('data:')) complaints.push(`requested ${request.url()}`);
  });
  const began = Date.now();
  await page.goto(url);
  if (options.javaScriptEnabled !== false) {
    await page.waitForFunction(() => document.documentElement.dataset.ready === 'true');
    await page.waitForFunction(() => Number(document.querySelector('.stage canvas')?.dataset.frames) > 0);
  }
  return { page, complaints, milliseconds: Date.now() - began, close: () => context.close() };
}

/** Rows of a table as exact texts. */
export function cells(page, id) {
  return page.$$eval(`#${id} tbody tr`, (rows) =>
    rows.map((row) => [...row.cells].map((cell) => cell.dataset.v ?? cell.textContent.trim())),
  );
}

/** A screenshot of the canvas once it is still. */
export async function picture(page) {
  const frames = () => page.$eval('.stage canvas', (canvas) => Number(canvas.dataset.frames));
  let last = -1;
  while (last !== (last = await frames())) await page.waitForTimeout(80);
  return page.locator('.stage').screenshot();
}
