// The page: creates a viewer on the canvas, and the controls around it.

import { namedViews, ViewerError, type Assets, type SceneSource, type Viewer } from '../viewer/types.js';
import { createViewer } from '../viewer/viewer.js';
import { AddressBar } from './address_bar.js';
import { block, byId, make } from '../common/dom.js';
import { answerEmbedder } from './embed.js';
import { FullScreen } from './full_screen.js';
import { Loading } from './loading.js';
import { recall } from './memory.js';
import { Messages } from '../common/messages.js';
import { Openings, sourceAt } from './openings.js';
import { Panel } from './panel.js';
import { CamerasSection } from './sections/cameras.js';
import { DrawingSection } from './sections/drawing.js';
import { LinkSection } from './sections/link.js';
import { DownloadSection } from './sections/download.js';
import { DebugViewSection } from './sections/debug_view.js';
import { ImageSection } from './sections/image.js';
import { LayersSection } from './sections/layers.js';
import { SavedSection } from './sections/saved.js';
import { SceneSection } from './sections/scene.js';
import { TimesSection } from './sections/times.js';
import { TourSection } from './sections/tour.js';
import { StepsSection } from './sections/steps.js';
import { ViewsSection } from './sections/views.js';
import { Shortcuts } from './shortcuts.js';
import { chooseSplats } from './splat_choice.js';
import { Start } from './start.js';

export interface ViewerPageOptions {
  /** By default the files next to the script. */
  readonly assets?: Assets;
  /** A scene that is part of the page. */
  readonly scene?: SceneSource | null;
}

/** The source for an address if the page can fetch it, otherwise null. Opening it later reports the error. */
function fetchable(address: string): SceneSource | null {
  try {
    return sourceAt(address);
  } catch {
    return null;
  }
}

/** Shows the error of a viewer that did not start, instead of the image. */
function explain(error: unknown): void {
  const missing = error instanceof ViewerError && error.kind === 'no-webgl2';
  const why = error instanceof Error ? error.message : String(error);
  block('stage').replaceChildren(make('div', { class: 'no-image-at-all', role: 'alert' },
    make('h2', {}, missing ? 'This browser has no WebGL2' : 'The viewer did not start'),
    make('p', {}, why),
    make('p', {}, missing ?
      'Tureen needs WebGL2. Use a current Firefox, Chrome, Edge or Safari. If you already do, check that graphics ' +
      'acceleration is on in its settings.' :
      'Reload the page. If that does not help, files may be missing on the server.')));
  document.body.classList.add('without-viewer');
  block('panel').hidden = true;
}

/** Disables gliding while the user prefers reduced motion. */
function obeyReducedMotion(viewer: Viewer): void {
  const reduced = matchMedia('(prefers-reduced-motion: reduce)');
  const obey = () => { viewer.gliding = !reduced.matches; };
  reduced.addEventListener('change', obey);
  obey();
}

/** Marks the page as empty while there is no scene and no preview; the style then hides the controls. */
function markEmpty(viewer: Viewer): void {
  viewer.on('preview', () => document.body.classList.remove('empty'));
  viewer.on('scene', (scene) => document.body.classList.toggle('empty', scene === null));
}

function tellOfContext(viewer: Viewer, messages: Messages): void {
  const lost = () => 'The browser reset the graphics device.' +
    (viewer.scene ? ' The scene returns when the device is available again.' : '');
  let takeAway = () => {};
  viewer.on('context', (what) => {
    takeAway();
    if (what === 'lost') takeAway = messages.error(lost(), 'device');
    else messages.notice(`The graphics device${viewer.scene ? ' and the scene are' : ' is'} available again.`);
  });
}

