// The page's own address: ?scene= says what is shown, the part after '#' from where. It follows what
// is shown, so that a reload, a bookmark and the Back button do what people expect.

import type { ViewPose } from '../viewer/types.js';
import { readFragment, writeFragment, type LinkedView } from './camera_link.js';

/** Readable: slashes and colons may stand in a query as they are. */
const queryText = (text: string) => encodeURIComponent(text).replace(/%2F/g, '/').replace(/%3A/g, ':');

export class AddressBar {
  /** `still`: the address is somebody else's (a page in a frame) and is left alone. */
  constructor(private readonly still: boolean) {}

  /** The scene that the address asks for, as it stands there. */
  scene(): string | null { return new URLSearchParams(location.search).get('scene') || null; }

  view(): LinkedView { return readFragment(location.hash); }

  /** What is shown has this address now, or none: it came from files. */
  showScene(scene: string | null): void {
    if (scene === this.scene()) return;
    this.change(() => history.pushState(null, '', this.link(scene, null, null)));
  }

  showView(pose: ViewPose, look: string): void {
    const link = this.link(this.scene(), pose, look);
    if (link !== location.href) this.change(() => history.replaceState(null, '', link));
  }

  /** This page with that scene, seen from there. */
  link(scene: string | null, pose: ViewPose | null, look: string | null): string {
    const others = [...new URLSearchParams(location.search)].filter(([name]) => name !== 'scene');
    if (scene) others.push(['scene', scene]);
    const query = others.map(([name, value]) => queryText(name) + (value ? `=${queryText(value)}` : '')).join('&');
    return location.href.replace(/[?#].*$/s, '') + (query ? `?${query}` : '') + writeFragment(pose, look);
  }

  /** Calls when a person went back or forward, or changed the address by hand. */
  onChange(listener: () => void): void { window.addEventListener('popstate', listener); }

  private change(how: () => void): void {
    if (this.still) return;
    try {
      how();
    } catch { /* a page from the disk may not, and a browser may find it too often */ }
  }
}
