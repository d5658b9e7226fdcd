// The page over the whole screen, where the browser has that for pages (an iPhone has not).

import { button } from './dom.js';

export class FullScreen {
  private readonly toggler = button('full-screen');

  constructor() {
    this.toggler.hidden = !document.fullscreenEnabled;
    this.toggler.addEventListener('click', () => this.toggle());
    document.addEventListener('fullscreenchange', () =>
      this.toggler.setAttribute('aria-pressed', String(document.fullscreenElement !== null)));
  }

  toggle(): void {
    const refused = () => { /* a browser may refuse; then nothing changes */ };
    if (document.fullscreenElement) document.exitFullscreen().catch(refused);
    else document.documentElement.requestFullscreen?.().catch(refused);
  }
}
