// The layers in a link: their order, and what differs from the files.
//
//   layers=2;1.3,hidden;1.1,at:2.5:0:0,turn:0:90:0,scale:1.5,mirror
//
// An entry for each layer, in their order: the number of its scene in the link, and its own number in a scene
// of several layers, both from 1. `at`, `turn` (degrees about x, then y, then z), `scale` and `mirror` are the
// new place of a layer that was moved. `shown`: hidden in the file, but visible now. Layers without an entry are removed.

import type { Placement, SceneLayer, SceneSource, Vec3 } from '../viewer/types.js';
import { degreesPerRadian, readVector } from './numbers.js';

export interface LinkedLayer {
  /** The number of the scene in the link, and of the layer in its scene, from 0. */
  readonly scene: number;
  readonly layer: number;
  readonly visible: boolean;
  /** Null: as in the file. */
  readonly placement: Placement | null;
}

/** Nine significant digits: the same place on the screen. */
const numberText = (value: number) =>
  String(Number(value.toPrecision(9))).replace('+', '');  // in a link, '+' is a space
const listText = (values: Vec3, factor = 1) => values.map((value) => numberText(value * factor)).join(':');

/** "2", or "2.3" for a layer of a scene with several, even if the device refused the others. */
const numberOf = (scene: number, layer: number, loaded: readonly SceneLayer[]) =>
  `${scene + 1}${layer > 0 || loaded.length > 1 ? `.${layer + 1}` : ''}`;

function changesOf(now: SceneLayer, loaded: SceneLayer): string {
  const parts: string[] = [];
  if (!now.visible) parts.push('hidden');
  if (now.transform.some((value, index) => value !== loaded.transform[index])) {
    const { position, rotation, scale, mirror } = now.placement;
    parts.push(`at:${listText(position)}`);
    if (rotation.some((angle) => angle !== 0)) parts.push(`turn:${listText(rotation, degreesPerRadian)}`);
    if (scale !== 1) parts.push(`scale:${numberText(scale)}`);
    if (mirror) parts.push('mirror');
  }
  return parts.map((part) => `,${part}`).join('');
}

/** The layers of `scenes`, which are the scenes of the link, in order. `loaded`: the layers of a scene as they
 *  were when it was opened. Null if nothing differs. */
export function writeLayers(scenes: readonly SceneSource[], layers: readonly SceneLayer[],
                            loaded: (scene: SceneSource) => readonly SceneLayer[]): string | null {
  const entries = layers.filter(({ source }) => scenes.includes(source)).map((layer) => {
    const before = loaded(layer.source), own = before.find(({ sourceLayer }) => sourceLayer === layer.sourceLayer)!;
    const number = numberOf(scenes.indexOf(layer.source), layer.sourceLayer, before);
    return { number, text: number + changesOf(layer, own) + (own.visible || !layer.visible ? '' : ',shown') };
  });
  const untouched = scenes.flatMap((scene, index) => loaded(scene).map(({ sourceLayer }, _, all) =>
    numberOf(index, sourceLayer, all)));
  const text = entries.map((entry) => entry.text).join(';');
  return text === untouched.join(';') ? null : text;
}

function readLayer(entry: string): LinkedLayer | null {
  const [number = '', ...changes] = entry.split(',');
  const numbers = /^([1-9]\d{0,4})(?:\.([1-9]\d{0,4}))?$/.exec(number);
  if (!numbers) return null;
  let visible = true, moved = false, mirror = false, scale = 1;
  let position: Vec3 = [0, 0, 0], rotation: Vec3 = [0, 0, 0];
  for (const change of changes) {
    const [name, values = ''] = change.split(/:(.*)/s);
    moved ||= name !== 'hidden' && name !== 'shown';
    switch (name) {
      case 'hidden': visible = false; break;
      case 'shown': break;
      case 'mirror': mirror = true; break;
      case 'scale':
        scale = Number(values);
        if (!(scale > 0 && Number.isFinite(scale))) return null;
        break;
      case 'at':
      case 'turn': {
        const vector = readVector(values, ':');
        if (!vector) return null;
        if (name === 'at') position = vector;
        else rotation = [vector[0] / degreesPerRadian, vector[1] / degreesPerRadian, vector[2] / degreesPerRadian];
        break;
      }
      default: return null;
    }
  }
  return {
    scene: Number(numbers[1]) - 1, layer: Number(numbers[2] ?? 1) - 1, visible,
    placement: moved ? { position, rotation, scale, mirror } : null,
  };
}

/** Null without a text. */
export function readLayers(text: string | null): readonly LinkedLayer[] | null | 'defect' {
  if (!text) return null;
  const layers = text.split(';').map(readLayer);
  return layers.every((layer) => layer !== null) ? layers : 'defect';
}
