// Draws the images of the page in docs/viewer.md and docs/web.md: node tests/web/docs_images.mjs FOLDER. Needs what
// the browser tests need.

import { join } from 'node:path';
import { serve } from '../../web/serve.mjs';
import { built, launch } from './browser.mjs';

const folder = process.argv[2];
if (!folder) throw new Error('use: node tests/web/docs_images.mjs FOLDER');

const phone = { viewport: { width: 390, height: 760 }, deviceScaleFactor: 1.5, isMobile: true, hasTouch: true };
const images = [
  { name: 'page_dark.png', how: { viewport: { width: 960, height: 640 }, colorScheme: 'dark' } },
  { name: 'page_light.png', how: { viewport: { width: 960, height: 640 }, colorScheme: 'light' } },
  { name: 'page.jpg', how: { viewport: { width: 1280, height: 800 }, colorScheme: 'light' } },
  { name: 'page_phone.jpg', how: { ...phone, colorScheme: 'dark' } },
  { name: 'page_layers.jpg', how: { viewport: { width: 1280, height: 960 }, colorScheme: 'light' }, change: changeLayers },
];

/** Places a second layer beside the first, hides and shows it, removes the first and undoes that. */
async function changeLayers(page) {
  await page.evaluate(() => history.replaceState(null, '', '?scene=soup.glb&scene=soup.glb#view=three-quarter'));
  await page.reload();
  await page.waitForFunction(() => document.querySelectorAll('#layers li').length === 2 && document.getElementById('loading').hidden);
  await page.click('#layers .go:has-text("soup 2")');
  for (const [id, value] of Object.entries({ 'layer-position-x': '1.6', 'layer-position-y': '-0.9', 'layer-scale': '0.6' })) {
    await page.fill(`#${id}`, value);
    await page.press(`#${id}`, 'Enter');
  }
  await page.uncheck('[aria-label="Show soup 2"]');
  await page.check('[aria-label="Show soup 2"]');
  await page.click('[aria-label="Remove soup"]');
  await page.keyboard.press('Control+z');
  await page.waitForFunction(() => document.querySelectorAll('#layers li').length === 2 && document.getElementById('loading').hidden);
  await page.locator('#frame').click();
  await page.evaluate(() => { document.querySelector('#notices').replaceChildren(); document.getElementById('panel').scrollTop = 0; });
}

const server = await serve(join(built, 'site'));
const browser = await launch('llvmpipe');
try {
  for (const { name, how, change } of images) {
    const profile = await browser.newContext(how);
    const page = await profile.newPage();
    await page.goto(new URL('?scene=soup.glb', server.address).href);  // its first view
    await page.waitForFunction(() => document.getElementById('loading').hidden && !document.body.classList.contains('empty'));
    await change?.(page);
    await page.waitForTimeout(6000);  // the view has arrived and is smooth
    await page.screenshot({ path: join(folder, name), ...(name.endsWith('jpg') && { quality: 88 }) });
    await profile.close();
  }
} finally {
  await browser.close();
  await server.close();
}
