// The page's address: ?scene= holds the scene, the part after '#' the camera. The page updates it, so
// reloads, bookmarks and the Back button work as usual.

import type { ViewPose } from '../viewer/types.js';
import { readFragment, writeFragment, type LinkedView } from './camera_link.js';

/** Encodes a query, but keeps slashes and colons, which are allowed there, readable. */
const queryText = (text: string) => encodeURIComponent(text).replace(/%2F/g, '/').replace(/%3A/g, ':');

export class AddressBar {
  /** `still`: do not change the address, for a page in a frame. */
  constructor(private readonly still: boolean) {}

  /** The scene in the address, unchanged. */
  scene(): string | null { return new URLSearchParams(location.search).get('scene') || null; }

  view(): LinkedView { return readFragment(location.hash); }

  /** Sets the address of the current scene; null for a scene from files. */
  showScene(scene: string | null): void {
    if (scene === this.scene()) return;
    this.change(() => history.pushState(null, '', this.link(scene, null, null)));
  }

  showView(pose: ViewPose, debugView: string): void {
    const link = this.link(this.scene(), pose, debugView);
    if (link !== location.href) this.change(() => history.replaceState(null, '', link));
  }

  /** A link to this page with a scene and a camera. */
  link(scene: string | null, pose: ViewPose | null, debugView: string | null): string {
    const others = [...new URLSearchParams(location.search)].filter(([name]) => name !== 'scene');
    if (scene) others.push(['scene', scene]);
    const query = others.map(([name, value]) => queryText(name) + (value ? `=${queryText(value)}` : '')).join('&');
    return location.href.replace(/[?#].*$/s, '') + (query ? `?${query}` : '') + writeFragment(pose, debugView);
  }

  /** Calls `listener` after the user goes back or forward, or edits the address. */
  onChange(listener: () => void): void { window.addEventListener('popstate', listener); }

  private change(how: () => void): void {
    if (this.still) return;
    try {
      how();
    } catch { /* browsers refuse it for pages from the disk, and limit its rate */ }
  }
}
