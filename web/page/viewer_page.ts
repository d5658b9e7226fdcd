// The page: makes a viewer of the canvas and puts everything around it.

import { urlOf } from '../viewer/addresses.js';
import type { Assets } from '../viewer/assets.js';
import { namedViews, ViewerError, type SceneSource, type Viewer } from '../viewer/types.js';
import { createViewer } from '../viewer/viewer.js';
import { AddressBar } from './address_bar.js';
import { block, byId, make } from './dom.js';
import { answerEmbedder } from './embed.js';
import { FullScreen } from './full_screen.js';
import { Loading } from './loading.js';
import { Messages } from './messages.js';
import { Openings } from './openings.js';
import { Panel } from './panel.js';
import { CamerasSection } from './sections/cameras.js';
import { DrawingSection } from './sections/drawing.js';
import { LinkSection } from './sections/link.js';
import { LookSection } from './sections/look.js';
import { ImageSection } from './sections/image.js';
import { SavedSection } from './sections/saved.js';
import { SceneSection } from './sections/scene.js';
import { TimesSection } from './sections/times.js';
import { ViewsSection } from './sections/views.js';
import { Shortcuts } from './shortcuts.js';
import { Start } from './start.js';

export interface ViewerPageOptions {
  /** Beside the script where they are not given. */
  readonly assets?: Assets;
  /** A scene that is part of the page. */
  readonly scene?: SceneSource | null;
}

/** What the page will open, where that can be fetched; what is wrong with it is said when it is opened. */
function fetchable(address: string): SceneSource | null {
  try {
    return { url: urlOf({ url: address }) };
  } catch {
    return null;
  }
}

/** Says in place of the image why there is none. */
function explain(error: unknown): void {
  const missing = error instanceof ViewerError && error.kind === 'no-webgl2';
  const why = error instanceof Error ? error.message : String(error);
  block('stage').replaceChildren(make('div', { class: 'no-image-at-all', role: 'alert' },
    make('h2', {}, missing ? 'This browser has no WebGL2' : 'The viewer did not start'),
    make('p', {}, why),
    make('p', {}, missing ?
      'Tureen draws with WebGL2. A current Firefox, Chrome, Edge or Safari has it; where it is one of them already, ' +
      'look whether graphics acceleration is switched off in its settings.' :
      'Reload the page; if that does not help, the folder that it is served from may not be whole.')));
  document.body.classList.add('without-viewer');
  block('panel').hidden = true;
}

/** Moves views at once for who asked for less motion, now or later. */
function obeyReducedMotion(viewer: Viewer): void {
  const reduced = matchMedia('(prefers-reduced-motion: reduce)');
  const obey = () => { viewer.gliding = !reduced.matches; };
  reduced.addEventListener('change', obey);
  obey();
}

/** Without a scene, whole or at its first image, there is nothing to set. */
function markEmpty(viewer: Viewer): void {
  viewer.on('preview', () => document.body.classList.remove('empty'));
  viewer.on('scene', (scene) => document.body.classList.toggle('empty', scene === null));
}

function tellOfContext(viewer: Viewer, messages: Messages): void {
  const lost = () => 'The browser took the graphics device away.' +
    (viewer.scene ? ' The scene comes back as soon as the device does.' : '');
  let takeAway = () => {};
  viewer.on('context', (what) => {
    takeAway();
    if (what === 'lost') takeAway = messages.error(lost(), 'device');
    else messages.notice(`The graphics device is back${viewer.scene ? ', and so is the scene' : ''}.`);
  });
}

