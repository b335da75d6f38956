// SPDX-License-Identifier: GPL-3.0-or-later
// Opens a page in Chromium until it has a result, saves a picture and prints the result as JSON:
//   node view.js ADDRESS PICTURE.png       (playwright-core is found from the current folder)
import {existsSync} from 'node:fs';
import {createRequire} from 'node:module';

const {chromium} = createRequire(`${process.cwd()}/`)('playwright-core');
const [address, picture] = process.argv.slice(2);
const executablePath = ['/usr/bin/chromium', '/usr/bin/google-chrome'].find(existsSync);
const browser = await chromium.launch({
  executablePath,
  args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader']
});
try {
  const page = await browser.newPage({viewport: {width: 960, height: 640}});
  const messages = [];
  page.on('console', (message) => {
    if (['error', 'warning'].includes(message.type())) messages.push(message.text());
  });
  page.on('pageerror', (error) => messages.push(String(error)));
  await page.goto(address);
  let result = {failures: ['no result in time']};
  try {
    await page.waitForFunction(() => window.result !== undefined, null, {timeout: 90_000});
    result = await page.evaluate(() => window.result);
  } catch {
    // The messages say why.
  }
  await page.screenshot({path: picture});
  console.log(JSON.stringify({...result, messages}));
} finally {
  await browser.close();
}