/** All controls around the image, except those for opening scenes. */
function addControls(viewer: Viewer, messages: Messages, loading: Loading, openings: Openings, bar: AddressBar,
                 start: Start): void {
  const tell = (sentence: string) => messages.notice(sentence);
  const failed = (what: unknown) => messages.thrown(what);

  const panel = new Panel(), fullScreen = new FullScreen();
  new SceneSection(viewer, (level) => void openings.openLevel(level), loading);
  new DownloadSection(viewer, loading, tell);
  new TourSection(viewer, failed);
  const steps = new StepsSection(viewer, loading, tell);
  new LayersSection(viewer, tell, failed);
  const views = new ViewsSection(viewer, tell), cameras = new CamerasSection(viewer, tell);
  const saved = new SavedSection(viewer, tell);
  new DrawingSection(viewer);
  const image = new ImageSection(viewer, tell, failed);
  const link = new LinkSection(viewer, bar, openings, tell);
  const follow = () => {
    openings.updateAddress();
    link.update();
  };
  const debugViews = new DebugViewSection(viewer, failed, follow);
  new TimesSection(viewer);
  viewer.on('view', follow);
  viewer.on('layers', follow);
  viewer.on('context', () => debugViews.update());
  openings.onOpened(() => {
    saved.follow(openings.sceneKey);
    debugViews.update();
    follow();
  });

  new Shortcuts(viewer.canvas, [
    { key: 'f', meaning: 'frame the whole scene', run: () => views.frame() },
    { key: 'r', meaning: 'return to the first view and its up axis', run: () => views.first() },
    { key: 'm', meaning: 'switch between orbit and fly', run: () => views.changeMode() },
    { key: 'u', meaning: 'change the up axis', run: () => views.nextUp() },
    { key: 'i', meaning: 'turn the scene upside down', run: () => views.turnOver() },
    { key: '[', meaning: 'previous recorded camera', run: () => cameras.step(-1) },
    { key: ']', meaning: 'next recorded camera', run: () => cameras.step(1) },
    { key: 'ctrl+z', meaning: 'undo', run: () => void steps.go('undo') },
    { key: 'ctrl+y', meaning: 'redo', run: () => void steps.go('redo') },
    { key: 'ctrl+shift+z', meaning: null, run: () => void steps.go('redo') },
    { key: 'k', meaning: 'save this view', run: () => saved.save() },
    { key: 'v', meaning: 'next debug view', run: () => debugViews.next() },
    { key: 'p', meaning: 'save the image', run: () => void image.save() },
    { key: 'l', meaning: 'copy a link to this view', run: () => void link.copy() },
    { key: 'o', meaning: 'open a scene', run: () => start.toggle() },
    { key: 'h', meaning: 'show or hide the panel', run: () => panel.toggle() },
    { key: 'x', meaning: 'full screen on or off', run: () => fullScreen.toggle() },
    { key: '?', meaning: 'show this list', run: () => byId('open-help', HTMLButtonElement).click() },
    ...namedViews.map((view, index) =>
      ({ key: String(index + 1), meaning: null, run: () => views.lookFrom(view) })),
  ]);
}

/** Opens the scene and view of the page's address when the user goes back or forward. */
function followAddress(loading: Loading, openings: Openings, bar: AddressBar, start: Start): void {
  bar.onChange(() => {
    const wanted = bar.scenes();
    if (bar.has(openings.addresses)) return void openings.look(bar.view());
    if (wanted.length === 0) {
      loading.clear();
      start.update();
    } else {
      void openings.openAddresses(wanted, bar.view());
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

  // Until the page can open dropped files, they must not replace it.
  const starting = new AbortController();
  for (const event of ['dragover', 'drop'])
    window.addEventListener(event, (drag) => drag.preventDefault(), { signal: starting.signal });

  const bar = new AddressBar(embedded);
  const wanted = bar.scenes();
  let viewer: Viewer;
  try {
    const expected = wanted[0] ? fetchable(wanted[0]) : options.scene;
    const blend = bar.blend();
    viewer = await createViewer(byId('canvas', HTMLCanvasElement), {
      chooseSplats, smoothAtRest: recall('smooth') !== false, upright: recall('upright') !== false, ...(options.assets && { assets: options.assets }), ...(expected && { expected }), ...(blend && { blend }),
    });
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
    followAddress(loading, openings, bar, start);
    block('actions').inert = false;
  }
  if (wanted.length > 0) await openings.openAddresses(wanted, bar.view());
  else if (options.scene) await openings.openPart(options.scene, bar.view());
  start?.update();
}
