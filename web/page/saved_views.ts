// The user's saved views of each scene, by name. Other scripts may change the storage, so invalid
// entries are skipped.

import type { ViewPose } from '../viewer/types.js';
import { recall, remember } from './memory.js';
import { isVector } from '../common/numbers.js';

export interface SavedView {
  readonly name: string;
  readonly pose: ViewPose;
}

/** Whether an untrusted value is a camera. */
export function isPose(value: unknown): value is ViewPose {
  const pose = value as Partial<ViewPose> | null;
  return typeof pose === 'object' && pose !== null && isVector(pose.eye) && isVector(pose.target) &&
    isVector(pose.up) && Number.isFinite(pose.fov) && Number.isFinite(pose.roll);
}

const isView = (value: unknown): value is SavedView =>
  typeof (value as SavedView | null)?.name === 'string' && isPose((value as SavedView).pose);

/** The views of one scene; `key` identifies the scene. */
export class SavedViews {
  private views: SavedView[];
  /** Whether the last write was stored permanently. */
  lasting = true;

  constructor(private readonly key: string) {
    const stored = recall(`views:${key}`);
    this.views = Array.isArray(stored) ? stored.filter(isView) : [];
  }

  list(): readonly SavedView[] { return this.views; }

  /** Saves a view; replaces one with the same name. An empty name becomes a free one, "View 3". */
  save(name: string, pose: ViewPose): string {
    const wanted = name.trim() || this.freeName();
    const at = this.views.findIndex((view) => view.name === wanted);
    if (at >= 0) this.views[at] = { name: wanted, pose };
    else this.views.push({ name: wanted, pose });
    this.write();
    return wanted;
  }

  remove(name: string): void {
    this.views = this.views.filter((view) => view.name !== name);
    this.write();
  }

  private freeName(): string {
    for (let number = this.views.length + 1; ; ++number)
      if (!this.views.some((view) => view.name === `View ${number}`)) return `View ${number}`;
  }

  private write(): void {
    this.lasting = remember(`views:${this.key}`, this.views.length ? this.views : null);
  }
}
