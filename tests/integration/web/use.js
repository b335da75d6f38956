// SPDX-License-Identifier: GPL-3.0-or-later
// Goes through the pages of a service in Chromium and prints what was checked, as JSON:
//   node use.js SERVICE/ EXAMPLES PICTURES
// The service has a collection "delft" with the features of EXAMPLES/delft.city.jsonl.
import {existsSync, readFileSync} from 'node:fs';
import {createRequire} from 'node:module';
import {gzipSync} from 'node:zlib';

const require = createRequire(`${process.cwd()}/`);
const {chromium} = require('playwright-core');
const axe = readFileSync(require.resolve('axe-core/axe.min.js'), 'utf8');
const [service, examples, pictures] = process.argv.slice(2);

const kNearMiddle = 0.12;  // of the width or height of the picture
const kPlace = [0x9b, 0x30, 0xff];
const kFacet = [0xbb, 0x57, 0x63];  // red over a wall
const kPin = [0xd0, 0x24, 0x38];
const kChosen = [0xff, 0xd2, 0x3f];
const kRoof = [0x9f, 0x50, 0x3e];
const kTetrahedron = [0x8f, 0xb8, 0xde];

const kPatience = 30_000;  // milliseconds until a picture must be what is expected

const seen = [];
const check = (isRight, name) => seen.push({isRight: Boolean(isRight), name});

/// Checks what becomes true once all is loaded and drawn: asks until it is, or until patience ends.
async function eventually(isRight, name) {
  const end = Date.now() + kPatience;
  while (!await isRight() && Date.now() < end) await page.waitForTimeout(250);
  check(await isRight(), name);
}

const executablePath = ['/usr/bin/chromium', '/usr/bin/google-chrome'].find(existsSync);
const browser = await chromium.launch({
  executablePath,
  args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader']
});
const context = await browser.newContext(
    {viewport: {width: 1280, height: 860}, reducedMotion: 'reduce', acceptDownloads: true});
const page = await context.newPage();
page.setDefaultTimeout(60_000);
const troubles = [];
page.on('console', (message) => {
  if (message.type() === 'error') troubles.push(message.text());
});
page.on('pageerror', (error) => troubles.push(String(error)));
page.on('request', (request) => {
  const url = request.url();
  if (!url.startsWith(service) && !/^(data|blob):/.test(url)) troubles.push(`asks ${url}`);
});

/// Pixels of the picture near a colour: their share, and their middle in parts of the picture.
const pixels = (colour) => page.evaluate((wanted) => {
  const source = document.querySelector('.stage canvas');
  const copy = document.createElement('canvas');
  [copy.width, copy.height] = [source.width, source.height];
  const drawing = copy.getContext('2d');
  drawing.drawImage(source, 0, 0);
  const {data} = drawing.getImageData(0, 0, copy.width, copy.height);
  let count = 0, x = 0, y = 0;
  for (let i = 0; i < data.length; i += 4) {
    const distance = Math.hypot(...wanted.map((value, channel) => value - data[i + channel]));
    if (distance > 60) continue;
    ++count;
    x += (i / 4) % copy.width;
    y += Math.floor(i / 4 / copy.width);
  }
  return {
    share: count / (copy.width * copy.height),
    x: x / count / copy.width,
    y: y / count / copy.height
  };
}, colour);

const isSeen = async (colour, share) => (await pixels(colour)).share > share;

async function isInMiddle(colour, least = 0) {
  const {share, x, y} = await pixels(colour);
  return share > least && Math.abs(x - 0.5) < kNearMiddle && Math.abs(y - 0.5) < kNearMiddle;
}

async function isAboveMiddle(colour, least) {
  const {share, x, y} = await pixels(colour);
  return share > least && Math.abs(x - 0.5) < kNearMiddle && y < 0.5 && y > 0.2;
}

/// The picture as text, to see whether it changed.
const picture = () => page.evaluate(async () => {
  await new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve)));
  return document.querySelector('.stage canvas').toDataURL();
});

