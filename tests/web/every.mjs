// All browser tests, file after file in one process, which starts one browser per backend:
//
//   node tests/web/every.mjs [NAME..]       such as moving; by default all files but types, which needs no browser

import { readdirSync } from 'node:fs';
import { after, test } from 'node:test';
import { endBrowsers, runFile } from './support.mjs';

const all = readdirSync(new URL('.', import.meta.url)).map((file) => /^(.*)\.test\.mjs$/.exec(file)?.[1])
  .filter((name) => name && name !== 'types');
const names = process.argv.length > 2 ? process.argv.slice(2) : all;

after(endBrowsers);
for (const name of names) test(name, (context) => runFile(context, () => import(`./${name}.test.mjs`)));
