// Opens scenes from all sources, and adds further ones as layers. Sets the page's address, if it can contain
// the scenes, and the first view.

import { urlOf } from '../viewer/addresses.js';
import type { SceneLayer, SceneSource, SceneSummary, Viewer } from '../viewer/types.js';
import type { AddressBar } from './address_bar.js';
import type { LinkedView } from '../common/camera_link.js';
import { writeLayers } from '../common/layer_link.js';
import type { Loading } from './loading.js';
import type { Messages } from '../common/messages.js';

/** The origin of a scene. */
export type Origin =
  | { readonly kind: 'address'; readonly address: string }
  | { readonly kind: 'files'; readonly name: string }
  /** The scene is part of the page. */
  | { readonly kind: 'page' };

/** The level of detail that an address may end in: streamed/lod-meta.json#lod=2. */
const levelPart = /#lod=(\d{1,3})$/;

export const sourceAt = (address: string): SceneSource => {
  const lod = levelPart.exec(address)?.[1], url = urlOf({ url: address.replace(levelPart, '') });
  return lod === undefined ? { url } : { url, lod: Number(lod) };
};

const atLevel = (origin: Origin, lod: number): Origin =>
  origin.kind === 'address' ? { ...origin, address: `${origin.address.replace(levelPart, '')}#lod=${lod}` } : origin;

const noView: LinkedView = { pose: null, named: null, debugView: null, layers: null, defect: null };

/** A scene that was opened or added. */
interface Opened {
  readonly origin: Origin;
  /** Its layers at that time. */
  readonly layers: readonly SceneLayer[];
}

export class Openings {
  private origin_: Origin | null = null;
  private key = '';
  private readonly opened = new Map<SceneSource, Opened>();
  /** Number of times that the scene was replaced or cleared: it ends earlier openings and additions. */
  private generation = 0;
  /** The generation whose scenes are being opened: the address is theirs until then. */
  private opening: number | null = null;
  /** Whether a scene of the link is missing: the address still names it. */
  private incomplete = false;
  private readonly listeners: (() => void)[] = [];

  constructor(private readonly viewer: Viewer, private readonly loading: Loading,
              private readonly messages: Messages, private readonly bar: AddressBar) {
    loading.onBegin(() => ++this.generation);
  }

  /** The origin of the first scene; null without one. */
  get origin(): Origin | null { return this.viewer.scene ? this.origin_ : null; }

  /** Identifies the first scene for saved views; added layers do not change it. */
  get sceneKey(): string { return this.key; }

  /** The scenes with an address, in the order of their first layers. */
  private get linked(): readonly SceneSource[] {
    const sources = new Set(this.viewer.layers.map(({ source }) => source));
    return [...sources].filter((source) => this.opened.get(source)?.origin.kind === 'address');
  }

  /** The addresses of these scenes. */
  get addresses(): readonly string[] {
    return this.linked.map((source) => {
      const { origin } = this.opened.get(source)!;
      return origin.kind === 'address' ? origin.address : '';
    });
  }

  /** Whether a link lacks a shown scene, because it is a local file. */
  get lacksScenes(): boolean {
    return this.viewer.layers.some(({ source }) => this.opened.get(source)?.origin.kind === 'files');
  }

  /** Changes of the layers, for a link; null without changes. */
  get layersText(): string | null {
    return writeLayers(this.linked, this.viewer.layers, (source) => this.opened.get(source)!.layers);
  }

  /** Calls `listener` after scenes are open and their first view is set, and after files were added. */
  onOpened(listener: () => void): void { this.listeners.push(listener); }

  /** Shows scenes, camera and layers in the address, unless it names scenes that are not open. */
  updateAddress(): void {
    const { viewer, bar } = this;
    if (!viewer.scene || this.incomplete || this.opening === this.generation || this.loading.busy) return;
    bar.showView(this.addresses, viewer.getView(), viewer.debugView, this.layersText);
  }

  /** Opens addresses, relative to the page's: the first replaces the scene, the others are added. */
  async openAddresses(addresses: readonly string[], view: LinkedView = noView): Promise<boolean> {
    const scenes: { source: SceneSource; origin: Origin }[] = [];
    try {
      for (const address of addresses)
        scenes.push({ source: sourceAt(address), origin: { kind: 'address', address } });
    } catch (error) {
      this.messages.thrown(error);
      return false;
    }
    return this.open(scenes, view);
  }

  /** Opens files. A link to a view of a file contains no scene, so its view applies to the first opened
   *  files. */
  openFiles(sources: readonly SceneSource[]): Promise<boolean> {
    const linked = !this.origin_ && this.bar.scenes().length === 0;
    return this.open(sources.map((source) => ({ source, origin: { kind: 'files', name: source.name ?? '' } })),
                     linked ? this.bar.view() : noView);
  }

