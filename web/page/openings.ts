// All ways to a scene end here: what is opened, whether the page's address can carry it, and from
// where it is looked at first.

import { urlOf } from '../viewer/addresses.js';
import type { SceneSource, SceneSummary, Viewer } from '../viewer/types.js';
import type { AddressBar } from './address_bar.js';
import type { LinkedView } from './camera_link.js';
import type { Loading } from './loading.js';
import type { Messages } from './messages.js';

/** Where the scene that is shown came from. */
export type Origin =
  | { readonly kind: 'address'; readonly address: string }
  | { readonly kind: 'files'; readonly name: string }
  /** It is part of the page. */
  | { readonly kind: 'page' };

const noView: LinkedView = { pose: null, look: null, defect: null };

export class Openings {
  private origin_: Origin | null = null;
  private readonly listeners: (() => void)[] = [];

  constructor(private readonly viewer: Viewer, private readonly loading: Loading,
              private readonly messages: Messages, private readonly bar: AddressBar) {}

  /** Of what is shown; null while nothing is. */
  get origin(): Origin | null { return this.viewer.scene ? this.origin_ : null; }

  /** Calls when a scene has been opened and is looked at from where it was asked to be. */
  onOpened(listener: () => void): void { this.listeners.push(listener); }

  /** By an address, relative to the page's. */
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

  /** A link to a view of a file has no scene: it is for who opens that file, first of all. */
  openFiles(source: SceneSource): Promise<boolean> {
    const linked = !this.origin_ && this.bar.scene() === null;
    return this.open(source, { kind: 'files', name: source.name ?? '' }, linked ? this.bar.view() : noView);
  }

  openPart(source: SceneSource, view: LinkedView): Promise<boolean> {
    return this.open(source, { kind: 'page' }, view);
  }

  /** Looks from where a link says. */
  async look(view: LinkedView): Promise<void> {
    if (view.defect) this.messages.notice(view.defect);
    this.lookFrom(view);
    try {
      if ((view.look ?? 'color') !== this.viewer.shownLook) await this.viewer.show(view.look ?? 'color');
    } catch (error) {
      this.messages.thrown(error);
    }
  }

  private lookFrom({ pose }: LinkedView): void {
    if (pose) this.viewer.setView({ ...pose, up: pose.up ?? this.viewer.getView().up });
  }

  private async open(source: SceneSource, origin: Origin, view: LinkedView): Promise<boolean> {
    // The first image is already seen from there, and a person may move on while the rest arrives.
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
