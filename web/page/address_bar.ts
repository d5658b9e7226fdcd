// The page's address: ?scene= holds a scene, once for each, and the part after '#' the camera and the layers. The page updates it, so
// reloads, bookmarks and the Back button work as usual.

import { queryText } from '../viewer/addresses.js';
import { splatBlendings, type SplatBlending, type ViewPose } from '../viewer/types.js';
import { readFragment, writeFragment, type LinkedView } from '../common/camera_link.js';

export class AddressBar {
  /** `still`: do not change the address, for a page in a frame. */
  constructor(private readonly still: boolean) {}

  /** The scenes in the address, unchanged. */
  scenes(): readonly string[] { return new URLSearchParams(location.search).getAll('scene').filter(Boolean); }

  /** The value of ?blend=, if it is one. */
  blend(): SplatBlending | undefined {
    const given = new URLSearchParams(location.search).get('blend');
    return splatBlendings.find((blend) => blend === given);
  }

  /** Whether the address has these scenes, in this order. */
  has(scenes: readonly string[]): boolean {
    const now = this.scenes();
    return now.length === scenes.length && now.every((scene, index) => scene === scenes[index]);
  }

  view(): LinkedView { return readFragment(location.hash); }

  /** Sets the addresses of the shown scenes; scenes from files have none. */
  showScenes(scenes: readonly string[]): void {
    if (!this.has(scenes)) this.change(() => history.pushState(null, '', this.link(scenes, null, null, null)));
  }

  /** Sets the addresses and the view. The Back button still leads to the scenes before. `layers`: text of
   *  writeLayers(). */
  showView(scenes: readonly string[], pose: ViewPose, debugView: string, layers: string | null): void {
    const link = this.link(scenes, pose, debugView, layers);
    if (link !== location.href) this.change(() => history.replaceState(null, '', link));
  }

  /** A link to this page with scenes, a camera and layers. */
  link(scenes: readonly string[], pose: ViewPose | null, debugView: string | null, layers: string | null): string {
    const others = [...new URLSearchParams(location.search)].filter(([name]) => name !== 'scene');
    for (const scene of scenes) others.push(['scene', scene]);
    const query = others.map(([name, value]) => queryText(name) + (value ? `=${queryText(value)}` : '')).join('&');
    return location.href.replace(/[?#].*$/s, '') + (query ? `?${query}` : '') + writeFragment(pose, debugView, layers);
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
