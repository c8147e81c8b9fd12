// SPDX-License-Identifier: Apache-2.0
// The report of a fleet of 10 000 in a real browser: it can be sorted, searched and scrolled. Times are printed, not
// judged: 3 s are wanted until it is open.
import assert from 'node:assert/strict';
import { mkdirSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { pathToFileURL } from 'node:url';
import { folder, kinfer, launch } from './browser.mjs';

const tasks = 10000;
const runs = join(folder, 'fleet_runs');
let browser;

/** Folders as a sweep leaves them, of calibrations with 24 parameters; the same numbers at each run. */
function makeRuns() {
  rmSync(runs, { recursive: true, force: true });
  mkdirSync(runs, { recursive: true });
  let state = 1;
  const random = () => (state = (state * 48271) % 2147483647) / 2147483647 - 0.5;
  let manifest = 'key,verb,arguments,robot,date\n';
  const names = Array.from({ length: 24 }, (_, i) => ['a', 'alpha', 'd', 'theta'][i % 4] + (1 + Math.floor(i / 4)));
  for (let i = 0; i < tasks; ++i) {
    const key = `r${String(i).padStart(5, '0')}`;
    manifest += `${key},calibrate,--data ${key}.csv,robot${i % 100},2026-${String(1 + (i % 12)).padStart(2, '0')}-01\n`;
    mkdirSync(join(runs, key));
    const refused = i % 500 === 7;
    const task = { format: 'kinfer-task/1', key, verb: 'calibrate', exit_code: refused ? 2 : 0, signal: 0,
      processor_class: 'x86_64 avx2, kernels avx2', sentence: refused ? 'poses.csv:14: expected 9 columns, found 8' : '' };
    writeFileSync(join(runs, key, 'task.json'), JSON.stringify(task, null, 1));
    if (refused) continue;
    const summary = { format: 'kinfer-summary/1', verb: 'calibrate', usability: 'use', reason: 'improves_nominal',
      figures: [{ name: 'rms_before_m', value: 1e-3 + 2e-4 * random() },
        { name: 'rms_after_m', value: (i === 4321 ? 1e-3 : 1e-4) * (1 + 0.3 * random()) }], findings: [],
      parameters: names.map((name) => ({ name, unit: 'rad', nominal: 0.5, value: 0.5 + 1e-3 * random(), sd: 1e-4 })),
      information: { names, nominal: names.map(() => 0.5), tolerance: names.map(() => 1e-3),
        vector: names.map(() => 10 * random()),
        information: names.map((_, r) => names.map((_, c) => (r === c ? 123.456789 : 0.123456789))) } };
    writeFileSync(join(runs, key, 'summary.json'), JSON.stringify(summary));
  }
  writeFileSync(join(runs, 'manifest.csv'), manifest);
}

before(async () => {
  mkdirSync(folder, { recursive: true });
  makeRuns();
  browser = await launch();
});
after(() => {
  rmSync(runs, { recursive: true, force: true });
  return browser?.close();
});

test('10 000 results are merged, and only the visible rows are in the page', async () => {
  const began = Date.now();
  kinfer('merge', 'fleet_runs', '--out', 'fleet', '--quiet');
  console.log(`merged in ${Date.now() - began} ms`);
  const page = await browser.newPage({ viewport: { width: 1280, height: 800 } });
  const complaints = [];
  page.on('console', (message) => ['error', 'warning'].includes(message.type()) && complaints.push(message.text()));
  page.on('pageerror', (error) => complaints.push(String(error)));
  const opened = Date.now();
  await page.goto(pathToFileURL(join(folder, 'fleet', 'report.html')).href);
  await page.waitForFunction(() => document.documentElement.dataset.ready === 'true');
  const milliseconds = Date.now() - opened;
  console.log(`open after ${milliseconds} ms`);
  assert.deepEqual(complaints, []);

  const texts = (column) => page.$$eval('.fleet-scroll tbody:nth-of-type(2) tr', (rows, k) => rows.map((row) => row.cells[k].textContent), column);
  assert.ok((await texts(0)).length < 100, 'only the visible rows are in the page');
  assert.equal((await texts(4))[0], 'refused', 'worst first');
  assert.ok((await page.textContent('#unusual')).includes('r04321'));
  await page.fill('#fleet-rows input', 'robot7 r04');
  assert.ok((await texts(1)).every((robot) => robot.startsWith('robot7')));
  await page.fill('#fleet-rows input', '');
  await page.click('.fleet-scroll th:nth-child(1) button');
  assert.equal((await texts(0))[0], 'r00000');
  await page.$eval('.fleet-scroll', (scroll) => (scroll.scrollTop = scroll.scrollHeight));
  await page.waitForFunction(() => document.querySelector('.fleet-scroll tbody:nth-of-type(2)').lastElementChild.cells[0].textContent === 'r09999');
  await page.evaluate(() => window.scrollTo(0, 0));
  await page.screenshot({ path: join(folder, 'fleet.png'), fullPage: true });
  await page.close();
});
