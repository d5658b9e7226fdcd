// A request: the settings of a measurement. The page's address has them; the form writes such addresses.
//
//   bench.html?scenes=soup.glb,models/fox.glb&set=hemisphere:8&size=1280x720,1920x1080&rounds=5&published=1&run=1
//   bench.html?scenes=soup.glb&grid=1&copies=14&run=1

import { ViewerError } from '../viewer/types.js';

export interface Size {
  readonly width: number;
  readonly height: number;
}

/** `recorded`: the scene's own cameras. */
export interface CameraSet {
  readonly kind: 'hemisphere' | 'orbit' | 'recorded';
  readonly count: number;
}

const isSet = (kind: string): kind is CameraSet['kind'] => ['hemisphere', 'orbit', 'recorded'].includes(kind);

/** The address of a scene. */
export interface Address {
  readonly url: string;
}

export interface BenchRequest {
  /** May contain a scene more than once. */
  readonly scenes: readonly Address[];
  readonly cameras: CameraSet;
  /** Whether all scenes are in one frame instead of one after the other. */
  readonly grid: boolean;
  /** Number of copies of each scene on a grid. */
  readonly copies: number;
  readonly sizes: readonly Size[];
  /** Number of passes over the cameras. */
  readonly rounds: number;
  /** Whether the baseline is measured too, in alternation with ours; never on a grid. */
  readonly published: boolean;
  /** Whether the measurement starts at once. */
  readonly run: boolean;
}

/** Upper limits. Larger values would take hours if the processor draws. */
const most = { views: 1000, rounds: 1000, copies: 100, side: 16384 } as const;

const usage = (sentence: string) => new ViewerError(sentence, 'usage');

/** A whole number from 1 to `limit`. Throws ViewerError. */
function countOf(text: string, what: string, limit: number): number {
  const value = Number(text);
  if (!/^\d+$/.test(text.trim()) || value < 1 || value > limit)
    throw usage(`“${text}” is not a number of ${what}: enter a number from 1 to ${limit}.`);
  return value;
}

/** The sizes in a text like "1280x720, 1920x1080". Throws ViewerError. */
function sizesOf(text: string): Size[] {
  return text.split(',').map((part) => part.trim()).filter(Boolean).map((part) => {
    const sides = /^(\d+)\s*[x×]\s*(\d+)$/i.exec(part)?.slice(1).map(Number);
    if (!sides?.every((side) => side >= 1 && side <= most.side))
      throw usage(`“${part}” is not a size: enter a size like 1280x720, with sides from 1 to ${most.side}.`);
    return { width: sides[0]!, height: sides[1]! };
  });
}

export const sizeText = ({ width, height }: Size) => `${width} × ${height}`;
/** The name in addresses and results: "hemisphere:8". */
export const setName = ({ kind, count }: CameraSet) => `${kind}:${count}`;

/** The request of an address, with the defaults of what it lacks. Throws ViewerError. */
export function readAddress(query: string): BenchRequest {
  const given = new URLSearchParams(query);
  // The form sends 0, and 1 after it if its box is checked.
  const flag = (name: string, usual: boolean) => (given.getAll(name).at(-1) ?? (usual ? '1' : '0')) !== '0';
  const [kind = '', count = '8'] = (given.get('set') ?? 'hemisphere').split(':');
  if (!isSet(kind))
    throw usage(`“${kind}” is not a camera set: use hemisphere:8, orbit:8 or recorded:8, with any number.`);
  const sizes = sizesOf(given.get('size') ?? ''), grid = flag('grid', false);
  return {
    scenes: given.getAll('scenes').flatMap((list) => list.split(',')).map((part) => ({ url: part.trim() })).filter(({ url }) => url),
    cameras: { kind, count: countOf(count, 'cameras', most.views) },
    grid,
    copies: countOf(given.get('copies') ?? '1', 'copies', most.copies),
    sizes: sizes.length ? sizes : [{ width: 1280, height: 720 }],
    rounds: countOf(given.get('rounds') ?? '5', 'rounds', most.rounds),
    published: !grid && flag('published', true),
    run: flag('run', false),
  };
}