/// Waits until the picture stays as it is for a second.
async function quiet() {
  let before = '', same = 0;
  for (const end = Date.now() + kPatience; same < 4 && Date.now() < end;) {
    await page.waitForTimeout(250);
    const now = await picture();
    same = now === before ? same + 1 : 0;
    before = now;
  }
}

async function accessible(name) {
  for (const colorScheme of ['light', 'dark']) {
    await page.emulateMedia({colorScheme});
    await page.evaluate(axe);
    const {violations} = await page.evaluate(() => window.axe.run());
    const text = violations.map(({id, nodes}) => `${id} ${nodes[0].html}`).join('; ');
    check(violations.length === 0, `${name}, ${colorScheme}: axe finds nothing (${text})`);
  }
  await page.emulateMedia({colorScheme: 'light'});
}

const shot = (name) => page.screenshot({path: `${pictures}/${name}.png`});

async function judgeAndStore() {
  await page.goto(service);
  await accessible('the first page');
  await page.setInputFiles('#file', `${examples}/invalid.city.jsonl`);
  await page.getByText('invalid.city.jsonl is invalid: 11 solids.').waitFor();
  await page.getByRole('button', {name: 'Next finding'}).focus();
  await page.keyboard.press('Enter');
  await eventually(() => isInMiddle(kPlace), 'the camera flies to the place of the finding');
  await eventually(() => isSeen(kFacet, 0.01), 'its facet is red');
  check(
      (await page.locator('.said').first().textContent()).startsWith('Finding 1 of '),
      'the finding is said');
  await shot('judged');
  await accessible('a file that was judged');
  const downloading = page.waitForEvent('download');
  await page.getByRole('button', {name: 'Report (JSON)'}).click();
  const report = JSON.parse(readFileSync(await (await downloading).path(), 'utf8'));
  check(report.features.length === 11 && !report.validity, 'the report is downloaded');
  await page.getByText('Store this file').click();
  await page.getByLabel('Collection').fill('mine');
  await page.getByRole('button', {name: 'Store', exact: true}).click();
  await page.getByText('11 features stored in mine').waitFor();
  await page.getByRole('link', {name: 'mine'}).click();
  await page.waitForURL('**/collections/mine');
  check(true, 'the file is stored, and its collection is a click away');
}

async function refuse() {
  await page.goto(`${service}validate`);
  const file = {name: 'broken.city.json', mimeType: 'application/json', buffer: Buffer.from('{"a')};
  const before = troubles.length;
  await page.setInputFiles('#file', file);
  await page.getByText('broken.city.json: ').waitFor();
  check(
      /line 1, column 4/.test(await page.getByRole('status').first().textContent()),
      'a broken file is refused with the reason');
  troubles.splice(before);  // the browser logs the status 400
}

async function longFile() {
  await page.goto(`${service}validate`);
  const file = {
    name: 'town.city.jsonl.gz',
    mimeType: 'application/gzip',
    buffer: gzipSync(readFileSync(`${examples}/delft.city.jsonl`))
  };
  await page.setInputFiles('#file', file);
  await page.getByText('is too long to be shown here').waitFor();
  await accessible('a file for a job');
  await page.getByLabel('Collection').fill('job');
  await page.getByRole('button', {name: 'Store', exact: true}).click();
  await page.getByRole('link', {name: 'as this job'}).click();
  await page.getByRole('cell', {name: 'successful', exact: true}).waitFor();
  await eventually(
      () => page.getByRole('row', {name: 'Features stored 159'}).isVisible(),
      'an archive is stored as a job');
  await shot('job');
  await accessible('a job');
  await page.goto(`${service}jobs`);
  await eventually(
      () => page.getByRole('link', {name: 'town.city.jsonl.gz'}).isVisible(), 'jobs are listed');
  await accessible('the list of jobs');
}

