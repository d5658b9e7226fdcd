// Downloads an address into one growing buffer, and reports the bytes as they arrive.

import { ViewerError } from './types.js';

/** Initial buffer size if the server does not report a length; the buffer grows as needed. */
const firstGuess = 1 << 20;

export interface Arrival {
  /** All bytes so far; a view that stays valid. Later bytes may be in another buffer. */
  readonly bytes: Uint8Array<ArrayBuffer>;
  /** Total number of bytes; null if unknown. */
  readonly total: number | null;
}

/** The announced number of bytes; null for compressed transfers, whose length is the compressed one. */
function announced(response: Response): number | null {
  const length = Number(response.headers.get('content-length'));
  return length > 0 && !response.headers.get('content-encoding') ? length : null;
}

async function request(url: string): Promise<Response> {
  let response;
  try {
    response = await fetch(url);
  } catch {
    throw new ViewerError(`${url} cannot be reached: there is no network, or the server does not allow pages ` +
                          'from other sites to read it (CORS).', 'network');
  }
  if (!response.ok) {
    const answer = [response.status, response.statusText].filter(Boolean).join(' ');  // HTTP/2 has no text
    throw new ViewerError(`${url} cannot be loaded: the server answered ${answer}.`, 'network');
  }
  return response;
}

function room(url: string, bytes: number): Uint8Array<ArrayBuffer> {
  try {
    return new Uint8Array(bytes);
  } catch {
    throw new ViewerError(`The page has not enough memory for the ${bytes.toLocaleString('en')} bytes of ${url}.`, 'memory');
  }
}

/** Calls `arrived` after each piece, and waits for it before the next. Rejects with ViewerError. */
export async function download(url: string, arrived: (arrival: Arrival) => void | Promise<void>): Promise<Uint8Array<ArrayBuffer>> {
  const response = await request(url);
  let total = announced(response), size = 0;
  let memory = room(url, total ?? firstGuess);
  const reader = response.body!.getReader();
  for (;;) {
    const { done, value } = await reader.read().catch(() => {
      throw new ViewerError(`The download of ${url} stopped after ${size.toLocaleString('en')} bytes: try again.`, 'network');
    });
    if (done) break;
    if (size + value.length > memory.length) {
      total = null;  // from other sites, the page may not see that the transfer is compressed
      const larger = room(url, Math.max(2 * memory.length, size + value.length));
      larger.set(memory.subarray(0, size));
      memory = larger;
    }
    memory.set(value, size);
    size += value.length;
    try {
      await arrived({ bytes: memory.subarray(0, size), total });
    } catch (error) {
      void reader.cancel().catch(() => {});  // stops the transfer
      throw error;
    }
  }
  return memory.subarray(0, size);
}
