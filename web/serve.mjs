// A small server of static files, for the site on the local computer and for its tests:
//
//   node serve.mjs [FOLDER] [--port 8000] [--host 127.0.0.1]
//
// It serves one folder, disables caching and needs only node. Use an ordinary web server for public
// sites.

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

/** The file for an address; null if it does not exist or is outside the folder. */
function fileOf(folder, address) {
  try {
    const path = decodeURIComponent(new URL(address, 'http://site').pathname);
    let file = realpathSync(join(folder, path));  // follows links, so their targets are checked too
    if (statSync(file).isDirectory()) file = realpathSync(join(file, 'index.html'));
    return file.startsWith(folder + sep) ? file : null;
  } catch {  // the file does not exist, or the address cannot be decoded
    return null;
  }
}

/** Serves a folder until `close` is called. `first`: handles a request first, and returns whether it
 *  answered. `port`: 0 for any free port. */
export async function serve(folder, { port = 0, host = '127.0.0.1', first = () => false } = {}) {
  const root = realpathSync(folder);
  const server = createServer((request, response) => {
    if (first(request, response)) return;
    if (request.method !== 'GET' && request.method !== 'HEAD') return void response.writeHead(405).end();
    const file = fileOf(root, request.url);
    if (!file) return void response.writeHead(404, { 'content-type': 'text/plain' }).end('The file does not exist.\n');
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
  if (!Number.isInteger(port) || port < 0 || port > 65535) throw new Error(`“${values.port}” is not a port: use a number from 0 to 65535.`);
  const folder = positionals[0] ?? join(dirname(fileURLToPath(import.meta.url)), '../build/web/out/site');
  const { address } = await serve(folder, { port, host: values.host });
  console.log(`serving ${folder} at ${address} until Ctrl-C`);
}

const sentences = { EADDRINUSE: 'The port is in use: choose another with --port.', ENOENT: 'The folder does not exist. Build the site with ./dev web.' };
if (process.argv[1] === fileURLToPath(import.meta.url))
  main().catch((error) => {
    console.error(sentences[error.code] ?? error.message);
    process.exitCode = 1;
  });
