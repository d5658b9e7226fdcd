// Chromium without a GPU, and the paths of the build, for tests and benchmarks of the page.

import { existsSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { chromium } from '../../web/node_modules/playwright-core/index.mjs';

export const source = dirname(dirname(dirname(fileURLToPath(import.meta.url))));
/** The output of `./dev web`. */
export const built = process.env.TUREEN_WEB ?? join(source, 'build/web/out');
/** The folder of the native programs from the same sources. */
export const programs = process.env.TUREEN_PROGRAMS ?? join(source, 'build/release/bin');

const quiet = ['--no-sandbox', '--disable-quic', '--no-first-run', '--disable-background-networking',
               '--disable-component-update', '--disable-sync'];
/** Replacements for a GPU. The native goldens are drawn with llvmpipe. */
const backends = {
  llvmpipe: ['--use-gl=angle', '--use-angle=gl-egl', '--ignore-gpu-blocklist'],
  swiftshader: ['--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'],
  none: ['--disable-gpu', '--disable-software-rasterizer', '--disable-3d-apis'],
};

/** Debian's browsers, and another by CHROMIUM. The shell has the same engine without a window, which halves the
 *  processor time of a visit: for tests. Benchmarks and images of the docs have the browser that people use. */
const shell = '/usr/bin/chromium-headless-shell', whole = '/usr/bin/chromium';
const found = (first, second) => process.env.CHROMIUM ?? (existsSync(first) ? first : second);

export const launch = (backend, flags = [], executablePath = found(whole, shell)) =>
  chromium.launch({ executablePath, args: [...quiet, ...backends[backend], ...flags] });
export const launchForTests = (backend) => launch(backend, [], found(shell, whole));
