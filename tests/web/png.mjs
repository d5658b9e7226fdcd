// PNG as written by the programs and browsers of these tests: 8 bits, grey, RGB or RGBA, not interlaced. An
// image is {width, height, pixels}: RGBA bytes, rows from the top.

import { deflateSync, inflateSync } from 'node:zlib';

const signature = Buffer.from('89504e470d0a1a0a', 'hex');
/** Bytes per pixel, by PNG colour type. */
const channelsOf = { 0: 1, 2: 3, 4: 2, 6: 4 };

function* chunks(bytes) {
  for (let at = 8; at < bytes.length;) {
    const size = bytes.readUInt32BE(at);
    yield { type: bytes.toString('latin1', at + 4, at + 8), data: bytes.subarray(at + 8, at + 8 + size) };
    at += 12 + size;
  }
}

/** The prediction of PNG's filter 4 from the neighbours to the left, above, and above to the left. */
function paeth(a, b, c) {
  const pa = Math.abs(b - c), pb = Math.abs(a - c), pc = Math.abs(a + b - 2 * c);
  return pa <= pb && pa <= pc ? a : pb <= pc ? b : c;
}

function unfilter(data, stride, height, channels) {
  const rows = Buffer.alloc(stride * height);
  for (let y = 0; y < height; ++y) {
    const filter = data[y * (stride + 1)];
    for (let x = 0; x < stride; ++x) {
      const at = y * stride + x;
      const left = x >= channels ? rows[at - channels] : 0, above = y > 0 ? rows[at - stride] : 0;
      const corner = x >= channels && y > 0 ? rows[at - stride - channels] : 0;
      const predicted = [0, left, above, (left + above) >> 1, paeth(left, above, corner)][filter];
      rows[at] = data[y * (stride + 1) + 1 + x] + predicted;
    }
  }
  return rows;
}

export function readPng(bytes) {
  if (!bytes.subarray(0, 8).equals(signature)) throw new Error('The file is not a PNG.');
  let width, height, channels;
  const packed = [];
  for (const { type, data } of chunks(bytes)) {
    if (type === 'IDAT') packed.push(data);
    if (type !== 'IHDR') continue;
    [width, height, channels] = [data.readUInt32BE(0), data.readUInt32BE(4), channelsOf[data[9]]];
    if (data[8] !== 8 || !channels || data[12] !== 0) throw new Error('This kind of PNG is not supported.');
  }
  const rows = unfilter(inflateSync(Buffer.concat(packed)), width * channels, height, channels);
  const pixels = new Uint8Array(4 * width * height);
  for (let i = 0; i < width * height; ++i) {
    const from = rows.subarray(i * channels, (i + 1) * channels);
    pixels.set(channels >= 3 ? from : [from[0], from[0], from[0]], 4 * i);
    pixels[4 * i + 3] = channels % 2 === 0 ? from[channels - 1] : 255;
  }
  return { width, height, pixels };
}

/** The CRC of a chunk's type and data. Debian 12's node does not have zlib.crc32. */
export function crc32(bytes) {
  let crc = ~0;
  for (const byte of bytes) {
    crc ^= byte;
    for (let bit = 0; bit < 8; ++bit) crc = (crc >>> 1) ^ (crc & 1 ? 0xedb88320 : 0);
  }
  return ~crc >>> 0;
}

function chunk(type, data) {
  const body = Buffer.concat([Buffer.from(type, 'latin1'), data]);
  const whole = Buffer.alloc(body.length + 8);
  whole.writeUInt32BE(data.length, 0);
  body.copy(whole, 4);
  whole.writeUInt32BE(crc32(body), body.length + 4);
  return whole;
}

export function writePng({ width, height, pixels }) {
  const head = Buffer.alloc(13);
  head.writeUInt32BE(width, 0);
  head.writeUInt32BE(height, 4);
  head.set([8, 6, 0, 0, 0], 8);
  const rows = Buffer.alloc((4 * width + 1) * height);  // each begins with filter 0
  for (let y = 0; y < height; ++y) rows.set(pixels.subarray(4 * y * width, 4 * (y + 1) * width), y * (4 * width + 1) + 1);
  return Buffer.concat([signature, chunk('IHDR', head), chunk('IDAT', deflateSync(rows)), chunk('IEND', Buffer.alloc(0))]);
}