  /** Opens the first scene again at another level of detail, and alone, from the same view. */
  openLevel(lod: number): Promise<boolean> {
    const first = this.viewer.layers[0]!.source, { origin } = this.opened.get(first)!, pose = this.viewer.getView();
    return this.open([{ source: { ...first, lod }, origin: atLevel(origin, lod) }], { ...noView, pose });
  }

  openPart(source: SceneSource, view: LinkedView): Promise<boolean> {
    return this.open([{ source, origin: { kind: 'page' } }], view);
  }

  /** Adds files to the scene. */
  async addFiles(sources: readonly SceneSource[]): Promise<boolean> {
    this.messages.clearErrors();
    const { generation } = this;
    let all = true;
    for (const source of sources) {
      if (generation !== this.generation) return all;  // another scene is open now
      all = await this.add(source, { kind: 'files', name: source.name ?? '' }) && all;
    }
    this.reportOpened();
    return all;
  }

  /** Applies the camera, the layers and the debug view of a link. `scenes`: the scenes of the link. */
  async look(view: LinkedView, scenes = this.linked): Promise<void> {
    if (view.defect) this.messages.notice(view.defect);
    try {
      await this.arrange(view, scenes);
      this.lookFrom(view);
      if ((view.debugView ?? 'color') !== this.viewer.debugView) await this.viewer.show(view.debugView ?? 'color');
    } catch (error) {
      this.messages.thrown(error);
    }
  }

  private lookFrom({ pose, named }: LinkedView): void {
    if (named) this.viewer.showNamedView(named, { glide: false });
    if (pose) this.viewer.setView({ ...pose, up: pose.up ?? this.viewer.getView().up });
  }

  /** Gives the layers the order and the places of a link. Entries without a layer are ignored. */
  private async arrange({ layers: entries }: LinkedView, scenes: readonly SceneSource[]): Promise<void> {
    if (!entries) return;
    const { viewer } = this;
    let next = 0;
    for (const { scene, layer, visible, placement } of entries) {
      const at = viewer.layers.findIndex(({ source, sourceLayer }, index) =>
        index >= next && source === scenes[scene] && sourceLayer === layer);
      if (at < 0) continue;
      await viewer.moveLayer(at, next);
      viewer.setLayer(next++, { visible, ...(placement && { transform: placement }) });
    }
    while (next > 0 && viewer.layers.length > next) await viewer.removeLayer(next);
  }

  private async open(scenes: readonly { readonly source: SceneSource; readonly origin: Origin }[],
                     view: LinkedView): Promise<boolean> {
    const [first, ...others] = scenes;
    if (!first) return false;
    // Previews already have this view, and the user may move it before the whole scene arrives. A named view depends
    // on the scene, so each part sets it again.
    let seen: string | null = null;
    const pose = () => JSON.stringify(this.viewer.getView()), isUnmoved = () => seen === null || seen === pose();
    const lookAgain = () => {
      if (!isUnmoved()) return;
      this.lookFrom(view);
      seen = pose();
    };
    const forget = this.viewer.on('preview', lookAgain);
    const loaded: Promise<SceneSummary | null> = this.loading.load(first.source);
    const { generation } = this;
    const scene = await loaded;
    forget();
    if (!scene) return false;
    this.origin_ = first.origin;
    this.key = first.origin.kind === 'address' ? first.origin.address.replace(levelPart, '') : `${scene.name}:${scene.triangles}`;
    this.incomplete = false;
    this.opened.clear();
    this.opened.set(first.source, { origin: first.origin, layers: this.viewer.layers });
    this.bar.showScenes(scenes.flatMap(({ origin }) => (origin.kind === 'address' ? [origin.address] : [])));
    // With further scenes the view is set before and after them: they take time.
    if (others.length > 0) lookAgain();
    this.opening = generation;
    let all = true;
    for (const { source, origin } of others) {
      if (generation !== this.generation) return true;  // another scene is open now
      all = await this.add(source, origin) && all;
    }
    if (generation !== this.generation) return true;
    this.opening = null;
    this.incomplete = !all;
    await this.look(isUnmoved() ? view : { ...view, pose: null, named: null },
                    scenes.filter(({ origin }) => origin.kind === 'address').map(({ source }) => source));
    this.viewer.forgetSteps();  // all of this was the opening
    this.reportOpened();
    return true;
  }

  private async add(source: SceneSource, origin: Origin): Promise<boolean> {
    const layers = await this.loading.add(source);
    if (!layers) return false;
    this.opened.set(source, { origin, layers });
    this.updateAddress();
    return true;
  }

  private reportOpened(): void {
    for (const listener of this.listeners) listener();
  }
}
