// The parts of a layer's transform, and the transform of parts: a similarity as position, rotation, scale
// and mirror.

import { ViewerError, type Matrix, type Placement, type Vec3 } from './types.js';

/** Throws ViewerError if a number is not finite or the scale is not above 0. */
export function matrixOf({ position, rotation, scale, mirror }: Placement): Matrix {
  if (![...position, ...rotation, scale].every(Number.isFinite) || !(scale > 0))
    throw new ViewerError('A placement needs position and rotation, three numbers each, and a scale above 0.', 'usage');
  const [cx, cy, cz] = rotation.map(Math.cos) as [number, number, number];
  const [sx, sy, sz] = rotation.map(Math.sin) as [number, number, number];
  const first = mirror ? -scale : scale;
  return [
    first * cy * cz, first * cy * sz, -first * sy, 0,
    scale * (sx * sy * cz - cx * sz), scale * (sx * sy * sz + cx * cz), scale * sx * cy, 0,
    scale * (cx * sy * cz + sx * sz), scale * (cx * sy * sz - sx * cz), scale * cx * cy, 0,
    ...position, 1,
  ];
}

/** The parts of a similarity. Where the rotation about y is a right angle, only the sum or difference of the
 *  other two is determined; that about x is then 0. */
export function placementOf(matrix: Matrix): Placement {
  const column = (index: number): Vec3 => [matrix[4 * index]!, matrix[4 * index + 1]!, matrix[4 * index + 2]!];
  const [a, b, c] = [column(0), column(1), column(2)];
  const determinant = a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
  const scale = Math.cbrt(Math.abs(determinant)), mirror = determinant < 0;
  const x = mirror ? -scale : scale;
  const sinY = Math.min(Math.max(-a[2] / x, -1), 1);
  // Nearer to the pole, rounding leaves no digits of the two other angles.
  const atPole = Math.abs(sinY) > 1 - 1e-12;
  const rotation: Vec3 = atPole ?
    [0, Math.asin(sinY), Math.atan2(-b[0], b[1])] :
    [Math.atan2(b[2], c[2]), Math.asin(sinY), Math.atan2(a[1] / x, a[0] / x)];
  return { position: column(3), rotation, scale, mirror };
}
