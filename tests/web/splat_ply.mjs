// A file of splats.

/** A splat PLY of `count` Gaussians in a cube, each of 56 bytes. */
export function splatPly(count) {
  const names = ['x', 'y', 'z', 'f_dc_0', 'f_dc_1', 'f_dc_2', 'opacity', 'scale_0', 'scale_1', 'scale_2',
                 'rot_0', 'rot_1', 'rot_2', 'rot_3'];
  const head = ['ply', 'format binary_little_endian 1.0', `element vertex ${count}`,
                ...names.map((name) => `property float ${name}`), 'end_header', ''].join('\n');
  const values = new Float32Array(names.length * count);
  let state = 1;
  const random = () => (state = (Math.imul(state, 1664525) + 1013904223) >>> 0) / 2 ** 31 - 1;
  for (let i = 0; i < count; ++i)
    values.set([random(), random(), random(), 2 * random(), 2 * random(), 2 * random(), 1, -4, -4, -4, 1, 0, 0, 0],
               names.length * i);
  return Buffer.concat([Buffer.from(head), Buffer.from(values.buffer)]);
}
