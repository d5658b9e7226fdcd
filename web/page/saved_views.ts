// Views that a person has kept, by name, for each scene. What is stored may have been changed by
// others: what is no view is passed over.

import type { Vec3, ViewPose } from '../viewer/types.js';
import { recall, remember } from './memory.js';

export interface SavedView {
  readonly name: string;
  readonly pose: ViewPose;
}

export const isVector = (value: unknown): value is Vec3 =>
  Array.isArray(value) && value.length === 3 && value.every((part) => Number.isFinite(part));

/** Whether something that came from outside is a camera. */
export function isPose(value: unknown): value is ViewPose {
  const pose = value as Partial<ViewPose> | null;
  return typeof pose === 'object' && pose !== null && isVector(pose.eye) && isVector(pose.target) &&
    isVector(pose.up) && Number.isFinite(pose.fov) && Number.isFinite(pose.roll);
}

const isView = (value: unknown): value is SavedView =>
  typeof (value as SavedView | null)?.name === 'string' && isPose((value as SavedView).pose);

/** The views of one scene; `key` tells scenes apart. */
export class SavedViews {
  private views: SavedView[];
  /** Whether they outlast the page, as far as is known. */
  lasting = true;

  constructor(private readonly key: string) {
    const stored = recall(`views:${key}`);
    this.views = Array.isArray(stored) ? stored.filter(isView) : [];
  }

  list(): readonly SavedView[] { return this.views; }

  /** Replaces the view of the same name. An empty name becomes "View 3". */
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
