// zlib's and zstd's decompression for the engine's program that reads all formats (web/engine/codecs.cpp): the engine calls
// them in the middle of a read, so they answer at once, and they work in the engine's memory.

import { decompress } from 'fzstd';
import { ZStream, Z_NO_FLUSH, Z_STREAM_ERROR, zlibInflate, zlibInflateEnd, zlibInflateInit2 } from 'pako';
import type { Codecs } from 'tureen-engine';

const streams = new Map<number, ZStream>();
let last = 0;

const littleNumber = (bytes: Uint8Array, at: number, size: number) =>
  bytes.subarray(at, at + size).reduceRight((sum, byte) => sum * 256 + byte, 0);

/** The header of a frame (RFC 8878, 3.1.1.1): its size, and that of the content; null if the header has none. */
function frameHeader(frame: Uint8Array): { readonly size: number; readonly content: number | null } {
  const descriptor = frame[4] ?? 0, isSingle = (descriptor & 32) !== 0, width = [isSingle ? 1 : 0, 2, 4, 8][descriptor >> 6]!;
  const at = 5 + (isSingle ? 0 : 1) + [0, 1, 2, 4][descriptor & 3]!;
  return { size: at + width, content: width === 0 ? null : littleNumber(frame, at, width) + (width === 2 ? 256 : 0) };
}

/** The frame, with an empty block added as its last one and without its checksum; `at` is the size of the header. Null if
 *  the input is not a single whole frame. */
function withEmptyBlock(frame: Uint8Array, at: number): Uint8Array | null {
  let last = at;
  for (let isLast = false; !isLast;) {
    if (at + 3 > frame.length) return null;
    const head = littleNumber(frame, at, 3), isOneByte = (head >> 1 & 3) === 1;
    isLast = (head & 1) === 1;
    last = at;
    at += 3 + (isOneByte ? 1 : head >> 3);
  }
  const checksum = frame[4]! & 4;  // the flag's bit is the size
  if (at + checksum !== frame.length) return null;
  const longer = new Uint8Array(at + 3);
  longer.set(frame.subarray(0, at));
  longer[4]! -= checksum;
  longer[last]! -= 1;
  longer[at] = 1;
  return longer;
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
      const { size, content } = frameHeader(input), frame = withEmptyBlock(input, size);
      if (!frame || (content ?? output.length) !== output.length) return -1;
      // fzstd does not report how much it writes. It stores the empty block where the content ends.
      const target = output.subarray();
      let end = -1;
      target.set = (source, at = 0) => {
        end = at;
        output.set(source, at);
      };
      decompress(frame, target);
      return end === output.length ? end : -1;
    } catch {
      return -1;
    }
  },
};