/** Everything around the image but opening. */
function addControls(viewer: Viewer, messages: Messages, loading: Loading, openings: Openings, bar: AddressBar,
                 start: Start): void {
  const tell = (sentence: string) => messages.notice(sentence);
  const failed = (what: unknown) => messages.thrown(what);
  const sceneKey = () => {
    const origin = openings.origin;
    return origin?.kind === 'address' ? origin.address : `${viewer.scene?.name}:${viewer.scene?.triangles}`;
  };

  const panel = new Panel(), fullScreen = new FullScreen();
  new SceneSection(viewer, loading);
  const views = new ViewsSection(viewer, tell), cameras = new CamerasSection(viewer, tell);
  const saved = new SavedSection(viewer, tell);
  new DrawingSection(viewer);
  const image = new ImageSection(viewer, tell, failed);
  const link = new LinkSection(viewer, bar, openings, tell);
  const follow = () => {
    // While another scene is on its way, or did not come, the address is that one's.
    const origin = openings.origin;
    if (origin && bar.scene() === (origin.kind === 'address' ? origin.address : null))
      bar.showView(viewer.getView(), viewer.shownLook);
    link.update();
  };
  const look = new LookSection(viewer, failed, follow);
  new TimesSection(viewer);
  viewer.on('view', follow);
  viewer.on('context', () => look.update());
  openings.onOpened(() => {
    saved.follow(sceneKey());
    look.update();
    follow();
  });

  new Shortcuts(viewer.canvas, [
    { key: 'f', meaning: 'all of the scene in the image', run: () => views.frame() },
    { key: 'r', meaning: 'back to the first view', run: () => views.first() },
    { key: 'm', meaning: 'a drag turns the scene, or the head', run: () => views.changeMode() },
    { key: 'u', meaning: 'another axis is up', run: () => views.nextUp() },
    { key: '[', meaning: 'the recorded camera before', run: () => cameras.step(-1) },
    { key: ']', meaning: 'the next recorded camera', run: () => cameras.step(1) },
    { key: 'k', meaning: 'keeps this view', run: () => saved.save() },
    { key: 'v', meaning: 'the next thing to look at', run: () => look.next() },
    { key: 'p', meaning: 'saves the image', run: () => void image.save() },
    { key: 'l', meaning: 'copies a link to this view', run: () => void link.copy() },
    { key: 'o', meaning: 'opens a scene', run: () => start.toggle() },
    { key: 'h', meaning: 'hides or shows the panel', run: () => panel.toggle() },
    { key: 'x', meaning: 'the whole screen, or not', run: () => fullScreen.toggle() },
    { key: '?', meaning: 'this list', run: () => byId('open-help', HTMLButtonElement).click() },
    ...namedViews.map((view, index) =>
      ({ key: String(index + 1), meaning: null, run: () => views.lookFrom(view) })),
  ]);
}

/** Opens what the page's address asks for, now and when a person goes back or forward. */
function followAddress(viewer: Viewer, openings: Openings, bar: AddressBar, start: Start): void {
  bar.onChange(() => {
    const wanted = bar.scene();
    const shown = openings.origin;
    const same = shown?.kind === 'address' ? shown.address === wanted : wanted === null;
    if (same) return void openings.look(bar.view());
    if (wanted === null) {
      viewer.clear();
      start.update();
    } else {
      void openings.openAddress(wanted, bar.view());
    }
  });
}

export async function openViewerPage(options: ViewerPageOptions = {}): Promise<void> {
  const embedded = new URLSearchParams(location.search).has('embed');
  document.documentElement.classList.toggle('embed', embedded);
  block('not-started').remove();
  const messages = new Messages();
  window.addEventListener('error', (event) => messages.thrown(event.error ?? event.message));
  window.addEventListener('unhandledrejection', (event) => messages.thrown(event.reason));

  // Until there is somewhere to take it, what is dropped must not replace the page.
  const starting = new AbortController();
  for (const event of ['dragover', 'drop'])
    window.addEventListener(event, (drag) => drag.preventDefault(), { signal: starting.signal });

  const bar = new AddressBar(embedded);
  const wanted = bar.scene();
  let viewer: Viewer;
  try {
    const expected = wanted ? fetchable(wanted) : options.scene;
    viewer = await createViewer(byId('canvas', HTMLCanvasElement),
                                { ...(options.assets && { assets: options.assets }), ...(expected && { expected }) });
  } catch (error) {
    return explain(error);
  }
  starting.abort();
  obeyReducedMotion(viewer);
  markEmpty(viewer);
  tellOfContext(viewer, messages);
  viewer.on('notice', (sentence) => messages.notice(sentence));

  const loading = new Loading(viewer, messages);
  const openings = new Openings(viewer, loading, messages, bar);
  const start = embedded ? null : new Start(viewer, openings, loading, messages);
  if (!start) {
    answerEmbedder(viewer, loading);
  } else {
    start.attachDrop();
    addControls(viewer, messages, loading, openings, bar, start);
    followAddress(viewer, openings, bar, start);
    block('actions').inert = false;
  }
  if (wanted) await openings.openAddress(wanted, bar.view());
  else if (options.scene) await openings.openPart(options.scene, bar.view());
  start?.update();
}
