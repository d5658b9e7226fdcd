// The part of a link after '#': a camera, a debug view and layers (layer_link.ts), in readable numbers.
//
//   #eye=4.269,-5.968,3.39&target=0,0,0.7&up=0,0,1&fov=35&look=depth
//   #view=three-quarter
//
// Lengths are in the scene's units, as in `tureen render --eye --target --up --fov`. `fov` (the vertical
// angle) and `roll` are in degrees; only recorded cameras have a roll.

import { namedViews, type NamedView, type Vec3, type ViewPose } from '../viewer/types.js';
import { readLayers, type LinkedLayer } from './layer_link.js';
import { degreesPerRadian, plainNumber, readVector } from './numbers.js';

/** `up`: null for the scene's own up axis. */
export type LinkedPose = Omit<ViewPose, 'up'> & { readonly up: Vec3 | null };

export interface LinkedView {
  readonly pose: LinkedPose | null;
  /** A view of the whole scene, instead of a pose. */
  readonly named: NamedView | null;
  /** The debug view; null for the final colours. */
  readonly debugView: string | null;
  /** The layers in their order; null if they are as in the files. */
  readonly layers: readonly LinkedLayer[] | null;
  /** The error in the link's camera or layers, as a sentence; null without one. */
  readonly defect: string | null;
}

/** Number of decimals for a precision of 1e-5 of the distance from eye to target. */
function decimalsFor(pose: ViewPose): number {
  const distance = Math.hypot(...pose.eye.map((value, axis) => value - pose.target[axis]!));
  return distance > 0 ? Math.ceil(5 - Math.log10(distance)) : 6;
}

export function writeFragment(pose: ViewPose | null, debugView: string | null, layers: string | null): string {
  const parts: string[] = [];
  if (pose) {
    const decimals = decimalsFor(pose);
    const list = (vector: Vec3, digits: number) => vector.map((value) => plainNumber(value, digits)).join(',');
    parts.push(`eye=${list(pose.eye, decimals)}`, `target=${list(pose.target, decimals)}`, `up=${list(pose.up, 6)}`,
               `fov=${plainNumber(pose.fov * degreesPerRadian, 4)}`);
    const roll = plainNumber(pose.roll * degreesPerRadian, 3);
    if (roll !== '0') parts.push(`roll=${roll}`);
  }
  if (debugView && debugView !== 'color') parts.push(`look=${encodeURIComponent(debugView)}`);
  if (layers) parts.push(`layers=${layers}`);
  return parts.length ? '#' + parts.join('&') : '';
}

export function readFragment(fragment: string): LinkedView {
  const parts = new URLSearchParams(fragment.replace(/^#/, ''));
  const debugView = parts.get('look') || null, layers = readLayers(parts.get('layers'));
  const layersDefect = layers === 'defect' ?
    'The link\'s layers cannot be read: each needs a number and its place, layers=1;2,at:3:0:0.' : null;
  const named = namedViews.find((view) => view === parts.get('view')) ?? null;
  const viewDefect = parts.has('view') && !named ? `The link's view is none of ${namedViews.join(', ')}.` : null;
  const rest = { named, debugView, layers: layers === 'defect' ? null : layers };
  if (!parts.has('eye') && !parts.has('target')) return { pose: null, ...rest, defect: viewDefect ?? layersDefect };

  const without = (defect: string): LinkedView => ({ pose: null, ...rest, defect });
  const vector = (name: string) => readVector(parts.get(name) ?? '', ',');
  const eye = vector('eye'), target = vector('target');
  if (!eye || !target)
    return without('The link\'s camera needs eye and target, three numbers each: #eye=4,-6,3&target=0,0,0.');
  if (eye.every((value, axis) => value === target[axis]))
    return without('The link\'s camera has the same eye and target: they must differ.');
  const up = vector('up');
  if (parts.has('up') && (!up || up.every((value) => value === 0))) return without('The link\'s up is not a direction: it needs three numbers, up=0,0,1.');
  const fov = Number(parts.get('fov') ?? 40), roll = Number(parts.get('roll') ?? 0);
  if (!(fov > 0 && fov < 180)) return without('The link\'s fov is not an angle between 0 and 180 degrees.');
  if (!Number.isFinite(roll)) return without('The link\'s roll is not a number of degrees.');
  return { pose: { eye, target, up, fov: fov / degreesPerRadian, roll: roll / degreesPerRadian }, ...rest, defect: layersDefect };
}
