// SPDX-License-Identifier: Apache-2.0
// The two reports in a real browser.
import assert from 'node:assert/strict';
import { readFileSync, statSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { cells, evidenceOf, folder, kinds, kinfer, launch, makeReports, open, picture, reportPath } from './browser.mjs';

const about = (shown, exact) => Math.abs(Number(shown) - exact) <= 1e-9 * Math.max(1, Math.abs(exact));
const degrees = 180 / Math.PI;

let browser;
before(async () => {
  makeReports();
  browser = await launch();
});
after(() => browser?.close());

for (const kind of kinds) {
  test(`the ${kind} report opens without errors and requests nothing`, async () => {
    const times = [];
    for (let i = 0; i < 3; ++i) {
      const { page, complaints, milliseconds, close } = await open(browser, kind);
      times.push(milliseconds);
      assert.deepEqual(complaints, []);
      assert.equal(await page.locator('#machine.live').count(), 1);
      await close();
    }
    console.log(`${kind}: interactive after ${Math.min(...times)} ms (of ${times.join(', ')})`);
    assert.ok(Math.min(...times) < 6000, `interactive after ${times} ms`);
  });

  test(`the ${kind} report fits wide and narrow screens, light and dark`, async () => {
    for (const width of [1280, 390])
      for (const colorScheme of ['light', 'dark']) {
        const { page, close } = await open(browser, kind, { viewport: { width, height: 844 }, colorScheme });
        const extent = await page.evaluate(() => document.scrollingElement.scrollWidth);
        assert.ok(extent <= width, `the page is ${extent} wide on a screen of ${width}`);
        await picture(page);
        await page.evaluate(() => window.scrollTo(0, 0));
        const height = Math.min(8000, await page.evaluate(() => document.scrollingElement.scrollHeight)); // GPUs draw no more
        const path = join(folder, `${kind}-${width}-${colorScheme}.png`);
        await page.screenshot({ path, fullPage: true, clip: { x: 0, y: 0, width, height } });
        await close();
      }
  });

  test(`the ${kind} report prints on A4 with all its sections and drawings`, async () => {
    const { page, close } = await open(browser, kind);
    await page.emulateMedia({ media: 'print' });
    const sizes = await page.$$eval('section, .still svg, figure svg', (elements) =>
      elements.filter((e) => !e.closest('details:not([open])')).map((e) => [e.id || e.getAttribute('aria-label'), e.getBoundingClientRect().height]),
    );
    for (const [what, height] of sizes) assert.ok(height > 10, `${what} is ${height} high on paper`);
    assert.equal(await page.locator('.stage canvas').isVisible(), false);
    const pdf = await page.pdf({ path: join(folder, `${kind}.pdf`), format: 'A4', printBackground: true });
    const pages = pdf.toString('latin1').match(/\/Type\s*\/Page\b/g)?.length ?? 0;
    const height = await page.evaluate(() => document.body.scrollHeight);
    assert.ok(pages >= 3, `${pages} pages for ${height} pixels`);
    await close();
  });

  test(`the ${kind} report is readable without scripts`, async () => {
    const { page, close } = await open(browser, kind, { javaScriptEnabled: false });
    assert.ok((await page.locator('#verdict').textContent()).length > 20);
    assert.ok(await page.locator('.still svg.scene').isVisible());
    assert.ok((await page.locator('tbody tr').count()) > 20);
    await close();
  });

  test(`the machine of the ${kind} report rotates by the keyboard`, async () => {
    const { page, close } = await open(browser, kind);
    await page.locator('.stage canvas').focus();
    const first = await picture(page);
    await page.keyboard.press('ArrowRight');
    assert.notDeepEqual(await picture(page), first);
    await page.keyboard.press('0');
    assert.deepEqual(await picture(page), first);
    await close();
  });

  test(`a table of the ${kind} report is copied as CSV with all digits`, async () => {
    const { page, close } = await open(browser, kind);
    await page.evaluate(() => {
      Object.defineProperty(navigator, 'clipboard', { value: { writeText: async (text) => { window.copied = text; } } });
    });
    const id = kind === 'calibrate' ? 'parameters' : 'links';
    await page.locator(`[data-csv=${id}] .copy`).click();
    const copied = await page.evaluate(() => window.copied);
    const rows = await cells(page, id);
    assert.equal(copied.trim().split('\n').length, rows.length + 1);
    assert.ok(copied.includes(rows[0].slice(0, 4).join(',')));
    await close();
  });

  test(`kinfer report makes the ${kind} report again byte for byte, within a second`, () => {
    const first = readFileSync(reportPath(kind));
    const began = Date.now();
    kinfer('report', kind);
    const taken = Date.now() - began;
    assert.deepEqual(readFileSync(reportPath(kind)), first);
    assert.ok(taken < 1000, `made in ${taken} ms`);
    const megabytes = statSync(reportPath(kind)).size / 1e6;
    console.log(`${kind}: report.html of ${megabytes.toFixed(2)} MB made in ${taken} ms`);
    assert.ok(megabytes < (kind === 'calibrate' ? 1.5 : 5), `${megabytes} MB`);
  });
}

test('the tables of a calibration equal evidence.json', async () => {
  const { page, close } = await open(browser, 'calibrate');
  const evidence = evidenceOf('calibrate');
  const parameters = await cells(page, 'parameters');
  assert.equal(parameters.length, evidence.parameters.length);
  evidence.parameters.forEach((p, i) => {
    const factor = p.unit === 'm' ? 1e3 : p.unit === 'rad' ? degrees : 1;
    assert.equal(parameters[i][0], p.name);
    assert.ok(about(parameters[i][1], factor * p.nominal), `${p.name}: ${parameters[i][1]}`);
    assert.ok(about(parameters[i][2], factor * p.value), `${p.name}: ${parameters[i][2]}`);
    assert.ok(about(parameters[i][4], factor * p.sd), `${p.name}: ${parameters[i][4]}`);
    assert.equal(parameters[i][7] !== "not determined", p.identifiable);
  });
  const errors = Object.fromEntries((await cells(page, 'errors')).map(([name, ...rest]) => [name, rest]));
  const holdout = errors['calibrated, rows not fitted'];
  const { mean, rms, sd, max, n } = evidence.after.holdout;
  [mean, rms, sd, max].forEach((value, i) => assert.ok(about(holdout[i], 1e3 * value)));
  assert.equal(Number(holdout[4]), n);
  await close();
});

test('the tables of an identification equal evidence.json', async () => {
  const { page, close } = await open(browser, 'identify');
  const evidence = evidenceOf('identify');
  const joints = await cells(page, 'joints');
  assert.equal(joints.length, 2 * evidence.joints.length);
  evidence.joints.forEach((joint, i) => {
    assert.equal(joints[2 * i][0], `${joint.parent}–${joint.child}`);
    joint.axis_in_parent.forEach((v, k) => assert.ok(about(joints[2 * i][3].split(' ')[k], v)));
    joint.point_in_child.forEach((v, k) => assert.ok(about(joints[2 * i + 1][5].split(' ')[k], 1e3 * v)));
  });
  const dh = await cells(page, 'dh');
  evidence.dh.forEach((row, i) => {
    assert.ok(about(dh[i][1], degrees * row.theta));
    assert.ok(about(dh[i][2], 1e3 * row.d));
    assert.ok(about(dh[i][3], 1e3 * row.a));
    assert.ok(about(dh[i][4], degrees * row.alpha));
  });
  const links = await cells(page, 'links');
  evidence.links.forEach((link, i) => {
    if (link.pin_distance_m !== undefined) assert.ok(about(links[i][3], 1e3 * link.pin_distance_m));
    assert.ok(about(links[i][6], degrees * link.axis_angle_rad));
    assert.ok(about(links[i][7], 1e3 * link.length_m));
  });
  await close();
});

test('a joint slider moves the robot, and a chosen pose moves it back', async () => {
  const { page, close } = await open(browser, 'calibrate');
  const first = await picture(page);
  await page.locator('summary', { hasText: 'Move the joints' }).click();
  const slider = page.locator('input[data-joint="1"]');
  const start = await slider.inputValue();
  await slider.focus();
  for (let i = 0; i < 8; ++i) await page.keyboard.press('ArrowRight');
  assert.notEqual(await slider.inputValue(), start);
  assert.notDeepEqual(await picture(page), first);
  await page.locator('.control', { hasText: 'Pose' }).locator('input').fill('1');
  await page.locator('.control', { hasText: 'Pose' }).locator('input').fill('0');
  assert.ok(Math.abs(Number(await slider.inputValue()) - Number(start)) < 1e-6);
  await close();
});

test('the exaggeration slider stretches the error vectors', async () => {
  const { page, close } = await open(browser, 'calibrate');
  const first = await picture(page);
  await page.locator('.control', { hasText: 'Exaggerate' }).locator('input').fill('0');
  assert.notDeepEqual(await picture(page), first);
  await close();
});

test('the time slider moves the machine through its recording, and play runs it', async () => {
  const { page, close } = await open(browser, 'identify');
  const first = await picture(page);
  const slider = page.locator('.control', { hasText: 'Time' }).locator('input');
  await slider.fill(String(Math.round(0.6 * Number(await slider.getAttribute('max')))));
  const later = await picture(page);
  assert.notDeepEqual(later, first);
  const held = Number(await slider.inputValue());
  await page.getByRole('button', { name: 'Play' }).click();
  await page.waitForFunction((from) => Number(document.querySelector('.play + .control input').value) > from, held);
  await page.getByRole('button', { name: 'Pause' }).click();
  await close();
});

test('the plot of a signal zooms and changes its sensor', async () => {
  const { page, close } = await open(browser, 'identify');
  const plot = page.locator('#traces .trace').first();
  await plot.scrollIntoViewIfNeeded();
  const first = await plot.screenshot();
  await page.locator('#traces select').first().selectOption({ index: 2 });
  const other = await plot.screenshot();
  assert.notDeepEqual(other, first);
  const box = await plot.locator('.u-over').boundingBox();
  await page.mouse.move(box.x + 0.3 * box.width, box.y + 40);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.5 * box.width, box.y + 40, { steps: 4 });
  await page.mouse.up();
  assert.notDeepEqual(await plot.screenshot(), other);
  await close();
});