async function otherFormats() {
  await page.goto(`${service}validate`);
  await page.setInputFiles('#file', `${examples}/../tests/golden/findings/103.gml`);
  await page.getByText('103.gml is invalid').waitFor();
  await page.getByRole('button', {name: 'Next finding'}).click();
  await eventually(() => isInMiddle(kPlace), 'the finding of a GML document is flown to');
  await eventually(() => isSeen(kFacet, 0.01), 'its facet is red');
}

async function list() {
  await page.goto(`${service}collections`);
  await accessible('the list of collections');
  await page.getByLabel('Only rows with').fill('DELF');
  await eventually(
      async () => await page.locator('table tr:visible').count() === 2,
      'the list of collections is filtered');
}

async function city() {
  await page.goto(`${service}collections/delft`);
  await page.waitForFunction(() => document.querySelector('.said')?.textContent === '');
  await eventually(() => isSeen(kRoof, 0.005), 'roofs are seen');
  await shot('city');
  await accessible('a collection');
  await page.getByLabel('From above').check();
  await eventually(() => isSeen(kRoof, 0.005), 'roofs are seen from above');
  await shot('city-from-above');
  await page.getByLabel('From above').uncheck();
  await page.getByRole('button', {name: 'Next finding'}).click();
  await page.getByText('1 of 7 that are not proven').waitFor();
  await eventually(() => isInMiddle(kChosen, 0.01), 'the next feature with findings is flown to');
  await quiet();
  const chosen = await pixels(kChosen);
  await shot('city-finding');
  await page.getByLabel('Not proven in red').uncheck();
  await quiet();
  const without = (await pixels(kPin)).share;
  await page.getByLabel('Pins of findings').check();
  await eventually(
      () => isAboveMiddle(kPin, without + 0.0003), 'a pin stands over what was flown to');
  await shot('city-pins');
  await page.getByLabel('Pins of findings').uncheck();
  await eventually(
      async () => Math.abs((await pixels(kPin)).share - without) < 1e-4, 'pins are switched off');
  await page.getByLabel('Not proven in red').check();
  await quiet();
  const id = await page.locator('.side h2').textContent();
  const box = await page.locator('.stage canvas').boundingBox();
  await page.mouse.click(box.x + box.width * chosen.x, box.y + box.height * chosen.y);
  await quiet();
  check(await page.locator('.side h2').textContent() === id, 'a click finds what is seen there');
  const before = await picture();
  await page.locator('.stage canvas').focus();
  await page.keyboard.press('ArrowLeft');
  await eventually(async () => await picture() !== before, 'keys turn');
  await quiet();
  const turned = await picture();
  await page.keyboard.press('+');
  await eventually(async () => await picture() !== turned, 'keys zoom');
  await page.locator('.side li a').first().click();
  await page.waitForURL('**/items/**');
  await page.getByText('Finding 1 of ').waitFor();
  await eventually(() => isSeen(kPlace, 0), 'the page of a feature shows its finding');
  await shot('item');
  await accessible('a feature');
  await quiet();
  const whole = await picture();
  await page.getByLabel('Cut at this height').fill('40');
  await eventually(async () => await picture() !== whole, 'a cut takes away what is above');
  await page.goto(`${service}collections/delft/items/NL.IMBAG.Pand.0503100000018420`);
  await page.getByLabel('Inside and bytes').check();
  await page.getByText(/[1-9]\d* tetrahedra/).waitFor();
  await eventually(() => isSeen(kTetrahedron, 0.001), 'tetrahedra are seen');
  await shot('inside');
  await accessible('the inside of a feature');
}

try {
  await judgeAndStore();
  await refuse();
  await longFile();
  await otherFormats();
  await list();
  await city();
} catch (error) {
  check(false, String(error));
  await shot('failure');
}
check(troubles.length === 0, `the browser has nothing to complain of (${troubles.join('; ')})`);
await browser.close();
console.log(JSON.stringify(seen));
