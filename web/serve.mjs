// A small server of static files, for looking at the site and for its tests:
//
//   node serve.mjs [FOLDER] [--port 8000] [--host 127.0.0.1]
//
// It serves one folder, keeps nothing in caches and needs nothing but node. It is for the own
// computer: any other server of files does as well, and better where others come.

import { createReadStream, realpathSync, statSync } from 'node:fs';
import { createServer } from 'node:http';
import { dirname, extname, join, sep } from 'node:path';
import { fileURLToPath } from 'node:url';
import { parseArgs } from 'node:util';

const types = {
  '.html': 'text/html; charset=utf-8', '.css': 'text/css; charset=utf-8',
  '.js': 'text/javascript; charset=utf-8', '.mjs': 'text/javascript; charset=utf-8',
  '.json': 'application/json', '.wasm': 'application/wasm',
  '.png': 'image/png', '.jpg': 'image/jpeg', '.svg': 'image/svg+xml', '.webp': 'image/webp',
  '.glb': 'model/gltf-binary', '.gltf': 'model/gltf+json',
};

/** The file that an address asks for; null where there is none, or none below the folder. */
function fileOf(folder, address) {
  try {
    const path = decodeURIComponent(new URL(address, 'http://site').pathname);
    let file = realpathSync(join(folder, path));  // follows links, and so sees where they lead
    if (statSync(file).isDirectory()) file = realpathSync(join(file, 'index.html'));
    return file.startsWith(folder + sep) ? file : null;
  } catch {  // no such file, or an address that cannot be decoded
    return null;
  }
}

/** Serves a folder until `close` is called. `first` may answer instead: it returns whether it has.
 *  Port 0 is any that is free. */
export async function serve(folder, { port = 0, host = '127.0.0.1', first = () => false } = {}) {
  const root = realpathSync(folder);
  const server = createServer((request, response) => {
    if (first(request, response)) return;
    if (request.method !== 'GET' && request.method !== 'HEAD') return void response.writeHead(405).end();
    const file = fileOf(root, request.url);
    if (!file) return void response.writeHead(404, { 'content-type': 'text/plain' }).end('There is no such file.\n');
    response.writeHead(200, {
      'content-type': types[extname(file).toLowerCase()] ?? 'application/octet-stream',
      'content-length': statSync(file).size, 'cache-control': 'no-store', 'x-content-type-options': 'nosniff',
    });
    if (request.method === 'HEAD') return void response.end();
    createReadStream(file).on('error', () => response.destroy()).pipe(response);
  });
  await new Promise((resolve, reject) => server.once('error', reject).listen(port, host, resolve));
  const name = host.includes(':') ? `[${host}]` : host === '127.0.0.1' ? 'localhost' : host;
  return {
    address: `http://${name}:${server.address().port}/`,
    async close() {
      server.closeAllConnections();
      await new Promise((resolve) => server.close(resolve));
    },
  };
}

async function main() {
  const { values, positionals } = parseArgs({
    allowPositionals: true,
    options: { port: { type: 'string', default: '8000' }, host: { type: 'string', default: '127.0.0.1' } },
  });
  const port = Number(values.port);
  if (!Number.isInteger(port) || port < 0 || port > 65535) throw new Error(`“${values.port}” is no port.`);
  const folder = positionals[0] ?? join(dirname(fileURLToPath(import.meta.url)), '../build/web/out/site');
  const { address } = await serve(folder, { port, host: values.host });
  console.log(`${folder} is served at ${address} until Ctrl-C`);
}

const sentences = { EADDRINUSE: 'The port is taken: name another one.', ENOENT: 'There is no such folder; ./dev web makes the site.' };
if (process.argv[1] === fileURLToPath(import.meta.url))
  main().catch((error) => {
    console.error(sentences[error.code] ?? error.message);
    process.exitCode = 1;
  });
