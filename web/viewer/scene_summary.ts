// What the page is told of a scene, from what the loader and the device said.

import type { PreparedScene } from './loader_messages.js';
import type { SceneSummary } from './types.js';

/** What showing a scene has told: web/engine/viewer.cpp. */
export interface ShownFacts {
  readonly plan: readonly string[];
  /** So many triangles. */
  readonly drawn: number;
  readonly device_bytes: number;
}

export const lowerLevelSentence = (level: number) =>
  `This device has not enough memory for the whole scene: it is drawn with lattice level ${level}.`;

export const nothingDrawn = 'Nothing of this scene can be drawn: it has no triangles that are finite and have an area.';

export function sceneSummary({ description }: PreparedScene, facts: ShownFacts): SceneSummary {
  const { name, source, notes, triangles, appearance, cameras, background, subject, looks } = description;
  return {
    name, source, triangles, appearance, background,
    notes: [...notes, ...(facts.drawn ? [] : [nothingDrawn])],
    plan: facts.plan,
    cameras: cameras.map(({ name, width, height }) => ({ name, width, height })),
    up: subject.up,
    upReason: description.up_reason,
    lookChoices: looks,
    featureCount: description.feature_count,
    deviceBytes: facts.device_bytes,
  };
}
