// A request: the settings of a measurement, in the form and in the page's address.
//
//   bench.html?scenes=soup.glb,models/fox.glb&set=hemisphere:8&size=1280x720,1920x1080&rounds=5&published=1&run=1
//   bench.html?scenes=soup.glb&grid=1&copies=14&run=1

import { queryText } from '../viewer/addresses.js';
import { ViewerError, type SceneSource } from '../viewer/types.js';

export interface Size {
  readonly width: number;
  readonly height: number;
}

/** A camera set that an address can contain. `recorded`: the scene's own cameras. */
export interface CameraSet {
  readonly kind: 'hemisphere' | 'orbit' | 'recorded';
  readonly count: number;
}

const isSet = (kind: string): kind is CameraSet['kind'] => ['hemisphere', 'orbit', 'recorded'].includes(kind);

/** The cameras of a measurement. A camera path gives `count` cameras evenly in time; a list gives its
 *  first ones. */
export type CameraChoice =
  | CameraSet
  | { readonly kind: 'file'; readonly count: number; readonly name: string; readonly text: string };

interface CommonRequest {
  /** Whether all scenes are in one frame instead of one after the other. */
  readonly grid: boolean;
  /** Number of copies of each scene on a grid. */
  readonly copies: number;
  readonly sizes: readonly Size[];
  /** Number of passes over the cameras. */
  readonly rounds: number;
  /** Whether the baseline is measured too, in alternation with ours; never on a grid. */
  readonly published: boolean;
}

export interface BenchRequest extends CommonRequest {
  /** May contain a scene more than once. */
  readonly scenes: readonly SceneSource[];
  readonly cameras: CameraChoice;
}

/** The initial values of the form, from the page's address or its defaults. */
export interface AddressRequest extends CommonRequest {
  readonly scenes: readonly string[];
  readonly set: CameraSet;
  /** Whether the measurement starts at once. */
  readonly run: boolean;
}

/** Upper limits. Larger values would take hours if the processor draws. */
export const most = { views: 1000, rounds: 1000, copies: 100, side: 16384 } as const;

const usage = (sentence: string) => new ViewerError(sentence, 'usage');

/** A whole number from 1 to `limit`. Throws ViewerError. */
export function countOf(text: string, what: string, limit: number): number {
  const value = Number(text);
  if (!/^\d+$/.test(text.trim()) || value < 1 || value > limit)
    throw usage(`“${text}” is not a number of ${what}: enter a number from 1 to ${limit}.`);
  return value;
}

/** The sizes in a text like "1280x720, 1920x1080". Throws ViewerError. */
export function sizesOf(text: string): Size[] {
  return text.split(',').map((part) => part.trim()).filter(Boolean).map((part) => {
    const sides = /^(\d+)\s*[x×]\s*(\d+)$/i.exec(part)?.slice(1).map(Number);
    if (!sides?.every((side) => side >= 1 && side <= most.side))
      throw usage(`“${part}” is not a size: enter a size like 1280x720, with sides from 1 to ${most.side}.`);
    return { width: sides[0]!, height: sides[1]! };
  });
}

export const sizeKey = ({ width, height }: Size) => `${width}x${height}`;
export const sizeText = ({ width, height }: Size) => `${width} × ${height}`;
/** The name in results: "hemisphere:8". */
export const setName = (cameras: CameraChoice) => `${cameras.kind === 'file' ? cameras.name : cameras.kind}:${cameras.count}`;

/** Throws ViewerError. */
export function readAddress(query: string): AddressRequest {
  const given = new URLSearchParams(query);
  const flag = (name: string) => given.has(name) && given.get(name) !== '0';
  const [kind = '', count = '8'] = (given.get('set') ?? 'hemisphere').split(':');
  if (!isSet(kind))
    throw usage(`“${kind}” is not a camera set: use hemisphere:8, orbit:8 or recorded:8, with any number.`);
  return {
    scenes: given.getAll('scenes').flatMap((list) => list.split(',')).filter(Boolean),
    grid: flag('grid'),
    copies: countOf(given.get('copies') ?? '1', 'copies', most.copies),
    set: { kind, count: countOf(count, 'cameras', most.views) },
    sizes: sizesOf(given.get('size') ?? ''),
    rounds: countOf(given.get('rounds') ?? '5', 'rounds', most.rounds),
    published: given.has('published') ? flag('published') : true,
    run: flag('run'),
  };
}

/** The query for this request; null if it uses local files, which an address cannot contain. */
export function writeAddress(request: BenchRequest): string | null {
  const { scenes, grid, copies, cameras, sizes, rounds, published } = request;
  const addresses = scenes.map((scene) => ('url' in scene ? scene.url : null));
  if (cameras.kind === 'file' || addresses.some((address) => address === null)) return null;
  return '?' + [
    `scenes=${addresses.map((address) => queryText(address!)).join(',')}`,
    ...(grid ? ['grid=1', `copies=${copies}`] : [`published=${published ? 1 : 0}`]),
    `set=${cameras.kind}:${cameras.count}`, `size=${sizes.map(sizeKey).join(',')}`, `rounds=${rounds}`,
  ].join('&');
}
