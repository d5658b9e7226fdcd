// Opens scenes from all sources. Sets the page's address, if it can contain the scene, and the first
// view.

import { urlOf } from '../viewer/addresses.js';
import type { SceneSource, SceneSummary, Viewer } from '../viewer/types.js';
import type { AddressBar } from './address_bar.js';
import type { LinkedView } from './camera_link.js';
import type { Loading } from './loading.js';
import type { Messages } from './messages.js';

/** The origin of the current scene. */
export type Origin =
  | { readonly kind: 'address'; readonly address: string }
  | { readonly kind: 'files'; readonly name: string }
  /** The scene is part of the page. */
  | { readonly kind: 'page' };

const noView: LinkedView = { pose: null, debugView: null, defect: null };

export class Openings {
  private origin_: Origin | null = null;
  private readonly listeners: (() => void)[] = [];

  constructor(private readonly viewer: Viewer, private readonly loading: Loading,
              private readonly messages: Messages, private readonly bar: AddressBar) {}

  /** The origin of the current scene; null without one. */
  get origin(): Origin | null { return this.viewer.scene ? this.origin_ : null; }

  /** Calls `listener` after a scene is open and its first view is set. */
  onOpened(listener: () => void): void { this.listeners.push(listener); }

  /** Opens an address, relative to the page's. */
  async openAddress(address: string, view: LinkedView = noView): Promise<boolean> {
    let source;
    try {
      source = { url: urlOf({ url: address }) };
    } catch (error) {
      this.messages.thrown(error);
      return false;
    }
    return this.open(source, { kind: 'address', address }, view);
  }

  /** Opens files. A link to a view of a file contains no scene, so its view applies to the first opened
   *  files. */
  openFiles(source: SceneSource): Promise<boolean> {
    const linked = !this.origin_ && this.bar.scene() === null;
    return this.open(source, { kind: 'files', name: source.name ?? '' }, linked ? this.bar.view() : noView);
  }

  openPart(source: SceneSource, view: LinkedView): Promise<boolean> {
    return this.open(source, { kind: 'page' }, view);
  }

  /** Applies the camera and the debug view of a link. */
  async look(view: LinkedView): Promise<void> {
    if (view.defect) this.messages.notice(view.defect);
    this.lookFrom(view);
    try {
      if ((view.debugView ?? 'color') !== this.viewer.debugView) await this.viewer.show(view.debugView ?? 'color');
    } catch (error) {
      this.messages.thrown(error);
    }
  }

  private lookFrom({ pose }: LinkedView): void {
    if (pose) this.viewer.setView({ ...pose, up: pose.up ?? this.viewer.getView().up });
  }

  private async open(source: SceneSource, origin: Origin, view: LinkedView): Promise<boolean> {
    // The preview already has this view, and the user may move it before the whole scene arrives.
    let looked = false;
    const forget = this.viewer.on('preview', () => {
      this.lookFrom(view);
      looked = true;
    });
    const scene: SceneSummary | null = await this.loading.load(source);
    forget();
    if (!scene) return false;
    this.origin_ = origin;
    this.bar.showScene(origin.kind === 'address' ? origin.address : null);
    await this.look(looked ? { ...view, pose: null } : view);
    for (const listener of this.listeners) listener();
    return true;
  }
}
