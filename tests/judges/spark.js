// Spark: decoders in Rust. ExtSplats is the most exact form in which it holds splats.
import { ExtSplats, utils } from 'spark';

/** Arrays with the words of the harmonics, four words a splat; a word has three channels. */
const words = (extra) => ['sh1', 'sh2', 'sh3a', 'sh3b'].map((name) => extra[name]).filter((array) => array);

export async function read(bytes, fileName) {
  const splats = new ExtSplats({ fileBytes: new Uint8Array(bytes), fileName });
  await splats.initialized;
  const degree = splats.getNumSh(), coefficients = (degree + 1) ** 2 - 1, arrays = words(splats.extra);
  const values = new Float32Array(splats.getNumSplats() * (14 + 3 * coefficients));
  let at = 0;
  for (let i = 0; i < splats.getNumSplats(); ++i) {
    const { center, scales, quaternion, opacity, color } = splats.getSplat(i);
    for (const value of [...center, ...scales, quaternion.w, quaternion.x, quaternion.y, quaternion.z, opacity,
                         color.r, color.g, color.b])
      values[at++] = value;
    for (let k = 0; k < coefficients; ++k) {
      const { r, g, b } = utils.decodeExtRgb(arrays[k >> 2][4 * i + (k & 3)]);
      values.set([r, g, b], at);
      at += 3;
    }
  }
  return { degree, values };
}
