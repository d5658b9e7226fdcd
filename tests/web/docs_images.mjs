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
];

const server = await serve(join(built, 'site'));
const browser = await launch('llvmpipe');
try {
  for (const { name, how } of images) {
    const profile = await browser.newContext(how);
    const page = await profile.newPage();
    await page.goto(new URL('?scene=soup.glb#view=three-quarter', server.address).href);
    await page.waitForFunction(() => document.getElementById('loading').hidden && !document.body.classList.contains('empty'));
    if (!how.isMobile) await page.keyboard.press('7');  // as in the window's images
    await page.waitForTimeout(6000);  // the view has arrived and is smooth
    await page.screenshot({ path: join(folder, name), ...(name.endsWith('jpg') && { quality: 88 }) });
    await profile.close();
  }
} finally {
  await browser.close();
  await server.close();
}
