// The calls of an embedding page, and checks of their arguments. Names, order and meaning are the same
// as in Viewer (viewer/types.ts); a property becomes setX.

import { urlOf } from '../viewer/addresses.js';
import {
  namedViews, ViewerError, type Matrix, type NamedView, type Placement, type Resolution, type SceneFile, type SceneLayer,
  type SceneSource, type Tour, type Vec3, type Viewer, type ViewerEvents, type ViewPose,
} from '../viewer/types.js';
import type { Loading } from './loading.js';
import { isVector } from '../common/numbers.js';
import { isPose } from './saved_views.js';

const eventNames: readonly (keyof ViewerEvents)[] =
  ['progress', 'preview', 'scene', 'layers', 'steps', 'notice', 'frame', 'view', 'tour', 'context'];

function refuse(what: string): never { throw new ViewerError(what, 'usage'); }

const object = (value: unknown): Record<string, unknown> =>
  typeof value === 'object' && value !== null ? (value as Record<string, unknown>) : {};

function number(value: unknown, name: string): number {
  return typeof value === 'number' && Number.isFinite(value) ? value : refuse(`${name} is not a number.`);
}

function whole(value: unknown, name: string): number {
  return Number.isInteger(value) && (value as number) >= 0 ? (value as number) :
    refuse(`${name} is not a whole number of at least 0.`);
}

function text(value: unknown, name: string): string {
  return typeof value === 'string' ? value : refuse(`${name} is not a text.`);
}

function truth(value: unknown, name: string): boolean {
  return typeof value === 'boolean' ? value : refuse(`${name} is not true or false.`);
}

const vector = (value: unknown, name: string): Vec3 =>
  isVector(value) ? value : refuse(`${name} is not three numbers.`);

function oneOf<T extends string>(value: unknown, choices: readonly T[], name: string): T {
  return choices.includes(value as T) ? (value as T) : refuse(`${name} must be one of ${choices.join(', ')}.`);
}

function pose(value: unknown): ViewPose {
  return isPose(value) ? value : refuse('A view needs eye, target and up, three numbers each, and fov and roll in radians.');
}

function file(value: unknown): SceneFile {
  const { path, data } = object(value);
  if (data instanceof ArrayBuffer) return { path: text(path, 'path'), data: new Blob([data]) };
  if (data instanceof Blob) return { path: text(path, 'path'), data };
  return refuse('A file\'s data must be a Blob or an ArrayBuffer.');
}

function source(value: unknown): SceneSource {
  const { url, files, name } = object(value);
  const named = name === undefined ? {} : { name: text(name, 'name') };
  if (Array.isArray(files)) return { files: files.map(file), ...named };
  if (typeof url !== 'string') refuse('A scene must be {url} or {files: [{path, data}]}.');
  return { url: urlOf({ url }), ...named };
}

function resolution(value: unknown): Resolution {
  if (typeof value === 'number') return number(value, 'resolution');
  return { targetFps: number(object(value).targetFps, 'targetFps') };
}

/** Layers for the outer page. Their sources may be large files. */
export const withoutSources = (layers: readonly SceneLayer[]) => layers.map(({ source, sourceLayer, ...layer }) => layer);

function transform(value: unknown): Matrix | Placement {
  if (Array.isArray(value) && value.length === 16 && value.every(Number.isFinite)) return value as Matrix;
  const { position, rotation, scale, mirror } = object(value);
  if (!isVector(position) || !isVector(rotation))
    return refuse('A transform must be 16 numbers, or {position, rotation, scale, mirror}.');
  return { position, rotation, scale: number(scale ?? 1, 'scale'), mirror: mirror === true };
}

function layerChange(value: unknown): { visible?: boolean; transform?: Matrix | Placement } {
  const given = object(value);
  return {
    ...(given.visible !== undefined && { visible: truth(given.visible, 'visible') }),
    ...(given.transform !== undefined && { transform: transform(given.transform) }),
  };
}

