// The panel next to the image, or a sheet below it on an upright phone. Its sections are <details>; the
// page stores which are open.

import { block, button } from '../common/dom.js';
import { recall, remember } from './memory.js';

const upright = matchMedia('(max-width: 720px) and (max-aspect-ratio: 1/1)');

export class Panel {
  private readonly panel = block('panel');
  private readonly toggler = button('toggle-panel');
  private readonly handle = button('handle');

  constructor() {
    const kept = recall('panel');
    this.show(typeof kept === 'boolean' && !upright.matches ? kept : !upright.matches);
    this.toggler.addEventListener('click', () => this.toggle());
    this.attachHandle();
    this.rememberSections();
  }

  toggle(): void {
    this.show(this.panel.hidden !== false);
    if (!upright.matches) remember('panel', !this.panel.hidden);
  }

  private show(open: boolean): void {
    if (!open && this.panel.contains(document.activeElement)) this.toggler.focus();
    this.panel.hidden = !open;
    this.toggler.setAttribute('aria-expanded', String(open));
  }

  /** A drag changes the height of the sheet; a tap or a long drag down closes it. */
  private attachHandle(): void {
    const { handle, panel } = this;
    let from: { y: number; height: number } | null = null;
    let pulled = false;
    handle.addEventListener('pointerdown', (event) => {
      from = { y: event.clientY, height: panel.offsetHeight };
      pulled = false;
      handle.setPointerCapture(event.pointerId);
    });
    handle.addEventListener('pointermove', (event) => {
      if (!from) return;
      pulled ||= Math.abs(event.clientY - from.y) > 6;
      if (pulled) panel.style.setProperty('--sheet', `${from.height + from.y - event.clientY}px`);
    });
    const release = () => {
      if (from && pulled && panel.offsetHeight < 120) this.close();
      from = null;
    };
    handle.addEventListener('pointerup', release);
    handle.addEventListener('pointercancel', release);
    handle.addEventListener('click', () => { if (!pulled) this.close(); });
    handle.addEventListener('keydown', () => { pulled = false; });
  }

  private close(): void {
    this.panel.style.removeProperty('--sheet');
    this.show(false);
  }

  private rememberSections(): void {
    const sections = [...block('sections').querySelectorAll('details')];
    const kept = recall('sections');
    if (Array.isArray(kept) && kept.length === sections.length)
      sections.forEach((section, index) => { section.open = kept[index] === true; });
    for (const section of sections)
      section.addEventListener('toggle', () => remember('sections', sections.map(({ open }) => open)));
  }
}
