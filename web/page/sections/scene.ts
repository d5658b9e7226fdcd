// Facts and notes about the scene.

import type { SceneSummary, Viewer } from '../../viewer/types.js';
import { block, fillFacts, fillSentences, make, select } from '../../common/dom.js';
import type { Loading } from '../loading.js';
import { bytesText, countText, primitivesText } from '../../common/numbers.js';

export class SceneSection {
  private notices: string[] = [];

  constructor(private readonly viewer: Viewer, private readonly chooseLevel: (level: number) => void, loading: Loading) {
    select('detail').addEventListener('change', () => this.chooseLevel(select('detail').selectedIndex));
    viewer.on('scene', (scene) => {
      if (!scene) this.notices = [];
      this.show(scene);
    });
    viewer.on('notice', (sentence) => {
      if (!this.notices.includes(sentence)) this.notices.push(sentence);
      this.showNotes();
    });
    loading.onBegin(() => { this.notices = []; });  // notices of the previous scene
    viewer.on('layers', () => this.showFacts());  // a moved layer changes the box
    this.show(viewer.scene);
  }

  private show(scene: SceneSummary | null): void {
    block('scene-title').textContent = scene ? this.title(scene) : '';
    document.title = scene ? `${this.title(scene)} · Tureen` : 'Tureen';
    this.showFacts();
    const detail = scene?.detail ?? null;
    block('detail-part').hidden = detail === null;
    select('detail').replaceChildren(...(detail?.splats ?? []).map((splats, level) =>
      make('option', { value: level, selected: level === detail!.level }, `${level}: ${countText(splats)} splats`)));
    this.showNotes();
  }

  private showFacts(): void {
    const { scene, box } = this.viewer;
    fillFacts(block('facts'), scene && box ? [
      ['Name', scene.name],
      ['Source', scene.source || null],
      ['Size', primitivesText(scene)],
      ['Extent', box.extent],
      ['Box', `${box.low} to ${box.high}`],
      ['Appearance', scene.appearance],
      ['GPU memory', scene.splatsByProcessor ? 'none: the processor draws the splats' : bytesText(scene.deviceBytes)],
    ] : [['Name', 'no scene is open']]);
  }

  /** "soup", "soup and 2 more" */
  private title({ name }: SceneSummary): string {
    const more = this.viewer.layers.length - 1;
    return more > 0 ? `${name} and ${more} more` : name;
  }

  private showNotes(): void {
    const notes = [...(this.viewer.scene?.notes ?? []), ...this.notices];
    fillSentences(block('notes'), notes);
    block('notes-part').hidden = notes.length === 0;
  }
}