type Answer = (given: readonly unknown[]) => unknown;

export function embedCalls(viewer: Viewer, loading: Loading, subscribe: (event: keyof ViewerEvents) => void,
                           unsubscribe: (event: keyof ViewerEvents) => void): ReadonlyMap<string, Answer> {
  return new Map<string, Answer>([
    ['load', ([what]) => loading.attempt(source(what))],
    ['cancel', () => loading.cancel()],
    ['clear', () => loading.clear()],
    ['addLayers', async ([what]) => withoutSources(await loading.attemptToAdd(source(what)))],
    ['layers', () => withoutSources(viewer.layers)],
    ['setLayer', ([index, change]) => viewer.setLayer(whole(index, 'The layer'), layerChange(change))],
    ['removeLayer', ([index]) => viewer.removeLayer(whole(index, 'The layer'))],
    ['moveLayer', ([from, to]) => viewer.moveLayer(whole(from, 'from'), whole(to, 'to'))],
    ['steps', () => viewer.steps],
    ['setHolding', ([held]) => { viewer.holding = truth(held, 'The switch'); }],
    ['undo', () => viewer.undo()],
    ['redo', () => viewer.redo()],
    ['goToStep', ([position]) => viewer.goToStep(whole(position, 'The position'))],
    ['forgetSteps', () => viewer.forgetSteps()],
    ['scene', () => viewer.scene],
    ['stats', () => viewer.stats],
    ['legend', () => viewer.legend],
    ['getView', () => viewer.getView()],
    ['setView', ([view, options]) => viewer.setView(pose(view), { glide: object(options).glide === true })],
    ['showNamedView', ([view]) => viewer.showNamedView(oneOf<NamedView>(view, namedViews, 'The view'))],
    ['showCamera', ([index]) => {
      const count = viewer.scene?.cameras.length ?? 0;
      if (whole(index, 'The camera') >= count) refuse(`The scene has ${count} cameras, counted from 0.`);
      viewer.showCamera(index as number);
    }],
    ['play', ([tour, seconds]) => viewer.play(oneOf<Tour>(tour, ['turntable', 'cameras'], 'The tour'),
                                              seconds === undefined ? undefined : number(seconds, 'seconds'))],
    ['stop', () => viewer.stop()],
    ['frame', () => viewer.frame()],
    ['home', () => viewer.home()],
    ['orbit', ([dx, dy]) => viewer.orbit(number(dx, 'dx'), number(dy, 'dy'))],
    ['pan', ([dx, dy]) => viewer.pan(number(dx, 'dx'), number(dy, 'dy'))],
    ['dolly', ([steps]) => viewer.dolly(number(steps, 'steps'))],
    ['setUp', ([axis]) => viewer.setUp(vector(axis, 'The axis'))],
    ['setMode', ([mode]) => { viewer.mode = oneOf(mode, ['orbit', 'fly'], 'The mode'); }],
    ['setFov', ([fov]) => { viewer.fov = number(fov, 'fov'); }],
    ['setBackground', ([color]) => { viewer.background = vector(color, 'The colour'); }],
    ['setResolution', ([value]) => { viewer.resolution = resolution(value); }],
    ['setSmoothAtRest', ([smooth]) => { viewer.smoothAtRest = truth(smooth, 'The switch'); }],
    ['show', ([name, features]) => {
      if (features === undefined) return viewer.show(text(name, 'name'));
      const { first, count } = object(features);
      return viewer.show(text(name, 'name'), { first: whole(first, 'first'), count: whole(count, 'count') });
    }],
    ['screenshot', ([size]) => {
      if (size === undefined) return viewer.screenshot();
      const { width, height } = object(size);
      return viewer.screenshot({ width: whole(width, 'width'), height: whole(height, 'height') });
    }],
    ['subscribe', ([event]) => subscribe(oneOf(event, eventNames, 'The event'))],
    ['unsubscribe', ([event]) => unsubscribe(oneOf(event, eventNames, 'The event'))],
  ]);
}
