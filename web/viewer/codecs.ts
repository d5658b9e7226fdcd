// zlib's and zstd's decompression for the engine's program that reads all formats (web/engine/codecs.cpp): the engine calls
// them in the middle of a read, so they answer at once, and they work in the engine's memory.

import { decompress } from 'fzstd';
import { ZStream, Z_NO_FLUSH, Z_STREAM_ERROR, zlibInflate, zlibInflateEnd, zlibInflateInit2 } from 'pako';
import type { Codecs } from 'tureen-engine';

const streams = new Map<number, ZStream>();
let last = 0;

const littleNumber = (bytes: Uint8Array, at: number, size: number) =>
  bytes.subarray(at, at + size).reduceRight((sum, byte) => sum * 256 + byte, 0);

/** The size in the header of a frame (RFC 8878, 3.1.1.1); null if it has none. */
function contentSize(frame: Uint8Array): number | null {
  const descriptor = frame[4] ?? 0, isSingle = (descriptor & 32) !== 0, width = [isSingle ? 1 : 0, 2, 4, 8][descriptor >> 6]!;
  const at = 5 + (isSingle ? 0 : 1) + [0, 1, 2, 4][descriptor & 3]!;
  return width === 0 ? null : littleNumber(frame, at, width) + (width === 2 ? 256 : 0);
}

export const codecs: Codecs = {
  begin(windowBits) {
    const stream = new ZStream();
    zlibInflateInit2(stream, windowBits);
    streams.set(++last, stream);
    return last;
  },
  inflate(number, heap, input, inputSize, output, outputSize) {
    const stream = streams.get(number)!;
    Object.assign(stream, { input: heap, next_in: input, avail_in: inputSize, output: heap, next_out: output, avail_out: outputSize });
    let status: number = Z_STREAM_ERROR;
    try {
      status = zlibInflate(stream, Z_NO_FLUSH);
    } catch { /* damaged */ }
    return [status, stream.avail_in, stream.avail_out];
  },
  end(number) {
    zlibInflateEnd(streams.get(number)!);
    streams.delete(number);
  },
  unzstd(input, output) {
    try {
      if ((contentSize(input) ?? output.length) !== output.length) return -1;
      decompress(input, output);
      return output.length;
    } catch {
      return -1;
    }
  },
};
