// Full screen for the page, if the browser supports it (an iPhone does not).

import { button } from '../common/dom.js';

export class FullScreen {
  private readonly toggler = button('full-screen');

  constructor() {
    this.toggler.hidden = !document.fullscreenEnabled;
    this.toggler.addEventListener('click', () => this.toggle());
    document.addEventListener('fullscreenchange', () =>
      this.toggler.setAttribute('aria-pressed', String(document.fullscreenElement !== null)));
  }

  toggle(): void {
    const refused = () => { /* if the browser refuses, nothing changes */ };
    if (document.fullscreenElement) document.exitFullscreen().catch(refused);
    else document.documentElement.requestFullscreen?.().catch(refused);
  }
}
